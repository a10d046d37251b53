#include "solver/periods/periods.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stddef.h>

#include "model/bound.h"
#include "model/extremes.h"
#include "solver/integrate/march.h"
#include "solver/integrate/tuning.h"
#include "solver/panel/arithmetic.h"
#include "solver/periods/multirevolution.h"
#include "solver/periods/segments.h"

// The largest distance from the largest_free_start of the free starts that counts as 0, over the largest_free_start. Rounding: 450 eps.
// Twice of it moves the largest_free_start by as much.
static const double ROUNDING_OF_EDGE = 1e-13;

// Whole periods of a bounded bristle with its inputs held.
typedef struct {
    const FcScene* scene;
    const FcSolverOptions* options;
    double period; // s
    bool is_bounded, is_planar;
    bool has_free_map;
    FcMap free_map, free_map_across;
    double largest_free_start
        [2]; // m, the highest and the lowest start that meets no bound; infinite if not known
    FcStepResult total;
    double done; // periods
    // After a period that met its bound: the last one that was kept.
    FcStepResult anchor;
    double anchor_period; // periods; negative for none
    FcBristle
        least; // the one with the smallest deflection at the end of a period that met its bound since then
} PeriodicSearch;

static double size_of(const FcStepResult* result) { return fc_size(fc_bristle_of(result)); }

static FcMap free_map_of(PeriodicSearch* search) {
    if (!search->has_free_map) {
        search->free_map =
            fc_march_map(search->scene, search->options, search->period, size_of(&search->total),
                         search->is_planar ? &search->free_map_across : NULL, &search->total.evaluations);
        if (fc_may_stick(search->scene->friction)) { // to the last digit
            search->free_map.offset = search->scene->drive.V.value * search->period;
            search->free_map_across.offset = search->scene->drive.V_y.value * search->period;
        }
        search->has_free_map = true;
        assert(fc_map_contracts(&search->free_map));
        search->largest_free_start[0] = search->largest_free_start[1] = INFINITY;
    }
    return search->free_map;
}

// The farthest start to that side (1 or -1) that meets no bound, from the end of the farthest start of all.
static double largest_free_start_of(PeriodicSearch* search, int side) {
    assert(side == 1 || side == -1);
    double* largest_free_start = &search->largest_free_start[side < 0];
    if (isfinite(*largest_free_start)) {
        return *largest_free_start;
    }
    const FcMap* map = &search->free_map;
    FcPlane plane;
    fc_plane_make(&plane, search->scene);
    const double farthest = side * fc_bound(&plane, FC_FREE, 0.0).D;
    FcStepResult end = {.delta = farthest, .evaluations = search->total.evaluations};
    // With static friction the bound that is met is the one without the drop.
    const bool drops = fc_has_static_friction(search->scene->friction);
    fc_march_step(drops ? &plane.of_static_limit : search->scene, search->options, search->period, &end);
    search->total.evaluations = end.evaluations;
    const double kept = 1.0 - map->relaxation;
    assert(kept > 0.0);
    const double margin = side * (end.delta - map->offset);
    *largest_free_start = side * fc_min(side * farthest, margin / kept);
    return *largest_free_start;
}

// Takes *total over n free periods.
static void take_free(const PeriodicSearch* search, double n, FcStepResult* total) {
    assert(n >= 0.0 && search->has_free_map);
    const FcMap map = fc_map_power(&search->free_map, n);
    fc_map_apply(&map, total);
    if (search->is_planar) {
        const FcMap across = fc_map_power(&search->free_map_across, n);
        fc_map_apply_across(&across, total);
    }
}

// Takes *total to the limit of infinitely many free periods.
static void settle(const PeriodicSearch* search, FcStepResult* total) {
    assert(search->has_free_map);
    const FcMap* map = &search->free_map;
    const FcMap* across = &search->free_map_across;
    const double least = FC_MIN_DIVISOR * fc_max(1.0, fc_max(fabs(map->offset), fabs(across->offset)));
    if (!(map->relaxation > least)) {
        return; // nothing relaxes
    }
    total->delta = map->offset / map->relaxation;
    total->delta_y = search->is_planar ? across->offset / map->relaxation : total->delta_y;
}

