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
    Real no_load;   // s, when a load that moves is 0
    AtModulus held; // at the modulus of the start
    bool bounded;   // sigma |delta| of Dahl or LuGre has a bound B
    bool open_ends; // a bristle is taken as if it had no bound: for the map of a period that touches none
    Real S;         // N
    Real path;      // m, integral of |V| over the step
    const Rule* rule;
    int fineness;
    Real panels;
} World;

// At a local time; rates are time derivatives of logarithms, found only when they are asked for.
typedef struct {
    Real V;
    Real sigma;
    Real coulomb;                  // N, F_C or mu F_n
    Real g;                        // N, where the bristle's force tends
    Real B;                        // N, the bound of what does not slip
    Real bound_rate, kinetic_rate; // of ln(B / sigma), ln(g / sigma)
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

static int sign_of(Real x) { return (x > 0.0L) - (x < 0.0L); }

static Real phase_at(const World* w, Real t) { return w->theta_0 + w->omega * t; }

static bool vibrates(const ReferenceScene* s) { return s->V_1 != 0.0 || s->a_d != 0.0; }

static bool is_held(const ReferenceScene* s) {
    return s->V_rate == 0.0 && s->d_rate == 0.0 && s->E_rate == 0.0 && s->load_rate == 0.0;
}

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
    return smooth + 2.0L * w->scene.V_1 / w->omega * sine(phase_at(w, a) + half, 1) * sinl(half);
}

static Real load_at(const World* w, Real t) {
    return w->no_load > -INFINITY ? w->scene.load_rate * (t - w->no_load)
                                  : (Real)w->scene.load + w->scene.load_rate * t;
}

static AtModulus modulus_at(const World* w, Real t) {
    return w->scene.E_rate == 0.0 ? w->held : at_modulus(&w->scene, (Real)w->scene.E + w->scene.E_rate * t);
}

// sigma [N/m] where F_n and d are those.
static Real stiffness_at(const ReferenceScene* s, const AtModulus* at, Real force, Real d) {
    const Real share = force / at->force;
    return s->contact == CONTACT_CONSTANT  ? (Real)s->contact_sigma
           : s->contact == CONTACT_MINDLIN ? at->stiffness * share
                                           : at->stiffness * share * share / (d * d * d);
}

// F_n [N] and sigma [N/m]; the rate of ln(limit / sigma), but for Stribeck's curve, without what cancels in it.
static void contact_at(const World* w, Real t, bool with_rates, Real* force, Real* sigma, Real* ratio_rate) {
    const ReferenceScene* s = &w->scene;
    *sigma = s->contact_sigma;
    *ratio_rate = *force = 0.0L;
    if (s->contact == CONTACT_CONSTANT && s->limit == LIMIT_CONSTANT) {
        return;
    }
    const AtModulus at = modulus_at(w, t);
    const Real theta = phase_at(w, t) + s->phase_d;
    const Real swing = s->a_d == 0.0 ? 0.0L : s->a_d * sine(theta, 1);
    Real d, rest_rate;
    if (s->input == INPUT_LOAD) {
        const Real load = load_at(w, t);
        *force = load / w->swell * expl(-w->decay * swing);
        d = logl(at.force * w->swell / load) / w->decay + swing;
        rest_rate = (at.by_force * s->E_rate - s->load_rate / load) / w->decay;
    } else {
        d = (Real)s->d + s->d_rate * t + swing;
        *force = at.force * expl(-w->decay * d);
        rest_rate = s->d_rate;
    }
    *sigma = stiffness_at(s, &at, *force, d);
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
    at.kinetic_rate = at.bound_rate;
    at.coulomb = s->limit == LIMIT_LOAD ? s->mu * force : s->F_C;
    Real curve = 1.0L;
    if (w->excess != 0.0L) {
        const Real slow = at.V / s->V_S, peak = w->excess * expl(-slow * slow);
        curve = 1.0L + peak;
        if (with_rates) {
            at.kinetic_rate -= 2.0L * peak * slow * velocity_rate(w, t) / (s->V_S * curve);
        }
    }
    at.g = at.coulomb * curve;
    at.B = at.coulomb * (1.0L + w->excess);
    return at;
}

// -d(delta') / d(delta) [1/s] with |V| = side V, which holds between reversals.
static Real relaxation(const World* w, const At* at, int side) {
    return w->scene.law == LAW_ELASTIC_PLASTIC ? 0.0L : at->sigma * (Real)side * at->V / at->g;
}

// Where a slipping bristle lies [m], and how fast that moves [m/s].
static Real slip_bound(const World* w, const At* at) {
    return (w->scene.law == LAW_ELASTIC_PLASTIC ? at->g : at->B) / at->sigma;
}
static Real slip_rate(const World* w, const At* at) {
    return slip_bound(w, at) * (w->scene.law == LAW_ELASTIC_PLASTIC ? at->kinetic_rate : at->bound_rate);
}

// How fast [m/s] the law alone would carry a bristle that lies on the bound of this side beyond it.
static Real outward(const World* w, Real t, int side) {
    const At at = scene_at(w, t, true);
    const Real forward = (Real)side * at.V;
    if (w->scene.law == LAW_ELASTIC_PLASTIC) {
        return forward - slip_rate(w, &at);
    }
    const Real over = at.B / at.g; // at least 1
    const Real own = forward > 0.0L ? forward * (1.0L - over) : forward * (1.0L + over);
    return own - slip_rate(w, &at);
}

// The same on the bound of what sticks.
static Real static_outward(const World* w, Real t, int side) {
    const At at = scene_at(w, t, true);
    return (Real)side * at.V - at.B / at.sigma * at.bound_rate;
}

// How far [m] the bristle is inside the bound of what does not slip, and of what slips.
static Real gap(const World* w, Real t, Real delta, int side) {
    const At at = scene_at(w, t, false);
    return at.B / at.sigma - (Real)side * delta;
}
static Real kinetic_gap(const World* w, Real t, Real delta, int side) {
    const At at = scene_at(w, t, false);
    return at.g / at.sigma - (Real)side * delta;
}

