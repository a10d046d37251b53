#include "solver/march/march.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

#include "model/regime.h"
#include "model/root.h"
#include "solver/budget.h"
#include "solver/interval.h"
#include "solver/march/meeting.h"
#include "solver/methods/methods.h"
#include "solver/stretches/watch.h"

// The change of V over V_S in which the curve is assumed to move by 1. Chosen empirically: twice of it makes
// panels that are refused, half of it more panels.
static const double CURVE_MOVES = 0.5;

// The largest displacement until V turns back, over the bound, that counts as rounding for a bristle at its
// static bound. Half or twice of it decides only motions of this size.
static const double ROUNDING_AT_REVERSAL = 1e-9;

// The displacement at the present V over a panel of a sticking bristle, over its bound. Chosen empirically:
// from one bound to the other it is 2. Half of it costs panels; twice of it makes panels that are cut early.
static const double SOON = 3.0;

// The number of regimes in a row, with next to no duration of each or of the one before, beyond which a panel slips
// whatever its push. Chosen empirically, for a bristle that rounding sends back and forth. Twice as many would cost
// time alone.
enum { MOST_IDLE = 4 };
// The length of the first such panel, a nudge, and the longest of such regimes, over the interval. Rounding: 4500
// eps. Twice of it slips twice as long without a push.
static const double FIRST_NUDGE = 1e-12;
// The longest regime that is idle over the length of the next such panel. Chosen empirically: without it a regime
// of some 1e-12 of the interval again and again costs millions of evaluations; a larger one counts more regimes.
static const double IDLE_BESIDE_NUDGE = 1e-3;

// The largest bend of the push between two points, over the largest bend from point to point there. Chosen
// empirically: half of it misses dips, twice of it costs evaluations.
static const double BENDS = 1.5;

// The number of halvings in search of a dip of the push to 0 between two points. Chosen empirically: a dip
// that is missed lasts less than 1e-3 of the cell. One more halving costs one evaluation.
enum { MOST_HALVINGS = 10 };

// A bound of |D''| over that of |D'| and the rate at which the scene moves. Derived: with L of FcPace and w of the
// vibration, |D''| <= D (L^2 + |(ln D)''|), and |(ln D)''| <= L w + 2 L^2: the last by E, load and 1 / d^3.
static const double BEND_OF_BOUND = 3.0;

typedef struct {
    const FcScene* scene;
    FcScene bound; // of a bristle that is free, or slips in Dahl and LuGre
    FcFriction bound_law;
    FcSolverOptions options;
    FcPlanner planner;
    double smooth_time;   // s, but for Stribeck's curve
    double duration;      // s
    double speed;         // m/s, at the most
    double fastest_bound; // m/s, |D'| is below it
    double t;             // s, reached
    double cut;           // s, that no panel steps over
    int side;             // of the bound along which it slips, else 0
    int left;             // of the bound that it has left at left_at, else 0
    double left_at;       // s
    double longest;       // s, slip so far
    FcStepResult* result;
} March;

static bool relaxes(const FcScene* scene) { return scene->friction->model != FC_ELASTIC_PLASTIC; }

// The bound along which the bristle slips.
static const FcScene* bound_of_slip(const March* m) {
    return fc_has_static_friction(m->scene->friction) ? m->scene : &m->bound;
}

static double allowed(const March* m) { return m->options.tolerance * m->options.force; }

// Prepares the plan of panels.
static void plan(March* m) {
    if (m->smooth_time == 0.0) {
        const FcPace pace = fc_pace(&m->bound, m->duration);
        m->planner = fc_planner(m->options.tolerance);
        m->smooth_time = fc_smooth_time(&pace);
        m->fastest_bound = pace.log_sigma * fc_scene_largest_saturation(&m->bound, m->duration);
    }
}

// The march points into itself.
static void begin(March* m, const FcScene* scene, const FcSolverOptions* options, double duration,
                  FcStepResult* result) {
    m->scene = scene;
    m->options = *options;
    m->duration = duration;
    m->result = result;
    m->t = m->cut = 0.0;
    m->side = m->left = 0;
    m->left_at = -1.0;
    m->longest = 0.0;
    m->bound = fc_scene_of_bound(scene, 0, &m->bound_law);
    m->smooth_time = 0.0; // not known
    m->speed = fc_drive_largest_speed(&scene->drive, duration);
}

// Whether D is constant; also if sigma and g fall alike.
static bool bound_stands(const FcScene* bound) {
    const bool stands_still = fc_scene_stiffness_is_constant(bound) && fc_scene_limit_is_constant(bound);
    return (stands_still || (fc_scene_ratio_is_constant(bound) && bound->drive.E.rate == 0.0)) &&
           (!fc_has_stribeck_curve(bound->friction) || fc_drive_V_is_constant(&bound->drive));
}

// ---- slipping ----