// Whether the period after n free ones meets the bound; n may be infinite.
static bool meets_after(PeriodicSearch* search, double n) {
    assert(n >= 0.0 && search->has_free_map && search->is_bounded);
    FcStepResult end = search->total;
    if (isinf(n)) {
        settle(search, &end);
    } else {
        take_free(search, n, &end);
        search->total.evaluations += FC_WORK_OF_POWER;
    }
    const FcBristle bristle = {.delta = end.delta, .delta_y = end.delta_y};
    const FcBristle reached = fc_project_onto_bound(search->scene, bristle);
    if (reached.delta != bristle.delta || reached.delta_y != bristle.delta_y) {
        return true;
    }
    end.meetings = 0;
    end.evaluations = search->total.evaluations;
    fc_march_step(search->scene, search->options, search->period, &end);
    search->total.evaluations = end.evaluations;
    return end.meetings > 0;
}

// free_periods by steps. The starts of free periods lie on a straight line, along which |delta| is convex at
// each phase. So all periods up to a last one are free.
static double free_periods_by_steps(PeriodicSearch* search, double left) {
    assert(left > 0.0);
    const FcMap map = free_map_of(search);
    const double moved = hypot(map.offset - map.relaxation * search->total.delta,
                               search->free_map_across.offset - map.relaxation * search->total.delta_y);
    FcPlane plane;
    fc_plane_make(&plane, search->scene);
    const double rounding = ROUNDING_OF_EDGE * fc_bound(&plane, FC_FREE, 0.0).D;
    if (map.relaxation == 0.0 ? moved == 0.0 : moved <= rounding) {
        return map.relaxation > 0.0 && meets_after(search, 0.0) ? 0.0 : left;
    }
    if (map.relaxation > 0.0 && !meets_after(search, HUGE_VAL) && !meets_after(search, 0.0)) {
        return left;
    }
    double free = 0.0; // periods that are free
    double more = 1.0; // periods that are not all free, once they are found
    while (free < left && search->total.evaluations <= FC_MAX_EVALUATIONS &&
           !meets_after(search, more - 1.0)) {
        free = more;
        more *= 2.0;
    }
    while (free < left && more - free > 1.0 && search->total.evaluations <= FC_MAX_EVALUATIONS) {
        const double middle = floor(0.5 * (free + more));
        if (middle == free || middle == more) { // beyond 2^53
            break;
        }
        if (meets_after(search, middle - 1.0)) {
            more = middle;
        } else {
            free = middle;
        }
    }
    assert(free >= 0.0 && free <= more);
    return free * moved <= rounding ? 0.0 : fc_min(free, left); // it is at the largest_free_start
}

// The number of periods after the free start delta that meet no bound. The deflection moves by s (1 - P^n) /
// (1 - P) in n of them, with the first shift s.
static double free_periods(PeriodicSearch* search, double left) {
    assert(left > 0.0);
    const FcMap map = free_map_of(search);
    if (search->is_planar || map.relaxation > FC_MAX_FORGOTTEN) {
        return free_periods_by_steps(search, left);
    }
    const double delta = search->total.delta;
    const double s = map.offset - map.relaxation * delta;
    if (s == 0.0) {
        return left;
    }
    const int side = s > 0.0 ? 1 : -1;
    const double largest_free_start = largest_free_start_of(search, side);
    const double margin = side * (largest_free_start - delta) / fabs(s);
    if (!(margin * map.relaxation < 1.0)) { // never
        return left;
    }
    if (!(side * (largest_free_start - delta) > ROUNDING_OF_EDGE * fabs(largest_free_start))) {
        return 0.0;
    }
    const double n = map.relaxation > 0.0 ? log1p(-map.relaxation * margin) / log1p(-map.relaxation) : margin;
    assert(!(n < 0.0));
    return fc_min(left, floor(n) + 1.0);
}

