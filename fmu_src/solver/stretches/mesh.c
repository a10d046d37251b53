#include "solver/stretches/mesh.h"

#include <assert.h>
#include <math.h>

#include "solver/budget.h"
#include "solver/panels/radau_panel.h"

// All but LAST are chosen empirically. Plans cost tries and not accuracy, since panels are judged afterwards:
// half or twice of a value changes the number of panels and of tries.
//
// Plans: if the limit stands still, panels of the lag miss about five times less than DISTANCES says, for
// errors of at least COARSE.
static const double LAG_BEHIND_CONSTANT_LIMIT = 5.0;
static const double COARSE = 1e-4;
// Plans: the tolerance, over the larger of 1 and the static ratio minus 1, below which the first panel of a
// transient in a Stribeck peak is planned a decade finer, since that transient is not exponential.
static const double FINE_IN_PEAK = 5e-5;
// Accuracy: the part of a stretch's path that panels may have missed, which decides in the stiffest contacts,
// and two safety factors on the relaxation until the end of a stretch. One is for the measured relaxation of
// the whole stretch, the other for its rest. Half of MISSED_OF_PATH, or larger factors, treat errors as
// forgotten that the end sees. Twice of it costs panels.
static const double MISSED_OF_PATH = 0.1;
static const double SURE_OF_WHOLE = 0.9;
static const double SURE_OF_REST = 0.5;

// Plans: lengths of a panel for a relative error of 10^-k, k = 0 .. FINEST, chosen empirically. LAYERS: of a
// decaying transient, in layers. DISTANCES: of the lag, in distances from its event. SMOOTH: in the time over
// which the logarithm of a coefficient moves by 1. Order 17 resolves a length that shrinks by 10^(-1/18) for
// each decade; the table ends at 3.2, and at 8 below three decades. Longer panels would save some in some
// scenes and be refused in others. PEAK: in a Stribeck peak, in lengths that resolve it. FINEST: beyond it
// rounding limits a panel.
enum { FINEST = 15 };
static const double LAYERS[FINEST + 1] = {25,  14,   9,   6.5, 4.5,  3.5, 2.8, 2.3,
                                          1.9, 1.65, 1.4, 1.2, 1.02, .9,  .8,  .7};
static const double DISTANCES[FINEST + 1] = {40,  30,  20,  14,  10,  6.5, 4.2, 2.9,
                                             2.1, 1.5, 1.1, .85, .65, .53, .43, .35};
static const double SMOOTH[FINEST + 1] = {8,   8,   8,    3.2,  3.2,  3.2,  3.2,  3.2,
                                          3.2, 3.2, 3.15, 2.78, 2.44, 2.15, 1.89, 1.66};
