#include "model/scene.h"

#include <assert.h>

// Where the surfaces rest at the time t [m], with contact.input = Load.
static double rest_separation(const FcScene* scene, const FcContactAtModulus* at_E, double t) {
    return (log(at_E->load_0 / fc_drive_load(&scene->drive, t)) + scene->log_swell) / at_E->decay;
}

static bool follows_load(const FcScene* scene) { return scene->contact->input == FC_CONTACT_LOAD; }

FcScene fc_scene_make(const FcContactParameters* contact, const FcContactAtModulus* at_E,
                      const FcFriction* friction, double F_C, const FcDrive* drive) {
    FcScene scene = {.contact = contact, .friction = friction, .F_C = F_C, .drive = *drive, .at_E = *at_E};
    if (drive->vibration.a_d != 0.0 && (follows_load(&scene) || fc_limit_follows_load(scene.friction))) {
        scene.log_swell = fc_contact_log_swell(at_E, drive->vibration.a_d);
    }
    if (!follows_load(&scene)) {
        scene.drive.load.rate = 0.0;
        return scene;
    }
    scene.floats = drive->load.rate != 0.0 || drive->E.rate != 0.0;
    scene.drive.d = (FcLinearInput){scene.floats ? 0.0 : rest_separation(&scene, at_E, 0.0), 0.0};
    return scene;
}

FcScene fc_scene_later(const FcScene* scene, double t) {
    const FcDrive drive = fc_drive_later(&scene->drive, t);
    const FcContactAtModulus at_E =
        drive.E.rate == 0.0 ? scene->at_E : fc_contact_at_modulus(scene->contact, drive.E.value);
    return fc_scene_make(scene->contact, &at_E, scene->friction, scene->F_C, &drive);
}

FcScene fc_scene_from(const FcScene* scene, double t) {
    FcScene from = fc_scene_later(scene, t);
    from.drive.theta_0 += from.drive.omega * t;
    return from;
}

// The contact at the modulus of the time t.
static FcContactAtModulus contact_at(const FcScene* scene, double t) {
    return scene->drive.E.rate == 0.0 ? scene->at_E
                                      : fc_contact_at_modulus(scene->contact, fc_drive_E(&scene->drive, t));
}

// The separation at t, of which the drive gives driven.
static double separation(const FcScene* scene, const FcContactAtModulus* at_E, double driven, double t) {
    return scene->floats ? driven + rest_separation(scene, at_E, t) : driven;
}

double fc_scene_d_at_phase(const FcScene* scene, double t, FcPhase at_t) {
    const double driven = fc_drive_values_at_phase(&scene->drive, t, at_t).d;
    if (!scene->floats) {
        return driven;
    }
    const FcContactAtModulus at_E = contact_at(scene, t);
    return separation(scene, &at_E, driven, t);
}

double fc_scene_d(const FcScene* scene, double t) {
    return fc_scene_d_at_phase(scene, t, fc_drive_phase(&scene->drive, t));
}

double fc_scene_d_rate_at_phase(const FcScene* scene, double t, FcPhase at_t) {
    const FcDrive* drive = &scene->drive;
    double rate = fc_drive_d_rate_at_phase(drive, at_t);
    if (scene->floats) {
        const double by_E =
            drive->E.rate != 0.0 ? fc_contact_slope_by_E(scene->contact, fc_drive_E(drive, t)).F_n : 0.0;
        rate += (by_E * drive->E.rate - drive->load.rate / fc_drive_load(drive, t)) / scene->at_E.decay;
    }
    return rate;
}

double fc_scene_d_rate(const FcScene* scene, double t) {
    return fc_scene_d_rate_at_phase(scene, t, fc_drive_phase(&scene->drive, t));
}

FcContactResponse fc_scene_contact(const FcScene* scene, double t) {
    const FcContactAtModulus at_E = contact_at(scene, t);
    return fc_contact_response(&at_E, separation(scene, &at_E, fc_drive_d(&scene->drive, t), t));
}

