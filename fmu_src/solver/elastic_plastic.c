#include "solver/elastic_plastic.h"

#include <math.h>

#include "solver/bound.h"
#include "solver/periods.h"
#include "solver/stick_slip.h"
#include "solver/turning_points.h"

static void add(FcTotals* sum, FcTotals part, double times) {
    sum->impulse += times * part.impulse;
    sum->work += times * part.work;
    sum->heat += times * part.heat;
    sum->drag += times * part.drag;
}

// Several intervals one after the other.
typedef struct {
    double tolerance;
    double delta; // m, reached
    FcTotals totals;
    double evaluations;
} Progress;

static void go(Progress* progress, const FcScene* scene, double duration, double times) {
    const FcStickSlip one =
        fc_stick_slip(scene, progress->tolerance, duration, progress->delta, &progress->evaluations);
    add(&progress->totals, one.totals, times);
    progress->delta = one.delta;
}

// The starts from which a period touches no bound; none where lowest > highest.
typedef struct {
    double lowest, highest; // m
} FreeStarts;

// x - D is largest, and x + D least, at a turning point or an end.
static FreeStarts free_starts(const FcScene* scene, double tolerance, double period, double* evaluations) {
    const FcPath path = fc_path_from(scene, 0.0);
    FcTurningPoints points;
    fc_turning_points_start(&points, scene, tolerance, period);
    fc_turning_points_foresee(&points, -FC_NO_BOUND, FC_NO_BOUND);
    FreeStarts starts = {.lowest = -points.at->D, .highest = points.at->D};
    while (points.at->t < period && points.evaluations <= FC_MOST_EVALUATIONS) {
        FcPiece piece;
        fc_turning_points_next(&points, -FC_NO_BOUND, FC_NO_BOUND, &piece);
        const double x = fc_path_at(&path, piece.end->t);
        starts.lowest = fmax(starts.lowest, -piece.end->D - x);
        starts.highest = fmin(starts.highest, piece.end->D - x);
    }
    *evaluations += points.evaluations;
    return starts;
}

// How many of the periods, shifting by s [m] each, touch no bound.
static double free_periods(const FreeStarts* starts, double delta, double s, double periods) {
    if (delta > starts->highest || delta < starts->lowest) {
        return 0.0;
    }
    if (s == 0.0) {
        return periods;
    }
    const double room = s > 0.0 ? starts->highest - delta : delta - starts->lowest;
    return fmin(periods, floor(room / fabs(s)) + 1.0);
}

// n periods that touch no bound. Each starts s farther than the one before; a period's totals are affine in its start.
static void creep(Progress* progress, const FcScene* scene, double period, double s, double n) {
    const FcPath path = fc_path_from(scene, 0.0);
    const FcIntegrator integrator = fc_integrator(scene, 0.0, progress->tolerance);
    const double mean_start = progress->delta + 0.5 * s * (n - 1.0);
    const FcTotals mean =
        fc_stick_totals(&integrator, &path, mean_start, period, mean_start + s, &progress->evaluations);
    add(&progress->totals, mean, n);
    progress->delta += n * s;
}

// A period that has touched a bound ends on hi or lo, whatever its start. From there the bristle creeps, at the most,
// to the other bound: when a period touches the bound that the mean velocity leads to, all that follow are alike.
static void step_over_equal_periods(Progress* progress, const FcScene* scene, double periods) {
    const FcBoundMotion at = fc_bound_motion(scene, 0.0);
    progress->totals.heat += fc_bound_loss(&at, progress->delta);
    progress->delta = fc_bound_reached(&at, progress->delta);
    const double period = 1.0 / scene->drive.vibration.f;
    const double s = scene->drive.V.value * period;
    const FreeStarts starts = free_starts(scene, progress->tolerance, period, &progress->evaluations);
    double left = periods;
    if (starts.lowest <= starts.highest) {
        const bool from_the_other_side = s > 0.0   ? progress->delta < starts.lowest
                                         : s < 0.0 ? progress->delta > starts.highest
                                                   : false;
        if (from_the_other_side) {
            go(progress, scene, period, 1.0);
            left -= 1.0;
        }
        const double n = free_periods(&starts, progress->delta, s, left);
        if (n > 0.0) {
            creep(progress, scene, period, s, n);
            left -= n;
        }
    }
    if (left > 0.0) {
        go(progress, scene, period, 1.0);
        left -= 1.0;
    }
    if (left > 0.0) {
        go(progress, scene, period, left);
    }
}

