// Periods: which intervals a step asks for, and how their maps are put together.
#include "solver/methods/periods.h"

#include <string.h>

#include "check.h"

static const double F = 1024.0; // Hz; a period is a power of 2, so that h f has no rounding
static const double PERIOD = 1.0 / 1024.0;

// What the intervals were asked for.
static struct {
    int calls;
    double duration[16]; // s
    double V[16];        // m/s, at the interval's start
    double d[16], E[16]; // m, Pa
    double delta_0[16];  // m
    FcMapScope scope[16];
} asked;
static double evaluations_each, slope;

static void ask(const FcScene* scene, double duration, double delta_0, FcMapScope scope) {
    const int k = asked.calls++ % 16;
    asked.duration[k] = duration;
    asked.V[k] = scene->drive.V.value;
    asked.d[k] = scene->drive.d.value;
    asked.E[k] = scene->drive.E.value;
    asked.delta_0[k] = delta_0;
    asked.scope[k] = scope;
}

// Relaxes by a quarter and adds V duration, whatever the scene. The impulse is the duration, and with delta times a force per
// deflection.
static FcMap quarter(const FcScene* scene, const FcSolverOptions* options, double duration, double delta_0,
                     double* evaluations) {
    (void)options;
    ask(scene, duration, delta_0, FC_MAP_ANY_START);
    *evaluations += evaluations_each;
    return (FcMap){.relaxation = 0.25,
                   .offset = scene->drive.V.value * duration,
                   .impulse_offset = duration,
                   .impulse_slope = slope * duration};
}

static void quarter_step(const FcScene* scene, const FcSolverOptions* options, double duration,
                         FcStepResult* result) {
    (void)options;
    ask(scene, duration, result->delta, FC_MAP_THIS_START);
    result->delta = 0.75 * result->delta + scene->drive.V.value * duration;
    result->impulse += duration;
    result->evaluations += evaluations_each;
}

static const FcIntegration LAW = {quarter_step, quarter, false};

typedef struct {
    double V_rate, V_1, h;
} Case;

static const FcSolverOptions options = {.tolerance = 1e-6, .step_size = 1e-8};

static FcScene scene_of(Case c) {
    static const FcContactParameters contact = {.model = FC_CONTACT_CONSTANT, .sigma = 1e6, .R_q = 1.0};
    memset(&asked, 0, sizeof asked);
    const FcDrive drive = fc_drive_make((FcLinearInput){2.0, c.V_rate}, (FcLinearInput){1.0, 0.5 * c.V_rate},
                                        (FcLinearInput){8.0, 0.25 * c.V_rate}, (FcLinearInput){1.0, 0.0},
                                        (FcVibration){F, c.V_1, 0.0, 0.0}, 0.0, 0.0);
    static const FcFriction friction = {.model = FC_DAHL, .limit = FC_LIMIT_CONSTANT};
    const FcContactAtModulus at_E = fc_contact_at_modulus(&contact, drive.E.value);
    return fc_scene_make(&contact, &at_E, &friction, 55.0, &drive);
}

static bool step(Case c, FcStepResult* result, FcMessage* message) {
    const FcScene scene = scene_of(c);
    *result = (FcStepResult){.delta = 1.0};
    return fc_periods_step(LAW, &scene, &options, c.h, result, message);
}

static void a_short_step_is_one_interval(void) {
    const Case cases[] = {
        {0.0, 1.0, 1.9 * PERIOD}, {0.0, 0.0, 1e6 * PERIOD}, {3.0, 0.0, 1e6 * PERIOD}, {3.0, 1.0, PERIOD}};
    for (int i = 0; i < 4; i++) {
        FcStepResult result;
        FcMessage message;
        CHECK(step(cases[i], &result, &message));
        CHECK(asked.calls == 1 && asked.duration[0] == cases[i].h && asked.scope[0] == FC_MAP_THIS_START);
        CHECK(asked.delta_0[0] == 1.0);
        CHECK_NEAR(result.delta, 0.75 + 2.0 * cases[i].h, 1e-15);
        CHECK(result.impulse == cases[i].h && result.evaluations == evaluations_each);
    }
}