static void take_cycles(PeriodicSearch* search, double times) {
    assert(times >= 0.0 && search->anchor_period >= 0.0 && search->anchor_period < search->done);
    FcStepResult* total = &search->total;
    const FcStepResult* anchor = &search->anchor;
    total->impulse += times * (total->impulse - anchor->impulse);
    total->impulse_y += times * (total->impulse_y - anchor->impulse_y);
    total->work += times * (total->work - anchor->work);
    total->heat += times * (total->heat - anchor->heat);
    total->drag += times * (total->drag - anchor->drag);
    search->done += times * (search->done - search->anchor_period);
}

static bool has_broken_away(const PeriodicSearch* search, const FcStepResult* result) {
    return fc_has_broken_away(search->scene->friction, result->state);
}

// Whether the bristle has returned to its state after the kept period.
static bool repeats(PeriodicSearch* search) {
    const FcStepResult* total = &search->total;
    const double size = size_of(total);
    const double changed =
        fc_max(fabs(total->delta - search->anchor.delta), fabs(total->delta_y - search->anchor.delta_y));
    if (search->anchor_period < 0.0 ||
        has_broken_away(search, total) != has_broken_away(search, &search->anchor) ||
        !(changed <= FC_SAME_END * size)) {
        return false;
    }
    return changed <= FC_SAME_END * FC_MIN_CHANGE * size ||
           changed <= FC_SAME_END * fc_min(1.0, free_map_of(search).relaxation) * size;
}

// In the plane a bristle that slips little in each period forgets its direction slowly. Takes its end to that of a
// period that repeats, by a step of Newton; the last period began at `from` [m].
static bool take_newton_step(const FcScene* scene, FcVector from, FcStepResult* total) {
    const FcVector moved = {total->delta - from.x, total->delta_y - from.y};
    const FcVector x = total->by_start[0]; // derivatives of the end by the start
    const FcVector y = total->by_start[1];
    const double all = (1.0 - x.x) * (1.0 - y.y) - x.y * y.x;
    if (!(hypot(x.x, x.y) + hypot(y.x, y.y) < 1e100) || all == 0.0) {
        return false;
    }
    const FcVector start = {((1.0 - y.y) * moved.x + y.x * moved.y) / all,
                            ((1.0 - x.x) * moved.y + x.y * moved.x) / all}; // what the start is to move by
    const double length = hypot(start.x, start.y);
    if (!isfinite(length)) {
        return false;
    }
    const double most = FC_MAX_NEWTON_STEP * size_of(total);
    const double part = length > most ? most / length : 1.0;
    const FcBristle reached = fc_project_onto_bound(scene, (FcBristle){.delta = from.x + part * start.x,
                                                                       .delta_y = from.y + part * start.y,
                                                                       .state = total->state});
    total->delta = reached.delta;
    total->delta_y = reached.delta_y;
    return true;
}

// Whether the mean since the kept period differs from *mean, which it becomes.
static bool still_drifts(const PeriodicSearch* search, FcVector* mean) {
    const double periods = search->done - search->anchor_period;
    assert(periods > 0.0);
    const FcVector before = *mean;
    *mean = (FcVector){search->total.impulse / periods, search->total.impulse_y / periods};
    const double allowed = search->options->tolerance * search->options->force * search->period;
    return !(hypot(mean->x - before.x, mean->y - before.y) <= allowed);
}

// Keeps the last period to compare later ones with. In an endless search the sums begin anew there: their size and the number
// of free periods would take digits from the cycle's.
static void move_anchor(PeriodicSearch* search, bool is_endless) {
    FcStepResult* total = &search->total;
    if (is_endless) {
        fc_result_start(total, fc_bristle_of(total), total->evaluations);
        search->done = 0.0;
    }
    search->anchor = *total;
    search->anchor_period = search->done;
    search->least.delta = INFINITY;
}

