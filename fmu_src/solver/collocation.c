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
#include "solver/collocation.h"

#include <assert.h>
#include <math.h>

#include "solver/radau_step.h"

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

// Time [s] in which V moves by a fraction of itself and of a Stribeck velocity, so that g(V) is resolved: the root of
// |V'| x + |V''| x^2 / 2 = 0.3 V_S + 0.2 |V|. Infinite where g does not depend on V.
static double stribeck_time(const FcScene* scene, double t) {
    const FcFriction* friction = scene->friction;
    if (friction->model != FC_LUGRE || friction->staticRatio == 1.0) {
        return INFINITY;
    }
    const FcDrive* drive = &scene->drive;
    const double change = 0.3 * friction->V_S + 0.2 * fabs(fc_drive_V(drive, t));
    const double rate = fabs(fc_drive_V_rate(drive, t));
    const double curvature = fabs(fc_drive_V_curvature(drive, t));
    return 2.0 * change / (rate + sqrt(rate * rate + 2.0 * curvature * change));
}

// Time [s] in which the bristle relaxes by 1 from t on: about the least root of r x + r' x^2 / 2 = 1
// and r'' x^3 / 6 = 1. The last one counts where V only touches zero.
static double relaxation_layer(const FcScene* scene, double t) {
    const FcDrive* drive = &scene->drive;
    const FcCoefficients at = fc_scene_coefficients(scene, t);
    const double per_speed = at.sigma / at.limit;
    const double r = per_speed * fabs(at.V);
    const double r_rate = per_speed * fabs(fc_drive_V_rate(drive, t));
    const double r_curvature = per_speed * fabs(fc_drive_V_curvature(drive, t));
    const double relaxation = fmin(2.0 / (r + sqrt(r * r + 2.0 * r_rate)), cbrt(6.0 / r_curvature));
    return fmin(relaxation, stribeck_time(scene, t));
}

// Width [s] of a dip of |V| at t that does not reach zero: that of the parabola, or the time to relax by 1 in it.
static double dip_layer(const FcScene* scene, double t) {
    const FcDrive* drive = &scene->drive;
    const double curvature = fabs(fc_drive_V_curvature(drive, t));
    const FcCoefficients at = fc_scene_coefficients(scene, t);
    const double width =
        fmax(sqrt(2.0 * fabs(at.V) / curvature), cbrt(6.0 * at.limit / (at.sigma * curvature)));
    return fmin(width, stribeck_time(scene, t));
}

// Layer [s] at the start of a communication step: none if delta_0 is where the bristle has settled, to first order in
// the time it takes to relax, so that it only follows V and sigma on their own scales.
static double start_layer(const FcScene* scene, double delta_0, double tolerance) {
    const FcCoefficients now = fc_scene_coefficients(scene, 0.0);
    const FcLogRates rates = fc_scene_log_rates(scene, 0.0);
    const double r = -fc_coefficients_rate(&now);
    const double settled = copysign(now.limit, now.V) * (1.0 + (rates.sigma - rates.limit) / r);
    if (fabs(now.sigma * delta_0 - settled) <= SAFETY * tolerance * fc_scene_force_scale(scene)) {
        const FcDrive* drive = &scene->drive; // distance of the reversal behind, width of the dip
        return fmin(fabs(now.V / fc_drive_V_rate(drive, 0.0)),
                    sqrt(2.0 * fabs(now.V / fc_drive_V_curvature(drive, 0.0))));
    }
    return relaxation_layer(scene, 0.0);
}

// How fast the phase and the logarithms of sigma and g move at the most, and whether the surfaces come so close, or the
// modulus or the load move so far, that they have to be followed instead of bounded.
typedef struct {
    double rate; // 1/s
    bool follows_d_and_E;
} Smoothness;

static bool depends_on_d(const FcScene* scene) {
    return scene->at_E.model != FC_CONTACT_CONSTANT || scene->friction->limit == FC_LIMIT_LOAD;
}

