// The scene: the laws' limits and forces, where a bristle slips, surfaces that float on a load, rates against differences, bounds.
#include "model/scene.h"

#include "check.h"
#include "model/regime.h"
#include "moving_scene.h"
#include "random.h"

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

// Of a bristle that touches no bound, at the time t.
static FcMotion free_motion(const FcScene* scene, double t, double delta) {
    const FcScene then = fc_scene_from(scene, t);
    return fc_motion(&then, FC_FREE, (FcBristle){.delta = delta});
}

// Of a bristle at the start, wherever it is.
static FcMotion motion_of(const FcScene* scene, FcBristle bristle) {
    const FcBristle reached = fc_reach(scene, bristle);
    return fc_motion(scene, fc_regime(scene, reached), reached);
}

// F_t = sigma delta + sigma_1 delta' + sigma_2 V, and Coulomb's g sgn V + sigma_2 V.
static void forces_of_the_laws(void) {
    const FcContactParameters contact = table_1(FC_CONTACT_CONSTANT, FC_CONTACT_SEPARATION);
    const double delta = 8e-6; // m; sigma delta = 20 N, below 55 N
    for (double t = 0.0; t < PERIOD; t += 0.13 * PERIOD) {
        const FcFriction coulomb = law(FC_COULOMB, FC_LIMIT_CONSTANT);
        const FcScene sliding = moving_scene(&contact, &coulomb, 0.0);
        const double V = fc_drive_V(&sliding.drive, t);
        const FcMotion slides = free_motion(&sliding, t, delta);
        CHECK_NEAR(slides.force.x, (V > 0.0 ? 55.0 : -55.0) + 3.0 * V, 1e-14);
        CHECK(slides.rates.delta == 0.0 && slides.rates.Q_f == slides.rates.W_f);

        const FcFriction plastic = law(FC_ELASTIC_PLASTIC, FC_LIMIT_CONSTANT);
        const FcScene sticking = moving_scene(&contact, &plastic, 0.0);
        const FcMotion sticks = free_motion(&sticking, t, delta);
        CHECK_NEAR(sticks.force.x, 20.0 + 40.0 * V + 3.0 * V, 1e-14);
        CHECK_NEAR(sticks.rates.Q_f, 43.0 * V * V, 1e-13);

        const FcFriction lugre = law(FC_LUGRE, FC_LIMIT_CONSTANT);
        const FcScene bristle = moving_scene(&contact, &lugre, 0.0);
        const double g = 55.0 * (1.0 + 0.5 * exp(-(V / 0.2) * (V / 0.2)));
        const double rate = V - 2.5e6 * fabs(V) * delta / g;
        const FcMotion relaxes = free_motion(&bristle, t, delta);
        CHECK_NEAR(relaxes.rates.delta, rate, 1e-13);
        CHECK_NEAR(relaxes.force.x, 20.0 + 40.0 * rate + 3.0 * V, 1e-13);
        CHECK_NEAR(relaxes.rates.W_f, relaxes.force.x * V, 1e-13);
    }
}

