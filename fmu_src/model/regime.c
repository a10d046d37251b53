#include "model/regime.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

#include "model/derivatives.h"

FcScene fc_scene_of_bound(const FcScene* scene, int slips, FcFriction* friction) {
    FcScene bound = *scene;
    *friction = *scene->friction;
    if (friction->model != FC_COULOMB) { // whose contact may be open
        friction->model = FC_ELASTIC_PLASTIC;
    }
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
    const FcPhase phase = fc_drive_phase(&bound->drive, t);
    const FcCoefficients at = fc_scene_coefficients_at_phase(bound, t, phase);
    return at.limit / at.sigma * fc_scene_log_rates_at_phase(bound, t, phase).ratio;
}

double fc_push(const FcScene* scene, const FcScene* bound, double t, int side) {
    const FcPhase phase = fc_drive_phase(&scene->drive, t);
    const FcCoefficients at = fc_scene_coefficients_at_phase(scene, t, phase);
    const FcCoefficients of = bound == scene ? at : fc_scene_coefficients_at_phase(bound, t, phase);
    const double D = of.limit / of.sigma;
    const double rate = D * fc_scene_log_rates_at_phase(bound, t, phase).ratio;
    const double back = scene->friction->model == FC_ELASTIC_PLASTIC ? 0.0 : fc_relaxation_rate(&at) * D;
    return side * at.V - back - rate;
}

double fc_push_at(void* context, double t) {
    const FcPushed* of = context;
    return fc_push(of->scene, of->bound, t, of->side);
}

FcBound fc_bound_in_plane(const FcScene* bound, double t) {
    if (fc_drive_is_planar(&bound->drive)) {
        FcPlane plane;
        fc_plane_make(&plane, bound);
        const FcPhase phase = fc_drive_phase(&bound->drive, t);
        const FcPlaneCoefficients at = fc_plane_coefficients(&plane, t, phase);
        const FcPlaneBound of = fc_plane_bound(&plane, &at, 1, t, phase);
        return (FcBound){at.limit, of.D, of.rate};
    }
    const FcCoefficients at = fc_scene_coefficients(bound, t);
    return (FcBound){at.limit, at.limit / at.sigma, fc_bound_rate(bound, t)};
}

static FcVector direction(double x, double y) {
    const double size = hypot(x, y);
    return size > 0.0 ? (FcVector){x / size, y / size} : (FcVector){0.0, 0.0};
}

// The bound of a bristle at the start of a scene, and its push.
typedef struct {
    FcPlane plane;
    FcPhase phase;
    FcPlaneCoefficients at;
    FcPlaneBound bound;
    FcVector n; // the direction of the deflection, or that in which it slips along a line
} AtBound;

static void set_bound(AtBound* of, int slips) {
    of->bound = fc_plane_bound(&of->plane, &of->at, slips, 0.0, of->phase);
}

static double push(const AtBound* of) { return fc_plane_push(&of->plane, &of->at, &of->bound, of->n); }

// The result points into itself.
static void find_bound(AtBound* of, const FcScene* scene, FcBristle bristle) {
    fc_plane_make(&of->plane, scene);
    of->phase = fc_drive_phase(&scene->drive, 0.0);
    of->at = fc_plane_coefficients(&of->plane, 0.0, of->phase);
    of->n = bristle.slips != 0 && !fc_is_planar(scene, bristle) ? (FcVector){bristle.slips, 0.0}
                                                                : direction(bristle.delta, bristle.delta_y);
    set_bound(of, bristle.slips);
}

double fc_push_in_plane(const FcScene* scene, FcBristle bristle) {
    AtBound of;
    find_bound(&of, scene, bristle);
    return push(&of);
}

static FcBristle moved_onto(const AtBound* of, FcBristle bristle) {
    const FcVector n = direction(bristle.delta, bristle.delta_y);
    bristle.delta = of->bound.D * n.x;
    bristle.delta_y = of->bound.D * n.y;
    return bristle;
}

