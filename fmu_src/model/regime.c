#include "model/regime.h"

#include <math.h>
#include <stddef.h>

#include "model/derivatives.h"

FcScene fc_scene_of_bound(const FcScene* scene, int slips, FcFriction* friction) {
    FcScene bound = *scene;
    *friction = *scene->friction;
    friction->model = FC_ELASTIC_PLASTIC;
    if (slips == 0 || scene->friction->model != FC_ELASTIC_PLASTIC) {
        const double ratio = fc_static_ratio(scene->friction);
        friction->mu *= ratio;
        friction->staticRatio = 1.0;
        bound.F_C *= ratio;
    }
    bound.friction = friction;
    return bound;
}

double fc_bound(const FcScene* bound, double t) {
    const FcCoefficients at = fc_scene_coefficients(bound, t);
    return at.limit / at.sigma;
}

double fc_bound_rate(const FcScene* bound, double t) {
    return fc_bound(bound, t) * fc_scene_log_rates(bound, t).ratio;
}

double fc_push(const FcScene* scene, const FcScene* bound, double t, int side) {
    const FcCoefficients at = fc_scene_coefficients(scene, t);
    return side * fc_free_rate(scene, &at, side * fc_bound(bound, t)) - fc_bound_rate(bound, t);
}

double fc_push_at(void* context, double t) {
    const FcPushed* of = context;
    return fc_push(of->scene, of->bound, t, of->side);
}

// That of the side at the start of the scene.
static double push(const FcScene* scene, int slips, int side) {
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(scene, slips, &friction);
    return fc_push(scene, &bound, 0.0, side);
}

static double bound_of(const FcScene* scene, const FcCoefficients* at, int slips) {
    const bool is_static = slips == 0 || scene->friction->model != FC_ELASTIC_PLASTIC;
    return at->limit * (is_static ? fc_static_over_limit(scene->friction, at->V) : 1.0) / at->sigma;
}

FcBristle fc_reach(const FcScene* scene, FcBristle bristle) {
    if (fc_scene_is_loose(scene)) {
        return (FcBristle){0};
    }
    if (!fc_is_bounded(scene->friction)) {
        return bristle;
    }
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    double D = bound_of(scene, &at, bristle.slips);
    const int side = bristle.delta < 0.0 ? -1 : 1;
    if (fabs(bristle.delta) > D) {
        if (fc_has_static_friction(scene->friction) && bristle.slips == 0) {
            bristle.slips = side;
            D = bound_of(scene, &at, side);
        }
        bristle.delta = side * D;
    }
    if (bristle.slips != 0 && !(push(scene, bristle.slips, bristle.slips) > 0.0)) {
        bristle.slips = 0;
    }
    return bristle;
}

// By how much of its bound a bristle that slips may be inside it. By hand: at the end of a step the phase's rounding may take
// it off the bound.
static const double INSIDE_BOUND = 1e-10;

FcRegime fc_regime(const FcScene* scene, FcBristle bristle) {
    if (!fc_is_bounded(scene->friction) || fc_scene_is_loose(scene) ||
        (fc_has_static_friction(scene->friction) && bristle.slips == 0)) {
        return FC_FREE;
    }
    const int side = bristle.delta < 0.0 ? -1 : 1;
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    const double D = bound_of(scene, &at, bristle.slips);
    const bool on_bound = fabs(bristle.delta) >= (1.0 - INSIDE_BOUND) * D && side * bristle.slips >= 0;
    return on_bound && push(scene, bristle.slips, side) > 0.0 ? (FcRegime)side : FC_FREE;
}

// What a motion is made of, or their derivatives along a direction.
typedef struct {
    double V;          // m/s
    double force;      // N, F
    double delta_rate; // m/s
} Parts;

static Parts parts_at(const FcScene* scene, const FcCoefficients* at, FcRegime regime, double delta) {
    if (fc_scene_is_loose(scene)) {
        return (Parts){.V = at->V};
    }
    if (scene->friction->model == FC_COULOMB) {
        return (Parts){.V = at->V, .force = fc_sign(at->V) * at->limit};
    }
    if (regime == FC_FREE) {
        return (Parts){.V = at->V, .force = at->sigma * delta, .delta_rate = fc_free_rate(scene, at, delta)};
    }
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(scene, regime, &friction);
    return (Parts){.V = at->V,
                   .force = (double)regime * fc_scene_coefficients(&bound, 0.0).limit,
                   .delta_rate = (double)regime * fc_bound_rate(&bound, 0.0)};
}

