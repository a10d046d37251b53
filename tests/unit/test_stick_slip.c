// The elastic-plastic law: formulas, the stop operator by brute force, many periods, the settled state, refusals.
#include "solver/stick_slip/stick_slip.h"

#include <string.h>

#include "check.h"
#include "model/constants.h"
#include "random.h"
#include "solver/methods/method.h"
#include "solver/stick_slip/bound.h"
#include "solver/stick_slip/regime_integrals.h"
#include "stop_operator.h"
#include "table_1.h"

static const double F_C = 55.0;     // N
static const double F = 16384.0;    // Hz, a power of 2: h f has no rounding
static const double D_MEAN = 14e-6; // m
static const double E = 58.556936170e9;

static FcContactParameters contact;
static FcFriction friction;

// What a scene is made of, beside Table 1.
typedef struct {
    int model, limit;
    double sigma; // N/m, at D_MEAN
    double V, V_rate, d_rate;
    double V_1, a_d, phase_d;
    double sigma_1;
    int law;                 // 0: ElasticPlastic
    double staticRatio, V_S; // 0: without static friction
} Setup;

static FcScene scene_of(Setup setup) {
    contact = table_1(setup.model, FC_CONTACT_SEPARATION);
    contact.sigma = setup.sigma;
    FcContactAtModulus at_E = fc_contact_at_modulus(&contact, E);
    friction = (FcFriction){.model = setup.law != 0 ? setup.law : FC_ELASTIC_PLASTIC,
                            .limit = setup.limit,
                            .mu = F_C / fc_contact_response(&at_E, D_MEAN).F_n,
                            .staticRatio = setup.staticRatio != 0.0 ? setup.staticRatio : 1.0,
                            .V_S = setup.staticRatio != 0.0 ? setup.V_S : 0.01,
                            .sigma_1 = setup.sigma_1};
    contact.stiffnessScale = setup.sigma / fc_contact_stiffness(&at_E, D_MEAN);
    at_E = fc_contact_at_modulus(&contact, E);
    const FcVibration vibration = {F, setup.V_1, setup.a_d, setup.phase_d};
    const FcDrive drive =
        fc_drive_make((FcLinearInput){setup.V, setup.V_rate}, (FcLinearInput){D_MEAN, setup.d_rate},
                      (FcLinearInput){E, 0.0}, (FcLinearInput){100.0, 0.0}, vibration, 0.0, 0.0);
    return fc_scene_make(&contact, &at_E, &friction, F_C, &drive);
}

static const double FINEST = 1e-12;
static const double COARSEST = 1e-2;

static FcSolverOptions within(double tolerance) {
    return (FcSolverOptions){.tolerance = tolerance, .step_size = 1e-8};
}

static FcStepResult step_within(double tolerance, const FcScene* scene, double h, double delta_0) {
    const FcSolverOptions options = within(tolerance);
    FcStepResult result = {0};
    FcMessage message;
    CHECK(fc_method_step(scene, FC_METHOD_COLLOCATION, NULL, &options, h, delta_0, &result, &message));
    return result;
}

static double settled_within(double tolerance, const FcScene* scene, double delta_0) {
    const FcSolverOptions options = within(tolerance);
    double evaluations = 0.0;
    return fc_method_settled(scene, &options, delta_0, &evaluations);
}

static FcStepResult step(const FcScene* scene, double h, double delta_0) {
    return step_within(FINEST, scene, h, delta_0);
}

// From rest it sticks for D / V, then slips.
static void at_constant_speed_it_sticks_then_slips(void) {
    const double sigma = 1e7;
    const double V = 0.02;
    const FcScene scene = scene_of((Setup){
        .model = FC_CONTACT_CONSTANT, .limit = FC_LIMIT_CONSTANT, .sigma = sigma, .V = V, .sigma_1 = 3.0});
    const double D = F_C / sigma;
    const FcStepResult stuck = step(&scene, 0.5 * D / V, 0.0);
    CHECK_NEAR(stuck.delta, 0.5 * D, 1e-15);
    CHECK_NEAR(stuck.impulse, 0.125 * F_C * D / V, 1e-15);
    CHECK_NEAR(stuck.work, 0.125 * F_C * D, 1e-15);
    CHECK(stuck.heat == 0.0);
    CHECK_NEAR(stuck.drag, 0.5 * D * V, 1e-15);
    const FcStepResult slipped = step(&scene, 3.0 * D / V, 0.0);
    CHECK(slipped.delta == D);
    CHECK_NEAR(slipped.impulse, 2.5 * F_C * D / V, 1e-15);
    CHECK_NEAR(slipped.work, 2.5 * F_C * D, 1e-15);
    CHECK_NEAR(slipped.heat, 2.0 * F_C * D, 1e-15);
    CHECK_NEAR(slipped.drag, D * V, 1e-15);
    // Beyond the bound it is taken onto it and loses the difference of the stored energy.
    const FcStepResult back = step(&scene, 0.0, -7.0 * D);
    CHECK(step(&scene, 0.0, 7.0 * D).delta == D && back.delta == -D);
    CHECK_NEAR(back.heat, 0.5 * sigma * 48.0 * D * D, 1e-15);
    CHECK(back.work == 0.0 && back.impulse == 0.0 && back.drag == 0.0);
}

