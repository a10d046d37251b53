#include "solver/periods/period_interpolation.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stddef.h>

#include "model/bound.h"
#include "model/extremes.h"
#include "model/pi.h"
#include "model/root.h"
#include "solver/integrate/march.h"
#include "solver/integrate/tuning.h"
#include "solver/periods/segments.h"

// The margin over the bound that counts as none. Derived: between the ends of a part the bound bends by less, if
// it changes by a factor of up to 10 in the block.
static const double NO_ROOM = 1e-3;

// The numbers of the two maps, along and transverse.
enum { OF_MAP = sizeof(FcMap) / sizeof(double), NUMBERS = 2 * OF_MAP };
typedef union {
    struct {
        FcMap map, across;
    };
    double of[NUMBERS];
} Numbers;

typedef struct {
    const FcBlock* of;
    double period;   // s
    FcBristle start; // at the block
    double* evaluations;
    int numbers;                  // of a map, or of two in the plane
    double place[FC_MAX_POINTS];  // of the points, in [-2, 2]
    Numbers point[FC_MAX_POINTS]; // Newton's coefficients: divided differences
    int points;
} Block;

// The largest error of the block's maps, as a force [N].
static double allowed(const Block* block) {
    return FC_SHARE_OF_BLOCK * block->of->options->tolerance * block->of->options->force;
}

static FcScene scene_at(const Block* block, double k) {
    assert(block->of->first + k >= 0.0);
    const FcScene later = fc_scene_later(block->of->scene, (block->of->first + k) * block->period);
    return block->of->phase > 0.0 ? fc_scene_from(&later, block->of->phase) : later;
}

// The bristle on the bound of that side at the start of a scene.
static FcBristle on_bound(const FcScene* scene, int side) {
    assert(side == 1 || side == -1);
    FcPlane plane;
    fc_plane_make(&plane, scene);
    return (FcBristle){.delta = side * fc_bound(&plane, FC_SLIPPING, 0.0).D, .state = FC_SLIPPING};
}

// Whether a bristle deflected by delta [m] lies on the bound of the block at the start of period k. A distance
// that is not rounding would grow from period to period.
static bool lies_on_bound(const Block* block, double k, double delta) {
    const FcScene scene = scene_at(block, k);
    const double bound = on_bound(&scene, block->of->side).delta;
    return fabs(bound - delta) <= FC_ROUNDING_OF_BOUND * fabs(bound);
}

// A period of a scene from a bristle.
static FcStepResult take_period(const Block* block, const FcScene* scene, FcBristle start) {
    FcStepResult result;
    fc_result_start(&result, start, *block->evaluations);
    fc_march_segments(scene, block->of->options, block->period, &result);
    *block->evaluations = result.evaluations;
    return result;
}

// The bristle `periods` after period k - periods of the block.
static FcBristle warmed_up(const Block* block, double k, int periods) {
    assert(periods >= 0);
    FcBristle bristle = block->start;
    for (int before = periods; before > 0; before--) {
        const FcScene scene = scene_at(block, k - before);
        const FcStepResult result = take_period(block, &scene, bristle);
        bristle = fc_bristle_of(&result);
    }
    return bristle;
}

static bool broken_away(const Block* block, FcBristleState state) {
    return fc_has_broken_away(block->of->scene->friction, state);
}

static double apart(FcBristle a, FcBristle b) { return hypot(a.delta - b.delta, a.delta_y - b.delta_y); }