static const double PEAK[FINEST + 1] = {4, 3, 1.7, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
// Derived: a panel that ends on a reversal and steps over its layer leaves an error of LAST lags, (9^2 + 1) /
// 2, the last diagonal entry of the inverse of the method's matrix, at its last node, whose weight is 1 /
// stages^2.
static const double LAST = 41.0;

// Decades of accuracy that a panel needs for this allowed relative error.
static int decades(double allowed) {
    return !(allowed < 0.3) ? 0 : (int)fc_least(FINEST, 0.15 + fc_digits(allowed)); // 0 for no number too
}

// The limits of a panel's length.
typedef struct {
    double left;         // s, to the stretch's end
    double after, ahead; // s, distances from the events, widened by their layers
    double smooth;       // s
    double peak;         // s, that the Stribeck curve allows
    double layer, layer_ahead;
    int finer;   // decades, by which a transient is planned finer
    bool starts; // with a transient that is seen, which no panel steps over: the estimate would be far off
    bool ends_at_event;  // or within its layer
    double allowed_last; // relative error of a panel that ends at the event
    int for_transient, for_lag, for_last, for_quadrature;
} Limits;

static int finest(const Limits* limits) {
    const int finer = limits->for_transient > limits->for_lag ? limits->for_transient : limits->for_lag;
    return finer > limits->for_quadrature ? finer : limits->for_quadrature;
}

static double length(const Limits* limits) {
    assert(limits->for_transient >= 0 && limits->for_lag >= 0 && limits->for_last >= 0);
    assert(limits->for_transient <= FINEST && limits->for_lag <= FINEST && limits->for_last <= FINEST);
    assert(limits->for_quadrature >= 0 && limits->for_quadrature <= FINEST);
    const double distances = DISTANCES[limits->for_lag];
    double h = fc_least(SMOOTH[finest(limits)] * limits->smooth, distances * limits->after);
    h = fc_least(h, limits->peak);
    if (limits->for_transient > 0 || limits->starts) {
        h = fc_least(h, LAYERS[limits->for_transient] * limits->layer);
    }
    const double shrink = distances / (1.0 + distances);
    if (!limits->ends_at_event) {
        return fc_least(limits->left, fc_least(h, shrink * limits->ahead));
    }
    double last = LAYERS[limits->for_last];
    if (limits->allowed_last > 1.0) {
        const double half = 0.5 * limits->allowed_last * LAST;
        last = fc_most(last, fc_least(FC_RADAU_STAGES * sqrt(half), half));
    }
    last *= limits->layer_ahead;
    if (limits->left <= fc_least(h, last)) {
        return limits->left;
    }
    // Up to the start of the last panel.
    const double graded =
        fc_most(fc_least(shrink * limits->left, limits->left - 0.95 * last), 0.35 * limits->left);
    return fc_least(h, graded);
}

static int more(int decades_needed, int caution) {
    return decades_needed + caution < FINEST ? decades_needed + caution : FINEST;
}

// The length [s] of a panel for these relative errors of the transient and of the lag.
static double planned_length(Limits* limits, double for_transient, double for_lag, int gone_decades,
                             int caution) {
    const int transient = decades(for_transient) - gone_decades;
    limits->for_transient = transient > 0 ? more(transient, caution + limits->finer) : 0;
    limits->for_lag = more(decades(for_lag), caution);
    limits->for_last = more(decades(limits->allowed_last), caution);
    limits->allowed_last *= caution > 0 ? pow(10.0, -caution) : 1.0;
    const double h = length(limits);
    return h < limits->left && !limits->ends_at_event ? fc_least(h, 0.6 * limits->left) : h;
}

double fc_left_at_end(const FcStretch* stretch, const FcPlace* at, double t, double gone) {
    const FcInterval* interval = stretch->interval;
    const double about = at->path - MISSED_OF_PATH * fabs(stretch->displacement);
    const double at_least_here = fc_most(about - interval->speed * (t - at->t), 0.0);
    if (at_least_here + stretch->path_after > interval->forgotten) {
        return 0.0;
    }
    double relaxes = stretch->path_after / interval->saturation;
    if (t < stretch->end) {
        const double at_least =
            fabs(fc_drive_displacement(&interval->scene->drive, t, stretch->end)) / interval->saturation;
        // at_least, too, if the others are NaN
        relaxes += fc_most(SURE_OF_REST * (SURE_OF_WHOLE * stretch->relaxes - gone), at_least);
    }
    assert(!(relaxes < 0.0));
    return exp(-relaxes);
}

// The relaxation from the stretch's start to the end of a panel of that length, about.
static double gone_after(const FcStretch* stretch, const FcPlace* at, double h) {
    return at->gone + (stretch->relaxes - at->gone) * h / (stretch->end - at->t);
}

// The requirements of the Stribeck curve on a panel that begins in its peak.
typedef struct {
    double lasts;  // s, in which V moves by half of itself and a Stribeck velocity, so that g(V) is resolved
    double tau;    // s, in which it moves by a Stribeck velocity
    double height; // 1, by which g still moves, over g
} Peak;

static Peak peak_at(const FcStretch* stretch, double t) {
    const FcPeaks* peaks = &stretch->peaks;
    const FcFriction* friction = stretch->interval->scene->friction;
    const FcVelocity at = fc_drive_velocity(&stretch->interval->scene->drive, t);
    const bool falls = t < peaks->after && peaks->after < peaks->before;
    return (Peak){
        .lasts = fc_velocity_time_of_change(&at, friction->V_S + 0.5 * fabs(at.V)),
        .tau = fc_velocity_time_of_change(&at, friction->V_S),
        .height = (falls ? fc_stribeck(friction, at.V) : friction->staticRatio) - 1.0,
    };
}

// Length [s] of a panel that begins in a peak. Its error of the curve acts while V moves on by V_S, and then
// lives.
static double length_in_peak(const FcStretch* stretch, const FcPlace* at, const Peak* peak, double lives) {
    const FcInterval* interval = stretch->interval;
    const double tolerance = interval->tolerance;
    const double near_rounding = tolerance < 1e-7 ? 0.7 : 1.0;
    double allowed = FC_PLAN_FOR_MEAN * tolerance * interval->duration / (lives + peak->tau);
    const double gone = gone_after(stretch, at, peak->lasts);
    if (fc_left_at_end(stretch, at, at->t + peak->lasts, gone) > tolerance * tolerance) {
        allowed = fc_least(allowed, FC_PLAN_AT_END * tolerance);
    }
    return allowed < peak->height ? PEAK[decades(allowed / peak->height)] * near_rounding * peak->lasts
                                  : INFINITY;
}

// The time [s] for which an error made in the next panel lives, and that times the length of the lag's panel
// [s2].
typedef struct {
    double lives;
    double lag_counts;
} Lives;

// The larger life of two errors: of one made here, and of one made near the event ahead.
static Lives lives_at(const FcStretch* stretch, const FcPlace* at, double after, double smooth) {
    const double rest = stretch->interval->duration - at->t;
    const bool known = isfinite(stretch->event);
    double lives = at->t == stretch->start ? stretch->w_a : at->rate > 0.0 ? 1.3 / at->rate : INFINITY;
    if (known) {
        lives = fc_least(lives, fc_most(stretch->w_a, stretch->w_b));
    }
    double lag_counts = lives * fc_least(after, smooth);
    if (known) {
        const double near = fc_most(0.25 * (stretch->event - at->t + stretch->w_b), stretch->w_b);
        const double part = stretch->w_b / near;
        const double there = stretch->w_b * (stretch->reversal ? part : part * part);
        lives = fc_most(lives, there);
        lag_counts = fc_most(lag_counts, there * fc_least(smooth, near));
    }
    return (Lives){fc_least(lives, rest), fc_least(lag_counts, rest * fc_least(rest, smooth))};
}

FcPlan fc_mesh_plan(const FcStretch* stretch, const FcPlace* at, int caution) {
    assert(stretch->start <= at->t && at->t < stretch->end && stretch->end <= stretch->event);
    assert(caution >= 0);
    const FcInterval* interval = stretch->interval;
    const double tiny = 1e-300;
    const double tolerance = interval->tolerance;
    const double for_mean = FC_PLAN_FOR_MEAN * tolerance * interval->duration; // s
    const double after = at->t - stretch->start + stretch->back;
    const bool known = isfinite(stretch->event);
    const double smooth = fc_smooth_time(&interval->pace);
    const bool in_peak = fc_in_peak(&stretch->peaks, at->t);
    const Peak peak = in_peak ? peak_at(stretch, at->t) : (Peak){.lasts = INFINITY};
    // The largest rate of ln(sigma / g). The lag is this rate times the time in which the bristle relaxes.
    const double drift =
        fc_most(0.0, 1.0 / smooth - interval->pace.phase) + fc_least(peak.height, 1.0) / peak.lasts;
    const Lives life = lives_at(stretch, at, after, smooth);
    const double transient = fc_least(at->transient, 1e12);
    const double gone = 0.434 * at->gone; // negative, or NaN, if the stiffness overflows
    const int gone_decades = gone > 0.0 ? (int)fc_least(1e3, gone) : 0;
    const double last_counts = drift * fc_least(stretch->w_b, smooth) + at->lag;
    Limits limits = {
        .left = stretch->end - at->t,
        .after = after,
        .ahead = known ? stretch->event - at->t + stretch->w_b : INFINITY,
        .smooth = smooth,
        .peak = in_peak ? length_in_peak(stretch, at, &peak, life.lives) : INFINITY,
        .layer = at->layer,
        .layer_ahead = stretch->w_b,
        .starts = at->gone == 0.0 && transient > tolerance,
        // Impulse and work of a constant force are exact. Those of another force are as good as the
        // quadrature.
        .for_quadrature = interval->moving_limit ? decades(tolerance) : 0,
        .ends_at_event = known && stretch->event - stretch->end <= stretch->w_b,
        .allowed_last = for_mean / (stretch->w_b * last_counts + tiny),
    };
    const double excess = interval->scene->friction->staticRatio - 1.0;
    limits.finer = isfinite(limits.peak) && limits.starts && tolerance < FINE_IN_PEAK * fc_most(1.0, excess);
    const double allowed_last = limits.allowed_last;
    const double of_lag = interval->moving_limit || tolerance < COARSE ? 1.0 : LAG_BEHIND_CONSTANT_LIMIT;
    double for_transient = for_mean / (transient * life.lives + tiny);
    double for_lag = of_lag * for_mean / (drift * life.lag_counts + tiny);
    FcPlan plan = {.h = planned_length(&limits, for_transient, for_lag, gone_decades, caution)};

    // Planned for the end, a panel may get longer. Then it ends nearer to the interval's end, and less of its
    // error fades.
    for (double judged = 0.0; plan.h > judged;) {
        judged = plan.h;
        const double fades = fc_left_at_end(stretch, at, at->t + plan.h, gone_after(stretch, at, plan.h));
        if (!(fades > tolerance * tolerance)) {
            break;
        }
        const double at_end = FC_PLAN_AT_END * tolerance / fades;
        for_transient = fc_least(for_transient, at_end / (transient + tiny));
        for_lag = fc_least(for_lag, of_lag * at_end / (drift * fc_least(life.lives, smooth) + tiny));
        limits.allowed_last = fc_least(allowed_last, at_end / (last_counts + tiny));
        plan.h = planned_length(&limits, for_transient, for_lag, gone_decades, caution);
    }
    if (at->t < stretch->peaks.before) {
        plan.h = fc_least(plan.h, stretch->peaks.before - at->t);
    }
    assert(!(plan.h < 0.0) && !(life.lives < 0.0));
    plan.in_peak = in_peak;
    plan.crosses_peak = in_peak && plan.h > peak.tau;
    plan.lives = life.lives;
    plan.grows = smooth;
    return plan;
}
