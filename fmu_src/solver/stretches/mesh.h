// How long the next Radau panel is.
//
// One idea: what may an error of the force be here, so that F_t at the end and its mean stay within the tolerance? The
// bristle has a fading memory. An error made at t lives for a time K, until it has relaxed: in the mean it counts K / H, H
// being the interval. The end sees e^-z of it, z being what relaxes in between.
//
// Two things are to be resolved. What is left of a transient counts while it lives; its panels are measured in layers,
// the time in which the bristle relaxes after the reversal. The lag behind a moving limit lasts; its panels are measured
// in distances from the events, where it is largest, and grow geometrically (stretches/stretch.h shows them).
//
// Lengths are chosen by tables, the accuracy a panel reaches is estimated afterwards (panels/judge.h): a panel that misses
// what it is allowed is taken again, shorter.
#ifndef FC_SOLVER_MESH_H
#define FC_SOLVER_MESH_H

#include "solver/stretches/stretch.h"

// Where the panels of a stretch have got to.
typedef struct {
    double t;         // s
    double rate;      // 1/s, sigma |V| / g
    double lag;       // 1, |force - what it settles to| over the interval's force
    double transient; // 1, the lag where the panels start
    double gone;      // 1, integral of the rate since then
    double path;      // m, to the stretch's end
    double layer;     // s, in which the bristle relaxes by 1 from where the panels start
} FcPlace;

typedef struct {
    double h;          // s
    bool in_peak;      // of the Stribeck curve
    bool crosses_peak; // by more than V_S
    double lives;      // s, K
    double grows;      // s, in which sigma may grow e-fold
} FcPlan;

// The panel from here. Each unit of caution asks for a tenth of the error.
FcPlan fc_mesh_plan(const FcStretch* stretch, const FcPlace* at, int caution);

// What is left at the interval's end of an error made at t [s], from here on in the stretch, by when the bristle has relaxed by
// gone since the panels' start, at the most; 0 for less than the square of what is allowed.
double fc_left_at_end(const FcStretch* stretch, const FcPlace* at, double t, double gone);

#endif