// F_t, and its derivative where parts are derivatives: it is linear in them.
static double whole_force(const FcFriction* friction, const Parts* of) {
    double F_t = of->force;
    if (friction->model != FC_COULOMB && friction->sigma_1 != 0.0) {
        F_t += friction->sigma_1 * of->delta_rate;
    }
    if (friction->sigma_2 != 0.0) {
        F_t += friction->sigma_2 * of->V;
    }
    return F_t;
}

static Parts parts(const FcScene* scene, FcRegime regime, double delta) {
    const FcContactResponse contact = fc_scene_contact(scene, 0.0);
    const FcCoefficients at = fc_scene_coefficients_of(scene, &contact);
    return parts_at(scene, &at, regime, delta);
}

double fc_force(const FcScene* scene, const FcContactResponse* contact, FcBristle bristle) {
    const FcCoefficients coefficients = fc_scene_coefficients_of(scene, contact);
    const bool asks_for_rate = scene->friction->sigma_1 != 0.0;
    const Parts at =
        parts_at(scene, &coefficients, asks_for_rate ? fc_regime(scene, bristle) : FC_FREE, bristle.delta);
    return whole_force(scene->friction, &at);
}

FcMotion fc_motion(const FcScene* scene, FcRegime regime, double delta) {
    const Parts at = parts(scene, regime, delta);
    const double F_t = whole_force(scene->friction, &at);
    const double power = F_t * at.V;
    return (FcMotion){
        .F_t = F_t, .rates = {.delta = at.delta_rate, .W_f = power, .Q_f = power - at.force * at.delta_rate}};
}

// The derivative of ln g along the direction, by the normal force and by the Stribeck curve.
static double log_limit_along(const FcScene* scene, double V, double log_F_n, const FcDirection* along) {
    const FcFriction* friction = scene->friction;
    const double by_load = fc_limit_follows_load(friction) ? log_F_n : 0.0;
    if (!fc_has_stribeck_curve(friction)) {
        return by_load;
    }
    return by_load + fc_stribeck_slope(friction, V) / fc_stribeck(friction, V) * along->V;
}

// Of delta' = V - r delta, r = sigma |V| / g.
static double free_rate_along(const FcScene* scene, const FcCoefficients* at, double delta, double log_sigma,
                              double log_limit, const FcDirection* along) {
    if (scene->friction->model == FC_ELASTIC_PLASTIC) {
        return along->V;
    }
    const double r = fc_relaxation_rate(at);
    const double r_along = r * (log_sigma - log_limit) + fc_sign(at->V) * at->sigma / at->limit * along->V;
    return along->V - r_along * delta - r * along->delta;
}

// How a direction moves what the contact gives.
typedef struct {
    double log_sigma, log_F_n;
} ContactAlong;

static ContactAlong contact_along(const FcScene* scene, const FcDirection* along) {
    const FcLogSlopes slopes = fc_log_slopes(scene);
    const double E = along->E;
    const double d = along->d;
    const double load = along->load;
    return (ContactAlong){
        .log_sigma = slopes.by_d.sigma * d + slopes.by_E.sigma * E + slopes.by_load.sigma * load,
        .log_F_n = slopes.by_d.F_n * d + slopes.by_E.F_n * E + slopes.by_load.F_n * load,
    };
}

static double bound_rate_along(const FcScene* bound, const FcDirection* along) {
    const bool floats = bound->contact->input == FC_CONTACT_LOAD; // d is no input
    const double by[] = {along->V, floats ? 0.0 : along->d, along->E, along->load};
    const size_t input[] = {offsetof(FcDrive, V), offsetof(FcDrive, d), offsetof(FcDrive, E),
                            offsetof(FcDrive, load)};
    double change = 0.0;
    for (int k = 0; k < 4; k++) {
        change += by[k] != 0.0 ? by[k] * fc_bound_rate_slope(bound, input[k]) : 0.0;
    }
    return change;
}

// But for delta_rate.
static Parts slipping_along(const FcScene* bound, FcRegime regime, const ContactAlong* contact,
                            const FcDirection* along) {
    const FcCoefficients at = fc_scene_coefficients(bound, 0.0);
    const double log_limit = log_limit_along(bound, at.V, contact->log_F_n, along);
    return (Parts){.V = along->V, .force = (double)regime * at.limit * log_limit};
}

static Parts free_along(const FcScene* scene, double delta, const ContactAlong* contact,
                        const FcDirection* along) {
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    const double log_limit = log_limit_along(scene, at.V, contact->log_F_n, along);
    if (scene->friction->model == FC_COULOMB) {
        return (Parts){.V = along->V, .force = fc_sign(at.V) * at.limit * log_limit};
    }
    return (Parts){
        .V = along->V,
        .force = at.sigma * (contact->log_sigma * delta + along->delta),
        .delta_rate = free_rate_along(scene, &at, delta, contact->log_sigma, log_limit, along),
    };
}

