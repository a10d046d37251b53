#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "moment.h"

static const Real PI = 3.141592653589793238462643383279502884L;

// -d(delta') / d(delta) [1/s] with |V| = side V, which holds between reversals.
static Real relaxation(const World* w, const At* at, int side) {
    return w->elastic ? 0.0L : at->sigma * (Real)side * at->V / at->g;
}

// How fast [m/s] the law alone would carry a bristle that lies on the bound of this side beyond it.
static Real outward(const World* w, Real t, int side, bool sticks) {
    const At at = scene_at(w, t, true);
    const Real forward = (Real)side * at.V;
    const Real own = w->elastic ? forward : forward - fabsl(forward) * at.B / at.g;
    return own - bound_rate(w, &at, sticks);
}

// How far [m] the bristle is inside its bound.
static Real gap(const World* w, Real t, Real delta, int side, bool sticks) {
    const At at = scene_at(w, t, false);
    return bound(w, &at, sticks) - (Real)side * delta;
}

// ---------------------------------------------------------------------------------------------------------------------
// Panels
// ---------------------------------------------------------------------------------------------------------------------

typedef struct {
    Real end;     // m, delta at the end
    Real change;  // m, of delta, which for a soft bristle has more digits than the difference of its ends
    Real impulse; // N s
    Real work;    // J
    Real heat;    // J
    Real path;    // m, integral of |V|
    // The scales of their errors: the length is the deflection at the end, or the remaining part of a longer
    // one.
    Real length, force, power;
    Real blur; // m, of delta at the end by the rounding of time
} Sums;

static void add_times(Sums* sums, const Sums* one, Real factor) {
    sums->impulse += factor * one->impulse;
    sums->work += factor * one->work;
    sums->heat += factor * one->heat;
    sums->path += factor * one->path;
}

static void add(Sums* sums, const Sums* part) {
    add_times(sums, part, 1.0L);
    sums->end = part->end;
    sums->change += part->change;
    sums->length = part->length;
    sums->blur = part->blur;
    sums->force += part->force;
    sums->power += part->power;
}

// Of a time [s] in which the bristle has that force, deflection's rate and V.
static void account(const World* w, Sums* sums, Real spring, Real rate, Real V, Real time) {
    const Real damping = w->scene.sigma_1 * rate, viscous = w->scene.sigma_2 * V;
    sums->impulse += time * (spring + viscous);
    sums->work += time * (spring + damping + viscous) * V;
    sums->heat += time * (spring * (V - rate) + (damping + viscous) * V);
    sums->force += time * (fabsl(spring) + fabsl(viscous) + w->S);
    sums->power += time * (fabsl(spring) + fabsl(damping) + fabsl(viscous) + w->S) *
                   (fabsl(V) + (spring == 0.0L ? 0.0L : fabsl(rate)));
}

// What moves on a stretch between cuts: V has one sign; the bristle follows its law, or slips along the bound
// of a side.
typedef struct {
    int sign; // of V
    int slip; // 0, +1, -1
} Motion;

// The deflections at the nodes of a panel by the bristle's own law: delta + Y, Y_i = size sum_j to_ij (V_j -
// r_j delta - r_j Y_j). Returns the change of delta.
static Real collocate(const World* w, const At* at, const Real* r, Real size, Real delta, Real* at_delta) {
    const int n = w->rule->stages;
    Real A[MOST_STAGES][MOST_STAGES], Y[MOST_STAGES] = {0};
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            const Real weight = size * w->rule->to[i][j];
            Y[i] += weight * (at[j].V - r[j] * delta);
            A[i][j] = (i == j ? 1.0L : 0.0L) + weight * r[j];
        }
    }
    solve(n, A, 1, &Y);
    for (int i = 0; i < n; i++) {
        at_delta[i] = delta + Y[i];
    }
    return Y[n - 1];
}