// Sets the cut: a reversal, since |V| has a kink there in Dahl and LuGre, or an end of Stribeck's curve.
static void find_cut(March* m, double end) {
    const FcDrive* drive = &m->scene->drive;
    if (m->cut > m->t && m->cut <= end) {
        return;
    }
    m->cut = relaxes(m->scene) ? fc_drive_next_event(drive, m->t, end).time : end;
    if (fc_has_stribeck_curve(m->scene->friction)) {
        for (int side = -1; side <= 1; side += 2) {
            FcDrive shifted = *drive;
            shifted.V.value -= side * FC_END_OF_PEAK * m->scene->friction->V_S;
            m->cut = fmin(m->cut, fc_drive_next_event(&shifted, m->t, m->cut).time);
        }
    }
}

static double smooth_time_of_slip(const March* m) {
    const FcFriction* friction = m->scene->friction;
    if (!fc_has_stribeck_curve(friction) || fc_drive_V_is_constant(&m->scene->drive)) {
        return m->smooth_time;
    }
    const FcVelocity at = fc_drive_velocity(&m->scene->drive, m->t);
    const double time = fc_velocity_time_of_change(&at, CURVE_MOVES * friction->V_S);
    const double ahead = fc_drive_V(&m->scene->drive, 0.5 * (m->t + fmin(m->cut, m->t + m->smooth_time)));
    return fabs(ahead) < FC_END_OF_PEAK * friction->V_S ? 1.0 / (1.0 / m->smooth_time + 1.0 / time)
                                                        : m->smooth_time;
}

// Moves the bristle at once to delta. The energy that it loses is heat.
static void move_to(March* m, double delta, double sigma) {
    FcStepResult* result = m->result;
    const double moved = delta - result->delta;
    result->heat -= 0.5 * sigma * moved * (delta + result->delta);
    result->drag += moved * fc_drive_V(&m->scene->drive, m->t);
    result->delta = delta;
}

// The time after which a push that is 0 decides, over the times in which the scene moves by 1 and V by V_S. Half or
// twice of it is as far from rounding and from the motion.
static const double JUST_AFTER = 1e-6;

// Whether the bristle slips on along that bound: the push is not below 0 or, if it is 0, not just after.
static bool slips_on(March* m, const FcScene* bound, int side) {
    const double push = fc_push(m->scene, bound, m->t, side);
    m->result->evaluations += 1.0;
    if (push != 0.0) {
        return push > 0.0;
    }
    const FcVelocity now = fc_drive_velocity(&m->scene->drive, m->t);
    const double time = fmin(m->smooth_time, fc_velocity_time_of_change(&now, m->scene->friction->V_S));
    m->result->evaluations += 1.0;
    return !(fc_push(m->scene, bound, m->t + JUST_AFTER * fmin(time, m->duration - m->t), side) < 0.0);
}

static void begin_slip(March* m, int side) {
    const FcCoefficients at = fc_scene_coefficients(bound_of_slip(m), m->t);
    move_to(m, side * at.limit / at.sigma, at.sigma);
    m->result->evaluations += 1.0;
    m->result->meetings++;
    m->side = side;
    m->cut = 0.0;
    if (fc_has_static_friction(m->scene->friction)) {
        m->result->slips = side;
    }
}

static void end_slip(March* m) {
    m->left = m->side;
    m->left_at = m->t;
    m->side = 0;
    m->result->slips = 0;
    m->cut = 0.0;
}

typedef struct {
    FcPoints at;
    double D[FC_MOST_POINTS];    // m
    double rate[FC_MOST_POINTS]; // m/s, D'
    double push[FC_MOST_POINTS]; // m/s
} Slip;

static void slip_points(March* m, double h, int rule, int side, Slip* slip) {
    const FcScene* bound = bound_of_slip(m);
    const bool relaxing = relaxes(m->scene);
    const bool still = bound_stands(bound);
    fc_points(bound, m->t, h, rule, &slip->at, &m->result->evaluations);
    for (int i = 0; i < slip->at.count; i++) {
        const double V = slip->at.V[i];
        slip->D[i] = slip->at.limit[i] / slip->at.sigma[i];
        slip->rate[i] = still ? 0.0 : slip->D[i] * fc_scene_log_rates(bound, slip->at.t[i]).ratio;
        const double back = relaxing ? fabs(V) * fc_static_over_limit(m->scene->friction, V) : 0.0;
        slip->push[i] = side * V - back - slip->rate[i];
    }
}

// A distance [m] that affects neither the force nor, over the path, work and heat. With static friction a
// smaller distance may decide whether the bristle breaks away, so only rounding is ignored.
static double unseen(const March* m, double sigma, double D) {
    if (fc_has_static_friction(m->scene->friction)) {
        return FC_ROUNDING_OF_MEETING * D;
    }
    // The tolerance of the bound's own force: the load may rise later in the step.
    const double may = fmin(allowed(m) / sigma, m->options.tolerance * D);
    return FC_SHARE_OF_EVENT * may * fmin(1.0, m->speed * m->duration / D);
}