// Takes periods until one repeats another, none meets the bound any more, or they are too many. After each:
// - It changes nothing: all later ones are like it.
// - Free periods follow: they are taken at once, by a power of their map.
// - It meets the bound, or the next will: its end is compared with the anchor, which moves ever farther. In the plane a step of
//   Newton's method may be taken between two anchors.
static void search_repetition(PeriodicSearch* search, double periods) {
    assert(search->is_bounded && search->done <= periods);
    FcStepResult* total = &search->total;
    search->anchor_period = -1.0;
    search->least.delta = INFINITY;
    int meetings = 0;
    // With static friction a step of Newton may lead from one cycle to another.
    const bool may_step =
        search->is_planar && isinf(periods) && !fc_has_static_friction(search->scene->friction);
    double keep = 1.0;                    // the number of the next meeting that is kept
    FcVector mean = {INFINITY, INFINITY}; // N s, impulse of a period up to the last one that was kept
    const int most = (search->is_planar && isinf(periods) ? FC_LONGER_IF_DRIFTING : 1) * FC_MAX_MEETINGS;
    while (search->done < periods && total->evaluations <= FC_MAX_EVALUATIONS && meetings < most) {
        total->evaluations += FC_WORK_OF_PERIOD;
        const FcStepResult before = *total;
        total->meetings = 0;
        fc_march_step(search->scene, search->options, search->period, total);
        search->done += 1.0;
        const bool was_free = total->meetings == 0 && !has_broken_away(search, total);
        if (was_free && total->delta == before.delta && total->delta_y == before.delta_y) {
            search->anchor_period = -1.0;
            return;
        }
        const double n =
            was_free && search->done < periods ? free_periods(search, periods - search->done) : 0.0;
        if (n == 0.0) { // it has met its bound, or will in the next period
            meetings++;
            if (!was_free && (isinf(search->least.delta) || size_of(total) < fc_size(search->least))) {
                search->least = fc_bristle_of(total);
            }
            if (repeats(search)) {
                return;
            }
            // Each is kept half as long again as the last, so that a cycle of any length returns to it.
            if (meetings >= keep) {
                keep = ceil(1.5 * meetings);
                if (!still_drifts(search, &mean) && meetings > FC_MAX_MEETINGS) {
                    return;
                }
                move_anchor(search, isinf(periods));
            } else if (may_step && !was_free &&
                       meetings < FC_MAX_MEETINGS / 2 && // the mean over the last third must be one
                       take_newton_step(search->scene, (FcVector){before.delta, before.delta_y}, total)) {
                search->anchor_period = -1.0; // periods repeat only if no step lies between them
            }
            continue;
        }
        if (isinf(n)) {
            settle(search, total);
            search->anchor_period = -1.0;
            return;
        }
        take_free(search, n, total);
        search->done += n;
        assert(search->done <= periods);
    }
}

static PeriodicSearch search_from(const FcScene* scene, const FcSolverOptions* options,
                                  const FcStepResult* start) {
    return (PeriodicSearch){.scene = scene,
                            .options = options,
                            .period = 1.0 / scene->drive.vibration.f,
                            .is_bounded = fc_march_may_meet(scene),
                            .is_planar = fc_is_planar(scene, fc_bristle_of(start)),
                            .total = *start};
}

static double step_over_equal_periods(const FcScene* scene, const FcSolverOptions* options, double periods,
                                      FcStepResult* total) {
    assert(periods >= 1.0 && periods == floor(periods) && !fc_drive_is_linear(&scene->drive));
    PeriodicSearch search = search_from(scene, options, total);
    if (!search.is_bounded) {
        free_map_of(&search);
        take_free(&search, periods, &search.total);
        *total = search.total;
        return search.done;
    }
    while (search.done < periods && search.total.evaluations <= FC_MAX_EVALUATIONS) {
        search_repetition(&search, periods);
        const double cycle = search.done - search.anchor_period;
        if (search.done < periods && cycle > 0.0 && repeats(&search)) {
            take_cycles(&search, floor((periods - search.done) / cycle));
        } else if (search.done < periods && search.anchor_period < 0.0) { // each period leads back
            free_map_of(&search);
            take_free(&search, periods - search.done, &search.total);
            search.done = periods;
        }
    }
    *total = search.total;
    return search.done;
}

// The options of a step with several intervals whose contact may stiffen.
static FcSolverOptions options_until_end(const FcSolverOptions* options, const FcScene* scene, double h) {
    FcSolverOptions own = *options;
    const FcScene end = fc_scene_from(scene, h);
    own.stiffness_at_end = end.is_open ? 0.0 : fc_scene_largest_stiffness(&end, 0.0);
    return own;
}