FcBristle fc_reach(const FcScene* scene, FcBristle bristle) {
    if (fc_scene_is_loose(scene)) {
        return (FcBristle){0};
    }
    if (!fc_is_bounded(scene->friction)) {
        return bristle;
    }
    AtBound of;
    find_bound(&of, scene, bristle);
    const double size = fc_size(bristle);
    if (size > of.bound.D) {
        if (fc_has_static_friction(scene->friction) && bristle.slips == 0 &&
            size > (1.0 + FC_ROUNDING_OF_BOUND) * of.bound.D) {
            bristle.slips = fc_is_planar(scene, bristle) ? 1 : fc_side(bristle);
            set_bound(&of, bristle.slips);
        }
        bristle = moved_onto(&of, bristle);
    }
    // A bristle with a push of 0 remains slipping. Its motion decides whether it sticks.
    if (bristle.slips != 0 && push(&of) < 0.0) {
        bristle.slips = 0;
    }
    return bristle;
}

FcBristle fc_onto_bound(const FcScene* scene, FcBristle bristle) {
    AtBound of;
    find_bound(&of, scene, bristle);
    return moved_onto(&of, bristle);
}

FcRegime fc_regime(const FcScene* scene, FcBristle bristle) {
    if (!fc_is_bounded(scene->friction) || fc_scene_is_loose(scene) ||
        (fc_has_static_friction(scene->friction) && bristle.slips == 0)) {
        return FC_FREE;
    }
    AtBound of;
    find_bound(&of, scene, bristle);
    const FcVector delta = {bristle.delta, bristle.delta_y};
    const bool on_bound = fc_product(of.n, delta) >= (1.0 - FC_INSIDE_BOUND) * of.bound.D;
    return on_bound && push(&of) > 0.0 ? (FcRegime)fc_side(bristle) : FC_FREE;
}

// The hysteresis of an event, over the bound and over the velocities: far above rounding, far below the
// tolerance of an integrator. Half or twice of it moves the events by as little.
static const double HYSTERESIS = 1e-10;

void fc_regime_indicators(const FcScene* scene, FcRegime regime, FcBristle bristle, double z[2]) {
    z[0] = z[1] = 1.0;
    if (!fc_is_bounded(scene->friction) || fc_scene_is_loose(scene)) {
        return;
    }
    FcFriction law;
    const FcScene of_bound = fc_scene_of_bound(scene, bristle.slips, &law);
    const FcBound bound = fc_bound_in_plane(&of_bound, 0.0);
    const int side = bristle.slips != 0 ? bristle.slips : (int)regime; // 0 for either
    if (regime == FC_FREE) {
        const bool has_side = side != 0 && !fc_is_planar(scene, bristle);
        const double size = has_side ? side * bristle.delta : fc_size(bristle);
        z[0] = (1.0 - size / bound.D) + HYSTERESIS;
    }
    if (side != 0) {
        const double speed = fc_drive_largest_speed(&scene->drive, 0.0) + fabs(bound.rate);
        z[1] = fc_push_in_plane(scene, bristle) + HYSTERESIS * speed;
    }
}

// The coefficients of the bristle's equation at the start of a scene.
typedef struct {
    FcVector V;   // m/s
    double speed; // m/s, |V|
    double sigma; // N/m
    double limit; // N, g
} Moment;

static Moment moment(const FcScene* scene, const FcContactResponse* contact) {
    if (fc_drive_is_planar(&scene->drive)) {
        FcPlane plane;
        fc_plane_make(&plane, scene);
        const FcPlaneCoefficients at = fc_plane_coefficients(&plane, 0.0, fc_drive_phase(&scene->drive, 0.0));
        return (Moment){at.V, at.speed, at.sigma, at.limit};
    }
    const FcCoefficients at = fc_scene_coefficients_of(scene, contact);
    return (Moment){{at.V, 0.0}, fabs(at.V), at.sigma, at.limit};
}

// The parts of a motion, or their derivatives along a direction.
typedef struct {
    FcVector V;          // m/s
    FcVector force;      // N, F
    FcVector delta_rate; // m/s
    FcVector state_rate; // m/s, the same of a delta that lags behind the bound
} Parts;

// a + factor b.
static FcVector plus(FcVector a, double factor, FcVector b) {
    return (FcVector){a.x + factor * b.x, a.y + factor * b.y};
}

static FcVector times(double factor, FcVector a) { return (FcVector){factor * a.x, factor * a.y}; }

// Without a transverse part it equals the product along, to the bit and with the sign of zero.
static double product(FcVector a, FcVector b) { return b.y == 0.0 ? a.x * b.x : fc_product(a, b); }

// The part of a that is perpendicular to n, |n| = 1.
static FcVector perpendicular(FcVector a, FcVector n) { return plus(a, -product(a, n), n); }

