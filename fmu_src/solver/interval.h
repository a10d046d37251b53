// The properties of a whole interval, the domain of one map: bounds of the coefficients of the bristle's
// equation, and the pace at which they move.
#ifndef FC_SOLVER_INTERVAL_H
#define FC_SOLVER_INTERVAL_H

#include <float.h>
#include <math.h>

#include "model/scene.h"
#include "solver/solver.h"

// An upper bound of how fast the scene moves: the one measure of pace for all plans of panels.
typedef struct {
    double phase;     // 1/s, of the vibration's angle
    double log_sigma; // 1/s, of ln(sigma) and of ln(g) but for the Stribeck curve
} FcPace;

// Over [0, h], h [s] >= 0.
FcPace fc_pace(const FcScene* scene, double h);

// Time [s] over which the phase, ln(sigma) or ln(g) moves by 1, at the least; infinite if nothing moves.
static inline double fc_smooth_time(const FcPace* pace) {
    const double rate = pace->phase + pace->log_sigma;
    return rate > 1.0 / DBL_MAX ? 1.0 / rate : INFINITY;
}

typedef struct {
    const FcScene* scene;
    double duration;   // s
    double tolerance;  // 1, of F_t at the end and of its mean, over the force
    double force;      // N, the scale of the tolerance
    double speed;      // m/s, largest |V|
    double stiffness;  // N/m, largest sigma
    double saturation; // m, largest g / sigma: over this path errors fade by e at least
    FcPace pace;
} FcInterval;

// Keeps the pointer.
FcInterval fc_interval_make(const FcScene* scene, double duration, const FcSolverOptions* options);

// The allowed error of a force [N].
static inline double fc_allowed_force(const FcInterval* interval) {
    return interval->tolerance * interval->force;
}

#endif
