// The length of the next Radau panel.
//
// The plan follows one question. How large may an error of the force be here if F_t at the end and its mean
// shall stay within the tolerance? The bristle has a fading memory. An error made at t lives for a time K,
// until it has relaxed. In the mean over the interval H it counts K / H. The end sees e^-z of it, with the
// relaxation z in between.
//
// A panel resolves a transient and a lag. The rest of the transient counts while it lives. The panels of a
// transient are measured in layers, the time in which the bristle relaxes after the reversal. The lag behind
// a moving limit lasts. The lag is largest at the events, so its panels are measured in distances from the
// events and grow geometrically (stretches/stretch.h shows them).
//
// Tables give the lengths. The accuracy of a panel is estimated afterwards (panels/judge.h), and a panel that
// misses it is taken again, shorter.
#ifndef FC_SOLVER_MESH_H
#define FC_SOLVER_MESH_H

#include "solver/stretches/stretch.h"

// The place that the panels of a stretch have reached.
typedef struct {
    double t;         // s
    double rate;      // 1/s, sigma |V| / g
    double lag;       // 1, |force - settled force| over the interval's force
    double transient; // 1, the lag at the start of the panels
    double gone;      // 1, integral of the rate since then
    double path;      // m, to the stretch's end
    double layer;     // s, in which the bristle relaxes by 1 from the start of the panels
} FcPlace;

typedef struct {
    double h;          // s
    bool in_peak;      // of the Stribeck curve
    bool crosses_peak; // by more than V_S
    double lives;      // s, K
    double grows;      // s, in which sigma may grow e-fold
} FcPlan;

// The panel from here. Each unit of caution allows a tenth of the error.
FcPlan fc_mesh_plan(const FcStretch* stretch, const FcPlace* at, int caution);

// The largest part of an error made at t [s], ahead in the stretch, that remains at the interval's end, if
// the bristle has relaxed by `gone` from the panels' start to t. Less than the square of the tolerance counts
// as 0.
double fc_left_at_end(const FcStretch* stretch, const FcPlace* at, double t, double gone);

#endif