// For a slipping bristle.
static FcVector direction_of_slip(const FcScene* scene, FcRegime regime, FcBristle bristle) {
    return fc_is_planar(scene, bristle) ? direction(bristle.delta, bristle.delta_y)
                                        : (FcVector){(double)regime, 0.0};
}

static Parts slipping_parts(const FcScene* scene, const Moment* at, FcRegime regime, FcBristle bristle) {
    FcFriction friction;
    const FcScene of_bound = fc_scene_of_bound(scene, regime, &friction);
    const FcBound bound = fc_bound_in_plane(&of_bound, 0.0);
    const FcVector n = direction_of_slip(scene, regime, bristle);
    Parts parts = {.V = at->V, .force = times(bound.limit, n), .delta_rate = times(bound.rate, n)};
    parts.state_rate = parts.delta_rate;
    if (fc_is_planar(scene, bristle)) {
        const FcVector turning = perpendicular(at->V, n);
        parts.delta_rate = plus(parts.delta_rate, 1.0, turning);
        parts.state_rate = plus(parts.state_rate, fc_size(bristle) / bound.D, turning);
    }
    return parts;
}

// r = sigma |V| / g [1/s] of Dahl and LuGre.
static double relaxation_rate(const FcScene* scene, const Moment* at) {
    return scene->friction->model == FC_ELASTIC_PLASTIC ? 0.0 : at->sigma * at->speed / at->limit;
}

static Parts parts_of(const FcScene* scene, const FcContactResponse* contact, FcRegime regime,
                      FcBristle bristle) {
    if (fc_scene_is_loose(scene)) {
        return (Parts){.V = {fc_drive_V(&scene->drive, 0.0), fc_drive_V_y(&scene->drive, 0.0)}};
    }
    const Moment at = moment(scene, contact);
    if (scene->friction->model == FC_COULOMB) {
        return (Parts){.V = at.V, .force = times(at.limit, direction(at.V.x, at.V.y))};
    }
    if (regime != FC_FREE) {
        return slipping_parts(scene, &at, regime, bristle);
    }
    const FcVector delta = {bristle.delta, bristle.delta_y};
    const FcVector rate =
        scene->friction->model == FC_ELASTIC_PLASTIC ? at.V : plus(at.V, -relaxation_rate(scene, &at), delta);
    return (Parts){.V = at.V, .force = times(at.sigma, delta), .delta_rate = rate, .state_rate = rate};
}

// F_t and F_y; or their derivatives, if the parts are derivatives, since both are linear in the parts.
static FcVector whole_force(const FcFriction* friction, const Parts* of) {
    FcVector F = of->force;
    if (friction->model != FC_COULOMB && friction->sigma_1 != 0.0) {
        F = plus(F, friction->sigma_1, of->delta_rate);
    }
    return friction->sigma_2 != 0.0 ? plus(F, friction->sigma_2, of->V) : F;
}

static Parts parts(const FcScene* scene, FcRegime regime, FcBristle bristle) {
    const FcContactResponse contact = fc_scene_contact(scene, 0.0);
    return parts_of(scene, &contact, regime, bristle);
}

FcVector fc_force(const FcScene* scene, const FcContactResponse* contact, FcBristle bristle) {
    const FcFriction* friction = scene->friction;
    if (friction->model != FC_COULOMB && friction->sigma_1 == 0.0 && friction->sigma_2 == 0.0) {
        return times(contact->sigma, (FcVector){bristle.delta, bristle.delta_y});
    }
    const bool asks_for_rate = friction->sigma_1 != 0.0;
    const Parts at = parts_of(scene, contact, asks_for_rate ? fc_regime(scene, bristle) : FC_FREE, bristle);
    return whole_force(friction, &at);
}

FcMotion fc_motion(const FcScene* scene, FcRegime regime, FcBristle bristle) {
    const Parts at = parts(scene, regime, bristle);
    const FcVector F = whole_force(scene->friction, &at);
    const double power = product(F, at.V);
    return (FcMotion){.force = F,
                      .rates = {.delta = at.state_rate.x,
                                .W_f = power,
                                .Q_f = power - product(at.force, at.delta_rate),
                                .delta_y = at.state_rate.y}};
}