// delta after n periods: 2 / F (1 - (3/4)^n) / (1/4) + (3/4)^n.
static void equal_periods_are_a_power(void) {
    FcStepResult result;
    FcMessage message;
    CHECK(step((Case){0.0, 1.0, 5.25 * PERIOD}, &result, &message));
    CHECK(asked.calls == 2);
    CHECK(asked.duration[0] == PERIOD && asked.scope[0] == FC_MAP_ANY_START);
    CHECK(asked.duration[1] == 0.25 * PERIOD && asked.scope[1] == FC_MAP_THIS_START);
    const double kept = pow(0.75, 5.0);
    const double after_five = 2.0 * PERIOD * (1.0 - kept) / 0.25 + kept;
    CHECK_NEAR(asked.delta_0[1], after_five, 1e-15);
    CHECK_NEAR(result.delta, 0.75 * after_five + 2.0 * 0.25 * PERIOD, 1e-15);
    CHECK_NEAR(result.impulse, 5.25 * PERIOD, 1e-15);
    CHECK(result.evaluations == 2.0 * evaluations_each);
}

static void a_billion_periods_cost_two_intervals(void) {
    FcStepResult result;
    FcMessage message;
    CHECK(step((Case){0.0, 1.0, 0x1p30 * PERIOD}, &result, &message));
    CHECK(asked.calls == 2 && asked.duration[1] == 0.0);
    CHECK_NEAR(asked.delta_0[1], 8.0 * PERIOD, 1e-15); // where 1/4 delta = V / F
    CHECK_NEAR(result.impulse, 0x1p30 * PERIOD, 1e-12);
}

static void the_settled_force_takes_one_interval(void) {
    const FcScene scene = scene_of((Case){0.0, 1.0, 0.0});
    FcStepResult end = {.delta = 1.0};
    slope = 3.0;
    const double force = fc_periods_settled(LAW, &scene, &options, &end);
    slope = 0.0;
    CHECK(asked.calls == 1 && asked.duration[0] == PERIOD && asked.scope[0] == FC_MAP_ANY_START);
    CHECK_NEAR(end.delta, 8.0 * PERIOD, 1e-15); // where 1/4 delta = V / F
    CHECK_NEAR(force, 1.0 + 3.0 * 8.0 * PERIOD, 1e-15);
    CHECK(end.evaluations == evaluations_each);
}

static void moving_inputs_are_gone_through_one_by_one(void) {
    FcStepResult result;
    FcMessage message;
    CHECK(step((Case){512.0, 1.0, 3.5 * PERIOD}, &result, &message));
    CHECK(asked.calls == 4);
    double delta = 1.0;
    for (int k = 0; k < 4; k++) {
        const double begin = k * PERIOD;
        CHECK(asked.duration[k] == (k < 3 ? PERIOD : 0.5 * PERIOD) && asked.scope[k] == FC_MAP_THIS_START);
        CHECK(asked.V[k] == 2.0 + 512.0 * begin);
        CHECK(asked.d[k] == 1.0 + 256.0 * begin);
        CHECK(asked.E[k] == 8.0 + 128.0 * begin);
        CHECK_NEAR(asked.delta_0[k], delta, 1e-15);
        delta = 0.75 * delta + asked.V[k] * asked.duration[k];
    }
    CHECK_NEAR(result.delta, delta, 1e-15);
    CHECK_NEAR(result.impulse, 3.5 * PERIOD, 1e-15);
}

static void too_much_work_is_refused(void) {
    FcStepResult result;
    FcMessage message = {""};
    CHECK(!step((Case){1e-9, 1.0, (1e6 + 1.0) * PERIOD}, &result, &message));
    CHECK(asked.calls == 0 && strstr(message.text, "1000001 vibration periods"));
    CHECK(step((Case){1e-9, 1.0, 1e6 * PERIOD}, &result, &message));
    CHECK(asked.calls == 1000001);

    evaluations_each = 0.6 * FC_MOST_EVALUATIONS;
    CHECK(!step((Case){0.0, 1.0, 5.25 * PERIOD}, &result, &message));
    CHECK(strstr(message.text, "evaluations") && strchr(message.text, '\n') == NULL);
    CHECK(step((Case){0.0, 1.0, PERIOD}, &result, &message));
    evaluations_each = 9.0;
}

int main(void) {
    evaluations_each = 9.0;
    a_short_step_is_one_interval();
    equal_periods_are_a_power();
    a_billion_periods_cost_two_intervals();
    the_settled_force_takes_one_interval();
    moving_inputs_are_gone_through_one_by_one();
    too_much_work_is_refused();
    return check_result();
}
