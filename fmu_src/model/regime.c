#include "model/regime.h"

#include <stddef.h>

#include "model/derivatives.h"

// What a motion is made of, or their derivatives along a direction.
typedef struct {
    double V;          // m/s
    double force;      // N, F
    double delta_rate; // m/s
} Parts;

static double free_rate(const FcScene* scene, const FcCoefficients* at, double delta) {
    return scene->friction->model == FC_ELASTIC_PLASTIC ? at->V : at->V - fc_relaxation_rate(at) * delta;
}

static Parts parts(const FcScene* scene, FcRegime regime, double delta) {
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    if (scene->friction->model == FC_COULOMB) {
        return (Parts){.V = at.V, .force = fc_sign(at.V) * at.limit};
    }
    if (regime == FC_FREE) {
        return (Parts){.V = at.V, .force = at.sigma * delta, .delta_rate = free_rate(scene, &at, delta)};
    }
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(scene, &friction);
    return (Parts){.V = at.V,
                   .force = (double)regime * fc_scene_coefficients(&bound, 0.0).limit,
                   .delta_rate = (double)regime * fc_scene_bound_rate(scene, 0.0)};
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

static double bound_rate_along(const FcScene* scene, const FcDirection* along) {
    const bool floats = scene->contact->input == FC_CONTACT_LOAD; // d is no input
    const double by[] = {along->V, floats ? 0.0 : along->d, along->E, along->load};
    const size_t input[] = {offsetof(FcDrive, V), offsetof(FcDrive, d), offsetof(FcDrive, E),
                            offsetof(FcDrive, load)};
    double change = 0.0;
    for (int k = 0; k < 4; k++) {
        change += by[k] != 0.0 ? by[k] * fc_bound_rate_slope(scene, input[k]) : 0.0;
    }
    return change;
}

static Parts slipping_along(const FcScene* scene, FcRegime regime, const ContactAlong* contact,
                            const FcDirection* along) {
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(scene, &friction);
    const FcCoefficients at = fc_scene_coefficients(&bound, 0.0);
    const double log_limit = log_limit_along(&bound, at.V, contact->log_F_n, along);
    return (Parts){.V = along->V,
                   .force = (double)regime * at.limit * log_limit,
                   .delta_rate = (double)regime * bound_rate_along(scene, along)};
}

static Parts parts_along(const FcScene* scene, FcRegime regime, double delta, const FcDirection* along) {
    const ContactAlong contact = contact_along(scene, along);
    if (regime != FC_FREE) {
        return slipping_along(scene, regime, &contact, along);
    }
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    const double log_limit = log_limit_along(scene, at.V, contact.log_F_n, along);
    if (scene->friction->model == FC_COULOMB) {
        return (Parts){.V = along->V, .force = fc_sign(at.V) * at.limit * log_limit};
    }
    return (Parts){
        .V = along->V,
        .force = at.sigma * (contact.log_sigma * delta + along->delta),
        .delta_rate = free_rate_along(scene, &at, delta, contact.log_sigma, log_limit, along),
    };
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

double fc_regime_bound(const FcScene* scene) {
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(scene, &friction);
    const FcCoefficients at = fc_scene_coefficients(&bound, 0.0);
    return at.limit / at.sigma;
}

double fc_regime_push(const FcScene* scene, int side) {
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    const double D = fc_regime_bound(scene);
    return side * free_rate(scene, &at, side * D) - fc_scene_bound_rate(scene, 0.0);
}