static Sums panel(World* w, const Motion* motion, Real a, Real b, Real delta) {
    const Rule* rule = w->rule;
    const int n = rule->stages, last = n - 1;
    const Real size = b - a;
    const bool bristle = !w->open && w->scene.law != LAW_COULOMB;
    Sums sums = {.path = fabsl(travel(w, &w->along, a, b)), .end = delta};
    At at[MOST_STAGES];
    Real r[MOST_STAGES] = {0}, rate[MOST_STAGES] = {0}, at_delta[MOST_STAGES] = {0};
    for (int i = 0; i < n; i++) {
        const Real t = a + size * rule->node[i];
        at[i] = scene_at(w, t, motion->slip != 0);
        if (motion->slip) {
            at_delta[i] = (Real)motion->slip * bound(w, &at[i], false);
            rate[i] = (Real)motion->slip * bound_rate(w, &at[i], false);
        } else if (bristle && w->elastic) {
            at_delta[i] = delta + travel(w, &w->along, a, t);
            rate[i] = at[i].V;
        } else if (bristle) {
            r[i] = relaxation(w, &at[i], motion->sign);
        }
    }
    sums.change = motion->slip            ? at_delta[last] - delta
                  : bristle && w->elastic ? travel(w, &w->along, a, b)
                                          : 0.0L;
    if (bristle && !motion->slip && !w->elastic) {
        sums.change = collocate(w, at, r, size, delta, at_delta);
        for (int i = 0; i < n; i++) {
            rate[i] = at[i].V - r[i] * at_delta[i];
        }
    }
    if (bristle) {
        Real relaxed = 0.0L, longest = fabsl(delta), fastest = 0.0L;
        for (int i = 0; i < n; i++) {
            relaxed += size * rule->weight[i] * r[i];
            longest = fmaxl(longest, fabsl(at_delta[i]));
            fastest = fmaxl(fastest, fabsl(rate[i]));
        }
        sums.end = at_delta[last];
        sums.blur = fastest * expl(-relaxed) * 2.0L * LDBL_EPSILON * b;
        sums.length = fmaxl(longest * expl(-relaxed), fmaxl(fabsl(sums.end), at[last].g / at[last].sigma));
    }
    for (int i = 0; i < n; i++) {
        const Real spring = bristle                       ? at[i].sigma * at_delta[i]
                            : w->scene.law == LAW_COULOMB ? (Real)motion->sign * at[i].coulomb
                                                          : 0.0L;
        account(w, &sums, spring, rate[i], at[i].V, size * rule->weight[i]);
    }
    sums.impulse += w->scene.sigma_1 * sums.change;
    sums.force += w->scene.sigma_1 * fabsl(sums.change);
    w->panels += 1.0L;
    return sums;
}

static const Real AGREE = 1e-13L; // the halves are then right to some 1e-17
static const int DEEPEST = 110;
static const Real MOST_PANELS = 1e6L; // more are not taken, and the step is not known

// An error in a panel is left alone when it is less than this share of the panel's mean force acting over the
// whole step.
static const Real LEAST = 1e-16L;

// Whether a panel of this size [s] and its halves give the same.
static bool agree(const World* w, const Sums* one, const Sums* two, Real size) {
    const Real share = w->fineness == 1 ? 1.0L : 0.01L, same = share * AGREE;
    const Real force = share * LEAST * two->force / size;
    const Real impulse = same * two->force + force * w->h,
               energy = same * two->power + force * (w->top * w->h + two->length);
    return fabsl(one->end - two->end) <= same * two->length + two->blur &&
           fabsl(one->impulse - two->impulse) <= impulse && fabsl(one->work - two->work) <= energy &&
           fabsl(one->heat - two->heat) <= energy;
}

static bool is_smallest(const World* w, Real a, Real b, int depth) {
    const Real middle = 0.5L * (a + b);
    return depth >= DEEPEST || w->panels > MOST_PANELS || !(middle > a && middle < b);
}

// The state of a march through the step.
typedef struct {
    World* w;
    Sums sums;
    Real delta;
    int slip;      // side along whose bound the bristle slips, or 0
    bool slipped;  // at any time
    bool watch[2]; // whether the bound of the side +1, -1 may be met
    int met;       // the side that was met, or 0
    Real met_at;   // when
} March;

