#include "plane_reference.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "moment.h"

typedef struct {
    Real x, y;
} Vector;

static Vector plus(Vector a, Real factor, Vector b) {
    return (Vector){a.x + factor * b.x, a.y + factor * b.y};
}
static Vector times(Real factor, Vector a) { return (Vector){factor * a.x, factor * a.y}; }
static Real dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y; }
static Real length_of(Vector a) { return sqrtl(dot(a, a)); }

// The vector of that length along another, or 0.
static Vector along(Vector a, Real length) {
    const Real now = length_of(a);
    return now > 0.0L ? times(length / now, a) : a;
}

static Vector velocity_at(const At* at) { return (Vector){at->V, at->V_y}; }

static Vector way(const World* w, Real a, Real b) {
    return (Vector){travel(w, &w->along, a, b), travel(w, &w->transverse, a, b)};
}

// ---------------------------------------------------------------------------------------------------------------------
// Panels
// ---------------------------------------------------------------------------------------------------------------------

// STICKS: the bristle follows its law inside a bound, if there is one. CATCHES: it has broken away, and its kinetic bound has
// risen since. SLIPS: along its bound.
typedef enum { STICKS, CATCHES, SLIPS } Motion;

typedef struct {
    Vector end, change;      // m, delta at the end, and its change
    Vector impulse;          // N s
    Real work, heat, path;   // J, J, m
    Real length;             // m, what errors of the end are measured by
    Real force, power;       // N s, J, what errors of impulse and energies are measured by
    Real blur;               // m, of the end by the rounding of time
    Real miss_force, miss_W; // N s, J, by which panels and their halves differ
} Sums;

static void add_times(Sums* sums, const Sums* one, Real factor) {
    sums->impulse = plus(sums->impulse, factor, one->impulse);
    sums->work += factor * one->work;
    sums->heat += factor * one->heat;
    sums->path += factor * one->path;
    sums->miss_force += factor * one->miss_force;
    sums->miss_W += factor * one->miss_W;
}

static void add(Sums* sums, const Sums* part) {
    add_times(sums, part, 1.0L);
    sums->end = part->end;
    sums->change = plus(sums->change, 1.0L, part->change);
    sums->length = part->length;
    sums->blur = part->blur;
    sums->force += part->force;
    sums->power += part->power;
}

// Of a time [s] with that force of the bristle, rate of its deflection and velocity.
static void account(const World* w, Sums* sums, Vector spring, Vector rate, Vector V, Real time) {
    const Vector rest = plus(times(w->scene.sigma_2, V), w->scene.sigma_1, rate);
    const Real strong = length_of(spring) + length_of(rest) + w->S;
    sums->impulse = plus(sums->impulse, time, plus(spring, w->scene.sigma_2, V));
    sums->work += time * (dot(spring, V) + dot(rest, V));
    sums->heat += time * (dot(spring, plus(V, -1.0L, rate)) + dot(rest, V));
    sums->path += time * length_of(V);
    sums->force += time * (length_of(spring) + w->scene.sigma_2 * length_of(V) + w->S);
    sums->power += time * strong * (length_of(V) + (length_of(spring) == 0.0L ? 0.0L : length_of(rate)));
}

// -d(delta') / d(delta) [1/s].
static Real relaxation(const World* w, const At* at) {
    return w->elastic ? 0.0L : at->sigma * length_of(velocity_at(at)) / at->g;
}

// How fast [m/s] the law alone would carry a bristle of that direction, on its kinetic bound, beyond it.
static Real outward(const World* w, const At* at, Vector delta) {
    const Real own = dot(along(delta, 1.0L), velocity_at(at)) - relaxation(w, at) * bound(w, at, false);
    return own - bound_rate(w, at, false);
}

// What must stay above 0 for the motion to go on; both are large where nothing can end it.
typedef struct {
    Real room; // m, to the bound
    Real lead; // m/s, outward
} Signs;

static const Real ROUNDING = 1e-17L; // of what a sign is made from

// With a little more than the rounding of each.
static Signs signs_at(const World* w, const At* at, Motion motion, bool broke, Vector delta) {
    Signs signs = {INFINITY, INFINITY};
    if (!w->bounded || w->open) {
        return signs;
    }
    if (motion != SLIPS) {
        const Real lies = bound(w, at, !broke);
        signs.room = lies * (1.0L + ROUNDING) - length_of(delta);
    }
    if (motion != STICKS) {
        signs.lead = outward(w, at, delta) + ROUNDING * (w->top + fabsl(bound_rate(w, at, false)));
    }
    return signs;
}