// V rises from zero or falls to it over a way of four times the bound, in microseconds or in days.
static void a_ramp_takes_any_time(void) {
    const double sigma = 1e7;
    const double D = F_C / sigma;
    for (double h = 1e-6; h < 1e6; h *= 10.0) {
        const double rate = 8.0 * D / (h * h);
        const double sticking[] = {0.5 * h, h * (1.0 - sqrt(0.75))}; // s, to the way D
        const double stuck[] = {D * h / 6.0,
                                rate * (h / 2.0 - sticking[1] / 6.0) * sticking[1] * sticking[1]};
        for (int i = 0; i < 4; i++) {
            const bool falls = i % 2 == 1;
            const double sign = i < 2 ? 1.0 : -1.0;
            const FcScene scene = scene_of((Setup){.model = FC_CONTACT_CONSTANT,
                                                   .limit = FC_LIMIT_CONSTANT,
                                                   .sigma = sigma,
                                                   .V = falls ? sign * rate * h : 0.0,
                                                   .V_rate = falls ? -sign * rate : sign * rate});
            const FcStepResult got = step(&scene, h, 0.0);
            CHECK_NEAR(got.delta, sign * D, 1e-15);
            CHECK_NEAR(got.work, 3.5 * F_C * D, 1e-13);
            CHECK_NEAR(got.heat, 3.0 * F_C * D, 1e-13);
            CHECK_NEAR(got.impulse, sign * (sigma * stuck[falls] + F_C * (h - sticking[falls])), 1e-13);
            const FcStepResult within = step(&scene, 0.3 * h, 0.0);
            const double x =
                falls ? rate * h * 0.3 * h - 0.5 * rate * 0.09 * h * h : 0.5 * rate * 0.09 * h * h;
            CHECK_NEAR(within.delta, sign * fmin(x, D), 1e-14);
        }
    }
}

// Under the path a sin(omega t) a closed loop costs 4 F_C (a - D), and nothing while a is within D (Prandtl): exact
// whatever the tolerance.
static void closed_loops(void) {
    const double V_1 = 0.7;
    const double a = V_1 / (FC_TWO_PI * F);
    const double ratio[] = {0.3, 0.999999, 1.000001, 1.7, 40.0, 1e6}; // a / D
    for (int i = 0; i < 6; i++) {
        const double D = a / ratio[i];
        const FcScene scene = scene_of(
            (Setup){.model = FC_CONTACT_CONSTANT, .limit = FC_LIMIT_CONSTANT, .sigma = F_C / D, .V_1 = V_1});
        const double settled = settled_within(COARSEST, &scene, 0.0);
        const FcStepResult loop = step_within(COARSEST, &scene, 1.0 / F, settled);
        const double lost = 4.0 * F_C * fmax(0.0, a - D);
        CHECK_WITHIN(loop.delta, settled, 1e-14 * D);
        CHECK_WITHIN(loop.heat, lost, 1e-13 * F_C * a);
        CHECK_WITHIN(loop.work, lost, 1e-13 * F_C * a);
        CHECK_WITHIN(loop.impulse, 0.0, 1e-13 * F_C / F);
    }
}

// From a reversal on, half a vibration leads 2 a far. What can't meet a bound is found stuck at the first look.
static void half_a_vibration_sticks_within_the_bound(void) {
    const double a = 1e-6;
    const double ratio[] = {0.01, 0.3, 0.496, 0.505, 0.7}; // a / D
    for (int i = 0; i < 5; i++) {
        const double D = a / ratio[i];
        FcScene scene = scene_of((Setup){.model = FC_CONTACT_CONSTANT,
                                         .limit = FC_LIMIT_CONSTANT,
                                         .sigma = F_C / D,
                                         .V_1 = a * FC_TWO_PI * F});
        scene.drive.theta_0 = -0.5 * FC_PI;
        const FcStepResult half = step(&scene, 0.5 / F, 0.0);
        CHECK_NEAR(half.delta, fmin(2.0 * a, D), 1e-14);
        CHECK_WITHIN(half.heat, F_C * fmax(0.0, 2.0 * a - D), 1e-13 * F_C * D);
        CHECK(2.0 * a < D ? half.evaluations == 2.0 : half.evaluations > 2.0); // of the bound and of sigma
    }
}

