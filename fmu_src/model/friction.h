// The laws of friction. The bristle's deflection delta [m] is the state of all but Coulomb's; g [N] is the limit of its
// force, constant or proportional to the normal force:
//
//     Coulomb         F = g sgn V
//     ElasticPlastic  delta' = V while sigma |delta| < g; else it slips along sigma |delta| = g      (Prandtl, Jenkins)
//     Dahl            delta' = V - sigma |V| delta / g                                               (Eq. 1, 2)
//     LuGre           the same with g (1 + (staticRatio - 1) e^(-(V / V_S)^2)) for g
//
// Every law with a state gives F_t = sigma delta + sigma_1 delta' + sigma_2 V, Coulomb F_t = F + sigma_2 V.
#ifndef FC_MODEL_FRICTION_H
#define FC_MODEL_FRICTION_H

#include <math.h>
#include <stdbool.h>

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

static inline bool fc_limit_follows_load(const FcFriction* friction) {
    return friction->limit == FC_LIMIT_LOAD;
}

// sgn V.
static inline double fc_sign(double V) { return V > 0.0 ? 1.0 : V < 0.0 ? -1.0 : 0.0; }

// Whether the limit depends on V.
static inline bool fc_has_stribeck_curve(const FcFriction* friction) {
    return friction->model == FC_LUGRE && friction->staticRatio != 1.0;
}

// Factor on the limit at the velocity V [m/s], and its derivative with respect to V [s/m]: 1 and 0 but for LuGre.
static inline double fc_stribeck(const FcFriction* friction, double V) {
    const double ratio = V / friction->V_S;
    return fc_has_stribeck_curve(friction) ? 1.0 + (friction->staticRatio - 1.0) * exp(-ratio * ratio) : 1.0;
}

static inline double fc_stribeck_slope(const FcFriction* friction, double V) {
    return -2.0 * V / (friction->V_S * friction->V_S) * (fc_stribeck(friction, V) - 1.0);
}

#endif
