// How long the next Radau panel is and how many stages it has.
//
// One idea: what may an error of the force be here, so that F_t at the end and its mean stay within the tolerance? The
// bristle forgets. An error made at t lives for a time K, until it has relaxed: in the mean it counts K / H, H being
// the interval. The end sees e^-z of it, z being what relaxes in between.
//
// Two things are to be resolved. What is left of a transient counts while it lives; its panels are measured in layers,
// the time in which the bristle relaxes after the reversal. The lag behind a moving limit lasts; its panels are measured
// in distances from the reversals, where it is largest, and grow geometrically:
//
//        reversal                                        reversal
//     |V|   |.  '   '      '         '         '      '   '  .|
//           |-|--|----|--------|-----------|--------|----|--|-|      panels
//            w_a                                            w_b      layers
//
// Lengths are chosen by tables, the accuracy a panel reaches is estimated afterwards (solver/panel.h): a panel that
// misses what it is allowed is taken again with more stages, then shorter.
#ifndef FC_SOLVER_MESH_H
#define FC_SOLVER_MESH_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "model/scene.h"
#include "solver/stribeck_bell.h"

// How fast the phase and the logarithms of sigma and g move at the most, and whether the surfaces come so close, or the
// modulus or the load move so far, that they have to be followed instead of bounded.
typedef struct {
    double rate; // 1/s
    bool follows_d_and_E;
} FcSmoothness;

typedef struct {
    const FcScene* scene;
    double end;        // s    of the interval
    double force;      // N    what the tolerance is relative to
    double allowed;    // 1    error of F_t at the end and of its mean, over force
    bool moving_limit; // g is no constant
    double saturation; // m    largest g / sigma: over this path errors fade by e at least
    double beyond;     // m    the same beyond the bells of the Stribeck curve
    double forgotten;  // m    over this path they fade below the square of what is allowed
    double speed;      // m/s  largest |V|
    FcSmoothness smooth;
} FcMesh;

// A stretch of time on which V keeps its sign, and the events on both sides that its panels are graded towards. The
// event ahead may lie beyond the end.
typedef struct {
    double start, end;                           // s
    double event;                                // s, at or beyond the end; infinite if there is none
    bool reversal;                               // the event is one, and no dip
    FcPhase start_phase, end_phase, event_phase; // of the vibration
    double w_a, w_b;                             // s, layers at the start and at the event
    double back; // s, from the start back to what the panels are graded away from
    double
        transient; // 1, at the interval's start: |force - what it settles to| over the mesh's force; elsewhere infinite
    FcBells bells;       // where the Stribeck curve matters
    double displacement; // m
    double relaxes;      // 1, by how much the bristle does in it, about; 0 where that is not known
    double path_after;   // m, path from the end to the next reversal or the interval's end
    FcCoefficients at_start, at_end; // with the layers; at the end where there is an event
} FcStretch;

// Of the vibration at t [s] in the stretch.
static inline FcPhase fc_stretch_phase(const FcStretch* stretch, const FcDrive* drive, double t) {
    return t == stretch->start ? stretch->start_phase
           : t == stretch->end ? stretch->end_phase
                               : fc_drive_phase(drive, t);
}

// About -log10(x), down to the next power of two; about 308 for 0 and the smallest numbers.
static inline double fc_digits(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return -0.30103 * ((int)(bits >> 52 & 0x7ff) - 1023); // log10(2) times the exponent
}

// Where the panels have got to.
typedef struct {
    double t;
    double rate;      // 1/s, sigma |V| / g
    double lag;       // 1, |force - what it settles to| over the mesh's force
    double transient; // 1, the lag at the stretch's start
    double gone;      // 1, integral of the rate since then
    double path;      // m, to the stretch's end
    double layer;     // s, in which the bristle relaxes by 1 from where the panels start
} FcPlace;

typedef struct {
    double h;          // s
    int stages;        // 5 or 9
    bool in_bell;      // of the Stribeck curve
    bool crosses_bell; // by more than V_S
    double lives;      // s, K
    double grows;      // s, in which sigma may grow e-fold
} FcPlan;

FcSmoothness fc_mesh_smoothness(const FcScene* scene, double h); // over [0, h]
FcMesh fc_mesh_make(const FcScene* scene, double end, double tolerance);

// Largest g / sigma over [0, h] [m]: what happened fades by e over that path at least. Infinite where E or the surfaces move.
double fc_mesh_largest_saturation(const FcScene* scene, double h);

// Time [s] in which a bristle that relaxes by per_path [1/m], sigma / g, does so by 1 from where V is that on: about the
// least root of r x + r' x^2 / 2 = 1 and r'' x^3 / 6 = 1. The last one counts where V only touches zero.
static inline double fc_mesh_layer(const FcVelocity* at, double per_path) {
    const double r = per_path * fabs(at->V);
    const double r_rate = per_path * fabs(at->rate);
    const double r_curvature = per_path * fabs(at->curvature);
    const double root = 2.0 / (r + sqrt(r * r + 2.0 * r_rate));
    return r_curvature * root * root * root <= 6.0 ? root : cbrt(6.0 / r_curvature);
}

// Width [s] of a dip of |V| that does not reach zero: that of the parabola, or the time to relax by 1 in it.
double fc_mesh_dip_layer(const FcVelocity* at, double per_path);

// Distance [s] of what V last came from, a reversal or a dip, when the bristle has settled there.
double fc_mesh_settled_back(const FcVelocity* at);

// What is left at the interval's end of an error made at t [s], from here on in the stretch, by when the bristle has relaxed by
// gone since the stretch's start, at the most; 0 for less than the square of what is allowed.
double fc_mesh_left_at_end(const FcMesh* mesh, const FcStretch* stretch, const FcPlace* at, double t,
                           double gone);

// The panel from here. Each unit of caution asks for a tenth of the error.
FcPlan fc_mesh_plan(const FcMesh* mesh, const FcStretch* stretch, const FcPlace* at, int caution);

#endif
