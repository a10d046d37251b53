#include "solver/methods/periods.h"

#include <assert.h>
#include <math.h>

#include "model/regime.h"
#include "solver/methods/leap.h"
#include "solver/pieces.h"

// The largest number of periods with moving inputs. More are refused: they may take minutes.
static const double MOST_CHANGING_PERIODS = 1e6;

// The largest difference of the ends of two periods that count as equal, over the deflection. Half of it
// costs a part of a period; twice of it accepts ends that still change by twice as much. A bristle that
// relaxes by a small part of its way in each period has that many times farther to go. LEAST_PART is for
// ElasticPlastic, whose ends differ by rounding alone.
static const double SAME_END = 1e-10;
static const double LEAST_PART = 1e-4;

// The distance from the edge of the free starts, over it, below which a start is at the edge. Rounding: 450
// eps.
static const double ROUNDING_OF_EDGE = 1e-13;

// The largest number of periods that meet the bound before a repetition is given up. With static friction the
// place of sticking may depend on the place of break-away. Then periods need not repeat, and the mean over
// the last half of the meetings counts. Half as many would give a mean over fewer periods; twice as many
// would cost twice the time.
enum { MOST_MEETINGS = 1000 };

void fc_periods_take(FcIntegration law, const FcScene* scene, const FcSolverOptions* options, double duration,
                     FcStepResult* total) {
    FcPieces pieces;
    fc_pieces_start(&pieces, scene, duration);
    while (total->evaluations <= FC_MOST_EVALUATIONS && fc_next_piece(&pieces)) {
        if (fc_scene_is_loose(pieces.scene)) {
            fc_loose_step(pieces.scene, total);
        } else {
            law.step(pieces.scene, options, pieces.h, total);
        }
    }
}

// Whole periods of a bounded bristle with its inputs held.
typedef struct {
    FcIntegration law;
    const FcScene* scene;
    const FcSolverOptions* options;
    double period; // s
    bool has_free_map;
    FcMap free_map;
    double edge[2]; // m, the highest and the lowest start that meets no bound; infinite until needed
    FcStepResult total;
    double done; // periods
    // After a period that met its bound: the last one whose number is a power of 2.
    FcStepResult met;
    double met_at; // periods; negative for none
} Walk;

static FcMap free_map_of(Walk* walk) {
    if (!walk->has_free_map) {
        walk->free_map = walk->law.free_map(walk->scene, walk->options, walk->period, walk->total.delta,
                                            &walk->total.evaluations);
        walk->has_free_map = true;
        walk->edge[0] = walk->edge[1] = INFINITY;
    }
    return walk->free_map;
}

// The farthest start to that side (1 or -1) that meets no bound, from the end of the farthest start of all.
static double edge_of(Walk* walk, int side) {
    assert(side == 1 || side == -1);
    double* edge = &walk->edge[side < 0];
    if (isfinite(*edge)) {
        return *edge;
    }
    const FcMap* map = &walk->free_map;
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(walk->scene, 0, &friction);
    const double farthest = side * fc_bound(&bound, 0.0);
    FcStepResult end = {.delta = farthest, .evaluations = walk->total.evaluations};
    // With static friction the bound that is met is the one without the drop.
    const bool drops = fc_has_static_friction(walk->scene->friction);
    walk->law.step(drops ? &bound : walk->scene, walk->options, walk->period, &end);
    walk->total.evaluations = end.evaluations;
    const double kept = 1.0 - map->relaxation;
    const double room = side * (end.delta - map->offset);
    *edge = kept > 0.0 ? fmin(side * farthest, room / kept) * side : room < 0.0 ? -side * HUGE_VAL : farthest;
    return *edge;
}

