#include "solver/turning_points.h"

#include <assert.h>
#include <math.h>

#include "solver/bound.h"
#include "solver/bracketed_root.h"

// A cell, in smooth times.
static const double CELL = 1.0;
// Of the bound at the start of a cell: ln D moves by about 1 in it.
static const double LEAST_BOUND = 0.25;
// A cell is halved at most this often: what two roots still closer enclose is below rounding.
enum { MOST_HALVINGS = 12 };

static FcBoundSample sample(const FcScene* scene, double t) {
    const FcBoundMotion at = fc_bound_motion(scene, t);
    return (FcBoundSample){.t = t,
                           .D = at.D,
                           .q = {at.V - at.D_rate, at.V + at.D_rate},
                           .q_rate = {at.V_rate - at.D_curvature, at.V_rate + at.D_curvature},
                           .smooth_time = fc_bound_smooth_time(scene, t, at.d, at.d_rate)};
}

// The upper bound comes nearer while V > D', the lower one while V < -D'; where they are equal both views are right.
static void set_nears(FcTurningPoints* points, const double q[2]) {
    points->nears_upper = !(q[0] < 0.0);
    points->nears_lower = q[1] < 0.0;
}

FcTurningPoints fc_turning_points(const FcScene* scene, double end) {
    FcTurningPoints points = {.scene = scene, .end = end, .constant_bound = fc_bound_is_constant(scene)};
    if (points.constant_bound) {
        points.D = fc_bound(scene, 0.0);
    } else {
        points.cell_end = sample(scene, 0.0);
        points.D = points.cell_end.D;
        points.speed = fc_drive_largest_speed(&scene->drive, end);
    }
    points.evaluations = 1.0;
    return points;
}

static FcPiece next_with_constant_bound(FcTurningPoints* points) {
    const FcDrive* drive = &points->scene->drive;
    FcPiece piece = {.start = points->t, .start_bound = points->D, .end_bound = points->D};
    piece.end = fc_drive_next_event(drive, piece.start, points->end).time;
    const double V = fc_drive_V(drive, 0.5 * (piece.start + piece.end));
    piece.nears_upper = V > 0.0;
    piece.nears_lower = V < 0.0;
    points->evaluations += 1.0;
    points->t = piece.end;
    return piece;
}

// Whether q may vanish twice or oftener between the samples: it dips towards zero and its tangents meet beyond, or it
// is so steep at both ends that it turns twice in between (a cubic does not while the slopes' sum is at most three
// times the mean slope).
static bool may_turn_within(double q_a, double q_b, double slope_a, double slope_b, double duration) {
    const double mean_slope = (q_b - q_a) / duration;
    if ((q_a < 0.0) == (q_b < 0.0)) {
        if (fmin(fabs(q_a), fabs(q_b)) > duration * fmax(fabs(slope_a), fabs(slope_b))) {
            return false;
        }
        const double s = q_a < 0.0 ? -1.0 : 1.0;
        if (s * slope_a < 0.0 && s * slope_b > 0.0) {
            const double meet = duration * (mean_slope - slope_b) / (slope_a - slope_b);
            return s * (q_a + slope_a * meet) <= 0.0;
        }
    }
    return slope_a * mean_slope >= 0.0 && slope_b * mean_slope >= 0.0 &&
           fabs(slope_a) + fabs(slope_b) > 3.0 * fabs(mean_slope);
}

typedef struct {
    const FcScene* scene;
    int which;
} RootOf;

static FcRootFunction evaluate(const void* context, double t) {
    const RootOf* of = context;
    const FcBoundSample at = sample(of->scene, t);
    return (FcRootFunction){.value = at.q[of->which], .rate = at.q_rate[of->which]};
}

// Adds the root of q, if it changes its sign between the samples.
static void add_turn(FcTurningPoints* points, int which, const FcBoundSample* a, const FcBoundSample* b) {
    if ((a->q[which] < 0.0) == (b->q[which] < 0.0) || points->turn_count == FC_MOST_TURNS_IN_CELL) {
        return;
    }
    const RootOf of = {points->scene, which};
    const FcRootFunction at_a = {.value = a->q[which], .rate = a->q_rate[which]};
    const double t = fc_bracketed_root(evaluate, &of, a->t, at_a, b->t, &points->evaluations);
    points->turns[points->turn_count++] = (FcTurningPoint){t, which};
}

// Adds the roots of V - D' (which 0) or V + D' (1) between two samples: from left to right, halving as needed.
static void add_turns(FcTurningPoints* points, int which, const FcBoundSample* start,
                      const FcBoundSample* end) {
    FcBoundSample left = *start;
    FcBoundSample ahead[MOST_HALVINGS + 1] = {*end}; // nearer ones last
    int halvings[MOST_HALVINGS + 1] = {0};           // of the stretch that ends there
    for (int last = 0; last >= 0;) {
        const FcBoundSample* right = &ahead[last];
        if (halvings[last] < MOST_HALVINGS &&
            may_turn_within(left.q[which], right->q[which], left.q_rate[which], right->q_rate[which],
                            right->t - left.t)) {
            halvings[last + 1] = ++halvings[last];
            ahead[last + 1] = sample(points->scene, left.t + 0.5 * (right->t - left.t));
            points->evaluations += 1.0;
            last++;
        } else {
            add_turn(points, which, &left, right);
            left = *right;
            last--;
        }
    }
}

static void sort(FcTurningPoint* turns, int count) {
    for (int i = 1; i < count; i++) {
        const FcTurningPoint turn = turns[i];
        int k = i;
        for (; k > 0 && turns[k - 1].t > turn.t; k--) {
            turns[k] = turns[k - 1];
        }
        turns[k] = turn;
    }
}

static void enter_cell(FcTurningPoints* points, double lowest, double highest) {
    const FcBoundSample start = points->cell_end;
    const double end = start.t + CELL * start.smooth_time;
    points->cell_end = sample(points->scene, end > start.t && end < points->end ? end : points->end);
    points->evaluations += 1.0;
    points->turn_count = 0;
    points->next_turn = 0;
    set_nears(points, start.q);
    const double reach = points->speed * (points->cell_end.t - start.t);
    const double bound = LEAST_BOUND * start.D;
    if (fmax(highest, -bound) + reach >= bound) {
        add_turns(points, 0, &start, &points->cell_end);
    }
    if (fmin(lowest, bound) - reach <= -bound) {
        add_turns(points, 1, &start, &points->cell_end);
    }
    sort(points->turns, points->turn_count);
}

static FcPiece next_with_moving_bound(FcTurningPoints* points, double lowest, double highest) {
    if (!(points->t < points->cell_end.t)) {
        enter_cell(points, lowest, highest);
    }
    FcPiece piece = {.start = points->t,
                     .end = points->cell_end.t,
                     .start_bound = points->D,
                     .end_bound = points->cell_end.D,
                     .nears_upper = points->nears_upper,
                     .nears_lower = points->nears_lower};
    if (points->next_turn < points->turn_count) {
        const FcTurningPoint turn = points->turns[points->next_turn++];
        piece.end = turn.t;
        piece.end_bound = fc_bound(points->scene, turn.t);
        points->evaluations += 1.0;
        points->nears_upper ^= turn.which == 0;
        points->nears_lower ^= turn.which == 1;
    }
    points->t = piece.end;
    points->D = piece.end_bound;
    return piece;
}

FcPiece fc_turning_points_next(FcTurningPoints* points, double lowest, double highest) {
    assert(points->t < points->end);
    return points->constant_bound ? next_with_constant_bound(points)
                                  : next_with_moving_bound(points, lowest, highest);
}
