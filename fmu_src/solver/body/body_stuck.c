#include "solver/body/body_stuck.h"

#include <assert.h>
#include <math.h>

#include "model/extremes.h"
#include "model/motion.h"

// The largest |Z|, over the radius of the bound. Chosen empirically: ten times of it loses a digit near resonance, where panels
// keep it; a tenth costs time there.
static const double MAX_DRIVEN = 1e3;

bool fc_body_stuck_start(const FcPlane* plane, const FcBody* body, const FcBodyStart* at, double t,
                         FcBodyStuck* stuck) {
    assert(body->m > 0.0 && plane->is_one_dimensional && t >= 0.0);
    const FcScene* scene = plane->scene;
    const FcDrive* drive = &scene->drive;
    if (at->kind != FC_STICKS || !fc_scene_stiffness_is_constant(scene) ||
        !fc_scene_limit_is_constant(scene) || scene->friction->sigma_1 != 0.0 ||
        scene->friction->sigma_2 != 0.0) {
        return false;
    }
    const FcPhase phase = fc_drive_phase(drive, t);
    const FcPlaneCoefficients now = fc_plane_coefficients(plane, t, phase);
    const double driven = body->m * drive->vibration.V_1 * drive->omega; // N
    const double stiffness = now.sigma - body->m * drive->omega * drive->omega;
    if (fabs(driven) * now.sigma > MAX_DRIVEN * now.static_limit * fabs(stiffness)) {
        return false;
    }
    *stuck = (FcBodyStuck){.A = (fc_input_after(body->F, t) + body->m * drive->V.rate) / now.sigma,
                           .B = body->F.rate / now.sigma,
                           .Z = driven != 0.0 ? -driven / stiffness : 0.0,
                           .omega = drive->omega,
                           .ringing = sqrt(now.sigma / body->m),
                           .phase = phase};
    stuck->C = at->delta - (stuck->A + stuck->Z * phase.sine);
    stuck->S = (at->v + now.V.x - (stuck->B + stuck->Z * stuck->omega * phase.cosine)) / stuck->ringing;
    return true;
}

double fc_body_stuck_delta(const FcBodyStuck* stuck, double x, double* rate, double* integral) {
    assert(x >= 0.0 && stuck->ringing >= 0.0);
    // Differences to the start, which keep the digits of a short time.
    const double half_sine = sin(0.5 * stuck->ringing * x);
    const double less_1 = -2.0 * half_sine * half_sine; // cos(w x) - 1
    const double sine = sin(stuck->ringing * x);
    const double s = sin(stuck->omega * x);
    const double c = cos(stuck->omega * x);
    const double swing = stuck->phase.sine * c + stuck->phase.cosine * s;
    const double swing_rate = stuck->phase.cosine * c - stuck->phase.sine * s;
    *rate = stuck->B + stuck->omega * stuck->Z * swing_rate +
            stuck->ringing * (stuck->S * (1.0 + less_1) - stuck->C * sine);
    *integral = (stuck->A + 0.5 * stuck->B * x) * x + (stuck->C * sine - stuck->S * less_1) / stuck->ringing;
    if (stuck->Z != 0.0) {
        *integral += stuck->Z * (stuck->phase.cosine - swing_rate) / stuck->omega;
    }
    return stuck->A + stuck->B * x + stuck->Z * swing + stuck->C * (1.0 + less_1) + stuck->S * sine;
}

double fc_body_stuck_free_time(const FcBodyStuck* stuck, double D, double end) {
    assert(D > 0.0 && end >= 0.0);
    const double most =
        D * (1.0 + 0.5 * FC_ROUNDING_OF_BOUND) - fabs(stuck->Z) - hypot(stuck->C, stuck->S); // of |A + B t|
    if (!(most > fabs(stuck->A))) {
        return 0.0;
    }
    const double way = most - (stuck->B < 0.0 ? -stuck->A : stuck->A);
    return fabs(stuck->B) * end > way ? way / fabs(stuck->B) : end;
}
