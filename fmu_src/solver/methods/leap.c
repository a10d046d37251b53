#include "solver/methods/leap.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stddef.h>

#include "model/constants.h"
#include "model/regime.h"
#include "solver/budget.h"

// The numbers of points of the interpolation: 4, 7 and 13, each of which contains the points before.
enum { FEWEST_POINTS = 4, MOST_POINTS = 13 };

// The fewest periods of a block. Chosen empirically: a block costs about as many. Fewer periods are computed
// one by one.
static const double FEWEST = 9.0;
// The number of periods in which a bristle that slips in the plane forgets its angle. Chosen empirically:
// fewer are refused more often, more cost more. Each sample costs two times as many, so fewer periods than
// FEWEST_OF_SLIPS are computed one by one.
enum { WARM_UP = 3 };
static const double FEWEST_OF_SLIPS = 60.0;

// The numbers of the two maps, along and transverse.
enum { OF_MAP = sizeof(FcMap) / sizeof(double), NUMBERS = 2 * OF_MAP };
typedef union {
    struct {
        FcMap map, across;
    };
    double of[NUMBERS];
} Numbers;

// Periods that begin `phase` [s] after those of the scene.
typedef struct {
    const FcIntegration* law;
    const FcScene* scene;
    const FcSolverOptions* options;
    double period;       // s
    double first, count; // the block
    double phase;        // s
    int side;            // of the bound at which they begin, 0 for any start
    int warm_up;     // in the plane: periods after which a bristle that slips has forgotten, 0 for any start
    FcBristle start; // at the block
    double delta;    // m, size of the start
    double* evaluations;
    int numbers;                // of a map, or of two in the plane
    Numbers point[MOST_POINTS]; // at the Chebyshev points, then their coefficients
    int points;
} Block;

static FcScene scene_at(const Block* block, double k) {
    const FcScene later = fc_scene_later(block->scene, (block->first + k) * block->period);
    return block->phase > 0.0 ? fc_scene_from(&later, block->phase) : later;
}

// The bristle on the bound of that side at the start of a scene.
static FcBristle on_bound(const FcScene* scene, int side) {
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(scene, side, &friction);
    return (FcBristle){.delta = side * fc_bound(&bound, 0.0),
                       .slips = fc_has_static_friction(scene->friction) ? side : 0};
}

// Whether a bristle deflected by delta [m] lies on the bound of the block at the start of period k, within
// the tolerance.
static bool lies_on_bound(const Block* block, double k, double delta) {
    const FcScene scene = scene_at(block, k);
    const double allowed = FC_SHARE_OF_LEAP * block->options->tolerance * block->options->force;
    return fabs(on_bound(&scene, block->side).delta - delta) * fc_scene_stiffness(&scene, 0.0) <= allowed;
}

// A period of a scene from a bristle.
static FcStepResult take_period(const Block* block, const FcScene* scene, FcBristle start) {
    FcStepResult result = fc_result_from(start, *block->evaluations);
    block->law->step(scene, block->options, block->period, &result);
    *block->evaluations = result.evaluations;
    return result;
}

// The bristle `periods` after period k - periods of the block.
static FcBristle warmed_up(const Block* block, double k, int periods) {
    FcBristle bristle = block->start;
    for (int before = periods; before > 0; before--) {
        const FcScene scene = scene_at(block, k - before);
        const FcStepResult result = take_period(block, &scene, bristle);
        bristle = fc_bristle_of(&result);
    }
    return bristle;
}

// The result of period k in the plane, if its start does not depend on the earlier start.
static bool sample_of_slips(const Block* block, const FcScene* scene, double k, Numbers* numbers) {
    const FcBristle start = warmed_up(block, k, block->warm_up);
    const FcBristle other = warmed_up(block, k, block->warm_up - 1);
    const double allowed = FC_SHARE_OF_LEAP * block->options->tolerance * block->options->force;
    if (start.slips != block->start.slips || other.slips != start.slips ||
        !(hypot(start.delta - other.delta, start.delta_y - other.delta_y) * fc_scene_stiffness(scene, 0.0) <=
          allowed)) {
        return false;
    }
    const FcStepResult result = take_period(block, scene, start);
    numbers->map = fc_map_of_one_start(&result);
    numbers->across =
        (FcMap){.relaxation = 1.0, .offset = result.delta_y, .impulse_offset = result.impulse_y};
    return result.slips == start.slips;
}

// The map of period k of the block; false if it has pieces, or does not lead from the bound to the bound as
// it should.
static bool sample(const Block* block, double k, Numbers* numbers) {
    FcScene scene = scene_at(block, k);
    if (scene.is_open || fc_scene_piece(&scene, block->period, block->period) < block->period ||
        scene.is_open) {
        return false;
    }
    if (block->warm_up > 0) {
        return sample_of_slips(block, &scene, k, numbers);
    }
    if (block->side == 0) {
        numbers->map = block->law->free_map(&scene, block->options, block->period, block->delta,
                                            &numbers->across, block->evaluations);
        return true;
    }
    const FcBristle start = on_bound(&scene, block->side);
    if (fc_regime(&scene, start) != (FcRegime)block->side) {
        return false;
    }
    const FcStepResult result = take_period(block, &scene, start);
    numbers->map = fc_map_of_one_start(&result);
    return lies_on_bound(block, k + 1.0, result.delta);
}

