// The default method. Inputs held and no vibration: the closed form. Otherwise 9-stage Radau IIA steps, split
// exactly at the reversals of V, where |V| has a kink, and graded towards them:
//
//        reversal                                        reversal
//     |V|   |.  '   '      '         '         '      '   '  .|
//           |-|--|----|--------|-----------|--------|----|--|-|      steps
//            w_a                                            w_b      layers
//
// After a reversal the force relaxes within a layer w; before one the deflection lags behind a moving stiffness
// within a layer as wide. A step at distance x from a layer's event is at most resolution (x + w) long, so a few
// steps cross any number of decades. The resolution is what the error control moves: an error per step of at most
// tolerance F_C times the fraction that relaxes in the step, which bounds the error after any number of steps.
#include <math.h>
#include <stdio.h>

#include "periods.h"
#include "radau_step.h"

// Estimated errors are held this far below the tolerance: the estimate is within a factor of 10 for 99 % of steps.
static const double SAFETY = 0.1;
// The error of a step goes about as this power of the resolution.
static const double ORDER = 12.0;
// Steps are at most resolution * this, in the time over which the logarithm of sigma or the phase moves by 1.
static const double SMOOTH_STEP = 2.0;
static const double SMALLEST_RESOLUTION = 0.05;
// sigma itself must stay resolved where nothing relaxes and no error is seen.
static const double LARGEST_RESOLUTION = 2.0;
// Rounding in a step, over F_C: asking for less would only shorten steps.
static const double ROUNDING = 2e-13;

// Time [s] in which the bristle relaxes by 1 from t on: about the least root of g x + g' x^2 / 2 = 1
// and g'' x^3 / 6 = 1. The last one counts where V only touches zero.
static double relaxation_layer(const DahlProblem* problem, double t) {
    const Drive* drive = &problem->drive;
    const double per_speed = dahl_stiffness(problem, t) / problem->F_C;
    const double g = per_speed * fabs(drive_V(drive, t));
    const double g_rate = per_speed * fabs(drive_V_rate(drive, t));
    const double g_curvature = per_speed * fabs(drive_V_curvature(drive, t));
    return fmin(2.0 / (g + sqrt(g * g + 2.0 * g_rate)), cbrt(6.0 / g_curvature));
}

// Width [s] of a dip of |V| at t that does not reach zero: that of the parabola, or the time to relax by 1 in it.
static double dip_layer(const DahlProblem* problem, double t) {
    const Drive* drive = &problem->drive;
    const double curvature = fabs(drive_V_curvature(drive, t));
    const double per_speed = dahl_stiffness(problem, t) / problem->F_C;
    return fmax(sqrt(2.0 * fabs(drive_V(drive, t)) / curvature), cbrt(6.0 / (per_speed * curvature)));
}

// Layer [s] at the start of a communication step: none if delta_0 is where the bristle has settled, to first order in
// the time it takes to relax, so that it only follows V and sigma on their own scales.
static double start_layer(const DahlProblem* problem, double delta_0, double tolerance) {
    const DahlCoefficients now = dahl_coefficients(problem, 0.0);
    const double g = now.sigma * fabs(now.V) / problem->F_C;
    const double settled = copysign(1.0, now.V) * (1.0 + dahl_log_stiffness_rate(problem, 0.0) / g);
    if (fabs(now.sigma * delta_0 / problem->F_C - settled) <= SAFETY * tolerance) {
        const Drive* drive = &problem->drive; // distance of the reversal behind, width of the dip
        return fmin(fabs(now.V / drive_V_rate(drive, 0.0)),
                    sqrt(2.0 * fabs(now.V / drive_V_curvature(drive, 0.0))));
    }
    return relaxation_layer(problem, 0.0);
}

// How fast the phase and ln(sigma) move at the most, and whether the surfaces come so close, or the modulus moves so
// far, that 1/d^3 and E have to be followed instead of bounded.
typedef struct {
    double rate; // 1/s
    int follows_d_and_E;
} Smoothness;

static Smoothness smoothness(const DahlProblem* problem, double h) {
    const Drive* drive = &problem->drive;
    Smoothness smooth = {.rate = drive_vibrates(drive) ? drive->omega : 0.0};
    if (problem->at_E.constant) {
        return smooth;
    }
    const double d_rate = fabs(drive->d.rate) + drive->vibration.a_d * drive->omega;
    const double by_nearness = 3.0 / drive_smallest_d(drive, h);
    const double E = drive_smallest_E(drive, h);
    smooth.rate += 2.0 * problem->at_E.decay * d_rate;
    smooth.follows_d_and_E =
        (d_rate > 0.0 && by_nearness > 2.0 * problem->at_E.decay) || drive_largest_E(drive, h) > 100.0 * E;
    if (!smooth.follows_d_and_E) {
        smooth.rate += by_nearness * d_rate + fabs(drive->E.rate) / E;
    }
    return smooth;
}