// With V -> 0 and sigma a < F_C the mean of the force tends to F_C - sigma a (physics of the vibrating spring).
static void slow_sliding_tends_to_the_limit_less_the_amplitude(void) {
    const double sigma = 7.76e6;
    const double a = 0.35e-6;
    const double V = 1e-9;
    const FcScene scene = scene_of((Setup){.model = FC_CONTACT_CONSTANT,
                                           .limit = FC_LIMIT_CONSTANT,
                                           .sigma = sigma,
                                           .V = V,
                                           .V_1 = a * FC_TWO_PI * F});
    const double settled = settled_within(FINEST, &scene, 0.0);
    CHECK_WITHIN(step(&scene, 1.0 / F, settled).impulse * F, F_C - sigma * a, sigma * V / F);
}

static double random_sign(void) { return random_01() < 0.5 ? -1.0 : 1.0; }

// Bounds of a hundred-thousandth to thirty times the way; a tenth of the scenes with V = V_1, where V only touches
// zero.
static Setup random_setup(double h) {
    Setup setup = {.model = 1 + (int)(3.0 * random_01()), .limit = 1 + (int)(2.0 * random_01())};
    setup.V = random_sign() * random_log(1e-3, 3.0);
    setup.V_1 = random_01() < 0.1 ? 0.0 : random_01() < 0.1 ? fabs(setup.V) : random_log(1e-3, 3.0);
    setup.a_d = random_01() < 0.2   ? 0.0
                : random_01() < 0.8 ? random_log(1e-8, 2e-6)
                                    : random_log(2e-6, 13e-6);
    setup.phase_d = FC_TWO_PI * random_01();
    setup.sigma_1 = random_01() < 0.3 ? 1.0 : 0.0;
    if (random_01() < 0.3) {
        setup.V_rate = (random_01() - 0.5) * 4.0 * setup.V / h;
        setup.d_rate = (random_01() - 0.5) * (D_MEAN - setup.a_d) / h;
    }
    const double way = (fabs(setup.V) + setup.V_1) / (FC_TWO_PI * F);
    setup.sigma = F_C / (way * random_log(1e-5, 30.0));
    return setup;
}

// Within the tolerance, and within a few roundings of the finest; a coarse one takes fewer evaluations.
static void brute_force_agrees(void) {
    const double tolerance[] = {1e-3, 1e-6, 1e-9, FINEST};
    double evaluations[4] = {0.0};
    for (int i = 0; i < 200; i++) {
        const double h = random_log(0.02, 3.0) / F;
        const FcScene scene = scene_of(random_setup(h));
        const double delta_0 = (2.0 * random_01() - 1.0) * 1.5 * fmin(fc_bound_motion(&scene, 0.0).D, 1e3);
        const StopOperator stop = stop_operator(&scene, h, delta_0, 100 + (int)(200.0 * h * F));
        const double g = (double)stop.limit;
        double lost_at_start;
        const double start = fc_stick_slip_reached(&scene, delta_0, &lost_at_start);
        const double lost = 0.5 * fc_scene_stiffness(&scene, 0.0) * (delta_0 * delta_0 - start * start);
        const double energy = g * (double)(stop.path + fabsl(stop.heat / stop.limit)) + lost;
        for (int k = 0; k < 4; k++) {
            const FcStepResult got = step_within(tolerance[k], &scene, h, delta_0);
            const double allowed = fmax(tolerance[k], 1e-11);
            CHECK_WITHIN(got.delta, (double)stop.delta,
                         fmax(tolerance[k], 1e-12) * g / fc_scene_stiffness(&scene, h));
            CHECK_WITHIN(got.impulse, (double)stop.impulse, allowed * g * h);
            CHECK_WITHIN(got.work, (double)stop.work, allowed * energy);
            CHECK_WITHIN(got.heat - lost, (double)stop.heat, allowed * energy);
            if (friction.sigma_1 != 0.0) { // delta' jumps where sticking changes to slipping
                CHECK_WITHIN(got.drag, (double)stop.drag,
                             fmax(tolerance[k], 1e-8) * (double)(stop.path * stop.path) / h);
            }
            evaluations[k] += got.evaluations;
        }
    }
    CHECK(evaluations[0] < evaluations[1] && evaluations[1] < evaluations[3]);
}

