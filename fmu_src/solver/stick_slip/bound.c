#include "solver/stick_slip/bound.h"

#include <assert.h>
#include <math.h>

// By hand: far beyond any deflection, and D L^2 is a number for rates L up to 1e50 1/s.
const double FC_NO_BOUND = 1e200;

// The longest smooth time, over the time to a pole. By hand: panels of the quadratures for six digits and more then end well
// before the pole (at most 6.75 of them); for fewer WAY_TO_POLE sees to it where E or the load falls (regime_integrals.c). Less
// costs cells.
static const double POLE = 0.12;
// The shortest smooth time that is good for all places, over that of the phase alone. By hand: costs cells, not accuracy.
static const double SHORTEST_COMMON = 0.1;
// The step of a central difference, over the smooth time. By hand: it misses 1e-8, and keeps rounding below 1e-11.
static const double DIFFERENCE_STEP = 1e-4;

static bool nothing_moves(const FcScene* scene) {
    return fc_scene_stiffness_is_constant(scene) && fc_scene_limit_is_constant(scene);
}

bool fc_bound_is_constant(const FcScene* scene) {
    if (fc_has_stribeck_curve(scene->friction) && !fc_drive_V_is_constant(&scene->drive)) {
        return false;
    }
    return nothing_moves(scene) || (fc_scene_ratio_is_constant(scene) && scene->drive.E.rate == 0.0);
}

bool fc_bound_may_fall(const FcScene* scene) {
    assert(!fc_has_stribeck_curve(scene->friction));
    const FcDrive* drive = &scene->drive;
    if (fc_bound_is_constant(scene)) {
        return false;
    }
    if (drive->vibration.a_d != 0.0 || drive->E.rate != 0.0) {
        return true;
    }
    const double apart = scene->floats ? -drive->load.rate : drive->d.rate; // the way that d goes
    const bool rises_with_d = scene->at_E.model != FC_CONTACT_CONSTANT;     // D = g / sigma
    return rises_with_d ? apart < 0.0 : apart > 0.0;
}

static double ratio(const FcScene* scene, const FcContactAtModulus* at_E, double limit, double sigma) {
    const double D = fc_scene_ratio_is_constant(scene)
                         ? scene->friction->mu * (at_E->load_0 / at_E->stiffness_0)
                         : limit / sigma;
    return D < FC_NO_BOUND ? D : FC_NO_BOUND;
}

// Beyond this decay d, e^(-decay d) is 0 in rounding: sigma and g are, or stand still. Derived: e^-746 is rounded to 0.
static const double GONE = 750.0;
// The longest smooth time, over the time until d may be back from there, or V at the Stribeck curve. Derived: the longest panel of
// the quadratures, 12 of them, then ends before that.
static const double WAY_TO_RETURN = 0.08;

// The least time [s] that d takes to fall by a distance [m].
static double time_to_fall(const FcScene* scene, double distance, double d_rate) {
    const double speed = fabs(d_rate);
    const double acceleration = scene->drive.vibration.a_d * scene->drive.omega * scene->drive.omega;
    return fc_time_to_move(speed, acceleration, distance);
}

// The times [s] from now on to a zero of d, E or the load, at the least: 1/d^3 and ln E have poles there.
static double time_to_pole(const FcScene* scene, double t, double d, double d_rate) {
    const FcDrive* drive = &scene->drive;
    double time = time_to_fall(scene, d, d_rate);
    if (drive->E.rate != 0.0) {
        time = fmin(time, fc_drive_E(drive, t) / fabs(drive->E.rate));
    }
    if (drive->load.rate != 0.0) {
        time = fmin(time, fc_drive_load(drive, t) / fabs(drive->load.rate));
    }
    return time;
}

// Beyond this velocity, over V_S, the Stribeck curve is 1 in rounding. Derived: e^(-6^2) is one eps.
static const double END_OF_PEAK = 6.0;

// The time [s] from now on over which V moves by half of V_S, or until it may be back at the Stribeck curve's peak.
static double stribeck_time(const FcScene* scene, double V) {
    const FcDrive* drive = &scene->drive;
    const double V_S = scene->friction->V_S;
    const double fastest = fabs(drive->V.rate) + drive->vibration.V_1 * drive->omega; // m/s2
    const double beyond = fabs(V) - END_OF_PEAK * V_S;
    return fmax(0.5 * V_S, WAY_TO_RETURN * beyond) / fastest;
}

// Rate [1/m] at which ln sigma or ln g moves with d, at the most.
static double log_slope(const FcScene* scene, double d) {
    return scene->at_E.model == FC_CONTACT_ASPERITIES ? 2.0 * scene->at_E.decay + 3.0 / d : scene->at_E.decay;
}

