// Fixed-step methods: explicit Euler, RK4, trapezoid and backward Euler, as a plain co-simulation FMU has
// them.
//
//     delta' = a(t) delta + b(t),     a = -sigma |V| / F_C,     b = V                          (Eq. 2)
//
// Every step is solver.stepSize long; the last one is shortened so that it ends at the communication point.
// Reversals are stepped over, as such an FMU does. The equation is affine, so the implicit methods are solved
// exactly with one division. The impulse and the work are two more quadrature equations of the same method.
#include <math.h>
#include <stdio.h>

#include "solver.h"

#define MOST_STEPS 1e8

// A step that fits this fraction of a step less or more than a whole number of times is taken to fit exactly.
#define STEP_ROUNDING 1e-6

// sigma |V| h / F_C up to which |growth per step| <= 1: of 1 - z, and of 1 - z + z^2/2 - z^3/6 + z^4/24.
#define EXPLICIT_EULER_LIMIT 2.0
#define RK4_LIMIT 2.785293563405282

// Samples of sigma |V| per vibration period; the largest one is within 0.1 % of the maximum.
#define SAMPLES_PER_PERIOD 256.0
#define MOST_SAMPLES 1e6

typedef struct {
    double delta;   // m
    double impulse; // N s
    double work;    // J
} Integrals;

typedef struct {
    double sigma; // N/m
    double V;     // m/s
    double a;     // 1/s
} Coefficients;

static Coefficients coefficients_at(const DahlProblem* problem, double t) {
    Coefficients at;
    at.sigma = dahl_stiffness(problem, t);
    at.V = drive_V(&problem->drive, t);
    at.a = -at.sigma * fabs(at.V) / problem->F_C;
    return at;
}

static Integrals slope_at(const Coefficients* at, double delta) {
    const double F = at->sigma * delta;
    return (Integrals){at->a * delta + at->V, F, F * at->V};
}

static Integrals plus(Integrals y, double h, Integrals slope) {
    return (Integrals){y.delta + h * slope.delta, y.impulse + h * slope.impulse, y.work + h * slope.work};
}

static Integrals explicit_euler(Integrals y, double h, const Coefficients* start) {
    return plus(y, h, slope_at(start, y.delta));
}

static Integrals backward_euler(Integrals y, double h, const Coefficients* end) {
    const double delta = (y.delta + h * end->V) / (1.0 - h * end->a);
    const Integrals slope = slope_at(end, delta);
    return (Integrals){delta, y.impulse + h * slope.impulse, y.work + h * slope.work};
}

static Integrals trapezoid(Integrals y, double h, const Coefficients* start, const Coefficients* end) {
    const Integrals half = plus(y, 0.5 * h, slope_at(start, y.delta));
    return backward_euler(half, 0.5 * h, end);
}

static Integrals rk4(Integrals y, double h, const Coefficients* start, const Coefficients* middle,
                     const Coefficients* end) {
    const Integrals k1 = slope_at(start, y.delta);
    const Integrals k2 = slope_at(middle, y.delta + 0.5 * h * k1.delta);
    const Integrals k3 = slope_at(middle, y.delta + 0.5 * h * k2.delta);
    const Integrals k4 = slope_at(end, y.delta + h * k3.delta);
    return plus(plus(plus(plus(y, h / 6.0, k1), h / 3.0, k2), h / 3.0, k3), h / 6.0, k4);
}

// sigma(t) |V(t)| over [0, h] is at most this [N/s]: the product of the two largest values.
static double power_bound(const DahlProblem* problem, double h) {
    return dahl_largest_stiffness(problem, h) * drive_largest_speed(&problem->drive, h);
}

// The largest sigma(t) |V(t)| over [0, h] [N/s], sampled; the bound where that would take too many samples.
static double largest_stiffness_rate(const DahlProblem* problem, double h) {
    const Drive* drive = &problem->drive;
    if (drive_is_constant(drive)) {
        return dahl_stiffness(problem, 0.0) * fabs(drive_V(drive, 0.0));
    }
    double duration = h;
    double periods = 1.0;
    if (drive_vibrates(drive)) {
        if (!drive_is_linear(drive)) {
            duration = fmin(h, 1.0 / drive->vibration.f);
        }
        periods = fmax(1.0, duration * drive->vibration.f);
    }
    const double samples = ceil(SAMPLES_PER_PERIOD * periods);
    if (!(samples <= MOST_SAMPLES)) {
        return power_bound(problem, h);
    }
    double largest = 0.0;
    for (double i = 0.0; i <= samples; i += 1.0) {
        const double t = duration * (i / samples);
        largest = fmax(largest, dahl_stiffness(problem, t) * fabs(drive_V(drive, t)));
    }
    return largest;
}

