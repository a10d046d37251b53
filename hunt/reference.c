#include "reference.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef long double Real;

static const Real PI = 3.141592653589793238462643383279502884L;

// ---------------------------------------------------------------------------------------------------------------------
// Radau's right rule on [0, 1] and its collocation matrix
// ---------------------------------------------------------------------------------------------------------------------

enum { MOST_STAGES = 13 };

typedef struct {
    int stages;
    Real node[MOST_STAGES];            // the last one is 1
    Real weight[MOST_STAGES];          // sum 1
    Real to[MOST_STAGES][MOST_STAGES]; // to[i][j]: integral of the j-th Lagrange polynomial over [0, node i]
} Rule;

// P_0 .. P_n of Legendre at x.
static void legendre(int n, Real x, Real* P) {
    P[0] = 1.0L;
    P[1] = x;
    for (int m = 1; m < n; m++) {
        P[m + 1] = ((Real)(2 * m + 1) * x * P[m] - (Real)m * P[m - 1]) / (Real)(m + 1);
    }
}

// P_n - P_(n-1), whose roots are Radau's right nodes on [-1, 1].
static Real radau_polynomial(int n, Real x) {
    Real P[MOST_STAGES + 2];
    legendre(n, x, P);
    return P[n] - P[n - 1];
}

static Rule make_rule(int n);

// Made once; the first call is not safe to be made by two threads at once.
static const Rule* rule_of(int stages) {
    static Rule rules[MOST_STAGES + 1];
    if (rules[stages].stages == 0) {
        rules[stages] = make_rule(stages);
    }
    return &rules[stages];
}

static Rule make_rule(int n) {
    Rule rule = {.stages = n};
    Real x[MOST_STAGES];
    int found = 0;
    const int cells = 4000;
    for (int k = 0; k < cells && found < n - 1; k++) {
        Real low = -cosl(PI * (Real)k / (Real)cells);
        Real high = -cosl(PI * (Real)(k + 1) / (Real)cells);
        const Real at_low = radau_polynomial(n, low);
        if (at_low * radau_polynomial(n, high) >= 0.0L) {
            continue;
        }
        for (int i = 0; i < 80; i++) {
            const Real middle = 0.5L * (low + high);
            if (radau_polynomial(n, middle) * at_low > 0.0L) {
                low = middle;
            } else {
                high = middle;
            }
        }
        x[found++] = 0.5L * (low + high);
    }
    x[n - 1] = 1.0L;
    Real P[MOST_STAGES][MOST_STAGES + 2];
    for (int i = 0; i < n; i++) {
        legendre(n, x[i], P[i]);
        rule.node[i] = 0.5L * (1.0L + x[i]);
        rule.weight[i] = 0.5L * (1.0L + x[i]) / ((Real)(n * n) * P[i][n - 1] * P[i][n - 1]);
    }
    // The rule integrates products of two polynomials of degree n - 1 exactly, so the Lagrange polynomials are sums of
    // Legendre's with P_m(x_j) w_j (2 m + 1) for coefficients.
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            Real sum = 1.0L + x[i];
            for (int m = 1; m < n; m++) {
                sum += P[j][m] * (P[i][m + 1] - P[i][m - 1]);
            }
            rule.to[i][j] = 0.5L * rule.weight[j] * sum;
        }
    }
    return rule;
}

// ---------------------------------------------------------------------------------------------------------------------
// The contact
// ---------------------------------------------------------------------------------------------------------------------

// Lower incomplete gamma function of s = 3/2 and 5/2: x^s e^-x sum of x^k / (s (s + 1) .. (s + k)), for large x by erf.
static Real lower_gamma(Real s, Real x) {
    if (x > 4.0L) {
        const Real of_3_2 = 0.5L * sqrtl(PI) * erfl(sqrtl(x)) - sqrtl(x) * expl(-x);
        return s < 2.0L ? of_3_2 : 1.5L * of_3_2 - x * sqrtl(x) * expl(-x);
    }
    Real term = 1.0L / s, sum = term;
    for (int k = 1; term > 1e-22L * sum; k++) {
        term *= x / (s + (Real)k);
        sum += term;
    }
    return powl(x, s) * expl(-x) * sum;
}

// Gamma(3/2, y) = sqrt(y) e^-y + sqrt(pi) / 2 erfc(sqrt(y)).
static Real upper_gamma_3_2(Real y) { return sqrtl(y) * expl(-y) + 0.5L * sqrtl(PI) * erfcl(sqrtl(y)); }

static Real bessel_I0(Real x) {
    const Real quarter = 0.25L * x * x;
    Real term = 1.0L, sum = 1.0L;
    for (int k = 1; k < 100000 && term > 1e-22L * sum; k++) {
        term *= quarter / ((Real)k * (Real)k);
        sum += term;
    }
    return sum;
}

// What F_n and sigma are over their power of e^(-lambda d / R_q), and the derivatives of their logarithms by E.
typedef struct {
    Real force, by_force;         // N
    Real stiffness, by_stiffness; // N/m; N m2 for Asperities
} AtModulus;

