#include "model/scene.h"

#include <assert.h>

#include "model/extremes.h"

// The mean separation [m] of the surfaces under a load, which is load_0 at d = 0.
static double rest_separation(const FcScene* scene, double load_0, double load) {
    return (log(load_0 / load) + scene->log_swell) / scene->at_E.decay;
}

static bool follows_load(const FcScene* scene) { return scene->contact->input == FC_CONTACT_LOAD; }

// A load or a stiffness below this counts as 0 [N, N/m]. Chosen empirically, far below any visible value: the
// product of two such numbers is still a number.
static const double NOTHING = 1e-100;

// Up to this decay the contact is closed for any parameters. Chosen empirically: e^-100 of a load and a
// stiffness. A larger value might miss an opening.
static const double NOT_FAR = 50.0;

// The separation [m] beyond which F_n or sigma counts as 0, if the load is not given.
static double open_separation(const FcContactAtModulus* at_E) {
    const double without_load = log(at_E->load_0 / NOTHING) / at_E->decay;
    if (at_E->model == FC_CONTACT_CONSTANT) {
        return without_load;
    }
    const double without_stiffness = log(at_E->stiffness_0 / NOTHING);
    if (at_E->model == FC_CONTACT_MINDLIN) {
        return fc_min(without_load, without_stiffness / at_E->decay);
    }
    double d =
        without_load; // of stiffness_0 e^(-2 decay d) / d^3, by iteration: an error falls to 1 % each time
    for (int i = 0; i < 8; i++) {
        d = (without_stiffness - 3.0 * log(d)) / (2.0 * at_E->decay);
    }
    return fc_min(without_load, d);
}

void fc_scene_make(FcScene* scene, const FcContactParameters* contact, const FcContactAtModulus* at_E,
                   const FcFriction* friction, double F_C) {
    FcDrive* drive = &scene->drive;
    assert(!(F_C < 0.0 || drive->vibration.a_d < 0.0));
    scene->contact = contact;
    scene->friction = friction;
    scene->F_C = F_C;
    scene->at_E = *at_E;
    const bool by_load = contact->input == FC_CONTACT_LOAD;
    const bool swells = drive->vibration.a_d != 0.0 && (by_load || fc_limit_follows_load(friction));
    scene->log_swell = swells ? fc_contact_log_swell(at_E, drive->vibration.a_d) : 0.0;
    assert(!(scene->log_swell < 0.0));
    scene->floats = by_load && (drive->load.rate != 0.0 || drive->E.rate != 0.0);
    if (!by_load) {
        drive->load.rate = 0.0;
        scene->is_open = at_E->decay * drive->d.value > NOT_FAR && drive->d.value > open_separation(at_E);
        return;
    }
    scene->is_open = !(drive->load.value > NOTHING);
    drive->d = (FcLinearInput){1.0, 0.0}; // m, of an open contact: no force depends on it
    if (scene->floats) {
        drive->d.value = 0.0;
    } else if (!scene->is_open) {
        drive->d.value = rest_separation(scene, at_E->load_0, drive->load.value);
    }
}

double fc_scene_closed_by(const FcScene* scene) {
    return follows_load(scene)
               ? scene->drive.load.value - NOTHING
               : fc_max(NOT_FAR / scene->at_E.decay, open_separation(&scene->at_E)) - scene->drive.d.value;
}

// The largest factor by which a load moves in a segment. Chosen empirically: a larger factor needs finer
// panels, a smaller one more segments.
static const double LOAD_OF_PIECE = 4.0;

// The contact at the modulus of the time t.
static FcContactAtModulus contact_at(const FcScene* scene, double t) {
    return scene->drive.E.rate == 0.0 ? scene->at_E
                                      : fc_contact_at_modulus(scene->contact, fc_drive_E(&scene->drive, t));
}

// Time [s] until d has reached the separation at which F_n or sigma counts as 0, which E moves: by iteration, since
// a modulus that moves tenfold moves it by a hundredth.
static double time_to_edge(const FcScene* scene, double rest) {
    const FcLinearInput d = scene->drive.d;
    assert(d.rate != 0.0);
    const int most = scene->drive.E.rate == 0.0 ? 1 : 8;
    double time = 0.0;
    for (int i = 0; i < most; i++) {
        const FcContactAtModulus at_E = contact_at(scene, fc_min(fc_max(time, 0.0), rest));
        time = (open_separation(&at_E) - d.value) / d.rate;
    }
    return time;
}

