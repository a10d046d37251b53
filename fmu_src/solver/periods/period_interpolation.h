// A block of vibration periods with moving inputs, whose maps are interpolated.
//
// The maps are sampled at Chebyshev points and interpolated by Newton's polynomial; the n maps are applied one after the
// other.
//
//     point k = (n - 1) (1 - cos(angle)) / 2,   angle = 0, pi, pi / 2, 3 pi / 4, pi / 4, ...
//
// A block is smooth if the points so far predict the map at the next one.
#ifndef FC_SOLVER_PERIODS_PERIOD_INTERPOLATION_H
#define FC_SOLVER_PERIODS_PERIOD_INTERPOLATION_H

#include "solver/solver.h"

// Periods that begin `phase` [s] after those of the scene.
typedef struct {
    const FcScene* scene;
    const FcSolverOptions* options;
    bool is_planar, is_bounded; // it may meet a bound
    double first, count;        // the block
    double phase;               // s
    int side;                   // of the bound at which they begin, 0 for any start
    int warm_up; // periods after which a bristle that meets its bound has forgotten, 0 for any start
} FcBlock;

// Takes *total through the block. False, with *total unchanged but for its evaluations, if the block is not
// smooth or a free bristle meets its bound.
bool fc_interpolate_periods(const FcBlock* block, FcStepResult* total);

#endif
