// Fixed-step methods: explicit Euler, RK4, trapezoid and backward Euler, as a plain co-simulation FMU has
// them.
//
//     delta' = a(t) delta + b(t),     a = -sigma |V| / g,       b = V                          (Eq. 2)
//
// Every step is solver.stepSize long; the last one is shortened so that it ends at the communication point.
// Steps pass over reversals, as in such an FMU. The equation is affine, so the implicit methods are solved
// exactly with one division. The integrals of FcStepResult are quadrature equations of the same method.
#include <assert.h>
#include <math.h>

#include "solver/methods.h"

// The largest number of steps in a communication step, like FC_MOST_EVALUATIONS (solver.h): more would seem
// to hang.
#define MOST_FIXED_STEPS 1e8

// The largest difference from a whole number of steps that counts as a whole number, since hosts round their
// steps. Half of it adds a tiny last step for hosts that round more coarsely; twice of it stretches the steps
// by as much more.
#define STEP_ROUNDING 1e-6

// sigma |V| h / g up to which |growth per step| <= 1. Derived: of 1 - z, and of 1 - z + z^2/2 - z^3/6 +
// z^4/24.
#define EXPLICIT_EULER_LIMIT 2.0
#define RK4_LIMIT 2.785293563405282

// Samples of sigma |V| / g per vibration period: the largest one is within 0.1 % of the maximum, with half as
// many within about 0.4 %. If a step needs more than MOST_RATE_SAMPLES, they would take longer than the step,
// and the bound is taken.
#define SAMPLES_PER_PERIOD 256.0
#define MOST_RATE_SAMPLES 1e6

// The deflection and the integrals of FcStepResult.
typedef struct {
    double delta;   // m
    double impulse; // N s
    double work;    // J
    double heat;    // J
    double drag;    // m2/s
} Integrals;

static Integrals slope_at(const FcCoefficients* at, double delta) {
    const double F = at->sigma * delta;
    const double slip = fc_relaxation_rate(at) * delta; // V - delta'
    const double rate = at->V - slip;
    return (Integrals){rate, F, F * at->V, F * slip, rate * at->V};
}

static Integrals plus(Integrals y, double h, Integrals slope) {
    return (Integrals){y.delta + h * slope.delta, y.impulse + h * slope.impulse, y.work + h * slope.work,
                       y.heat + h * slope.heat, y.drag + h * slope.drag};
}

static Integrals explicit_euler(Integrals y, double h, const FcCoefficients* start) {
    return plus(y, h, slope_at(start, y.delta));
}

static Integrals backward_euler(Integrals y, double h, const FcCoefficients* end) {
    const double delta = (y.delta + h * end->V) / (1.0 + h * fc_relaxation_rate(end));
    Integrals next = plus(y, h, slope_at(end, delta));
    next.delta = delta;
    return next;
}

static Integrals trapezoid(Integrals y, double h, const FcCoefficients* start, const FcCoefficients* end) {
    const Integrals half = plus(y, 0.5 * h, slope_at(start, y.delta));
    return backward_euler(half, 0.5 * h, end);
}

static Integrals rk4(Integrals y, double h, const FcCoefficients* start, const FcCoefficients* middle,
                     const FcCoefficients* end) {
    const Integrals k1 = slope_at(start, y.delta);
    const Integrals k2 = slope_at(middle, y.delta + 0.5 * h * k1.delta);
    const Integrals k3 = slope_at(middle, y.delta + 0.5 * h * k2.delta);
    const Integrals k4 = slope_at(end, y.delta + h * k3.delta);
    return plus(plus(plus(plus(y, h / 6.0, k1), h / 3.0, k2), h / 3.0, k3), h / 6.0, k4);
}

// sigma |V| / g over [0, h] is at most this [1/s]: the product of the extremes.
static double rate_bound(const FcScene* scene, double h) {
    return fc_drive_largest_speed(&scene->drive, h) / fc_scene_smallest_saturation(scene, h);
}

static double rate_at(const FcScene* scene, double t) {
    const FcCoefficients at = fc_scene_coefficients(scene, t);
    return fc_relaxation_rate(&at);
}

// The largest sigma |V| / g over [0, h] [1/s], sampled; the bound if that would take too many samples. If the
// limit follows the load, or d and V vibrate out of phase, the extremes do not coincide, and the bound alone
// would refuse stable steps.
static double largest_rate(const FcScene* scene, double h) {
    const FcDrive* drive = &scene->drive;
    if (fc_drive_is_constant(drive)) {
        return rate_at(scene, 0.0);
    }
    double duration = h;
    double periods = 1.0;
    if (fc_drive_vibrates(drive)) {
        if (!fc_drive_is_linear(drive)) {
            duration = fmin(h, 1.0 / drive->vibration.f);
        }
        periods = fmax(1.0, duration * drive->vibration.f);
    }
    const double samples = ceil(SAMPLES_PER_PERIOD * periods);
    if (!(samples <= MOST_RATE_SAMPLES)) {
        return rate_bound(scene, h);
    }
    double largest = 0.0;
    for (double i = 0.0; i <= samples; i += 1.0) {
        const double t = duration * (i / samples);
        largest = fmax(largest, rate_at(scene, t));
    }
    return largest;
}