double fc_scene_segment(FcScene* scene, double rest, double whole) {
    assert(rest >= 0.0 && rest <= whole);
    const FcDrive* drive = &scene->drive;
    const bool by_load = follows_load(scene);
    const double rate = by_load ? drive->load.rate : drive->d.rate;
    if (!fc_scene_has_segments(scene)) {
        return rest;
    }
    // Time until the contact opens or closes; negative if this lies behind.
    const bool opens = by_load ? rate < 0.0 : rate > 0.0;
    const bool is_far = by_load || scene->is_open ||
                        scene->at_E.decay * fc_max(drive->d.value, drive->d.value + rate * rest) > NOT_FAR;
    const double to_edge = by_load  ? -drive->load.value / rate
                           : is_far ? time_to_edge(scene, rest)
                                    : HUGE_VAL;
    const double room = FC_NEARLY_OPEN * whole;
    scene->is_open = scene->is_open || (opens && to_edge <= room);
    if (scene->is_open) {
        return opens ? rest : fc_min(rest, to_edge + room);
    }
    if (by_load) {
        const double part = rate > 0.0 ? 1.0 - LOAD_OF_PIECE : 1.0 - 1.0 / LOAD_OF_PIECE;
        return fc_min(rest, part * to_edge);
    }
    const double moved = log(LOAD_OF_PIECE) / (scene->at_E.decay * fabs(rate));
    return fc_min(rest, to_edge > 0.0 ? fc_min(moved, to_edge) : moved);
}

FcScene fc_scene_later(const FcScene* scene, double t) {
    assert(!(t < 0.0));
    FcScene later = {.drive = fc_drive_later(&scene->drive, t)};
    const double E = later.drive.E.value;
    const FcContactAtModulus at_E =
        later.drive.E.rate == 0.0 ? scene->at_E : fc_contact_at_modulus(scene->contact, E);
    fc_scene_make(&later, scene->contact, &at_E, scene->friction, scene->F_C);
    return later;
}

FcScene fc_scene_from(const FcScene* scene, double t) {
    FcScene from = fc_scene_later(scene, t);
    from.drive.theta_0 += from.drive.omega * t;
    return from;
}

// The separation at t; driven is the drive's part.
static double separation(const FcScene* scene, const FcContactAtModulus* at_E, double driven, double t) {
    return scene->floats ? driven + rest_separation(scene, at_E->load_0, fc_drive_load(&scene->drive, t))
                         : driven;
}

static double d_at_phase(const FcScene* scene, double t, FcPhase at_t) {
    const double driven = fc_drive_values_at_phase(&scene->drive, t, at_t).d;
    if (!scene->floats) {
        return driven;
    }
    const FcContactAtModulus at_E = contact_at(scene, t);
    return separation(scene, &at_E, driven, t);
}

double fc_scene_d(const FcScene* scene, double t) {
    return d_at_phase(scene, t, fc_drive_phase(&scene->drive, t));
}

static double d_rate_at_phase(const FcScene* scene, double t, FcPhase at_t) {
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
    return d_rate_at_phase(scene, t, fc_drive_phase(&scene->drive, t));
}

FcContactResponse fc_scene_contact(const FcScene* scene, double t) {
    if (scene->is_open) {
        return (FcContactResponse){.sigma = scene->at_E.model == FC_CONTACT_CONSTANT ? scene->at_E.stiffness_0
                                                                                     : 0.0};
    }
    const FcContactAtModulus at_E = contact_at(scene, t);
    return fc_contact_response(&at_E, separation(scene, &at_E, fc_drive_d(&scene->drive, t), t));
}

