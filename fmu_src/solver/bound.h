// The bound D = g / sigma [m] of an elastic-plastic bristle's deflection: how it moves, and what else the bristle's
// events and integrals need at one moment, for the price of one sine, cosine and exponential while E is held.
//
//     ln D = ln g - ln sigma,      D' = D L,      D'' = D (L^2 + L'),      L = (ln D)'
#ifndef FC_SOLVER_BOUND_H
#define FC_SOLVER_BOUND_H

#include <stdbool.h>

#include "model/scene.h"

// Larger bounds than this [m] count as it, and as none: they are never met, and their rates stay finite.
extern const double FC_NO_BOUND;

typedef struct {
    double V;           // m/s
    double V_rate;      // m/s2
    double sigma;       // N/m
    double limit;       // N, g
    double D;           // m
    double D_rate;      // m/s
    double D_curvature; // m/s2
    double d;           // m
    double d_rate;      // m/s
    double sin_theta;   // of the vibration
} FcBoundMotion;

FcBoundMotion fc_bound_motion(const FcScene* scene, double t);

// The time [s] from t on over which the phase, ln sigma and ln g move by 1 at the most, at the separation d [m] and its
// rate [m/s].
double fc_bound_smooth_time(const FcScene* scene, double t, double d, double d_rate);

// D alone [m].
double fc_bound(const FcScene* scene, double t);

// Whether sigma, g and D stand still over the step.
bool fc_bound_stiffness_is_constant(const FcScene* scene);
bool fc_bound_limit_is_constant(const FcScene* scene);
bool fc_bound_is_constant(const FcScene* scene);

#endif