// Time [s] from t on over which the phase or ln(sigma) moves by 1, at the least.
static double smooth_time(const DahlProblem* problem, const Smoothness* smooth, double t) {
    if (!smooth->follows_d_and_E) {
        return 1.0 / smooth->rate;
    }
    const Drive* drive = &problem->drive;
    // Twice the rates at t: they rise while the step goes on.
    const double by_nearness = 2.0 * 3.0 / drive_d(drive, t);
    const double by_E = 2.0 * fabs(drive->E.rate) / drive_E(drive, t);
    const double rate = smooth->rate + by_nearness * fabs(drive_d_rate(drive, t)) + by_E;
    const double curvature = by_nearness * drive->vibration.a_d * drive->omega * drive->omega;
    return 2.0 / (rate + sqrt(rate * rate + 2.0 * curvature)); // rate x + curvature x^2 / 2 = 1
}

// Where the two trajectories of the interval's map are: P started from 1 and Q started from 0. For one start alone
// P is 0 from the beginning and Q starts from there.
typedef struct {
    DahlMap map;
    double resolution;
    Smoothness smooth;
    double delta_scale;     // m, size of the deflection at the start
    double delta_tolerance; // m, error allowed in the deflection
    double evaluations;     // in the communication step so far
} Progress;

// A stretch of time on which V keeps its sign, and the events on both sides that its steps are graded towards. The
// event ahead may lie beyond the end.
typedef struct {
    double start, end; // s
    double event;      // s, at or beyond the end; infinite if there is none
    double w_a, w_b;   // s, layers at the start and at the event
} Stretch;

// Length [s] of the step at t.
static double graded_step(const Progress* progress, const DahlProblem* problem, const Stretch* stretch,
                          double t) {
    const double resolution = progress->resolution;
    const double end = stretch->end;
    const double left = end - t;
    const double after = resolution * (t - stretch->start + stretch->w_a);
    const double before = resolution / (1.0 + resolution) * (stretch->event - t + stretch->w_b);
    const double smooth = resolution * SMOOTH_STEP * smooth_time(problem, &progress->smooth, t);
    const double smallest = 4e-16 * end; // below this t + h would not move
    const double h = fmax(smallest, fmin(smooth, fmin(after, before)));
    if (h >= left / 1.1) {
        return left;
    }
    return h > 0.5 * left ? 0.5 * left : h;
}

// Estimated error over what the step is allowed, for the map's two trajectories.
static double relative_error(const Progress* progress, const RadauStep* step, double F_C) {
    const double P = 1.0 - progress->map.relaxation;
    const RadauTail full = radau_tail_full(step, progress->map.offset);
    double error = radau_error(&full, step->z_mean);
    if (P != 0.0) {
        const RadauTail homogeneous = radau_tail_homogeneous(step, P * progress->delta_scale);
        error += radau_error(&homogeneous, step->z_mean);
    }
    const double rounding = ROUNDING * F_C / step->sigma[RADAU_STAGES - 1];
    const double allowed = fmax(SAFETY * progress->delta_tolerance, rounding) * fmin(1.0, step->z_mean);
    return error > 0.0 ? error / allowed : 0.0;
}

// Adds the step to the map.
static void accept(Progress* progress, const RadauStep* step, double h) {
    DahlMap* map = &progress->map;
    const double P = 1.0 - map->relaxation;
    const double Q = map->offset;
    const double relaxed = radau_impulse_relaxed(step, h);
    map->impulse_slope += relaxed * P;
    map->impulse_offset += relaxed * Q + radau_impulse_driven(step, h);
    map->relaxation -= P * step->relaxed[RADAU_STAGES - 1];
    map->offset += Q * step->relaxed[RADAU_STAGES - 1] + step->driven[RADAU_STAGES - 1];
}