// But for the Stribeck curve.
static double smooth_time_of_contact(const FcScene* scene, double t, double d, double d_rate) {
    const FcDrive* drive = &scene->drive;
    if (nothing_moves(scene)) {
        return 1.0 / drive->omega;
    }
    const double by_d = log_slope(scene, d);
    const double pole = POLE * time_to_pole(scene, t, d, d_rate);
    const double rate = drive->omega + by_d * fabs(d_rate);
    const double curvature = by_d * drive->vibration.a_d * drive->omega * drive->omega;
    double time = fc_time_to_move(rate, curvature, 1.0);
    const double gone = GONE / scene->at_E.decay;
    if (d > gone && !scene->floats) {
        const double returning = WAY_TO_RETURN * time_to_fall(scene, d - gone, d_rate);
        time = fmax(time, drive->omega > 0.0 ? fmin(returning, 1.0 / drive->omega) : returning);
    }
    return fmin(pole, time);
}

double fc_bound_smooth_time(const FcScene* scene, const FcBoundMotion* at) {
    const double time = smooth_time_of_contact(scene, at->t, at->d, at->d_rate);
    return fc_has_stribeck_curve(scene->friction) ? 1.0 / (1.0 / time + 1.0 / stribeck_time(scene, at->V))
                                                  : time;
}

double fc_bound_common_smooth_time(const FcScene* scene, double h) {
    const FcDrive* drive = &scene->drive;
    if (scene->floats || drive->E.rate != 0.0 || drive->omega == 0.0 ||
        fc_has_stribeck_curve(scene->friction)) {
        return 0.0;
    }
    if (nothing_moves(scene)) {
        return 1.0 / drive->omega;
    }
    const double d = fc_drive_smallest_d(drive, h);
    const double d_rate = fabs(drive->d.rate) + drive->vibration.a_d * drive->omega;
    const double rate = drive->omega + log_slope(scene, d) * d_rate;
    const double least = fmin(POLE * time_to_pole(scene, 0.0, d, d_rate), 1.0 / rate);
    return least * drive->omega > SHORTEST_COMMON ? least : 0.0;
}

// The factor of the Stribeck curve on D, log_rate and log_curvature being the derivatives of ln D without it.
static void add_stribeck_curve(FcBoundMotion* at, const FcScene* scene, double log_rate,
                               double log_curvature) {
    const FcDrive* drive = &scene->drive;
    const double V_curvature =
        drive->omega * drive->omega * (drive->V.value + drive->V.rate * at->t - at->V); // -omega^2 V_1 cos
    const double factor = fc_stribeck(scene->friction, at->V);
    const double slope = fc_stribeck_slope(scene->friction, at->V) / factor;
    const double bend = fc_stribeck_curvature(scene->friction, at->V) / factor - slope * slope;
    const double rate = log_rate + slope * at->V_rate;
    at->limit *= factor;
    at->D = fmin(FC_NO_BOUND, factor * at->D);
    at->D_rate = at->D * rate;
    at->D_curvature =
        at->D * (rate * rate + log_curvature + slope * V_curvature + bend * at->V_rate * at->V_rate);
}

// Inputs E and load held: everything is a function of d, and V.
static void set_held(FcBoundMotion* at, const FcScene* scene) {
    const FcContactAtModulus* c = &scene->at_E;
    const bool follows_load = fc_limit_follows_load(scene->friction);
    const FcContactResponse now = fc_contact_response(c, at->d);
    const FcContactLogSlope by_d = fc_contact_slope_by_d(c, at->d);
    at->sigma = now.sigma;
    at->limit = follows_load ? scene->friction->mu * now.F_n : scene->F_C;
    at->D = ratio(scene, c, at->limit, at->sigma);
    const double slope = (follows_load ? by_d.F_n : 0.0) - by_d.sigma;
    const double log_rate = slope * at->d_rate;
    const double log_curvature =
        slope * at->d_curvature - fc_contact_stiffness_bend(c, at->d) * at->d_rate * at->d_rate;
    at->D_rate = at->D * log_rate;
    at->D_curvature = at->D * (log_rate * log_rate + log_curvature);
    if (fc_has_stribeck_curve(scene->friction)) {
        add_stribeck_curve(at, scene, log_rate, log_curvature);
    }
}

static double log_rate_at(const FcScene* scene, double t) { return fc_scene_log_rates(scene, t).ratio; }