// Refuses an explicit method beyond its limit, whose numbers would grow without bound.
static bool check_stability(const FcScene* scene, const char* method, double limit, double step_size,
                            double step, double h, FcMessage* message) {
    if (rate_bound(scene, h) * step <= limit) {
        return true;
    }
    const double rate = largest_rate(scene, h);
    if (rate * step <= limit) {
        return true;
    }
    // Rounded down, so that the printed step is itself usable.
    const double usable = (1.0 - 1e-4) * limit / rate;
    fc_message_set(
        message,
        "solver.stepSize = %.5g s is too long for solver.method = %s: sigma |V| h / F_C = %.5g with the step "
        "h = %.5g s, and the method is stable up to %.5g; the largest usable step is %.5g s",
        step_size, method, rate * step, step, limit, usable);
    return false;
}

// If the bristle has a bound, a step ends on it or within it, and the energy lost by that is heat.
static Integrals within_bound(Integrals y, const FcFriction* friction, const FcCoefficients* at) {
    const double D = at->limit * fc_static_over_limit(friction, at->V) / at->sigma;
    assert(!(D < 0.0));
    if (fabs(y.delta) > D) {
        const double reached = copysign(D, y.delta);
        y.heat += 0.5 * at->sigma * (y.delta - reached) * (y.delta + reached);
        y.drag += at->V * (reached - y.delta);
        y.delta = reached;
    }
    return y;
}

static Integrals integrate(const FcScene* scene, FcMethod method, double step, double steps, double h,
                           Integrals y, double* evaluations) {
    assert(step > 0.0 && steps >= 1.0 && steps == floor(steps));
    const bool uses_start = method != FC_METHOD_BACKWARD_EULER;
    const bool uses_middle = method == FC_METHOD_RK4;
    const bool bounded = fc_is_bounded(scene->friction);
    const bool uses_end = method != FC_METHOD_EXPLICIT_EULER || bounded;
    *evaluations = steps + (uses_start && uses_end ? 1.0 : 0.0) + (uses_middle ? steps : 0.0);

    FcCoefficients start = {0.0, 0.0, 1.0};
    FcCoefficients middle = start;
    FcCoefficients end = start;
    if (uses_start) {
        start = fc_scene_coefficients(scene, 0.0);
    }
    double t = 0.0;
    for (double i = 1.0; i <= steps; i += 1.0) {
        const bool last = i == steps;
        const double t_next = last ? h : i * step;
        const double length = t_next - t;
        if (uses_middle) {
            middle = fc_scene_coefficients(scene, t + 0.5 * length);
        }
        if (uses_end || !last) {
            end = fc_scene_coefficients(scene, t_next);
        }
        switch (method) {
        case FC_METHOD_EXPLICIT_EULER:
            y = explicit_euler(y, length, &start);
            break;
        case FC_METHOD_RK4:
            y = rk4(y, length, &start, &middle, &end);
            break;
        case FC_METHOD_TRAPEZOID:
            y = trapezoid(y, length, &start, &end);
            break;
        default:
            y = backward_euler(y, length, &end);
            break;
        }
        if (bounded) {
            y = within_bound(y, scene->friction, &end);
        }
        start = end;
        t = t_next;
    }
    return y;
}

bool fc_fixed_step(const FcScene* scene, FcMethod method, const FcSolverOptions* options, double h,
                   FcStepResult* result, FcMessage* message) {
    assert(h >= 0.0 && options->step_size > 0.0);
    if (h == 0.0) {
        return true;
    }
    const double ratio = h / options->step_size;
    const double steps = fmax(1.0, ceil(ratio - STEP_ROUNDING));
    if (!(steps <= MOST_FIXED_STEPS)) {
        fc_message_set(
            message,
            "solver.stepSize = %.5g s cuts the communication step of %.5g s into %.5g steps; at most %.0e "
            "are allowed",
            options->step_size, h, ratio, MOST_FIXED_STEPS);
        return false;
    }
    const bool fits = fabs(steps - ratio) <= STEP_ROUNDING;
    const double step = fits || steps == 1.0 ? h / steps : options->step_size;

    if (method == FC_METHOD_EXPLICIT_EULER && !check_stability(scene, "explicitEuler", EXPLICIT_EULER_LIMIT,
                                                               options->step_size, step, h, message)) {
        return false;
    }
    if (method == FC_METHOD_RK4 &&
        !check_stability(scene, "rk4", RK4_LIMIT, options->step_size, step, h, message)) {
        return false;
    }

    double evaluations = 0.0;
    const Integrals y =
        integrate(scene, method, step, steps, h, (Integrals){.delta = result->delta}, &evaluations);
    if (!isfinite(y.delta) || !isfinite(y.impulse) || !isfinite(y.work) || !isfinite(y.heat) ||
        !isfinite(y.drag)) {
        return fc_message_set(
            message,
            "solver.stepSize = %.5g s: the deflection, the impulse or the work is no longer a finite number "
            "after a communication step of %.5g s",
            options->step_size, h);
    }
    result->delta = y.delta;
    result->impulse += y.impulse;
    result->work += y.work;
    result->heat += y.heat;
    result->drag += y.drag;
    result->evaluations += evaluations;
    return true;
}
