#include "solver/stick_slip/turning_points.h"

#include <assert.h>
#include <math.h>

#include "model/root.h"
#include "solver/solver.h"

// All are chosen by hand but MISSED_OF_PEAK.
//
// A cell lasts this many smooth times, in each of which the phase, ln sigma and ln g move by 1 at the most (bound.h). Less costs
// samples, more may hide two turns from the samples at its ends.
static const double CELL = 1.5;
// A root's tolerance where everything else is exact but for rounding, 4500 eps.
static const double ROUNDING_OF_TURN = 1e-12;
// In a cell the bound is at least this part of what it is at the start, since ln D moves by about 1. Less costs turns that are
// not needed, more misses some.
static const double LEAST_BOUND = 0.25;
// A piece of a bristle that relaxes ends where the bound has fallen to this part of what it was at the start. Less may pass over
// a meeting, more costs pieces.
static const double FARTHEST_FALL = 0.25;
// A bound that moves by no more than this, over D, stands still, 5 eps; the slope of its rate has a rounding of that.
static const double STANDS = 1e-15;
static const double SLOPE_OF_STANDING = 1e-11;
// Over the peak's height. Derived (may_turn_in_peak): 43 / (2^5 384), and three times that for what moves besides.
static const double MISSED_OF_PEAK = 0.01;
// A bristle within this of the bound, over D, may be on it. Less may miss its turn, more costs turns.
static const double NEAR_BOUND = 1e-6;
// Two turning points this near to each other, over what is left of the cell, count as one time: far above rounding, far below
// what moves the bristle.
static const double SAME_TIME = 1e-9;
// Turns are found at least as well as for this tolerance: where V only just reverses a turn that is taken a little early or
// late lets the bristle stick past its bound.
static const double LOOSEST_TURN = 1e-9;
// A cell is divided at most this often in a row: what two roots still closer enclose is below rounding, about 2^-30 squared.
enum { MOST_DIVISIONS = 30 };
// And by no more samples in all: where the rates are beyond the largest numbers nothing excludes two roots.
enum { MOST_SAMPLES_IN_CELL = 4096 };

// The rate [m/s] at which the upper bound (0) or the lower one (1) comes nearer, and its slope [m/s2].
static double approach(const FcTurningPoints* points, const FcBoundMotion* at, int which) {
    return ((which == 0 ? 1.0 : -1.0) - points->sign * at->k) * at->V - at->D_rate;
}

static double approach_rate(const FcTurningPoints* points, const FcBoundMotion* at, int which) {
    return ((which == 0 ? 1.0 : -1.0) - points->sign * (at->k + at->k_slope * at->V)) * at->V_rate -
           at->D_curvature;
}

// Whether it comes nearer from now on. Where neither moves both views are right: the upper one is taken to come nearer.
static bool nears(const FcTurningPoints* points, const FcBoundMotion* at, int which) {
    const double now = approach(points, at, which);
    const double rate = now != 0.0 ? now : approach_rate(points, at, which);
    return which == 0 ? !(rate < 0.0) : rate > 0.0;
}

void fc_turning_points_start(FcTurningPoints* points, const FcScene* scene, double tolerance, double end) {
    tolerance = fmin(tolerance, LOOSEST_TURN);
    points->law = scene;
    points->relaxes = scene->friction->model != FC_ELASTIC_PLASTIC;
    points->scene = scene;
    if (points->relaxes) {
        points->bound_scene = fc_scene_of_bound(scene, &points->friction);
        points->scene = &points->bound_scene;
    }
    points->end = end;
    points->constant_bound = !points->relaxes && fc_bound_is_constant(scene);
    points->last_step = cbrt(1e-4 * (points->constant_bound ? fmin(ROUNDING_OF_TURN, tolerance) : tolerance));
    points->tolerance = 0.01 * tolerance;
    points->at = &points->sample[0];
    points->ahead = points->sample_count = 0;
    points->next_turn = points->turn_count = 0;
    points->evaluations = 1.0;
    points->sign = 0.0;
    points->event = (FcDriveEvent){.time = 0.0};
    points->sample[0] = fc_turning_points_motion(points, 0.0);
    points->smooth_time = fc_bound_common_smooth_time(scene, end);
    points->peak_time = 0.0;
    points->speed = fc_drive_largest_speed(&scene->drive, end);
}