static void many_periods_are_one_after_the_other(void) {
    for (int i = 0; i < 300; i++) {
        Setup setup = random_setup(1.0 / F);
        setup.V_rate = setup.d_rate = 0.0;
        setup.V_1 = fmax(setup.V_1, 1e-3);
        setup.V = random_01() < 0.1 ? 0.0 : random_01() < 0.7 ? setup.V_1 * random_log(1e-6, 0.1) : setup.V;
        const FcScene scene = scene_of(setup);
        const double periods = floor(2.0 + 60.0 * random_01());
        const double rest = 0.375 / F;
        const double delta_0 = (2.0 * random_01() - 1.0) * 1.5 * fmin(fc_bound_motion(&scene, 0.0).D, 1e3);
        const FcStepResult all = step(&scene, periods / F + rest, delta_0);
        FcStepResult sum = {.delta = delta_0};
        double g = 0.0;
        double dearest = 0.0;
        for (double k = 0.0; k <= periods; k += 1.0) {
            const FcStepResult one = step(&scene, k < periods ? 1.0 / F : rest, sum.delta);
            sum.delta = one.delta;
            sum.impulse += one.impulse;
            sum.work += one.work;
            sum.heat += one.heat;
            dearest = fmax(dearest, one.evaluations);
            g = fmax(g, fc_scene_coefficients(&scene, k / periods / F).limit);
        }
        const double h = periods / F + rest;
        const double energy = g * (fabs(setup.V) + setup.V_1) * h + sum.heat;
        CHECK_WITHIN(all.delta, sum.delta, 1e-12 * g / fc_scene_stiffness(&scene, rest));
        CHECK_WITHIN(all.impulse, sum.impulse, 1e-12 * g * h);
        CHECK_WITHIN(all.work, sum.work, 1e-11 * energy);
        CHECK_WITHIN(all.heat, sum.heat, 1e-12 * energy);
        CHECK(all.evaluations < 20.0 * dearest); // as a few periods, not as many

        // The settled state is where 2^40 periods end, and a period leads back to it.
        const double settled = settled_within(FINEST, &scene, delta_0);
        const double allowed = 1e-12 * fmin(fc_bound_motion(&scene, 0.0).D, 1e3) + 1e-13 * setup.V_1 / F;
        CHECK_WITHIN(step(&scene, 1099511627776.0 / F, delta_0).delta, settled, allowed);
        CHECK_WITHIN(step(&scene, 1.0 / F, settled).delta, settled, allowed);
    }
}

// A bristle that creeps by s = V / f a period, n periods without touching: the sum of F over the periods in closed form.
static void creeping_is_an_arithmetic_series(void) {
    const double sigma = 1e6;
    const double V = ldexp(1.0, -40);
    const double V_1 = 0.01;
    const FcScene scene = scene_of((Setup){
        .model = FC_CONTACT_CONSTANT, .limit = FC_LIMIT_CONSTANT, .sigma = sigma, .V = V, .V_1 = V_1});
    const double n = 1048576.0 * 16.0;
    const double h = n / F;
    const FcStepResult crept = step(&scene, h, 0.0);
    CHECK_NEAR(crept.delta, V * h, 1e-14);
    CHECK_NEAR(crept.impulse, 0.5 * sigma * V * h * h, 1e-12); // the vibration's sine has no mean
    CHECK(crept.heat == 0.0 && crept.evaluations < 100.0);
    CHECK_NEAR(crept.work, 0.5 * sigma * V * h * V * h, 1e-9);
}

// Mindlin's stiffness and mu F_n fall alike: the bound stands still, also where both have all but vanished.
static void mindlin_with_a_load_has_a_constant_bound(void) {
    FcScene scene = scene_of(
        (Setup){.model = FC_CONTACT_MINDLIN, .limit = FC_LIMIT_LOAD, .sigma = 1e7, .V_1 = 1.0, .a_d = 1e-6});
    CHECK(fc_bound_is_constant(&scene));
    CHECK_NEAR(fc_bound_motion(&scene, 0.0).D, F_C / 1e7, 1e-14);
    scene.drive.d.value = 1.4e-3; // e^-700
    CHECK_NEAR(fc_bound_motion(&scene, 0.3 / F).D, F_C / 1e7, 1e-14);
}

