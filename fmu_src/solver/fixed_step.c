// Fixed-step methods: explicit Euler, RK4, trapezoid and backward Euler, as a plain co-simulation FMU has
// them.
//
//     delta' = V - r delta,     r = sigma |V| / g                                             (Eq. 2)
//
// A communication step is cut into equal steps of at most solver.stepSize. Steps pass over reversals, as in
// such an FMU. The equation is affine, so the implicit methods are solved exactly with one division. The
// integrals of FcStepResult are quadrature equations of the same method.
#include "solver/fixed_step.h"

#include <assert.h>
#include <math.h>

#include "model/extremes.h"
#include "solver/periods/segments.h"

// What a step takes of FC_MAX_EVALUATIONS (solver.h), at most; with a bound, at which each step makes a scene. Chosen
// empirically, for the same time.
#define OF_A_STEP 2.0
#define OF_A_BOUNDED_STEP 5.0

// The part of a step that makes no further step, since hosts round their steps. Half of it does for hosts
// that round more coarsely; twice of it stretches the steps by as much more.
#define STEP_ROUNDING 1e-6

// sigma |V| h / g up to which |growth per step| <= 1. Derived: of 1 - z, and of 1 - z + z^2/2 - z^3/6 +
// z^4/24.
#define EXPLICIT_EULER_LIMIT 2.0
#define RK4_LIMIT 2.785293563405282

// Samples of sigma |V| / g per vibration period: the largest one is within 0.1 % of the maximum, with half as
// many within about 0.4 %. More than MAX_RATE_SAMPLES would take longer than the step.
#define SAMPLES_PER_PERIOD 256.0
#define MAX_RATE_SAMPLES 1e6

// The rates of the deflection and of the integrals of FcStepResult.
typedef struct {
    double delta, impulse, work, heat, drag;
} Rates;

static Rates rates_at(const FcCoefficients* at, double delta) {
    const double F = at->sigma * delta;
    const double slip = fc_relaxation_rate(at) * delta; // V - delta'
    const double rate = at->V - slip;
    return (Rates){rate, F, F * at->V, F * slip, rate * at->V};
}

static void add(FcStepResult* y, double h, Rates rates) {
    y->delta += h * rates.delta;
    y->impulse += h * rates.impulse;
    y->work += h * rates.work;
    y->heat += h * rates.heat;
    y->drag += h * rates.drag;
}

static void explicit_euler(FcStepResult* y, double h, const FcCoefficients* start) {
    add(y, h, rates_at(start, y->delta));
}

static void backward_euler(FcStepResult* y, double h, const FcCoefficients* end) {
    const double delta = (y->delta + h * end->V) / (1.0 + h * fc_relaxation_rate(end));
    add(y, h, rates_at(end, delta));
    y->delta = delta;
}

static void rk4(FcStepResult* y, double h, const FcCoefficients* start, const FcCoefficients* middle,
                const FcCoefficients* end) {
    const Rates k1 = rates_at(start, y->delta);
    const Rates k2 = rates_at(middle, y->delta + 0.5 * h * k1.delta);
    const Rates k3 = rates_at(middle, y->delta + 0.5 * h * k2.delta);
    const Rates k4 = rates_at(end, y->delta + h * k3.delta);
    add(y, h / 6.0, k1);
    add(y, h / 3.0, k2);
    add(y, h / 3.0, k3);
    add(y, h / 6.0, k4);
}

// The largest sigma |V| / g over [0, h] [1/s], sampled.
static double largest_rate(const FcScene* scene, double h) {
    assert(h > 0.0);
    const FcDrive* drive = &scene->drive;
    const bool vibrates = fc_drive_vibrates(drive);
    const double f = vibrates ? drive->vibration.f : 0.0;
    const double span = fc_drive_is_linear(drive) || !vibrates ? h : fc_min(h, 1.0 / f);
    const double samples = fc_min(ceil(SAMPLES_PER_PERIOD * fc_max(1.0, span * f)), MAX_RATE_SAMPLES);
    double largest = 0.0;
    for (double i = 0.0; i <= samples; i += 1.0) {
        const FcCoefficients at = fc_scene_coefficients(scene, span * (i / samples));
        largest = fc_max(largest, fc_relaxation_rate(&at));
    }
    return largest;
}

