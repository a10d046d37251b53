// Periods: which intervals a step asks for, how their maps are put together, and that many periods at once are the same as one by
// one, whatever the law, for the price of a few.
#include "solver/periods.h"

#include <string.h>

#include "check.h"
#include "model/regime.h"
#include "random.h"
#include "solver/method.h"
#include "table_1.h"

static const double F = 1024.0; // Hz; a period is a power of 2, so that h f has no rounding
static const double PERIOD = 1.0 / 1024.0;

// What was asked for.
static struct {
    int steps, maps;
    double duration[16]; // s, of the steps
    double V[16];        // m/s, at the step's start
    double d[16], E[16]; // m, Pa
    double delta[16];    // m
} asked;
static double evaluations_each;

// Relaxes by a quarter and adds V duration, whatever the scene; the impulse is the duration, and delta times a force per deflection.
static FcMap quarter_map(const FcScene* scene, const FcSolverOptions* options, double duration,
                         double delta_0, FcMap* across, double* evaluations) {
    (void)options, (void)delta_0, (void)across;
    asked.maps++;
    *evaluations += evaluations_each;
    return (FcMap){.relaxation = 0.25,
                   .offset = scene->drive.V.value * duration,
                   .impulse_slope = 3.0 * duration,
                   .impulse_offset = duration};
}

static void quarter_step(const FcScene* scene, const FcSolverOptions* options, double duration,
                         FcStepResult* result) {
    const int k = asked.steps++ % 16;
    asked.duration[k] = duration;
    asked.V[k] = scene->drive.V.value;
    asked.d[k] = scene->drive.d.value;
    asked.E[k] = scene->drive.E.value;
    asked.delta[k] = result->delta;
    const FcMap map = quarter_map(scene, options, duration, result->delta, NULL, &result->evaluations);
    asked.maps--;
    fc_map_apply(&map, result);
}

static const FcIntegration QUARTER = {quarter_step, quarter_map, false, false};

typedef struct {
    double V_rate, V_1, h;
} Case;

static const FcSolverOptions options = {.tolerance = 1e-6, .force = 55.0};

static FcScene scene_of(Case c) {
    static const FcContactParameters contact = {.model = FC_CONTACT_CONSTANT, .sigma = 1e6, .R_q = 1.0};
    memset(&asked, 0, sizeof asked);
    const FcDrive drive = fc_drive_make((FcLinearInput){2.0, c.V_rate}, (FcLinearInput){1.0, 0.5 * c.V_rate},
                                        (FcLinearInput){8.0, 0.25 * c.V_rate}, (FcLinearInput){1.0, 0.0},
                                        (FcVibration){.f = F, .V_1 = c.V_1}, 0.0, 0.0);
    static const FcFriction friction = {.model = FC_DAHL, .limit = FC_LIMIT_CONSTANT};
    const FcContactAtModulus at_E = fc_contact_at_modulus(&contact, drive.E.value);
    return fc_scene_make(&contact, &at_E, &friction, 55.0, &drive);
}

static bool step(Case c, FcStepResult* result, FcMessage* message) {
    const FcScene scene = scene_of(c);
    return fc_periods_step(QUARTER, &scene, &options, c.h, result, message);
}

static void a_short_step_is_one_interval(void) {
    const Case cases[] = {
        {0.0, 1.0, 1.9 * PERIOD}, {0.0, 0.0, 1e6 * PERIOD}, {3.0, 0.0, 1e6 * PERIOD}, {3.0, 1.0, PERIOD}};
    for (int i = 0; i < 4; i++) {
        FcStepResult result = {.delta = 1.0};
        FcMessage message;
        CHECK(step(cases[i], &result, &message));
        CHECK(asked.steps == 1 && asked.maps == 0 && asked.duration[0] == cases[i].h);
        CHECK_NEAR(result.delta, 0.75 + 2.0 * cases[i].h, 1e-15);
        CHECK(result.impulse == 4.0 * cases[i].h && result.evaluations == evaluations_each);
    }
}