// Without stiffness there is no bound and no force.
static void without_stiffness_it_follows(void) {
    FcScene scene = scene_of((Setup){.model = FC_CONTACT_ASPERITIES,
                                     .limit = FC_LIMIT_CONSTANT,
                                     .sigma = 1e7,
                                     .V = 0.5,
                                     .V_1 = 0.1,
                                     .a_d = 1e-6});
    scene.drive.d.value = 0.1; // e^-100000
    const FcStepResult result = step(&scene, 100.0 / F, 1e-6);
    CHECK_NEAR(result.delta, 1e-6 + 0.5 * 100.0 / F, 1e-14);
    CHECK(result.impulse == 0.0 && result.work == 0.0 && result.heat == 0.0);
    CHECK(settled_within(FINEST, &scene, 1e-6) == 1e-6);
}

static void too_many_changing_periods_are_refused(void) {
    const FcScene scene = scene_of((Setup){.model = FC_CONTACT_CONSTANT,
                                           .limit = FC_LIMIT_CONSTANT,
                                           .sigma = 1e7,
                                           .V = 0.5,
                                           .V_rate = 1e-3,
                                           .V_1 = 0.1});
    FcStepResult result = {.delta = 42.0};
    FcMessage message = {{0}};
    const FcSolverOptions options = within(FINEST);
    CHECK(!fc_method_step(&scene, FC_METHOD_COLLOCATION, NULL, &options, 2e6 / F, 0.0, &result, &message));
    CHECK(result.delta == 42.0 && strstr(message.text, "vibration periods") != NULL);
    CHECK(step(&scene, 1000.0 / F, 0.0).evaluations > 1000.0);
}

// d leaves within the step so fast that a regime has a million panels: its quadrature breaks off, and does not seem to hang.
static void quadratures_break_off_at_the_most_evaluations(void) {
    const FcScene scene = scene_of((Setup){.model = FC_CONTACT_ASPERITIES,
                                           .limit = FC_LIMIT_LOAD,
                                           .sigma = 1e7,
                                           .V = 1e-9,
                                           .d_rate = 1e6,
                                           .sigma_1 = 1.0});
    const double h = 1e-5;
    const double allowed = FC_MOST_EVALUATIONS + 100.0;
    double stick = FC_MOST_EVALUATIONS - 1000.0;
    const FcIntegrator integrator = fc_integrator(&scene, 0.0, FINEST);
    fc_stick_map(&integrator, 0.0, h, 0.5 * h, &stick);
    CHECK(stick > FC_MOST_EVALUATIONS && stick < allowed);
    FcStepResult slip = {.evaluations = FC_MOST_EVALUATIONS - 1000.0};
    const FcBoundMotion start = fc_bound_motion(&scene, 0.0);
    const FcBoundMotion end = fc_bound_motion(&scene, h);
    fc_add_slip(&integrator, 1.0, &start, &end, &slip);
    CHECK(slip.evaluations > FC_MOST_EVALUATIONS && slip.evaluations < allowed);
}

// The error of n nodes falls with a panel's length to the power 2 n: to k digits they integrate n 10^(-k / 2n) smooth
// times.
static double longest_panel(int nodes, int digits) { return nodes * pow(10.0, -0.5 * digits / nodes); }

static int fewest_nodes(double length, int digits) {
    const int nodes[] = {4, 6, 8};
    for (int i = 0; i < 3; i++) {
        if (length <= longest_panel(nodes[i], digits)) {
            return nodes[i];
        }
    }
    return 12;
}

static void quadratures_take_the_fewest_nodes_that_do(void) {
    const int nodes[] = {4, 6, 8, 12};
    const double margin = 6e-3; // the longest panels are known to three digits
    const double smooth_time = 1e-6;
    const FcScene scene = scene_of((Setup){.model = FC_CONTACT_ASPERITIES,
                                           .limit = FC_LIMIT_LOAD,
                                           .sigma = 1e7,
                                           .V = 0.5,
                                           .a_d = 1e-6,
                                           .sigma_1 = 1.0});
    const FcBoundMotion start = fc_bound_motion(&scene, 0.0);
    for (int digits = 0; digits <= 13; digits++) {
        const FcIntegrator integrator = fc_integrator(&scene, smooth_time, 0.5 * pow(10.0, -digits));
        for (int i = 0; i < 8; i++) {
            const double length =
                longest_panel(nodes[i / 2], digits) * (i % 2 == 0 ? 1.0 - margin : 1.0 + margin);
            const double panels = length > longest_panel(12, digits) ? 2.0 : 1.0;
            const double expected = panels * fewest_nodes(length / panels, digits);
            const double h = length * smooth_time;
            double stuck = 0.0;
            fc_stick_map(&integrator, 0.0, h, 0.5 * h, &stuck);
            CHECK(stuck == expected);
            const FcBoundMotion end = fc_bound_motion(&scene, h);
            FcStepResult slipped = {0}; // g, and the rate at which the bound recedes
            fc_add_slip(&integrator, 1.0, &start, &end, &slipped);
            CHECK(slipped.evaluations == 2.0 * expected);
        }
    }
}