static FcCoefficients coefficients(const FcScene* scene, const FcContactResponse* response, double V) {
    const double limit =
        fc_limit_follows_load(scene->friction) ? scene->friction->mu * response->F_n : scene->F_C;
    assert(!(response->sigma < 0.0 || limit < 0.0));
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

FcCoefficients fc_scene_coefficients_of(const FcScene* scene, const FcContactResponse* response) {
    return coefficients(scene, response, fc_drive_V(&scene->drive, 0.0));
}

FcCoefficients fc_scene_coefficients(const FcScene* scene, double t) {
    return fc_scene_coefficients_at_phase(scene, t, fc_drive_phase(&scene->drive, t));
}

double fc_scene_stiffness(const FcScene* scene, double t) {
    const FcContactAtModulus at_E = contact_at(scene, t);
    return fc_contact_stiffness(&at_E, separation(scene, &at_E, fc_drive_d(&scene->drive, t), t));
}

FcLogRates fc_scene_log_rates(const FcScene* scene, double t, FcPhase at_t) {
    if (!fc_scene_depends_on_d(scene)) {
        return (FcLogRates){0.0, 0.0};
    }
    const FcDrive* drive = &scene->drive;
    const double d_rate = d_rate_at_phase(scene, t, at_t);
    const FcContactLogSlope by_d = fc_contact_slope_by_d(&scene->at_E, d_at_phase(scene, t, at_t));
    double sigma = by_d.sigma * d_rate;
    double limit = by_d.F_n * d_rate;
    double ratio = (by_d.F_n - by_d.sigma) * d_rate;
    if (drive->E.rate != 0.0) {
        const FcContactLogSlope by_E = fc_contact_slope_by_E(scene->contact, fc_drive_E(drive, t));
        sigma += by_E.sigma * drive->E.rate;
        limit += by_E.F_n * drive->E.rate;
        ratio += (by_E.F_n - by_E.sigma) * drive->E.rate;
    }
    if (scene->floats) { // the surfaces follow the load: the effect of E on F_n cancels, also in rounding
        limit = drive->load.rate / fc_drive_load(drive, t) + by_d.F_n * fc_drive_d_rate_at_phase(drive, at_t);
    }
    if (!fc_limit_follows_load(scene->friction)) {
        ratio = -sigma;
    } else if (sigma == 0.0) {
        ratio = limit;
    }
    return (FcLogRates){sigma, ratio};
}

double fc_scene_smallest_d(const FcScene* scene, double h) {
    assert(h >= 0.0);
    const FcDrive* drive = &scene->drive;
    double d = fc_input_min(drive->d, h) - drive->vibration.a_d;
    if (scene->floats) {
        d += rest_separation(scene, fc_min(scene->at_E.load_0, contact_at(scene, h).load_0),
                             fc_max(drive->load.value, fc_drive_load(drive, h)));
    }
    return d;
}

static double largest_d(const FcScene* scene, double h) {
    const FcDrive* drive = &scene->drive;
    double d = fc_input_max(drive->d, h) + drive->vibration.a_d;
    if (scene->floats) {
        d += rest_separation(scene, fc_max(scene->at_E.load_0, contact_at(scene, h).load_0),
                             fc_min(drive->load.value, fc_drive_load(drive, h)));
    }
    return d;
}

double fc_scene_largest_stiffness(const FcScene* scene, double h) {
    assert(!(scene->drive.E.value <= 0.0));
    const FcContactAtModulus stiffest = contact_at(scene, scene->drive.E.rate > 0.0 ? h : 0.0);
    return fc_contact_stiffness(&stiffest, fc_scene_smallest_d(scene, h));
}

double fc_scene_smallest_limit(const FcScene* scene, double h) {
    assert(h >= 0.0);
    if (!fc_limit_follows_load(scene->friction)) {
        return scene->F_C;
    }
    const FcContactAtModulus end = contact_at(scene, h);
    const double load_0 = fc_min(scene->at_E.load_0, end.load_0);
    return scene->friction->mu * load_0 * fc_contact_decayed(&scene->at_E, largest_d(scene, h));
}

double fc_scene_smallest_saturation(const FcScene* scene, double h) {
    assert(h >= 0.0);
    if (fc_scene_ratio_is_constant(scene)) {
        const FcContactAtModulus end = contact_at(scene, h);
        return scene->friction->mu *
               fc_min(scene->at_E.load_0 / scene->at_E.stiffness_0, end.load_0 / end.stiffness_0);
    }
    return fc_scene_smallest_limit(scene, h) / fc_scene_largest_stiffness(scene, h);
}

// g / sigma is largest at an end of E and of the load, with the surfaces farthest apart or, with a constant
// stiffness, nearest.
double fc_scene_largest_saturation(const FcScene* scene, double h) {
    assert(h >= 0.0);
    const FcFriction* friction = scene->friction;
    if (!fc_scene_depends_on_d(scene)) {
        return scene->F_C / scene->at_E.stiffness_0 * fc_static_ratio(friction);
    }
    const bool follows = fc_limit_follows_load(friction);
    const bool moves = scene->floats || scene->drive.E.rate != 0.0;
    const bool is_nearest = scene->at_E.model == FC_CONTACT_CONSTANT && follows;
    const double d = is_nearest ? fc_scene_smallest_d(scene, h) : largest_d(scene, h);
    double largest = 0.0;
    for (int end = 0; end <= moves; end++) {
        const FcContactAtModulus at_E = contact_at(scene, end == 0 ? 0.0 : h);
        const FcContactResponse response = fc_contact_response(&at_E, d);
        largest = fc_max(largest, (follows ? friction->mu * response.F_n : scene->F_C) / response.sigma);
    }
    return largest * fc_static_ratio(friction);
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

double fc_scene_mean_limit(const FcScene* scene, double t) {
    if (!fc_limit_follows_load(scene->friction)) {
        return scene->F_C;
    }
    if (follows_load(scene)) {
        return scene->friction->mu * fc_max(0.0, fc_drive_load(&scene->drive, t));
    }
    const FcContactAtModulus at_E = contact_at(scene, t);
    const double d = scene->drive.d.value + scene->drive.d.rate * t;
    return scene->friction->mu * at_E.load_0 * exp(scene->log_swell - at_E.decay * d);
}