// An explicit method beyond its limit would return numbers that grow without bound: refuse it.
static int check_stability(const DahlProblem* problem, const char* method, double limit, double step_size,
                           double step, double h, Message* message) {
    const double allowed = limit * problem->F_C;
    if (power_bound(problem, h) * step <= allowed) {
        return 1;
    }
    const double rate = largest_stiffness_rate(problem, h);
    if (rate * step <= allowed) {
        return 1;
    }
    // Rounded down, so that the printed step is itself usable.
    const double usable = (1.0 - 1e-4) * allowed / rate;
    snprintf(
        message->text, sizeof message->text,
        "solver.stepSize = %.5g s is too long for solver.method = %s: sigma |V| h / F_C = %.5g with the step "
        "h = %.5g s, and the method is stable up to %.5g; the largest usable step is %.5g s",
        step_size, method, rate * step / problem->F_C, step, limit, usable);
    return 0;
}

static Integrals integrate(const DahlProblem* problem, SolverMethod method, double step, double steps,
                           double h, Integrals y, double* evaluations) {
    const int uses_start = method != METHOD_BACKWARD_EULER;
    const int uses_middle = method == METHOD_RK4;
    const int uses_end = method != METHOD_EXPLICIT_EULER;
    *evaluations = steps + (uses_start && uses_end ? 1.0 : 0.0) + (uses_middle ? steps : 0.0);

    Coefficients start = {0.0, 0.0, 0.0};
    Coefficients middle = start;
    Coefficients end = start;
    if (uses_start) {
        start = coefficients_at(problem, 0.0);
    }
    double t = 0.0;
    for (double i = 1.0; i <= steps; i += 1.0) {
        const int last = i == steps;
        const double t_next = last ? h : i * step;
        const double length = t_next - t;
        if (uses_middle) {
            middle = coefficients_at(problem, t + 0.5 * length);
        }
        if (uses_end || !last) {
            end = coefficients_at(problem, t_next);
        }
        switch (method) {
        case METHOD_EXPLICIT_EULER:
            y = explicit_euler(y, length, &start);
            break;
        case METHOD_RK4:
            y = rk4(y, length, &start, &middle, &end);
            break;
        case METHOD_TRAPEZOID:
            y = trapezoid(y, length, &start, &end);
            break;
        default:
            y = backward_euler(y, length, &end);
            break;
        }
        start = end;
        t = t_next;
    }
    return y;
}

int fixed_step_step(const DahlProblem* problem, SolverMethod method, const SolverOptions* options, double h,
                    double delta_0, StepResult* result, Message* message) {
    if (h == 0.0) {
        *result = (StepResult){.delta = delta_0};
        return 1;
    }
    const double ratio = h / options->step_size;
    const double steps = fmax(1.0, ceil(ratio - STEP_ROUNDING));
    if (!(steps <= MOST_STEPS)) {
        snprintf(
            message->text, sizeof message->text,
            "solver.stepSize = %.5g s cuts the communication step of %.5g s into %.5g steps; at most %.0e "
            "are allowed",
            options->step_size, h, ratio, MOST_STEPS);
        return 0;
    }
    const int fits = fabs(steps - ratio) <= STEP_ROUNDING;
    const double step = fits || steps == 1.0 ? h / steps : options->step_size;

    if (method == METHOD_EXPLICIT_EULER && !check_stability(problem, "explicitEuler", EXPLICIT_EULER_LIMIT,
                                                            options->step_size, step, h, message)) {
        return 0;
    }
    if (method == METHOD_RK4 &&
        !check_stability(problem, "rk4", RK4_LIMIT, options->step_size, step, h, message)) {
        return 0;
    }

    double evaluations = 0.0;
    const Integrals y =
        integrate(problem, method, step, steps, h, (Integrals){.delta = delta_0}, &evaluations);
    if (!isfinite(y.delta) || !isfinite(y.impulse) || !isfinite(y.work)) {
        snprintf(
            message->text, sizeof message->text,
            "solver.stepSize = %.5g s: the deflection, the impulse or the work is no longer a finite number "
            "after a communication step of %.5g s",
            options->step_size, h);
        return 0;
    }
    *result = (StepResult){y.delta, y.impulse, y.work, evaluations};
    return 1;
}