static int side_met(const March* march, const Motion* motion, Real t, Real delta) {
    for (int side = 1; side >= -1 && !motion->slip; side -= 2) {
        if (march->watch[side < 0] && gap(march->w, t, delta, side, march->slip == 0) < 0.0L) {
            return side;
        }
    }
    return 0;
}

static void commit(March* march, const Sums* part) {
    add(&march->sums, part);
    march->delta = part->end;
}

// A free bristle on its way to the bound of a side.
typedef struct {
    const March* march;
    const Motion* motion;
    Real from; // s
    int side;
} Way;

static Real beyond(const void* context, Real t) {
    const Way* way = context;
    World* w = way->march->w;
    const Real start = way->march->delta;
    const Real delta = t > way->from ? panel(w, way->motion, way->from, t, start).end : start;
    return -gap(w, t, delta, way->side, way->march->slip == 0);
}

static void go_over(March* march, const Motion* motion, Real a, Real b);

// Over [a, b], of which one is the sum of a single panel, by halves until they agree with the whole; a
// bristle that is free stops at a bound.
static void go_on(March* march, const Motion* motion, Real a, Real b, const Sums* one, int depth) {
    World* w = march->w;
    const Real middle = 0.5L * (a + b);
    const Sums left = panel(w, motion, a, middle, march->delta);
    const Sums right = panel(w, motion, middle, b, left.end);
    Sums two = left;
    add(&two, &right);
    if (!agree(w, one, &two, b - a) && !is_smallest(w, a, b, depth)) {
        go_on(march, motion, a, middle, &left, depth + 1);
        if (!march->met) {
            const Sums again = motion->slip ? right : panel(w, motion, middle, b, march->delta);
            go_on(march, motion, middle, b, &again, depth + 1);
        }
        return;
    }
    int side = side_met(march, motion, middle, left.end);
    if (!side) {
        commit(march, &left);
        side = side_met(march, motion, b, right.end);
        a = middle;
        if (!side) {
            commit(march, &right);
            return;
        }
    } else {
        b = middle;
    }
    const Way way = {march, motion, a, side};
    const Real met_at = beyond(&way, a) >= 0.0L ? a : crossing(beyond, &way, a, b);
    march->watch[0] = march->watch[1] = false;
    if (met_at > a) {
        go_over(march, motion, a, met_at);
    }
    march->met = side;
    march->met_at = met_at;
}

static void go_over(March* march, const Motion* motion, Real a, Real b) {
    const Sums one = panel(march->w, motion, a, b, march->delta);
    go_on(march, motion, a, b, &one, 0);
}

// ---------------------------------------------------------------------------------------------------------------------
// Cuts of the step
// ---------------------------------------------------------------------------------------------------------------------

typedef struct {
    const World* w;
    Real level; // m/s, of V
    int side;   // of a bound
    bool sticks;
} Zero;

static Real velocity_less(const void* context, Real t) {
    const Zero* zero = context;
    return velocity(zero->w, &zero->w->along, t) - zero->level;
}

static Real outward_of(const void* context, Real t) {
    const Zero* zero = context;
    return outward(zero->w, t, zero->side, zero->sticks);
}

// The zeros of dV/dt, the turns of the vibration, and equal pieces in between.
static void cut_at_bends(const World* w, Cuts* cuts) {
    const ReferenceScene* s = &w->scene;
    const int pieces = 4 * w->fineness;
    if (!vibrates(s)) {
        return;
    }
    const long first = (long)floorl(w->theta_0 / (2.0L * PI)) - 1;
    const long last = (long)ceill((w->theta_0 + w->omega * w->h) / (2.0L * PI)) + 1;
    const Real ratio = s->V_1 == 0.0 ? 2.0L : s->V_rate / (s->V_1 * w->omega);
    for (long k = first; k <= last; k++) {
        for (int j = 0; j < pieces; j++) {
            cut(cuts, (2.0L * PI * ((Real)k + (Real)j / (Real)pieces) - w->theta_0) / w->omega);
        }
        if (fabsl(ratio) < 1.0L) {
            const Real angle = asinl(ratio);
            cut(cuts, (2.0L * PI * (Real)k + angle - w->theta_0) / w->omega);
            cut(cuts, (2.0L * PI * (Real)k + PI - angle - w->theta_0) / w->omega);
        }
    }
}

