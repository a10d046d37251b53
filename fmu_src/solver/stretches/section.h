// The parts of a stretch that are crossed alike are its Stribeck peaks and the section between them. This
// file also plans the Gauss panels of a part, if they are cheaper than Radau panels.
//
//     |V|  |    .  '  '  .    |
//          |  '            '  |
//          |peak| between |peak|
//
// Only the cost depends on the plan: the accuracy of a Gauss panel is bounded or judged (panels/judge.h).
#ifndef FC_SOLVER_SECTION_H
#define FC_SOLVER_SECTION_H

#include "solver/stretches/stretch.h"

// The approximate relaxation: in all, in the half that relaxes more, and at the largest rate throughout.
typedef struct {
    double whole, half, fastest;
} FcRelaxation;

typedef struct {
    const FcScene* scene; // of the coefficients there
    double start, end;    // s
    double share;         // 1, of the stretch
    FcRelaxation z;       // 1, by how much the bristle relaxes in it
    double forgets;       // 1, and in the stretch and the next
    bool in_peak;
    bool is_measured; // z is sampled in the whole section, not at its start alone
    bool soft;        // Gauss panels may be cheaper
} FcSection;

// A peak, the section between, a peak.
enum { FC_MOST_SECTIONS = 3 };

// The number of sections of the stretch. Adds its evaluations to *evaluations.
int fc_sections(const FcStretch* stretch, FcSection* sections, double* evaluations);

typedef struct {
    int count; // of equal lengths; 0 if Radau panels are about cheaper
    int nodes; // 4, 6, 8 or 12
} FcGaussPlan;

// The Gauss panels for a section of the stretch.
FcGaussPlan fc_section_plan(const FcStretch* stretch, const FcSection* section);

// The same between peaks, by phi, half the angle by which the vibration turns, mu, half the largest change of
// ln(sigma), and the required decades of accuracy.
FcGaussPlan fc_gauss_plan(double phi, double mu, const FcRelaxation* z, double decades);

#endif