// ---------------------------------------------------------------------------------------------------------------------
// Open or closed
// ---------------------------------------------------------------------------------------------------------------------

static const Real OPEN = 1e-100L; // N or N/m, of F_n and sigma without vibration, if d is given

// The bristle, or Coulomb's limit, depends on the separation.
static bool knows_contact(const ReferenceScene* s) {
    return s->limit == LIMIT_LOAD || s->contact != CONTACT_CONSTANT;
}

static bool is_open(const World* w, Real t) {
    const ReferenceScene* s = &w->scene;
    if (!knows_contact(s)) {
        return false;
    }
    if (s->input == INPUT_LOAD) {
        return !(load_at(w, t) > 0.0L);
    }
    const AtModulus at = modulus_at(w, t);
    const Real d = (Real)s->d + s->d_rate * t, force = at.force * expl(-w->decay * d);
    return force < OPEN || stiffness_at(s, &at, force, d) < OPEN;
}

// The part of [0, h] in which the contact is closed; empty: from = to = h.
typedef struct {
    Real from, to;
} Closed;

static Closed closed_part(const World* w) {
    const bool at_start = is_open(w, 0.0L), at_end = is_open(w, w->h);
    if (at_start == at_end) {
        return (Closed){at_start ? w->h : 0.0L, w->h};
    }
    Real low = 0.0L, high = w->h;
    for (int k = 0; k < 200; k++) {
        const Real middle = 0.5L * (low + high);
        if (!(middle > low && middle < high)) {
            break;
        }
        *(is_open(w, middle) == at_start ? &low : &high) = middle;
    }
    return at_start ? (Closed){high, w->h} : (Closed){0.0L, low};
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
    sums->length = part->length;
    sums->blur = part->blur;
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
    sums->force += time * (fabsl(spring) + fabsl(viscous) + w->S);
    sums->power += time * (fabsl(spring) + fabsl(damping) + fabsl(viscous) + w->S) *
                   (fabsl(at->V) + (spring == 0.0L ? 0.0L : fabsl(rate)));
}

// What moves on a stretch between cuts: V has one sign; the bristle follows its law, or slips along the bound of a side.
typedef struct {
    int sign; // of V
    int slip; // 0, +1, -1
} Motion;

// The deflections at the nodes of a panel by the bristle's own law.
static void collocate(const World* w, const At* at, const Real* r, Real size, Real delta, Real* at_delta,
                      Real* change) {
    // Both the change Y of delta, Y_i = size sum_j to_ij (V_j - r_j delta - r_j Y_j), and delta itself,
    // delta_i = delta + size sum_j to_ij (V_j - r_j delta_j): what is the smaller has the more digits.
    const int n = w->rule->stages;
    Real A[MOST_STAGES][MOST_STAGES], Y[MOST_STAGES][2];
    for (int i = 0; i < n; i++) {
        Y[i][0] = 0.0L;
        Y[i][1] = delta;
        for (int j = 0; j < n; j++) {
            const Real weight = size * w->rule->to[i][j];
            Y[i][0] += weight * (at[j].V - r[j] * delta);
            Y[i][1] += weight * at[j].V;
            A[i][j] = (i == j ? 1.0L : 0.0L) + weight * r[j];
        }
    }
    solve(n, A, Y);
    for (int i = 0; i < n; i++) {
        at_delta[i] = fabsl(Y[i][0]) < fabsl(Y[i][1]) ? delta + Y[i][0] : Y[i][1];
    }
    *change = Y[n - 1][0];
}

static Sums panel(World* w, const Motion* motion, Real a, Real b, Real delta) {
    const Rule* rule = w->rule;
    const int n = rule->stages;
    const Real size = b - a;
    Sums sums = {0};
    At at[MOST_STAGES];
    Real r[MOST_STAGES] = {0}, rate[MOST_STAGES] = {0}, at_delta[MOST_STAGES] = {0};
    for (int i = 0; i < n; i++) {
        at[i] = scene_at(w, a + size * rule->node[i], motion->slip != 0);
    }
    if (motion->slip) {
        for (int i = 0; i < n; i++) {
            at_delta[i] = (Real)motion->slip * slip_bound(w, &at[i]);
            rate[i] = (Real)motion->slip * slip_rate(w, &at[i]);
        }
        sums.change = at_delta[n - 1] - delta;
    } else if (w->scene.law == LAW_ELASTIC_PLASTIC) {
        for (int i = 0; i < n; i++) {
            at_delta[i] = delta + travel(w, a, a + size * rule->node[i]);
            rate[i] = at[i].V;
        }
        sums.change = travel(w, a, b);
    } else {
        for (int i = 0; i < n; i++) {
            r[i] = relaxation(w, &at[i], motion->sign);
        }
        collocate(w, at, r, size, delta, at_delta, &sums.change);
        for (int i = 0; i < n; i++) {
            rate[i] = at[i].V - r[i] * at_delta[i];
        }
    }
    sums.end = at_delta[n - 1];
    Real relaxed = 0.0L, longest = fabsl(delta), fastest = 0.0L;
    for (int i = 0; i < n; i++) {
        relaxed += size * rule->weight[i] * r[i];
        longest = fmaxl(longest, fabsl(at_delta[i]));
        fastest = fmaxl(fastest, fabsl(rate[i]));
    }
    const Real kept = expl(-relaxed);
    sums.blur = fastest * kept * 2.0L * LDBL_EPSILON * b;
    sums.length = fmaxl(longest * kept, fmaxl(fabsl(sums.end), at[n - 1].g / at[n - 1].sigma));
    for (int i = 0; i < n; i++) {
        account(w, &sums, &at[i], at_delta[i], rate[i], size * rule->weight[i]);
    }
    sums.impulse += w->scene.sigma_1 * sums.change;
    sums.force += w->scene.sigma_1 * fabsl(sums.change);
    w->panels += 1.0L;
    return sums;
}

static const Real AGREE = 1e-13L; // the halves are then right to some 1e-17
static const int DEEPEST = 110;
static const Real MOST_PANELS = 1e6L; // more are not taken, and the step is not known