typedef struct {
    Sums sums;
    Signs sign[MOST_STAGES + 1]; // at the start and at the nodes
} Panel;

// The state of a march through the step.
typedef struct {
    World* w;
    Sums sums;
    Vector delta;
    Motion motion;
    bool broke;    // with static friction: it slips, or catches up
    bool slipped;  // at any time
    bool met;      // the motion has come to its end,
    Real met_at;   // then,
    bool at_bound; // at its bound, not by its lead
} March;

// The deflections at the nodes by Dahl's and LuGre's law: delta + Y, Y_i = size sum_j to_ij (V_j - r_j delta - r_j Y_j).
static void collocate(const World* w, const At* at, Real size, Vector delta, Vector* change) {
    const int n = w->rule->stages;
    Real A[MOST_STAGES][MOST_STAGES], Y[2][MOST_STAGES] = {{0}};
    Vector rate[MOST_STAGES];
    for (int j = 0; j < n; j++) {
        const Real r = relaxation(w, &at[j]);
        rate[j] = plus(velocity_at(&at[j]), -r, delta);
        for (int i = 0; i < n; i++) {
            A[i][j] = (i == j ? 1.0L : 0.0L) + size * w->rule->to[i][j] * r;
        }
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            Y[0][i] += size * w->rule->to[i][j] * rate[j].x;
            Y[1][i] += size * w->rule->to[i][j] * rate[j].y;
        }
    }
    solve(n, A, 2, Y);
    for (int i = 0; i < n; i++) {
        change[i] = (Vector){Y[0][i], Y[1][i]};
    }
}

// How fast [rad/s] the deflection turns that slips at an angle, and the derivative by the angle.
static Real turn(const World* w, const At* at, Real angle, Real* slope) {
    const Real lies = bound(w, at, false), x = sine(angle, 1), y = sine(angle, 0);
    *slope = -(at->V * x + at->V_y * y) / lies;
    return (at->V_y * x - at->V * y) / lies;
}

// The angles at the nodes of a bristle that slips from an angle on, by Newton; false where it finds none.
static bool turn_over(const World* w, const At* at, Real size, Real angle, Real* at_angle) {
    const int n = w->rule->stages;
    Real Y[1][MOST_STAGES] = {{0}};
    for (int k = 0; k < 25; k++) {
        Real A[MOST_STAGES][MOST_STAGES], step[1][MOST_STAGES], most = 0.0L;
        for (int i = 0; i < n; i++) {
            step[0][i] = -Y[0][i];
        }
        for (int j = 0; j < n; j++) {
            Real slope;
            const Real rate = turn(w, &at[j], angle + Y[0][j], &slope);
            if (!(size * slope < 1.0L)) { // it turns away from where it is: a long panel would not see that
                return false;
            }
            for (int i = 0; i < n; i++) {
                const Real weight = size * w->rule->to[i][j];
                A[i][j] = (i == j ? 1.0L : 0.0L) - weight * slope;
                step[0][i] += weight * rate;
            }
        }
        solve(n, A, 1, step);
        for (int i = 0; i < n; i++) {
            Y[0][i] += step[0][i];
            most = fmaxl(most, fabsl(step[0][i]));
        }
        if (!(most < 3.0L)) {
            return false;
        }
        if (most < 1e-9L && k > 0) { // the next would be 1e-18
            for (int i = 0; i < n; i++) {
                at_angle[i] = angle + Y[0][i];
            }
            return true;
        }
    }
    return false;
}

