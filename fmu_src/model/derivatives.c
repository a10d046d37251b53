#include "model/derivatives.h"

#include <math.h>
#include <stddef.h>

// Rate [1/s] at which what the bound depends on moves.
static double pace_of_bound(const FcScene* scene) {
    const FcDrive* drive = &scene->drive;
    const FcLogRates rates = fc_scene_log_rates(scene, 0.0);
    double pace = drive->omega + fabs(rates.sigma) + fabs(rates.limit) + fc_drive_E_growth(drive, 0.0);
    if (drive->load.rate != 0.0) {
        pace += fc_drive_load_growth(drive, 0.0);
    }
    if (fc_has_stribeck_curve(scene->friction)) {
        pace += (fabs(drive->V.rate) + drive->omega * drive->vibration.V_1) / scene->friction->V_S;
    }
    return pace;
}

// Second time derivative of the bound [m/s2], by differences of its rate, which is exact: central, or away from
// surfaces that would touch.
static double bound_acceleration(const FcScene* scene) {
    double tau = 1e-4 / pace_of_bound(scene); // the error is some tau^2
    if (!isfinite(tau)) {                     // it stands still, but for less than the smallest number
        return 0.0;
    }
    tau = copysign(tau, fc_scene_d_rate(scene, 0.0));
    const double apart = fc_scene_bound_rate(scene, tau);
    if (fc_scene_d(scene, -tau) > 0.0) {
        return (apart - fc_scene_bound_rate(scene, -tau)) / (2.0 * tau);
    }
    return (4.0 * apart - 3.0 * fc_scene_bound_rate(scene, 0.0) - fc_scene_bound_rate(scene, 2.0 * tau)) /
           (2.0 * tau);
}

// Slipping along side times the bound.
static double slip_force_rate(const FcScene* scene, double side) {
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(scene, &friction);
    const double sigma_1 = scene->friction->sigma_1;
    const double damping = sigma_1 != 0.0 ? sigma_1 * bound_acceleration(&bound) : 0.0;
    return side *
           (fc_scene_coefficients(&bound, 0.0).limit * fc_scene_log_rates(&bound, 0.0).limit + damping);
}

// delta' = V.
static double stuck_force_rate(const FcScene* scene, double delta) {
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    const double sigma_1 = scene->friction->sigma_1;
    const double damping = sigma_1 != 0.0 ? sigma_1 * fc_drive_V_rate(&scene->drive, 0.0) : 0.0;
    return at.sigma * (fc_scene_log_rates(scene, 0.0).sigma * delta + at.V) + damping;
}

// F = sigma delta + sigma_1 delta', delta' = rate delta + V.
static double affine_force_rate(const FcScene* scene, double delta) {
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    const FcLogRates rates = fc_scene_log_rates(scene, 0.0);
    const double rate = -fc_relaxation_rate(&at);
    const double delta_rate = rate * delta + at.V;
    double damping = 0.0;
    if (scene->friction->sigma_1 != 0.0) {
        const double V_rate = fc_drive_V_rate(&scene->drive, 0.0);
        const double rate_rate =
            rate * (rates.sigma - rates.limit) - fc_sign(at.V) * at.sigma / at.limit * V_rate;
        damping = scene->friction->sigma_1 * (V_rate + rate_rate * delta + rate * delta_rate);
    }
    return at.sigma * (rates.sigma * delta + delta_rate) + damping;
}

// The deflection of a bristle that an input may have pushed beyond its bound, which it lies on then.
static double within_bound(const FcScene* scene, double delta) {
    if (!fc_is_bounded(scene->friction)) {
        return delta;
    }
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    const double bound = at.limit * fc_bound_over_limit(scene->friction, at.V) / at.sigma;
    return fmax(-bound, fmin(bound, delta));
}