// An error in a panel is left alone when it is less than this share of the panel's mean force acting over the whole step.
static const Real LEAST = 1e-16L;

// Whether a panel of this size [s] and its halves give the same.
static bool agree(const World* w, const Sums* one, const Sums* two, Real size) {
    const Real least = w->fineness == 1 ? LEAST : 0.01L * LEAST,
               same = w->fineness == 1 ? AGREE : 0.01L * AGREE;
    const Real force = least * two->force / size;
    const Real impulse = same * two->force + force * w->h,
               energy = same * two->power + force * (w->path + two->length);
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
    bool watch[2]; // whether the bound of the side +1, -1 may be met, by a bristle of Dahl or LuGre
    int met;       // the side that was met, or 0
    Real met_at;   // when
} March;

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

static void go_over(March* march, const Motion* motion, Real a, Real b) {
    const Sums one = panel(march->w, motion, a, b, march->delta);
    go_on(march, motion, a, b, &one, 0);
}

// The bristle is inside its bound at a and beyond it at b: goes on to where it meets it.
static void go_to_bound(March* march, const Motion* motion, Real a, Real b, int side) {
    World* w = march->w;
    Real low = a, high = b;
    Real gap_low = gap(w, a, march->delta, side);
    Real gap_high = gap(w, b, panel(w, motion, a, b, march->delta).end, side);
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
        const Real found = gap(w, t, panel(w, motion, a, t, march->delta).end, side);
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
    const Real met_at = high;
    if (met_at > a) {
        const bool kept[2] = {march->watch[0], march->watch[1]};
        march->watch[0] = march->watch[1] = false;
        go_over(march, motion, a, met_at);
        march->watch[0] = kept[0];
        march->watch[1] = kept[1];
    }
    march->met = side;
    march->met_at = met_at;
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
    if (!agree(w, one, &two, b - a) && !is_smallest(w, a, b, depth)) {
        go_on(march, motion, a, middle, &left, depth + 1);
        if (!march->met) {
            const Sums again = motion->slip ? right : panel(w, motion, middle, b, march->delta);
            go_on(march, motion, middle, b, &again, depth + 1);
        }
        return;
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

// Sorted, without repetition, inside the part.
static void tidy(Cuts* cuts, Closed part) {
    qsort(cuts->time, cuts->count, sizeof *cuts->time, by_time);
    size_t kept = 0;
    for (size_t k = 0; k < cuts->count; k++) {
        const Real t = cuts->time[k];
        if (t >= part.from && t <= part.to && (kept == 0 || t > cuts->time[kept - 1])) {
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

static Real static_outward_less(const World* w, Real t, Real shift, int side) {
    return static_outward(w, t, side) - shift;
}

// Where dV/dt = 0, where the vibration turns, and equal pieces in between.
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
    static const Real MULTIPLES[] = {0.25L, 0.5L, 1.0L, 1.5L, 2.0L, 3.0L, 4.0L, 6.0L, 9.0L};
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
static void cut_at_zeros(const World* w, Cuts* cuts, Function* function, int side, Real a, Real b) {
    const int cells = 12 * w->fineness;
    Real before = 0.0L, t_before = a, here = function(w, a, 0.0L, side), t_here = a;
    for (int k = 1; k <= cells; k++) {
        const Real t = k == cells ? b : 0.5L * (a + b) - 0.5L * (b - a) * cosl(PI * (Real)k / (Real)cells);
        const Real next = function(w, t, 0.0L, side);
        if (here * next < 0.0L) {
            cut(cuts, root(w, function, 0.0L, side, t_here, t));
        } else if (k >= 2 && here * before > 0.0L && fabsl(here) <= fabsl(before) &&
                   fabsl(here) <= fabsl(next)) {
            // a local least of |function| next to the middle sample: golden section
            Real low = t_before, high = t;
            for (int i = 0; i < 60; i++) {
                const Real x = low + 0.381966L * (high - low), y = high - 0.381966L * (high - low);
                const Real at_x = function(w, x, 0.0L, side), at_y = function(w, y, 0.0L, side);
                if (at_x * here < 0.0L || at_y * here < 0.0L) {
                    const Real inside = at_x * here < 0.0L ? x : y;
                    cut(cuts, root(w, function, 0.0L, side, low, inside));
                    cut(cuts, root(w, function, 0.0L, side, inside, high));
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

// Of [0, h], or of the part in which the contact is closed.
static Cuts all_cuts(const World* w, Closed part) {
    Cuts cuts = {0};
    const ReferenceScene* s = &w->scene;
    const Real span = part.to - part.from;
    cut(&cuts, part.from);
    cut(&cuts, part.to);
    cut_at_bends(w, &cuts);
    if (s->load_rate != 0.0 || s->E_rate != 0.0 || s->d_rate != 0.0) {
        // a load may fall by decades toward the end, or rise by as much from the start
        for (int k = 1; k <= 60; k += 2) {
            cut(&cuts, part.from + ldexpl(span, -k));
            cut(&cuts, part.to - ldexpl(span, -k));
        }
    }
    tidy(&cuts, part);
    cut_at_velocities(w, &cuts);
    tidy(&cuts, part);
    const bool elastic = s->law == LAW_ELASTIC_PLASTIC;
    const size_t count = cuts.count;
    for (size_t k = 0; (elastic || w->bounded) && k + 1 < count; k++) {
        for (int side = -1; side <= 1; side += 2) {
            cut_at_zeros(w, &cuts, outward_less, side, cuts.time[k], cuts.time[k + 1]);
            if (elastic && w->excess != 0.0L) {
                cut_at_zeros(w, &cuts, static_outward_less, side, cuts.time[k], cuts.time[k + 1]);
            }
        }
    }
    tidy(&cuts, part);
    return cuts;
}

// ---------------------------------------------------------------------------------------------------------------------
// The march over the part of a step in which the contact is closed
// ---------------------------------------------------------------------------------------------------------------------

static void stretch_of_bounded(March* march, Real a, Real b) {
    World* w = march->w;
    const Real middle = 0.5L * (a + b);
    Motion motion = {.sign = sign_of(velocity(w, middle))};
    march->watch[0] = w->bounded && !w->open_ends && outward(w, middle, 1) > 0.0L;
    march->watch[1] = w->bounded && !w->open_ends && outward(w, middle, -1) > 0.0L;
    march->met = 0;
    if (march->slip && !march->watch[march->slip == 1 ? 0 : 1]) {
        march->slip = 0;
    }
    if (!march->slip) {
        go_over(march, &motion, a, b);
        march->slip = march->met;
        a = march->met ? march->met_at : b;
        march->met = 0;
    }
    if (march->slip) {
        march->slipped = true;
        if (a < b) {
            motion.slip = march->slip;
            go_over(march, &motion, a, b);
        }
    }
}

typedef Real Gap(const World* w, Real t, Real delta, int side);

// When a bristle that moves with V, and is inside at a, comes to its bound; b if it does not. The gap is monotone.
static Real arrival(const March* march, Gap* gap_of, int side, Real a, Real b) {
    const World* w = march->w;
    if (!(gap_of(w, b, march->delta + travel(w, a, b), side) < 0.0L)) {
        return b;
    }
    Real low = a, high = b;
    for (int k = 0; k < 120; k++) {
        const Real middle = 0.5L * (low + high);
        if (!(middle > low && middle < high)) {
            break;
        }
        *(gap_of(w, middle, march->delta + travel(w, a, middle), side) < 0.0L ? &high : &low) = middle;
    }
    return high;
}

// The bristle drops to the bound of what slips, at a time: the limit of a fast motion, which the damping feels.
static void break_away(March* march, Real t, int side) {
    const At at = scene_at(march->w, t, false);
    const Real from = march->delta, to = (Real)side * at.g / at.sigma;
    march->delta = to;
    march->slip = side;
    march->slipped = true;
    if (march->w->excess != 0.0L) {
        const Real damping = march->w->scene.sigma_1 * (to - from);
        march->sums.impulse += damping;
        march->sums.work += damping * at.V;
        march->sums.heat += damping * at.V + 0.5L * at.sigma * (from - to) * (from + to);
    }
}

static void stretch_of_elastic(March* march, Real a, Real b) {
    World* w = march->w;
    const Real middle = 0.5L * (a + b);
    const bool leaves[2] = {outward(w, middle, 1) > 0.0L, outward(w, middle, -1) > 0.0L};
    const Motion stuck = {.sign = sign_of(velocity(w, middle))};
    while (a < b) {
        const int side = march->slip;
        if (side != 0 && !leaves[side == 1 ? 0 : 1]) {
            march->slip = 0;
        } else if (side != 0) {
            march->slipped = true;
            // on the bound, or catching up
            const Real missing = kinetic_gap(w, a, march->delta, side);
            Real until = missing > 1e-18L * fabsl(march->delta) ? arrival(march, kinetic_gap, side, a, b) : a;
            if (until > a) {
                go_over(march, &stuck, a, until);
                a = until;
            }
            if (a < b) {
                const Motion slip = {.sign = stuck.sign, .slip = side};
                go_over(march, &slip, a, b);
                a = b;
            }
        } else {
            Real until = b;
            int breaks = 0;
            for (int k = -1; k <= 1 && !w->open_ends; k += 2) {
                const Real when = arrival(march, gap, k, a, b);
                if (when < until || (gap(w, b, march->delta + travel(w, a, b), k) < 0.0L && when <= until)) {
                    until = when;
                    breaks = k;
                }
            }
            if (until > a) {
                go_over(march, &stuck, a, until);
            }
            if (breaks) {
                break_away(march, until, breaks);
            }
            a = until;
        }
    }
}

// From a march's delta and slip through the closed part.
static void march_over(March* march, Closed part) {
    World* w = march->w;
    Cuts cuts = all_cuts(w, part);
    for (size_t k = 0; k + 1 < cuts.count; k++) {
        if (w->scene.law == LAW_ELASTIC_PLASTIC) {
            stretch_of_elastic(march, cuts.time[k], cuts.time[k + 1]);
        } else {
            stretch_of_bounded(march, cuts.time[k], cuts.time[k + 1]);
        }
    }
    free(cuts.time);
}

// ---------------------------------------------------------------------------------------------------------------------
// Many equal periods
// ---------------------------------------------------------------------------------------------------------------------

// A period maps delta in a monotone way, and as long as it touches no bound in an affine one: delta - fixed to kept (delta -
// fixed), or delta to delta + shift. Its sums are then polynomials of degree 2 in delta, of degree 1 without relaxation.
typedef struct {
    World world;
    bool drifts;                // kept is 1
    Real shift, fixed, relaxed; // relaxed: 1 - kept
} Period;

static March one_period(Period* p, Real delta, int slip, bool open_ends) {
    March march = {.w = &p->world, .delta = delta, .slip = slip};
    p->world.open_ends = open_ends;
    march_over(&march, (Closed){0.0L, p->world.h});
    p->world.open_ends = false;
    return march;
}

static void find_map(Period* p, Real delta) {
    const ReferenceScene* s = &p->world.scene;
    const At at = scene_at(&p->world, 0.0L, false);
    p->drifts = s->law == LAW_ELASTIC_PLASTIC || (s->V == 0.0 && s->V_1 == 0.0);
    p->shift = p->drifts ? travel(&p->world, 0.0L, p->world.h) : 0.0L;
    if (s->V_1 != 0.0 && s->V == 0.0) {
        p->shift = 0.0L;
    }
    Real x = delta;
    for (int k = 0; k < 3 && !p->drifts; k++) { // once would do but for rounding
        const Real y = x + at.g / at.sigma;
        const Real change_x = one_period(p, x, 0, true).sums.change;
        p->relaxed = (change_x - one_period(p, y, 0, true).sums.change) / (y - x);
        p->fixed = x = x + change_x / p->relaxed;
    }
}

static Real after_periods(const Period* p, Real delta, Real n) {
    if (p->drifts) {
        return delta + n * p->shift;
    }
    return p->fixed + (delta - p->fixed) * (p->relaxed < 1.0L ? expl(n * log1pl(-p->relaxed)) : 0.0L);
}

static bool touches(Period* p, Real delta) { return one_period(p, delta, 0, false).slipped; }

// 1 + x + .. + x^(n - 1), x = 1 - relaxed.
static Real geometric(Real relaxed, Real n) {
    return relaxed >= 1.0L ? 1.0L : relaxed == 0.0L ? n : -expm1l(n * log1pl(-relaxed)) / relaxed;
}

static void add_times(Sums* sums, const Sums* one, Real factor) {
    sums->impulse += factor * one->impulse;
    sums->work += factor * one->work;
    sums->heat += factor * one->heat;
}

// The sums of n periods from delta, none of which touches a bound.
static void add_untouched(Period* p, Real delta, Real n, Sums* sums) {
    if (p->drifts) {
        const Real far =
            n > 1.0L ? (n - 1.0L) * p->shift : 0.0L; // linear in delta: the mean of the first and the last
        const March first = one_period(p, delta, 0, true), last = one_period(p, delta + far, 0, true);
        add_times(sums, &first.sums, 0.5L * n);
        add_times(sums, &last.sums, 0.5L * n);
        return;
    }
    const Real off = delta - p->fixed, first = geometric(p->relaxed, n);
    const Real second = geometric(p->relaxed * (2.0L - p->relaxed), n);
    const March at = one_period(p, p->fixed, 0, true), above = one_period(p, p->fixed + off, 0, true);
    const March below = one_period(p, p->fixed - off, 0, true);
    add_times(sums, &at.sums, n - second);
    add_times(sums, &above.sums, 0.5L * (second + first));
    add_times(sums, &below.sums, 0.5L * (second - first));
}

enum { MOST_CYCLE = 4096 };

typedef struct {
    Real delta;
    int slip;
    Real count; // periods before it
    Sums sums;  // up to it
} Mark;

// How many periods from delta touch no bound, at the most n, at least 1: the first one touches none.
static Real untouched(Period* p, Real delta, Real n) {
    Real low = 1.0L, high = 2.0L;
    if (p->drifts ? p->shift == 0.0L : !touches(p, p->fixed)) {
        return n;
    }
    while (high < n &&
           !touches(p, after_periods(p, delta, high - 1.0L))) { // the period number high touches none
        low = high;
        high *= 2.0L;
        if (high > 1e30L) {
            return n;
        }
    }
    high = fminl(high, n + 1.0L); // number n + 1 is not asked of
    while (high - low > 1.0L) {
        const Real middle = floorl(0.5L * (low + high));
        *(touches(p, after_periods(p, delta, middle - 1.0L)) ? &high : &low) = middle;
    }
    return low;
}

// Goes n periods on, INFINITY for ever: then *cycle is the sums of the periods that repeat at last, *length their number, and
// the state that at the end of the first of them. False where none repeat.
static bool go_periods(Period* p, Real* delta, int* slip, Real n, Sums* sums, Sums* cycle, Real* length) {
    Mark* marks = malloc(MOST_CYCLE * sizeof *marks);
    Real done = 0.0L;
    int count = 0;
    if (marks == NULL) {
        abort();
    }
    find_map(p, *delta);
    bool known = true;
    while (done < n) {
        const March march = one_period(p, *delta, *slip, false);
        if (!march.slipped) {
            const Real many = untouched(p, *delta, n - done);
            if (isinf(many)) {
                const Real settles = p->drifts ? *delta : p->fixed;
                *cycle = one_period(p, settles, 0, true).sums;
                *length = 1.0L;
                *delta = settles;
                break;
            }
            add_untouched(p, *delta, many, sums);
            *delta = after_periods(p, *delta, many);
            done += many;
            continue;
        }
        add_times(sums, &march.sums, 1.0L);
        *delta = march.delta;
        *slip = march.slip;
        done += 1.0L;
        const Real size = scene_at(&p->world, 0.0L, false).B / scene_at(&p->world, 0.0L, false).sigma;
        int k = count - 1;
        while (k >= 0 && !(marks[k].slip == *slip &&
                           fabsl(marks[k].delta - *delta) <= 1e-16L * (size + fabsl(*delta)))) {
            k--;
        }
        if (k >= 0) {
            Sums between = *sums;
            add_times(&between, &marks[k].sums, -1.0L);
            const Real periods = done - marks[k].count;
            *cycle = between;
            *length = periods;
            if (isinf(n)) {
                break;
            }
            const Real times = floorl((n - done) / periods);
            add_times(sums, &between, times);
            done += times * periods;
            count = 0;
        } else if (count == MOST_CYCLE || p->world.panels > MOST_PANELS) {
            known = false;
            break;
        } else {
            marks[count++] = (Mark){*delta, *slip, done, *sums};
        }
    }
    free(marks);
    return known;
}

// ---------------------------------------------------------------------------------------------------------------------
// An input that jumps: the limit of a fast ramp
// ---------------------------------------------------------------------------------------------------------------------

// The ends of the ramp: what is linear, and what is so in its logarithm.
typedef struct {
    Real V, d, E;
    Real ln_limit, ln_scale, ln_ratio, ln_V_S; // of F_C or mu, of the stiffness's factor, of R and V_S
} Corner;

static Corner corner_of(const World* w) {
    const ReferenceScene* s = &w->scene;
    const Real swing = s->a_d * sine(w->theta_0 + s->phase_d, 1);
    const Real rest =
        s->input == INPUT_LOAD ? logl(w->held.force * w->swell / s->load) / w->decay : (Real)s->d;
    Corner corner = {.V = velocity(w, 0.0L), .d = rest + swing, .E = s->E};
    corner.ln_limit = logl(s->limit == LIMIT_LOAD ? s->mu : s->F_C);
    corner.ln_scale = logl(s->contact == CONTACT_CONSTANT ? s->contact_sigma : s->stiffnessScale);
    corner.ln_ratio = logl(1.0L + w->excess);
    corner.ln_V_S = logl(s->V_S);
    return corner;
}

typedef struct {
    const World* w;
    Corner from, to;
} Ramp;

typedef struct {
    Real g, sigma, B;
} OnRamp;

static OnRamp ramp_at(const Ramp* ramp, Real x) {
#define LINEAR(name) (ramp->from.name + x * (ramp->to.name - ramp->from.name))
    ReferenceScene s = ramp->w->scene;
    s.stiffnessScale = 1.0;
    s.contact_sigma = 1.0;
    const AtModulus at = at_modulus(&s, LINEAR(E));
    const Real d = LINEAR(d), force = at.force * expl(-ramp->w->decay * d);
    const Real ratio = expl(LINEAR(ln_ratio)), slow = LINEAR(V) / expl(LINEAR(ln_V_S));
    const Real coulomb = expl(LINEAR(ln_limit)) * (s.limit == LIMIT_LOAD ? force : 1.0L);
    OnRamp on = {.sigma = expl(LINEAR(ln_scale)) * stiffness_at(&s, &at, force, d), .B = ratio * coulomb};
    on.g = s.law == LAW_ELASTIC_PLASTIC ? coulomb * (1.0L + (ratio - 1.0L) * expl(-slow * slow)) : on.B;
    return on;
#undef LINEAR
}

// Integral of g |dD| over [a, b], D = g / sigma: the trapezoidal rule, extrapolated.
static Real heat_along(const Ramp* ramp, Real a, Real b) {
    enum { LEVELS = 9 };
    Real table[LEVELS];
    for (int level = 0; level < LEVELS; level++) {
        const int cells = 1 << level;
        Real sum = 0.0L;
        OnRamp left = ramp_at(ramp, a);
        for (int k = 1; k <= cells; k++) {
            const OnRamp right = ramp_at(ramp, a + (b - a) * (Real)k / (Real)cells);
            sum += 0.5L * (left.g + right.g) * (left.g / left.sigma - right.g / right.sigma);
            left = right;
        }
        Real last = level > 0 ? table[level - 1] : 0.0L, power = 1.0L;
        for (int k = 0; k < level; k++) { // Romberg's row, in place from the coarsest on
            power *= 4.0L;
            const Real kept = table[k];
            table[k] = sum;
            sum += (sum - kept) / (power - 1.0L);
        }
        table[level] = sum;
        if (level > 2 && fabsl(sum - last) <= 1e-16L * fabsl(sum)) {
            return sum;
        }
    }
    return table[LEVELS - 1];
}

static bool is_beyond(const Ramp* ramp, Real x, Real length, bool sticks) {
    const OnRamp on = ramp_at(ramp, x);
    return (sticks ? on.B : on.g) / on.sigma < length;
}

// Moves the bristle along the ramp from before to the start of w; returns the heat.
static Real ride(const World* before, const World* w, Real* delta, int* slip) {
    enum { CELLS = 64 };
    const Ramp ramp = {w, corner_of(before), corner_of(w)};
    Real heat = 0.0L, length = fabsl(*delta);
    const int side = sign_of(*delta);
    bool sticks = w->scene.law == LAW_ELASTIC_PLASTIC && w->excess + before->excess > 0.0L && *slip == 0;
    for (int k = 0; k < CELLS; k++) {
        Real from = (Real)k / CELLS;
        const Real to = (Real)(k + 1) / CELLS;
        while (is_beyond(&ramp, to, length, sticks)) {
            Real low = from, high = to;
            for (int i = 0; i < 100 && is_beyond(&ramp, from, length, sticks) == false; i++) {
                const Real middle = 0.5L * (low + high);
                if (!(middle > low && middle < high)) {
                    break;
                }
                *(is_beyond(&ramp, middle, length, sticks) ? &high : &low) = middle;
            }
            from = is_beyond(&ramp, from, length, sticks) ? from : high;
            const OnRamp there = ramp_at(&ramp, from);
            const Real bound = there.g / there.sigma;
            if (sticks) {
                heat += 0.5L * there.sigma * (length - bound) * (length + bound);
                length = bound;
                sticks = false;
                *slip = side;
                continue;
            }
            heat += heat_along(&ramp, from, to);
            const OnRamp end = ramp_at(&ramp, to);
            length = end.g / end.sigma;
        }
    }
    *delta = (Real)side * length;
    return heat;
}

// ---------------------------------------------------------------------------------------------------------------------
// The step
// ---------------------------------------------------------------------------------------------------------------------

static Real whole_path(const World* w) {
    World still = *w; // Stribeck's curve and the bound ask for cuts that the path needs not
    still.excess = 0.0L;
    still.bounded = false;
    still.scene.law = LAW_COULOMB;
    still.scene.d_rate = still.scene.E_rate = still.scene.load_rate = 0.0;
    if (still.scene.V_1 == 0.0) {
        still.scene.a_d = 0.0;
    }
    Cuts cuts = all_cuts(&still, (Closed){0.0L, w->h});
    Real path = 0.0L;
    for (size_t k = 0; k + 1 < cuts.count; k++) {
        path += fabsl(travel(w, cuts.time[k], cuts.time[k + 1]));
    }
    free(cuts.time);
    return path;
}

// Mean of the limit over a period of the vibration with the inputs of a time [N].
static Real mean_limit(const World* w, Real t) {
    const ReferenceScene* s = &w->scene;
    if (s->limit == LIMIT_CONSTANT) {
        return s->F_C;
    }
    if (is_open(w, t)) {
        return 0.0L;
    }
    if (s->input == INPUT_LOAD) {
        return s->mu * load_at(w, t);
    }
    const AtModulus at = modulus_at(w, t);
    return s->mu * at.force * w->swell * expl(-w->decay * ((Real)s->d + s->d_rate * t));
}

static Real largest_force(const World* w, Real delta) {
    const ReferenceScene* s = &w->scene;
    const Real V_end = (Real)s->V + s->V_rate * w->h;
    const Real top = fmaxl(fabsl((Real)s->V), fabsl(V_end)) + fabsl((Real)s->V_1);
    Real S = (1.0L + w->excess) * fmaxl(mean_limit(w, 0.0L), mean_limit(w, w->h));
    if (s->law != LAW_COULOMB && !is_open(w, 0.0L)) {
        S = fmaxl(S, scene_at(w, 0.0L, false).sigma * fabsl(delta));
    }
    return fmaxl(S, ((s->law == LAW_COULOMB ? 0.0L : (Real)s->sigma_1) + s->sigma_2) * top);
}

// The same with its inputs held.
static World held_world(const World* w, Real h) {
    World held = *w;
    held.scene.V_rate = held.scene.d_rate = held.scene.E_rate = held.scene.load_rate = 0.0;
    held.no_load = -INFINITY;
    held.h = h;
    return held;
}

static bool has_many_periods(const World* w) {
    return is_held(&w->scene) && vibrates(&w->scene) && w->h * w->scene.f > 4.0L;
}

static World make_world(const ReferenceScene* scene, Real h, int fineness) {
    World w = {.scene = *scene, .h = h, .fineness = fineness};
    const bool bristle = scene->law == LAW_DAHL || scene->law == LAW_LUGRE;
    w.bounded = bristle && scene->limit == LIMIT_LOAD;
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
    const Real load_end = (Real)scene->load + scene->load_rate * h;
    w.no_load = (scene->load > 0.0) != (load_end > 0.0L) && scene->load_rate != 0.0
                    ? -(Real)scene->load / scene->load_rate
                    : -INFINITY;
    return w;
}

static void find_path(World* w) {
    if (!has_many_periods(w)) {
        w->path = whole_path(w);
        return;
    }
    World part = *w;
    const Real n = floorl(w->h * w->scene.f);
    part.h = 1.0L / w->scene.f;
    w->path = n * whole_path(&part);
    part.h = w->h - n * part.h;
    w->path += part.h > 0.0L ? whole_path(&part) : 0.0L;
}

// Over [a, b], open: viscous friction, and Coulomb's if its limit is constant; Coulomb's law also while closed.
static void without_bristle(const World* w, Real a, Real b, Sums* sums) {
    if (!(b > a)) {
        return;
    }
    World still = *w;
    still.excess = 0.0L;
    still.bounded = false;
    still.scene.law = LAW_COULOMB;
    const bool open = is_open(w, 0.5L * (a + b));
    Cuts cuts = all_cuts(&still, (Closed){a, b});
    for (size_t k = 0; k + 1 < cuts.count; k++) {
        const int pieces = 4 * w->fineness;
        const Real sign = (Real)sign_of(velocity(w, 0.5L * (cuts.time[k] + cuts.time[k + 1])));
        const Real size = (cuts.time[k + 1] - cuts.time[k]) / (Real)pieces;
        for (int i = 0; i < pieces * w->rule->stages; i++) {
            const Real at_piece = (Real)(i / w->rule->stages);
            const Real t = cuts.time[k] + size * (at_piece + w->rule->node[i % w->rule->stages]);
            const Real time = size * w->rule->weight[i % w->rule->stages], V = velocity(w, t);
            Real limit = 0.0L;
            if (w->scene.law == LAW_COULOMB) {
                limit = w->scene.limit == LIMIT_CONSTANT ? w->scene.F_C
                        : open                           ? 0.0L
                                                         : scene_at(w, t, false).coulomb;
            }
            const Real force = sign * limit + w->scene.sigma_2 * V;
            sums->impulse += time * force;
            sums->work += time * force * V;
            sums->heat += time * force * V;
        }
    }
    free(cuts.time);
}

// Open and closed parts alike; for many equal periods of all that has no bristle.
static void coulomb_over(const World* w, Sums* sums) {
    if (has_many_periods(w)) {
        Sums one = {0};
        const Real n = floorl(w->h * w->scene.f), T = 1.0L / w->scene.f;
        without_bristle(w, 0.0L, T, &one);
        add_times(sums, &one, n);
        without_bristle(w, 0.0L, w->h - n * T, sums);
        return;
    }
    const Closed part = closed_part(w);
    without_bristle(w, 0.0L, part.from, sums);
    without_bristle(w, part.from, part.to, sums);
    without_bristle(w, part.to, w->h, sums);
}

// F_t [N] at a time.
static Real force_at(const World* w, Real t, Real delta, int slip, bool open) {
    const ReferenceScene* s = &w->scene;
    const Real V = velocity(w, t);
    if (s->law == LAW_COULOMB) {
        const Real limit = s->limit == LIMIT_CONSTANT ? s->F_C : open ? 0.0L : scene_at(w, t, false).coulomb;
        return (Real)sign_of(V) * limit + s->sigma_2 * V;
    }
    if (open) {
        return s->sigma_2 * V;
    }
    const At at = scene_at(w, t, true);
    Real rate = at.V - relaxation(w, &at, sign_of(at.V)) * delta;
    const bool on_bound = slip &&
                          fabsl((Real)slip * slip_bound(w, &at) - delta) <= 1e-11L * slip_bound(w, &at) &&
                          outward(w, t, slip) > 0.0L;
    if (on_bound) {
        rate = (Real)slip * slip_rate(w, &at);
    }
    return at.sigma * delta + s->sigma_1 * rate + s->sigma_2 * at.V;
}

// What the jump of the inputs, or a start beyond the bound, does to the bristle; returns its heat.
static Real jump(const ReferenceScene* before, const World* w, Real* delta, int* slip) {
    const ReferenceScene* s = &w->scene;
    const bool elastic = s->law == LAW_ELASTIC_PLASTIC;
    const World past = before ? make_world(before, 0.0L, w->fineness) : *w;
    if (is_open(w, 0.0L) || is_open(&past, 0.0L)) {
        const bool slides = s->contact == CONTACT_CONSTANT && s->limit == LIMIT_LOAD && !is_open(&past, 0.0L);
        const Real heat = slides ? 0.5L * s->contact_sigma * *delta * *delta : 0.0L;
        *delta = 0.0L;
        *slip = 0;
        return heat;
    }
    if (!elastic && !w->bounded) {
        return 0.0L;
    }
    const At at = scene_at(w, 0.0L, false);
    const bool sticks = elastic && *slip == 0;
    const Real length = fabsl(*delta), bound = (elastic ? at.g : at.B) / at.sigma;
    if (before == NULL) {
        if (length <= (sticks ? at.B / at.sigma : bound)) {
            return 0.0L;
        }
        const int side = sign_of(*delta);
        *delta = (Real)side * bound;
        *slip = elastic ? side : 0;
        return 0.5L * at.sigma * (length - bound) * (length + bound);
    }
    return ride(&past, w, delta, slip);
}

// The deflection at the start that the periodic state of held inputs has, without vibration the one of sliding for ever.
static bool settle(const World* w, Real* delta, int* slip, Sums* cycle, Real* length) {
    const ReferenceScene* s = &w->scene;
    Period period = {.world = held_world(w, 1.0L / s->f)};
    World* held = &period.world;
    *length = 1.0L;
    if (is_open(held, 0.0L)) {
        *delta = 0.0L;
        *slip = 0;
        coulomb_over(held, cycle);
        return true;
    }
    if (!vibrates(s)) {
        const At at = scene_at(held, 0.0L, false);
        const int side = sign_of(s->V);
        if (side != 0) {
            *delta = (Real)side * at.g / at.sigma;
        }
        *slip = s->law == LAW_ELASTIC_PLASTIC ? side : 0;
        cycle->impulse = held->h * (at.sigma * *delta + s->sigma_2 * at.V);
        return true;
    }
    held->path = whole_path(held);
    Sums sums = {0};
    return go_periods(&period, delta, slip, INFINITY, &sums, cycle, length);
}

static void step_of_bristle(World* w, Real* delta, int* slip, ReferenceStep* result, Sums* sums) {
    if (has_many_periods(w) && !is_open(w, 0.0L)) {
        const Real n = floorl(w->h * w->scene.f);
        Period period = {.world = *w};
        period.world.h = 1.0L / w->scene.f;
        period.world.path = whole_path(&period.world);
        Sums cycle = {0};
        Real length = 0.0L;
        result->known = go_periods(&period, delta, slip, n, sums, &cycle, &length);
        World rest = *w;
        rest.h = w->h - n / w->scene.f;
        March march = {.w = &rest, .delta = *delta, .slip = *slip};
        if (rest.h > 0.0L) {
            march_over(&march, (Closed){0.0L, rest.h});
        }
        add_times(sums, &march.sums, 1.0L);
        *delta = march.delta;
        *slip = march.slip;
        return;
    }
    const Closed part = closed_part(w);
    without_bristle(w, 0.0L, part.from, sums);
    if (part.to > part.from) {
        // what has no load has no rate: the last 1e-18 of the way to it is left out
        Closed inner = part;
        const Real edge = ldexpl(part.to - part.from, -58);
        inner.from += part.from > 0.0L ? edge : 0.0L;
        inner.to -= part.to < w->h ? edge : 0.0L;
        March march = {.w = w, .delta = part.from > 0.0L ? 0.0L : *delta, .slip = *slip};
        march_over(&march, inner);
        add_times(sums, &march.sums, 1.0L);
        *delta = march.delta;
        *slip = march.slip;
        result->known = w->panels <= MOST_PANELS;
    }
    if (part.to < w->h) {
        if (w->scene.contact == CONTACT_CONSTANT) {
            sums->heat += 0.5L * w->scene.contact_sigma * *delta * *delta;
        }
        *delta = 0.0L;
        *slip = 0;
    }
    without_bristle(w, part.to, w->h, sums);
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
                            .initial = START_GIVEN};
}

void reference_step(const ReferenceScene* before, const ReferenceScene* scene, int fineness,
                    ReferenceStep* result) {
    World w = make_world(scene, scene->h, fineness);
    const World held = held_world(&w, w.h);
    w.S = largest_force(&w, scene->delta_0);
    find_path(&w);
    *result = (ReferenceStep){.path = (double)w.path, .S = (double)w.S, .known = true};
    Sums sums = {0};
    Real delta = scene->delta_0;
    int slip = scene->slips;
    const bool bristle = scene->law != LAW_COULOMB;
    if (bristle) {
        Sums cycle = {0};
        Real length;
        if (scene->initial == START_SETTLED) {
            jump(NULL, &held, &delta, &slip);
            slip = 0;
            result->known = settle(&w, &delta, &slip, &cycle, &length);
        } else {
            sums.heat = jump(before, &w, &delta, &slip);
        }
    }
    const bool open = is_open(&w, 0.0L);
    int slip_start = slip;
    if (!open && (w.bounded || (scene->law == LAW_ELASTIC_PLASTIC && w.excess == 0.0L))) {
        const At at = scene_at(&w, 0.0L, false); // a state that was rounded may lie next to its bound
        slip_start = fabsl(delta) >= (1.0L - 1e-11L) * at.B / at.sigma ? sign_of(delta) : 0;
    }
    result->F_t_start = (double)force_at(&held, 0.0L, delta, slip_start, open);
    if (bristle) {
        step_of_bristle(&w, &delta, &slip, result, &sums);
    } else {
        coulomb_over(&w, &sums);
    }
    result->delta = (double)delta;
    result->slips = scene->law == LAW_ELASTIC_PLASTIC && w.excess != 0.0L ? slip : 0;
    result->F_t = (double)force_at(&w, w.h, delta, slip, is_open(&w, w.h));
    result->F_t_mean = (double)(sums.impulse / w.h);
    result->work = (double)sums.work;
    result->heat = (double)sums.heat;
}

bool reference_settled_force(const ReferenceScene* scene, double* force, double* S) {
    ReferenceScene still = *scene;
    still.V_rate = still.d_rate = still.E_rate = still.load_rate = 0.0;
    still.start = 0.0;
    World w = make_world(&still, 1.0L / still.f, 1);
    w.S = largest_force(&w, still.delta_0);
    *S = (double)w.S;
    Sums cycle = {0};
    Real length = 1.0L, delta = still.delta_0;
    int slip = 0;
    bool known = true;
    if (still.law == LAW_COULOMB) {
        coulomb_over(&w, &cycle);
    } else {
        jump(NULL, &w, &delta, &slip);
        slip = 0;
        known = settle(&w, &delta, &slip, &cycle, &length);
    }
    *force = (double)(cycle.impulse / (length / still.f));
    return known;
}