// The number of periods from the free start delta on that meet no bound. The deflection moves by s (1 - P^n)
// / (1 - P) in n of them, with its motion s in the first.
static double free_periods(Walk* walk, double left) {
    const FcMap map = free_map_of(walk);
    const double delta = walk->total.delta;
    const double s = map.offset - map.relaxation * delta;
    if (s == 0.0) {
        return left;
    }
    const int side = s > 0.0 ? 1 : -1;
    const double relaxation = fmin(1.0, map.relaxation); // rounding may exceed 1
    const double edge = edge_of(walk, side);
    const double room = side * (edge - delta) / fabs(s);
    if (!(room * relaxation < 1.0)) { // never
        return left;
    }
    if (!(side * (edge - delta) > ROUNDING_OF_EDGE * fabs(edge))) {
        return 0.0;
    }
    const double n = relaxation > 0.0 ? log1p(-relaxation * room) / log1p(-relaxation) : room;
    assert(!(n < 0.0));
    return fmin(left, floor(n) + 1.0);
}

static void repeat(Walk* walk, double times) {
    assert(times >= 0.0 && walk->met_at >= 0.0 && walk->met_at < walk->done);
    FcStepResult* total = &walk->total;
    const FcStepResult* met = &walk->met;
    total->impulse += times * (total->impulse - met->impulse);
    total->work += times * (total->work - met->work);
    total->heat += times * (total->heat - met->heat);
    total->drag += times * (total->drag - met->drag);
    walk->done += times * (walk->done - walk->met_at);
}

// Whether the bristle has returned to its state after the kept period.
static bool repeats(Walk* walk) {
    const double delta = walk->total.delta;
    const double changed = fabs(delta - walk->met.delta);
    if (walk->met_at < 0.0 || walk->total.slips != walk->met.slips || !(changed <= SAME_END * fabs(delta))) {
        return false;
    }
    const double part = fmax(LEAST_PART, fmin(1.0, free_map_of(walk).relaxation));
    return changed <= SAME_END * part * fabs(delta);
}

// Takes `periods`, which may be infinitely many, and stops if periods repeat. Those since met_at do, or a
// single free one if met_at is negative. If too many meetings do not repeat, met_at is about half of them
// ago.
static void walk_to_repetition(Walk* walk, double periods) {
    FcStepResult* total = &walk->total;
    walk->met_at = -1.0;
    int meetings = 0;
    while (walk->done < periods && total->evaluations <= FC_MOST_EVALUATIONS && meetings < MOST_MEETINGS) {
        const double delta = total->delta;
        total->meetings = 0;
        walk->law.step(walk->scene, walk->options, walk->period, total);
        walk->done += 1.0;
        const bool was_free = total->meetings == 0 && total->slips == 0;
        if (was_free && total->delta == delta) {
            walk->met_at = -1.0;
            return;
        }
        const double n = was_free && walk->done < periods ? free_periods(walk, periods - walk->done) : 0.0;
        if (n == 0.0) { // it has met its bound, or will in the next period
            meetings++;
            if (repeats(walk)) {
                return;
            }
            // Each is kept twice as long as the last, so that a cycle of any length returns to it.
            if ((meetings & (meetings - 1)) == 0) {
                walk->met = *total;
                walk->met_at = walk->done;
            }
            continue;
        }
        if (isinf(n)) {
            const FcMap* map = &walk->free_map;
            const double target = map->relaxation > 0.0 ? map->offset / map->relaxation : total->delta;
            total->delta = isfinite(target) ? target : total->delta;
            walk->met_at = -1.0;
            return;
        }
        const FcMap map = fc_map_power(&walk->free_map, n);
        fc_map_apply(&map, total);
        walk->done += n;
    }
}

static Walk walk_from(FcIntegration law, const FcScene* scene, const FcSolverOptions* options,
                      const FcStepResult* start) {
    return (Walk){.law = law,
                  .scene = scene,
                  .options = options,
                  .period = 1.0 / scene->drive.vibration.f,
                  .total = *start};
}