// Goes through a stretch.
static void cross(Progress* progress, const DahlProblem* problem, const Stretch* stretch) {
    const double start = stretch->start;
    const double end = stretch->end;
    const double V_middle = drive_V(&problem->drive, 0.5 * (start + end));
    const double sign = V_middle > 0.0 ? 1.0 : V_middle < 0.0 ? -1.0 : 0.0;
    const DahlMap before = progress->map;
    double t = start;
    while (t < end && progress->evaluations <= FC_MOST_EVALUATIONS) {
        const double h = graded_step(progress, problem, stretch, t);
        RadauStep step;
        radau_step(problem, t, h, sign, &step);
        progress->evaluations += RADAU_STAGES;

        const double error = relative_error(progress, &step, problem->F_C);
        // 1.6^12 = 281: an error far below its bound needs no root.
        const double change = error < 1.0 / 300.0 ? 1.6 : fmax(0.3, pow(error, -1.0 / ORDER));
        const int can_shrink = progress->resolution > SMALLEST_RESOLUTION && t + 0.5 * h > t;
        if (error > 1.0 && can_shrink) {
            progress->resolution *= fmin(0.95 * change, 0.8);
            continue;
        }
        progress->resolution =
            fmax(SMALLEST_RESOLUTION, fmin(LARGEST_RESOLUTION, progress->resolution * change));
        accept(progress, &step, h);
        t = h < end - t ? t + h : end;
    }
    // Work from F |V| = F_C (|V| - s delta'), exact and without quadrature.
    DahlMap* map = &progress->map;
    const double path = sign * drive_displacement(&problem->drive, start, end);
    map->work_slope += sign * problem->F_C * (map->relaxation - before.relaxation);
    map->work_offset += problem->F_C * (path - sign * (map->offset - before.offset));
}

// Without stiffness there is no force: the bristle goes with V.
static DahlMap slack_map(const DahlProblem* problem, double h) {
    DahlMap map = dahl_identity();
    map.offset = drive_displacement(&problem->drive, 0.0, h);
    return map;
}

static DahlMap collocation_interval(const DahlProblem* problem, const SolverOptions* options, double duration,
                                    double delta_0, MapScope scope, double* evaluations) {
    const Drive* drive = &problem->drive;
    const double saturated = problem->F_C / dahl_largest_stiffness(problem, duration);
    if (!isfinite(saturated)) {
        return slack_map(problem, duration);
    }
    Progress progress = {
        .map = dahl_identity(),
        .resolution = 1.5 * pow(options->tolerance, 1.0 / (2 * RADAU_STAGES)),
        .smooth = smoothness(problem, duration),
        .delta_scale = fmax(fabs(delta_0), problem->F_C / dahl_stiffness(problem, 0.0)),
        .delta_tolerance = options->tolerance * saturated,
        .evaluations = *evaluations,
    };
    Stretch stretch = {0};
    if (scope == MAP_THIS_START) {
        progress.map.relaxation = 1.0;
        progress.map.offset = delta_0;
        stretch.w_a = start_layer(problem, delta_0, options->tolerance);
    } else {
        stretch.w_a = relaxation_layer(problem, 0.0);
    }
    while (stretch.start < duration && progress.evaluations <= FC_MOST_EVALUATIONS) {
        // An event farther beyond the end than the end is from here does not shape the steps.
        const double horizon = duration + (duration - stretch.start);
        const DriveEvent event = drive_next_event(drive, stretch.start, horizon);
        stretch.event = event.time < horizon ? event.time : INFINITY;
        stretch.end = fmin(event.time, duration);
        if (event.time < horizon) {
            stretch.w_b =
                event.reversal ? relaxation_layer(problem, stretch.end) : dip_layer(problem, stretch.end);
        }
        cross(&progress, problem, &stretch);
        stretch.start = stretch.end;
        stretch.w_a = stretch.w_b;
    }
    *evaluations = progress.evaluations;
    return progress.map;
}

int collocation_step(const DahlProblem* problem, const SolverOptions* options, double h, double delta_0,
                     StepResult* result, Message* message) {
    const Drive* drive = &problem->drive;
    if (!drive_is_constant(drive)) {
        StepResult moving;
        if (!periods_step(collocation_interval, problem, options, h, delta_0, &moving, message)) {
            return 0;
        }
        if (moving.evaluations > FC_MOST_EVALUATIONS) {
            snprintf(
                message->text, sizeof message->text,
                "the step of %.9g s needs more than %.0e evaluations: an input or the separation moves over "
                "too many orders of magnitude in it; use smaller steps, or cut the motion",
                h, FC_MOST_EVALUATIONS);
            return 0;
        }
        *result = moving;
        return 1;
    }
    const DahlMap map = dahl_constant_map(drive->V.value, dahl_stiffness(problem, 0.0), problem->F_C, h);
    *result = (StepResult){
        .delta = (1.0 - map.relaxation) * delta_0 + map.offset,
        .impulse = map.impulse_slope * delta_0 + map.impulse_offset,
        .work = map.work_slope * delta_0 + map.work_offset,
        .evaluations = 1.0,
    };
    return 1;
}
