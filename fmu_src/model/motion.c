#include "model/motion.h"

#include <float.h>
#include <math.h>

#include "model/special.h"

static FcVector times(double factor, FcVector a) { return (FcVector){factor * a.x, factor * a.y}; }

// The part of a that is perpendicular to n, |n| = 1.
static FcVector perpendicular(FcVector a, FcVector n) { return fc_plus(a, -fc_product(a, n), n); }

// The parts of a motion, or their derivatives along a direction.
typedef struct {
    FcVector V;          // m/s
    FcVector force;      // N, F
    FcVector delta_rate; // m/s
    FcVector state_rate; // m/s, the same of a delta that lags behind the bound
} Parts;

static Parts slipping_parts(const FcAtBound* of, FcBristle bristle) {
    const FcVector turning = perpendicular(of->at.V, of->n);
    const FcVector rate = times(of->bound.rate, of->n);
    return (Parts){.V = of->at.V,
                   .force = times(of->bound.limit, of->n),
                   .delta_rate = fc_plus(rate, 1.0, turning),
                   .state_rate = fc_plus(rate, fc_size(bristle) / of->bound.D, turning)};
}

static Parts parts(const FcScene* scene, FcBristle bristle) {
    if (fc_scene_is_separated(scene)) {
        return (Parts){.V = {fc_drive_V(&scene->drive, 0.0), fc_drive_V_y(&scene->drive, 0.0)}};
    }
    if (bristle.state == FC_SLIPPING) {
        FcAtBound of;
        fc_at_bound(&of, scene, bristle);
        return slipping_parts(&of, bristle);
    }
    FcPlane plane;
    fc_plane_make(&plane, scene);
    const FcPlaneCoefficients at = fc_plane_coefficients(&plane, 0.0, fc_drive_phase(&scene->drive, 0.0));
    if (!fc_has_bristle(scene->friction)) {
        return (Parts){.V = at.V, .force = fc_plane_coulomb(&at)};
    }
    const FcVector delta = fc_delta(bristle);
    const FcVector rate = fc_plus(at.V, -fc_plane_relaxation(&plane, &at), delta);
    return (Parts){.V = at.V, .force = times(at.sigma, delta), .delta_rate = rate, .state_rate = rate};
}

// F_t and F_y; or their derivatives, if the parts are derivatives, since both are linear in the parts.
static FcVector whole_force(const FcFriction* friction, const Parts* of) {
    FcVector F = of->force;
    if (fc_has_bristle(friction) && friction->sigma_1 != 0.0) {
        F = fc_plus(F, friction->sigma_1, of->delta_rate);
    }
    return friction->sigma_2 != 0.0 ? fc_plus(F, friction->sigma_2, of->V) : F;
}

FcVector fc_force(const FcScene* scene, const FcContactResponse* contact, FcBristle bristle) {
    const FcFriction* friction = scene->friction;
    if (fc_has_bristle(friction) && friction->sigma_1 == 0.0 && friction->sigma_2 == 0.0) {
        return times(contact->sigma, fc_delta(bristle));
    }
    bristle.state = friction->sigma_1 != 0.0 ? fc_bristle_state(scene, bristle) : FC_FREE;
    const Parts at = parts(scene, bristle);
    return whole_force(friction, &at);
}

FcMotion fc_motion(const FcScene* scene, FcBristle bristle) {
    const Parts at = parts(scene, bristle);
    const FcVector F = whole_force(scene->friction, &at);
    const double power = fc_product(F, at.V);
    return (FcMotion){.force = F,
                      .rates = {.delta = at.state_rate.x,
                                .W_f = power,
                                .Q_f = power - fc_product(at.force, at.delta_rate),
                                .delta_y = at.state_rate.y}};
}

// a + factor b.
static FcContactLogSlope slope_plus(FcContactLogSlope a, double factor, FcContactLogSlope b) {
    return (FcContactLogSlope){a.sigma + factor * b.sigma, a.A_r + factor * b.A_r, a.F_n + factor * b.F_n};
}

FcContactLogSlope fc_contact_along(const FcScene* scene, const FcDirection* along) {
    FcContactLogSlope change = {.sigma = along->log_stiffness};
    const double now = scene->is_open ? 0.0 : fc_scene_d(scene, 0.0);
    if (!(now > 0.0)) { // open, or moved there in a scene that does not use it
        return change;
    }
    const FcDrive* drive = &scene->drive;
    const FcContactLogSlope by_d = fc_contact_slope_by_d(&scene->at_E, now);
    const FcContactLogSlope by_E = fc_contact_slope_by_E(scene->contact, drive->E.value);
    double d = along->swing;
    if (scene->contact->input == FC_CONTACT_SEPARATION) {
        d += along->d;
    } else { // d = (ln F_n(0) - ln load + ...) / decay
        const double decay = scene->at_E.decay;
        d += (by_E.F_n * along->E - along->load / drive->load.value) / decay;
        d += fc_bessel_ratio(decay * drive->vibration.a_d) * along->a_d;
    }
    change = along->E != 0.0 ? slope_plus(change, along->E, by_E) : change;
    return d != 0.0 ? slope_plus(change, d, by_d) : change;
}