static FcCoefficients coefficients(const FcScene* scene, const FcContactResponse* response, double V) {
    const double limit =
        fc_limit_follows_load(scene->friction) ? scene->friction->mu * response->F_n : scene->F_C;
    return (FcCoefficients){
        .V = V, .sigma = response->sigma, .limit = limit * fc_stribeck(scene->friction, V)};
}

FcCoefficients fc_scene_coefficients_at_phase(const FcScene* scene, double t, FcPhase at_t) {
    const FcDriveValues now = fc_drive_values_at_phase(&scene->drive, t, at_t);
    FcContactResponse response = {.sigma = scene->at_E.stiffness_0};
    if (fc_scene_depends_on_d(scene)) {
        const FcContactAtModulus at_E = contact_at(scene, t);
        response = fc_contact_response(&at_E, separation(scene, &at_E, now.d, t));
    }
    return coefficients(scene, &response, now.V);
}

FcCoefficients fc_scene_coefficients(const FcScene* scene, double t) {
    return fc_scene_coefficients_at_phase(scene, t, fc_drive_phase(&scene->drive, t));
}

double fc_scene_stiffness(const FcScene* scene, double t) { return fc_scene_coefficients(scene, t).sigma; }

FcLogRates fc_scene_log_rates_at_phase(const FcScene* scene, double t, FcPhase at_t) {
    const FcDrive* drive = &scene->drive;
    FcLogRates rates = {0.0, 0.0, 0.0};
    if (fc_scene_depends_on_d(scene)) {
        const double d_rate = fc_scene_d_rate_at_phase(scene, t, at_t);
        const FcContactLogSlope by_d =
            fc_contact_slope_by_d(&scene->at_E, fc_scene_d_at_phase(scene, t, at_t));
        rates.sigma = by_d.sigma * d_rate;
        rates.limit = by_d.F_n * d_rate;
        rates.ratio = (by_d.F_n - by_d.sigma) * d_rate;
        if (drive->E.rate != 0.0) {
            const FcContactLogSlope by_E = fc_contact_slope_by_E(scene->contact, fc_drive_E(drive, t));
            rates.sigma += by_E.sigma * drive->E.rate;
            rates.limit += by_E.F_n * drive->E.rate;
            rates.ratio += (by_E.F_n - by_E.sigma) * drive->E.rate;
        }
        if (scene->floats) { // the surfaces follow the load: what E does to F_n cancels, also in rounding
            rates.limit =
                drive->load.rate / fc_drive_load(drive, t) + by_d.F_n * fc_drive_d_rate_at_phase(drive, at_t);
        }
        if (!fc_limit_follows_load(scene->friction)) {
            rates.limit = 0.0;
            rates.ratio = -rates.sigma;
        } else if (rates.sigma == 0.0) {
            rates.ratio = rates.limit;
        }
    }
    if (fc_has_stribeck_curve(scene->friction)) {
        const FcVelocity at = fc_drive_velocity_at_phase(drive, t, at_t);
        const double by_V = fc_stribeck_slope(scene->friction, at.V) / fc_stribeck(scene->friction, at.V);
        rates.limit += by_V * at.rate;
        rates.ratio += by_V * at.rate;
    }
    return rates;
}

FcLogRates fc_scene_log_rates(const FcScene* scene, double t) {
    return fc_scene_log_rates_at_phase(scene, t, fc_drive_phase(&scene->drive, t));
}

FcScene fc_scene_of_bound(const FcScene* scene, FcFriction* friction) {
    FcScene bound = *scene;
    *friction = fc_law_of_bound(scene->friction);
    bound.friction = friction;
    return bound;
}

double fc_scene_bound_rate(const FcScene* scene, double t) {
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(scene, &friction);
    const FcCoefficients at = fc_scene_coefficients(&bound, t);
    const FcLogRates rates = fc_scene_log_rates(&bound, t);
    return at.limit / at.sigma * rates.ratio;
}

