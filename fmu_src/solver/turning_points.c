#include "solver/turning_points.h"

#include <assert.h>
#include <math.h>

#include "solver/bracketed_root.h"

// A cell, in smooth times.
static const double CELL = 1.5;
// A root's tolerance where everything else is exact but for rounding.
static const double ROUNDING = 1e-12;
// Of the bound at the start of a cell: ln D moves by about 1 in it.
static const double LEAST_BOUND = 0.25;
// A bristle within this of the bound, over D, may be on it.
static const double NEAR_BOUND = 1e-6;
// To a known turn.
enum { MOST_STEPS = 100 };
// A cell is halved at most this often: what two roots still closer enclose is below rounding.
enum { MOST_HALVINGS = 12 };

// The slope of the rate at which a bound comes nearer.
static double approach_rate(const FcBoundMotion* at, int which) {
    return (which == 0 ? at->V_rate : -at->V_rate) - at->D_curvature;
}

// Where they stand still both views are right: the upper one is taken to come nearer.
static bool nears(const FcBoundMotion* at, int which) {
    return which == 0 ? !(fc_bound_approach(at, 0) < 0.0) : fc_bound_approach(at, 1) > 0.0;
}

void fc_turning_points_start(FcTurningPoints* points, const FcScene* scene, double tolerance, double end) {
    points->scene = scene;
    points->end = end;
    points->constant_bound = fc_bound_is_constant(scene);
    points->last_step = cbrt(1e-4 * (points->constant_bound ? fmin(ROUNDING, tolerance) : tolerance));
    points->at = &points->sample[0];
    points->ahead = points->sample_count = 0;
    points->next_turn = points->turn_count = 0;
    points->evaluations = 1.0;
    points->sample[0] = fc_bound_motion(scene, 0.0);
    points->smooth_time = fc_bound_common_smooth_time(scene, end);
    points->speed = fc_drive_largest_speed(&scene->drive, end);
    points->known.known = false;
    points->longest_way = INFINITY;
}

void fc_turning_points_foresee(FcTurningPoints* points, double lowest, double highest) {
    if (!points->constant_bound && points->smooth_time > 0.0) {
        points->known = fc_known_turns(points->scene, &points->sample[0], points->end, lowest, highest);
        points->longest_way = points->known.known ? CELL * points->smooth_time : INFINITY;
        points->next_known = 0.0;
        points->turned = -1;
        points->has_last = false;
    }
}