// With static friction it sticks up to the static bound and then drops to the kinetic one, along which it slips while V pushes it.
static void an_elastic_plastic_bristle_breaks_away(void) {
    const FcContactParameters contact = table_1(FC_CONTACT_CONSTANT, FC_CONTACT_SEPARATION);
    const FcFriction plastic = law(FC_ELASTIC_PLASTIC, FC_LIMIT_CONSTANT);
    const FcScene scene = moving_scene(&contact, &plastic, 0.0);
    const double V = fc_drive_V(&scene.drive, 0.0);
    const double kinetic = 55.0 / 2.5e6 * (1.0 + 0.5 * exp(-(V / 0.2) * (V / 0.2)));
    const double beyond = 1.0001 * 1.5 * 55.0 / 2.5e6;
    CHECK(V > 0.0 && fc_drive_V_rate(&scene.drive, 0.0) < 0.0); // the kinetic bound rises
    for (int side = -1; side <= 1; side += 2) {
        const FcBristle sticks = fc_reach(&scene, (FcBristle){.delta = side * 0.9999 * beyond});
        CHECK(sticks.delta == side * 0.9999 * beyond && sticks.slips == 0);
        CHECK(fc_regime(&scene, sticks) == FC_FREE);
        const FcBristle drops = fc_reach(&scene, (FcBristle){.delta = side * beyond});
        CHECK_NEAR(drops.delta, side * kinetic, 1e-14);
        CHECK(drops.slips == (side > 0 ? 1 : 0)); // V pushes forward
        CHECK(fc_regime(&scene, drops) == (FcRegime)drops.slips);
        const FcBristle inside = fc_reach(&scene, (FcBristle){.delta = side * 0.5 * kinetic, .slips = side});
        CHECK(inside.delta == side * 0.5 * kinetic && inside.slips == drops.slips);
        CHECK(fc_regime(&scene, inside) == FC_FREE);
    }
}