// The push between two points at which it is above 0, with a second derivative of at most `bend`.
typedef struct {
    FcPushed of;
    double bend; // m/s3
    double seen; // m, that an end of the slip may be off
    double* evaluations;
} Push;

// The time between a and b at which the push falls to 0, found by halving as long as it may; infinite if it
// does not.
static double dip_of_push(const Push* push, double a, double at_a, double b, double at_b) {
    typedef struct {
        double t, push;
        int halvings; // that are left
    } End;
    End ends[MOST_HALVINGS + 1] = {{b, at_b, MOST_HALVINGS}}; // of the parts that are left, the next one last
    FcPushed of = push->of;
    for (int count = 1; count > 0;) {
        End* end = &ends[count - 1];
        const double h = end->t - a;
        const double slope = (end->push - at_a) / h;
        const double x = 0.5 * h - slope / push->bend; // of the least that it may be
        const double least = at_a + x * (slope - 0.5 * push->bend * (h - x));
        if (x > 0.0 && x < h && least <= 0.0 && end->halvings > 0) {
            const double middle = a + 0.5 * h;
            end->halvings--;
            ends[count] = (End){middle, fc_push_at(&of, middle), end->halvings};
            *push->evaluations += 1.0;
            count++;
            continue;
        }
        if (end->push <= 0.0 && count > 1) {
            return fc_root_between(fc_push_at, &of, a, at_a, end->t, end->push, 0.0, push->seen,
                                   push->evaluations);
        }
        a = end->t;
        at_a = end->push;
        count--;
    }
    return INFINITY;
}

// The second difference of the push at point i of a panel.
static double bend_at(const Slip* slip, int i) {
    const double* t = slip->at.t;
    const double* f = slip->push;
    return 2.0 * ((f[i + 1] - f[i]) / (t[i + 1] - t[i]) - (f[i] - f[i - 1]) / (t[i] - t[i - 1])) /
           (t[i + 1] - t[i - 1]);
}

// The time in the panel at which the push falls to 0; infinite if it does not. At the start it is above 0.
static double end_of_push(March* m, int side, const Slip* slip) {
    const double* t = slip->at.t;
    const double* f = slip->push;
    Push push = {.of = {m->scene, bound_of_slip(m), side},
                 .seen = unseen(m, slip->at.sigma[0], slip->D[0]),
                 .evaluations = &m->result->evaluations};
    const int last = slip->at.count - 1;
    for (int i = 0; i < last; i++) {
        push.bend =
            BENDS * fmax(bend_at(slip, i > 0 ? i : 1), bend_at(slip, i + 1 < last ? i + 1 : last - 1));
        const double end =
            push.bend > 0.0 && f[i] > 0.0 ? dip_of_push(&push, t[i], f[i], t[i + 1], f[i + 1]) : INFINITY;
        if (isfinite(end)) {
            return end;
        }
        if (f[i + 1] <= 0.0) {
            return fc_root_between(fc_push_at, &push.of, t[i], f[i], t[i + 1], f[i + 1], 0.0, push.seen,
                                   push.evaluations);
        }
    }
    return INFINITY;
}

// Stores the middle of the longest slip.
static void note_slip(March* m, double duration) {
    if (duration > m->longest) {
        m->longest = duration;
        m->result->slip_time = m->t + 0.5 * duration;
        m->result->slip_side = m->side;
    }
}

static void add_slip(March* m, const Slip* slip) {
    note_slip(m, slip->at.h);
    FcStepResult* result = m->result;
    const FcPoints* at = &slip->at;
    double limit = 0.0;
    double limit_V = 0.0;
    double recedes = 0.0;
    double V_recedes = 0.0;
    for (int i = 1; i <= at->n; i++) {
        const double w = at->rule->weight[i - 1] * at->h;
        limit += w * at->limit[i];
        limit_V += w * at->limit[i] * at->V[i];
        recedes += w * at->limit[i] * slip->rate[i];
        V_recedes += w * at->V[i] * slip->rate[i];
    }
    result->impulse += m->side * limit;
    result->work += m->side * limit_V;
    result->heat += m->side * limit_V - recedes;
    result->drag += m->side * V_recedes;
    result->delta = m->side * slip->D[at->count - 1];
}

static bool is_slip_accurate(const March* m, const Slip* slip) {
    double f[FC_MOST_POINTS];
    double fastest = m->speed;
    double least = slip->D[0];
    double most = slip->D[0];
    for (int i = 0; i < slip->at.count; i++) {
        fastest = fmax(fastest, fabs(slip->rate[i]));
        least = fmin(least, slip->D[i]);
        most = fmax(most, slip->D[i]);
    }
    for (int i = 0; i < slip->at.count; i++) {
        const double part = fastest > 0.0 ? (slip->at.V[i] - m->side * slip->rate[i]) / fastest : 0.0;
        f[i] = slip->at.limit[i] * (1.0 + part);
    }
    // The heat g (V - D') may err by its part of the path of surfaces and bristle alone, since D' may be fast
    // for a short time.
    const double path = m->speed * m->duration + (most - least) + FC_ROUNDING_OF_MEETING * most;
    const double of_path = fastest > 0.0 ? fmin(1.0, path / (fastest * m->duration)) : 1.0;
    return fc_error_at_points(&slip->at, f) * slip->at.h <=
           FC_SHARE_OF_FORMULA * allowed(m) * of_path * m->duration;
}

