// The parts of a stretch that are crossed alike: its bells of the Stribeck curve, and what is between them.
//
//     |V|  |    .  '  '  .    |
//          |  '            '  |
//          |bell| between |bell|
//
// Gauss panels cross a section where they are cheaper, elsewhere Radau panels, and those go on over the sections until the
// next that Gauss panels cross.
#ifndef FC_SOLVER_SECTION_H
#define FC_SOLVER_SECTION_H

#include "solver/gauss_pieces.h"
#include "solver/mesh.h"

typedef struct {
    const FcScene* scene; // of the coefficients there
    double start, end;    // s
    double share;         // 1, of the stretch
    FcRelaxation z;       // 1, by how much the bristle relaxes in it
    double forgets;       // 1, and in the stretch and the next
    bool in_bell;
    bool is_measured; // z is by what sigma is in the whole section, not at the start alone
    bool soft;        // Gauss panels may be cheaper
} FcSection;

enum { FC_MOST_SECTIONS = 3 };

// How many sections a stretch has in which the bristle relaxes by about per_path [1/m] and by most_per_path at the most;
// beyond_bells is the scene without its Stribeck curve.
int fc_sections(const FcScene* scene, const FcScene* beyond_bells, const FcStretch* stretch, double per_path,
                double most_per_path, FcSection* sections, double* evaluations);

// The Gauss panels for a section; decades of accuracy asked for.
FcGaussPieces fc_section_pieces(const FcSection* section, const FcBells* bells, double decades);

// Displacement [m] of V from t to a time in the stretch.
double fc_stretch_displacement(const FcStretch* stretch, const FcDrive* drive, double t, double end);

#endif