double fc_force_rate(const FcScene* scene, double delta) {
    const FcFriction* friction = scene->friction;
    delta = within_bound(scene, delta);
    const double viscous =
        friction->sigma_2 != 0.0 ? friction->sigma_2 * fc_drive_V_rate(&scene->drive, 0.0) : 0.0;
    const double side = fc_scene_slip_side(scene, 0.0, delta);
    if (side != 0.0) {
        return slip_force_rate(scene, side) + viscous;
    }
    if (friction->model == FC_ELASTIC_PLASTIC) {
        return stuck_force_rate(scene, delta) + viscous;
    }
    if (friction->model == FC_COULOMB) {
        const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
        return fc_sign(at.V) * at.limit * fc_scene_log_rates(scene, 0.0).limit + viscous;
    }
    return affine_force_rate(scene, delta) + viscous;
}

static FcContactLogSlope times(FcContactLogSlope slope, double factor) {
    return (FcContactLogSlope){slope.sigma * factor, slope.A_r * factor, slope.F_n * factor};
}

static FcContactLogSlope plus(FcContactLogSlope a, FcContactLogSlope b) {
    return (FcContactLogSlope){a.sigma + b.sigma, a.A_r + b.A_r, a.F_n + b.F_n};
}

FcLogSlopes fc_log_slopes(const FcScene* scene) {
    const FcDrive* drive = &scene->drive;
    const FcContactLogSlope by_d = fc_contact_slope_by_d(&scene->at_E, fc_scene_d(scene, 0.0));
    const FcContactLogSlope by_E = fc_contact_slope_by_E(scene->contact, drive->E.value);
    if (scene->contact->input == FC_CONTACT_SEPARATION) {
        return (FcLogSlopes){.by_d = by_d, .by_E = by_E};
    }
    // d = (ln F_n(0) - ln load + ...) / decay
    const double decay = scene->at_E.decay;
    return (FcLogSlopes){
        .by_E = plus(by_E, times(by_d, by_E.F_n / decay)),
        .by_load = times(by_d, -1.0 / (decay * drive->load.value)),
    };
}

// F_t of Dahl and LuGre: sigma delta + sigma_1 (V - sigma |V| delta / g).
static double affine_force_slope(const FcScene* scene, const FcCoefficients* at, double delta,
                                 double log_sigma, double log_limit) {
    const double sigma_1 = scene->friction->sigma_1;
    const double damping =
        sigma_1 != 0.0 ? sigma_1 * fc_relaxation_rate(at) * delta * (log_limit - log_sigma) : 0.0;
    return at->sigma * delta * log_sigma + damping;
}

// The side of the bound that the elastic force is, since the bristle slips along it or has been pushed beyond it; or 0.
static double side_of_bound(const FcScene* scene, double delta) {
    const double side = fc_scene_slip_side(scene, 0.0, delta);
    return side == 0.0 && within_bound(scene, delta) != delta ? fc_sign(delta) : side;
}

// Of the elastic force and of the damping but where the bristle slips. The damping of one that lies on its bound and leaves
// it, sigma_1 (V - |V| bound / g), depends on V alone.
static double force_slope(const FcScene* scene, double delta, const FcContactLogSlope* slope) {
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    const double log_limit = fc_limit_follows_load(scene->friction) ? slope->F_n : 0.0;
    if (scene->friction->model == FC_COULOMB) {
        return fc_sign(at.V) * at.limit * log_limit;
    }
    const double side = side_of_bound(scene, delta);
    if (side != 0.0) {
        return side * at.limit * fc_bound_over_limit(scene->friction, at.V) * log_limit;
    }
    return scene->friction->model == FC_ELASTIC_PLASTIC
               ? at.sigma * delta * slope->sigma
               : affine_force_slope(scene, &at, delta, slope->sigma, log_limit);
}