// delta after n periods: 2 / F (1 - (3/4)^n) / (1/4) + (3/4)^n.
static void equal_periods_are_a_power(void) {
    FcStepResult result = {.delta = 1.0};
    FcMessage message;
    CHECK(step((Case){0.0, 1.0, 5.25 * PERIOD}, &result, &message));
    CHECK(asked.maps == 1 && asked.steps == 1 && asked.duration[0] == 0.25 * PERIOD);
    const double kept = pow(0.75, 5.0);
    const double after_five = 2.0 * PERIOD * (1.0 - kept) / 0.25 + kept;
    CHECK_NEAR(asked.delta[0], after_five, 1e-15);
    CHECK_NEAR(result.delta, 0.75 * after_five + 2.0 * 0.25 * PERIOD, 1e-15);
    CHECK(result.evaluations == 2.0 * evaluations_each);
}

static void a_billion_periods_cost_one_interval(void) {
    FcStepResult result = {.delta = 1.0};
    FcMessage message;
    CHECK(step((Case){0.0, 1.0, 0x1p30 * PERIOD}, &result, &message));
    CHECK(asked.maps == 1 && asked.steps == 0);    // no rest
    CHECK_NEAR(result.delta, 8.0 * PERIOD, 1e-15); // where 1/4 delta = V / F
    // and what the start, 1 - 8 PERIOD away, decays by adds 4 periods of it
    const double transient = 3.0 * PERIOD * 4.0 * (1.0 - 8.0 * PERIOD);
    CHECK_NEAR(result.impulse, 0x1p30 * PERIOD * (1.0 + 3.0 * 8.0 * PERIOD) + transient, 1e-12);
}

static void the_settled_force_takes_one_interval(void) {
    const FcScene scene = scene_of((Case){0.0, 1.0, 0.0});
    FcStepResult end = {.delta = 1.0};
    const double force = fc_periods_settled(QUARTER, &scene, &options, &end).x;
    CHECK(asked.maps == 1 && asked.steps == 0 && end.evaluations == evaluations_each);
    CHECK_NEAR(force, 1.0 + 3.0 * 8.0 * PERIOD, 1e-15);
    CHECK_NEAR(end.delta, 8.0 * PERIOD, 1e-15);
}

static void moving_inputs_are_gone_through_one_by_one(void) {
    FcStepResult result = {.delta = 1.0};
    FcMessage message;
    CHECK(step((Case){512.0, 1.0, 3.5 * PERIOD}, &result, &message));
    CHECK(asked.steps == 4 && asked.maps == 0);
    double delta = 1.0;
    for (int k = 0; k < 4; k++) {
        const double begin = k * PERIOD;
        CHECK(asked.duration[k] == (k < 3 ? PERIOD : 0.5 * PERIOD));
        CHECK(asked.V[k] == 2.0 + 512.0 * begin);
        CHECK(asked.d[k] == 1.0 + 256.0 * begin);
        CHECK(asked.E[k] == 8.0 + 128.0 * begin);
        CHECK_NEAR(asked.delta[k], delta, 1e-15);
        delta = 0.75 * delta + asked.V[k] * asked.duration[k];
    }
    CHECK_NEAR(result.delta, delta, 1e-15);
}

static void too_much_work_is_refused(void) {
    FcStepResult result = {.delta = 7.0};
    FcMessage message = {""};
    CHECK(!step((Case){1e-9, 1.0, (1e6 + 1.0) * PERIOD}, &result, &message));
    CHECK(asked.steps == 0 && strstr(message.text, "1000001 vibration periods"));
    CHECK(step((Case){1e-9, 1.0, 1e6 * PERIOD}, &result, &message));
    CHECK(asked.steps + asked.maps < 100); // moving ones are interpolated

    evaluations_each = 0.6 * FC_MOST_EVALUATIONS;
    result = (FcStepResult){.delta = 7.0};
    CHECK(!step((Case){0.0, 1.0, 5.25 * PERIOD}, &result, &message));
    CHECK(strstr(message.text, "evaluations") && strchr(message.text, '\n') == NULL);
    result = (FcStepResult){.delta = 7.0};
    CHECK(step((Case){0.0, 1.0, PERIOD}, &result, &message));
    evaluations_each = 9.0;
}

// ---- the laws ----

typedef struct {
    FcContactParameters contact;
    FcFriction friction;
    FcScene scene; // points to them
    double V_1, a_d;
    double D; // m, the static bound at the start without vibration
} Slider;

static const double LIMIT = 55.0; // N