// The result of period k, if its start does not depend on the earlier start. Of starts after one period more each the
// differences fall like powers: all the later ones together must be within the share.
static bool sample_of_slips(const Block* block, const FcScene* scene, double k, Numbers* numbers) {
    const int most = block->of->warm_up;
    assert(most >= 2);
    const FcBristle start = warmed_up(block, k, most);
    const FcBristle other = warmed_up(block, k, most - 1);
    const double last = apart(start, other);
    const double before = apart(other, warmed_up(block, k, most - 2));
    const double close =
        allowed(block) / fc_max(block->of->options->stiffness_at_end, fc_scene_stiffness(scene, 0.0));
    if (broken_away(block, start.state) != broken_away(block, block->start.state) ||
        broken_away(block, other.state) != broken_away(block, start.state) ||
        !(last <= close && last * last <= close * (before - last))) {
        return false;
    }
    const FcStepResult result = take_period(block, scene, start);
    numbers->map = fc_map_of_one_start(&result);
    numbers->across =
        (FcMap){.relaxation = 1.0, .offset = result.delta_y, .impulse_offset = result.impulse_y};
    return broken_away(block, result.state) == broken_away(block, start.state) &&
           result.meetings > 0; // a free bristle forgets nothing
}

// The map of period k of the block; false if it has segments, or does not lead from the bound to the bound as
// it should.
static bool sample(const Block* block, double k, Numbers* numbers) {
    FcScene scene = scene_at(block, k);
    if (scene.is_open || fc_scene_segment(&scene, block->period, block->period) < block->period ||
        scene.is_open) {
        return false;
    }
    if (block->of->warm_up > 0) {
        return sample_of_slips(block, &scene, k, numbers);
    }
    if (block->of->side == 0) {
        numbers->map = fc_march_map(&scene, block->of->options, block->period, fc_size(block->start),
                                    block->of->is_planar ? &numbers->across : NULL, block->evaluations);
        return true;
    }
    const FcBristle start = on_bound(&scene, block->of->side);
    if (fc_bristle_state(&scene, start) != FC_SLIPPING) {
        return false;
    }
    const FcStepResult result = take_period(block, &scene, start);
    numbers->map = fc_map_of_one_start(&result);
    return lies_on_bound(block, k + 1.0, result.delta);
}

// The bound [m]; of surfaces that are apart 1e100 m, for which there is no number.
static double bound_of(const FcCoefficients* at) {
    static const double FAR = 1e100;
    return at->limit < FAR * at->sigma ? at->limit / at->sigma : FAR;
}

// The effect of an error of each number of a map on a force of 1 N.
static Numbers weights(const Block* block, const Numbers* typical) {
    const FcScene begin = scene_at(block, 0.0);
    const FcScene end = scene_at(block, block->of->count - 1.0);
    const FcCoefficients at = fc_scene_coefficients(&begin, 0.0);
    const FcCoefficients at_end = fc_scene_coefficients(&end, 0.0);
    const double sigma = fc_max(block->of->options->stiffness_at_end, fc_max(at.sigma, at_end.sigma));
    const double delta = fc_max(fc_size(block->start), fc_max(bound_of(&at), bound_of(&at_end)));
    const double path = fc_drive_largest_speed(&begin.drive, block->period) * block->period + DBL_MIN;
    const double damping = block->of->scene->friction->sigma_1;
    // Errors of the deflection add up until they have relaxed.
    const double lives =
        fc_min(block->of->count, 1.0 / fc_max(typical->map.relaxation, 1.0 / block->of->count));
    const FcMap of_map = {
        .relaxation = sigma * delta * lives,
        .offset = sigma * lives,
        .impulse_slope = delta / block->period,
        .impulse_offset = 1.0 / block->period,
        .work_slope = delta / path,
        .work_offset = 1.0 / path,
        .drag_slope = damping * delta / path,
        .drag_offset = damping / path,
        .heat_square = delta * delta / path,
        .heat_slope = delta / path,
        .heat_offset = 1.0 / path,
    };
    return (Numbers){.map = of_map, .across = of_map};
}

// The angles of the points, over pi / 16: Chebyshev's, in an order that halves the angles between them. Of
// those in between, one at the end of the block comes first, since errors are largest there, and then one
// inside, where a kink would be.
static const int ANGLE[FC_MAX_POINTS] = {0, 16, 8, 12, 4, 14, 6, 2, 10, 15, 7, 1, 9, 13, 5, 3, 11};

// The place of period k in the block, in [-2, 2]: a length that keeps products of distances near 1.
static double place_in(const Block* block, double k) { return 4.0 * k / (block->of->count - 1.0) - 2.0; }

