// The scene: surfaces that float on a load, rates against differences, bounds against samples.
#include "model/scene.h"

#include "check.h"
#include "model/motion.h"
#include "table_1.h"

static const double F = 20e3; // Hz
static const double PERIOD = 5e-5;
static const double TWO_PI = 6.283185307179586;

static FcFriction law(int model, int limit) {
    return (FcFriction){.model = model,
                        .limit = limit,
                        .mu = 0.176,
                        .staticRatio = 1.5,
                        .V_S = 0.2,
                        .sigma_1 = 40.0,
                        .sigma_2 = 3.0};
}

// Everything moves: V, d, E, the load, both vibrations. The scene points into what the caller keeps.
static FcScene moving_scene(const FcContactParameters* contact, const FcFriction* friction, double rates) {
    FcScene scene = {.drive = {.V = {0.1, 900.0 * rates},
                               .d = {14e-6, 0.02 * rates},
                               .E = {9e9, 3e13 * rates},
                               .load = {312.0, -1e6 * rates},
                               .vibration = {.f = F, .V_1 = 0.3, .a_d = 1.1e-6, .phase_d = 0.7}}};
    fc_drive_start(&scene.drive, 0.3e-5, 0.0);
    const FcContactAtModulus at_E = fc_contact_at_modulus(contact, 9e9);
    fc_scene_make(&scene, contact, &at_E, friction, 55.0);
    return scene;
}

typedef struct {
    FcContactParameters contact;
    FcFriction friction;
} Kind;

enum { KINDS = 3 * 2 * 2 * 2 };

static Kind kind(int k) {
    const int models[] = {FC_CONTACT_ASPERITIES, FC_CONTACT_MINDLIN, FC_CONTACT_CONSTANT};
    return (Kind){.contact = table_1(models[k % 3], k / 3 % 2 ? FC_CONTACT_LOAD : FC_CONTACT_SEPARATION),
                  .friction =
                      law(k / 6 % 2 ? FC_LUGRE : FC_DAHL, k / 12 % 2 ? FC_LIMIT_LOAD : FC_LIMIT_CONSTANT)};
}

// Five-point differences over 1e-3 of a period, off by less than 1e-9 of omega.
static double slope(double (*quantity)(const FcScene*, double), const FcScene* scene, double t) {
    const double k = 1e-3 * PERIOD;
    return (8.0 * (quantity(scene, t + k) - quantity(scene, t - k)) -
            (quantity(scene, t + 2 * k) - quantity(scene, t - 2 * k))) /
           (12.0 * k);
}

// The mean of F_n over a period, at the rest separation of the time t, by the trapezoidal rule.
static double mean_load(const FcScene* scene, double t) {
    const FcContactAtModulus at_E = fc_contact_at_modulus(scene->contact, fc_drive_E(&scene->drive, t));
    const double angle = scene->drive.theta_0 + scene->drive.omega * t + 0.7;
    const double rest = fc_scene_d(scene, t) - 1.1e-6 * cos(angle);
    double sum = 0.0;
    for (int k = 0; k < 64; k++) {
        sum += fc_contact_response(&at_E, rest + 1.1e-6 * cos(TWO_PI * k / 64)).F_n;
    }
    return sum / 64;
}

static void surfaces_float_on_the_load(void) {
    const FcContactParameters contact = table_1(FC_CONTACT_MINDLIN, FC_CONTACT_LOAD);
    const FcFriction friction = law(FC_DAHL, FC_LIMIT_LOAD);
    for (double rates = 0.0; rates <= 1.0; rates += 1.0) {
        const FcScene scene = moving_scene(&contact, &friction, rates);
        for (double t = 0.0; t < 2.0 * PERIOD; t += 0.3 * PERIOD) {
            CHECK_NEAR(mean_load(&scene, t), 312.0 - 1e6 * rates * t, 1e-13);
        }
    }
    // The rise under 1.1 um: (R_q / lambda) ln I_0(0.55).
    FcScene scene = moving_scene(&contact, &friction, 0.0);
    const double raised = scene.drive.d.value;
    const double flat = log(scene.at_E.load_0 / 312.0) / scene.at_E.decay;
    CHECK_WITHIN(raised - flat, 0.1484829e-6, 1e-13);
}

static double log_stiffness(const FcScene* scene, double t) {
    return log(fc_scene_coefficients(scene, t).sigma);
}
static double bound(const FcScene* scene, double t) {
    FcPlane plane;
    fc_plane_make(&plane, scene);
    return fc_bound(&plane, 1, t).D;
}

static void rates_are_derivatives(void) {
    const double omega = TWO_PI * F;
    for (int k = 0; k < KINDS; k++) {
        Kind one = kind(k);
        if (one.friction.model == FC_LUGRE) { // the bound that follows a curve
            one.friction.model = FC_ELASTIC_PLASTIC;
        }
        const FcScene scene = moving_scene(&one.contact, &one.friction, 1.0);
        for (double t = 0.01 * PERIOD; t < PERIOD; t += 0.09 * PERIOD) {
            const FcLogRates rates = fc_scene_log_rates(&scene, t, fc_drive_phase(&scene.drive, t));
            CHECK_WITHIN(rates.sigma, slope(log_stiffness, &scene, t), 1e-8 * omega);
            CHECK_WITHIN(fc_scene_d_rate(&scene, t), slope(fc_scene_d, &scene, t), 1e-9 * omega * 1.1e-6);
            FcPlane plane;
            fc_plane_make(&plane, &scene);
            CHECK_WITHIN(fc_bound(&plane, 1, t).rate, slope(bound, &scene, t),
                         1e-7 * omega * bound(&scene, t));
        }
    }
}

static void bounds_hold(void) {
    const double h = 1.3 * PERIOD;
    for (int k = 0; k < KINDS; k++) {
        const Kind one = kind(k);
        for (double rates = -1.0; rates <= 1.0; rates += 1.0) {
            const FcScene scene = moving_scene(&one.contact, &one.friction, rates);
            double d = INFINITY, sigma = 0.0, limit = INFINITY, saturation = INFINITY;
            for (double t = 0.0; t <= h; t += 1e-3 * PERIOD) {
                const FcCoefficients at = fc_scene_coefficients(&scene, t);
                d = fmin(d, fc_scene_d(&scene, t));
                sigma = fmax(sigma, at.sigma);
                limit = fmin(limit, at.limit);
                saturation = fmin(saturation, at.limit / at.sigma);
            }
            const double rounding = 1.0 + 1e-14;
            CHECK(fc_scene_smallest_d(&scene, h) <= d * rounding);
            CHECK(fc_scene_largest_stiffness(&scene, h) * rounding >= sigma);
            CHECK(fc_scene_smallest_limit(&scene, h) <= limit * rounding);
            CHECK(fc_scene_smallest_saturation(&scene, h) <= saturation * rounding);
            // and are of use: not smaller than half of what is
            CHECK(fc_scene_smallest_d(&scene, h) >= 0.5 * d);
            CHECK(fc_scene_smallest_limit(&scene, h) >= 0.2 * limit);
        }
    }
}

int main(void) {
    surfaces_float_on_the_load();
    rates_are_derivatives();
    bounds_hold();
    return check_result();
}