static Panel panel(const March* march, Real a, Real b, Vector delta) {
    World* w = march->w;
    const Rule* rule = w->rule;
    const int n = rule->stages, last = n - 1;
    const Real size = b - a;
    const bool bristle = !w->open && w->scene.law != LAW_COULOMB, slips = march->motion == SLIPS;
    const bool rates = slips || march->motion == CATCHES;
    Panel p = {.sums = {.end = delta}};
    At at[MOST_STAGES];
    Vector change[MOST_STAGES] = {{0}}, rate[MOST_STAGES] = {{0}};
    Real angle[MOST_STAGES];
    for (int i = 0; i < n; i++) {
        at[i] = scene_at(w, a + size * rule->node[i], rates);
    }
    if (slips && !turn_over(w, at, size, atan2l(delta.y, delta.x), angle)) {
        p.sums.end.x = NAN; // agrees with nothing
        return p;
    }
    if (bristle && !slips && !w->elastic) {
        collocate(w, at, size, delta, change);
    }
    Real relaxed = 0.0L, longest = length_of(delta), fastest = 0.0L;
    for (int i = 0; i < n; i++) {
        const Vector V = velocity_at(&at[i]);
        if (slips) {
            Real unused;
            const Vector n_at = {sine(angle[i], 1), sine(angle[i], 0)}, t_at = {-n_at.y, n_at.x};
            const Real lies = bound(w, &at[i], false);
            change[i] = plus(times(lies, n_at), -1.0L, delta);
            rate[i] = plus(times(bound_rate(w, &at[i], false), n_at),
                           lies * turn(w, &at[i], angle[i], &unused), t_at);
        } else if (bristle && w->elastic) {
            change[i] = way(w, a, a + size * rule->node[i]);
            rate[i] = V;
        } else if (bristle) {
            const Real r = relaxation(w, &at[i]);
            rate[i] = plus(V, -r, plus(delta, 1.0L, change[i]));
            relaxed += size * rule->weight[i] * r;
        }
        const Vector now = plus(delta, 1.0L, change[i]);
        const Vector spring = bristle                       ? times(at[i].sigma, now)
                              : w->scene.law == LAW_COULOMB ? along(V, at[i].coulomb)
                                                            : (Vector){0};
        account(w, &p.sums, spring, rate[i], V, size * rule->weight[i]);
        longest = fmaxl(longest, length_of(now));
        fastest = fmaxl(fastest, length_of(rate[i]));
        p.sign[i + 1] = signs_at(w, &at[i], march->motion, march->broke, now);
    }
    if (bristle) {
        p.sums.change = change[last];
        p.sums.end = plus(delta, 1.0L, change[last]);
        p.sums.blur = fastest * expl(-relaxed) * 2.0L * LDBL_EPSILON * b;
        p.sums.length = fmaxl(longest * expl(-relaxed), at[last].g / at[last].sigma);
    }
    p.sums.impulse = plus(p.sums.impulse, w->scene.sigma_1, p.sums.change);
    p.sums.force += w->scene.sigma_1 * length_of(p.sums.change);
    const At start = scene_at(w, a, rates);
    p.sign[0] = signs_at(w, &start, march->motion, march->broke, delta);
    w->panels += 1.0L;
    return p;
}

static const Real AGREE = 1e-13L; // the halves are then right to some 1e-17
static const Real LEAST = 1e-16L; // of the force of the step: what errors of a panel are left alone
static const int DEEPEST = 110;
static const Real MOST_PANELS = 1e6L; // more are not taken, and the step is not known

// Whether a panel of this size [s] and its halves give the same.
static bool agree(const World* w, const Sums* one, const Sums* two, Real size) {
    const Real share = w->fineness == 1 ? 1.0L : 0.01L, same = share * AGREE;
    const Real force = share * LEAST * two->force / size;
    const Real impulse = same * two->force + force * w->h;
    const Real energy = same * two->power + force * (w->top * w->h + two->length);
    return length_of(plus(one->end, -1.0L, two->end)) <= same * two->length + two->blur &&
           length_of(plus(one->impulse, -1.0L, two->impulse)) <= impulse &&
           fabsl(one->work - two->work) <= energy && fabsl(one->heat - two->heat) <= energy;
}

// Whether a sign that is positive at three nodes may be negative between them: by the parabola through them.
static bool dips(const Real* x, Real y_0, Real y_1, Real y_2, Real rounding) {
    const Real left = (y_1 - y_0) / (x[1] - x[0]), right = (y_2 - y_1) / (x[2] - x[1]);
    const Real curve = (right - left) / (x[2] - x[0]), least = fminl(y_0, fminl(y_1, y_2));
    const Real lowest = 0.5L * (x[0] + x[1] - left / curve);
    const Real low = y_0 + (lowest - x[0]) * (left + curve * (lowest - x[1]));
    return curve > 0.0L && lowest > x[0] && lowest < x[2] && low < 0.5L * least && least - low > rounding;
}

static bool is_over(const Signs* sign) { return sign->room < 0.0L || sign->lead < 0.0L; }