static double period_of_point(const Block* block, int j) {
    assert(j >= 0 && j < FC_MAX_POINTS);
    return (block->of->count - 1.0) * 0.5 * (1.0 - cos(FC_PI / 16.0 * ANGLE[j]));
}

// Infinite if an error is no number. Without a path work and heat have infinite weights and no errors.
static double largest_error(int count, const Numbers* weight, const double* error) {
    double largest = 0.0;
    for (int i = 0; i < count; i++) {
        const double seen = error[i] != 0.0 && weight->of[i] != 0.0 ? weight->of[i] * fabs(error[i]) : 0.0;
        if (isnan(seen)) {
            return HUGE_VAL;
        }
        largest = fc_max(largest, seen);
    }
    return largest;
}

// The interpolated map of period k: Newton's polynomial.
static Numbers map_at(const Block* block, double k) {
    Numbers map = {.of = {0.0}};
    const double place = place_in(block, k);
    assert(block->points <= FC_MAX_POINTS);
    for (int j = block->points - 1; j >= 0; j--) {
        for (int i = 0; i < block->numbers; i++) {
            map.of[i] = map.of[i] * (place - block->place[j]) + block->point[j].of[i];
        }
    }
    return map;
}

// Subtracts from the map of period k the map that the block predicts; the effect of the rest on a force [N].
static double less_foretold(const Block* block, double k, Numbers* map) {
    const Numbers weight = weights(block, map);
    const Numbers predicted = map_at(block, k);
    for (int i = 0; i < block->numbers; i++) {
        map->of[i] -= predicted.of[i];
    }
    return largest_error(block->numbers, &weight, map->of);
}

// Interpolates the block, point by point, up to a point that the points before it predict. False if there is
// none, or if a period has no map.
static bool interpolate(Block* block) {
    const double may = allowed(block);
    const double most = fc_min(FC_MAX_POINTS, floor(FC_MAX_PART_OF_BLOCK * block->of->count));
    double before_last = HUGE_VAL;
    for (block->points = 0; block->points < most;) {
        const int j = block->points;
        const double k = period_of_point(block, j);
        Numbers error;
        if (!sample(block, k, &error)) {
            return false;
        }
        const double last = less_foretold(block, k, &error);
        double product = 1.0;
        block->place[j] = place_in(block, k);
        for (int before = 0; before < j; before++) {
            product *= block->place[j] - block->place[before];
        }
        assert(product != 0.0); // no two points are one
        for (int i = 0; i < block->numbers; i++) {
            block->point[j].of[i] = error.of[i] / product;
        }
        block->points++;
        // The errors of a kink fall slowly, and one may be small by chance.
        const double most_before = block->of->warm_up > 0 ? 1.0 : FC_MAX_ERROR_BEFORE;
        if (j >= FC_MIN_POINTS && last <= may && before_last <= most_before * may) {
            return true;
        }
        before_last = last;
    }
    return false;
}

static double periods_of_part(const Block* block) {
    return fc_max(1.0, floor(block->of->count / FC_PARTS_OF_BLOCK));
}

// The time between a and b at which the push turns. If d does not vibrate, that is nearly the reversal of V.
static double turn_of(FcPushed push, double a, double b, double* evaluations) {
    assert(a <= b);
    const double at_a = fc_push_at(&push, a);
    const double at_b = fc_push_at(&push, b);
    *evaluations += 2.0;
    const FcDrive* drive = &push.plane->scene->drive;
    return drive->vibration.a_d != 0.0 && at_a * at_b < 0.0
               ? fc_root_between(fc_push_at, &push, a, at_a, b, at_b, 0.0, evaluations)
               : fc_drive_next_event(drive, a, b).time;
}