static void step_over_equal_periods(FcIntegration law, const FcScene* scene, const FcSolverOptions* options,
                                    double periods, FcStepResult* total) {
    assert(periods >= 2.0 && periods == floor(periods));
    if (!law.is_bounded) {
        const FcMap one =
            law.free_map(scene, options, 1.0 / scene->drive.vibration.f, total->delta, &total->evaluations);
        const FcMap all = fc_map_power(&one, periods);
        fc_map_apply(&all, total);
        return;
    }
    Walk walk = walk_from(law, scene, options, total);
    while (walk.done < periods && walk.total.evaluations <= FC_MOST_EVALUATIONS) {
        walk_to_repetition(&walk, periods);
        const double cycle = walk.done - walk.met_at;
        if (walk.done < periods && cycle > 0.0 && repeats(&walk)) {
            repeat(&walk, floor((periods - walk.done) / cycle));
        } else if (walk.done < periods && walk.met_at < 0.0) { // each period leads back
            const FcMap map = free_map_of(&walk);
            const FcMap all = fc_map_power(&map, periods - walk.done);
            fc_map_apply(&all, &walk.total);
            walk.done = periods;
        }
    }
    *total = walk.total;
}

FcPeriods fc_periods_in(const FcScene* scene, double h) {
    assert(h >= 0.0);
    const double f = scene->drive.vibration.f;
    const double count = fc_drive_vibrates(&scene->drive) ? floor(h * f) : 0.0;
    const double rest = count > 0.0 ? fmax(0.0, fma(h, f, -count) / f) : h;
    assert(rest <= h);
    return (FcPeriods){.count = count, .rest = rest};
}

bool fc_periods_check(const FcScene* scene, double h, double evaluations, FcMessage* message) {
    const double f = scene->drive.vibration.f;
    const double periods = fc_periods_in(scene, h).count;
    if (periods > MOST_CHANGING_PERIODS && fc_drive_is_linear(&scene->drive)) {
        return fc_message_set(
            message,
            "a step of %.9g s holds %.9g vibration periods while an input moves (its derivative is not 0); "
            "at most %.9g of them are computed: the largest step is %.9g s",
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
                     FcStepResult* result, FcMessage* message) {
    if (!fc_periods_check(scene, h, 0.0, message)) {
        return false;
    }
    const FcPeriods periods = fc_periods_in(scene, h);
    if (periods.count < 2.0) {
        fc_periods_take(law, scene, options, h, result);
    } else if (fc_drive_is_linear(&scene->drive)) {
        fc_leap(law, scene, options, periods.count, result);
        const FcScene rest = fc_scene_later(scene, periods.count / scene->drive.vibration.f);
        fc_periods_take(law, &rest, options, periods.rest, result);
    } else if (fc_scene_is_loose(scene)) {
        fc_loose_step(scene, result);
    } else {
        step_over_equal_periods(law, scene, options, periods.count, result);
        fc_periods_take(law, scene, options, periods.rest, result);
    }
    return fc_periods_check(scene, h, result->evaluations, message);
}

double fc_periods_settled(FcIntegration law, const FcScene* scene, const FcSolverOptions* options,
                          FcStepResult* end) {
    const double f = scene->drive.vibration.f;
    if (fc_scene_is_loose(scene)) {
        fc_loose_step(scene, end);
        return 0.0;
    }
    Walk walk = walk_from(law, scene, options, end);
    FcMap map;
    if (law.is_bounded) {
        walk_to_repetition(&walk, HUGE_VAL);
        const double cycle = walk.done - walk.met_at;
        *end = walk.total;
        if (walk.met_at >= 0.0 && cycle > 0.0) {
            return (walk.total.impulse - walk.met.impulse) / cycle * f;
        }
        map = free_map_of(&walk);
        end->evaluations = walk.total.evaluations;
    } else {
        map = law.free_map(scene, options, 1.0 / f, end->delta, &end->evaluations);
        const double target =
            map.offset != 0.0 || map.relaxation != 0.0 ? map.offset / map.relaxation : end->delta;
        end->delta = isfinite(target) ? target : end->delta;
    }
    FcStepResult period = {.delta = end->delta};
    fc_map_apply(&map, &period);
    return period.impulse * f;
}