// Where the limit follows the load, a bristle of Dahl or LuGre beyond the bound lies on it, mu F_n or staticRatio mu F_n, and
// slips along it while its law would lead beyond: with V held, where the bound falls.
static void a_bristle_slips_along_a_limit_that_follows_the_load(void) {
    const FcContactParameters contact = table_1(FC_CONTACT_CONSTANT, FC_CONTACT_SEPARATION);
    for (int model = FC_DAHL; model <= FC_LUGRE; model += FC_LUGRE - FC_DAHL) {
        for (double d_rate = -0.02; d_rate <= 0.02; d_rate += 0.04) { // F_n rises, falls
            FcFriction friction = law(model, FC_LIMIT_LOAD);
            friction.sigma_2 = 0.0;
            FcScene scene = moving_scene(&contact, &friction, 0.0);
            scene.drive.vibration = (FcVibration){.f = F};
            scene.drive.d.rate = d_rate;
            scene.drive.V.value = 1e-3;
            const double F_n = scene.at_E.load_0 * exp(-scene.at_E.decay * 14e-6);
            const double limit = (model == FC_LUGRE ? 1.5 : 1.0) * 0.176 * F_n;
            const double D = limit / 2.5e6;
            const double D_rate = -D * scene.at_E.decay * d_rate;
            const double free_rate =
                1e-3 * (1.0 - (model == FC_LUGRE ? 1.5 / (1.0 + 0.5 * exp(-2.5e-5)) : 1.0));
            const bool slips = d_rate > 0.0;
            CHECK(fc_regime(&scene, fc_reach(&scene, (FcBristle){.delta = 2.0 * D})) == (slips ? 1 : 0));
            CHECK(fc_regime(&scene, fc_reach(&scene, (FcBristle){.delta = -2.0 * D})) == (slips ? -1 : 0));
            CHECK(fc_regime(&scene, (FcBristle){.delta = 0.99 * D}) == FC_FREE);
            const double rate = slips ? D_rate : free_rate;
            const FcMotion motion = motion_of(&scene, (FcBristle){.delta = 2.0 * D});
            CHECK_WITHIN(motion.rates.delta, rate, 1e-11 * 1e-3);
            CHECK_NEAR(motion.force.x, limit + 40.0 * rate, 1e-12);
            friction.limit = FC_LIMIT_CONSTANT;
            CHECK(fc_reach(&scene, (FcBristle){.delta = 2.0 * D}).delta == 2.0 * D);
            CHECK(fc_regime(&scene, (FcBristle){.delta = 2.0 * D}) == FC_FREE);
        }
    }
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
static double bound(const FcScene* scene, double t) { return fc_bound(scene, t); }

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
            FcFriction of_bound;
            const FcScene bound_scene = fc_scene_of_bound(&scene, 0, &of_bound);
            CHECK_WITHIN(fc_bound_rate(&bound_scene, t), slope(bound, &bound_scene, t),
                         1e-7 * omega * fc_bound(&bound_scene, t));
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

// A scene and what it is made of; which of its inputs move, and whether it vibrates, chance decides for each.
typedef struct {
    Kind made;
    FcDrive given; // with both the separation and the load
    FcScene scene; // points to made
} Random;

static double moves_or_not(double size) { return random_01() < 0.5 ? 0.0 : size * (2.0 * random_01() - 1.0); }

// The modulus is one at which both the elastic and the plastic asperities count. Over a period inputs move by at most a
// third, and the second in which they would vanish holds no whole number of periods.
static void make_random(Random* one, int k) {
    one->made = kind(k);
    one->made.friction.model =
        random_01() < 0.3 ? FC_ELASTIC_PLASTIC : one->made.friction.model; // no curve, and bounds
    const double E = random_log(3e8, 30e9);
    const double per = 0.3 / PERIOD;
    const bool vibrates = random_01() < 0.6;
    const FcVibration vibration = {.f = 19999.7,
                                   .V_1 = vibrates ? 0.3 * random_01() : 0.0,
                                   .a_d = vibrates && random_01() < 0.8 ? 1.1e-6 * random_01() : 0.0,
                                   .phase_d = TWO_PI * random_01()};
    one->given = fc_drive_make((FcLinearInput){random_01() - 0.5, moves_or_not(per)},
                               (FcLinearInput){14e-6, moves_or_not(1e-6 * per)},
                               (FcLinearInput){E, moves_or_not(E * per)},
                               (FcLinearInput){1.0, moves_or_not(per)}, vibration, random_01(), 0.0);
    const FcContactAtModulus at_E = fc_contact_at_modulus(&one->made.contact, E);
    one->scene = fc_scene_make(&one->made.contact, &at_E, &one->made.friction, 55.0, &one->given);
}

// On its kinetic bound it slips while V pushes outwards faster than the bound recedes.
static void it_slips_where_V_outruns_the_bound(void) {
    int slips = 0, sticks = 0;
    for (int k = 0; k < 20 * KINDS; k++) {
        Random one;
        make_random(&one, k);
        one.made.friction.model = FC_ELASTIC_PLASTIC;
        one.made.friction.sigma_1 = 0.0;
        one.made.friction.sigma_2 = 0.0;
        const FcCoefficients at = fc_scene_coefficients(&one.scene, 0.0);
        const double D = at.limit / at.sigma;
        const double D_rate = slope(bound, &one.scene, 0.0);
        for (int side = -1; side <= 1; side += 2) {
            const double outruns = side * at.V - D_rate;
            if (fabs(outruns) < 1e-3 * (fabs(at.V) + fabs(D_rate))) {
                continue;
            }
            const int expected = outruns > 0.0 ? side : 0;
            const FcBristle reached =
                fc_reach(&one.scene, (FcBristle){.delta = side * 1.1 * D, .slips = side});
            CHECK_NEAR(reached.delta, side * D, 1e-15);
            CHECK(reached.slips == expected);
            CHECK(fc_regime(&one.scene, reached) == (FcRegime)expected);
            CHECK(fc_regime(&one.scene, (FcBristle){.delta = side * (1.0 - 1e-9) * D, .slips = side}) ==
                  FC_FREE);
            const FcMotion motion = motion_of(&one.scene, reached);
            CHECK_WITHIN(motion.rates.delta, expected != 0 ? side * D_rate : at.V,
                         1e-7 * (fabs(at.V) + fabs(D_rate)));
            CHECK_NEAR(motion.force.x, side * at.limit, 1e-13);
            slips += expected != 0;
            sticks += expected == 0;
        }
    }
    CHECK(slips > 100 && sticks > 100);
}

int main(void) {
    it_slips_where_V_outruns_the_bound();
    limits_of_the_laws();
    forces_of_the_laws();
    an_elastic_plastic_bristle_breaks_away();
    a_bristle_slips_along_a_limit_that_follows_the_load();
    surfaces_float_on_the_load();
    rates_are_derivatives();
    bounds_hold();
    later_scenes_continue();
    return check_result();
}