// The rate of the bound with one input changed.
static double bound_rate_with(const FcScene* scene, size_t input, double value) {
    FcDrive drive = scene->drive;
    ((FcLinearInput*)(void*)((char*)&drive + input))->value = value;
    const FcContactAtModulus at_E = fc_contact_at_modulus(scene->contact, drive.E.value);
    const FcScene moved = fc_scene_make(scene->contact, &at_E, scene->friction, scene->F_C, &drive);
    return fc_scene_bound_rate(&moved, 0.0);
}

double fc_bound_rate_slope(const FcScene* scene, size_t input) {
    const double value = ((const FcLinearInput*)(const void*)((const char*)&scene->drive + input))->value;
    const double change = input == offsetof(FcDrive, V) ? 1e-5 * scene->friction->V_S : 1e-5 * value;
    return (bound_rate_with(scene, input, value + change) - bound_rate_with(scene, input, value - change)) /
           (2.0 * change);
}

// The damping of a bristle that slips is sigma_1 times the rate of the bound.
static double slip_damping_slope(const FcScene* scene, double side, size_t input) {
    const double sigma_1 = scene->friction->sigma_1;
    return sigma_1 == 0.0 || side == 0.0 ? 0.0 : side * sigma_1 * fc_bound_rate_slope(scene, input);
}

// The elastic part depends on V where it is a bound with a Stribeck curve.
static double force_slope_by_V(const FcScene* scene, double delta) {
    const FcFriction* friction = scene->friction;
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    const double log_limit = fc_stribeck_slope(friction, at.V) / fc_stribeck(friction, at.V);
    const bool has_curve = friction->model == FC_ELASTIC_PLASTIC && fc_has_stribeck_curve(friction);
    const double elastic = has_curve ? side_of_bound(scene, delta) * at.limit * log_limit : 0.0;
    if (friction->model == FC_COULOMB || friction->sigma_1 == 0.0 ||
        fc_scene_slip_side(scene, 0.0, delta) != 0.0) {
        return friction->sigma_2 + elastic;
    }
    if (friction->model == FC_ELASTIC_PLASTIC) {
        return friction->sigma_2 + elastic + friction->sigma_1;
    }
    const double rate_slope = -fc_sign(at.V) * at.sigma / at.limit + fc_relaxation_rate(&at) * log_limit;
    return friction->sigma_2 + friction->sigma_1 * (1.0 + rate_slope * within_bound(scene, delta));
}

static FcSlopes slopes(const FcScene* scene, const FcContactResponse* now, double delta,
                       const FcContactLogSlope* slope) {
    return (FcSlopes){
        .F_t = force_slope(scene, delta, slope),
        .F_n = now->F_n * slope->F_n,
        .sigma = now->sigma * slope->sigma,
        .A_r = now->A_r * slope->A_r,
    };
}

FcGradient fc_gradient(const FcScene* scene, double delta) {
    const FcContactResponse now = fc_scene_contact(scene, 0.0);
    const FcLogSlopes logs = fc_log_slopes(scene);
    FcGradient gradient = {
        .by_V = {.F_t = force_slope_by_V(scene, delta)},
        .by_d = slopes(scene, &now, delta, &logs.by_d),
        .by_E = slopes(scene, &now, delta, &logs.by_E),
        .by_load = slopes(scene, &now, delta, &logs.by_load),
    };
    const double side = fc_scene_slip_side(scene, 0.0, delta);
    if (scene->friction->model == FC_ELASTIC_PLASTIC && fc_has_stribeck_curve(scene->friction)) {
        gradient.by_V.F_t += slip_damping_slope(scene, side, offsetof(FcDrive, V));
    }
    gradient.by_E.F_t += slip_damping_slope(scene, side, offsetof(FcDrive, E));
    if (scene->contact->input == FC_CONTACT_LOAD) {
        gradient.by_load.F_t += slip_damping_slope(scene, side, offsetof(FcDrive, load));
    } else {
        gradient.by_d.F_t += slip_damping_slope(scene, side, offsetof(FcDrive, d));
    }
    return gradient;
}