// The latest end of a slip, or of the motion of a slipping bristle inside its bound. In ElasticPlastic it is
// the time at which V reverses, unless the bound falls there. Otherwise it is `end`.
static double latest_end(March* m, double end) {
    const FcDrive* drive = &m->scene->drive;
    if (relaxes(m->scene)) {
        return end;
    }
    FcDriveEvent event = fc_drive_next_event(drive, m->t, end);
    while (!event.reversal && event.time < end) {
        event = fc_drive_next_event(drive, event.time, end);
    }
    if (!(event.time < end) || bound_stands(&m->bound)) {
        return event.time;
    }
    m->result->evaluations += 1.0;
    return fc_bound_rate(&m->bound, event.time) < 0.0
               ? end
               : event.time; // V is 0, so the kinetic bound is the static one
}

// The next panel of a slip, up to `end` at most.
static Slip next_slip(March* m, double end) {
    Slip panel;
    int rule;
    plan(m);
    find_cut(m, end);
    double h = fc_plan_panel(&m->planner, m->cut - m->t, smooth_time_of_slip(m), &rule);
    for (int tries = 0;; tries++) {
        slip_points(m, h, rule, m->side, &panel);
        if (is_slip_accurate(m, &panel) || !fc_refine_panel(&h, &rule, tries)) {
            return panel;
        }
    }
}

// Slips along the bound for a panel, up to `end` at most, which lies before the bristle leaves the bound.
static void slip_panel(March* m, double end) {
    const Slip panel = next_slip(m, end);
    add_slip(m, &panel);
    m->t = fc_panel_end(m->t, panel.at.h, m->cut);
}

// Slips along the bound whatever the push, for *nudge at the most. A nudge is shorter if the bristle would leave its
// bound in it by a distance that is seen: it leaves with the push, and falls behind in Dahl and LuGre for the time
// D / |V| at the most. The next one is four times as long, since a push of rounding soon becomes another.
static void slip_nudge(March* m, double* nudge) {
    const FcScene* bound = bound_of_slip(m);
    for (;; *nudge *= 0.25) {
        const double end = fmin(m->duration, m->t + *nudge);
        const FcCoefficients at = fc_scene_coefficients(bound, end);
        const double D = at.limit / at.sigma;
        const double time = relaxes(m->scene) ? fmin(*nudge, D / fabs(at.V)) : *nudge;
        m->result->evaluations += 2.0;
        if (-fc_push(m->scene, bound, end, m->side) * time <= unseen(m, at.sigma, D) ||
            *nudge <= FIRST_NUDGE * m->duration) {
            slip_panel(m, end);
            *nudge *= 4.0;
            return;
        }
    }
}

// Slips along the bound to the time `end`, before which the bristle does not leave the bound.
static void slip_to(March* m, double end) {
    const FcScene* bound = bound_of_slip(m);
    const bool stands = bound_stands(bound);
    if (fc_scene_limit_is_constant(bound) &&
        (!fc_has_stribeck_curve(bound->friction) || fc_drive_V_is_constant(&bound->drive)) &&
        (stands || m->scene->friction->sigma_1 == 0.0)) {
        const FcCoefficients at = fc_scene_coefficients(bound, end);
        const double work = m->side * at.limit * fc_drive_displacement(&m->scene->drive, m->t, end);
        note_slip(m, end - m->t);
        m->result->impulse += m->side * at.limit * (end - m->t);
        m->result->work += work;
        m->result->heat += work;
        if (!stands) {
            const double delta = m->side * at.limit / at.sigma;
            m->result->heat -= m->side * at.limit * (delta - m->result->delta);
            m->result->delta = delta;
        }
        m->result->evaluations += 1.0;
        m->t = end;
    }
    m->cut = 0.0;
    while (m->t < end && m->result->evaluations <= FC_MOST_EVALUATIONS) {
        slip_panel(m, end);
    }
}

// The time up to which a bristle of ElasticPlastic without static friction is sure to slip: |V| is larger
// than |D'| may be.
static double sure_end(const March* m, double end) {
    FcDrive slower = m->scene->drive;
    slower.V.value -= m->side * m->fastest_bound;
    const double event = fc_drive_next_event(&slower, m->t, end).time;
    return m->side * fc_drive_V(&slower, 0.5 * (m->t + event)) > 0.0 ? event : m->t;
}