// Where V is a multiple of V_S, and 0; V is monotone between the cuts so far.
static void cut_at_velocities(const World* w, Cuts* cuts) {
    const size_t count = cuts->count, levels = w->excess == 0.0L ? 1 : LEVELS;
    for (size_t k = 0; k + 1 < count; k++) {
        const Real a = cuts->time[k], b = cuts->time[k + 1];
        for (size_t m = 0; m < 2 * levels; m++) {
            const Zero zero = {.w = w, .level = (m % 2 ? 1.0L : -1.0L) * MULTIPLES[m / 2] * w->scene.V_S};
            if (velocity_less(&zero, a) * velocity_less(&zero, b) < 0.0L) {
                cut(cuts, crossing(velocity_less, &zero, a, b));
            }
        }
    }
}

// Cuts at the times between a and b at which a bristle may leave its bound, as the samples at the ends of
// cells show. A push that passes zero only just, between two samples, counts too: the extreme next to a
// sample is searched.
static void cut_at_zeros(const Zero* zero, Cuts* cuts, Real a, Real b) {
    const int cells = 12 * zero->w->fineness;
    Real t[3] = {a, a, a}, value[3] = {0.0L, 0.0L, outward_of(zero, a)};
    for (int k = 1; k <= cells; k++) {
        t[0] = t[1], t[1] = t[2], value[0] = value[1], value[1] = value[2];
        t[2] = k == cells ? b : 0.5L * (a + b) - 0.5L * (b - a) * cosl(PI * (Real)k / (Real)cells);
        value[2] = outward_of(zero, t[2]);
        if (value[1] * value[2] < 0.0L) {
            cut(cuts, crossing(outward_of, zero, t[1], t[2]));
            continue;
        }
        Real low = t[0], high = t[2];
        const Real size = fabsl(value[1]);
        const bool least = value[1] * value[0] > 0.0L && size <= fabsl(value[0]) && size <= fabsl(value[2]);
        for (int i = 0; i < 60 && least; i++) { // golden section
            const Real x = low + 0.381966L * (high - low), y = high - 0.381966L * (high - low);
            const Real at_x = outward_of(zero, x), at_y = outward_of(zero, y);
            if (at_x * value[1] < 0.0L || at_y * value[1] < 0.0L) {
                const Real inside = at_x * value[1] < 0.0L ? x : y;
                cut(cuts, crossing(outward_of, zero, low, inside));
                cut(cuts, crossing(outward_of, zero, inside, high));
                break;
            }
            *(fabsl(at_x) < fabsl(at_y) ? &high : &low) = fabsl(at_x) < fabsl(at_y) ? y : x;
        }
    }
}

// Of the part in which the contact is closed, or open.
static Cuts all_cuts(const World* w, Closed part) {
    Cuts cuts = {0};
    const ReferenceScene* s = &w->scene;
    const Real span = part.to - part.from;
    cut(&cuts, part.from);
    cut(&cuts, part.to);
    cut_at_bends(w, &cuts);
    if (!w->open && (s->load_rate != 0.0 || s->E_rate != 0.0 || s->d_rate != 0.0)) {
        // a load may fall by decades toward the end, or rise by as much from the start
        for (int k = 1; k <= 60; k += 2) {
            cut(&cuts, part.from + ldexpl(span, -k));
            cut(&cuts, part.to - ldexpl(span, -k));
        }
    }
    tidy(&cuts, part);
    cut_at_velocities(w, &cuts);
    tidy(&cuts, part);
    const size_t count = cuts.count;
    const int kinds = w->excess != 0.0L && w->elastic
                          ? 4
                          : 2; // of both sides; the bound that slips, then the one that sticks
    for (size_t k = 0; w->bounded && !w->open && k + 1 < count; k++) {
        for (int kind = 0; kind < kinds; kind++) {
            const Zero zero = {.w = w, .side = kind % 2 ? 1 : -1, .sticks = kind >= 2};
            cut_at_zeros(&zero, &cuts, cuts.time[k], cuts.time[k + 1]);
        }
    }
    tidy(&cuts, part);
    return cuts;
}

