// The scene: the laws' limits and forces, surfaces that float on a load, rates against differences, bounds.
#include "model/scene.h"

#include "check.h"
#include "moving_scene.h"

static void limits_of_the_laws(void) {
    const FcContactParameters contact = table_1(FC_CONTACT_ASPERITIES, FC_CONTACT_SEPARATION);
    const FcFriction dahl = law(FC_DAHL, FC_LIMIT_CONSTANT);
    const FcFriction lugre = law(FC_LUGRE, FC_LIMIT_CONSTANT);
    const FcFriction loaded = law(FC_LUGRE, FC_LIMIT_LOAD);
    CHECK(fc_stribeck(&dahl, 0.0) == 1.0 && fc_stribeck(&lugre, 0.0) == 1.5);
    CHECK_NEAR(fc_stribeck(&lugre, 0.2), 1.0 + 0.5 * exp(-1.0), 1e-15);
    CHECK_NEAR(fc_stribeck(&lugre, -0.4), 1.0 + 0.5 * exp(-4.0), 1e-15);
    for (double t = 0.0; t < PERIOD; t += 0.07 * PERIOD) {
        const FcScene constant = moving_scene(&contact, &dahl, 1.0);
        const FcScene follows = moving_scene(&contact, &loaded, 1.0);
        CHECK(fc_scene_coefficients(&constant, t).limit == 55.0);
        const double V = fc_drive_V(&follows.drive, t);
        const double F_n = fc_scene_contact(&follows, t).F_n;
        CHECK_NEAR(fc_scene_coefficients(&follows, t).limit,
                   0.176 * F_n * (1.0 + 0.5 * exp(-(V / 0.2) * (V / 0.2))), 1e-14);
    }
}

// F_t = sigma delta + sigma_1 delta' + sigma_2 V, and Coulomb's g sgn V + sigma_2 V.
static void forces_of_the_laws(void) {
    const FcContactParameters contact = table_1(FC_CONTACT_CONSTANT, FC_CONTACT_SEPARATION);
    const double delta = 8e-6; // m; sigma delta = 20 N, below 55 N
    for (double t = 0.0; t < PERIOD; t += 0.13 * PERIOD) {
        const FcFriction coulomb = law(FC_COULOMB, FC_LIMIT_CONSTANT);
        const FcScene sliding = moving_scene(&contact, &coulomb, 0.0);
        const double V = fc_drive_V(&sliding.drive, t);
        CHECK_NEAR(fc_scene_outputs(&sliding, t, delta).F_t, (V > 0.0 ? 55.0 : -55.0) + 3.0 * V, 1e-15);
        CHECK(fc_scene_deflection_rate(&sliding, t, delta) == 0.0);

        const FcFriction plastic = law(FC_ELASTIC_PLASTIC, FC_LIMIT_CONSTANT);
        const FcScene sticking = moving_scene(&contact, &plastic, 0.0);
        CHECK_NEAR(fc_scene_outputs(&sticking, t, delta).F_t, 20.0 + 40.0 * V + 3.0 * V, 1e-14);

        const FcFriction lugre = law(FC_LUGRE, FC_LIMIT_CONSTANT);
        const FcScene bristle = moving_scene(&contact, &lugre, 0.0);
        const double g = 55.0 * (1.0 + 0.5 * exp(-(V / 0.2) * (V / 0.2)));
        const double rate = V - 2.5e6 * fabs(V) * delta / g;
        CHECK_NEAR(fc_scene_deflection_rate(&bristle, t, delta), rate, 1e-14);
        CHECK_NEAR(fc_scene_outputs(&bristle, t, delta).F_t, 20.0 + 40.0 * rate + 3.0 * V, 1e-14);
    }
}

// A bristle beyond its bound lies on it; one on it slips while V pushes outwards.
static void an_elastic_plastic_bristle_slips(void) {
    const FcContactParameters contact = table_1(FC_CONTACT_CONSTANT, FC_CONTACT_SEPARATION);
    FcFriction plastic = law(FC_ELASTIC_PLASTIC, FC_LIMIT_CONSTANT);
    plastic.sigma_2 = 0.0;
    const FcScene scene = moving_scene(&contact, &plastic, 0.0);
    const double bound = 55.0 / 2.5e6;
    CHECK(fc_drive_V(&scene.drive, 0.0) > 0.0);
    CHECK(fc_scene_slip_side(&scene, 0.0, bound) == 1.0 && fc_scene_slip_side(&scene, 0.0, -bound) == 0.0);
    CHECK(fc_scene_slip_side(&scene, 0.0, 0.99 * bound) == 0.0);
    CHECK(fc_scene_deflection_rate(&scene, 0.0, bound) == 0.0);
    CHECK_NEAR(fc_scene_outputs(&scene, 0.0, 2.0 * bound).F_t, 55.0, 1e-15);
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
static double log_limit(const FcScene* scene, double t) { return log(fc_scene_coefficients(scene, t).limit); }
static double bound(const FcScene* scene, double t) {
    const FcCoefficients at = fc_scene_coefficients(scene, t);
    return at.limit / at.sigma;
}

static void rates_are_derivatives(void) {
    const double omega = TWO_PI * F;
    for (int k = 0; k < KINDS; k++) {
        const Kind one = kind(k);
        const FcScene scene = moving_scene(&one.contact, &one.friction, 1.0);
        for (double t = 0.01 * PERIOD; t < PERIOD; t += 0.09 * PERIOD) {
            const FcLogRates rates = fc_scene_log_rates(&scene, t);
            CHECK_WITHIN(rates.sigma, slope(log_stiffness, &scene, t), 1e-8 * omega);
            CHECK_WITHIN(rates.limit, slope(log_limit, &scene, t), 1e-8 * omega);
            CHECK_WITHIN(fc_scene_d_rate(&scene, t), slope(fc_scene_d, &scene, t), 1e-9 * omega * 1.1e-6);
            CHECK_WITHIN(fc_scene_bound_rate(&scene, t), slope(bound, &scene, t),
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

// With vibration a scene later by whole periods goes through the same times.
static void later_scenes_continue(void) {
    for (int k = 0; k < KINDS; k++) {
        const Kind one = kind(k);
        const FcScene scene = moving_scene(&one.contact, &one.friction, 1.0);
        const FcScene later = fc_scene_later(&scene, 2.0 * PERIOD);
        for (double t = 0.0; t < PERIOD; t += 0.3 * PERIOD) {
            const FcCoefficients now = fc_scene_coefficients(&later, t);
            const FcCoefficients same = fc_scene_coefficients(&scene, t + 2.0 * PERIOD);
            CHECK_NEAR(now.V, same.V, 1e-13);
            CHECK_NEAR(now.sigma, same.sigma, 1e-12);
            CHECK_NEAR(now.limit, same.limit, 1e-12);
        }
    }
}

int main(void) {
    limits_of_the_laws();
    forces_of_the_laws();
    an_elastic_plastic_bristle_slips();
    surfaces_float_on_the_load();
    rates_are_derivatives();
    bounds_hold();
    later_scenes_continue();
    return check_result();
}