FcBoundMotion fc_turning_points_motion(const FcTurningPoints* points, double t) {
    if (points->constant_bound && t > 0.0) {
        return fc_bound_standing(points->scene, &points->sample[0], t);
    }
    FcBoundMotion at = fc_bound_motion(points->scene, t);
    if (points->relaxes) {
        fc_bound_relaxes(points->law->friction, 1, &at);
    }
    return at;
}

static void next_with_constant_bound(FcTurningPoints* points, FcPiece* piece) {
    const FcDrive* drive = &points->scene->drive;
    points->sample[0] = *points->at;
    const double start = points->sample[0].t;
    const double end = fc_drive_next_event(drive, start, points->end).time;
    const double V = fc_drive_V(drive, 0.5 * (start + end));
    points->sample[1] = fc_turning_points_motion(points, end);
    points->at = &points->sample[1];
    points->evaluations += 1.0;
    piece->start = &points->sample[0];
    piece->end = &points->sample[1];
    piece->nears[0] = V > 0.0;
    piece->nears[1] = V < 0.0;
    piece->turns = true;
}

// Whether q may vanish twice or oftener between the samples: it dips towards zero and its tangents meet beyond, or it
// is so steep at both ends that it turns twice in between (a cubic does not while the slopes' sum is at most three
// times the mean slope).
static bool may_turn_within(double q_a, double q_b, double slope_a, double slope_b, double duration) {
    const double change = q_b - q_a;
    if ((q_a < 0.0) == (q_b < 0.0)) {
        if (fmin(fabs(q_a), fabs(q_b)) > duration * fmax(fabs(slope_a), fabs(slope_b))) {
            return false;
        }
        const double s = q_a < 0.0 ? -1.0 : 1.0;
        if (s * slope_a < 0.0 && s * slope_b > 0.0) {
            const double meet = (change - slope_b * duration) / (slope_a - slope_b);
            return s * (q_a + slope_a * meet) <= 0.0;
        }
    }
    return slope_a * change >= 0.0 && slope_b * change >= 0.0 &&
           (fabs(slope_a) + fabs(slope_b)) * duration > 3.0 * fabs(change);
}

// Whether the cubic through the samples tells that q, which is nowhere farther from it than missed, has no second root: by
// its coefficients of Bernstein, between which it lies, as its slope lies between their differences. The slope of q is
// within 3.1 missed of that.
static bool is_told_by_cubic(double q_a, double q_b, double slope_a, double slope_b, double duration,
                             double missed) {
    const double by[4] = {q_a, q_a + slope_a * duration / 3.0, q_b - slope_b * duration / 3.0, q_b};
    const double s = q_b < 0.0 ? -1.0 : 1.0;
    const bool crosses = (q_a < 0.0) != (q_b < 0.0);
    bool told = crosses || s * q_a > missed;
    for (int i = 0; i < 3; i++) {
        told = told && (crosses ? s * (by[i + 1] - by[i]) > 3.1 / 3.0 * missed : s * by[i + 1] > missed);
    }
    return told;
}

typedef struct {
    const FcTurningPoints* points;
    int which;
    FcBoundMotion last; // evaluated
} Approach;

static FcRootFunction root_function(const Approach* of, const FcBoundMotion* at) {
    return (FcRootFunction){.value = approach(of->points, at, of->which),
                            .rate = approach_rate(of->points, at, of->which)};
}

static FcRootFunction evaluate(void* context, double t) {
    Approach* of = context;
    of->last = fc_turning_points_motion(of->points, t);
    return root_function(of, &of->last);
}

// The turning point between two samples at which a bound's approach changes its sign. One that vanishes at the first, but for
// rounding which may hold for a while, may have its turn later.
static FcBoundMotion turn_between(FcTurningPoints* points, int which, const FcBoundMotion* a,
                                  const FcBoundMotion* b) {
    FcBoundMotion from = *a;
    for (double part = SAME_TIME; approach(points, &from, which) == 0.0 && part < 1.0; part *= 32.0) {
        from = fc_turning_points_motion(points, a->t + part * (b->t - a->t));
        points->evaluations += 1.0;
    }
    if ((approach(points, &from, which) < 0.0) == (approach(points, b, which) < 0.0)) {
        return *a;
    }
    Approach of = {points, which, from};
    const double t = fc_root(evaluate, &of, from.t, root_function(&of, &from), b->t, root_function(&of, b),
                             points->last_step, points->tolerance * a->D, &points->evaluations);
    return fc_bound_nearby(points->scene, &of.last, t);
}

