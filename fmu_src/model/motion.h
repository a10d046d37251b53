// The motion of a bristle at the start of a scene, by its state:
//
//     free, catching up   delta' = V in ElasticPlastic, V - sigma |V| delta / g in Dahl and LuGre     F = sigma delta
//     slipping            delta' = n D' + V - (n V) n                                                 F = n sigma D
//
// delta, V and F are vectors in the plane of the contact (model/plane.h), and n is the direction of delta. Along a line n is
// the bound's side, 1 or -1, and delta' = n D'. In model exchange a state lasts from one event to the next, so that the
// right-hand side is smooth between them. The force of a bristle that slips is that of the bound itself. So an integrator's
// error of delta does not affect the force, and inputs that move the bound ahead of delta do not either. n turns as on the
// bound itself. With F_t = F + sigma_1 delta' + sigma_2 V
//
//     W_f' = F_t V        Q_f' = F_t V - F delta'
#ifndef FC_MODEL_MOTION_H
#define FC_MODEL_MOTION_H

#include "model/bound.h"

// Time derivatives of the states.
typedef struct {
    double delta;   // m/s
    double W_f;     // W
    double Q_f;     // W
    double delta_y; // m/s
} FcStateRates;

typedef struct {
    FcVector force; // N, (F_t, F_y)
    FcStateRates rates;
} FcMotion;

static inline bool fc_motion_is_finite(const FcMotion* of) {
    return isfinite(of->force.x) && isfinite(of->force.y) && isfinite(of->rates.delta) &&
           isfinite(of->rates.delta_y) && isfinite(of->rates.W_f) && isfinite(of->rates.Q_f);
}

// A law without a bound is free. Coulomb's force has no state.
FcMotion fc_motion(const FcScene* scene, FcBristle bristle);

// (F_t, F_y) [N] of a bristle within its bound, from the results of fc_scene_contact at the start.
FcVector fc_force(const FcScene* scene, const FcContactResponse* contact, FcBristle bristle);

// A direction in the space of the variables of the motion.
typedef struct {
    double V;             // m/s, with the vibration
    double d;             // m, the input
    double swing;         // m, by which the vibration moves the separation
    double a_d;           // m, by which its amplitude moves the mean separation under a load
    double E;             // Pa
    double load;          // N
    double delta;         // m
    double V_y;           // m/s, with the vibration
    double delta_y;       // m
    double log_limit;     // 1, of F_C or mu, over itself
    double log_stiffness; // 1, of contact.sigma or stiffnessScale, over itself
    double staticRatio;   // 1, 0 in laws that do not use it
    double V_S;           // m/s
    double sigma_1;       // N s/m
    double sigma_2;       // N s/m
    double bound_rate;    // m/s, of the rate of the bound, for a bristle that slips
} FcDirection;

// Derivatives of ln(sigma), ln(A_r) and ln(F_n) along a direction at the start of a scene. With a load they include the
// motion of the separation. Those of F_n and A_r are 0 for an open contact.
FcContactLogSlope fc_contact_along(const FcScene* scene, const FcDirection* along);

// The derivative of the motion along the direction, by the chain rule.
FcMotion fc_motion_along(const FcScene* scene, FcBristle bristle, const FcDirection* along);

// Time derivative of (F_t, F_y) [N/s] of a bristle that is within its bound, with the rates of the inputs in
// the drive.
FcVector fc_force_rate(const FcScene* scene, FcBristle bristle);

#endif