// The distance of both bounds less the way of the bristle from the one that it leaves to the other [m], in period k of
// an ElasticPlastic bristle. A bristle leaves its bound where the push ends, and then moves as the surfaces do. If they move it by
// more than the distance until they turn, it reaches the other bound: below 0 it slips along both.
static double distance_less_way(const Block* block, double k) {
    const FcScene scene =
        scene_at(block, fc_min(k, block->of->count - 2.0)); // up to two periods are looked at
    const int side = block->of->side;
    assert(side == 1 || side == -1);
    FcPlane plane;
    fc_plane_make(&plane, &scene);
    // The vibration opposes the slip most half a period after the start of the scene or later.
    const FcDrive* drive = &scene.drive;
    const FcPhase phase = fc_drive_phase(drive, 0.0);
    const double turns = (side > 0 ? 0.5 : 0.0) - atan2(phase.sine, phase.cosine) / (2.0 * FC_PI);
    const double half = 0.5 * block->period;
    const double opposed = half + (turns + 0.5 - floor(turns + 0.5)) * block->period;
    const double leaves =
        turn_of((FcPushed){&plane, FC_SLIPPING, {side, 0.0}}, opposed - half, opposed, block->evaluations);
    const double nears =
        turn_of((FcPushed){&plane, FC_FREE, {-side, 0.0}}, opposed, opposed + half, block->evaluations);
    return fc_bound(&plane, FC_SLIPPING, leaves).D + fc_bound(&plane, FC_FREE, nears).D -
           fabs(fc_drive_displacement(drive, leaves, nears));
}

// Whether the block also predicts the period in which a slip along the other bound is most likely to begin or to
// cease between its points: that in which the distance less way passes 0, or else an extreme one. In ElasticPlastic, while V
// reverses; else there is none.
static bool predicts_slips(const Block* block) {
    const FcScene first = scene_at(block, 0.0);
    if (block->of->side == 0 || !fc_may_stick(first.friction) ||
        fabs(first.drive.V.value) >= first.drive.vibration.V_1) {
        return true;
    }
    const double stride = periods_of_part(block);
    double before[2] = {distance_less_way(block, 0.0), distance_less_way(block, stride)};
    double at = 0.0;
    double least = HUGE_VAL;
    for (double k = 2.0 * stride; k < block->of->count; k += stride) {
        const double now = distance_less_way(block, k);
        const double falls = before[0] - before[1];
        const double rises = now - before[1];
        if (before[1] * now < 0.0) {
            least = 0.0;
            at = rint(k + stride * now / (before[1] - now));
        } else if (falls * rises > 0.0 && fabs(before[1]) < least) { // the vertex of a parabola
            least = fabs(before[1]);
            at = rint(k - stride + 0.5 * stride * (falls - rises) / (falls + rises));
        }
        before[0] = before[1];
        before[1] = now;
    }
    Numbers error;
    return at == 0.0 || (sample(block, at, &error) && less_foretold(block, at, &error) <= allowed(block));
}

// A free bounded bristle at the start of period k, and a lower bound of its margin in this period [m].
typedef struct {
    double k, margin;
    FcBristle start;
} Place;

// The bounds of the motion of a free bounded bristle in the periods of a block.
typedef struct {
    double stride;                       // periods of a part
    FcVector middle;                     // m, of the swing, from the deflection at a period's start
    double swing;                        // m, about the middle
    FcVector V, rate;                    // m/s and m/s a period, without the vibration
    double D[2 * FC_PARTS_OF_BLOCK + 2]; // m, the least bound of the periods at the ends of parts
} Margins;