// ---------------------------------------------------------------------------------------------------------------------
// The march through the step
// ---------------------------------------------------------------------------------------------------------------------

// The bristle meets its bound. One that stuck drops to the kinetic bound: the limit of a fast motion, so the
// damping does work.
static void break_away(March* march, Real t, int side) {
    const At at = scene_at(march->w, t, false);
    const Real from = march->delta, to = (Real)side * bound(march->w, &at, false);
    const Real damping = march->w->scene.sigma_1 * (to - from);
    march->delta = to;
    march->slip = side;
    march->slipped = true;
    march->sums.impulse += damping;
    march->sums.work += damping * at.V;
    march->sums.heat += damping * at.V + 0.5L * at.sigma * (from - to) * (from + to);
}

static void stretch(March* march, Real a, Real b) {
    World* w = march->w;
    const Real middle = 0.5L * (a + b);
    Motion motion = {.sign = sign_of(velocity(w, &w->along, middle))};
    bool arrived = false; // at the bound just now
    int stays = 0;        // where V is 0 it may break away and stick without end
    while (a < b) {
        if (march->slip && !(outward(w, middle, march->slip, false) > 0.0L)) {
            march->slip = 0; // it sticks, or leaves the bound
        }
        const bool blind = stays > 4;
        const Real to = blind && a + 1e-12L * (b - a) > a ? a + 1e-12L * (b - a) : b;
        const int slip = march->slip;
        march->slipped = march->slipped || slip;
        march->met = 0;
        for (int side = 1; side >= -1; side -= 2) {
            march->watch[side < 0] = !blind && w->bounded && !w->open && !w->open_ends &&
                                     (slip ? side == slip : outward(w, middle, side, true) > 0.0L);
        }
        // on the bound, or catching up
        const bool lies =
            slip && (arrived || gap(w, a, march->delta, slip, false) <= 1e-18L * fabsl(march->delta));
        motion.slip = lies ? slip : 0;
        go_over(march, &motion, a, to);
        stays = march->met && !(march->met_at > a) ? stays + 1 : 0;
        a = march->met ? march->met_at : to;
        arrived = march->met != 0;
        if (march->met && !slip) {
            break_away(march, a, march->met);
        }
    }
}

static void march_part(March* march, Closed part, bool open) {
    if (!(part.to > part.from)) {
        return;
    }
    march->w->open = open;
    Cuts cuts = all_cuts(march->w, part);
    for (size_t k = 0; k + 1 < cuts.count; k++) {
        stretch(march, cuts.time[k], cuts.time[k + 1]);
    }
    free(cuts.time);
}

static void march_over(March* march) {
    World* w = march->w;
    const Closed part = closed_part(w);
    march_part(march, (Closed){0.0L, part.from}, true);
    // without a load there is no rate: the last 1e-18 of the way to it is left out
    const Real edge = ldexpl(part.to - part.from, -58);
    march_part(
        march,
        (Closed){part.from + (part.from > 0.0L ? edge : 0.0L), part.to - (part.to < w->h ? edge : 0.0L)},
        false);
    if (part.to < w->h) {
        const bool slides = w->scene.contact == CONTACT_CONSTANT && w->scene.law != LAW_COULOMB;
        march->sums.heat += slides ? 0.5L * w->scene.contact_sigma * march->delta * march->delta : 0.0L;
        march->delta = 0.0L;
        march->slip = 0;
    }
    march_part(march, (Closed){part.to, w->h}, true);
    w->open = false;
}

// ---------------------------------------------------------------------------------------------------------------------
// Many equal periods
// ---------------------------------------------------------------------------------------------------------------------