// The effect of an error of each number of a map on a force of 1 N.
static Numbers weights(const Block* block, const Numbers* typical) {
    const FcScene begin = scene_at(block, 0.0);
    const FcScene end = scene_at(block, block->count - 1.0);
    const FcCoefficients at = fc_scene_coefficients(&begin, 0.0);
    const double sigma = fmax(at.sigma, fc_scene_stiffness(&end, 0.0));
    const double delta = fmax(block->delta, at.limit / at.sigma);
    const double path = fc_drive_largest_speed(&begin.drive, block->period) * block->period + DBL_MIN;
    const double damping = block->scene->friction->sigma_1;
    // Errors of the deflection add up until they have relaxed.
    const double lives = fmin(block->count, 1.0 / fmax(typical->map.relaxation, 1.0 / block->count));
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

static double largest_error(int count, const Numbers* weight, const double* error) {
    double largest = 0.0;
    for (int i = 0; i < count; i++) {
        const double seen = weight->of[i] != 0.0 ? weight->of[i] * fabs(error[i]) : 0.0;
        largest = seen <= largest ? largest : seen; // also if it is not a number
    }
    return largest;
}

// Chebyshev coefficients from the values at the points.
static void find_coefficients(int count, const Numbers* point, int points, Numbers* coefficient) {
    const int last = points - 1;
    for (int c = 0; c <= last; c++) {
        for (int i = 0; i < count; i++) {
            double sum = 0.0;
            for (int j = 0; j <= last; j++) {
                const double part = j == 0 || j == last ? 0.5 : 1.0;
                sum += part * point[j].of[i] * cos(FC_PI * c * (last - j) / last);
            }
            coefficient[c].of[i] = (c == 0 || c == last ? 1.0 : 2.0) / last * sum;
        }
    }
}

// The interpolated map of period k, by Clenshaw's rule.
static Numbers map_at(const Block* block, double k) {
    const int count = block->numbers;
    const double x = block->count > 1.0 ? 2.0 * k / (block->count - 1.0) - 1.0 : 0.0;
    Numbers b = block->point[block->points - 1];
    Numbers before = {.of = {0.0}};
    for (int c = block->points - 2; c >= 0; c--) {
        for (int i = 0; i < count; i++) {
            const double next = block->point[c].of[i] + (c > 0 ? 2.0 : 1.0) * x * b.of[i] - before.of[i];
            before.of[i] = b.of[i];
            b.of[i] = next;
        }
    }
    return b;
}

static double place_of(const Block* block, int j, int points) {
    return 0.5 * (block->count - 1.0) * (1.0 - cos(FC_PI * j / (points - 1)));
}

typedef enum { SMOOTH, ROUGH, NO_MAP } Interpolated;

// Interpolates the block through that number of points. If it is more than the fewest, sampled holds every
// second point in its first half.
static Interpolated interpolate(Block* block, int points, Numbers* sampled) {
    const bool has_half = points > FEWEST_POINTS;
    for (int j = points - 1; j >= 0 && has_half; j -= 2) {
        sampled[j] = sampled[j / 2];
    }
    for (int j = has_half ? 1 : 0; j < points; j += has_half ? 2 : 1) {
        if (!sample(block, place_of(block, j, points), &sampled[j])) {
            return NO_MAP;
        }
    }
    find_coefficients(block->numbers, sampled, points, block->point);
    block->points = points;
    const Numbers weight = weights(block, &sampled[points / 2]);
    const double may = FC_SHARE_OF_LEAP * block->options->tolerance * block->options->force;
    if (!(largest_error(block->numbers, &weight, block->point[points - 1].of) <= may)) {
        return ROUGH;
    }
    // A period between two points, not in the middle, at which even and odd errors appear.
    Numbers between;
    const double k =
        0.6 * place_of(block, points / 2, points) + 0.4 * place_of(block, points / 2 - 1, points);
    if (!sample(block, k, &between)) {
        return NO_MAP;
    }
    Numbers found = map_at(block, k);
    for (int i = 0; i < block->numbers; i++) {
        found.of[i] -= between.of[i];
    }
    return largest_error(block->numbers, &weight, found.of) <= may ? SMOOTH : ROUGH;
}

// Whether a bounded bristle would meet its bound in period k, from its state at the start of that period.
static bool meets(const Block* block, double k, const FcStepResult* at) {
    const FcScene scene = scene_at(block, k);
    const FcBristle start = {.delta = at->delta, .delta_y = at->delta_y};
    const FcBristle reached = block->law->is_planar ? fc_plane_reach(&scene, start) : fc_reach(&scene, start);
    if (reached.delta != start.delta || reached.delta_y != start.delta_y) {
        return true;
    }
    return take_period(block, &scene, start).meetings > 0;
}

// Takes *total through the block. False, with *total unchanged, if the block is not smooth or a free bristle
// meets its bound.
static bool take_block(Block* block, FcStepResult* total) {
    Numbers sampled[MOST_POINTS];
    int points = FEWEST_POINTS;
    Interpolated is = interpolate(block, points, sampled);
    while (is == ROUGH && 2 * points - 1 <= fmin(MOST_POINTS, block->count)) {
        points = 2 * points - 1;
        is = interpolate(block, points, sampled);
    }
    if (is != SMOOTH) {
        return false;
    }
    FcStepResult result = *total;
    const bool is_watched = block->side == 0 && block->warm_up == 0 && block->law->is_bounded;
    const double each = is_watched ? fmax(1.0, floor(block->count / FEWEST_POINTS)) : HUGE_VAL;
    double next = 0.0;
    for (double k = 0.0; k < block->count; k += 1.0) {
        if (is_watched && (k >= next || k == block->count - 1.0)) {
            if (meets(block, k, &result)) {
                return false;
            }
            next += each;
        }
        const Numbers at = map_at(block, k);
        fc_map_apply(&at.map, &result);
        if (block->law->is_planar) {
            fc_map_apply_across(&at.across, &result);
        }
    }
    result.evaluations = *block->evaluations;
    if (block->side != 0) {
        result.slips = fc_has_static_friction(block->scene->friction) ? block->side : 0;
    }
    *total = result;
    return true;
}

// One period, or the part [from, to] of it.
static void take_part(FcIntegration law, const FcScene* scene, const FcSolverOptions* options, double k,
                      double from, double to, FcStepResult* total) {
    FcScene part = fc_scene_later(scene, k / scene->drive.vibration.f);
    if (from > 0.0) {
        part = fc_scene_from(&part, from);
    }
    fc_periods_take(law, &part, options, to - from, total);
}

// The number of periods from k to the kink at |V| = V_1, beyond which V begins or ends to reverse.
static double to_kink(const FcScene* scene, double k) {
    const FcDrive* drive = &scene->drive;
    double nearest = HUGE_VAL;
    for (int side = -1; side <= 1 && drive->V.rate != 0.0; side++) {
        const double at =
            (side * drive->vibration.V_1 - drive->V.value) / drive->V.rate * drive->vibration.f; // periods
        if (at > k + 1.0 && (side != 0 || drive->vibration.V_1 == 0.0)) {
            nearest = fmin(nearest, floor(at - k));
        }
    }
    return nearest;
}

void fc_leap(FcIntegration law, const FcScene* scene, const FcSolverOptions* options, double periods,
             FcStepResult* total) {
    const double period = 1.0 / scene->drive.vibration.f;
    double longest = periods;
    for (double k = 0.0; k < periods && total->evaluations <= FC_MOST_EVALUATIONS;) {
        bool slipped = false;
        if (law.is_bounded) { // the first period says whether it slips
            total->meetings = 0;
            take_part(law, scene, options, k, 0.0, period, total);
            slipped = total->meetings > 0;
            k += 1.0;
        }
        const double room = fmin(longest, fmin(periods - k, to_kink(scene, k)));
        const bool on_line = slipped && !law.is_planar; // there it begins at its bound
        const double count = on_line ? room - 1.0 : room;
        const double fewest = slipped && law.is_planar ? FEWEST_OF_SLIPS : FEWEST;
        Block block = {.law = &law,
                       .scene = scene,
                       .options = options,
                       .period = period,
                       .first = k,
                       .count = floor(count),
                       .phase = on_line ? total->slip_time : 0.0,
                       .side = on_line ? total->slip_side : 0,
                       .warm_up = slipped && law.is_planar ? WARM_UP : 0,
                       .start = fc_bristle_of(total),
                       .delta = hypot(total->delta, total->delta_y),
                       .numbers = law.is_planar ? NUMBERS : OF_MAP,
                       .evaluations = &total->evaluations};
        bool taken = false;
        if (block.count >= fewest && k >= block.warm_up && (total->slips == 0 || slipped)) {
            FcStepResult before = *total;
            if (on_line) {
                take_part(law, scene, options, k, 0.0, block.phase, total);
            }
            taken = (!on_line || lies_on_bound(&block, 0.0, total->delta)) && take_block(&block, total);
            if (taken && on_line) {
                take_part(law, scene, options, k + block.count, block.phase, period, total);
            } else if (!taken) {
                before.evaluations = total->evaluations;
                *total = before;
            }
            longest = taken ? 2.0 * room : floor(0.5 * room);
        } else {
            longest = fmax(longest, 2.0 * fewest);
        }
        if (taken) {
            k += block.count + (on_line ? 1.0 : 0.0);
        } else if (!law.is_bounded) {
            take_part(law, scene, options, k, 0.0, period, total);
            k += 1.0;
        }
    }
}