static AtModulus at_modulus(const ReferenceScene* scene, Real E) {
    const Real R = scene->R, R_q = scene->R_q, lambda = scene->lambda, nu = scene->nu;
    const Real density = (Real)scene->eta * scene->A_n * scene->c;
    const Real p_m = (1.234L + 1.256L * nu) * (1.0L - nu * nu) * scene->Y;
    const Real yields = PI * p_m / (2.0L * E);
    const Real x = lambda * yields * yields * R / R_q;
    const Real x_E = -2.0L * x / E;
    const Real decay = expl(-x);
    AtModulus at;
    {
        const Real front = 4.0L / 3.0L * sqrtl(R) * powl(R_q, 1.5L) / powl(lambda, 2.5L);
        const Real plastic = PI * R * R_q * p_m / (lambda * lambda);
        const Real gamma = lower_gamma(2.5L, x);
        const Real sum = front * E * gamma + plastic * (2.0L + x) * decay;
        const Real slope =
            front * (gamma + E * powl(x, 1.5L) * decay * x_E) - plastic * (1.0L + x) * decay * x_E;
        at.force = density * sum;
        at.by_force = slope / sum;
    }
    if (scene->contact == CONTACT_ASPERITIES) {
        const Real area = scene->c * PI * (Real)scene->eta * R * R_q * scene->A_n / (lambda * lambda);
        const Real bracket = 1.0L + decay;
        at.stiffness = scene->stiffnessScale * E * area * area * bracket * bracket;
        at.by_stiffness = 1.0L / E - 2.0L * decay * x_E / bracket;
    } else if (scene->contact == CONTACT_MINDLIN) {
        const Real half = expl(-0.5L * x), plastic = 0.5L * powl(2.0L / lambda, 1.5L);
        const Real upper = upper_gamma_3_2(0.5L * x);
        const Real sum = lower_gamma(1.5L, x) / powl(lambda, 1.5L) + plastic * half * upper;
        const Real slope =
            sqrtl(x) * decay / powl(lambda, 1.5L) - 0.5L * plastic * half * (upper + sqrtl(0.5L * x) * half);
        const Real tangential = 2.0L * (1.0L - nu) / (2.0L - nu);
        at.stiffness = scene->stiffnessScale * density * 2.0L * E * tangential * sqrtl(R * R_q) * sum;
        at.by_stiffness = 1.0L / E + slope * x_E / sum;
    } else {
        at.stiffness = scene->contact_sigma;
        at.by_stiffness = 0.0L;
    }
    return at;
}

// ---------------------------------------------------------------------------------------------------------------------
// The scene at a time
// ---------------------------------------------------------------------------------------------------------------------

typedef struct {
    ReferenceScene scene;
    Real V_start; // m/s
    Real h, omega, theta_0, decay, swell, excess;
    AtModulus held; // at the modulus of the start
    bool bounded;   // sigma |delta| has a bound B
    bool moves;     // sigma or the limit move, but for Stribeck's curve
    Real path;      // m, integral of |V| over the step
    const Rule* rule;
    int fineness;
    Real panels, unresolved;
} World;

// At a local time; rates are time derivatives of logarithms, found where they are asked for.
typedef struct {
    Real V, V_rate;
    Real sigma;
    Real coulomb;    // N, F_C or mu F_n
    Real g;          // N, where the bristle's force tends
    Real B;          // N, the bound of a bounded bristle
    Real bound_rate; // of ln(B / sigma)
} At;

// Sine of x + shift pi / 2. The library's own reduction to a quarter turn would take half of all time; pi / 2 in two parts,
// the first of 41 bits, is as good for some thousand turns.
static Real sine(Real x, int shift) {
    static const Real FIRST = 0x1.921fb54442p0L, SECOND = 0x0.d18469898cc51701b8p-40L;
    const Real quarters = rintl(x * (2.0L / PI));
    const Real rest = (x - quarters * FIRST) - quarters * SECOND;
    switch (((long)quarters + shift) & 3) {
    case 0:
        return sinl(rest);
    case 1:
        return cosl(rest);
    case 2:
        return -sinl(rest);
    default:
        return -cosl(rest);
    }
}

static Real phase_at(const World* w, Real t) { return w->theta_0 + w->omega * t; }

static Real velocity(const World* w, Real t) {
    const Real V_1 = w->scene.V_1, change = w->scene.V_rate * t;
    if (V_1 == 0.0L) {
        return w->scene.V + change;
    }
    const Real half = 0.5L * w->omega * t;
    if (fabsl(half) < 0.25L) { // a step of 1e-14 s may lie next to a reversal as a whole
        return w->V_start + change - 2.0L * V_1 * sine(w->theta_0 + half, 0) * sinl(half);
    }
    return w->scene.V + change + V_1 * sine(phase_at(w, t), 1);
}

static Real velocity_rate(const World* w, Real t) {
    const Real slope = w->scene.V_rate;
    return w->scene.V_1 == 0.0 ? slope : slope - w->scene.V_1 * w->omega * sine(phase_at(w, t), 0);
}

// Integral of V over [a, b].
static Real travel(const World* w, Real a, Real b) {
    const Real span = b - a;
    const Real smooth = ((Real)w->scene.V + w->scene.V_rate * 0.5L * (a + b)) * span;
    if (w->scene.V_1 == 0.0) {
        return smooth;
    }
    const Real half = 0.5L * w->omega * span;
    return smooth + 2.0L * w->scene.V_1 / w->omega * cosl(phase_at(w, a) + half) * sinl(half);
}