// d leaves at once, or arrives from afar: sigma grows like e^(-+t / tau), and the stuck bristle gives
// sigma V tau^2 or sigma V (h tau - tau^2) at a cost that the distance does not count in.
static void what_is_far_apart_costs_nothing(void) {
    const double sigma = 6e6;
    const double V = 5e-3;
    const double h = 1e-3;
    for (double speed = 1e4; speed < 1e13; speed *= 10.0) {
        FcScene scene = scene_of((Setup){.model = FC_CONTACT_MINDLIN,
                                         .limit = FC_LIMIT_CONSTANT,
                                         .sigma = sigma,
                                         .V = V,
                                         .d_rate = speed});
        const double tau = 1.0 / (scene.at_E.decay * speed);
        const FcStepResult left = step(&scene, h, 0.0);
        CHECK_NEAR(left.impulse, sigma * V * tau * tau, 1e-9);
        scene.drive.d = (FcLinearInput){D_MEAN + speed * h, -speed};
        const FcStepResult arrived = step(&scene, h, 0.0);
        CHECK_NEAR(arrived.impulse, sigma * V * tau * (h - tau), 1e-4 + 1e-15 * h / tau);
        CHECK(left.evaluations < 1e4 && arrived.evaluations < 1e4);
    }
}

// E or the load falls to a fiftieth within the step, along the bound all the way: with V held, the work is V times the
// integral of g, the heat less by that of g dD (trapezoidal sums), the drag V times what D moves.
static void the_bound_is_followed_towards_a_zero_of_E_or_load(void) {
    const double h = 1e-3;
    const double V = 0.1;
    for (int input = FC_CONTACT_SEPARATION; input <= FC_CONTACT_LOAD; input++) {
        const bool loaded = input == FC_CONTACT_LOAD;
        FcScene scene = scene_of((Setup){.model = loaded ? FC_CONTACT_ASPERITIES : FC_CONTACT_CONSTANT,
                                         .limit = FC_LIMIT_LOAD,
                                         .sigma = loaded ? 1e10 : 2e5,
                                         .V = V,
                                         .sigma_1 = 1.0});
        contact.input = input;
        FcDrive drive = scene.drive;
        drive.load.value = F_C / friction.mu;
        *(loaded ? &drive.load.rate : &drive.E.rate) = -0.98 * (loaded ? drive.load.value : E) / h;
        scene = fc_scene_make(&contact, &scene.at_E, &friction, F_C, &drive);
        enum { PARTS = 20000 };
        double impulse = 0.0;
        double receding = 0.0;
        FcCoefficients a = fc_scene_coefficients(&scene, 0.0);
        const double D_start = a.limit / a.sigma;
        for (int i = 1; i <= PARTS; i++) {
            const FcCoefficients b = fc_scene_coefficients(&scene, h * i / PARTS);
            impulse += 0.5 * (a.limit + b.limit) * (h / PARTS);
            receding += 0.5 * (a.limit + b.limit) * (b.limit / b.sigma - a.limit / a.sigma);
            a = b;
        }
        const double drag = V * (a.limit / a.sigma - D_start);
        for (double tolerance = COARSEST; tolerance > 1e-7; tolerance *= 0.1) {
            const FcStepResult got = step_within(tolerance, &scene, h, D_start);
            CHECK_WITHIN(got.delta, a.limit / a.sigma, 1e-12 * D_start);
            CHECK_WITHIN(got.impulse, impulse, tolerance * F_C * h);
            CHECK_WITHIN(got.work, V * impulse, tolerance * F_C * V * h);
            CHECK_WITHIN(got.heat, V * impulse - receding, tolerance * F_C * V * h);
            CHECK_WITHIN(got.drag, drag, tolerance * V * V * h);
        }
    }
}