static Smoothness smoothness(const FcScene* scene, double h) {
    const FcDrive* drive = &scene->drive;
    Smoothness smooth = {.rate = fc_drive_vibrates(drive) ? drive->omega : 0.0};
    if (!depends_on_d(scene)) {
        return smooth;
    }
    const double d_rate = fabs(drive->d.rate) + drive->vibration.a_d * drive->omega;
    const double by_nearness = 3.0 / fc_scene_smallest_d(scene, h);
    const double E = fc_drive_smallest_E(drive, h);
    smooth.rate += 2.0 * scene->at_E.decay * d_rate;
    smooth.follows_d_and_E = scene->floats || (d_rate > 0.0 && by_nearness > 2.0 * scene->at_E.decay) ||
                             fc_drive_largest_E(drive, h) > 100.0 * E;
    if (!smooth.follows_d_and_E) {
        smooth.rate += by_nearness * d_rate + fabs(drive->E.rate) / E;
    }
    return smooth;
}

// Time [s] from t on over which the phase, ln(sigma) or ln(g) moves by 1, at the least.
static double smooth_time(const FcScene* scene, const Smoothness* smooth, double t) {
    const double by_V = stribeck_time(scene, t);
    if (!smooth->follows_d_and_E) {
        return fmin(by_V, 1.0 / smooth->rate);
    }
    const FcDrive* drive = &scene->drive;
    // Twice the rates at t: they rise while the step goes on.
    const double by_nearness = 2.0 * 3.0 / fc_scene_d(scene, t);
    const double by_E = 2.0 * fabs(drive->E.rate) / fc_drive_E(drive, t);
    const double d_rate = fc_scene_d_rate(scene, t);
    const double floating =
        scene->floats ? 4.0 * scene->at_E.decay * fabs(d_rate - fc_drive_d_rate(drive, t)) : 0.0;
    const double rate = smooth->rate + by_nearness * fabs(d_rate) + by_E + floating;
    const double curvature = by_nearness * drive->vibration.a_d * drive->omega * drive->omega;
    return fmin(by_V, 2.0 / (rate + sqrt(rate * rate + 2.0 * curvature))); // rate x + curvature x^2 / 2 = 1
}