// F_n [N] and sigma [N/m]; the rate of ln(limit / sigma), but for Stribeck's curve, without what cancels in it.
static void contact_at(const World* w, Real t, bool with_rates, Real* force, Real* sigma, Real* ratio_rate) {
    const ReferenceScene* s = &w->scene;
    *sigma = s->contact_sigma;
    *ratio_rate = *force = 0.0L;
    if (s->contact == CONTACT_CONSTANT && s->limit == LIMIT_CONSTANT) {
        return;
    }
    const AtModulus at = s->E_rate == 0.0 ? w->held : at_modulus(s, (Real)s->E + s->E_rate * t);
    const Real theta = phase_at(w, t) + s->phase_d;
    const Real swing = s->a_d == 0.0 ? 0.0L : s->a_d * sine(theta, 1);
    Real d, rest_rate;
    if (s->input == INPUT_LOAD) {
        const Real load = (Real)s->load + s->load_rate * t;
        *force = load / w->swell * expl(-w->decay * swing);
        d = logl(at.force * w->swell / load) / w->decay + swing;
        rest_rate = (at.by_force * s->E_rate - s->load_rate / load) / w->decay;
    } else {
        d = (Real)s->d + s->d_rate * t + swing;
        *force = at.force * expl(-w->decay * d);
        rest_rate = s->d_rate;
    }
    const Real over_force = *force / at.force;
    if (s->contact == CONTACT_ASPERITIES) {
        *sigma = at.stiffness * over_force * over_force / (d * d * d);
    } else if (s->contact == CONTACT_MINDLIN) {
        *sigma = at.stiffness * over_force;
    }
    if (with_rates) {
        const Real d_rate = rest_rate - (s->a_d == 0.0 ? 0.0L : s->a_d * w->omega * sine(theta, 0));
        Real of_E = s->limit == LIMIT_LOAD ? at.by_force : 0.0L;
        Real of_d = s->limit == LIMIT_LOAD ? -w->decay : 0.0L;
        if (s->contact == CONTACT_ASPERITIES) {
            of_E -= at.by_stiffness;
            of_d += 2.0L * w->decay + 3.0L / d;
        } else if (s->contact == CONTACT_MINDLIN) {
            of_E -= at.by_stiffness;
            of_d += w->decay;
        }
        *ratio_rate = of_E * s->E_rate + of_d * d_rate;
    }
}

static At scene_at(const World* w, Real t, bool with_rates) {
    const ReferenceScene* s = &w->scene;
    At at = {.V = velocity(w, t)};
    Real force;
    contact_at(w, t, with_rates, &force, &at.sigma, &at.bound_rate);
    at.coulomb = s->limit == LIMIT_LOAD ? s->mu * force : s->F_C;
    Real curve = 1.0L, curve_rate = 0.0L;
    if (w->excess != 0.0L) {
        const Real slow = at.V / s->V_S;
        const Real peak = w->excess * expl(-slow * slow);
        curve = 1.0L + peak;
        if (with_rates) {
            at.V_rate = velocity_rate(w, t);
            curve_rate = -2.0L * peak * slow * at.V_rate / (s->V_S * curve);
        }
    }
    at.g = at.coulomb * curve;
    if (s->law == LAW_ELASTIC_PLASTIC) {
        at.B = at.g;
        at.bound_rate += curve_rate;
    } else {
        at.B = at.coulomb * (1.0L + w->excess);
    }
    return at;
}

// -d(delta') / d(delta) [1/s] with |V| = side V, which holds between reversals.
static Real relaxation(const World* w, const At* at, int side) {
    return w->scene.law == LAW_ELASTIC_PLASTIC ? 0.0L : at->sigma * (Real)side * at->V / at->g;
}

static Real bound_rate(const At* at) { return at->B / at->sigma * at->bound_rate; }

// How fast [m/s] the law alone would carry a bristle that lies on the bound of this side beyond it.
static Real outward(const World* w, Real t, int side) {
    const At at = scene_at(w, t, true);
    const Real forward = (Real)side * at.V;
    if (w->scene.law == LAW_ELASTIC_PLASTIC) {
        return forward - bound_rate(&at);
    }
    const Real over = at.B / at.g; // at least 1
    const Real own = forward > 0.0L ? forward * (1.0L - over) : forward * (1.0L + over);
    return own - bound_rate(&at);
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
    Real limit;   // N s, integral of F_C or mu F_n
    Real peak;    // N, largest |sigma delta|
    // What errors of these are measured by: the length is that at the end, or what is kept of a longer one.
    Real length, force, power;
    Real blur; // m, of delta at the end by the rounding of time
} Sums;

static void add(Sums* sums, const Sums* part) {
    sums->end = part->end;
    sums->change += part->change;
    sums->impulse += part->impulse;
    sums->work += part->work;
    sums->heat += part->heat;
    sums->limit += part->limit;
    sums->length = part->length;
    sums->blur = part->blur;
    sums->peak = fmaxl(sums->peak, part->peak);
    sums->force += part->force;
    sums->power += part->power;
}

// Solves A x = b in place for two right sides, pivoting by columns.
static void solve(int n, Real A[MOST_STAGES][MOST_STAGES], Real b[MOST_STAGES][2]) {
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k + 1; i < n; i++) {
            if (fabsl(A[i][k]) > fabsl(A[best][k])) {
                best = i;
            }
        }
        for (int j = k; best != k && j < n; j++) {
            const Real kept = A[k][j];
            A[k][j] = A[best][j];
            A[best][j] = kept;
        }
        for (int c = 0; best != k && c < 2; c++) {
            const Real kept = b[k][c];
            b[k][c] = b[best][c];
            b[best][c] = kept;
        }
        for (int i = k + 1; i < n; i++) {
            const Real factor = A[i][k] / A[k][k];
            for (int j = k + 1; j < n; j++) {
                A[i][j] -= factor * A[k][j];
            }
            b[i][0] -= factor * b[k][0];
            b[i][1] -= factor * b[k][1];
        }
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int c = 0; c < 2; c++) {
            for (int j = i + 1; j < n; j++) {
                b[i][c] -= A[i][j] * b[j][c];
            }
            b[i][c] /= A[i][i];
        }
    }
}

static void account(const World* w, Sums* sums, const At* at, Real delta, Real rate, Real time) {
    const ReferenceScene* s = &w->scene;
    const Real spring = at->sigma * delta;
    const Real damping = s->sigma_1 * rate, viscous = s->sigma_2 * at->V;
    const Real force = spring + damping + viscous;
    sums->impulse += time * (spring + viscous);
    sums->work += time * force * at->V;
    sums->heat += time * (spring * (at->V - rate) + (damping + viscous) * at->V);
    sums->limit += time * at->coulomb;
    sums->force += time * (fabsl(spring) + fabsl(viscous) + at->coulomb);
    sums->power += time * (fabsl(spring) + fabsl(damping) + fabsl(viscous) + at->coulomb) *
                   (fabsl(at->V) + (spring == 0.0L ? 0.0L : fabsl(rate)));
    sums->peak = fmaxl(sums->peak, fabsl(spring));
}