static void step_over_changing_periods(Progress* progress, const FcScene* scene, double periods,
                                       double rest) {
    const double f = scene->drive.vibration.f;
    for (double k = 0.0; k <= periods && progress->evaluations <= FC_MOST_EVALUATIONS; k += 1.0) {
        const FcScene now = fc_scene_later(scene, k / f);
        go(progress, &now, k < periods ? 1.0 / f : rest, 1.0);
    }
}

double fc_elastic_plastic_reached(const FcScene* scene, double delta) {
    const FcBoundMotion at = fc_bound_motion(scene, 0.0);
    return fc_bound_reached(&at, delta);
}

// Without vibration, all held: it sticks, then slips.
static void step_at_constant_speed(const FcScene* scene, double h, double delta_0, FcStepResult* result) {
    const FcBoundMotion at = fc_bound_motion(scene, 0.0);
    const double start = fc_bound_reached(&at, delta_0);
    const double room = at.V > 0.0 ? at.D - start : at.D + start;
    const double sticking = at.V != 0.0 ? fmin(h, room / fabs(at.V)) : h;
    const double slipping = h - sticking;
    const double x = at.V * sticking;
    const double mean_delta = start + 0.5 * x;
    const double g = copysign(at.limit, at.V);
    *result = (FcStepResult){
        .delta = slipping > 0.0 ? copysign(at.D, at.V) : start + x,
        .impulse = at.sigma * mean_delta * sticking + g * slipping,
        .work = at.sigma * mean_delta * x + g * at.V * slipping,
        .heat = g * at.V * slipping + fc_bound_loss(&at, delta_0),
        .drag = at.V * x,
        .evaluations = 1.0,
    };
}

bool fc_elastic_plastic_step(const FcScene* scene, double tolerance, double h, double delta_0,
                             FcStepResult* result, FcMessage* message) {
    if (fc_drive_is_constant(&scene->drive)) {
        step_at_constant_speed(scene, h, delta_0, result);
        return true;
    }
    if (!fc_periods_check(scene, h, 0.0, message)) {
        return false;
    }
    const FcPeriods periods = fc_periods_in(scene, h);
    Progress progress = {.tolerance = tolerance, .delta = delta_0};
    if (periods.count < 2.0) {
        go(&progress, scene, h, 1.0);
    } else if (fc_drive_is_linear(&scene->drive)) {
        step_over_changing_periods(&progress, scene, periods.count, periods.rest);
    } else {
        step_over_equal_periods(&progress, scene, periods.count);
        go(&progress, scene, periods.rest, 1.0);
    }
    if (!fc_periods_check(scene, h, progress.evaluations, message)) {
        return false;
    }
    *result = (FcStepResult){
        .delta = progress.delta,
        .impulse = progress.totals.impulse,
        .work = progress.totals.work,
        .heat = progress.totals.heat,
        .drag = progress.totals.drag,
        .evaluations = progress.evaluations,
    };
    return true;
}

double fc_elastic_plastic_settled(const FcScene* scene, double tolerance, double delta_0,
                                  double* evaluations) {
    const double V = scene->drive.V.value;
    const double D = fc_bound(scene, 0.0);
    const double start = fc_elastic_plastic_reached(scene, delta_0);
    if (!fc_drive_vibrates(&scene->drive)) {
        return V != 0.0 && D < FC_NO_BOUND ? copysign(D, V) : start;
    }
    const double period = 1.0 / scene->drive.vibration.f;
    const FreeStarts starts = free_starts(scene, tolerance, period, evaluations);
    if (starts.lowest > starts.highest) {
        return fc_stick_slip(scene, tolerance, period, start, evaluations).delta;
    }
    if (V == 0.0) {
        return fmax(starts.lowest, fmin(starts.highest, start));
    }
    const double settled = V * period + (V > 0.0 ? starts.highest : starts.lowest);
    return fabs(settled) < 0.5 * FC_NO_BOUND ? settled : start;
}