// Refuses an explicit method beyond its limit, whose numbers would grow without bound.
static bool check_stability(const FcScene* scene, const char* method, double limit, double step_size,
                            double step, double h, FcMessage* message) {
    assert(limit > 0.0 && step > 0.0 && step <= h);
    const double bound = fc_drive_largest_speed(&scene->drive, h) / fc_scene_smallest_saturation(scene, h);
    if (bound * step <= limit) {
        return true;
    }
    const double rate = largest_rate(scene, h);
    // The usable step is rounded down, so that the printed one is itself usable.
    return rate * step <= limit ||
           fc_message_set(
               message,
               "solver.stepSize = %.5g s is too long for solver.method = %s: sigma |V| h / F_C = %.5g with "
               "the step h = %.5g s, and the method is stable up to %.5g; the largest usable step "
               "is %.5g s",
               step_size, method, rate * step, step, limit, (1.0 - 1e-4) * limit / rate);
}

// A step from t to t_next; *start are the coefficients at t, and become those at t_next, if the method uses
// both.
static void take_step(FcMethod method, const FcScene* scene, FcStepResult* y, double t, double t_next,
                      FcCoefficients* start) {
    const double h = t_next - t;
    assert(h >= 0.0 && method != FC_METHOD_COLLOCATION && method != FC_METHOD_CVODE);
    if (method == FC_METHOD_EXPLICIT_EULER) {
        const FcCoefficients at = fc_scene_coefficients(scene, t);
        explicit_euler(y, h, &at);
        return;
    }
    const FcCoefficients end = fc_scene_coefficients(scene, t_next);
    if (method == FC_METHOD_BACKWARD_EULER) {
        backward_euler(y, h, &end);
    } else if (method == FC_METHOD_TRAPEZOID) {
        explicit_euler(y, 0.5 * h, start);
        backward_euler(y, 0.5 * h, &end);
    } else {
        const FcCoefficients middle = fc_scene_coefficients(scene, t + 0.5 * h);
        rk4(y, h, start, &middle, &end);
    }
    *start = end;
}

static double steps_in(double h, double size) { return fc_max(1.0, ceil(h / size - STEP_ROUNDING)); }

bool fc_check_fixed_steps(const FcScene* scene, double size, double h, FcMessage* message) {
    assert(size > 0.0 && h >= 0.0);
    const double steps = steps_in(h, size);
    const double most = FC_MAX_EVALUATIONS / (fc_is_bounded(scene->friction) ? OF_A_BOUNDED_STEP : OF_A_STEP);
    return steps <= most ||
           fc_message_set(
               message,
               "solver.stepSize = %.5g s cuts the communication step of %.5g s into %.5g steps; at most %.0e "
               "are allowed",
               size, h, steps, most);
}

bool fc_fixed_step(const FcScene* scene, FcMethod method, const FcSolverOptions* options, double h,
                   FcStepResult* result, FcMessage* message) {
    assert(h >= 0.0 && options->step_size > 0.0);
    if (h == 0.0) {
        return true;
    }
    const double size = options->step_size;
    const double steps = steps_in(h, size);
    const double step = h / steps;
    assert(step <= (1.0 + 2.0 * STEP_ROUNDING) * size);
    if ((method == FC_METHOD_EXPLICIT_EULER &&
         !check_stability(scene, "explicitEuler", EXPLICIT_EULER_LIMIT, size, step, h, message)) ||
        (method == FC_METHOD_RK4 && !check_stability(scene, "rk4", RK4_LIMIT, size, step, h, message))) {
        return false;
    }
    const bool bounded = fc_is_bounded(scene->friction);
    FcCoefficients start = {0.0, 0.0, 1.0};
    if (method == FC_METHOD_TRAPEZOID || method == FC_METHOD_RK4) {
        start = fc_scene_coefficients(scene, 0.0);
        result->evaluations += 1.0;
    }
    for (double i = 1.0; i <= steps; i += 1.0) {
        const double t_next = h * (i / steps);
        take_step(method, scene, result, h * ((i - 1.0) / steps), t_next, &start);
        if (bounded) { // one beyond its bound is moved onto it
            const FcScene end = fc_scene_from(scene, t_next);
            fc_project_result(&end, result);
        }
    }
    result->evaluations += method == FC_METHOD_RK4 ? 2.0 * steps : steps;
    return true;
}