static void stick_until(March* m, const FcScene* bound, double end);

// A bristle that sticks from the march's time on, and the side of the bound to which it goes.
typedef struct {
    const March* march;
    int side;
} Stuck;

static double beyond_bound(void* context, double t) {
    const Stuck* of = context;
    const March* m = of->march;
    const double x = fc_drive_displacement(&m->scene->drive, m->t, t);
    return of->side * (m->result->delta + x) - fc_bound(&m->bound, t);
}

// Slips on, leaves the bound as V turns after `sure`, and sticks until it meets the other bound or V comes near to 0
// again: all without a search, if |V'| exceeds |D''| while |V| may be below |D'|. The push then falls to 0 once, and
// the distance to the other bound does. False, and nothing has happened, if V turns more slowly.
static bool turn_to_other_bound(March* m, double sure, double end) {
    const FcDrive* drive = &m->scene->drive;
    const int side = m->side;
    FcDrive faster = *drive;
    faster.V.value += side * m->fastest_bound;
    const double turned = fc_drive_next_event(&faster, sure, end).time;
    const FcVelocity middle = fc_drive_velocity(drive, 0.5 * (sure + turned));
    const double bend = drive->vibration.V_1 * drive->omega * drive->omega;
    const double rate = -side * middle.rate - 0.5 * (turned - sure) * bend;
    if (!(rate > BEND_OF_BOUND * m->fastest_bound / m->smooth_time)) {
        return false;
    }
    const double until = fc_drive_next_event(&faster, turned, end).time;
    if (!(-side * fc_drive_V(drive, 0.5 * (turned + until)) > m->fastest_bound)) {
        return false;
    }
    FcPushed push = {m->scene, &m->bound, side};
    const double before = fc_push_at(&push, sure);
    const double after = fc_push_at(&push, turned);
    const FcCoefficients at = fc_scene_coefficients(&m->bound, m->t);
    m->result->evaluations += 3.0;
    if (!(before > 0.0 && after < 0.0)) { // by rounding
        return false;
    }
    const double seen = unseen(m, at.sigma, at.limit / at.sigma);
    slip_to(m, fc_root_between(fc_push_at, &push, sure, before, turned, after, 0.0, seen,
                               &m->result->evaluations));
    end_slip(m);
    Stuck stuck = {m, -side};
    const double D = fabs(m->result->delta);
    const FcVelocity now = fc_drive_velocity(drive, m->t);
    double b = fmin(until, m->t + fc_time_to_move(fabs(now.V), fabs(now.rate), SOON * D));
    double beyond = beyond_bound(&stuck, b);
    m->result->evaluations += 1.0;
    if (!(beyond > 0.0) && b < until) {
        b = until;
        beyond = beyond_bound(&stuck, b);
        m->result->evaluations += 1.0;
    }
    const bool meets = beyond > 0.0;
    stick_until(m, &m->bound,
                meets ? fc_root_between(beyond_bound, &stuck, m->t, -2.0 * D, b, beyond, seen, 0.0,
                                        &m->result->evaluations)
                      : until);
    if (meets) {
        begin_slip(m, -side);
    }
    return true;
}

// Slips along the bound for a panel, up to `end` at most, or until the bristle leaves the bound.
static void slip(March* m, double end) {
    plan(m);
    if (!relaxes(m->scene) && !fc_has_static_friction(m->scene->friction)) {
        const double sure = sure_end(m, end);
        if (sure < end && turn_to_other_bound(m, sure, end)) {
            return;
        }
        if (sure > m->t) {
            slip_to(m, sure);
            return;
        }
    }
    if (!slips_on(m, bound_of_slip(m), m->side)) {
        end_slip(m);
        return;
    }
    const double slip_end = latest_end(m, end);
    const Slip panel = next_slip(m, slip_end);
    const double leaves = end_of_push(m, m->side, &panel);
    if (leaves <= m->t + panel.at.h) {
        slip_to(m, leaves);
        end_slip(m);
        return;
    }
    add_slip(m, &panel);
    m->t = fc_panel_end(m->t, panel.at.h, m->cut);
    if (slip_end < end && m->t >= slip_end) {
        end_slip(m);
    }
}

// ---- free, Dahl and LuGre ----

static void relax(March* m) {
    FcScene rest = *m->scene;
    FcScene bound = m->bound;
    if (m->t > 0.0) {
        rest = fc_scene_from(m->scene, m->t);
        bound = fc_scene_from(&m->bound, m->t);
    }
    FcSolverOptions options = m->options;
    options.tolerance *= FC_SHARE_OF_FREE;
    FcWatch watch = {
        .bound = &bound, .reach = m->speed * m->duration, .left = m->t == m->left_at ? m->left : 0};
    const FcMap map = fc_collocation_watched(&rest, &options, m->duration - m->t, m->result->delta, &watch,
                                             &m->result->evaluations);
    fc_map_apply(&map, m->result);
    if (watch.met.side == 0) {
        m->t = m->duration;
        return;
    }
    m->t = fmin(m->duration, m->t + watch.met.t);
    begin_slip(m, watch.met.side);
}