static Parts parts_along(const FcScene* scene, FcRegime regime, double delta, const FcDirection* along) {
    if (fc_scene_is_loose(scene)) {
        return (Parts){.V = along->V};
    }
    const ContactAlong contact = contact_along(scene, along);
    if (regime == FC_FREE) {
        return free_along(scene, delta, &contact, along);
    }
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(scene, regime, &friction);
    Parts change = slipping_along(&bound, regime, &contact, along);
    change.delta_rate = (double)regime * bound_rate_along(&bound, along);
    return change;
}

FcMotion fc_motion_along(const FcScene* scene, FcRegime regime, double delta, const FcDirection* along) {
    const Parts at = parts(scene, regime, delta);
    const Parts change = parts_along(scene, regime, delta, along);
    const double F_t = whole_force(scene->friction, &at);
    const double F_t_along = whole_force(scene->friction, &change);
    const double power = F_t_along * at.V + F_t * change.V;
    const double stored = change.force * at.delta_rate + at.force * change.delta_rate;
    return (FcMotion){.F_t = F_t_along,
                      .rates = {.delta = change.delta_rate, .W_f = power, .Q_f = power - stored}};
}

double fc_bound_along(const FcScene* scene, FcBristle bristle, const FcDirection* along) {
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(scene, bristle.slips, &friction);
    const ContactAlong contact = contact_along(scene, along);
    const double V = fc_drive_V(&scene->drive, 0.0);
    return bristle.delta * (log_limit_along(&bound, V, contact.log_F_n, along) - contact.log_sigma);
}

// Second time derivative of the bound [m/s2], by a central difference of its rate, which is exact. Its pace is that of what moves
// it; away from surfaces that would touch.
static double bound_acceleration(const FcScene* bound) {
    const FcDrive* drive = &bound->drive;
    const FcLogRates rates = fc_scene_log_rates(bound, 0.0);
    double pace = drive->omega + fabs(rates.sigma) + fabs(rates.limit) + fc_drive_E_growth(drive, 0.0);
    if (drive->load.rate != 0.0) {
        pace += fc_drive_load_growth(drive, 0.0);
    }
    if (fc_has_stribeck_curve(bound->friction)) {
        pace += (fabs(drive->V.rate) + drive->omega * drive->vibration.V_1) / bound->friction->V_S;
    }
    double tau = 1e-4 / pace; // the error is some tau^2
    if (!isfinite(tau)) {     // it stands still, but for less than the smallest number
        return 0.0;
    }
    tau = copysign(tau, fc_scene_d_rate(bound, 0.0));
    const double apart = fc_bound_rate(bound, tau);
    if (fc_scene_d(bound, -tau) > 0.0) {
        return (apart - fc_bound_rate(bound, -tau)) / (2.0 * tau);
    }
    return (4.0 * apart - 3.0 * fc_bound_rate(bound, 0.0) - fc_bound_rate(bound, 2.0 * tau)) / (2.0 * tau);
}

double fc_force_rate(const FcScene* scene, FcBristle bristle) {
    const FcDrive* drive = &scene->drive;
    const FcRegime regime = fc_regime(scene, bristle);
    const FcDirection in_time = {
        .V = fc_drive_V_rate(drive, 0.0),
        .d = scene->contact->input == FC_CONTACT_LOAD ? 0.0 : fc_drive_d_rate(drive, 0.0),
        .E = drive->E.rate,
        .load = drive->load.rate,
        .delta = fc_motion(scene, regime, bristle.delta).rates.delta,
    };
    if (fc_scene_is_loose(scene)) {
        return scene->friction->sigma_2 * in_time.V;
    }
    ContactAlong contact = contact_along(scene, &in_time);
    if (scene->contact->input == FC_CONTACT_LOAD) { // which the vibration moves besides
        const FcContactLogSlope by_d = fc_contact_slope_by_d(&scene->at_E, fc_scene_d(scene, 0.0));
        contact.log_sigma += by_d.sigma * fc_drive_d_rate(drive, 0.0);
        contact.log_F_n += by_d.F_n * fc_drive_d_rate(drive, 0.0);
    }
    Parts change;
    if (regime == FC_FREE) {
        change = free_along(scene, bristle.delta, &contact, &in_time);
    } else {
        FcFriction friction;
        const FcScene bound = fc_scene_of_bound(scene, regime, &friction);
        change = slipping_along(&bound, regime, &contact, &in_time);
        change.delta_rate =
            scene->friction->sigma_1 != 0.0 ? (double)regime * bound_acceleration(&bound) : 0.0;
    }
    return whole_force(scene->friction, &change);
}