// kappa of some 0.01 to 100, the way of a period of V some part of the bound, any law.
static void draw(Slider* slider) {
    const int models[] = {FC_ELASTIC_PLASTIC, FC_ELASTIC_PLASTIC, FC_DAHL, FC_LUGRE};
    const int kind = (int)(4.0 * random_01());
    slider->friction = (FcFriction){.model = models[kind],
                                    .limit = random_01() < 0.6 ? FC_LIMIT_LOAD : FC_LIMIT_CONSTANT,
                                    .mu = 0.176,
                                    .staticRatio = kind == 0 ? 1.0 : 1.0 + random_log(0.05, 1.5)};
    slider->V_1 = random_log(0.05, 3.0);
    // Under a wide Stribeck curve a bristle may stick as soon as it has broken away, which multiplies what its starts differ by:
    // it has no cycle, and no two ways of computing it agree.
    slider->friction.V_S = slider->V_1 * random_log(1e-3, kind == 1 ? 1e-2 : 3.0);
    slider->a_d = random_01() < 0.3 ? 0.0 : random_log(1e-8, 2e-6);
    const double omega = 6.283185307179586 * F;
    const double V = slider->V_1 * random_log(1e-3, 2.0) * (random_01() < 0.5 ? -1.0 : 1.0);
    const int contacts[] = {FC_CONTACT_ASPERITIES, FC_CONTACT_MINDLIN, FC_CONTACT_CONSTANT};
    slider->contact = table_1(contacts[(int)(3.0 * random_01())], FC_CONTACT_LOAD);
    const FcDrive drive = fc_drive_make(
        (FcLinearInput){V, 0.0}, (FcLinearInput){14e-6, 0.0}, (FcLinearInput){58e9, 0.0},
        (FcLinearInput){LIMIT / 0.176, 0.0},
        (FcVibration){F, slider->V_1, slider->a_d, 6.28 * random_01(), 0.0, 0.0}, random_01() / F, 0.0);
    FcContactAtModulus at_E = fc_contact_at_modulus(&slider->contact, 58e9);
    slider->scene = fc_scene_make(&slider->contact, &at_E, &slider->friction, LIMIT, &drive);
    const double sigma = random_log(1e-2, 1e2) * LIMIT * omega / slider->V_1;
    const double factor = sigma / fc_scene_stiffness(&slider->scene, 0.0);
    slider->contact.stiffnessScale *= factor;
    slider->contact.sigma *= factor;
    at_E = fc_contact_at_modulus(&slider->contact, 58e9);
    slider->scene = fc_scene_make(&slider->contact, &at_E, &slider->friction, LIMIT, &drive);
    slider->D = LIMIT / sigma;
}

static FcStepResult take(const FcScene* scene, double tolerance, double h, FcBristle from) {
    const FcSolverOptions of = {
        .tolerance = tolerance, .force = fc_static_ratio(scene->friction) * LIMIT, .step_size = 1e-3};
    FcStepResult result;
    FcMessage message;
    CHECK(fc_method_step(scene, FC_METHOD_COLLOCATION, NULL, &of, h, from, &result, &message));
    return result;
}

static FcStepResult one_by_one(const FcScene* scene, double tolerance, double n, FcBristle from) {
    FcStepResult sum = {.delta = from.delta, .slips = from.slips};
    for (double k = 0.0; k < n; k += 1.0) {
        const FcStepResult one =
            take(scene, tolerance, PERIOD, (FcBristle){.delta = sum.delta, .slips = sum.slips});
        sum.delta = one.delta;
        sum.slips = one.slips;
        sum.impulse += one.impulse;
        sum.work += one.work;
        sum.heat += one.heat;
    }
    return sum;
}

static void many_at_once_are_the_same_as_one_by_one(void) {
    const double tolerance = 1e-8;
    int slipped = 0;
    for (int i = 0; i < 400; i++) {
        Slider slider;
        draw(&slider);
        const FcScene* scene = &slider.scene;
        const double n = floor(random_log(2.0, 200.0));
        const FcBristle start = fc_reach(scene, (FcBristle){.delta = slider.D * (2.0 * random_01() - 1.0)});
        const FcStepResult all = take(scene, tolerance, n * PERIOD, start);
        const FcStepResult sum = one_by_one(scene, tolerance, n, start);
        const double force = 2.0 * tolerance * fc_static_ratio(scene->friction) * LIMIT;
        const double path = (fabs(scene->drive.V.value) + slider.V_1) * n * PERIOD;
        CHECK_WITHIN(all.delta * LIMIT / slider.D, sum.delta * LIMIT / slider.D, 3.0 * force);
        CHECK(all.slips == sum.slips);
        CHECK_WITHIN(all.impulse, sum.impulse, force * n * PERIOD);
        CHECK_WITHIN(all.work, sum.work, force * path);
        CHECK_WITHIN(all.heat, sum.heat, force * path);
        slipped += all.meetings > 0;
    }
    CHECK(slipped > 50);
}