// The derivative of ln s, Stribeck's curve at V, along the direction.
static double log_curve_along(const FcFriction* friction, FcVector V, const FcDirection* along) {
    if (!fc_has_stribeck_curve(friction) && along->staticRatio == 0.0) {
        return 0.0;
    }
    const double speed = hypot(V.x, V.y);
    const double speed_along = product((FcVector){along->V, along->V_y}, direction(V.x, V.y));
    const double ratio = speed / friction->V_S;
    const double by_speed = fc_stribeck_slope(friction, speed) * (speed_along - ratio * along->V_S);
    return (by_speed + exp(-ratio * ratio) * along->staticRatio) / fc_stribeck(friction, speed);
}

// The derivative of ln g: by the parameter of the limit, the normal force and the Stribeck curve.
static double log_limit_along(const FcScene* scene, FcVector V, double log_F_n, const FcDirection* along) {
    const double by_load = fc_limit_follows_load(scene->friction) ? log_F_n : 0.0;
    return along->log_limit + by_load + log_curve_along(scene->friction, V, along);
}

// The derivative of delta' = V - r delta along the direction, with r = sigma |V| / g.
static FcVector free_rate_along(const FcScene* scene, const Moment* at, FcVector delta, double log_sigma,
                                double log_limit, const FcDirection* along) {
    const FcVector V_along = {along->V, along->V_y};
    if (scene->friction->model == FC_ELASTIC_PLASTIC) {
        return V_along;
    }
    const double r = relaxation_rate(scene, at);
    const double r_along =
        r * (log_sigma - log_limit) + at->sigma / at->limit * product(V_along, direction(at->V.x, at->V.y));
    return plus(plus(V_along, -r_along, delta), -r, (FcVector){along->delta, along->delta_y});
}

// The direction for a scene of the bound: the static bound has no curve, but the ratio as a factor.
static FcDirection direction_of_bound(const FcScene* scene, FcDirection along) {
    if (scene->friction->model != FC_ELASTIC_PLASTIC) {
        along.log_limit += along.staticRatio != 0.0 ? along.staticRatio / scene->friction->staticRatio : 0.0;
        along.staticRatio = 0.0;
    }
    return along;
}

static Parts slipping_along(const FcScene* scene, const FcScene* of_bound, FcRegime regime, FcBristle bristle,
                            const FcContactLogSlope* contact, const FcDirection* along) {
    const FcBound bound = fc_bound_in_plane(of_bound, 0.0);
    const FcContactResponse now = fc_scene_contact(scene, 0.0);
    const FcVector V = moment(scene, &now).V;
    const FcDirection along_bound = direction_of_bound(scene, *along);
    const double log_limit = log_limit_along(of_bound, V, contact->F_n, &along_bound);
    const FcVector V_along = {along->V, along->V_y};
    const FcVector delta_along = {along->delta, along->delta_y};
    const FcVector n = direction_of_slip(scene, regime, bristle);
    const double size = fc_size(bristle);
    const FcVector n_along =
        size > 0.0 ? times(1.0 / size, perpendicular(delta_along, n)) : (FcVector){0.0, 0.0};
    const FcVector turning = perpendicular(V, n);
    FcVector turning_along = perpendicular(V_along, n);
    turning_along = plus(turning_along, -product(V, n_along), n);
    turning_along = plus(turning_along, -product(V, n), n_along);
    const FcVector with_D = plus(times(along->bound_rate, n), bound.rate, n_along);
    const double lag = size / bound.D;
    const double lag_along = product(delta_along, n) / bound.D - lag * (log_limit - contact->sigma);
    return (Parts){.V = V_along,
                   .force = plus(times(bound.limit * log_limit, n), bound.limit, n_along),
                   .delta_rate = plus(with_D, 1.0, turning_along),
                   .state_rate = plus(plus(with_D, lag, turning_along), lag_along, turning)};
}

static Parts free_along(const FcScene* scene, FcBristle bristle, const FcContactLogSlope* contact,
                        const FcDirection* along) {
    const FcContactResponse now = fc_scene_contact(scene, 0.0);
    const Moment at = moment(scene, &now);
    const double log_limit = log_limit_along(scene, at.V, contact->F_n, along);
    const FcVector V_along = {along->V, along->V_y};
    if (scene->friction->model == FC_COULOMB) {
        const FcVector n = direction(at.V.x, at.V.y);
        FcVector turning = {0.0, 0.0};
        if (V_along.x != 0.0 || V_along.y != 0.0) { // at rest the force jumps: not a number
            turning = times(at.limit / at.speed, perpendicular(V_along, n));
        }
        return (Parts){.V = V_along, .force = plus(turning, at.limit * log_limit, n)};
    }
    const FcVector delta = {bristle.delta, bristle.delta_y};
    const FcVector delta_along = {along->delta, along->delta_y};
    const FcVector rate = free_rate_along(scene, &at, delta, contact->sigma, log_limit, along);
    return (Parts){
        .V = V_along,
        .force = times(at.sigma, plus(delta_along, contact->sigma, delta)),
        .delta_rate = rate,
        .state_rate = rate,
    };
}