// Where the two trajectories of the interval's map are: P started from 1 and Q started from 0. For one start alone
// P is 0 from the beginning and Q starts from there.
typedef struct {
    FcMap map;
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
static double graded_step(const Progress* progress, const FcScene* scene, const Stretch* stretch, double t) {
    const double resolution = progress->resolution;
    const double end = stretch->end;
    const double left = end - t;
    const double after = resolution * (t - stretch->start + stretch->w_a);
    const double before = resolution / (1.0 + resolution) * (stretch->event - t + stretch->w_b);
    const double smooth = resolution * SMOOTH_STEP * smooth_time(scene, &progress->smooth, t);
    const double smallest = 4e-16 * end; // below this t + h would not move
    const double h = fmax(smallest, fmin(smooth, fmin(after, before)));
    if (h >= left / 1.1) {
        return left;
    }
    return h > 0.5 * left ? 0.5 * left : h;
}

// Estimated error over what the step is allowed, for the map's two trajectories.
static double relative_error(const Progress* progress, const FcRadauStep* step) {
    const double P = 1.0 - progress->map.relaxation;
    const FcRadauTail full = fc_radau_tail_full(step, progress->map.offset);
    double error = fc_radau_error(&full, step->z_mean);
    if (P != 0.0) {
        const FcRadauTail homogeneous = fc_radau_tail_homogeneous(step, P * progress->delta_scale);
        error += fc_radau_error(&homogeneous, step->z_mean);
    }
    const double rounding = ROUNDING * step->saturation;
    const double allowed = fmax(SAFETY * progress->delta_tolerance, rounding) * fmin(1.0, step->z_mean);
    return error > 0.0 ? error / allowed : 0.0;
}

// Goes through a stretch.
static void cross(Progress* progress, const FcScene* scene, const Stretch* stretch) {
    const double start = stretch->start;
    const double end = stretch->end;
    const double V_middle = fc_drive_V(&scene->drive, 0.5 * (start + end));
    const double sign = V_middle > 0.0 ? 1.0 : V_middle < 0.0 ? -1.0 : 0.0;
    double t = start;
    while (t < end && progress->evaluations <= FC_MOST_EVALUATIONS) {
        const double h = graded_step(progress, scene, stretch, t);
        FcRadauStep step;
        fc_radau_step(scene, t, h, sign, &step);
        progress->evaluations += FC_RADAU_STAGES;

        const double error = relative_error(progress, &step);
        // 1.6^12 = 281: an error far below its bound needs no root.
        const double change = error < 1.0 / 300.0 ? 1.6 : fmax(0.3, pow(error, -1.0 / ORDER));
        const bool can_shrink = progress->resolution > SMALLEST_RESOLUTION && t + 0.5 * h > t;
        if (error > 1.0 && can_shrink) {
            progress->resolution *= fmin(0.95 * change, 0.8);
            continue;
        }
        progress->resolution =
            fmax(SMALLEST_RESOLUTION, fmin(LARGEST_RESOLUTION, progress->resolution * change));
        const FcMap map = fc_radau_map(&step, h);
        progress->map = fc_map_compose(&progress->map, &map);
        t = h < end - t ? t + h : end;
    }
}

// Without stiffness there is no force: the bristle goes with V.
static FcMap slack_map(const FcScene* scene, double h) {
    FcMap map = fc_map_identity();
    map.offset = fc_drive_displacement(&scene->drive, 0.0, h);
    map.drag_offset = fc_drive_square(&scene->drive, 0.0, h);
    return map;
}

FcMap fc_collocation_interval(const FcScene* scene, const FcSolverOptions* options, double duration,
                              double delta_0, FcMapScope scope, double* evaluations) {
    assert(duration >= 0.0 && options->tolerance > 0.0);
    const FcDrive* drive = &scene->drive;
    const double saturated = fc_scene_force_scale(scene) / fc_scene_largest_stiffness(scene, duration);
    if (!isfinite(saturated)) {
        return slack_map(scene, duration);
    }
    const FcCoefficients start = fc_scene_coefficients(scene, 0.0);
    Progress progress = {
        .map = fc_map_identity(),
        .resolution = 1.5 * pow(options->tolerance, 1.0 / (2 * FC_RADAU_STAGES)),
        .smooth = smoothness(scene, duration),
        .delta_scale = fmax(fabs(delta_0), start.limit / start.sigma),
        .delta_tolerance = options->tolerance * saturated,
        .evaluations = *evaluations,
    };
    Stretch stretch = {0};
    if (scope == FC_MAP_THIS_START) {
        progress.map.relaxation = 1.0;
        progress.map.offset = delta_0;
        stretch.w_a = start_layer(scene, delta_0, options->tolerance);
    } else {
        stretch.w_a = relaxation_layer(scene, 0.0);
    }
    while (stretch.start < duration && progress.evaluations <= FC_MOST_EVALUATIONS) {
        // An event farther beyond the end than the end is from here does not shape the steps.
        const double horizon = duration + (duration - stretch.start);
        const FcDriveEvent event = fc_drive_next_event(drive, stretch.start, horizon);
        stretch.event = event.time < horizon ? event.time : INFINITY;
        stretch.end = fmin(event.time, duration);
        if (event.time < horizon) {
            stretch.w_b =
                event.reversal ? relaxation_layer(scene, stretch.end) : dip_layer(scene, stretch.end);
        }
        cross(&progress, scene, &stretch);
        stretch.start = stretch.end;
        stretch.w_a = stretch.w_b;
    }
    *evaluations = progress.evaluations;
    return progress.map;
}

void fc_collocation_constant(const FcScene* scene, double h, double delta_0, FcStepResult* result) {
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    const FcMap map = fc_map_of_constant_scene(&at, h);
    *result = (FcStepResult){.delta = delta_0, .evaluations = 1.0};
    fc_map_apply(&map, result);
}