static Margins margins_of(const Block* block) {
    const FcScene first = scene_at(block, 0.0);
    const FcDrive* drive = &first.drive;
    const double swing = hypot(drive->vibration.V_1, drive->vibration.V_2) / drive->omega;
    Margins margins = {.stride = periods_of_part(block),
                       .swing = 2.0 * swing,
                       .V = {drive->V.value, drive->V_y.value},
                       .rate = {drive->V.rate * block->period, drive->V_y.rate * block->period}};
    if (fc_may_stick(first.friction)) { // else it may swing about any middle
        const FcPhase phase = fc_drive_phase(drive, 0.0);
        const double square = drive->omega * drive->omega;
        margins.middle.x = (drive->V.rate - fc_drive_velocity_at_phase(drive, 0.0, phase).rate) / square;
        margins.middle.y = (drive->V_y.rate - fc_drive_velocity_y_at_phase(drive, 0.0, phase).rate) / square;
        margins.swing = swing;
    }
    for (int i = 0; i * margins.stride < block->of->count + margins.stride; i++) {
        const FcScene scene = scene_at(block, fc_min(i * margins.stride, block->of->count - 1.0));
        FcPlane plane;
        fc_plane_make(&plane, &scene);
        assert(i < 2 * FC_PARTS_OF_BLOCK + 2);
        margins.D[i] = fc_scene_smallest_saturation(&plane.of_static_limit, block->period);
    }
    return margins;
}

static double margin_at(const Block* block, const Margins* margins, double k, FcBristle start) {
    const int i = (int)(k / margins->stride);
    assert(i >= 0 && i < 2 * FC_PARTS_OF_BLOCK + 1);
    const double length = fc_min(margins->stride, block->of->count - 1.0 - i * margins->stride);
    const double part = length > 0.0 ? (k - i * margins->stride) / length : 0.0;
    const double D = margins->D[i] + part * (margins->D[i + 1] - margins->D[i]);
    const double V = hypot(margins->V.x + k * margins->rate.x, margins->V.y + k * margins->rate.y) +
                     hypot(margins->rate.x, margins->rate.y); // at the most
    return (1.0 - NO_ROOM) * D - hypot(start.delta - margins->middle.x, start.delta_y - margins->middle.y) -
           margins->swing - V * block->period;
}

// Whether the bristle would meet its bound in that period.
static bool meets(const Block* block, const Place* place) {
    const FcScene scene = scene_at(block, place->k);
    const FcBristle start = place->start;
    const FcBristle reached = fc_project_onto_bound(&scene, start);
    if (reached.delta != start.delta || reached.delta_y != start.delta_y) {
        return true;
    }
    return take_period(block, &scene, start).meetings > 0;
}

// ---- a stuck bristle of ElasticPlastic, whose motion is known at any time ----

// A bristle that sticks in the whole block: its first scene, and that of its bound.
typedef struct {
    const Block* block;
    FcScene first;
    FcPlane plane;
    FcDrive across;
} Stuck;

static FcBristle stuck_at(const Stuck* of, double t) {
    FcBristle bristle = of->block->start;
    bristle.delta += fc_drive_displacement(&of->first.drive, 0.0, t);
    bristle.delta_y += of->block->of->is_planar ? fc_drive_displacement(&of->across, 0.0, t) : 0.0;
    return bristle;
}

// The distance [m] to the bound, at the part `phase` of period k, or at the next end of the block.
static double margin_of_stuck(const Stuck* of, double k, double phase) {
    const double t = fc_min(fc_max(0.0, k + phase), of->block->of->count) * of->block->period;
    *of->block->evaluations += 1.0;
    return fc_bound(&of->plane, FC_FREE, t).D - fc_size(stuck_at(of, t));
}

// The least margin of period k: that at the vertex of a parabola through three times.
static double least_margin(const Stuck* of, double k) {
    double least = HUGE_VAL;
    double at = 0.0;
    for (int i = 0; i < FC_PHASES; i++) {
        const double margin = margin_of_stuck(of, k, (double)i / FC_PHASES);
        at = margin < least ? i : at;
        least = fc_min(least, margin);
    }
    const double before = margin_of_stuck(of, k, (at - 1.0) / FC_PHASES);
    const double after = margin_of_stuck(of, k, (at + 1.0) / FC_PHASES);
    const double bend = before - 2.0 * least + after;
    const double vertex = bend > 0.0 ? at + 0.5 * (before - after) / bend : at;
    return fc_min(least, margin_of_stuck(of, k, vertex / FC_PHASES));
}