// Adds the turning point of a bound between two samples, if there is one. Where the bound starts to come nearer it is
// one only for a bristle that may be on the bound by then. Of a bound that hardly moves there may be any number in rounding:
// the list ends at `most`.
static void add_turn(FcTurningPoints* points, int which, bool may_be_on_bound, int most,
                     const FcBoundMotion* a, const FcBoundMotion* b) {
    const bool recedes = approach(points, a, which) < 0.0;
    if (recedes == (approach(points, b, which) < 0.0) || (recedes && !may_be_on_bound) ||
        points->turn_count == most) {
        return;
    }
    points->turn[points->turn_count++] = (FcTurningPoint){turn_between(points, which, a, b), which, recedes};
}

// Whether a bound may turn in a Stribeck peak. What a cubic through samples at a and b misses of its approach [m/s] is the
// fourth derivative times the time to the power 4, over 384. In a smooth time V / V_S moves by a half. The fifth derivative
// of e^-(x^2), by which D' moves, and twice the fourth of x e^-(x^2), by which V k does, are below 43 e^-(x^2 / 2).
static bool may_turn_in_peak(const FcTurningPoints* points, const FcBoundMotion* a, const FcBoundMotion* b,
                             int which) {
    const FcFriction* friction = points->law->friction;
    const double q_a = approach(points, a, which);
    const double q_b = approach(points, b, which);
    const double slope_a = approach_rate(points, a, which);
    const double slope_b = approach_rate(points, b, which);
    const double duration = b->t - a->t;
    const double part = duration / points->peak_time;
    const double moves = points->relaxes ? friction->V_S : a->D / points->peak_time;
    double missed = MISSED_OF_PEAK * (friction->staticRatio - 1.0) * moves * part * part * part * part;
    if (is_told_by_cubic(q_a, q_b, slope_a, slope_b, duration, missed)) {
        return false;
    }
    const double x = fmin(fabs(a->V), fabs(b->V)) / friction->V_S;
    missed *= exp(-0.5 * x * x);
    return missed * duration > points->tolerance * a->D
               ? !is_told_by_cubic(q_a, q_b, slope_a, slope_b, duration, missed)
               : may_turn_within(q_a, q_b, slope_a, slope_b, duration);
}

static bool may_turn_between(const FcTurningPoints* points, const FcBoundMotion* a, const FcBoundMotion* b,
                             int which) {
    if (points->peak_time > 0.0) {
        return may_turn_in_peak(points, a, b, which);
    }
    return may_turn_within(approach(points, a, which), approach(points, b, which),
                           approach_rate(points, a, which), approach_rate(points, b, which), b->t - a->t);
}

// Whether a bound stands still between two samples but for rounding, of which its slope has far more.
static bool stands_still(const FcTurningPoints* points, const FcBoundMotion* a, const FcBoundMotion* b,
                         int which) {
    const double duration = b->t - a->t;
    const double rate = fmax(fabs(approach(points, a, which)), fabs(approach(points, b, which)));
    const double slope = fmax(fabs(approach_rate(points, a, which)), fabs(approach_rate(points, b, which)));
    return rate * duration <= STANDS * a->D && slope * duration * duration <= SLOPE_OF_STANDING * a->D;
}

// Where to divide a cell [s]: where the approach is least, by a straight line through its slopes at both ends, if they
// point to one; there two roots part, or are excluded, at once. Else in the middle.
static double dividing_time(const FcTurningPoints* points, const FcBoundMotion* a, const FcBoundMotion* b,
                            int which) {
    const double slope_a = approach_rate(points, a, which);
    const double part = slope_a / (slope_a - approach_rate(points, b, which));
    return a->t + (part > 0.02 && part < 0.98 ? part : 0.5) * (b->t - a->t);
}