// The derivative of ln s, Stribeck's curve at V, along the direction.
static double log_curve_along(const FcFriction* friction, FcVector V, const FcDirection* along) {
    if (!fc_has_stribeck_curve(friction) && along->staticRatio == 0.0) {
        return 0.0;
    }
    const double speed = hypot(V.x, V.y);
    const double speed_along = fc_product((FcVector){along->V, along->V_y}, fc_direction_or_zero(V));
    const double ratio = speed / friction->V_S;
    const double by_speed = fc_stribeck_slope(friction, speed) * (speed_along - ratio * along->V_S);
    return (by_speed + exp(fc_stribeck_log_peak(friction, speed)) * along->staticRatio) /
           fc_stribeck(friction, speed);
}

// The derivative of ln g, or of the limit of the bound: by the parameter of the limit, the normal force and the Stribeck
// curve, of which the static bound has the ratio.
static double log_limit_along(const FcFriction* friction, bool slips, FcVector V, double log_F_n,
                              const FcDirection* along) {
    const bool is_static = slips && !fc_may_stick(friction);
    return along->log_limit + (fc_limit_follows_load(friction) ? log_F_n : 0.0) +
           (is_static ? along->staticRatio / friction->staticRatio : log_curve_along(friction, V, along));
}

static Parts slipping_along(const FcAtBound* of, FcBristle bristle, double log_sigma, double log_limit,
                            const FcDirection* along) {
    const FcVector V = of->at.V;
    const FcVector n = of->n;
    const FcVector V_along = {along->V, along->V_y};
    const FcVector delta_along = {along->delta, along->delta_y};
    const double D = of->bound.D;
    const double limit = of->bound.limit;
    const double size = fc_size(bristle);
    const FcVector n_along =
        size > 0.0 ? times(1.0 / size, perpendicular(delta_along, n)) : (FcVector){0.0, 0.0};
    const FcVector turning = perpendicular(V, n);
    FcVector turning_along = perpendicular(V_along, n);
    turning_along = fc_plus(turning_along, -fc_product(V, n_along), n);
    turning_along = fc_plus(turning_along, -fc_product(V, n), n_along);
    const FcVector with_D = fc_plus(times(along->bound_rate, n), of->bound.rate, n_along);
    const double lag = size / D;
    const double lag_along = fc_product(delta_along, n) / D - lag * (log_limit - log_sigma);
    return (Parts){.V = V_along,
                   .force = fc_plus(times(limit * log_limit, n), limit, n_along),
                   .delta_rate = fc_plus(with_D, 1.0, turning_along),
                   .state_rate = fc_plus(fc_plus(with_D, lag, turning_along), lag_along, turning)};
}

static Parts free_along(const FcAtBound* of, FcBristle bristle, double log_sigma, double log_limit,
                        const FcDirection* along) {
    const FcPlaneCoefficients* at = &of->at;
    const FcFriction* friction = of->plane.scene->friction;
    const FcVector V_along = {along->V, along->V_y};
    const FcVector direction_of_V = fc_direction_or_zero(at->V);
    if (!fc_has_bristle(friction)) {
        FcVector turning = {0.0, 0.0};
        if (V_along.x != 0.0 || V_along.y != 0.0) { // at rest the force jumps: not a number
            turning =
                times(at->speed > 0.0 ? at->limit / at->speed : NAN, perpendicular(V_along, direction_of_V));
        }
        return (Parts){.V = V_along, .force = fc_plus(turning, at->limit * log_limit, direction_of_V)};
    }
    const FcVector delta = fc_delta(bristle);
    const FcVector delta_along = {along->delta, along->delta_y};
    FcVector rate = V_along; // of delta' = V - r delta, with r = sigma |V| / g
    if (fc_may_relax(friction)) {
        const double r = fc_plane_relaxation(&of->plane, at);
        const double r_along =
            r * (log_sigma - log_limit) + at->sigma / at->limit * fc_product(V_along, direction_of_V);
        rate = fc_plus(fc_plus(V_along, -r_along, delta), -r, delta_along);
    }
    return (Parts){.V = V_along,
                   .force = times(at->sigma, fc_plus(delta_along, log_sigma, delta)),
                   .delta_rate = rate,
                   .state_rate = rate};
}