// Sticks for some periods and slips in one: V T is a third of what break-away drops.
static void stick_slip_over_several_periods_is_a_cycle(void) {
    Slider slider = {
        .contact = table_1(FC_CONTACT_CONSTANT, FC_CONTACT_SEPARATION),
        .friction = {
            .model = FC_ELASTIC_PLASTIC, .limit = FC_LIMIT_CONSTANT, .staticRatio = 1.5, .V_S = 1e-3}};
    const double D = LIMIT / slider.contact.sigma;
    const FcDrive drive = fc_drive_make((FcLinearInput){0.16 * D * F, 0.0}, (FcLinearInput){14e-6, 0.0},
                                        (FcLinearInput){58e9, 0.0}, (FcLinearInput){1.0, 0.0},
                                        (FcVibration){.f = F, .V_1 = 0.3 * D * 6.28 * F}, 0.0, 0.0);
    const FcContactAtModulus at_E = fc_contact_at_modulus(&slider.contact, 58e9);
    slider.scene = fc_scene_make(&slider.contact, &at_E, &slider.friction, LIMIT, &drive);
    const FcScene* scene = &slider.scene;
    int periods_of_slip = 0;
    FcBristle bristle = {0};
    for (int k = 0; k < 60; k++) {
        const FcStepResult one = take(scene, 1e-8, PERIOD, bristle);
        periods_of_slip += one.meetings > 0;
        bristle = (FcBristle){.delta = one.delta, .slips = one.slips};
    }
    CHECK(periods_of_slip > 10 && periods_of_slip < 30); // so that it is about cycles of several periods
    for (double n = 2.0; n < 60.0; n += 1.0) {
        const FcStepResult all = take(scene, 1e-8, n * PERIOD, (FcBristle){0});
        const FcStepResult sum = one_by_one(scene, 1e-8, n, (FcBristle){0});
        CHECK_WITHIN(all.delta, sum.delta, 1e-9 * D);
        CHECK_WITHIN(all.impulse, sum.impulse, 1e-9 * LIMIT * n * PERIOD);
        CHECK_WITHIN(all.heat, sum.heat, 1e-9 * LIMIT * D * n);
    }
    const FcStepResult hundred = take(scene, 1e-8, 100.0 * PERIOD, (FcBristle){0});
    const FcStepResult million = take(scene, 1e-8, 1e6 * PERIOD, (FcBristle){0});
    CHECK(million.evaluations < 1.5 * hundred.evaluations);
    // The mean of the cycle is that of the million.
    const FcSolverOptions of = {.tolerance = 1e-8, .force = LIMIT, .step_size = 1e-3};
    FcVector force;
    double evaluations = 0.0;
    fc_method_settled(scene, &of, (FcBristle){0}, &force, &evaluations);
    CHECK_WITHIN(force.x, million.impulse / (1e6 * PERIOD), 1e-5 * LIMIT);
}

static void a_million_periods_cost_what_a_hundred_cost(void) {
    for (int i = 0; i < 300; i++) {
        Slider slider;
        draw(&slider);
        const FcBristle start = fc_reach(&slider.scene, (FcBristle){0});
        const double hundred = take(&slider.scene, 1e-6, 100.0 * PERIOD, start).evaluations;
        const double million = take(&slider.scene, 1e-6, 1e6 * PERIOD, start).evaluations;
        CHECK(million <= 3.0 * hundred + 1000.0);
    }
}

int main(void) {
    evaluations_each = 9.0;
    a_short_step_is_one_interval();
    equal_periods_are_a_power();
    a_billion_periods_cost_one_interval();
    the_settled_force_takes_one_interval();
    moving_inputs_are_gone_through_one_by_one();
    too_much_work_is_refused();
    many_at_once_are_the_same_as_one_by_one();
    stick_slip_over_several_periods_is_a_cycle();
    a_million_periods_cost_what_a_hundred_cost();
    return check_result();
}
