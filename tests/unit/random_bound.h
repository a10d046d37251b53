// Random scenes in which both V and the bound vibrate, from a bound that moves slowly to one that moves fast.
#ifndef FC_UNIT_RANDOM_BOUND_H
#define FC_UNIT_RANDOM_BOUND_H

#include "model/constants.h"
#include "random.h"
#include "solver/stick_slip/bound.h"
#include "table_1.h"

static const double F = 20e3;          // Hz
static const double D_MEAN = 14e-6;    // m
static const double E = 58.55693617e9; // Pa

static FcContactParameters contact;
static FcFriction friction;

// It points to contact and friction.
static inline FcScene random_scene(void) {
    contact = table_1(1 + (int)(3.0 * random_01()), FC_CONTACT_SEPARATION);
    friction = (FcFriction){.model = FC_ELASTIC_PLASTIC,
                            .limit = 1 + (int)(2.0 * random_01()),
                            .mu = 0.18,
                            .staticRatio = 1.0,
                            .V_S = 0.01};
    const double V_1 = random_log(1e-2, 3.0);
    const double V = (random_01() - 0.5) * 2.0 * V_1 * (random_01() < 0.5 ? 1.0 : random_log(1e-4, 1.0));
    const FcVibration vibration = {F, V_1, random_log(1e-8, 6e-6), FC_TWO_PI * random_01()};
    const FcContactAtModulus plain = fc_contact_at_modulus(&contact, E);
    const double bound = V_1 / (FC_TWO_PI * F) * random_log(1e-4, 1e4);
    contact.stiffnessScale *= 55.0 / bound / fc_contact_stiffness(&plain, D_MEAN);
    contact.sigma = 55.0 / bound;
    const FcContactAtModulus at_E = fc_contact_at_modulus(&contact, E);
    const FcDrive drive =
        fc_drive_make((FcLinearInput){V, 0.0}, (FcLinearInput){D_MEAN, 0.0}, (FcLinearInput){E, 0.0},
                      (FcLinearInput){100.0, 0.0}, vibration, random_01() / F, 0.0);
    return fc_scene_make(&contact, &at_E, &friction, 55.0, &drive);
}

// The rate [m/s] at which the upper bound (0) or the lower one (1) comes nearer to a stuck bristle.
static inline double approach(const FcBoundMotion* at, int which) {
    return (which == 0 ? at->V : -at->V) - at->D_rate;
}

#endif