// Adds the turning points of a bound between two samples: from left to right, dividing as needed.
static void add_turns(FcTurningPoints* points, int which, bool may_be_on_bound, const FcBoundMotion* start,
                      const FcBoundMotion* end) {
    const bool keeps_sign = (approach(points, start, which) < 0.0) == (approach(points, end, which) < 0.0);
    if (!(start->D < FC_NO_BOUND || end->D < FC_NO_BOUND) ||
        (keeps_sign && !may_turn_between(points, start, end, which)) ||
        stands_still(points, start, end, which)) {
        return; // nothing is met, or it makes no difference
    }
    const int before = points->turn_count;
    const int most = before + FC_MOST_TURNS_IN_CELL / 2; // as many for either bound
    FcBoundMotion left = *start;
    FcBoundMotion ahead[MOST_DIVISIONS + 1]; // nearer ones last
    int divisions[MOST_DIVISIONS + 1] = {0}; // of the stretch that ends there
    ahead[0] = *end;
    int samples = 0;
    for (int last = 0; last >= 0;) {
        const FcBoundMotion* right = &ahead[last];
        if (divisions[last] < MOST_DIVISIONS && samples++ < MOST_SAMPLES_IN_CELL &&
            may_turn_between(points, &left, right, which)) {
            divisions[last + 1] = ++divisions[last];
            ahead[last + 1] = fc_turning_points_motion(points, dividing_time(points, &left, right, which));
            points->evaluations += 1.0;
            last++;
        } else {
            add_turn(points, which, may_be_on_bound || points->turn_count > before, most, &left, right);
            left = *right;
            last--;
        }
    }
}

static void sort(FcTurningPoint* turns, int count) {
    for (int i = 1; i < count; i++) {
        const FcTurningPoint turn = turns[i];
        int k = i;
        for (; k > 0 && turns[k - 1].at.t > turn.at.t; k--) {
            turns[k] = turns[k - 1];
        }
        turns[k] = turn;
    }
}

// Where the cells that start at t must end: with a bristle that relaxes at the next reversal.
static double end_of_cells(FcTurningPoints* points, double t) {
    if (!points->relaxes) {
        return points->end;
    }
    if (!(points->event.time > t)) {
        points->event = fc_drive_next_event(&points->scene->drive, t, points->end);
    }
    points->sign = fc_sign(fc_drive_V(&points->scene->drive, 0.5 * (t + points->event.time)));
    return points->event.time;
}

// The end of the next cell, or of the next few where they are alike.
static void take_samples(FcTurningPoints* points) {
    const FcBoundMotion start = points->sample[points->sample_count];
    const double end = end_of_cells(points, start.t);
    FcBoundMotion* next = &points->sample[1];
    points->sample[0] = start;
    points->sample_count = 1;
    points->ahead = 0;
    if (points->smooth_time > 0.0) {
        const double cells = ceil((end - start.t) / (CELL * points->smooth_time));
        const double length = (end - start.t) / cells;
        points->sample_count = cells < FC_CELLS_AT_ONCE ? (int)cells : FC_CELLS_AT_ONCE;
        fc_bound_motions(points->scene, start.t + length, length, points->sample_count, next);
        if (points->relaxes) {
            fc_bound_relaxes(points->law->friction, points->sample_count, next);
        }
        if (cells <= FC_CELLS_AT_ONCE) {
            points->sample[points->sample_count].t = end;
        }
    } else {
        const double smooth_time = fc_bound_smooth_time(points->law, &start);
        points->peak_time = fc_has_stribeck_curve(points->law->friction) ? smooth_time : 0.0;
        const double t = start.t + CELL * smooth_time;
        *next = fc_turning_points_motion(points, t > start.t && t < end ? t : end);
    }
    FcBoundMotion* last = &points->sample[points->sample_count];
    if (points->relaxes && points->event.reversal && last->t == end) {
        last->V = 0.0; // and no rounding, beside which D' may be nothing
    }
    points->evaluations += points->sample_count;
}

// Whether D rises all the time between the samples. A bristle that relaxes then meets no bound: its k is at least 1, so that
// either comes nearer by -D' at the most; and D' has no Stribeck peak. Both must recede at the start too, by which the piece
// is judged: where D hardly moves that is a matter of V, which may not have turned yet but for rounding.
static bool rises(const FcTurningPoints* points, const FcBoundMotion* a, const FcBoundMotion* b) {
    return a->D_rate > 0.0 && b->D_rate > 0.0 && !nears(points, a, 0) && !nears(points, a, 1) &&
           !may_turn_within(a->D_rate, b->D_rate, a->D_curvature, b->D_curvature, b->t - a->t);
}