// What moves on a stretch between cuts: V has one sign; the bristle is free, or slips along the bound of a side.
typedef struct {
    int sign; // of V
    int slip; // 0, +1, -1
} Motion;

static Sums panel(World* w, const Motion* motion, Real a, Real b, Real delta) {
    const Rule* rule = w->rule;
    const int n = rule->stages;
    const Real size = b - a;
    Sums sums = {0};
    At at[MOST_STAGES];
    Real r[MOST_STAGES], rate[MOST_STAGES] = {0}, at_delta[MOST_STAGES] = {0};
    bool relaxes = false;
    for (int i = 0; i < n; i++) {
        at[i] = scene_at(w, a + size * rule->node[i], motion->slip != 0);
        r[i] = motion->slip ? 0.0L : relaxation(w, &at[i], motion->sign);
        relaxes = relaxes || r[i] != 0.0L;
    }
    if (motion->slip) {
        for (int i = 0; i < n; i++) {
            at_delta[i] = (Real)motion->slip * at[i].B / at[i].sigma;
            rate[i] = (Real)motion->slip * bound_rate(&at[i]);
        }
        sums.change = at_delta[n - 1] - delta;
    } else {
        // Both the change Y of delta, Y_i = size sum_j to_ij (V_j - r_j delta - r_j Y_j), and delta itself,
        // delta_i = delta + size sum_j to_ij (V_j - r_j delta_j): what is the smaller has the more digits.
        Real A[MOST_STAGES][MOST_STAGES], Y[MOST_STAGES][2];
        for (int i = 0; i < n; i++) {
            Y[i][0] = 0.0L;
            Y[i][1] = delta;
            for (int j = 0; j < n; j++) {
                const Real weight = size * rule->to[i][j];
                Y[i][0] += weight * (at[j].V - r[j] * delta);
                Y[i][1] += weight * at[j].V;
                A[i][j] = (i == j ? 1.0L : 0.0L) + weight * r[j];
            }
        }
        if (relaxes) {
            solve(n, A, Y);
        }
        for (int i = 0; i < n; i++) {
            at_delta[i] = fabsl(Y[i][0]) < fabsl(Y[i][1]) ? delta + Y[i][0] : Y[i][1];
            rate[i] = at[i].V - r[i] * at_delta[i];
        }
        sums.change = Y[n - 1][0];
    }
    sums.end = at_delta[n - 1];
    Real relaxed = 0.0L, longest = fabsl(delta), fastest = 0.0L;
    for (int i = 0; i < n; i++) {
        relaxed += size * rule->weight[i] * r[i];
        longest = fmaxl(longest, fabsl(at_delta[i]));
        fastest = fmaxl(fastest, fabsl(rate[i]));
    }
    sums.blur = fastest * expl(-relaxed) * 2.0L * LDBL_EPSILON * b;
    sums.length = fmaxl(longest * expl(-relaxed), fmaxl(fabsl(sums.end), at[n - 1].g / at[n - 1].sigma));
    for (int i = 0; i < n; i++) {
        account(w, &sums, &at[i], at_delta[i], rate[i], size * rule->weight[i]);
    }
    sums.impulse += w->scene.sigma_1 * sums.change;
    sums.force += w->scene.sigma_1 * fabsl(sums.change);
    w->panels += 1.0L;
    return sums;
}

static const Real AGREE = 1e-15L; // the halves are then right to some 1e-18
static const int DEEPEST = 110;
static const Real MOST_PANELS = 2e5L; // from there on panels are taken as they come, which `unresolved` tells

// Below this share of what the panel's mean force would do over the whole step lies the rounding of time.
static const Real LEAST = 1e-17L;

// Whether a panel of this size [s] and its halves give the same.
static bool agree(const World* w, const Sums* one, const Sums* two, Real size) {
    const Real force = LEAST * two->force / size;
    const Real impulse = AGREE * two->force + force * w->h, energy = AGREE * two->power + force * w->path;
    return fabsl(one->end - two->end) <= AGREE * two->length + two->blur &&
           fabsl(one->impulse - two->impulse) <= impulse && fabsl(one->limit - two->limit) <= impulse &&
           fabsl(one->work - two->work) <= energy && fabsl(one->heat - two->heat) <= energy;
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
    bool watch[2]; // whether the bound of the side +1, -1 may be met
    int met;       // the side that was met, or 0
    Real met_at;   // when
    Real changed;  // when the motion last changed between free and slip
} March;

static Real gap(const World* w, Real t, Real delta, int side) {
    const At at = scene_at(w, t, false);
    return at.B / at.sigma - (Real)side * delta;
}

static int side_met(const March* march, Real t, Real delta) {
    for (int k = 0; k < 2; k++) {
        const int side = k == 0 ? 1 : -1;
        if (march->watch[k] && gap(march->w, t, delta, side) < 0.0L) {
            return side;
        }
    }
    return 0;
}

static void commit(March* march, const Sums* part) {
    add(&march->sums, part);
    march->delta = part->end;
}

static void go_on(March* march, const Motion* motion, Real a, Real b, const Sums* one, int depth);