// Whether a motion may end unseen in a panel; where it has just begun a sign is 0 and rises.
static bool hides(const World* w, const Panel* p) {
    const int n = w->rule->stages;
    Real x[MOST_STAGES + 1] = {0.0L};
    for (int k = 0; k < n; k++) {
        x[k + 1] = w->rule->node[k];
    }
    const Real of_room = 1e-15L * p->sums.length, of_lead = 1e-15L * w->top;
    for (int k = 0; k + 2 <= n && !is_over(&p->sign[k + 2]); k++) {
        const Signs* s = &p->sign[k];
        if ((s->room < INFINITY && s->room > of_room &&
             dips(&x[k], s[0].room, s[1].room, s[2].room, of_room)) ||
            (s->lead < INFINITY && s->lead > of_lead &&
             dips(&x[k], s[0].lead, s[1].lead, s[2].lead, of_lead))) {
            return true;
        }
    }
    return false;
}

static bool is_smallest(const World* w, Real a, Real b, int depth) {
    const Real middle = 0.5L * (a + b);
    return depth >= DEEPEST || w->panels > MOST_PANELS || !(middle > a && middle < b);
}

// A motion on its way to its end.
typedef struct {
    const March* march;
    Real from;
    bool at_bound;
} Way;

static Real beyond(const void* context, Real t) {
    const Way* to = context;
    const Panel p = panel(to->march, to->from, t, to->march->delta);
    const Signs* last = &p.sign[to->march->w->rule->stages];
    return -(to->at_bound ? last->room : last->lead);
}

// Over a part that is accurate, up to the motion's end if that is in it.
static void commit(March* march, Real a, Real b, const Panel* p) {
    const int n = march->w->rule->stages;
    int k = 0;
    while (k <= n && !is_over(&p->sign[k])) {
        k++;
    }
    Panel part = *p;
    if (k <= n) {
        march->met = true;
        march->at_bound = p->sign[k].room < 0.0L;
        const Way to = {march, a, march->at_bound};
        const Real low = k <= 1 ? a : a + (b - a) * march->w->rule->node[k - 2];
        march->met_at = k == 0 ? a : crossing(beyond, &to, low, a + (b - a) * march->w->rule->node[k - 1]);
        if (!(march->met_at > a)) {
            return;
        }
        part = panel(march, a, march->met_at, march->delta);
    }
    add(&march->sums, &part.sums);
    march->delta = part.sums.end;
}

