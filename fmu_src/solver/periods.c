#include "solver/periods.h"

#include <assert.h>
#include <math.h>

// More periods than this with moving inputs are refused: they would take minutes.
static const double MOST_CHANGING_PERIODS = 1e6;

// With held inputs all periods are the same map, and n of them its n-th power.
static void step_over_equal_periods(FcIntervalMap interval, const FcScene* scene,
                                    const FcSolverOptions* options, double periods, double rest,
                                    FcStepResult* total) {
    const double period = 1.0 / scene->drive.vibration.f;
    const FcMap one = interval(scene, options, period, total->delta, FC_MAP_ANY_START, &total->evaluations);
    const FcMap all = fc_map_power(&one, periods);
    fc_map_apply(&all, total);
    const FcMap last = interval(scene, options, rest, total->delta, FC_MAP_THIS_START, &total->evaluations);
    fc_map_apply(&last, total);
}

static void step_over_changing_periods(FcIntervalMap interval, const FcScene* scene,
                                       const FcSolverOptions* options, double periods, double rest,
                                       FcStepResult* total) {
    const double f = scene->drive.vibration.f;
    for (double k = 0.0; k <= periods; k += 1.0) {
        const FcScene part = fc_scene_later(scene, k / f);
        const double duration = k < periods ? 1.0 / f : rest;
        const FcMap map =
            interval(&part, options, duration, total->delta, FC_MAP_THIS_START, &total->evaluations);
        fc_map_apply(&map, total);
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

bool fc_periods_step(FcIntervalMap interval, const FcScene* scene, const FcSolverOptions* options, double h,
                     double delta_0, FcStepResult* result, FcMessage* message) {
    if (!fc_periods_check(scene, h, 0.0, message)) {
        return false;
    }
    FcStepResult total = {.delta = delta_0};
    const FcPeriods periods = fc_periods_in(scene, h);
    if (periods.count < 2.0) {
        const FcMap map = interval(scene, options, h, total.delta, FC_MAP_THIS_START, &total.evaluations);
        fc_map_apply(&map, &total);
    } else if (fc_drive_is_linear(&scene->drive)) {
        step_over_changing_periods(interval, scene, options, periods.count, periods.rest, &total);
    } else {
        step_over_equal_periods(interval, scene, options, periods.count, periods.rest, &total);
    }
    if (!fc_periods_check(scene, h, total.evaluations, message)) {
        return false;
    }
    *result = total;
    return true;
}