static Parts parts_along(const FcScene* scene, FcRegime regime, FcBristle bristle, const FcDirection* along) {
    if (fc_scene_is_loose(scene)) {
        return (Parts){.V = {along->V, along->V_y}};
    }
    const FcContactLogSlope contact = fc_contact_along(scene, along);
    if (regime == FC_FREE) {
        return free_along(scene, bristle, &contact, along);
    }
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(scene, regime, &friction);
    return slipping_along(scene, &bound, regime, bristle, &contact, along);
}

FcMotion fc_motion_along(const FcScene* scene, FcRegime regime, FcBristle bristle, const FcDirection* along) {
    const Parts at = parts(scene, regime, bristle);
    const Parts change = parts_along(scene, regime, bristle, along);
    const FcVector F = whole_force(scene->friction, &at);
    FcVector F_along = plus(whole_force(scene->friction, &change), along->sigma_2, at.V);
    if (scene->friction->model != FC_COULOMB) {
        F_along = plus(F_along, along->sigma_1, at.delta_rate);
    }
    const double power = product(F_along, at.V) + product(F, change.V);
    const double stored = product(change.force, at.delta_rate) + product(at.force, change.delta_rate);
    return (FcMotion){.force = F_along,
                      .rates = {.delta = change.state_rate.x,
                                .W_f = power,
                                .Q_f = power - stored,
                                .delta_y = change.state_rate.y}};
}

// Second time derivative of the bound [m/s2], by a central difference of its rate, which is exact. The
// difference is taken over the fastest change of an input, and away from surfaces that would touch.
static double bound_acceleration(const FcScene* bound) {
    const FcDrive* drive = &bound->drive;
    const FcLogRates rates = fc_scene_log_rates(bound, 0.0);
    double pace = drive->omega + fabs(rates.sigma) + fabs(rates.limit) + fc_drive_E_growth(drive, 0.0);
    if (drive->load.rate != 0.0) {
        pace += fc_drive_load_growth(drive, 0.0);
    }
    if (fc_has_stribeck_curve(bound->friction)) {
        const double across = fabs(drive->V_y.rate) + drive->omega * drive->vibration.V_2;
        pace += (fabs(drive->V.rate) + drive->omega * drive->vibration.V_1 + across) / bound->friction->V_S;
    }
    if (pace < DBL_MIN) { // it stands still
        return 0.0;
    }
    double tau = 1e-4 / pace; // the error is some tau^2
    tau = copysign(tau, fc_scene_d_rate(bound, 0.0));
    const double apart = fc_bound_in_plane(bound, tau).rate;
    if (fc_scene_d(bound, -tau) > 0.0) {
        return (apart - fc_bound_in_plane(bound, -tau).rate) / (2.0 * tau);
    }
    return (4.0 * apart - 3.0 * fc_bound_in_plane(bound, 0.0).rate -
            fc_bound_in_plane(bound, 2.0 * tau).rate) /
           (2.0 * tau);
}

FcVector fc_force_rate(const FcScene* scene, FcBristle bristle) {
    const FcDrive* drive = &scene->drive;
    const FcRegime regime = fc_regime(scene, bristle);
    const FcStateRates rates = fc_motion(scene, regime, bristle).rates;
    FcDirection in_time = {
        .V = fc_drive_V_rate(drive, 0.0),
        .d = drive->d.rate,
        .swing = fc_drive_d_rate(drive, 0.0) - drive->d.rate,
        .E = drive->E.rate,
        .load = drive->load.rate,
        .delta = rates.delta,
        .V_y = fc_drive_velocity_y_at_phase(drive, 0.0, fc_drive_phase(drive, 0.0)).rate,
        .delta_y = rates.delta_y,
    };
    if (regime != FC_FREE && scene->friction->sigma_1 != 0.0) {
        FcFriction friction;
        const FcScene bound = fc_scene_of_bound(scene, regime, &friction);
        in_time.bound_rate = bound_acceleration(&bound);
    }
    const Parts change = parts_along(scene, regime, bristle, &in_time);
    return whole_force(scene->friction, &change);
}