// Over [a, b], of which one is a single panel, by halves until they agree with the whole; to the motion's end.
static void go_on(March* march, Real a, Real b, const Panel* one, int depth) {
    World* w = march->w;
    const Real middle = 0.5L * (a + b);
    const Panel left = panel(march, a, middle, march->delta);
    const Panel right = panel(march, middle, b, left.sums.end);
    Sums two = left.sums;
    add(&two, &right.sums);
    const bool good = agree(w, &one->sums, &two, b - a) && !hides(w, &left) && !hides(w, &right);
    if (!good && !is_smallest(w, a, b, depth)) {
        go_on(march, a, middle, &left, depth + 1);
        if (!march->met) {
            const Panel again = panel(march, middle, b, march->delta);
            go_on(march, middle, b, &again, depth + 1);
        }
        return;
    }
    march->sums.miss_force += length_of(plus(one->sums.impulse, -1.0L, two.impulse));
    march->sums.miss_W += fmaxl(fabsl(one->sums.work - two.work), fabsl(one->sums.heat - two.heat));
    commit(march, a, middle, &left);
    if (!march->met) {
        commit(march, middle, b, &right);
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Cuts of the step
// ---------------------------------------------------------------------------------------------------------------------

typedef struct {
    const World* w;
    Real level; // m2/s2
    int order;
} Zero;

static Real square_less(const void* context, Real t) {
    const Zero* zero = context;
    const Real V = velocity(zero->w, &zero->w->along, t), V_y = velocity(zero->w, &zero->w->transverse, t);
    return V * V + V_y * V_y - zero->level;
}

// The derivative of half of V^2 of one component, of order 1, 2 or 3.
static Real change_of_square(const World* w, const Drive* drive, Real t, int order) {
    const Real V = velocity(w, drive, t), V_1 = velocity_rate(w, drive, t);
    const Real swing = drive->swing * w->omega * w->omega, theta = drive->theta + w->omega * t;
    const Real V_2 = -swing * sine(theta, 1);
    return order == 1   ? V * V_1
           : order == 2 ? V_1 * V_1 + V * V_2
                        : 3.0L * V_1 * V_2 + V * w->omega * swing * sine(theta, 0);
}

static Real change_of_speed(const void* context, Real t) {
    const Zero* zero = context;
    return change_of_square(zero->w, &zero->w->along, t, zero->order) +
           change_of_square(zero->w, &zero->w->transverse, t, zero->order);
}

static void cut_where(Cuts* cuts, Function* function, const Zero* zero) {
    const size_t count = cuts->count;
    for (size_t k = 0; k + 1 < count; k++) {
        const Real a = cuts->time[k], b = cuts->time[k + 1];
        if (function(zero, a) * function(zero, b) < 0.0L) {
            cut(cuts, crossing(function, zero, a, b));
        }
    }
}

// Equal pieces of a period; where a load may fall or rise by decades; the extremes of |V|, and multiples of V_S.
static Cuts all_cuts(const World* w, Closed part) {
    Cuts cuts = {0};
    const ReferenceScene* s = &w->scene;
    const Real span = part.to - part.from, pieces = 32.0L;
    const Real first = w->theta_0 / w->omega; // s, since the start of the period
    cut(&cuts, part.from);
    cut(&cuts, part.to);
    for (Real k = ceill(first * s->f * pieces); vibrates(s) && k < (first + w->h) * s->f * pieces;
         k += 1.0L) {
        cut(&cuts, k / (pieces * s->f) - first);
    }
    for (int k = 1; k <= 60 && !w->open && (s->load_rate != 0.0 || s->E_rate != 0.0 || s->d_rate != 0.0);
         k += 2) {
        cut(&cuts, part.from + ldexpl(span, -k));
        cut(&cuts, part.to - ldexpl(span, -k));
    }
    tidy(&cuts, part);
    for (int order = 3; order >= 1; order--) { // between the zeros of one there is but one of the next
        const Zero zero = {.w = w, .order = order};
        cut_where(&cuts, change_of_speed, &zero);
        tidy(&cuts, part);
    }
    for (size_t m = 0; w->excess != 0.0L && m < LEVELS; m++) {
        const Real level = MULTIPLES[m] * s->V_S;
        const Zero zero = {.w = w, .level = level * level};
        cut_where(&cuts, square_less, &zero);
        tidy(&cuts, part);
    }
    return cuts;
}

// ---------------------------------------------------------------------------------------------------------------------
// The march through the step
// ---------------------------------------------------------------------------------------------------------------------

// Break-away: it drops along its direction, and the damping feels it.
static void break_away(March* march, Real t) {
    const World* w = march->w;
    const At at = scene_at(w, t, false);
    const Vector from = march->delta, to = along(from, bound(w, &at, false));
    const Vector damping = times(w->scene.sigma_1, plus(to, -1.0L, from));
    const Real lost = dot(plus(from, -1.0L, to), plus(from, 1.0L, to));
    march->sums.impulse = plus(march->sums.impulse, 1.0L, damping);
    march->sums.work += dot(damping, velocity_at(&at));
    march->sums.heat += dot(damping, velocity_at(&at)) + 0.5L * at.sigma * lost;
    march->delta = to;
    march->broke = true;
}

// The motion has come to its end: what follows.
static void change_motion(March* march) {
    const World* w = march->w;
    const Real t = march->met_at;
    const At at = scene_at(w, t, true);
    if (!march->at_bound) {
        march->motion = STICKS;
        march->broke = false;
        return;
    }
    if (w->elastic && w->excess != 0.0L && !march->broke) {
        break_away(march, t);
    } else {
        march->delta = along(march->delta, bound(w, &at, false));
    }
    const bool slips = outward(w, &at, march->delta) > 0.0L;
    march->motion = slips ? SLIPS : STICKS;
    march->broke = march->broke && slips;
    march->slipped = true;
}

static bool pushes(const World* w, Real t, Vector delta) {
    const At at = scene_at(w, t, true);
    return outward(w, &at, delta) > 0.0L;
}

static void march_part(March* march, Closed part, bool open) {
    World* w = march->w;
    if (!(part.to > part.from)) {
        return;
    }
    w->open = open;
    Cuts cuts = all_cuts(w, part);
    for (size_t k = 0; k + 1 < cuts.count; k++) {
        Real a = cuts.time[k];
        for (const Real b = cuts.time[k + 1]; a < b && w->panels <= MOST_PANELS;) {
            if (march->broke && !pushes(w, a, march->delta) && !pushes(w, 0.5L * (a + b), march->delta)) {
                march->motion = STICKS; // nothing moves, or it turns back
                march->broke = false;
            }
            const Panel one = panel(march, a, b, march->delta);
            march->met = false;
            go_on(march, a, b, &one, 0);
            a = march->met ? march->met_at : b;
            if (march->met) {
                change_motion(march);
            }
        }
    }
    free(cuts.time);
}

static void march_over(March* march) {
    World* w = march->w;
    const Closed part = closed_part(w);
    const Real edge = ldexpl(part.to - part.from, -58); // what has no load has no rate
    march_part(march, (Closed){0.0L, part.from}, true);
    march_part(
        march,
        (Closed){part.from + (part.from > 0.0L ? edge : 0.0L), part.to - (part.to < w->h ? edge : 0.0L)},
        false);
    if (part.to < w->h) {
        const bool slides = w->scene.contact == CONTACT_CONSTANT && w->scene.law != LAW_COULOMB;
        march->sums.heat += slides ? 0.5L * w->scene.contact_sigma * dot(march->delta, march->delta) : 0.0L;
        march->delta = (Vector){0};
        march->motion = STICKS;
        march->broke = false;
    }
    march_part(march, (Closed){part.to, w->h}, true);
    w->open = false;
}

// What a march hands on.
typedef struct {
    Vector delta;
    bool broke;
} State;

static March march_from(World* w, State state) {
    March march = {
        .w = w, .delta = state.delta, .broke = state.broke, .motion = state.broke ? CATCHES : STICKS};
    march_over(&march);
    return march;
}

static State state_of(const March* march) { return (State){march->delta, march->broke}; }

// ---------------------------------------------------------------------------------------------------------------------
// Equal periods
// ---------------------------------------------------------------------------------------------------------------------

static bool are_equal(State a, State b, Real unit) {
    return a.broke == b.broke &&
           length_of(plus(a.delta, -1.0L, b.delta)) <= 3e-17L * (unit + length_of(b.delta));
}

// A length [m] of deflections.
static Real unit_of(World* w) {
    if (w->scene.law == LAW_COULOMB || is_open(w, 0.0L)) {
        return 1.0L;
    }
    const At at = scene_at(w, 0.0L, false);
    return bound(w, &at, true);
}

// Goes n periods on, most of them at once where they repeat.
static bool go_periods(World* w, State* state, Real n, Sums* sums) {
    const Real unit = unit_of(w);
    for (Real done = 0.0L; done < n; done += 1.0L) {
        const March march = march_from(w, *state);
        const State next = state_of(&march);
        const bool repeats = are_equal(next, *state, unit);
        add_times(sums, &march.sums, repeats ? n - done : 1.0L);
        *state = next;
        if (repeats) {
            return true;
        }
        if (w->panels > MOST_PANELS) {
            return false;
        }
    }
    return true;
}

enum { MOST_CYCLE = 256, CYCLE_BEFORE_NEWTON = 32 };
static const Real MOST_OF_SETTLING = 1e5L; // panels

// How many periods more from a state make no slip; each one shifts the deflection.
static Real skip_untouched(World* w, State state, Vector shift) {
    Real low = 0.0L, high = 1.0L;
    for (bool found = false; (!found || high - low > 1.0L) && w->panels <= MOST_OF_SETTLING;) {
        const Real n = found ? floorl(0.5L * (low + high)) : high;
        const State there = {plus(state.delta, n, shift), false};
        const bool touched = march_from(w, there).slipped;
        found = found || touched;
        *(touched ? &high : &low) = n;
        high = found ? high : 2.0L * high;
    }
    return low;
}

// ElasticPlastic: periods until one that slips ends where one has ended before, or nothing slips nor drifts.
static bool settle_by_cycle(World* w, State* state, Vector* mean) {
    typedef struct {
        State state;
        Vector impulse; // of all periods so far,
        Real count;     // of that many
    } Mark;
    const Real unit = unit_of(w);
    const Vector shift = {w->along.V / w->scene.f, w->transverse.V / w->scene.f};
    const int most = w->excess == 0.0L && length_of(shift) > 0.0L ? CYCLE_BEFORE_NEWTON : MOST_CYCLE;
    Mark* marks = memory(NULL, MOST_CYCLE * sizeof *marks);
    Mark now = {.state = *state};
    bool known = false;
    for (int count = 0; count < most && !known && w->panels <= MOST_OF_SETTLING;) {
        const March march = march_from(w, now.state);
        now = (Mark){state_of(&march), plus(now.impulse, 1.0L, march.sums.impulse), now.count + 1.0L};
        *mean = times(w->scene.f, march.sums.impulse);
        if (!march.slipped) {
            const Real n = length_of(shift) > 0.0L ? skip_untouched(w, now.state, shift) : INFINITY;
            if (isinf(n)) {
                known = true;
                continue;
            }
            // their impulses grow by the same from one to the next
            const Vector next = march_from(w, now.state).sums.impulse;
            const Vector growth = plus(next, -1.0L, march.sums.impulse);
            now.impulse = plus(plus(now.impulse, n, march.sums.impulse), 0.5L * n * (n + 1.0L), growth);
            now.state.delta = plus(now.state.delta, n, shift);
            now.count += n;
            continue;
        }
        for (int k = count - 1; k >= 0 && !known; k--) {
            known = are_equal(marks[k].state, now.state, unit);
            *mean =
                times(w->scene.f / (now.count - marks[k].count), plus(now.impulse, -1.0L, marks[k].impulse));
        }
        marks[count++] = now;
    }
    *state = now.state;
    free(marks);
    return known;
}

// Newton's step to the fixed point of a period's map, which from a state misses it so.
static Vector newton_step(World* w, State state, Vector end, Vector miss, Real step) {
    const Vector x = {state.delta.x - step, state.delta.y}, y = {state.delta.x, state.delta.y - step};
    const Vector by_x = times(1.0L / step, plus(end, -1.0L, march_from(w, (State){x, false}).delta));
    const Vector by_y = times(1.0L / step, plus(end, -1.0L, march_from(w, (State){y, false}).delta));
    const Real a = 1.0L - by_x.x, b = -by_y.x, c = -by_x.y, d = 1.0L - by_y.y, all = a * d - b * c;
    return (Vector){(d * miss.x - b * miss.y) / all, (a * miss.y - c * miss.x) / all};
}

// The periodic state where it does not depend on the start, by Newton: at once where no bound is met, soon where slips are so
// small that each forgets little. A bristle that only drifts goes to where it slips.
static bool settle_by_newton(World* w, State* state, Vector* mean) {
    const Vector shift = {w->along.V / w->scene.f, w->transverse.V / w->scene.f};
    const Real unit = unit_of(w), step = 1e-3L * (w->elastic ? fminl(length_of(shift), unit) : unit);
    for (int k = 0; k < 60 && w->panels <= MOST_OF_SETTLING; k++) {
        const March march = march_from(w, *state);
        const Vector miss = plus(march.delta, -1.0L, state->delta);
        *mean = times(w->scene.f, march.sums.impulse);
        if (w->elastic && !march.slipped) {
            state->delta = plus(march.delta, skip_untouched(w, state_of(&march), shift), shift);
            continue;
        }
        const Vector newton = newton_step(w, *state, march.delta, miss, step);
        if (length_of(miss) <= 1e-15L * unit && !(length_of(newton) > 1e-12L * unit)) {
            return true;
        }
        const bool plain = k % 4 == 3 || !(length_of(newton) < 10.0L * unit); // there are kinks
        state->delta = plus(state->delta, 1.0L, plain ? miss : newton);
    }
    return false;
}

// To the periodic state of held inputs, w of one period, or to sliding for ever; the mean force.
static bool settle(World* w, State* state, Vector* mean) {
    const ReferenceScene* s = &w->scene;
    if (s->law == LAW_COULOMB || is_open(w, 0.0L)) {
        *mean = times(s->f, march_from(w, *state).sums.impulse);
        return true;
    }
    if (vibrates(s)) {
        const bool drifts = w->along.V != 0.0L || w->transverse.V != 0.0L;
        return (w->elastic && settle_by_cycle(w, state, mean)) ||
               ((!w->elastic || (drifts && w->excess == 0.0L)) && settle_by_newton(w, state, mean));
    }
    const At at = scene_at(w, 0.0L, false);
    const Vector V = velocity_at(&at);
    if (length_of(V) > 0.0L) {
        *state = (State){along(V, at.g / at.sigma), w->elastic && w->excess != 0.0L};
    }
    *mean = plus(times(at.sigma, state->delta), s->sigma_2, V);
    return true;
}

// ---------------------------------------------------------------------------------------------------------------------
// The step
// ---------------------------------------------------------------------------------------------------------------------

// The force [N] at a time; slips: on its bound, if the law pushes it outward.
static Vector force_at(const World* w, Real t, State state) {
    const ReferenceScene* s = &w->scene;
    World there = *w;
    there.open = is_open(w, t);
    const At at = scene_at(&there, t, true);
    const Vector V = velocity_at(&at);
    if (s->law == LAW_COULOMB || there.open) {
        return plus(along(V, s->law == LAW_COULOMB ? at.coulomb : 0.0L), s->sigma_2, V);
    }
    Vector rate = plus(V, -relaxation(w, &at), state.delta);
    const Real lies = bound(w, &at, false), length = length_of(state.delta);
    const bool may_slip = w->bounded && (state.broke || !w->elastic || w->excess == 0.0L);
    if (may_slip && length >= (1.0L - ON_BOUND) * lies && outward(w, &at, state.delta) > 0.0L) {
        const Vector n = along(state.delta, 1.0L), t_at = {-n.y, n.x};
        rate = plus(times(bound_rate(w, &at, false), n), dot(V, t_at), t_at);
    }
    return plus(plus(times(at.sigma, state.delta), s->sigma_1, rate), s->sigma_2, V);
}

static Real jump_to(const ReferenceScene* before, const World* w, State* state) {
    Real length = length_of(state->delta);
    int slip = state->broke;
    const Real heat = jump(before, w, &length, &slip);
    *state = (State){along(state->delta, length), slip != 0 && w->excess != 0.0L};
    return heat;
}

static State start_of(const ReferenceScene* s) {
    return s->law == LAW_COULOMB ? (State){0} : (State){{s->delta_0, s->delta_y_0}, s->slips != 0};
}

static bool advance(World* w, State* state, Sums* sums) {
    const ReferenceScene* s = &w->scene;
    World rest = *w;
    bool known = true;
    if (is_held(s) && vibrates(s) && w->h * s->f > 4.0L) {
        World period = *w;
        period.h = 1.0L / s->f;
        const Real n = floorl(w->h * s->f);
        known = go_periods(&period, state, n, sums);
        rest.h = w->h - n / s->f;
    }
    const March march = march_from(&rest, *state);
    add_times(sums, &march.sums, 1.0L);
    *state = state_of(&march);
    return known && rest.panels <= MOST_PANELS;
}

bool plane_is_needed(const ReferenceScene* before, const ReferenceScene* scene) {
    const bool now =
        scene->V_y != 0.0 || scene->V_y_rate != 0.0 || scene->V_2 != 0.0 || scene->delta_y_0 != 0.0;
    return now || (before != NULL && plane_is_needed(NULL, before));
}

void plane_step(const ReferenceScene* before, const ReferenceScene* scene, int fineness,
                ReferenceStep* result) {
    World w = make_world(scene, scene->h, fineness);
    State state = start_of(scene);
    w.S = largest_force(&w, length_of(state.delta));
    World held = held_world(&w, 1.0L / scene->f);
    *result = (ReferenceStep){.S = (double)w.S, .known = true};
    Sums sums = {0};
    if (scene->law != LAW_COULOMB && scene->initial == START_SETTLED) {
        Vector mean;
        jump_to(NULL, &held, &state);
        result->known = settle(&held, &state, &mean);
    } else if (scene->law != LAW_COULOMB) {
        sums.heat = jump_to(before, &w, &state);
    }
    const Vector start = force_at(&held, 0.0L, state);
    result->known = advance(&w, &state, &sums) && result->known;
    const Vector force = force_at(&w, w.h, state), mean = times(1.0L / w.h, sums.impulse);
    result->delta = (double)state.delta.x, result->delta_y = (double)state.delta.y;
    result->slips = w.elastic && w.excess != 0.0L && state.broke;
    result->F_t = (double)force.x, result->F_y = (double)force.y;
    result->F_t_mean = (double)mean.x, result->F_y_mean = (double)mean.y;
    result->F_t_start = (double)start.x, result->F_y_start = (double)start.y;
    result->work = (double)sums.work;
    result->heat = (double)sums.heat;
    result->path = (double)sums.path;
    result->error = (double)fmaxl(sums.miss_force / (w.h * w.S),
                                  sums.path > 0.0L ? sums.miss_W / (w.S * sums.path) : 0.0L);
}

bool plane_settled_force(const ReferenceScene* scene, double force[2], double* S) {
    ReferenceScene still = *scene;
    still.V_rate = still.V_y_rate = still.d_rate = still.E_rate = still.load_rate = 0.0;
    still.start = 0.0;
    World w = make_world(&still, 1.0L / still.f, 1);
    State state = start_of(&still);
    Vector mean = {0};
    w.S = largest_force(&w, length_of(state.delta));
    jump_to(NULL, &w, &state);
    const bool known = settle(&w, &state, &mean);
    *S = (double)w.S;
    force[0] = (double)mean.x, force[1] = (double)mean.y;
    return known;
}
