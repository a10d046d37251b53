// The contact in the plane: V = (V, V_y), and the bristle's deflection and force are vectors too. With r =
// sigma |V| / g,
//
//     Coulomb         F = g V / |V|
//     Dahl, LuGre     delta' = V - r delta, g with Stribeck's curve of |V|
//     ElasticPlastic  it sticks, delta' = V, inside the disc |delta| < D of the static bound, and slips on the circle of the kinetic one,
//                     delta = D n, for as long as it is pushed outwards, n V > D'; n turns with the part of V across it,
//                     D n' = V - (n V) n
//
// If g follows the load, |sigma delta| of Dahl and LuGre has the bound that it has along a line (friction.h).
#ifndef FC_MODEL_PLANE_H
#define FC_MODEL_PLANE_H

#include "model/scene.h"

typedef struct {
    double x, y;
} FcVector;

static inline double fc_product(FcVector a, FcVector b) { return a.x * b.x + a.y * b.y; }
// a + factor b.
static inline FcVector fc_plus(FcVector a, double factor, FcVector b) {
    return (FcVector){a.x + factor * b.x, a.y + factor * b.y};
}
// a / |a|; if a is 0, the other vector.
static inline FcVector fc_direction(FcVector a, FcVector otherwise) {
    const double size = hypot(a.x, a.y);
    return size > 0.0 ? (FcVector){a.x / size, a.y / size} : otherwise;
}
// a / |a|; 0 if a is 0.
static inline FcVector fc_direction_or_zero(FcVector a) { return fc_direction(a, (FcVector){0.0, 0.0}); }
// |a| |b| times the sine of the angle from a to b.
static inline double fc_across(FcVector a, FcVector b) { return a.x * b.y - a.y * b.x; }

static inline FcVector fc_delta(FcBristle bristle) { return (FcVector){bristle.delta, bristle.delta_y}; }

// Whether the contact moves or is deflected transversely.
static inline bool fc_is_planar(const FcScene* scene, FcBristle bristle) {
    return bristle.delta_y != 0.0 || fc_drive_is_planar(&scene->drive);
}

// A scene, and the same scene with its static limit, which does not depend on V. It points into itself.
typedef struct {
    const FcScene* scene;
    FcFriction static_friction;
    FcScene of_static_limit;
    bool is_one_dimensional; // nothing moves transversely
} FcPlane;
void fc_plane_make(FcPlane* plane, const FcScene* scene); // keeps the pointer

// The coefficients of the equations above at one time.
typedef struct {
    FcVector V;          // m/s
    double speed;        // m/s, |V|
    double sigma;        // N/m
    double limit;        // N, g at |V|
    double static_limit; // N
} FcPlaneCoefficients;
FcPlaneCoefficients fc_plane_coefficients(const FcPlane* plane, double t, FcPhase at_t);

// r = sigma |V| / g [1/s] of Dahl and LuGre.
static inline double fc_plane_relaxation(const FcPlane* plane, const FcPlaneCoefficients* at) {
    return fc_may_stick(plane->scene->friction) ? 0.0 : at->sigma * at->speed / at->limit;
}

// The force [N] of Coulomb's law, g V / |V|; 0 if nothing moves.
static inline FcVector fc_plane_coulomb(const FcPlaneCoefficients* at) {
    const double over_speed = at->speed > 0.0 ? at->limit / at->speed : 0.0;
    return (FcVector){over_speed * at->V.x, over_speed * at->V.y};
}

// The radius D [m] of the bound of a bristle in that state.
double fc_plane_radius(const FcPlane* plane, const FcPlaneCoefficients* at, FcBristleState state);

// The bound with its rate, and the rate of ln sigma.
typedef struct {
    double limit;          // N
    double D;              // m
    double rate;           // m/s
    double log_sigma_rate; // 1/s
} FcPlaneBound;
FcPlaneBound fc_plane_bound(const FcPlane* plane, const FcPlaneCoefficients* at, FcBristleState state,
                            double t, FcPhase at_t);
FcPlaneBound fc_bound(const FcPlane* plane, FcBristleState state, double t); // at a local time [s]

// The push: the velocity [m/s] at which a bristle on its bound, in the direction n (|n| = 1), would leave the
// bound outwards. The bristle slips while the push is positive.
double fc_plane_push(const FcPlane* plane, const FcPlaneCoefficients* at, const FcPlaneBound* bound,
                     FcVector n);

// The push as a function of time, for fc_root_between: context is an FcPushed.
typedef struct {
    const FcPlane* plane;
    FcBristleState state;
    FcVector n;
} FcPushed;
double fc_push_at(void* context, double t);

#endif