// delta' of a bristle that touches no bound.
static double free_rate(const FcScene* scene, const FcCoefficients* at, double delta) {
    return scene->friction->model == FC_ELASTIC_PLASTIC ? at->V : at->V - fc_relaxation_rate(at) * delta;
}

static double bound_at(const FcScene* scene, const FcCoefficients* at) {
    return at->limit * fc_bound_over_limit(scene->friction, at->V);
}

// By how much of its bound a bristle that slips may be inside it. By hand: at the end of a step the phase's rounding may take
// it off the bound, the further the steeper Stribeck's curve is there. What an input that has fallen by decades rounds by may
// be more, which the step itself mends (fc_stick_slip_end).
static const double INSIDE_BOUND = 1e-10;
static const double ROUNDING_OF_V = 1e-15; // of the top speed
static const double MOST_INSIDE_BOUND = 1e-6;

static double inside_bound(const FcScene* scene, double V) {
    const FcDrive* drive = &scene->drive;
    const double top = fabs(drive->V.value) + fabs(drive->vibration.V_1);
    const double by_V = fc_stribeck_slope(scene->friction, V) / fc_stribeck(scene->friction, V);
    return fmin(MOST_INSIDE_BOUND, INSIDE_BOUND + ROUNDING_OF_V * top * fabs(by_V));
}

double fc_scene_slip_side(const FcScene* scene, double t, double delta) {
    if (!fc_is_bounded(scene->friction)) {
        return 0.0;
    }
    const FcCoefficients at = fc_scene_coefficients(scene, t);
    const double bound = bound_at(scene, &at);
    if (at.sigma * fabs(delta) < (1.0 - inside_bound(scene, at.V)) * bound) {
        return 0.0;
    }
    const double side = delta < 0.0 ? -1.0 : 1.0;
    return side * free_rate(scene, &at, side * (bound / at.sigma)) >= fc_scene_bound_rate(scene, t) ? side
                                                                                                    : 0.0;
}

double fc_scene_deflection_rate(const FcScene* scene, double t, double delta) {
    if (scene->friction->model == FC_COULOMB) {
        return 0.0;
    }
    const double side = fc_scene_slip_side(scene, t, delta);
    if (side != 0.0) {
        return side * fc_scene_bound_rate(scene, t);
    }
    const FcCoefficients at = fc_scene_coefficients(scene, t);
    if (fc_is_bounded(scene->friction)) {
        const double D = bound_at(scene, &at) / at.sigma;
        delta = fmax(-D, fmin(D, delta));
    }
    return free_rate(scene, &at, delta);
}

static double force(const FcScene* scene, double t, const FcCoefficients* at, double delta) {
    const FcFriction* friction = scene->friction;
    const double viscous = friction->sigma_2 != 0.0 ? friction->sigma_2 * at->V : 0.0;
    if (friction->model == FC_COULOMB) {
        return fc_sign(at->V) * at->limit + viscous;
    }
    const double damping =
        friction->sigma_1 != 0.0 ? friction->sigma_1 * fc_scene_deflection_rate(scene, t, delta) : 0.0;
    double elastic = at->sigma * delta; // Eq. 1
    if (fc_is_bounded(friction)) {
        const double bound = bound_at(scene, at);
        elastic = fmax(-bound, fmin(bound, elastic));
    }
    return elastic + damping + viscous;
}

FcOutputs fc_scene_outputs(const FcScene* scene, double t, double delta) {
    const FcContactAtModulus at_E = contact_at(scene, t);
    const FcDriveValues now = fc_drive_values(&scene->drive, t);
    const FcContactResponse response = fc_contact_response(&at_E, separation(scene, &at_E, now.d, t));
    const FcCoefficients at = coefficients(scene, &response, now.V);
    return (FcOutputs){.F_t = force(scene, t, &at, delta),
                       .F_n = response.F_n,
                       .sigma = response.sigma,
                       .A_r = response.A_r};
}

