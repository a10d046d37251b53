#include "periods.h"

#include <math.h>
#include <stdio.h>

const double PERIODS_WITH_MOVING_INPUTS = 1e6;

static void apply(const DahlMap* map, StepResult* result) {
    const double delta_0 = result->delta;
    result->delta = (1.0 - map->relaxation) * delta_0 + map->offset;
    result->impulse += map->impulse_slope * delta_0 + map->impulse_offset;
    result->work += map->work_slope * delta_0 + map->work_offset;
}

// The same drive with its local time starting at t, a whole number of periods later.
static Drive periods_later(const Drive* drive, double t) {
    Drive later = *drive;
    later.V.value = drive->V.value + drive->V.rate * t;
    later.d.value = drive->d.value + drive->d.rate * t;
    later.E.value = drive->E.value + drive->E.rate * t;
    return later;
}

int periods_step(IntervalMap interval, const DahlProblem* problem, const SolverOptions* options, double h,
                 double delta_0, StepResult* result, Message* message) {
    StepResult total = {.delta = delta_0};
    const Drive* drive = &problem->drive;
    const double f = drive->vibration.f;
    const double periods = drive_vibrates(drive) ? floor(h * f) : 0.0;

    if (periods < 2.0) {
        const DahlMap map = interval(problem, options, h, total.delta, MAP_THIS_START, &total.evaluations);
        apply(&map, &total);
        *result = total;
        return 1;
    }

    const double rest = fmax(0.0, fma(h, f, -periods) / f);
    if (!drive_is_linear(drive)) {
        const DahlMap one =
            interval(problem, options, 1.0 / f, total.delta, MAP_ANY_START, &total.evaluations);
        const DahlMap all = dahl_power(&one, periods);
        apply(&all, &total);
        const DahlMap last =
            interval(problem, options, rest, total.delta, MAP_THIS_START, &total.evaluations);
        apply(&last, &total);
        *result = total;
        return 1;
    }

    if (periods > PERIODS_WITH_MOVING_INPUTS) {
        snprintf(
            message->text, sizeof message->text,
            "a step of %.9g s holds %.9g vibration periods while an input moves (its derivative is not 0); "
            "at most %.9g periods are computed one by one: the largest step is %.9g s",
            h, periods, PERIODS_WITH_MOVING_INPUTS, PERIODS_WITH_MOVING_INPUTS / f);
        return 0;
    }
    for (double k = 0.0; k <= periods; k += 1.0) {
        const Drive now = periods_later(drive, k / f);
        const DahlProblem part = dahl_problem(problem->contact, &now, problem->F_C);
        const double duration = k < periods ? 1.0 / f : rest;
        const DahlMap map =
            interval(&part, options, duration, total.delta, MAP_THIS_START, &total.evaluations);
        apply(&map, &total);
    }
    *result = total;
    return 1;
}