// ---- free, ElasticPlastic ----

// Displacements [m] from the panel's start to its points.
static void displacements(const March* m, const FcPoints* at, double* x) {
    double V[FC_GAUSS_MOST_NODES];
    double of_nodes[FC_GAUSS_MOST_NODES];
    for (int i = 0; i < at->n; i++) {
        V[i] = at->h * at->V[i + 1];
    }
    fc_gauss_integrate(at->rule, at->n, V, of_nodes);
    x[0] = 0.0;
    for (int i = 0; i < at->n; i++) {
        x[i + 1] = of_nodes[i];
    }
    x[at->count - 1] = fc_drive_displacement(&m->scene->drive, m->t, m->t + at->h);
}

// The map of a bristle that sticks over the panel.
static FcMap stuck_map(const March* m, const FcPoints* at, const double* x) {
    FcMap map = {.offset = x[at->count - 1]};
    for (int i = 1; i <= at->n; i++) {
        const double slope = at->rule->weight[i - 1] * at->h * at->sigma[i];
        map.impulse_slope += slope;
        map.impulse_offset += slope * x[i];
        map.work_slope += slope * at->V[i];
        map.work_offset += slope * x[i] * at->V[i];
    }
    if (m->scene->friction->sigma_1 != 0.0) {
        map.drag_offset = fc_drive_square(&m->scene->drive, m->t, m->t + at->h);
    }
    return map;
}

static bool is_stick_accurate(const March* m, const FcPoints* at, const double* x, double delta) {
    double f[FC_MOST_POINTS];
    for (int i = 0; i < at->count; i++) {
        const double part = m->speed > 0.0 ? at->V[i] / m->speed : 0.0;
        f[i] = at->sigma[i] * (delta + x[i]) * (1.0 + part);
    }
    return fc_error_at_points(at, f) * at->h <= FC_SHARE_OF_FORMULA * allowed(m) * m->duration;
}

static FcCourse course_of(const March* m, const FcScene* bound, const FcPoints* at, const double* x) {
    FcCourse course = {.scene = m->scene,
                       .bound = bound,
                       .count = at->count,
                       .from = m->t,
                       .exact = true,
                       .still = bound_stands(bound),
                       .left = m->t == m->left_at ? m->left : 0};
    for (int i = 0; i < at->count; i++) {
        course.t[i] = at->t[i];
        course.V[i] = at->V[i];
        course.delta[i] = m->result->delta + x[i];
        course.D[i] = at->limit[i] / at->sigma[i];
    }
    return course;
}

// The map up to the time `end`, before which the bristle meets no bound, for starts of the size of delta [m].
static FcMap map_until(March* m, const FcScene* bound, double delta, double end) {
    FcMap map = fc_map_identity();
    plan(m);
    while (m->t < end && m->result->evaluations <= FC_MOST_EVALUATIONS) {
        FcPoints at;
        double x[FC_MOST_POINTS];
        int rule;
        double h = fc_plan_panel(&m->planner, end - m->t, m->smooth_time, &rule);
        for (int tries = 0;; tries++) {
            fc_points(bound, m->t, h, rule, &at, &m->result->evaluations);
            displacements(m, &at, x);
            if (is_stick_accurate(m, &at, x, delta + map.offset) || !fc_refine_panel(&h, &rule, tries)) {
                break;
            }
        }
        const FcMap part = stuck_map(m, &at, x);
        fc_map_append(&map, &part);
        m->t = fc_panel_end(m->t, h, end);
    }
    return map;
}

static void stick_until(March* m, const FcScene* bound, double end) {
    const FcMap map = map_until(m, bound, m->result->delta, end);
    fc_map_apply(&map, m->result);
}

