// The integral of the lag against the bristle's equation in some million steps, each exact for coefficients that stand still.
#include "solver/settled_lag.h"

#include "check.h"
#include "random.h"
#include "table_1.h"

static const double LIMIT = 55.0;

typedef struct {
    FcContactParameters contact;
    FcFriction friction;
    FcScene scene;
    FcInterval interval;
    FcStretch stretch;
} Slider;

// A stretch from one reversal to the next, whose layers are up to a hundredth of it.
static void draw(Slider* slider) {
    slider->contact = table_1(FC_CONTACT_ASPERITIES, FC_CONTACT_SEPARATION);
    slider->contact.stiffnessScale = random_log(1e-3, 1e-1);
    slider->friction =
        (FcFriction){.model = FC_DAHL, .limit = FC_LIMIT_CONSTANT, .staticRatio = 1.0, .V_S = 0.05};
    const FcContactAtModulus at_E = fc_contact_at_modulus(&slider->contact, 58e9);
    const FcVibration vibration = {
        .f = 20e3, .V_1 = 1.4, .a_d = random_log(1e-7, 1.2e-6), .phase_d = 6.3 * random_01()};
    const FcDrive drive = fc_drive_make((FcLinearInput){1.4 * (random_01() - 0.5), 0.0},
                                        (FcLinearInput){14e-6, 0.0}, (FcLinearInput){58e9, 0.0},
                                        (FcLinearInput){200.0, 0.0}, vibration, random_01() / 20e3, 0.0);
    FcScene* scene = &slider->scene;
    *scene = fc_scene_make(&slider->contact, &at_E, &slider->friction, LIMIT, &drive);
    const double start = fc_drive_next_event(&drive, 0.0, 1e-4).time;
    const double end = fc_drive_next_event(&drive, start, 1e-4).time;
    const FcVelocity V[] = {fc_drive_velocity(&drive, start), fc_drive_velocity(&drive, end)};
    const FcCoefficients at[] = {fc_scene_coefficients(scene, start), fc_scene_coefficients(scene, end)};
    const FcSolverOptions options = {.tolerance = 1e-3, .force = LIMIT};
    slider->interval = fc_interval_make(scene, scene, end, &options);
    slider->stretch = (FcStretch){.interval = &slider->interval,
                                  .start = start,
                                  .end = end,
                                  .event = end,
                                  .reversal = true,
                                  .at_start = at[0],
                                  .at_end = at[1]};
    slider->stretch.w_a = slider->stretch.back = fc_layer(&V[0], at[0].sigma / LIMIT);
    slider->stretch.w_b = fc_layer(&V[1], at[1].sigma / LIMIT);
}

typedef struct {
    double time; // s, integral of the force over the limit, less 1
    double drag; // m2/s, integral of V delta'
} Exact;

// From the limit itself at the time t on, in steps of a thirtieth of the time to relax.
static Exact exact(const Slider* slider, double t, double end) {
    const FcScene* scene = &slider->scene;
    const FcCoefficients start = fc_scene_coefficients(scene, t);
    const double side = start.V < 0.0 ? -1.0 : 1.0;
    double delta = side * LIMIT / start.sigma;
    Exact sum = {0.0, 0.0};
    while (t < end) {
        const FcCoefficients here = fc_scene_coefficients(scene, t);
        const double relaxes = 1.0 / fmax(fc_relaxation_rate(&here), 1.0 / slider->stretch.w_b);
        const double h = fmin(0.03 * relaxes, end - t);
        const FcCoefficients at = fc_scene_coefficients(scene, t + 0.5 * h);
        const double D = side * LIMIT / at.sigma;
        const double gone = -expm1(-fc_relaxation_rate(&at) * h);
        const double middle = delta + (D - delta) * -expm1(-0.5 * fc_relaxation_rate(&at) * h);
        const double after = delta + (D - delta) * gone;
        sum.time += h * (side * at.sigma * middle / LIMIT - 1.0);
        sum.drag += at.V * (after - delta);
        delta = after;
        t = t + h < end ? t + h : end;
    }
    return sum;
}

static void lag_is_that_of_the_equation(void) {
    int told = 0;
    for (int k = 0; k < 8; k++) {
        Slider slider;
        draw(&slider);
        const FcStretch* stretch = &slider.stretch;
        const double length = stretch->end - stretch->start;
        const double t = stretch->start + length * (k % 3 == 0 ? 0.5 : k % 3 == 1 ? 0.2 : 0.06);
        const double end = k % 4 == 3 ? stretch->end - 0.2 * length : stretch->end;
        const FcCoefficients at_t = fc_scene_coefficients(&slider.scene, t);
        FcLagSpan span = {.stretch = stretch,
                          .t = t,
                          .end = end,
                          .rate = fc_relaxation_rate(&at_t),
                          .V_at_t = fc_drive_velocity(&slider.scene.drive, t),
                          .V_at_end = fc_drive_velocity(&slider.scene.drive, end),
                          .at_end = fc_scene_coefficients(&slider.scene, end),
                          .rho = fc_scene_log_rates(&slider.scene, end).sigma,
                          .allowed = 1e-6};
        FcLag lag;
        double too_long = INFINITY;
        double evaluations = 0.0;
        CHECK(fc_settled_lag(&span, &lag, &too_long, &evaluations) && evaluations == FC_LAG_NODES);
        FcLag last = lag;
        double allowed = span.allowed; // the least that it promises
        while (fc_settled_lag(&span, &lag, &too_long, &evaluations)) {
            last = lag;
            allowed = span.allowed;
            span.allowed *= 0.8;
        }
        const Exact right = exact(&slider, t, end);
        CHECK_WITHIN(last.time, right.time, allowed + 1e-4 * fabs(right.time));
        told += allowed < 0.2 * fabs(right.time);
        CHECK_NEAR((at_t.V < 0.0 ? -1.0 : 1.0) * LIMIT * last.drag, right.drag, 5e-3);
    }
    CHECK(told >= 4); // so that it says something
}

int main(void) {
    lag_is_that_of_the_equation();
    return check_result();
}
