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
    FcPhase phase;      // of the vibration
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
    double k;           // 1, how fast a bristle on the bound relaxes, over |V|
    double k_slope;     // s/m, its slope by V
} FcBoundMotion;

FcBoundMotion fc_bound_motion(const FcScene* scene, double t);

// At t, t + step, ..., at half the price each: the angle's sine and cosine are rotated from one to the next.
void fc_bound_motions(const FcScene* scene, double t, double step, int count, FcBoundMotion* at);

// Sets k at each, which is 0 else: a bristle of Dahl or LuGre relaxes at the rate sigma |V| / g, on its bound by |V| k.
void fc_bound_relaxes(const FcFriction* law, int count, FcBoundMotion* at);

// The phase, V, D, d and their rates at a time t so near to it that terms of third order of D and d don't count; the rest
// stays as it was.
FcBoundMotion fc_bound_nearby(const FcScene* scene, const FcBoundMotion* at, double t);

// Of a bound that stands still: the phase, V and its rate; the rest stays as it was.
FcBoundMotion fc_bound_standing(const FcScene* scene, const FcBoundMotion* at, double t);

// The time [s] from at->t on over which the phase, ln sigma and ln g move by 1 at the most, and V by half of V_S where a
// Stribeck curve counts; t, V, d and d_rate are what it takes.
double fc_bound_smooth_time(const FcScene* scene, const FcBoundMotion* at);

// A time that is no longer than that anywhere in [0, h]; 0 where that is of no use: where it would be much shorter than at
// other places, without vibration, with a Stribeck curve, and where the inputs E or load move.
double fc_bound_common_smooth_time(const FcScene* scene, double h);

// delta [m] taken onto the bound where it lies beyond, and what the bristle loses by that [J].
double fc_bound_reached(const FcBoundMotion* at, double delta);
double fc_bound_loss(const FcBoundMotion* at, double delta);

// Whether D stands still over the step.
bool fc_bound_is_constant(const FcScene* scene);

// Whether D may fall in the step, without a Stribeck curve: of the bound of a law that relaxes.
bool fc_bound_may_fall(const FcScene* scene);

#endif