static Parts parts_along(const FcScene* scene, FcBristle bristle, const FcDirection* along) {
    if (fc_scene_is_separated(scene)) {
        return (Parts){.V = {along->V, along->V_y}};
    }
    const bool slips = bristle.state == FC_SLIPPING;
    bristle.state = slips ? FC_SLIPPING : FC_FREE;
    FcAtBound of;
    fc_at_bound(&of, scene, bristle);
    const FcContactLogSlope by = fc_contact_along(scene, along);
    const double log_limit = log_limit_along(scene->friction, slips, of.at.V, by.F_n, along);
    return slips ? slipping_along(&of, bristle, by.sigma, log_limit, along)
                 : free_along(&of, bristle, by.sigma, log_limit, along);
}

FcMotion fc_motion_along(const FcScene* scene, FcBristle bristle, const FcDirection* along) {
    const Parts at = parts(scene, bristle);
    const Parts change = parts_along(scene, bristle, along);
    const FcVector F = whole_force(scene->friction, &at);
    FcVector F_along = fc_plus(whole_force(scene->friction, &change), along->sigma_2, at.V);
    if (fc_has_bristle(scene->friction)) {
        F_along = fc_plus(F_along, along->sigma_1, at.delta_rate);
    }
    const double power = fc_product(F_along, at.V) + fc_product(F, change.V);
    const double stored = fc_product(change.force, at.delta_rate) + fc_product(at.force, change.delta_rate);
    return (FcMotion){.force = F_along,
                      .rates = {.delta = change.state_rate.x,
                                .W_f = power,
                                .Q_f = power - stored,
                                .delta_y = change.state_rate.y}};
}

// Second time derivative of the bound [m/s2], by a central difference of its rate, which is exact. The
// difference is taken over the fastest change of an input, and away from surfaces that would touch.
static double bound_acceleration(const FcScene* scene) {
    const FcDrive* drive = &scene->drive;
    FcPlane plane;
    fc_plane_make(&plane, scene);
    const FcPlaneBound now = fc_bound(&plane, FC_SLIPPING, 0.0);
    double pace = drive->omega + fabs(now.log_sigma_rate) + fabs(now.rate / now.D + now.log_sigma_rate) +
                  fabs(drive->E.rate) / drive->E.value;
    if (drive->load.rate != 0.0) {
        pace += fabs(drive->load.rate) / drive->load.value;
    }
    if (fc_has_static_friction(scene->friction)) {
        const double across = fabs(drive->V_y.rate) + drive->omega * drive->vibration.V_2;
        pace += (fabs(drive->V.rate) + drive->omega * drive->vibration.V_1 + across) / scene->friction->V_S;
    }
    if (pace < DBL_MIN) { // it stands still
        return 0.0;
    }
    double tau = 1e-4 / pace; // the error is some tau^2
    tau = copysign(tau, fc_scene_d_rate(scene, 0.0));
    const double apart = fc_bound(&plane, FC_SLIPPING, tau).rate;
    if (fc_scene_d(scene, -tau) > 0.0) {
        return (apart - fc_bound(&plane, FC_SLIPPING, -tau).rate) / (2.0 * tau);
    }
    return (4.0 * apart - 3.0 * now.rate - fc_bound(&plane, FC_SLIPPING, 2.0 * tau).rate) / (2.0 * tau);
}

FcVector fc_force_rate(const FcScene* scene, FcBristle bristle) {
    const FcDrive* drive = &scene->drive;
    const FcPhase phase = fc_drive_phase(drive, 0.0);
    bristle.state = fc_bristle_state(scene, bristle);
    const FcStateRates rates = fc_motion(scene, bristle).rates;
    FcDirection in_time = {
        .V = fc_drive_velocity_at_phase(drive, 0.0, phase).rate,
        .d = drive->d.rate,
        .swing = fc_drive_d_rate_at_phase(drive, phase) - drive->d.rate,
        .E = drive->E.rate,
        .load = drive->load.rate,
        .delta = rates.delta,
        .V_y = fc_drive_velocity_y_at_phase(drive, 0.0, phase).rate,
        .delta_y = rates.delta_y,
    };
    if (bristle.state == FC_SLIPPING && scene->friction->sigma_1 != 0.0) {
        in_time.bound_rate = bound_acceleration(scene);
    }
    const Parts change = parts_along(scene, bristle, &in_time);
    return whole_force(scene->friction, &change);
}
