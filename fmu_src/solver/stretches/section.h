// The parts of a stretch that are crossed alike: its Stribeck peaks, and what is between them; and into how many Gauss panels
// a part is cut, where they are cheaper than Radau panels.
//
//     |V|  |    .  '  '  .    |
//          |  '            '  |
//          |peak| between |peak|
//
// Only the price depends on the plan: whether a Gauss panel is accurate is bounded or judged (panels/judge.h).
#ifndef FC_SOLVER_SECTION_H
#define FC_SOLVER_SECTION_H

#include "solver/stretches/stretch.h"

// What relaxes, about: in all, in the half where more does, and if it went on as fast as it ever does.
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
    bool is_measured; // z is by what sigma is in the whole section, not at the start alone
    bool soft;        // Gauss panels may be cheaper
} FcSection;

// A peak, what is between, a peak.
enum { FC_MOST_SECTIONS = 3 };

// How many sections the stretch has. Adds to *evaluations what it takes.
int fc_sections(const FcStretch* stretch, FcSection* sections, double* evaluations);

typedef struct {
    int count; // of equal lengths; 0 where Radau panels are about cheaper
    int nodes; // 4, 6, 8 or 12
} FcGaussPlan;

// The Gauss panels for a section of the stretch.
FcGaussPlan fc_section_plan(const FcStretch* stretch, const FcSection* section);

// The same between peaks, by phi, half the angle by which the vibration turns, mu, half of what ln(sigma) may move by, and
// the decades of accuracy asked for.
FcGaussPlan fc_gauss_plan(double phi, double mu, const FcRelaxation* z, double decades);

#endif
