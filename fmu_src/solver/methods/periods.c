#include "solver/methods/periods.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

// More periods than this with moving inputs are refused. By hand: they would take minutes.
static const double MOST_CHANGING_PERIODS = 1e6;

// A period that touches a bound ends on one of two deflections, and the deflection goes one way: all that follow the
// second one end alike. Derived: the third shows it.
enum { MOST_TOUCHES = 3 };

// Two ends of periods that differ by less than this, over the first, are the same. By hand: less costs a third period, more
// takes an end that still changes.
static const double SAME_END = 1e-9;

static FcFreePeriod free_period(FcIntegration law, const FcScene* scene, const FcSolverOptions* options,
                                double delta, double* evaluations) {
    const double period = 1.0 / scene->drive.vibration.f;
    if (law.free_period != NULL) {
        return law.free_period(scene, options, delta, evaluations);
    }
    return (FcFreePeriod){.map = law.interval(scene, options, period, delta, FC_MAP_ANY_START, evaluations),
                          .lowest = -INFINITY,
                          .highest = INFINITY};
}

// How many periods from a free start delta on touch no bound. The deflection moves by s (1 - P^n) / (1 - P) in n of them,
// s being how far it moves in the first.
static double free_periods(const FcFreePeriod* free, double delta, double s, double periods) {
    const double relaxation = fmin(1.0, free->map.relaxation); // which rounding may exceed
    const double room = (s > 0.0 ? free->highest - delta : delta - free->lowest) / fabs(s);
    if (!(room * relaxation < 1.0)) { // also where s is 0: never
        return periods;
    }
    const double n = relaxation > 0.0 ? log1p(-relaxation * room) / log1p(-relaxation) : room;
    return fmin(periods, floor(n) + 1.0);
}

static void take(FcIntegration law, const FcScene* scene, const FcSolverOptions* options, double duration,
                 FcStepResult* total) {
    const FcMap map =
        law.interval(scene, options, duration, total->delta, FC_MAP_THIS_START, &total->evaluations);
    fc_map_apply(&map, total);
}

static void step_over_equal_periods(FcIntegration law, const FcScene* scene, const FcSolverOptions* options,
                                    double periods, FcStepResult* total) {
    const double period = 1.0 / scene->drive.vibration.f;
    const FcFreePeriod free = free_period(law, scene, options, total->delta, &total->evaluations);
    int touches = 0;
    for (double left = periods; left > 0.0 && total->evaluations <= FC_MOST_EVALUATIONS;) {
        const double delta = total->delta;
        const double nearest = fmax(free.lowest, fmin(free.highest, delta));
        const double s = free.map.offset - free.map.relaxation * nearest;
        // A period that touches where the bristle does not stay ends on a free start, but for rounding.
        const bool is_free = delta == nearest || (touches > 0 && (delta - nearest) * s <= 0.0);
        FcMap map = free.map;
        double n;
        if (is_free && free.lowest <= free.highest) {
            n = free_periods(&free, nearest, s, left);
        } else {
            map = law.interval(scene, options, period, delta, FC_MAP_THIS_START, &total->evaluations);
            touches++;
            const bool repeats = touches > 1 && fabs(map.offset - delta) <= SAME_END * fabs(delta);
            n = repeats || touches == MOST_TOUCHES ? left : 1.0;
        }
        map = fc_map_power(&map, n);
        fc_map_apply(&map, total);
        left -= n;
    }
}

static void step_over_changing_periods(FcIntegration law, const FcScene* scene,
                                       const FcSolverOptions* options, double periods, double rest,
                                       FcStepResult* total) {
    const double f = scene->drive.vibration.f;
    for (double k = 0.0; k <= periods && total->evaluations <= FC_MOST_EVALUATIONS; k += 1.0) {
        const FcScene part = fc_scene_later(scene, k / f);
        take(law, &part, options, k < periods ? 1.0 / f : rest, total);
    }
}

FcPeriods fc_periods_in(const FcScene* scene, double h) {
    assert(h >= 0.0);
    const double f = scene->drive.vibration.f;
    const double count = fc_drive_vibrates(&scene->drive) ? floor(h * f) : 0.0;
    return (FcPeriods){.count = count, .rest = count > 0.0 ? fmax(0.0, fma(h, f, -count) / f) : h};
}

