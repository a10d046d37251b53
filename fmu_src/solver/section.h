// The parts of a stretch that are crossed alike: its bells of the Stribeck curve, and what is between them.
//
//     |V|  |    .  '  '  .    |
//          |  '            '  |
//          |bell| between |bell|
//
// Where little relaxes in a section Gauss panels cross it, elsewhere Radau panels, and those go on over the sections
// until the next that is soft.
#ifndef FC_SOLVER_SECTION_H
#define FC_SOLVER_SECTION_H

#include "solver/mesh.h"

typedef struct {
    const FcScene* scene; // of the coefficients there
    double start, end;    // s
    bool in_bell;
    bool soft;      // little relaxes in it
    double share;   // 1, of the stretch
    double moves;   // 1, by about how much the phase and ln(sigma) do
    double relaxes; // 1, by about how much the bristle does in it
    double forgets; // 1, and in the stretch and the next
} FcSection;

typedef struct {
    FcSection at[3];
    int count;
} FcSections;

// Of a stretch in which the bristle relaxes by per_path [1/m]; beyond_bells is the scene without its Stribeck curve.
FcSections fc_sections(const FcScene* scene, const FcScene* beyond_bells, const FcStretch* stretch,
                       double per_path);

// Displacement [m] of V from t to a time in the stretch.
double fc_stretch_displacement(const FcStretch* stretch, const FcDrive* drive, double t, double end);

#endif
