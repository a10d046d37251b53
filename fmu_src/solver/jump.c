#include "solver/jump.h"

#include <math.h>

#include "solver/panels/panel_tables.h"

FcPast fc_past(const FcScene* scene) {
    if (fc_scene_is_loose(scene)) {
        return (FcPast){.sigma = 0.0};
    }
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    return (FcPast){.d = fc_scene_depends_on_d(scene) ? fc_scene_d(scene, 0.0) : 0.0,
                    .V = at.V,
                    .E = scene->drive.E.value,
                    .limit = at.limit / fc_stribeck(scene->friction, at.V),
                    .sigma = at.sigma};
}

// The way from the past to the scene, its places from 0 to 1.
typedef struct {
    const FcScene* scene;
    FcPast past;
    double d, V, E;              // by which they change
    double log_limit, log_sigma; // by which parameters change them
    int slips;                   // whose bound is meant
} Ramp;

typedef struct {
    double limit; // N, of the bound
    double sigma; // N/m
    double D;     // m
    double rate;  // m, of D along the ramp
} Place;

static Place at_place(const Ramp* ramp, double s) {
    const FcScene* scene = ramp->scene;
    const FcFriction* friction = scene->friction;
    const double d = ramp->past.d + s * ramp->d;
    const double E = ramp->past.E + s * ramp->E;
    const double V = ramp->past.V + s * ramp->V;
    const bool follows_load = fc_limit_follows_load(friction);
    Place at = {.limit = scene->F_C, .sigma = scene->at_E.stiffness_0};
    double rate = ramp->log_limit - ramp->log_sigma;
    if (fc_scene_depends_on_d(scene)) {
        const FcContactAtModulus at_E =
            ramp->E == 0.0 ? scene->at_E : fc_contact_at_modulus(scene->contact, E);
        const FcContactResponse response = fc_contact_response(&at_E, d);
        const FcContactLogSlope by_d = fc_contact_slope_by_d(&at_E, d);
        at.sigma = response.sigma;
        rate -= by_d.sigma * ramp->d;
        if (follows_load) {
            at.limit = friction->mu * response.F_n;
            rate += by_d.F_n * ramp->d;
        }
        if (ramp->E != 0.0) {
            const FcContactLogSlope by_E = fc_contact_slope_by_E(scene->contact, E);
            rate += ((follows_load ? by_E.F_n : 0.0) - by_E.sigma) * ramp->E;
        }
    }
    at.sigma *= exp((s - 1.0) * ramp->log_sigma);
    at.limit *= exp((s - 1.0) * ramp->log_limit);
    if (fc_has_static_friction(friction) && ramp->slips != 0) {
        at.limit *= fc_stribeck(friction, V);
        rate += fc_stribeck_slope(friction, V) / fc_stribeck(friction, V) * ramp->V;
    } else {
        at.limit *= fc_static_ratio(friction);
    }
    at.D = at.limit / at.sigma;
    at.rate = at.D * rate;
    return at;
}

static Ramp ramp_from(const FcScene* scene, const FcPast* past, int slips) {
    const FcPast now = fc_past(scene);
    Ramp ramp = {.scene = scene, .past = *past, .slips = 0};
    ramp.d = now.d - past->d;
    ramp.V = now.V - past->V;
    ramp.E = now.E - past->E;
    const Place start = at_place(&ramp, 0.0); // with the parameters of now
    ramp.log_limit = log(start.limit / (fc_static_ratio(scene->friction) * past->limit));
    ramp.log_sigma = log(start.sigma / past->sigma);
    ramp.slips = slips;
    return ramp;
}

// The place at which the bound comes to lie below |delta|, which it does by the end: by the secant rule, halved where that is slow.
static double where_met(const Ramp* ramp, double delta) {
    double a = 0.0;
    double b = 1.0;
    double at_a = at_place(ramp, a).D - delta;
    double at_b = at_place(ramp, b).D - delta;
    if (!(at_a > 0.0)) {
        return 0.0;
    }
    for (int i = 0; i < 100 && b - a > 1e-15; i++) {
        const double s = i % 3 == 2 ? 0.5 * (a + b) : a + (b - a) * at_a / (at_a - at_b);
        if (!(s > a && s < b)) {
            break;
        }
        const double at_s = at_place(ramp, s).D - delta;
        if (at_s > 0.0) {
            a = s;
            at_a = at_s;
        } else {
            b = s;
            at_b = at_s;
        }
    }
    return b;
}

// The integral of g |dD| from the place s on: by panels over which D and g move by e at the most.
static double heat_from(const Ramp* ramp, double s) {
    const Place start = at_place(ramp, s);
    const Place end = at_place(ramp, 1.0);
    const double panels =
        ceil(fabs(log(end.D / start.D)) + fabs(log(end.limit / start.limit)) + 1e-3); // at least one
    const FcGaussRule* rule = &FC_GAUSS_12;
    const double length = (1.0 - s) / panels;
    double heat = 0.0;
    for (double k = 0.0; k < panels; k += 1.0) {
        for (int i = 0; i < 12; i++) {
            const Place at = at_place(ramp, s + (k + 0.5 + rule->node[i]) * length);
            heat += rule->weight[i] * length * at.limit * fabs(at.rate);
        }
    }
    return heat;
}

FcBristle fc_jump(const FcScene* scene, const FcPast* past, FcBristle bristle, double* heat) {
    const FcBristle reached = fc_reach(scene, bristle);
    const double delta = fabs(bristle.delta);
    const double D = fabs(reached.delta);
    *heat = 0.0;
    if (D == delta) {
        return reached;
    }
    const double sigma = fc_scene_contact(scene, 0.0).sigma;
    if (past->sigma == 0.0 ||
        fc_scene_is_loose(scene)) { // an open contact has no stiffness, or a constant one
        *heat = 0.5 * sigma * (delta - D) * (delta + D);
        return reached;
    }
    const bool breaks_away = fc_has_static_friction(scene->friction) && bristle.slips == 0;
    Ramp ramp = ramp_from(scene, past, bristle.slips);
    const double s = where_met(&ramp, delta);
    if (breaks_away) {
        ramp.slips = bristle.delta < 0.0 ? -1 : 1;
        const Place at = at_place(&ramp, s);
        *heat = 0.5 * at.sigma * (delta - at.D) * (delta + at.D);
    }
    *heat += heat_from(&ramp, s);
    return reached;
}