// The ways of a step:
// - less than two periods, or none: one march over all its segments
// - two periods or more while an input moves linearly: multirevolution, which is refused if they are too many
// - an open contact: no march
// - held inputs: equal periods, of which those that repeat are taken at once
// The rest after whole periods is marched. Too many evaluations are refused.
bool fc_periods_step(const FcScene* scene, const FcSolverOptions* options, double h, FcStepResult* result,
                     FcMessage* message) {
    const double f = scene->drive.vibration.f;
    const bool is_linear = fc_drive_is_linear(&scene->drive);
    const double periods = fc_drive_vibrates(&scene->drive) ? floor(h * f) : 0.0;
    const double rest = periods > 0.0 ? fc_max(0.0, fma(h, f, -periods) / f) : h;
    // A rest of no more than the rounding of h could take a slip off its bound.
    const bool has_rest = rest > 4.0 * DBL_EPSILON * h;
    assert(h >= 0.0 && rest <= h);
    FcSolverOptions until_end;
    if (is_linear && (periods >= 2.0 || fc_scene_has_segments(scene))) {
        until_end = options_until_end(options, scene, h);
        options = &until_end;
    }
    if (periods > FC_MAX_CHANGING_PERIODS && is_linear) {
        return fc_message_set(
            message,
            "a step of %.9g s holds %.9g vibration periods while an input moves (its derivative is not 0); "
            "at most %.9g of them are computed: the largest step is %.9g s",
            h, periods, FC_MAX_CHANGING_PERIODS, FC_MAX_CHANGING_PERIODS / f);
    }
    double done = periods;
    if (periods < 2.0) {
        fc_march_segments(scene, options, h, result);
    } else if (is_linear) {
        done = fc_multirevolution(scene, options, periods, result);
        if (has_rest) {
            const FcScene later = fc_scene_later(scene, periods / f);
            fc_march_segments(&later, options, rest, result);
        }
    } else if (fc_scene_is_separated(scene)) {
        fc_open_contact_step(result);
    } else {
        done = step_over_equal_periods(scene, options, periods, result);
        if (has_rest) {
            fc_march_segments(scene, options, rest, result);
        }
    }
    assert(done >= 0.0 && done <= periods);
    if (result->evaluations > FC_MAX_EVALUATIONS) {
        return fc_message_set(
            message,
            "the step of %.9g s needs more than %.0e evaluations: an input or the separation moves over "
            "too many orders of magnitude in it, or no period is like another; use steps of at most %.1g s",
            h, FC_MAX_EVALUATIONS, done < periods && done >= 1.0 ? 0.5 * done / f : 0.01 * h);
    }
    return true;
}

FcVector fc_periods_settled(const FcScene* scene, const FcSolverOptions* options, FcStepResult* end,
                            bool* scatters) {
    const double f = scene->drive.vibration.f;
    assert(f > 0.0 && fc_drive_vibrates(&scene->drive) && !fc_drive_is_linear(&scene->drive));
    if (fc_scene_is_separated(scene)) {
        fc_open_contact_step(end);
        return (FcVector){0.0, 0.0};
    }
    PeriodicSearch search = search_from(scene, options, end);
    if (search.is_bounded) {
        search_repetition(&search, HUGE_VAL);
        const double cycle = search.done - search.anchor_period;
        if (search.anchor_period >= 0.0 && cycle > 0.0) {
            *scatters = fc_has_static_friction(scene->friction) && !repeats(&search);
            *end = search.total;
            if (isfinite(search.least.delta)) {
                end->delta = search.least.delta;
                end->delta_y = search.least.delta_y;
                end->state = search.least.state;
            }
            return (FcVector){(search.total.impulse - search.anchor.impulse) / cycle * f,
                              (search.total.impulse_y - search.anchor.impulse_y) / cycle * f};
        }
        free_map_of(&search);
    } else {
        free_map_of(&search);
        settle(&search, &search.total);
    }
    *end = search.total;
    FcStepResult period = {.delta = end->delta, .delta_y = end->delta_y};
    take_free(&search, 1.0, &period);
    return (FcVector){period.impulse * f, period.impulse_y * f};
}