// The bristle is inside its bound at a and beyond it at b: goes on to where it meets it.
static void go_to_bound(March* march, const Motion* motion, Real a, Real b, int side) {
    World* w = march->w;
    Real low = a, high = b;
    Real gap_low = gap(march->w, a, march->delta, side);
    Real gap_high = gap(march->w, b, panel(w, motion, a, b, march->delta).end, side);
    if (gap_low <= 0.0L) {
        high = a;
    }
    for (int k = 0; k < 200 && high > low; k++) {
        Real t = k % 3 == 2 ? 0.5L * (low + high) : high - gap_high * (high - low) / (gap_high - gap_low);
        if (!(t > low && t < high)) {
            t = 0.5L * (low + high);
        }
        if (!(t > low && t < high)) {
            break;
        }
        const Real found = gap(march->w, t, panel(w, motion, a, t, march->delta).end, side);
        if (found == 0.0L) {
            low = high = t;
        } else if (found < 0.0L) {
            high = t;
            gap_high = found;
            gap_low *= 0.5L;
        } else {
            low = t;
            gap_low = found;
            gap_high *= 0.5L;
        }
    }
    march->met = side;
    march->met_at = high;
    if (march->met_at > a) {
        const bool kept[2] = {march->watch[0], march->watch[1]};
        march->watch[0] = march->watch[1] = false;
        const Sums last = panel(w, motion, a, march->met_at, march->delta);
        march->met = 0;
        go_on(march, motion, a, march->met_at, &last, 0);
        march->met = side;
        march->watch[0] = kept[0];
        march->watch[1] = kept[1];
    }
}

// Over [a, b], of which one is the sum of a single panel, by halves until they agree with the whole; a bristle that is free
// stops where it meets a bound.
static void go_on(March* march, const Motion* motion, Real a, Real b, const Sums* one, int depth) {
    World* w = march->w;
    const Real middle = 0.5L * (a + b);
    const Sums left = panel(w, motion, a, middle, march->delta);
    const Sums right = panel(w, motion, middle, b, left.end);
    Sums two = left;
    add(&two, &right);
    const bool smallest = is_smallest(w, a, b, depth);
    if (!agree(w, one, &two, b - a) && !smallest) {
        go_on(march, motion, a, middle, &left, depth + 1);
        if (!march->met) {
            const Sums again = motion->slip ? right : panel(w, motion, middle, b, march->delta);
            go_on(march, motion, middle, b, &again, depth + 1);
        }
        return;
    }
    if (smallest) {
        w->unresolved += 1.0L;
    }
    const int side_left = motion->slip ? 0 : side_met(march, middle, left.end);
    if (side_left) {
        go_to_bound(march, motion, a, middle, side_left);
        return;
    }
    const int side_right = motion->slip ? 0 : side_met(march, b, two.end);
    commit(march, &left);
    if (side_right) {
        go_to_bound(march, motion, middle, b, side_right);
        return;
    }
    commit(march, &right);
}

// ---------------------------------------------------------------------------------------------------------------------
// Cuts of the step
// ---------------------------------------------------------------------------------------------------------------------

typedef struct {
    Real* time;
    size_t count, room;
} Cuts;

static void cut(Cuts* cuts, Real t) {
    if (cuts->count == cuts->room) {
        cuts->room = cuts->room ? 2 * cuts->room : 256;
        Real* grown = realloc(cuts->time, cuts->room * sizeof *grown);
        if (grown == NULL) {
            abort();
        }
        cuts->time = grown;
    }
    cuts->time[cuts->count++] = t;
}

static int by_time(const void* a, const void* b) {
    const Real x = *(const Real*)a, y = *(const Real*)b;
    return (x > y) - (x < y);
}

// Sorted, without repetition, inside [0, h].
static void tidy(Cuts* cuts, Real h) {
    qsort(cuts->time, cuts->count, sizeof *cuts->time, by_time);
    size_t kept = 0;
    for (size_t k = 0; k < cuts->count; k++) {
        const Real t = cuts->time[k];
        if (t >= 0.0L && t <= h && (kept == 0 || t > cuts->time[kept - 1])) {
            cuts->time[kept++] = t;
        }
    }
    cuts->count = kept;
}

typedef Real Function(const World* w, Real t, Real shift, int side);

