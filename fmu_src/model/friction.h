// The laws of friction. The bristle's deflection delta [m] is the state of all laws but Coulomb's. g [N] is
// the limit of the bristle's force, constant or proportional to the normal force. Stribeck's curve is s(V) =
// 1 + (staticRatio - 1) e^(-(V / V_S)^2).
//
//     Coulomb         F = g sgn V
//     ElasticPlastic  it sticks, delta' = V, until sigma |delta| reaches the static bound, staticRatio g; it breaks away and
//                     slips along the kinetic bound g s(V), until it would move slower than that bound   (Prandtl, Jenkins)
//     Dahl            delta' = V - sigma |V| delta / g                                                   (Eq. 1, 2)
//     LuGre           delta' = V - sigma |V| delta / (g s(V))
//
// If g follows the load, a bristle of Dahl carries at most g, and one of LuGre at most staticRatio g. The
// bristle slips along that bound.
//
// Every law with a state gives F_t = sigma delta + sigma_1 delta' + sigma_2 V, Coulomb F_t = F + sigma_2 V.
#ifndef FC_MODEL_FRICTION_H
#define FC_MODEL_FRICTION_H

#include <assert.h>
#include <math.h>
#include <stdbool.h>

// The values of modelDescription.xml.
typedef enum { FC_DAHL = 1, FC_COULOMB = 2, FC_ELASTIC_PLASTIC = 3, FC_LUGRE = 4 } FcFrictionModel;
typedef enum { FC_LIMIT_CONSTANT = 1, FC_LIMIT_LOAD = 2 } FcFrictionLimit;

typedef struct {
    int model;          // FcFrictionModel
    int limit;          // FcFrictionLimit: F_C, or mu times the normal force
    double mu;          // 1
    double staticRatio; // 1      static over Coulomb friction, at least 1
    double V_S;         // m/s    Stribeck velocity
    double sigma_1;     // N s/m  damping of the bristle
    double sigma_2;     // N s/m  viscous friction
} FcFriction;

// The state of a bristle. Its transitions are in model/bound.h.
typedef enum {
    FC_FREE, // inside its bound: ElasticPlastic sticks, delta' = V; Dahl and LuGre relax, delta' = V - r delta
    FC_SLIPPING, // along its bound: delta = n D
    FC_CATCHING_UP // ElasticPlastic with static friction: it has broken away, and lies inside its kinetic bound since an
                   // input has jumped; delta' = V
} FcBristleState;

typedef struct {
    double delta; // m
    FcBristleState state;
    double delta_y; // m, across
} FcBristle;

// The size of the deflection [m].
static inline double fc_size(FcBristle bristle) {
    return bristle.delta_y == 0.0 ? fabs(bristle.delta) : hypot(bristle.delta, bristle.delta_y);
}

// The side along: 1 or -1.
static inline int fc_side(FcBristle bristle) { return bristle.delta < 0.0 ? -1 : 1; }

static inline bool fc_limit_follows_load(const FcFriction* friction) {
    return friction->limit == FC_LIMIT_LOAD;
}

// Whether the law has a state, the deflection of a bristle.
static inline bool fc_has_bristle(const FcFriction* friction) { return friction->model != FC_COULOMB; }

// Whether the bristle sticks, delta' = V, below its bound.
static inline bool fc_may_stick(const FcFriction* friction) { return friction->model == FC_ELASTIC_PLASTIC; }

// Whether the bristle relaxes, delta' = V - r delta, at the rate r = sigma |V| / limit [1/s].
static inline bool fc_may_relax(const FcFriction* friction) {
    return fc_has_bristle(friction) && !fc_may_stick(friction);
}

// Whether the law uses staticRatio.
static inline bool fc_may_have_static_friction(const FcFriction* friction) {
    return friction->model == FC_LUGRE || friction->model == FC_ELASTIC_PLASTIC;
}

// Whether the limit depends on V.
static inline bool fc_has_stribeck_curve(const FcFriction* friction) {
    return fc_may_have_static_friction(friction) && friction->staticRatio != 1.0;
}

// Whether the bristle remembers that it slips.
static inline bool fc_has_static_friction(const FcFriction* friction) {
    return fc_may_stick(friction) && friction->staticRatio != 1.0;
}

// Whether the bristle has broken away, so that its bound is the kinetic one.
static inline bool fc_has_broken_away(const FcFriction* friction, FcBristleState state) {
    return state != FC_FREE && fc_has_static_friction(friction);
}

// Static over Coulomb friction; 1 in laws without static friction.
static inline double fc_static_ratio(const FcFriction* friction) {
    return fc_has_stribeck_curve(friction) ? friction->staticRatio : 1.0;
}

// Whether the bristle's force has a bound along which it slips.
static inline bool fc_is_bounded(const FcFriction* friction) {
    return fc_may_stick(friction) || (fc_may_relax(friction) && fc_limit_follows_load(friction));
}

// The velocity over V_S beyond which a Stribeck curve counts as 1: e^-25 of it remains. Chosen empirically; at half
// of it e^-6 would remain.
#define FC_END_OF_PEAK 5.0

// The shape of the curve at the velocity V [m/s]: ln of (s(V) - 1) / (s(0) - 1).
static inline double fc_stribeck_log_peak(const FcFriction* friction, double V) {
    const double farthest = 26.0 * friction->V_S; // where e^-676 of it is left: 0 in all digits
    const double speed = fabs(V) > farthest ? farthest : fabs(V);
    return -(speed / friction->V_S) * (speed / friction->V_S);
}

// Factor on the limit at the velocity V [m/s], and its derivative with respect to V [s/m]: 1 and 0 without a
// Stribeck curve.
static inline double fc_stribeck(const FcFriction* friction, double V) {
    assert(!fc_has_stribeck_curve(friction) || friction->staticRatio >= 1.0);
    return fc_has_stribeck_curve(friction)
               ? 1.0 + (friction->staticRatio - 1.0) * exp(fc_stribeck_log_peak(friction, V))
               : 1.0;
}

static inline double fc_stribeck_slope(const FcFriction* friction, double V) {
    return -2.0 * V / (friction->V_S * friction->V_S) * (fc_stribeck(friction, V) - 1.0);
}

// The static limit over the limit at V.
static inline double fc_static_over_limit(const FcFriction* friction, double V) {
    return fc_has_stribeck_curve(friction) ? friction->staticRatio / fc_stribeck(friction, V) : 1.0;
}

#endif