// The load falls along a straight line while Dahl's bristle slides at V with a constant stiffness: without a bound
// F = sigma / (sigma - b) (g - g0 (g / g0)^(sigma / b)), b = (g0 - g1) / (V h), and the bound cuts it off at g for good. The
// stiffness being constant, the heat is the work less what the bristle stores.
static void a_falling_load_cuts_dahls_bristle_off(void) {
    const double h = 1e-2;
    const double V = 3e-3;
    const double sigma = 1e5;
    const double tolerance[] = {1e-2, 1e-3, 1e-6, 1e-9};
    for (int i = 0; i < 48; i++) {
        const double falls_to = pow(10.0, -0.5 * (i / 4)); // down to a part in 3e5
        const double side = i % 2 == 0 ? 1.0 : -1.0;
        FcScene scene = scene_of((Setup){.model = FC_CONTACT_CONSTANT,
                                         .limit = FC_LIMIT_LOAD,
                                         .sigma = sigma,
                                         .V = side * V,
                                         .law = FC_DAHL});
        const double g_0 = 20.0;
        const double g_1 = 0.9 * falls_to * g_0;
        contact.input = FC_CONTACT_LOAD;
        FcDrive drive = scene.drive;
        drive.load = (FcLinearInput){g_0 / friction.mu, (g_1 - g_0) / friction.mu / h};
        scene = fc_scene_make(&contact, &scene.at_E, &friction, F_C, &drive);
        enum { PARTS = 200000 };
        const long double b = (g_0 - g_1) / (V * h);
        long double impulse = 0.0L;
        long double force = 0.0L;
        for (int k = 1; k <= PARTS; k++) {
            const long double g = g_0 + (g_1 - g_0) * ((long double)k / PARTS);
            const long double free = sigma / (sigma - b) * (g - g_0 * powl(g / g_0, sigma / b));
            const long double next = fminl(free, g);
            impulse += 0.5L * (force + next) * h / PARTS;
            force = next;
        }
        const double stored = 0.5 * (double)(force * force) / sigma;
        const FcStepResult got = step_within(tolerance[i % 4], &scene, h, 0.0);
        const double allowed = fmax(tolerance[i % 4], 1e-8);
        CHECK_WITHIN(sigma * got.delta, side * (double)force, tolerance[i % 4] * g_0);
        CHECK_WITHIN(got.impulse, side * (double)impulse, allowed * g_0 * h);
        CHECK_WITHIN(got.work, V * (double)impulse, allowed * g_0 * V * h);
        CHECK_WITHIN(got.heat, V * (double)impulse - stored, allowed * g_0 * V * h);
    }
}

// Any bounded law by brute force: the equation is solved exactly over each small step for its coefficients in the middle,
// then cut off at the bound; what is left of work and stored energy is heat.
static FcStepResult cut_off(const FcScene* scene, double h, double delta, int steps) {
    FcStepResult sum = {0};
    StopMoment a = stop_moment(scene, 0.0L);
    const bool relaxes = friction.model != FC_ELASTIC_PLASTIC;
    const long double dt = (long double)h / steps;
    long double u = delta;
    for (int i = 0; i < steps; i++) {
        const StopMoment m = stop_moment(scene, dt * (i + 0.5L));
        const StopMoment b = stop_moment(scene, dt * (i + 1.0L));
        const long double ratio = friction.staticRatio - 1.0;
        const long double at_m = 1.0L + ratio * expl(-(m.V / friction.V_S) * (m.V / friction.V_S));
        const long double at_b = 1.0L + ratio * expl(-(b.V / friction.V_S) * (b.V / friction.V_S));
        const long double z = relaxes ? m.sigma * fabsl(m.V) / (m.limit * at_m) * dt : 0.0L;
        const long double free = u * expl(-z) + m.V * dt * (z > 1e-9L ? -expm1l(-z) / z : 1.0L - 0.5L * z);
        const long double D = b.D * (relaxes ? friction.staticRatio : at_b);
        const long double next = fmaxl(-D, fminl(D, free));
        const long double force = 0.5L * (a.sigma * u + b.sigma * next);
        const long double middle = 0.5L * (u + next);
        sum.impulse += (double)(force * dt);
        sum.work += (double)(force * m.V * dt);
        sum.heat += (double)(force * m.V * dt - 0.5L * (b.sigma * next * next - a.sigma * u * u) +
                             0.5L * m.sigma * m.log_sigma_rate * middle * middle * dt);
        u = next;
        a = b;
    }
    sum.delta = (double)u;
    return sum;
}

static Setup random_bounded_setup(double h) {
    Setup setup = random_setup(h);
    const int laws[] = {FC_DAHL, FC_LUGRE, FC_ELASTIC_PLASTIC};
    setup.law = laws[(int)(3.0 * random_01())];
    setup.limit = FC_LIMIT_LOAD;
    setup.a_d = random_log(1e-7, 3e-6);
    setup.sigma = F_C * FC_TWO_PI * F / (fabs(setup.V) + setup.V_1) * random_log(0.3, 300.0);
    setup.sigma_1 = 0.0;
    if (setup.law != FC_DAHL) {
        setup.staticRatio = 1.0 + random_log(0.1, 1.5);
        setup.V_S = (fabs(setup.V) + setup.V_1) * random_log(0.03, 2.0);
    }
    return setup;
}