static Real root(const World* w, Function* function, Real shift, int side, Real low, Real high) {
    const bool rising = function(w, high, shift, side) > 0.0L;
    for (int k = 0; k < 90; k++) {
        const Real middle = 0.5L * (low + high);
        if (!(middle > low && middle < high)) {
            break;
        }
        if ((function(w, middle, shift, side) > 0.0L) == rising) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return rising ? high : low;
}

static Real velocity_less(const World* w, Real t, Real shift, int side) {
    (void)side;
    return velocity(w, t) - shift;
}

static Real outward_less(const World* w, Real t, Real shift, int side) { return outward(w, t, side) - shift; }

// Where dV/dt = 0, where the vibration turns, and equal pieces in between.
static void cut_at_bends(const World* w, Cuts* cuts) {
    const ReferenceScene* s = &w->scene;
    const int pieces = 8 * w->fineness;
    cut(cuts, 0.0L);
    cut(cuts, w->h);
    for (int k = 1; k < pieces; k++) {
        cut(cuts, w->h * (Real)k / (Real)pieces);
    }
    if (s->V_1 == 0.0 && s->a_d == 0.0) {
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
    static const Real MULTIPLES[] = {0.125L, 0.25L, 0.5L, 0.75L, 1.0L, 1.5L, 2.0L,
                                     3.0L,   4.0L,  5.0L, 6.5L,  8.0L, 10.0L};
    const size_t count = cuts->count;
    for (size_t k = 0; k + 1 < count; k++) {
        const Real a = cuts->time[k], b = cuts->time[k + 1];
        const Real V_a = velocity(w, a), V_b = velocity(w, b);
        if (V_a * V_b < 0.0L) {
            cut(cuts, root(w, velocity_less, 0.0L, 0, a, b));
        }
        for (size_t m = 0; w->excess != 0.0L && m < sizeof MULTIPLES / sizeof *MULTIPLES; m++) {
            for (int sign = -1; sign <= 1; sign += 2) {
                const Real level = (Real)sign * MULTIPLES[m] * w->scene.V_S;
                if ((V_a - level) * (V_b - level) < 0.0L) {
                    cut(cuts, root(w, velocity_less, level, 0, a, b));
                }
            }
        }
    }
}

// Cuts at the zeros of a function between a and b that the samples at the ends of cells show, also where it only just
// passes zero between two of them: the extreme next to a sample is searched.
static void cut_at_zeros(const World* w, Cuts* cuts, int side, Real a, Real b) {
    const int cells = 12 * w->fineness;
    Real before = 0.0L, t_before = a, here = outward(w, a, side), t_here = a;
    for (int k = 1; k <= cells; k++) {
        const Real t = k == cells ? b : 0.5L * (a + b) - 0.5L * (b - a) * cosl(PI * (Real)k / (Real)cells);
        const Real next = outward(w, t, side);
        if (here * next < 0.0L) {
            cut(cuts, root(w, outward_less, 0.0L, side, t_here, t));
        } else if (k >= 2 && here * before > 0.0L && fabsl(here) <= fabsl(before) &&
                   fabsl(here) <= fabsl(next)) {
            // a local least of |outward| next to the middle sample: golden section
            Real low = t_before, high = t;
            for (int i = 0; i < 60; i++) {
                const Real x = low + 0.381966L * (high - low), y = high - 0.381966L * (high - low);
                const Real at_x = outward(w, x, side), at_y = outward(w, y, side);
                if (at_x * here < 0.0L || at_y * here < 0.0L) {
                    const Real inside = at_x * here < 0.0L ? x : y;
                    cut(cuts, root(w, outward_less, 0.0L, side, low, inside));
                    cut(cuts, root(w, outward_less, 0.0L, side, inside, high));
                    break;
                }
                if (fabsl(at_x) < fabsl(at_y)) {
                    high = y;
                } else {
                    low = x;
                }
            }
        }
        before = here;
        t_before = t_here;
        here = next;
        t_here = t;
    }
}

static Cuts all_cuts(const World* w) {
    Cuts cuts = {0};
    const ReferenceScene* s = &w->scene;
    cut_at_bends(w, &cuts);
    tidy(&cuts, w->h);
    cut_at_velocities(w, &cuts);
    if (s->load_rate != 0.0 || s->E_rate != 0.0 || s->d_rate != 0.0) {
        // a load or a modulus may fall by decades toward the end, or rise by as much from the start
        for (int k = 1; k <= 30; k++) {
            cut(&cuts, ldexpl(w->h, -k));
            cut(&cuts, w->h - ldexpl(w->h, -k));
        }
    }
    tidy(&cuts, w->h);
    if (w->bounded) {
        const size_t count = cuts.count;
        for (size_t k = 0; k + 1 < count; k++) {
            cut_at_zeros(w, &cuts, 1, cuts.time[k], cuts.time[k + 1]);
            cut_at_zeros(w, &cuts, -1, cuts.time[k], cuts.time[k + 1]);
        }
        tidy(&cuts, w->h);
    }
    return cuts;
}

// ---------------------------------------------------------------------------------------------------------------------
// The step
// ---------------------------------------------------------------------------------------------------------------------

static Real whole_path(const World* w) {
    World still = *w; // Stribeck's curve and the bound ask for cuts that the path needs not
    still.excess = 0.0L;
    still.bounded = false;
    Cuts cuts = all_cuts(&still);
    Real path = 0.0L;
    for (size_t k = 0; k + 1 < cuts.count; k++) {
        path += fabsl(travel(w, cuts.time[k], cuts.time[k + 1]));
    }
    free(cuts.time);
    return path;
}

static World make_world(const ReferenceScene* scene, int fineness) {
    World w = {.scene = *scene, .h = scene->h, .fineness = fineness};
    const bool bristle = scene->law == LAW_DAHL || scene->law == LAW_LUGRE;
    w.bounded = scene->law == LAW_ELASTIC_PLASTIC || (bristle && scene->binds && scene->limit == LIMIT_LOAD);
    w.excess =
        scene->law == LAW_LUGRE || scene->law == LAW_ELASTIC_PLASTIC ? (Real)scene->staticRatio - 1.0L : 0.0L;
    w.omega = 2.0L * PI * scene->f;
    // f start, of which whole numbers are taken off, exactly: the product and what it loses in rounding
    const double cycles = scene->f * scene->start;
    const double lost = fma(scene->f, scene->start, -cycles);
    w.theta_0 = 2.0L * PI * ((Real)(cycles - floor(cycles)) + lost);
    w.V_start = (Real)scene->V + scene->V_1 * sine(w.theta_0, 1);
    w.decay = (Real)scene->lambda / scene->R_q;
    w.swell = bessel_I0(w.decay * scene->a_d);
    w.held = at_modulus(scene, scene->E);
    w.rule = rule_of(fineness == 1 ? 10 : 12);
    w.path = whole_path(&w);
    return w;
}

static Real inside_bound(const World* w, Real delta) {
    if (!w->bounded) {
        return delta;
    }
    const At at = scene_at(w, 0.0L, false);
    const Real bound = at.B / at.sigma;
    return fminl(fmaxl(delta, -bound), bound);
}

static int sign_of(Real x) { return (x > 0.0L) - (x < 0.0L); }

// Marches over the step from delta; returns the side along which the bristle slips at the end.
static int march_over(World* w, Real delta, March* march) {
    *march = (March){.w = w, .delta = inside_bound(w, delta), .changed = -1.0L};
    Cuts cuts = all_cuts(w);
    int slip = 0;
    if (w->bounded) {
        const At at = scene_at(w, 0.0L, false);
        march->sums.heat = 0.5L * at.sigma * (delta - march->delta) * (delta + march->delta);
        slip = fabsl(delta) >= at.B / at.sigma ? sign_of(delta) : 0;
    }
    for (size_t k = 0; k + 1 < cuts.count; k++) {
        Real a = cuts.time[k];
        const Real b = cuts.time[k + 1], middle = 0.5L * (a + b);
        Motion motion = {.sign = sign_of(velocity(w, middle))};
        march->watch[0] = w->bounded && outward(w, middle, 1) > 0.0L;
        march->watch[1] = w->bounded && outward(w, middle, -1) > 0.0L;
        march->met = 0;
        if (slip && !march->watch[slip == 1 ? 0 : 1]) {
            slip = 0;
            march->changed = a;
        }
        if (!slip) {
            const Sums one = panel(w, &motion, a, b, march->delta);
            go_on(march, &motion, a, b, &one, 0);
            slip = march->met;
            march->met = 0;
            if (slip) {
                march->changed = a = march->met_at;
            }
        }
        if (slip && a < b) {
            motion.slip = slip;
            const Sums one = panel(w, &motion, a, b, march->delta);
            go_on(march, &motion, a, b, &one, 0);
        }
    }
    free(cuts.time);
    return slip;
}

static Real force_at(const World* w, Real t, Real delta, int slip) {
    const ReferenceScene* s = &w->scene;
    const At at = scene_at(w, t, true);
    Real rate = at.V - relaxation(w, &at, sign_of(at.V)) * delta;
    if (slip) {
        rate = (Real)slip * bound_rate(&at);
    }
    return at.sigma * delta + s->sigma_1 * rate + s->sigma_2 * at.V;
}

// The deflection at the start that the periodic state of held inputs has, without vibration the one of sliding for ever.
typedef struct {
    Real delta;       // m
    int slip;         // side along which it slips at the end of a period, or 0
    Real slips_since; // s
} Settled;

static Settled settled(const World* w) {
    const ReferenceScene* s = &w->scene;
    const Real delta_0 = inside_bound(w, s->delta_0);
    if (s->V_1 == 0.0 && s->a_d == 0.0) {
        const At at = scene_at(w, 0.0L, false);
        const int side = sign_of(s->V);
        return side == 0 ? (Settled){.delta = delta_0}
                         : (Settled){(Real)side * at.g / at.sigma, w->bounded ? side : 0, INFINITY};
    }
    World period = *w;
    period.h = 2.0L * PI / w->omega;
    period.scene.V_rate = period.scene.d_rate = period.scene.E_rate = period.scene.load_rate = 0.0;
    period.path = whole_path(&period);
    const At at = scene_at(&period, 0.0L, false);
    March march;
    Real delta = delta_0;
    if (s->law == LAW_ELASTIC_PLASTIC) {
        if (s->V != 0.0) {
            delta = (Real)sign_of(s->V) * at.B / at.sigma;
        }
    } else if (s->V != 0.0 || s->V_1 != 0.0) {
        // without the bound a period maps delta to kept delta + from_rest
        period.bounded = false;
        march_over(&period, 0.0L, &march);
        const Real from_rest = march.delta, change = march.sums.change;
        delta = at.g / at.sigma;
        for (int k = 0; k < 3; k++) { // once would do but for rounding
            march_over(&period, delta, &march);
            const Real kept = (march.delta - from_rest) / delta;
            // where little relaxes the changes have the digits, else the ends
            delta = kept > 0.99L ? delta * change / (change - march.sums.change) : from_rest / (1.0L - kept);
        }
        period.bounded = w->bounded;
    }
    if (!w->bounded) {
        return (Settled){.delta = delta};
    }
    // Clamped affine maps have their fixed point where the clamp puts that of the affine map.
    const int slip = march_over(&period, delta, &march);
    return (Settled){march.delta, slip, period.h - march.changed};
}

// F_C, or mu times the mean of F_n over a period of the vibration with the inputs of a time [N].
static Real mean_limit(const World* w, Real t) {
    const ReferenceScene* s = &w->scene;
    if (s->limit == LIMIT_CONSTANT) {
        return s->F_C;
    }
    if (s->input == INPUT_LOAD) {
        return s->mu * ((Real)s->load + s->load_rate * t);
    }
    const AtModulus at = at_modulus(s, (Real)s->E + s->E_rate * t);
    return s->mu * at.force * w->swell * expl(-w->decay * ((Real)s->d + s->d_rate * t));
}

// limit is the time mean of the limit over the step [N].
static double force_scale(const World* w, double limit) {
    const Real at_start = mean_limit(w, 0.0L);
    return fmin((double)at_start, fmax(limit, (double)fminl(at_start, mean_limit(w, w->h))));
}

static void step_of_coulomb(World* w, ReferenceStep* result) {
    // F = sgn V: an ElasticPlastic bristle that slips for ever, without a force of its own.
    const ReferenceScene* s = &w->scene;
    Cuts cuts = all_cuts(w);
    Real impulse = 0.0L, work = 0.0L, limit = 0.0L;
    for (size_t k = 0; k + 1 < cuts.count; k++) {
        const Real a = cuts.time[k], b = cuts.time[k + 1];
        const int pieces = 4 * w->fineness;
        const Real sign = (Real)sign_of(velocity(w, 0.5L * (a + b)));
        for (int p = 0; p < pieces; p++) {
            const Real size = (b - a) / (Real)pieces, begin = a + size * (Real)p;
            for (int i = 0; i < w->rule->stages; i++) {
                const At at = scene_at(w, begin + size * w->rule->node[i], false);
                const Real time = size * w->rule->weight[i], force = sign * at.coulomb + s->sigma_2 * at.V;
                impulse += time * force;
                work += time * force * at.V;
                limit += time * at.coulomb;
            }
        }
    }
    free(cuts.time);
    const At end = scene_at(w, w->h, false);
    result->F_t = (double)((Real)sign_of(end.V) * end.coulomb + s->sigma_2 * end.V);
    const At start = scene_at(w, 0.0L, false);
    result->F_t_start = (double)((Real)sign_of(start.V) * start.coulomb + s->sigma_2 * start.V);
    // at a reversal either sign will do
    const bool turns = fabsl(end.V) <= 1e-13L * (fabsl((Real)s->V) + fabsl((Real)s->V_1));
    result->F_t_other = turns ? -result->F_t : result->F_t;
    result->gap = turns ? 0.0 : INFINITY;
    const bool starts_turning = fabsl(start.V) <= 1e-13L * (fabsl((Real)s->V) + fabsl((Real)s->V_1));
    result->F_t_start_other = starts_turning ? -result->F_t_start : result->F_t_start;
    result->gap_start = starts_turning ? 0.0 : INFINITY;
    result->sigma = (double)end.sigma;
    result->delta = result->delta_start = s->delta_0;
    result->F_t_mean = (double)(impulse / w->h);
    result->work = result->heat = (double)work;
    result->limit = (double)(limit / w->h);
    result->scale = force_scale(w, result->limit);
    result->largest = (double)end.coulomb;
}

ReferenceScene reference_scene(void) {
    return (ReferenceScene){.V = 0.005,
                            .d = 14e-6,
                            .E = 58.556936170e9,
                            .load = 312.44,
                            .f = 20e3,
                            .F_C = 55.0,
                            .mu = 0.176,
                            .staticRatio = 1.0,
                            .V_S = 0.01,
                            .contact_sigma = 2.5e6,
                            .stiffnessScale = 1.0,
                            .R_q = 6e-6,
                            .R = 1.7e-6,
                            .eta = 47e9,
                            .A_n = 1e-4,
                            .nu = 0.33,
                            .Y = 410e6,
                            .c = 17.0,
                            .lambda = 3.0,
                            .h = 1e-4,
                            .law = LAW_DAHL,
                            .limit = LIMIT_CONSTANT,
                            .contact = CONTACT_ASPERITIES,
                            .input = INPUT_SEPARATION,
                            .initial = START_GIVEN,
                            .binds = 1};
}

// What a bristle at a time does to F_t, and would do on the other side of a jump: slipping, or not.
typedef struct {
    Real force, other; // N
    Real gap;          // N, from that jump; what it has slipped is the way back
} AtJump;

// slip is the side along which the bristle slips, since so long [s]; 0 where it is free.
static AtJump force_near_jump(const World* w, Real t, Real delta, int slip, Real slips_since) {
    const int side = sign_of(delta);
    AtJump at = {.force = force_at(w, t, delta, slip), .gap = INFINITY};
    at.other = at.force;
    if (!w->bounded || side == 0) {
        return at;
    }
    const Real sigma = scene_at(w, t, false).sigma, leaves = outward(w, t, side);
    if (slip) {
        at.other = force_at(w, t, delta, 0);
        at.gap = sigma * fmaxl(0.0L, leaves) * slips_since;
    } else if (leaves > 0.0L) {
        at.other = force_at(w, t, delta, side);
        at.gap = sigma * fmaxl(0.0L, gap(w, t, delta, side));
    }
    return at;
}

// With held inputs. A start that is given slips where it cannot be told from its bound.
static AtJump force_at_start(const World* w, const Settled* start) {
    World held = *w;
    held.scene.V_rate = held.scene.d_rate = held.scene.E_rate = held.scene.load_rate = 0.0;
    int slip = start->slip;
    const int side = sign_of(start->delta);
    if (slip == 0 && w->bounded && side != 0 && outward(&held, 0.0L, side) > 0.0L &&
        gap(&held, 0.0L, start->delta, side) <= 1e-17L * fabsl(start->delta)) {
        slip = side;
    }
    return force_near_jump(&held, 0.0L, start->delta, slip, start->slips_since);
}

void reference_step(const ReferenceScene* scene, int fineness, ReferenceStep* result) {
    World w = make_world(scene, fineness);
    *result = (ReferenceStep){.path = (double)w.path, .changed = -1.0};
    if (scene->law == LAW_COULOMB) {
        step_of_coulomb(&w, result);
        return;
    }
    Settled from = {.delta = scene->delta_0};
    if (scene->initial == START_SETTLED) {
        from = settled(&w);
    }
    const Real delta = from.delta;
    from.delta = inside_bound(&w, delta);
    March march;
    const int slip = march_over(&w, delta, &march);
    result->delta_start = (double)from.delta;
    const AtJump starts = force_at_start(&w, &from);
    result->F_t_start = (double)starts.force;
    result->F_t_start_other = (double)starts.other;
    result->gap_start = (double)starts.gap;
    const AtJump at_end = force_near_jump(&w, w.h, march.delta, slip, w.h - march.changed);
    result->delta = (double)march.delta;
    result->F_t = (double)at_end.force;
    result->F_t_other = (double)at_end.other;
    result->gap = (double)at_end.gap;
    result->sigma = (double)scene_at(&w, w.h, false).sigma;
    result->F_t_mean = (double)(march.sums.impulse / w.h);
    result->work = (double)march.sums.work;
    result->heat = (double)march.sums.heat;
    result->limit = (double)(march.sums.limit / w.h);
    result->scale = force_scale(&w, result->limit);
    const At at_start = scene_at(&w, 0.0L, false);
    result->largest = (double)fmaxl(march.sums.peak, at_start.sigma * fabsl(from.delta));
    result->changed = (double)march.changed;
    result->panels = (double)w.panels;
    result->unresolved = (double)w.unresolved;
}

void reference_frame(const ReferenceScene* scene, ReferenceStep* frame) {
    const World w = make_world(scene, 1);
    *frame = (ReferenceStep){.path = (double)w.path,
                             .sigma = (double)scene_at(&w, w.h, false).sigma,
                             .scale = force_scale(&w, 0.0),
                             .largest = (double)(scene_at(&w, 0.0L, false).sigma * fabsl(scene->delta_0)),
                             .gap = INFINITY,
                             .gap_start = INFINITY};
}