static March one_period(World* w, Real delta, int slip, bool open_ends) {
    March march = {.w = w, .delta = delta, .slip = slip};
    w->open_ends = open_ends;
    march_over(&march);
    w->open_ends = false;
    return march;
}

// As long as it touches no bound, a period maps delta in an affine way, and its sums are polynomials of
// degree 2 in delta: it multiplies (1, x, x^2, impulse, work, heat, path) by a matrix, x = delta / unit.
enum { ROWS = 7, POWERS = 50 };
typedef struct {
    Real m[ROWS][ROWS];
} Map;

static Map find_map(World* w, Real unit) {
    const bool drifts_not = w->elastic && w->scene.V == 0.0;
    Map map = {0};
    Real way[3], of[3][4];
    for (int k = 0; k < 3; k++) {
        const Sums sums = one_period(w, (Real)(k - 1) * unit, 0, true).sums;
        way[k] = drifts_not ? 0.0L : sums.change / unit;
        of[k][0] = sums.impulse, of[k][1] = sums.work, of[k][2] = sums.heat, of[k][3] = sums.path;
    }
    const Real shift = way[1], kept = 1.0L + (w->elastic ? 0.0L : 0.5L * (way[2] - way[0]));
    map.m[0][0] = 1.0L;
    map.m[1][0] = shift, map.m[1][1] = kept;
    map.m[2][0] = shift * shift, map.m[2][1] = 2.0L * shift * kept, map.m[2][2] = kept * kept;
    for (int i = 0; i < 4; i++) {
        map.m[3 + i][0] = of[1][i];
        map.m[3 + i][1] = 0.5L * (of[2][i] - of[0][i]);
        map.m[3 + i][2] = 0.5L * (of[2][i] + of[0][i]) - of[1][i];
        map.m[3 + i][3 + i] = 1.0L;
    }
    return map;
}

static Map twice(const Map* map) {
    Map two = {0};
    for (int i = 0; i < ROWS; i++) {
        for (int j = 0; j < ROWS; j++) {
            for (int k = 0; k < ROWS; k++) {
                two.m[i][j] += map->m[i][k] * map->m[k][j];
            }
        }
    }
    return two;
}

// A period, and its map's powers of 1, 2, 4 ..
typedef struct {
    World world;
    Real unit; // m, of x
    Map power[POWERS];
} Period;

// delta after n periods that touch no bound; adds their sums.
static Real after_untouched(const Period* p, Real delta, Real n, Sums* sums) {
    Real x = delta / p->unit;
    for (int k = 0; k < POWERS; k++) {
        if (fmodl(floorl(ldexpl(n, -k)), 2.0L) == 0.0L) {
            continue;
        }
        Real of[ROWS];
        for (int i = 0; i < ROWS; i++) {
            const Real* row = p->power[k].m[i];
            of[i] = row[0] + x * (row[1] + x * row[2]);
        }
        const Sums part = {.impulse = of[3], .work = of[4], .heat = of[5], .path = of[6]};
        add_times(sums, &part, 1.0L);
        x = of[1];
    }
    return x * p->unit;
}

// Whether period number n from delta on touches a bound, if none before it does.
static bool touches(Period* p, Real delta, Real n) {
    Sums unused = {0};
    return one_period(&p->world, after_untouched(p, delta, n - 1.0L, &unused), 0, false).slipped;
}

// How many periods from delta touch no bound, at the most n, or 2^(POWERS - 1); the first one touches none.
static Real count_untouched(Period* p, Real delta, Real n) {
    Real low = 1.0L, high = fminl(n, ldexpl(1.0L, POWERS - 1));
    if (!touches(p, delta, high)) {
        return high;
    }
    while (2.0L * low < high && !touches(p, delta, 2.0L * low)) {
        low *= 2.0L;
    }
    high = fminl(high, 2.0L * low);
    while (high - low > 1.0L) {
        const Real middle = floorl(0.5L * (low + high));
        *(touches(p, delta, middle) ? &high : &low) = middle;
    }
    return low;
}

enum { MOST_CYCLE = 4096 };