bool fc_periods_check(const FcScene* scene, double h, double evaluations, FcMessage* message) {
    const double f = scene->drive.vibration.f;
    const double periods = fc_periods_in(scene, h).count;
    if (periods > MOST_CHANGING_PERIODS && fc_drive_is_linear(&scene->drive)) {
        return fc_message_set(
            message,
            "a step of %.9g s holds %.9g vibration periods while an input moves (its derivative is not 0); "
            "at most %.9g periods are computed one by one: the largest step is %.9g s",
            h, periods, MOST_CHANGING_PERIODS, MOST_CHANGING_PERIODS / f);
    }
    if (evaluations > FC_MOST_EVALUATIONS) {
        return fc_message_set(
            message,
            "the step of %.9g s needs more than %.0e evaluations: an input or the separation moves over "
            "too many orders of magnitude in it; use smaller steps, or cut the motion",
            h, FC_MOST_EVALUATIONS);
    }
    return true;
}

bool fc_periods_step(FcIntegration law, const FcScene* scene, const FcSolverOptions* options, double h,
                     double delta_0, FcStepResult* result, FcMessage* message) {
    if (!fc_periods_check(scene, h, 0.0, message)) {
        return false;
    }
    FcStepResult total = {.delta = delta_0};
    const FcPeriods periods = fc_periods_in(scene, h);
    if (periods.count < 2.0) {
        take(law, scene, options, h, &total);
    } else if (fc_drive_is_linear(&scene->drive)) {
        step_over_changing_periods(law, scene, options, periods.count, periods.rest, &total);
    } else {
        step_over_equal_periods(law, scene, options, periods.count, &total);
        take(law, scene, options, periods.rest, &total);
    }
    if (!fc_periods_check(scene, h, total.evaluations, message)) {
        return false;
    }
    *result = total;
    return true;
}

// The fixed point of the period's map. Where no start is free, periods end alike after MOST_TOUCHES. Where the affine map's fixed
// point is a free start, it is that. Where it is beyond them, what the nearest free start leads to: that one only just touches,
// so all starts beyond it end there too, and it is beyond it itself.
static double settled(FcIntegration law, const FcScene* scene, const FcSolverOptions* options,
                      const FcFreePeriod* free, double delta_0, double* evaluations) {
    if (free->lowest > free->highest) {
        const double period = 1.0 / scene->drive.vibration.f;
        FcStepResult end = {.delta = delta_0, .evaluations = *evaluations};
        for (int touches = 0; touches < MOST_TOUCHES; touches++) {
            take(law, scene, options, period, &end);
        }
        *evaluations = end.evaluations;
        return end.delta;
    }
    const FcMap* map = &free->map;
    const double target =
        map->offset != 0.0 || map->relaxation != 0.0 ? map->offset / map->relaxation : delta_0;
    const double start = fmax(free->lowest, fmin(free->highest, target));
    const double end = start == target ? target : start - map->relaxation * start + map->offset;
    return isfinite(end) ? end : delta_0;
}

double fc_periods_settled(FcIntegration law, const FcScene* scene, const FcSolverOptions* options,
                          double delta_0, double* evaluations) {
    const FcFreePeriod free = free_period(law, scene, options, delta_0, evaluations);
    return settled(law, scene, options, &free, delta_0, evaluations);
}

double fc_periods_settled_force(FcIntegration law, const FcScene* scene, const FcSolverOptions* options,
                                double delta_0, double* evaluations) {
    const double f = scene->drive.vibration.f;
    const FcFreePeriod free = free_period(law, scene, options, delta_0, evaluations);
    FcStepResult period = {.delta = settled(law, scene, options, &free, delta_0, evaluations)};
    const bool is_free = free.lowest <= period.delta && period.delta <= free.highest;
    const FcMap map =
        is_free ? free.map
                : law.interval(scene, options, 1.0 / f, period.delta, FC_MAP_THIS_START, evaluations);
    fc_map_apply(&map, &period);
    return period.impulse * f;
}