// Bounds of the separation where the surfaces rest.
static double smallest_rest(const FcScene* scene, double h) {
    const FcContactAtModulus end = contact_at(scene, h);
    const double load_0 = fmin(scene->at_E.load_0, end.load_0);
    const double load = fmax(scene->drive.load.value, fc_drive_load(&scene->drive, h));
    return (log(load_0 / load) + scene->log_swell) / scene->at_E.decay;
}

static double largest_rest(const FcScene* scene, double h) {
    const FcContactAtModulus end = contact_at(scene, h);
    const double load_0 = fmax(scene->at_E.load_0, end.load_0);
    const double load = fmin(scene->drive.load.value, fc_drive_load(&scene->drive, h));
    return (log(load_0 / load) + scene->log_swell) / scene->at_E.decay;
}

double fc_scene_smallest_d(const FcScene* scene, double h) {
    assert(h >= 0.0);
    const double driven = fc_drive_smallest_d(&scene->drive, h);
    return scene->floats ? driven + smallest_rest(scene, h) : driven;
}

static double largest_d(const FcScene* scene, double h) {
    const double driven = fc_drive_largest_d(&scene->drive, h);
    return scene->floats ? driven + largest_rest(scene, h) : driven;
}

double fc_scene_largest_stiffness(const FcScene* scene, double h) {
    const FcContactAtModulus stiffest = contact_at(scene, scene->drive.E.rate > 0.0 ? h : 0.0);
    return fc_contact_stiffness(&stiffest, fc_scene_smallest_d(scene, h));
}

double fc_scene_smallest_limit(const FcScene* scene, double h) {
    if (!fc_limit_follows_load(scene->friction)) {
        return scene->F_C;
    }
    const FcContactAtModulus end = contact_at(scene, h);
    const double load_0 = fmin(scene->at_E.load_0, end.load_0);
    return scene->friction->mu * load_0 * exp(-scene->at_E.decay * largest_d(scene, h));
}

double fc_scene_smallest_saturation(const FcScene* scene, double h) {
    if (fc_scene_ratio_is_constant(scene)) {
        const FcContactAtModulus end = contact_at(scene, h);
        return scene->friction->mu *
               fmin(scene->at_E.load_0 / scene->at_E.stiffness_0, end.load_0 / end.stiffness_0);
    }
    return fc_scene_smallest_limit(scene, h) / fc_scene_largest_stiffness(scene, h);
}

double fc_scene_largest_saturation(const FcScene* scene, double h) {
    if (scene->floats || scene->drive.E.rate != 0.0) {
        return INFINITY;
    }
    const FcFriction* friction = scene->friction;
    const double d = largest_d(scene, h);
    const double g = fc_limit_follows_load(friction) ? friction->mu * fc_contact_response(&scene->at_E, d).F_n
                                                     : scene->F_C;
    return g * fc_stribeck(friction, 0.0) / fc_contact_stiffness(&scene->at_E, d);
}

static bool contact_moves(const FcScene* scene) {
    const FcDrive* drive = &scene->drive;
    return drive->vibration.a_d != 0.0 || drive->d.rate != 0.0 || drive->E.rate != 0.0 || scene->floats;
}

bool fc_scene_stiffness_is_constant(const FcScene* scene) {
    return scene->at_E.model == FC_CONTACT_CONSTANT || !contact_moves(scene);
}

bool fc_scene_limit_is_constant(const FcScene* scene) {
    return !fc_limit_follows_load(scene->friction) || !contact_moves(scene);
}

double fc_scene_force_scale(const FcScene* scene) {
    if (!fc_limit_follows_load(scene->friction)) {
        return scene->F_C;
    }
    const double d = fc_scene_d(scene, 0.0) - (fc_drive_d(&scene->drive, 0.0) - scene->drive.d.value);
    return scene->friction->mu * scene->at_E.load_0 * exp(scene->log_swell - scene->at_E.decay * d);
}
