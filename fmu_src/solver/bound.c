#include "solver/bound.h"

#include <math.h>

const double FC_NO_BOUND = 1e200;

// Of the time to a pole: the longest panel of the quadratures then ends well before it.
static const double POLE = 0.12;
// Of the smooth time, for a central difference.
static const double SMALL_PART = 1e-4;

static bool contact_moves(const FcScene* scene) {
    const FcDrive* drive = &scene->drive;
    return drive->vibration.a_d != 0.0 || drive->d.rate != 0.0 || drive->E.rate != 0.0 || scene->floats;
}

bool fc_bound_stiffness_is_constant(const FcScene* scene) {
    return scene->at_E.model == FC_CONTACT_CONSTANT || !contact_moves(scene);
}

bool fc_bound_limit_is_constant(const FcScene* scene) {
    return !fc_limit_follows_load(scene->friction) || !contact_moves(scene);
}

// F_n and Mindlin's stiffness fall with d alike.
static bool ratio_is_constant(const FcScene* scene) {
    return scene->at_E.model == FC_CONTACT_MINDLIN && fc_limit_follows_load(scene->friction);
}

bool fc_bound_is_constant(const FcScene* scene) {
    return (fc_bound_stiffness_is_constant(scene) && fc_bound_limit_is_constant(scene)) ||
           (ratio_is_constant(scene) && scene->drive.E.rate == 0.0);
}

static double ratio(const FcScene* scene, const FcContactAtModulus* at_E, double limit, double sigma) {
    const double D =
        ratio_is_constant(scene) ? scene->friction->mu * (at_E->load_0 / at_E->stiffness_0) : limit / sigma;
    return D < FC_NO_BOUND ? D : FC_NO_BOUND;
}

// The times [s] from now on to a zero of d, E or the load, at the least: 1/d^3 and ln E have poles there.
static double time_to_pole(const FcScene* scene, double t, double d, double d_rate) {
    const FcDrive* drive = &scene->drive;
    const double speed = fabs(d_rate);
    const double acceleration = drive->vibration.a_d * drive->omega * drive->omega;
    double time = 2.0 * d / (speed + sqrt(speed * speed + 2.0 * acceleration * d));
    if (drive->E.rate != 0.0) {
        time = fmin(time, fc_drive_E(drive, t) / fabs(drive->E.rate));
    }
    if (drive->load.rate != 0.0) {
        time = fmin(time, fc_drive_load(drive, t) / fabs(drive->load.rate));
    }
    return time;
}

double fc_bound_smooth_time(const FcScene* scene, double t, double d, double d_rate) {
    const FcDrive* drive = &scene->drive;
    if (!contact_moves(scene) ||
        (scene->at_E.model == FC_CONTACT_CONSTANT && !fc_limit_follows_load(scene->friction))) {
        return 1.0 / drive->omega;
    }
    const double by_d =
        scene->at_E.model == FC_CONTACT_ASPERITIES ? 2.0 * scene->at_E.decay + 3.0 / d : scene->at_E.decay;
    const double pole = POLE * time_to_pole(scene, t, d, d_rate);
    const double rate = drive->omega + by_d * fabs(d_rate);
    const double curvature = by_d * drive->vibration.a_d * drive->omega * drive->omega;
    // rate x + curvature x^2 / 2 = 1
    return fmin(pole, 2.0 / (rate + sqrt(rate * rate + 2.0 * curvature)));
}

// Inputs E and load held: everything is a function of d.
static void set_held(FcBoundMotion* at, const FcScene* scene, double d_curvature) {
    const FcContactResponse now = fc_contact_response(&scene->at_E, at->d);
    at->sigma = now.sigma;
    at->limit = fc_limit_follows_load(scene->friction) ? scene->friction->mu * now.F_n : scene->F_C;
    at->D = ratio(scene, &scene->at_E, at->limit, at->sigma);
    if (fc_bound_is_constant(scene)) {
        return;
    }
    const FcContactLogSlope slope = fc_contact_slope_by_d(&scene->at_E, at->d);
    const double by_d = (fc_limit_follows_load(scene->friction) ? slope.F_n : 0.0) - slope.sigma;
    const double by_d_by_d = scene->at_E.model == FC_CONTACT_ASPERITIES ? -3.0 / (at->d * at->d) : 0.0;
    const double log_rate = by_d * at->d_rate;
    at->D_rate = at->D * log_rate;
    at->D_curvature =
        at->D * (log_rate * log_rate + by_d * d_curvature + by_d_by_d * at->d_rate * at->d_rate);
}

static double log_rate_at(const FcScene* scene, double t) {
    const FcLogRates rates = fc_scene_log_rates(scene, t);
    return rates.limit - rates.sigma;
}

static void set_moving(FcBoundMotion* at, const FcScene* scene, double t) {
    const FcCoefficients now = fc_scene_coefficients(scene, t);
    const FcContactAtModulus at_E = fc_contact_at_modulus(scene->contact, fc_drive_E(&scene->drive, t));
    at->sigma = now.sigma;
    at->limit = now.limit;
    at->D = ratio(scene, &at_E, now.limit, now.sigma);
    const double log_rate = log_rate_at(scene, t);
    const double tau = SMALL_PART * fc_bound_smooth_time(scene, t, at->d, at->d_rate);
    const double log_curvature = (log_rate_at(scene, t + tau) - log_rate_at(scene, t - tau)) / (2.0 * tau);
    at->D_rate = at->D * log_rate;
    at->D_curvature = at->D * (log_rate * log_rate + log_curvature);
}

FcBoundMotion fc_bound_motion(const FcScene* scene, double t) {
    const FcDrive* drive = &scene->drive;
    const FcVibration* vibration = &drive->vibration;
    FcBoundMotion at = {.V = drive->V.value + drive->V.rate * t,
                        .V_rate = drive->V.rate,
                        .d = drive->d.value + drive->d.rate * t,
                        .d_rate = drive->d.rate};
    double d_curvature = 0.0;
    if (drive->omega != 0.0) {
        const double theta = drive->theta_0 + drive->omega * t;
        const double c = cos(theta);
        const double s = sin(theta);
        at.sin_theta = s;
        at.V += vibration->V_1 * c;
        at.V_rate -= vibration->V_1 * drive->omega * s;
        const double c_d = c * drive->cos_phase_d - s * drive->sin_phase_d;
        const double s_d = s * drive->cos_phase_d + c * drive->sin_phase_d;
        at.d += vibration->a_d * c_d;
        at.d_rate -= vibration->a_d * drive->omega * s_d;
        d_curvature = -vibration->a_d * drive->omega * drive->omega * c_d;
    }
    if (scene->floats || drive->E.rate != 0.0) {
        at.d = fc_scene_d(scene, t);
        at.d_rate = fc_scene_d_rate(scene, t);
        set_moving(&at, scene, t);
    } else {
        set_held(&at, scene, d_curvature);
    }
    return at;
}

double fc_bound(const FcScene* scene, double t) { return fc_bound_motion(scene, t).D; }
