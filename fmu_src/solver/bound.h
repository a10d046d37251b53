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
    double t;           // s
    double V;           // m/s
    double V_rate;      // m/s2
    double sigma;       // N/m
    double limit;       // N, g
    double D;           // m
    double D_rate;      // m/s
    double D_curvature; // m/s2
    double d;           // m
    double d_rate;      // m/s
    double d_curvature; // m/s2
    double sin_theta;   // of the vibration
} FcBoundMotion;

// The rate [m/s] at which the upper bound (0) or the lower one (1) comes nearer to a stuck bristle.
static inline double fc_bound_approach(const FcBoundMotion* at, int which) {
    return (which == 0 ? at->V : -at->V) - at->D_rate;
}

FcBoundMotion fc_bound_motion(const FcScene* scene, double t);

// At t, t + step, ..., at half the price each: the angle's sine and cosine are rotated from one to the next.
void fc_bound_motions(const FcScene* scene, double t, double step, int count, FcBoundMotion* at);

// V, D, d and their rates at a time t so near to it that terms of third order of D and d don't count; the rest stays as
// it was.
FcBoundMotion fc_bound_nearby(const FcBoundMotion* at, double t);

// Of a bound that stands still: V and its rate and sin_theta; the rest stays as it was.
FcBoundMotion fc_bound_standing(const FcScene* scene, const FcBoundMotion* at, double t);

// The time [s] from t on over which the phase, ln sigma and ln g move by 1 at the most, at the separation d [m] and its
// rate [m/s].
double fc_bound_smooth_time(const FcScene* scene, double t, double d, double d_rate);

// A time that is no longer than that anywhere in [0, h]; 0 where that is of no use: where it would be much shorter than at
// other places, without vibration, and where the inputs E or load move.
double fc_bound_common_smooth_time(const FcScene* scene, double h);

// delta [m] taken onto the bound where it lies beyond, and what the bristle loses by that [J].
double fc_bound_reached(const FcBoundMotion* at, double delta);
double fc_bound_loss(const FcBoundMotion* at, double delta);

// With E held, at the separation d [m]: D [m], and the slope of ln D by d [1/m].
double fc_bound_at_separation(const FcScene* scene, double d);
double fc_bound_log_slope(const FcScene* scene, double d);

// D alone [m].
double fc_bound(const FcScene* scene, double t);

// Whether D stands still over the step.
bool fc_bound_is_constant(const FcScene* scene);

#endif
