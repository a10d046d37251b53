// Scenes in which everything moves, one for each kind of contact, limit and law, and slopes by differences.
#ifndef FC_UNIT_MOVING_SCENE_H
#define FC_UNIT_MOVING_SCENE_H

#include "model/scene.h"
#include "table_1.h"

static const double F = 20e3; // Hz
static const double PERIOD = 5e-5;
static const double TWO_PI = 6.283185307179586;

static inline FcFriction law(int model, int limit) {
    return (FcFriction){.model = model,
                        .limit = limit,
                        .mu = 0.176,
                        .staticRatio = 1.5,
                        .V_S = 0.2,
                        .sigma_1 = 40.0,
                        .sigma_2 = 3.0};
}

// Everything moves: V, d, E, the load, both vibrations. The scene points into what the caller keeps.
static inline FcScene moving_scene(const FcContactParameters* contact, const FcFriction* friction,
                                   double rates) {
    const FcDrive drive =
        fc_drive_make((FcLinearInput){0.1, 900.0 * rates}, (FcLinearInput){14e-6, 0.02 * rates},
                      (FcLinearInput){9e9, 3e13 * rates}, (FcLinearInput){312.0, -1e6 * rates},
                      (FcVibration){.f = F, .V_1 = 0.3, .a_d = 1.1e-6, .phase_d = 0.7}, 0.3e-5, 0.0);
    const FcContactAtModulus at_E = fc_contact_at_modulus(contact, 9e9);
    return fc_scene_make(contact, &at_E, friction, 55.0, &drive);
}

typedef struct {
    FcContactParameters contact;
    FcFriction friction;
} Kind;

enum { KINDS = 3 * 2 * 2 * 2 };

static inline Kind kind(int k) {
    const int models[] = {FC_CONTACT_ASPERITIES, FC_CONTACT_MINDLIN, FC_CONTACT_CONSTANT};
    return (Kind){.contact = table_1(models[k % 3], k / 3 % 2 ? FC_CONTACT_LOAD : FC_CONTACT_SEPARATION),
                  .friction =
                      law(k / 6 % 2 ? FC_LUGRE : FC_DAHL, k / 12 % 2 ? FC_LIMIT_LOAD : FC_LIMIT_CONSTANT)};
}

// Five-point differences over 1e-3 of a period, off by less than 1e-9 of omega.
static inline double slope(double (*quantity)(const FcScene*, double), const FcScene* scene, double t) {
    const double k = 1e-3 * PERIOD;
    return (8.0 * (quantity(scene, t + k) - quantity(scene, t - k)) -
            (quantity(scene, t + 2 * k) - quantity(scene, t - 2 * k))) /
           (12.0 * k);
}

#endif