FcBoundMotion fc_turning_points_motion(const FcTurningPoints* points, double t) {
    return points->constant_bound ? fc_bound_standing(points->scene, &points->sample[0], t)
                                  : fc_bound_motion(points->scene, t);
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

// The one turn of a bound between a and b [s], the guess lying near it: Newton's method.
static FcBoundMotion turn_near(FcTurningPoints* points, int which, double a, double b, double guess) {
    const double last_step = points->last_step * points->smooth_time;
    double t = fmax(a, fmin(b, guess));
    for (int i = 0;; i++) {
        const FcBoundMotion at = fc_bound_motion(points->scene, t);
        points->evaluations += 1.0;
        const double rate = fc_bound_approach(&at, which);
        if (rate > 0.0) {
            a = t;
        } else {
            b = t;
        }
        const double step = -rate / approach_rate(&at, which);
        const bool inside = t + step >= a && t + step <= b;
        if ((inside && fabs(step) <= last_step) || i == MOST_STEPS) {
            return fc_bound_nearby(&at, inside ? t + step : t);
        }
        t = inside ? t + step : a + 0.5 * (b - a);
    }
}

// The sample that ends the step, taken once.
static const FcBoundMotion* last_sample(FcTurningPoints* points) {
    FcBoundMotion* last = &points->sample[FC_CELLS_AT_ONCE];
    if (!points->has_last) {
        *last = fc_bound_motion(points->scene, points->end);
        points->evaluations += 1.0;
        points->has_last = true;
    }
    return last;
}

static void next_with_known_turns(FcTurningPoints* points, FcPiece* piece) {
    const FcKnownTurns* known = &points->known;
    const int n = fmod(points->next_known, 2.0) == 0.0 ? 0 : 1;
    const double later = floor(0.5 * points->next_known) * known->cycle;
    const double quarter = 0.25 / points->scene->drive.vibration.f;
    const double from = known->middle[n] + later - quarter;
    const double to = known->middle[n] + later + quarter;
    points->sample[0] = *points->at;
    piece->start = &points->sample[0];
    piece->nears[0] = nears(piece->start, 0);
    piece->nears[1] = nears(piece->start, 1);
    if (points->turned >= 0) {
        piece->nears[points->turned] = false;
    }
    piece->turns = from < points->end &&
                   (to <= points->end || !(fc_bound_approach(last_sample(points), known->which[n]) > 0.0));
    if (piece->turns) {
        points->sample[1] = turn_near(points, known->which[n], fmax(0.0, from), fmin(to, points->end),
                                      known->guess[n] + later);
        points->next_known += 1.0;
        points->turned = known->which[n];
        points->at = &points->sample[1];
    } else {
        points->turned = -1;
        points->at = last_sample(points);
    }
    piece->end = points->at;
}

void fc_turning_points_shorten(FcTurningPoints* points, FcPiece* piece, int which) {
    if (!points->known.known) {
        return; // cells end where a bound starts to come nearer
    }
    FcBoundMotion at = {.t = piece->end->t};
    do {
        const double t = piece->start->t + 0.5 * (at.t - piece->start->t);
        if (!(t > piece->start->t && t < at.t)) {
            return; // what it could meet is below rounding
        }
        at = fc_bound_motion(points->scene, t);
        points->evaluations += 1.0;
    } while (!(fc_bound_approach(&at, which) < 0.0));
    points->next_known -= piece->turns ? 1.0 : 0.0;
    points->turned = -1;
    points->sample[1] = at;
    piece->turns = false;
    piece->end = points->at = &points->sample[1];
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

typedef struct {
    const FcScene* scene;
    int which;
    FcBoundMotion last; // evaluated
} Approach;

static FcRootFunction evaluate(void* context, double t) {
    Approach* of = context;
    of->last = fc_bound_motion(of->scene, t);
    return (FcRootFunction){.value = fc_bound_approach(&of->last, of->which),
                            .rate = approach_rate(&of->last, of->which)};
}

// The turning point between two samples at which a bound's approach changes its sign.
static FcBoundMotion turn_between(FcTurningPoints* points, int which, const FcBoundMotion* a,
                                  const FcBoundMotion* b) {
    Approach of = {points->scene, which, *a};
    const FcRootFunction at_a = {.value = fc_bound_approach(a, which), .rate = approach_rate(a, which)};
    const FcRootFunction at_b = {.value = fc_bound_approach(b, which), .rate = approach_rate(b, which)};
    const double t = fc_bracketed_root(evaluate, &of, a->t, at_a, b->t, at_b, points->last_step, INFINITY,
                                       &points->evaluations);
    return fc_bound_nearby(&of.last, t);
}

// Adds the turning point of a bound between two samples, if there is one. Where the bound starts to come nearer it is
// one only for a bristle that may be on the bound by then.
static void add_turn(FcTurningPoints* points, int which, bool may_be_on_bound, const FcBoundMotion* a,
                     const FcBoundMotion* b) {
    if ((fc_bound_approach(a, which) < 0.0) == (fc_bound_approach(b, which) < 0.0) ||
        (fc_bound_approach(a, which) < 0.0 && !may_be_on_bound) ||
        points->turn_count == FC_MOST_TURNS_IN_CELL) {
        return;
    }
    points->turn[points->turn_count++] =
        (FcTurningPoint){turn_between(points, which, a, b), which, fc_bound_approach(a, which) < 0.0};
}

static bool may_turn_between(const FcBoundMotion* a, const FcBoundMotion* b, int which) {
    return may_turn_within(fc_bound_approach(a, which), fc_bound_approach(b, which), approach_rate(a, which),
                           approach_rate(b, which), b->t - a->t);
}

// Adds the turning points of a bound between two samples: from left to right, halving as needed.
static void add_turns(FcTurningPoints* points, int which, bool may_be_on_bound, const FcBoundMotion* start,
                      const FcBoundMotion* end) {
    if (!may_turn_between(start, end, which)) {
        add_turn(points, which, may_be_on_bound, start, end);
        return;
    }
    const int before = points->turn_count;
    FcBoundMotion left = *start;
    FcBoundMotion ahead[MOST_HALVINGS + 1]; // nearer ones last
    int halvings[MOST_HALVINGS + 1] = {0};  // of the stretch that ends there
    ahead[0] = *end;
    for (int last = 0; last >= 0;) {
        const FcBoundMotion* right = &ahead[last];
        if (halvings[last] < MOST_HALVINGS && may_turn_between(&left, right, which)) {
            halvings[last + 1] = ++halvings[last];
            ahead[last + 1] = fc_bound_motion(points->scene, left.t + 0.5 * (right->t - left.t));
            points->evaluations += 1.0;
            last++;
        } else {
            add_turn(points, which, may_be_on_bound || points->turn_count > before, &left, right);
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

// The end of the next cell, or of the next few where they are alike.
static void take_samples(FcTurningPoints* points) {
    const FcBoundMotion start = points->sample[points->sample_count];
    FcBoundMotion* next = &points->sample[1];
    points->sample[0] = start;
    points->sample_count = 1;
    points->ahead = 0;
    if (points->smooth_time > 0.0) {
        const double cells = ceil((points->end - start.t) / (CELL * points->smooth_time));
        const double length = (points->end - start.t) / cells;
        points->sample_count = cells < FC_CELLS_AT_ONCE ? (int)cells : FC_CELLS_AT_ONCE;
        fc_bound_motions(points->scene, start.t + length, length, points->sample_count, next);
        if (cells <= FC_CELLS_AT_ONCE) {
            points->sample[points->sample_count].t = points->end;
        }
    } else {
        const double end =
            start.t + CELL * fc_bound_smooth_time(points->scene, start.t, start.d, start.d_rate);
        *next = fc_bound_motion(points->scene, end > start.t && end < points->end ? end : points->end);
    }
    points->evaluations += points->sample_count;
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
        may_be_on[first] && !may_be_on[1 - first] && nears(start, first) && points->turn_count == 0;
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
    piece->nears[0] = nears(points->at, 0);
    piece->nears[1] = nears(points->at, 1);
    if (points->next_turn > 0) {
        const FcTurningPoint* turned = &points->turn[points->next_turn - 1];
        piece->nears[turned->which] = turned->nears_after;
    }
    piece->turns = points->next_turn < points->turn_count;
    piece->end = piece->turns ? &points->turn[points->next_turn++].at : &points->sample[points->ahead];
    points->at = piece->end;
}

void fc_turning_points_next(FcTurningPoints* points, double lowest, double highest, FcPiece* piece) {
    assert(points->at->t < points->end);
    if (points->constant_bound) {
        next_with_constant_bound(points, piece);
    } else if (points->known.known) {
        next_with_known_turns(points, piece);
    } else {
        next_with_moving_bound(points, lowest, highest, piece);
    }
}
