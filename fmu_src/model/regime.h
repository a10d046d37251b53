// The motion of a bristle whose regime is known: free, or slipping along its bound. In model exchange a regime holds from
// one event to the next, so that the right-hand side is smooth between them:
//
//     free       delta' = V in ElasticPlastic, V - sigma |V| delta / g in Dahl and LuGre      F = sigma delta
//     slipping   delta' = side D'                                                             F = side sigma D
//
// with the bound D = g / sigma, in LuGre with the static limit. The force of a bristle that slips is that of the bound
// itself, so an integrator's error of delta does not reach it. With F_t = F + sigma_1 delta' + sigma_2 V
//
//     W_f' = F_t V        Q_f' = F_t V - F delta'
#ifndef FC_MODEL_REGIME_H
#define FC_MODEL_REGIME_H

#include "model/scene.h"

// The sign of the bound along which the bristle slips; 0 where it touches none.
typedef enum { FC_SLIPS_BACK = -1, FC_FREE = 0, FC_SLIPS_FORWARD = 1 } FcRegime;

// Time derivatives of the states.
typedef struct {
    double delta; // m/s
    double W_f;   // W
    double Q_f;   // W
} FcStateRates;

typedef struct {
    double F_t; // N
    FcStateRates rates;
} FcMotion;

// At the start of the scene, of a bristle deflected by delta [m]. FC_FREE for a law without a bound; Coulomb's force has
// no regime.
FcMotion fc_motion(const FcScene* scene, FcRegime regime, double delta);

// A direction in the space of what the motion depends on.
typedef struct {
    double V;     // m/s
    double d;     // m
    double E;     // Pa
    double load;  // N
    double delta; // m
} FcDirection;

// The derivative of the motion along the direction, by the chain rule; of the rate of a bound by a central difference.
FcMotion fc_motion_along(const FcScene* scene, FcRegime regime, double delta, const FcDirection* along);

// The bound D [m] at the start of the scene of a bounded law.
double fc_regime_bound(const FcScene* scene);

// Velocity [m/s] by which a bristle on the bound of that side (1 or -1) is pushed beyond it: what it would move by if it were
// free, less the motion of the bound. It slips where this is positive.
double fc_regime_push(const FcScene* scene, int side);

#endif