// Sticks for a panel, up to `end` at most, or until it meets its bound. A slipping bristle inside its bound
// moves with V while it comes nearer to its bound.
static void stick(March* m, double end) {
    plan(m);
    const int slips = m->result->slips;
    const FcScene* bound = slips != 0 ? m->scene : &m->bound;
    double slip_end = end;
    if (slips != 0) {
        if (!slips_on(m, m->scene, slips)) {
            end_slip(m);
            return;
        }
        slip_end = latest_end(m, end);
        find_cut(m, slip_end);
    } else {
        m->cut = end;
    }
    const double smooth_time = slips != 0 ? smooth_time_of_slip(m) : m->smooth_time;
    // A stiff bristle is soon at its bound: no panel that is far longer.
    const FcVelocity now = fc_drive_velocity(&m->scene->drive, m->t);
    const double soon = fc_time_to_move(fabs(now.V), fabs(now.rate), SOON * fc_bound(bound, m->t));
    const double left = soon > 0.0 ? fmin(m->cut - m->t, soon) : m->cut - m->t;
    int rule;
    double h = fc_plan_panel(&m->planner, left, smooth_time, &rule);
    FcPoints at;
    double x[FC_MOST_POINTS];
    fc_points(bound, m->t, h, rule, &at, &m->result->evaluations);
    displacements(m, &at, x);
    const FcCourse course = course_of(m, bound, &at, x);
    FcMeeting met = fc_first_meeting(&course, FC_ROUNDING_OF_MEETING * course.D[0],
                                     unseen(m, at.sigma[0], course.D[0]), &m->result->evaluations);
    double until = met.side != 0 ? met.t : fc_panel_end(m->t, h, m->cut);
    bool sticks = false; // at that time
    if (slips != 0) {
        Slip panel;
        slip_points(m, h, rule, slips, &panel);
        const double end_of_slip = end_of_push(m, slips, &panel);
        sticks = end_of_slip <= m->t + h && !(met.side != 0 && met.t <= end_of_slip);
        until = sticks ? end_of_slip : until;
    }
    if (met.side == 0 && !sticks && is_stick_accurate(m, &at, x, m->result->delta)) {
        const FcMap map = stuck_map(m, &at, x);
        fc_map_apply(&map, m->result);
        m->t = until;
    } else {
        stick_until(m, bound, until);
    }
    if (sticks || (met.side == 0 && slip_end < end && m->t >= slip_end)) {
        end_slip(m);
    } else if (met.side != 0) {
        begin_slip(m, met.side);
    } else if (slips * m->result->delta < 0.0) { // it moves to its other bound
        m->result->slips = -slips;
    }
}

// ---- ElasticPlastic with a bound that stands still ----

// The map over [t, end] with a constant stiffness and that displacement, in closed forms.
static FcMap still_map(const FcScene* scene, double sigma, double t, double end, double displacement) {
    const FcDrive* drive = &scene->drive;
    const double x = displacement;
    return (FcMap){
        .offset = x,
        .impulse_slope = sigma * (end - t),
        .impulse_offset = sigma * fc_drive_displacement_integral(drive, t, end),
        .work_slope = sigma * x,
        .work_offset = 0.5 * sigma * x * x,
        .drag_offset = scene->friction->sigma_1 != 0.0 ? fc_drive_square(drive, t, end) : 0.0,
    };
}

// Sticks to the time `end`, before which it meets no bound.
static void stick_to(March* m, double end) {
    if (fc_scene_stiffness_is_constant(m->scene)) {
        const double x = fc_drive_displacement(&m->scene->drive, m->t, end);
        const FcMap map = still_map(m->scene, fc_scene_stiffness(m->scene, m->t), m->t, end, x);
        fc_map_apply(&map, m->result);
        m->t = end;
    }
    stick_until(m, &m->bound, end);
}

typedef struct {
    const FcDrive* drive;
    double from; // s
    double way;  // m, to the bound
    int side;
} WayToBound;

static FcRootFunction way_to_bound(void* context, double t) {
    const WayToBound* of = context;
    const FcVelocity at = fc_drive_velocity(of->drive, t);
    return (FcRootFunction){.value = of->side * fc_drive_displacement(of->drive, of->from, t) - of->way,
                            .rate = of->side * at.V,
                            .curvature = of->side * at.rate};
}

// The largest last step to a meeting, over its bracket: the error is of the order of its cube, 1e-15. Ten
// times of it would leave 1e-12.
static const double LAST_STEP = 1e-5;

// Between two reversals of V the deflection is monotone. So the bristle meets its bound D if it would be
// beyond D at the second reversal. A slip ends at the next reversal. With a Stribeck curve and a varying V
// the kinetic bound varies.
static void march_between_reversals(March* m, double D) {
    const FcScene* scene = m->scene;
    const FcDrive* drive = &scene->drive;
    const bool has_peak = fc_has_stribeck_curve(scene->friction) && !fc_drive_V_is_constant(drive);
    double sticks_to = m->t; // known to meet nothing up to there
    double delta = m->result->delta;
    while (m->t < m->duration && m->result->evaluations <= FC_MOST_EVALUATIONS) {
        if (m->result->slips != 0 && (m->side == 0 || has_peak)) {
            m->side != 0 ? slip(m, m->duration) : stick(m, m->duration);
            sticks_to = m->t;
            delta = m->result->delta;
            continue;
        }
        const double end = fc_drive_next_event(drive, sticks_to, m->duration).time;
        const double V = fc_drive_V(drive, 0.5 * (sticks_to + end));
        const int side = V < 0.0 ? -1 : 1;
        if (m->side != 0) {
            if (m->side * V > 0.0) {
                slip_to(m, end);
            } else {
                end_slip(m);
            }
            sticks_to = m->t;
            delta = m->result->delta;
            continue;
        }
        const double x = fc_drive_displacement(drive, sticks_to, end);
        m->result->evaluations += 1.0;
        const double way = fmax(0.0, D - side * delta); // below 0 by rounding
        bool goes_on = !(side * x > way);
        if (!goes_on && end < m->duration && way <= FC_ROUNDING_OF_MEETING * D &&
            side * x <= ROUNDING_AT_REVERSAL * D && fc_has_static_friction(scene->friction)) {
            // It sticks at the static bound if V reverses before the bristle could slip. The remaining
            // distance is rounding.
            goes_on = !(fc_push(scene, scene, sticks_to, side) > 0.0);
        }
        if (goes_on) {
            sticks_to = end;
            delta += x;
            if (end >= m->duration) {
                stick_to(m, end);
            }
            continue;
        }
        double meets = sticks_to;
        if (way > 0.0) {
            WayToBound of = {drive, sticks_to, way, side};
            meets = fc_root(way_to_bound, &of, sticks_to, way_to_bound(&of, sticks_to), end,
                            way_to_bound(&of, end), LAST_STEP, INFINITY, &m->result->evaluations);
        }
        stick_to(m, meets);
        begin_slip(m, side);
        sticks_to = m->t;
        delta = m->result->delta;
    }
}