static void enter_cell(FcTurningPoints* points, double lowest, double highest) {
    if (points->ahead == points->sample_count) {
        take_samples(points);
    }
    const FcBoundMotion* start = &points->sample[points->ahead++];
    const FcBoundMotion* end = start + 1;
    points->at = start;
    points->turn_count = 0;
    points->next_turn = 0;
    if (points->relaxes && rises(points, start, end)) {
        return;
    }
    const double reach = points->speed * (end->t - start->t);
    const double bound = LEAST_BOUND * start->D;
    const bool reachable[2] = {fmax(highest, -bound) + reach >= bound, fmin(lowest, bound) - reach <= -bound};
    const double on_bound = (1.0 - NEAR_BOUND) * start->D;
    const bool may_be_on[2] = {highest >= on_bound, lowest <= -on_bound};
    const int first = may_be_on[1] ? 1 : 0;
    if (reachable[first]) {
        add_turns(points, first, may_be_on[first], start, end);
    }
    const bool slips_on =
        may_be_on[first] && !may_be_on[1 - first] && nears(points, start, first) && points->turn_count == 0;
    if (reachable[1 - first] && !slips_on) {
        add_turns(points, 1 - first, may_be_on[1 - first], start, end);
    }
    sort(points->turn, points->turn_count);
}

static void next_with_moving_bound(FcTurningPoints* points, double lowest, double highest, FcPiece* piece) {
    if (points->at == &points->sample[points->ahead]) {
        enter_cell(points, lowest, highest);
    }
    piece->start = points->at;
    // So near to a turning point the rate's sign is one of rounding, as it is at a reversal where the cell may start: what
    // holds is by what its turns were looked for.
    const double just_before = points->at->t - SAME_TIME * (points->sample[points->ahead].t - points->at->t);
    const FcBoundMotion* cell = &points->sample[points->ahead - 1];
    const FcBoundMotion* from = cell->t >= just_before ? cell : points->at;
    piece->nears[0] = nears(points, from, 0);
    piece->nears[1] = nears(points, from, 1);
    for (int i = 0; i < points->next_turn; i++) {
        const FcTurningPoint* turned = &points->turn[i];
        if (turned->at.t >= just_before) {
            piece->nears[turned->which] = turned->nears_after;
        }
    }
    piece->turns = points->next_turn < points->turn_count;
    piece->end = piece->turns ? &points->turn[points->next_turn++].at : &points->sample[points->ahead];
    points->at = piece->end;
}

// A bristle that relaxes may be anywhere. Its cells are joined up to the next reversal, since what it costs to tell where it
// is, is dear, but not where the bound falls by more than FARTHEST_FALL: a bristle that has met it might be back at it. Where
// the bound's rate is rounding alone each cell may cost MOST_SAMPLES_IN_CELL, so the evaluations are limited here too.
static void next_of_relaxing(FcTurningPoints* points, FcPiece* piece) {
    next_with_moving_bound(points, -FC_NO_BOUND, FC_NO_BOUND, piece);
    points->piece_start = *piece->start;
    while (
        !piece->turns && points->at->t < points->event.time && points->evaluations <= FC_MOST_EVALUATIONS &&
        points->at->D > FARTHEST_FALL * points->piece_start.D &&
        nears(points, points->at, 0) == piece->nears[0] && nears(points, points->at, 1) == piece->nears[1]) {
        FcPiece next;
        next_with_moving_bound(points, -FC_NO_BOUND, FC_NO_BOUND, &next);
        piece->end = next.end;
        piece->turns = next.turns;
    }
    piece->start = &points->piece_start;
}

void fc_turning_points_next(FcTurningPoints* points, double lowest, double highest, FcPiece* piece) {
    assert(points->at->t < points->end);
    if (points->relaxes) {
        next_of_relaxing(points, piece);
    } else if (points->constant_bound) {
        next_with_constant_bound(points, piece);
    } else {
        next_with_moving_bound(points, lowest, highest, piece);
    }
}