// Whether a bristle that sticks in the block would meet its bound in it: it is followed through the tightest period and
// those beside it. It has no margin, by estimate, in these places.
static bool meets_while_stuck(const Block* block, const Place* suspects, int places) {
    assert(places > 0);
    Stuck of = {.block = block, .first = scene_at(block, 0.0)};
    fc_plane_make(&of.plane, &of.first);
    of.across = fc_drive_across(&of.first.drive);
    double part = 0.0;
    double least = HUGE_VAL;
    for (int i = 0; i < places; i++) {
        const double margin = least_margin(&of, suspects[i].k);
        part = margin < least ? suspects[i].k : part;
        least = fc_min(least, margin);
    }
    const double stride = periods_of_part(block);
    double tightest = part;
    for (double k = fc_max(0.0, part - stride); k < fc_min(part + stride + 1.0, block->of->count); k += 1.0) {
        const double margin = least_margin(&of, k);
        tightest = margin < least ? k : tightest;
        least = fc_min(least, margin);
    }
    for (double k = fc_max(0.0, tightest - 1.0); k < fc_min(tightest + 2.0, block->of->count); k += 1.0) {
        const Place place = {k, 0.0, stuck_at(&of, k * block->period)};
        if (meets(block, &place)) {
            return true;
        }
    }
    return false;
}

// Whether a bristle that relaxes would meet its bound in one of the places in which it has no margin by estimate.
static bool meets_in_some(const Block* block, const Place* suspects, int places) {
    for (int i = 0; i < places; i++) {
        if (meets(block, &suspects[i])) {
            return true;
        }
    }
    return false;
}

// In four steps: the maps of a few periods are interpolated, and refused if they are not smooth or predict other slips; all
// periods are taken by their maps, and the period with the least margin of each part is noted; the noted ones without a
// margin are marched, and the block is refused if one meets its bound; the result replaces *total.
bool fc_interpolate_periods(const FcBlock* of, FcStepResult* total) {
    assert(of->count > 1.0 && of->phase >= 0.0 && of->first >= of->warm_up);
    Block found = {.of = of,
                   .period = 1.0 / of->scene->drive.vibration.f,
                   .start = fc_bristle_of(total),
                   .numbers = of->is_planar ? NUMBERS : OF_MAP,
                   .evaluations = &total->evaluations};
    Block* block = &found;
    if (of->side != 0 && !lies_on_bound(block, 0.0, total->delta)) {
        return false;
    }
    if (!interpolate(block) || !predicts_slips(block)) {
        return false;
    }
    FcStepResult result = *total;
    const bool is_watched = of->side == 0 && of->warm_up == 0 && of->is_bounded;
    const Margins margins = is_watched ? margins_of(block) : (Margins){.stride = of->count};
    Place suspects[2 * FC_PARTS_OF_BLOCK + 1]; // the period with the least margin of each part
    int places = 0;
    Place least = {.margin = HUGE_VAL};
    for (double k = 0.0; k < of->count; k += 1.0) {
        if (is_watched) {
            const FcBristle start = {.delta = result.delta, .delta_y = result.delta_y};
            const Place at = {k, margin_at(block, &margins, k, start), start};
            least = at.margin <= least.margin ? at : least;
            if (fmod(k + 1.0, margins.stride) == 0.0 || k == of->count - 1.0) {
                if (least.margin <= 0.0) {
                    assert(places < 2 * FC_PARTS_OF_BLOCK + 1);
                    suspects[places++] = least;
                }
                least.margin = HUGE_VAL;
            }
        }
        const Numbers at = map_at(block, k);
        fc_map_apply(&at.map, &result);
        if (of->is_planar) {
            fc_map_apply_across(&at.across, &result);
        }
    }
    const bool sticks = fc_may_stick(of->scene->friction);
    if (places > 0 &&
        (sticks ? meets_while_stuck(block, suspects, places) : meets_in_some(block, suspects, places))) {
        return false;
    }
    result.evaluations = *block->evaluations;
    if (of->side != 0) {
        result.state = FC_CATCHING_UP; // the interpolated end lies on the bound but for its error
    }
    *total = result;
    return true;
}