typedef struct {
    Real delta;
    int slip;
    Real count; // periods before it
    Sums sums;  // up to it
} Mark;

// Goes n periods on, INFINITY for ever: then *cycle is the sums of the periods that repeat at last, *length their number, and
// the state that at the end of one that slips, that of
// the smallest deflection. False where none repeat.
static bool go_periods(const World* of, Real* delta, int* slip, Real n, Sums* sums, Sums* cycle,
                       Real* length) {
    Period p = {.world = *of, .unit = 1.0L};
    World* w = &p.world;
    if (w->scene.law != LAW_COULOMB && !is_open(w, 0.0L)) {
        const At at = scene_at(w, 0.0L, false);
        p.unit = bound(w, &at, true);
    }
    Mark* marks = memory(NULL, MOST_CYCLE * sizeof *marks);
    int count = 0;
    bool known = true;
    for (int k = 0; k < POWERS; k++) {
        p.power[k] = k == 0 ? find_map(w, p.unit) : twice(&p.power[k - 1]);
    }
    for (Real done = 0.0L; done < n && known;) {
        const March march = one_period(w, *delta, *slip, false);
        if (!march.slipped) {
            const Real many = count_untouched(&p, *delta, n - done);
            *delta = after_untouched(&p, *delta, many, sums);
            *slip = march.slip;
            done += many;
            if (isinf(n) && many == ldexpl(1.0L, POWERS - 1)) {
                *cycle = one_period(w, *delta, 0, false).sums;
                *length = 1.0L;
                break;
            }
            continue;
        }
        add_times(sums, &march.sums, 1.0L);
        *delta = march.delta;
        *slip = march.slip;
        done += 1.0L;
        int k = count - 1;
        while (k >= 0 && !(marks[k].slip == *slip &&
                           fabsl(marks[k].delta - *delta) <= 1e-16L * (p.unit + fabsl(*delta)))) {
            k--;
        }
        if (k >= 0) {
            *cycle = *sums;
            add_times(cycle, &marks[k].sums, -1.0L);
            *length = done - marks[k].count;
            if (isinf(n)) {
                for (; k < count; k++) {
                    if (fabsl(marks[k].delta) < fabsl(*delta)) {
                        *delta = marks[k].delta;
                        *slip = marks[k].slip;
                    }
                }
                break;
            }
            const Real times = floorl((n - done) / *length);
            add_times(sums, cycle, times);
            done += times * *length;
            count = 0;
        } else if (count == MOST_CYCLE || w->panels > MOST_PANELS) {
            known = false;
        } else {
            marks[count++] = (Mark){*delta, *slip, done, *sums};
        }
    }
    free(marks);
    return known;
}

// ---------------------------------------------------------------------------------------------------------------------
// The step
// ---------------------------------------------------------------------------------------------------------------------

static bool has_many_periods(const World* w) {
    return is_held(&w->scene) && vibrates(&w->scene) && w->h * w->scene.f > 4.0L;
}
// F_t [N] at a time.
static Real force_at(const World* w, Real t, Real delta, int slip) {
    const ReferenceScene* s = &w->scene;
    World there = *w;
    there.open = is_open(w, t);
    const At at = scene_at(&there, t, true);
    if (s->law == LAW_COULOMB) {
        return (Real)sign_of(at.V) * at.coulomb + s->sigma_2 * at.V;
    }
    if (there.open) {
        return s->sigma_2 * at.V;
    }
    const Real lies = bound(w, &at, false);
    const bool slips =
        slip && fabsl((Real)slip * lies - delta) <= ON_BOUND * lies && outward(w, t, slip, false) > 0.0L;
    const Real rate =
        slips ? (Real)slip * bound_rate(w, &at, false) : at.V - relaxation(w, &at, sign_of(at.V)) * delta;
    return at.sigma * delta + s->sigma_1 * rate + s->sigma_2 * at.V;
}