static void any_bounded_law_is_cut_off(void) {
    const double tolerance[] = {1e-2, 1e-3, 1e-6, 1e-9};
    for (int i = 0; i < 120; i++) {
        const double h = random_log(0.05, 1.5) / F;
        const Setup setup = random_bounded_setup(h);
        const FcScene scene = scene_of(setup);
        const double bound = F_C / setup.sigma * friction.staticRatio;
        const double delta_0 = (2.0 * random_01() - 1.0) * 0.5 * bound;
        double lost;
        const double start = fc_stick_slip_reached(&scene, delta_0, &lost);
        const FcStepResult brute = cut_off(&scene, h, start, 40000);
        const double g = fc_scene_force_scale(&scene) * friction.staticRatio;
        const double speed = fc_drive_largest_speed(&scene.drive, h);
        const double path = speed * h + bound;
        for (int k = 0; k < 4; k++) {
            const FcStepResult got = step_within(tolerance[k], &scene, h, delta_0);
            const double allowed = fmax(tolerance[k], 3e-4);
            const double sigma = fc_scene_stiffness(&scene, h);
            CHECK_WITHIN(sigma * got.delta, sigma * brute.delta, allowed * g);
            CHECK_WITHIN(got.impulse, brute.impulse, allowed * g * h);
            CHECK_WITHIN(got.work, brute.work, allowed * g * path);
            CHECK_WITHIN(got.heat - lost, brute.heat, 3.0 * allowed * g * path);
        }
    }
}

// A leap over periods is one after the other, and ends where the scene settles.
static void periods_of_any_bounded_law_leap(void) {
    for (int i = 0; i < 120; i++) {
        Setup setup = random_bounded_setup(1.0 / F);
        setup.V_rate = setup.d_rate = 0.0;
        setup.V_1 = fmax(setup.V_1, 1e-3);
        const FcScene scene = scene_of(setup);
        const double periods = floor(2.0 + 12.0 * random_01());
        const double delta_0 = 0.5 * (2.0 * random_01() - 1.0) * F_C / setup.sigma;
        const double tolerance = 1e-7;
        const FcStepResult all = step_within(tolerance, &scene, periods / F, delta_0);
        FcStepResult sum = {.delta = delta_0};
        for (double k = 0.0; k < periods; k += 1.0) {
            const FcStepResult one = step_within(tolerance, &scene, 1.0 / F, sum.delta);
            sum.delta = one.delta;
            sum.impulse += one.impulse;
            sum.work += one.work;
            sum.heat += one.heat;
        }
        const double g = fc_scene_force_scale(&scene) * friction.staticRatio;
        const double h = periods / F;
        const double energy = g * (fabs(setup.V) + setup.V_1) * h + fabs(sum.heat);
        const double sigma = fc_scene_stiffness(&scene, 0.0);
        CHECK_WITHIN(sigma * all.delta, sigma * sum.delta, 2.0 * tolerance * g);
        CHECK_WITHIN(all.impulse, sum.impulse, 2.0 * tolerance * g * h);
        CHECK_WITHIN(all.work, sum.work, 2.0 * tolerance * energy);
        CHECK_WITHIN(all.heat, sum.heat, 4.0 * tolerance * energy);
        const double settled = settled_within(tolerance, &scene, delta_0);
        const FcStepResult long_after = step_within(tolerance, &scene, 1099511627776.0 / F, delta_0);
        CHECK_WITHIN(sigma * long_after.delta, sigma * settled, 2.0 * tolerance * g);
    }
}

int main(void) {

    what_is_far_apart_costs_nothing();
    at_constant_speed_it_sticks_then_slips();
    a_ramp_takes_any_time();
    closed_loops();
    half_a_vibration_sticks_within_the_bound();
    slow_sliding_tends_to_the_limit_less_the_amplitude();
    brute_force_agrees();
    many_periods_are_one_after_the_other();
    creeping_is_an_arithmetic_series();
    mindlin_with_a_load_has_a_constant_bound();
    without_stiffness_it_follows();
    too_many_changing_periods_are_refused();
    quadratures_break_off_at_the_most_evaluations();
    quadratures_take_the_fewest_nodes_that_do();
    the_bound_is_followed_towards_a_zero_of_E_or_load();
    a_falling_load_cuts_dahls_bristle_off();
    any_bounded_law_is_cut_off();
    periods_of_any_bounded_law_leap();
    return check_result();
}
