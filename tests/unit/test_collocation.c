// The default method over an interval against brute force: short steps of constant coefficients, those of the step's
// middle, each solved exactly. Their error falls with the square of the step; with 4e5 steps a period it is below 1e-8,
// but for the end of a stiff contact: there the bristle has settled on what the last step's middle asks for.
#include "check.h"
#include "solver/collocation.h"
#include "table_1.h"

static const double PERIOD = 5e-5; // s
static const double F_C = 55.0;    // N
static const double V_1 = 1.44;    // m/s
enum { STEPS = 400000 };

typedef struct {
    FcContactParameters contact;
    FcFriction friction;
    FcScene scene;
} Slider;

// A slider whose stiffness at 14 um is about sigma [N/m]; what it points to lies in *slider.
static void make(Slider* slider, double sigma, int model, double V, double start) {
    slider->contact = table_1(FC_CONTACT_ASPERITIES, FC_CONTACT_SEPARATION);
    slider->contact.stiffnessScale = sigma / 5.743065402e12;
    slider->friction = (FcFriction){
        .model = model, .limit = FC_LIMIT_CONSTANT, .mu = 0.176, .staticRatio = 1.4, .V_S = 0.01 * V_1};
    const FcContactAtModulus at_E = fc_contact_at_modulus(&slider->contact, 58.556936170e9);
    const FcVibration vibration = {.f = 1.0 / PERIOD, .V_1 = V_1, .a_d = 1.1e-6, .phase_d = 0.7};
    const FcDrive drive =
        fc_drive_make((FcLinearInput){V, 0.0}, (FcLinearInput){14e-6, 0.0},
                      (FcLinearInput){58.556936170e9, 0.0}, (FcLinearInput){0.0, 0.0}, vibration, start, 0.0);
    slider->scene = fc_scene_make(&slider->contact, &at_E, &slider->friction, F_C, &drive);
}

static FcStepResult brute_force(const FcScene* scene, double h, double delta_0) {
    FcStepResult sum = {.delta = delta_0};
    const double step = h / STEPS;
    for (int i = 0; i < STEPS; i++) {
        const FcCoefficients at = fc_scene_coefficients(scene, (i + 0.5) * step);
        const FcMap map = fc_map_of_constant_scene(&at, step);
        fc_map_apply(&map, &sum);
    }
    return sum;
}

static double evaluations_of(const Slider* slider, double h, double tolerance) {
    const FcScene* scene = &slider->scene;
    const FcCoefficients start = fc_scene_coefficients(scene, 0.0);
    const double delta_0 = 0.3 * start.limit / start.sigma;
    const FcSolverOptions options = {.tolerance = tolerance, .step_size = 1e-8};
    double evaluations = 0.0;
    const FcMap map = fc_collocation_interval(scene, &options, h, delta_0, FC_MAP_THIS_START, &evaluations);
    FcStepResult found = {.delta = delta_0};
    fc_map_apply(&map, &found);
    const FcStepResult exact = brute_force(scene, h, delta_0);
    const double path = fc_drive_largest_speed(&scene->drive, h) * h;
    const double of_last_step = fabs(fc_scene_log_rates(scene, h).sigma) * h / STEPS;
    CHECK_WITHIN(fc_scene_stiffness(scene, h) * found.delta, fc_scene_stiffness(scene, h) * exact.delta,
                 (tolerance + of_last_step) * F_C);
    CHECK_WITHIN(found.impulse, exact.impulse, tolerance * F_C * h);
    CHECK_WITHIN(found.work, exact.work, tolerance * F_C * path);
    CHECK_WITHIN(found.heat, exact.heat, tolerance * F_C * path);
    return evaluations;
}

// From contacts without to contacts with nothing but settled panels.
static void every_stiffness_and_tolerance(void) {
    Slider slider;
    const int models[] = {FC_DAHL, FC_LUGRE};
    for (int law = 0; law < 2; law++) {
        for (double sigma = 6e4; sigma < 1e13; sigma *= 100.0) {
            for (double tolerance = 1e-2; tolerance > 1e-7; tolerance *= 1e-2) {
                make(&slider, sigma, models[law], 5e-3, 1.3e-5);
                evaluations_of(&slider, 1.07 * PERIOD, tolerance);
            }
        }
    }
}

// A panel a layer and one for the rest: the loosest tolerance in the stiffest contact costs next to nothing.
static void a_settled_stretch_is_one_panel(void) {
    Slider slider;
    make(&slider, 6e12, FC_DAHL, 5e-3, 1.3e-5);
    CHECK(evaluations_of(&slider, 1.07 * PERIOD, 1e-3) < 30.0);
}

// The transient of a start that is far from settled, and ends close before and after a reversal.
static void ends_around_a_reversal(void) {
    Slider slider;
    make(&slider, 6e11, FC_DAHL, 0.0, 0.0);
    for (double end = 0.2499; end < 0.2502; end += 2e-5) {
        evaluations_of(&slider, end * PERIOD, 1e-3);
    }
}

int main(void) {
    every_stiffness_and_tolerance();
    a_settled_stretch_is_one_panel();
    ends_around_a_reversal();
    return check_result();
}