// The deflection at the start that the periodic state of held inputs has, without vibration the one of sliding for ever.
static bool settle(const World* w, Real* delta, int* slip, Sums* cycle, Real* length) {
    const ReferenceScene* s = &w->scene;
    World held = held_world(w, 1.0L / s->f);
    if (vibrates(s) || is_open(&held, 0.0L) || s->law == LAW_COULOMB) {
        Sums sums = {0};
        return go_periods(&held, delta, slip, INFINITY, &sums, cycle, length);
    }
    const At at = scene_at(&held, 0.0L, false);
    const int side = sign_of(s->V);
    *delta = side ? (Real)side * at.g / at.sigma : *delta;
    *slip = w->elastic ? side : 0;
    cycle->impulse = held.h * (at.sigma * *delta + s->sigma_2 * at.V);
    *length = 1.0L;
    return true;
}

// Goes over the step; false if it needs more than the reference takes.
static bool advance(World* w, Real* delta, int* slip, Sums* sums) {
    bool known = true;
    World rest = *w;
    if (has_many_periods(w)) {
        const Real n = floorl(w->h * w->scene.f);
        World period = *w;
        Sums cycle = {0};
        Real length = 0.0L;
        period.h = 1.0L / w->scene.f;
        known = go_periods(&period, delta, slip, n, sums, &cycle, &length);
        rest.h = w->h - n / w->scene.f;
    }
    if (rest.h > 0.0L) {
        const March march = one_period(&rest, *delta, *slip, false);
        add_times(sums, &march.sums, 1.0L);
        *delta = march.delta;
        *slip = march.slip;
    }
    return known && rest.panels <= MOST_PANELS;
}

void reference_step(const ReferenceScene* before, const ReferenceScene* scene, int fineness,
                    ReferenceStep* result) {
    World w = make_world(scene, scene->h, fineness);
    w.S = largest_force(&w, scene->delta_0);
    const World held = held_world(&w, w.h);
    *result = (ReferenceStep){.S = (double)w.S, .known = true};
    Sums sums = {0};
    Real delta = scene->law == LAW_COULOMB ? 0.0L : scene->delta_0;
    int slip = scene->slips;
    if (scene->law != LAW_COULOMB && scene->initial == START_SETTLED) {
        Sums cycle = {0};
        Real length;
        jump(NULL, &held, &delta, &slip);
        result->known = settle(&w, &delta, &slip, &cycle, &length);
    } else if (scene->law != LAW_COULOMB) {
        sums.heat = jump(before, &w, &delta, &slip);
    }
    int slip_start = slip;
    if (w.bounded && !(w.elastic && w.excess != 0.0L) && !is_open(&w, 0.0L)) {
        const At at = scene_at(&w, 0.0L, false); // a state that was rounded may lie next to its bound
        slip_start = fabsl(delta) >= (1.0L - ON_BOUND) * bound(&w, &at, true) ? sign_of(delta) : 0;
    }
    result->F_t_start = (double)force_at(&held, 0.0L, delta, slip_start);
    result->known = advance(&w, &delta, &slip, &sums) && result->known;
    result->delta = (double)delta;
    result->slips = w.elastic && w.excess != 0.0L ? slip : 0;
    result->F_t = (double)force_at(&w, w.h, delta, slip);
    result->F_t_mean = (double)(sums.impulse / w.h);
    result->work = (double)sums.work;
    result->heat = (double)sums.heat;
    result->path = (double)sums.path;
}

bool reference_settled_force(const ReferenceScene* scene, double* force, double* S) {
    ReferenceScene still = *scene;
    still.V_rate = still.d_rate = still.E_rate = still.load_rate = 0.0;
    still.start = 0.0;
    World w = make_world(&still, 1.0L / still.f, 1);
    w.S = largest_force(&w, still.delta_0);
    *S = (double)w.S;
    Sums cycle = {0};
    Real length = 1.0L, delta = still.law == LAW_COULOMB ? 0.0L : still.delta_0;
    int slip = 0;
    jump(NULL, &w, &delta, &slip);
    const bool known = settle(&w, &delta, &slip, &cycle, &length);
    *force = (double)(cycle.impulse / (length / still.f));
    return known;
}