static void set_moving(FcBoundMotion* at, const FcScene* scene, double t) {
    const FcCoefficients now = fc_scene_coefficients(scene, t);
    const FcContactAtModulus at_E = fc_contact_at_modulus(scene->contact, fc_drive_E(&scene->drive, t));
    at->sigma = now.sigma;
    at->limit = now.limit;
    const double factor = fc_stribeck(scene->friction, now.V);
    at->D = fmin(FC_NO_BOUND, factor * ratio(scene, &at_E, now.limit / factor, now.sigma));
    if (fc_bound_is_constant(scene)) {
        return;
    }
    const double log_rate = log_rate_at(scene, t);
    const double tau = DIFFERENCE_STEP * fc_bound_smooth_time(scene, at);
    const double log_curvature =
        isfinite(tau) ? (log_rate_at(scene, t + tau) - log_rate_at(scene, t - tau)) / (2.0 * tau) : 0.0;
    at->D_rate = at->D * log_rate;
    at->D_curvature = at->D * (log_rate * log_rate + log_curvature);
}

// The angle's cosine c and sine s given.
static FcBoundMotion motion_at_phase(const FcScene* scene, double t, double c, double s) {
    const FcDrive* drive = &scene->drive;
    const FcVibration* vibration = &drive->vibration;
    const double omega = drive->omega;
    const double d_c = vibration->a_d * (c * drive->cos_phase_d - s * drive->sin_phase_d);
    const double d_s = vibration->a_d * (s * drive->cos_phase_d + c * drive->sin_phase_d);
    FcBoundMotion at = {.t = t,
                        .phase = {.cosine = c, .sine = s},
                        .V = drive->V.value + drive->V.rate * t + vibration->V_1 * c,
                        .V_rate = drive->V.rate - vibration->V_1 * omega * s,
                        .d = drive->d.value + drive->d.rate * t + d_c,
                        .d_rate = drive->d.rate - omega * d_s,
                        .d_curvature = -omega * omega * d_c};
    if (scene->floats || drive->E.rate != 0.0) {
        at.d = fc_scene_d(scene, t);
        at.d_rate = fc_scene_d_rate(scene, t);
        set_moving(&at, scene, t);
    } else {
        set_held(&at, scene);
    }
    return at;
}

FcBoundMotion fc_bound_motion(const FcScene* scene, double t) {
    if (scene->drive.omega == 0.0) {
        return motion_at_phase(scene, t, 1.0, 0.0);
    }
    const double theta = scene->drive.theta_0 + scene->drive.omega * t;
    return motion_at_phase(scene, t, cos(theta), sin(theta));
}

void fc_bound_motions(const FcScene* scene, double t, double step, int count, FcBoundMotion* at) {
    const double theta = scene->drive.theta_0 + scene->drive.omega * t;
    const double turn = scene->drive.omega * step;
    const double cos_turn = cos(turn);
    const double sin_turn = sin(turn);
    double c = cos(theta);
    double s = sin(theta);
    for (int i = 0; i < count; i++) {
        at[i] = motion_at_phase(scene, t + i * step, c, s);
        const double c_next = c * cos_turn - s * sin_turn;
        s = s * cos_turn + c * sin_turn;
        c = c_next;
    }
}

void fc_bound_relaxes(const FcFriction* law, int count, FcBoundMotion* at) {
    assert(law->model != FC_ELASTIC_PLASTIC);
    for (int i = 0; i < count; i++) {
        at[i].k = fc_bound_over_limit(law, at[i].V);
        at[i].k_slope = -at[i].k * fc_stribeck_slope(law, at[i].V) / fc_stribeck(law, at[i].V);
    }
}

FcBoundMotion fc_bound_nearby(const FcScene* scene, const FcBoundMotion* at, double t) {
    const double dt = t - at->t;
    FcBoundMotion nearby = *at;
    nearby.t = t;
    nearby.phase = fc_drive_phase(&scene->drive, t);
    nearby.V += at->V_rate * dt;
    nearby.D += dt * (at->D_rate + 0.5 * dt * at->D_curvature);
    nearby.D_rate += at->D_curvature * dt;
    nearby.d += dt * (at->d_rate + 0.5 * dt * at->d_curvature);
    nearby.d_rate += at->d_curvature * dt;
    return nearby;
}

FcBoundMotion fc_bound_standing(const FcScene* scene, const FcBoundMotion* at, double t) {
    const FcDrive* drive = &scene->drive;
    FcBoundMotion now = *at;
    now.t = t;
    now.phase = fc_drive_phase(drive, t);
    const FcVelocity velocity = fc_drive_velocity_at_phase(drive, t, now.phase);
    now.V = velocity.V;
    now.V_rate = velocity.rate;
    return now;
}

double fc_bound_reached(const FcBoundMotion* at, double delta) { return fmax(-at->D, fmin(at->D, delta)); }

double fc_bound_loss(const FcBoundMotion* at, double delta) {
    const double reached = fc_bound_reached(at, delta);
    return delta != reached ? 0.5 * at->sigma * (delta - reached) * (delta + reached) : 0.0;
}