// ---- the march ----

// Whether a stuck bristle with the bound D at the start cannot reach it in the step.
static bool is_far_from_bound(const March* m, double D) {
    const double farthest = fabs(m->result->delta) + m->speed * m->duration;
    return farthest < D && farthest < fc_scene_smallest_saturation(&m->bound, m->duration);
}

void fc_march_step(const FcScene* scene, const FcSolverOptions* options, double duration,
                   FcStepResult* result) {
    assert(duration >= 0.0 && fc_is_bounded(scene->friction));
    March m;
    begin(&m, scene, options, duration, result);
    result->on_bound = false;
    const bool has_memory = fc_has_static_friction(scene->friction);
    const double D = fc_bound(has_memory && result->slips != 0 ? scene : &m.bound, 0.0);
    result->evaluations += 1.0;
    const bool on_bound = fabs(result->delta) >= D * (1.0 - FC_ROUNDING_OF_MEETING);
    if (on_bound && (!has_memory || result->slips == (result->delta < 0.0 ? -1 : 1))) {
        m.side = result->delta < 0.0 ? -1 : 1; // it leaves at once if it is not pushed
        result->meetings++;
    }
    if (!relaxes(scene) && result->slips == 0 && is_far_from_bound(&m, D)) {
        stick_to(&m, duration);
        return;
    }
    if (!relaxes(scene) && bound_stands(&m.bound)) {
        march_between_reversals(&m, fc_bound(&m.bound, 0.0));
        return;
    }
    double before = -1.0;
    double last = duration; // of the regime before
    double nudge = FIRST_NUDGE * duration;
    for (int idle = 0; m.t < duration && result->evaluations <= FC_MOST_EVALUATIONS;) {
        const double shorter = fmin(m.t - before, last);
        idle = shorter > fmax(FIRST_NUDGE * duration, IDLE_BESIDE_NUDGE * nudge) ? 0 : idle + 1;
        last = m.t - before;
        before = m.t;
        if (m.side != 0) {
            if (idle > MOST_IDLE) {
                slip_nudge(&m, &nudge);
                before = m.t;
                idle = MOST_IDLE - 2; // one more try of either regime
            } else {
                slip(&m, duration);
            }
        } else if (relaxes(scene)) {
            relax(&m);
        } else {
            stick(&m, duration);
        }
    }
    result->on_bound = m.side != 0;
}

FcMap fc_march_stuck(const FcScene* scene, const FcSolverOptions* options, double duration,
                     double* evaluations) {
    FcStepResult unused = {0};
    March m;
    begin(&m, scene, options, duration, &unused);
    const double sigma = fc_scene_stiffness(scene, 0.0);
    const double D = fc_bound(&m.bound, 0.0);
    const FcDrive* drive = &scene->drive;
    unused.evaluations = 1.0;
    FcMap map = fc_scene_stiffness_is_constant(scene)
                    ? still_map(scene, sigma, 0.0, duration, fc_drive_displacement(drive, 0.0, duration))
                    : map_until(&m, &m.bound, D, duration);
    *evaluations += unused.evaluations;
    return map;
}

// Whether the bound may fall in the step.
static bool may_fall(const FcScene* bound) {
    const FcDrive* drive = &bound->drive;
    if (bound_stands(bound)) {
        return false;
    }
    if (drive->vibration.a_d != 0.0 || drive->E.rate != 0.0) {
        return true;
    }
    const double apart = bound->floats ? -drive->load.rate : drive->d.rate; // the way that d goes
    const bool rises_with_d = bound->at_E.model != FC_CONTACT_CONSTANT;     // D = g / sigma
    return rises_with_d ? apart < 0.0 : apart > 0.0;
}

bool fc_march_may_touch(const FcScene* scene) {
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(scene, 0, &friction);
    return !relaxes(scene) || may_fall(&bound);
}
