#include "reference.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

typedef long double Real;

static const Real PI = 3.141592653589793238462643383279502884L;

// ---------------------------------------------------------------------------------------------------------------------
// Radau's right rule on [0, 1] and its collocation matrix; linear equations; roots
// ---------------------------------------------------------------------------------------------------------------------

enum { MOST_STAGES = 12 };

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

static Rule make_rule(int n) {
    Rule rule = {.stages = n};
    Real x[MOST_STAGES], P[MOST_STAGES][MOST_STAGES + 1];
    for (int i = 0; i < n; i++) {
        // The roots of P_n - P_(n-1) from the least to 1, each by Newton with those before it divided out.
        x[i] = i == 0 ? -0.999999L : i == n - 1 ? 1.0L : x[i - 1] + 1e-6L;
        for (int k = 0; k < 100 && i < n - 1; k++) {
            legendre(n, x[i], P[i]);
            const Real of_n = P[i][n - 1] - x[i] * P[i][n], of_less = P[i][n - 2] - x[i] * P[i][n - 1];
            const Real value = P[i][n] - P[i][n - 1];
            Real slope = ((Real)n * of_n - (Real)(n - 1) * of_less) / (1.0L - x[i] * x[i]);
            for (int j = 0; j < i; j++) {
                slope -= value / (x[i] - x[j]);
            }
            x[i] -= value / slope;
        }
        legendre(n, x[i], P[i]);
        rule.node[i] = 0.5L * (1.0L + x[i]);
        rule.weight[i] = 0.5L * (1.0L + x[i]) / ((Real)(n * n) * P[i][n - 1] * P[i][n - 1]);
    }
    // The rule integrates products of two polynomials of degree n - 1 exactly, so the Lagrange polynomials
    // are sums of Legendre's with P_m(x_j) w_j (2 m + 1) for coefficients.
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

// Made once; the first call is not safe to be made by two threads at once.
static const Rule* rule_of(int stages) {
    static Rule rules[MOST_STAGES + 1];
    if (rules[stages].stages == 0) {
        rules[stages] = make_rule(stages);
    }
    return &rules[stages];
}

static void swap(Real* a, Real* b) {
    const Real kept = *a;
    *a = *b;
    *b = kept;
}

// Solves A x = b in place, pivoting by columns.
static void solve(int n, Real A[MOST_STAGES][MOST_STAGES], Real* b) {
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k + 1; i < n; i++) {
            best = fabsl(A[i][k]) > fabsl(A[best][k]) ? i : best;
        }
        for (int j = k; best != k && j < n; j++) {
            swap(&A[k][j], &A[best][j]);
        }
        swap(&b[k], &b[best]);
        for (int i = k + 1; i < n; i++) {
            const Real factor = A[i][k] / A[k][k];
            for (int j = k + 1; j < n; j++) {
                A[i][j] -= factor * A[k][j];
            }
            b[i] -= factor * b[k];
        }
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int j = i + 1; j < n; j++) {
            b[i] -= A[i][j] * b[j];
        }
        b[i] /= A[i][i];
    }
}

typedef Real Function(const void* context, Real x);

// Where a function passes zero between low and high, on the side of high: regula falsi, by halves every third
// time.
static Real crossing(Function* function, const void* context, Real low, Real high) {
    Real at_low = function(context, low), at_high = function(context, high);
    const bool rises = at_high > 0.0L;
    for (int k = 0; k < 200; k++) {
        const Real middle = 0.5L * (low + high), least = 2.0L * LDBL_EPSILON * fabsl(high);
        Real x = high - at_high * (high - low) / (at_high - at_low);
        x = k % 3 == 2 ? middle : fmaxl(low + least, fminl(high - least, x));
        x = x > low && x < high ? x : middle;
        if (!(x > low && x < high)) {
            break;
        }
        const Real at = function(context, x);
        if ((at > 0.0L) == rises) {
            high = x;
            at_high = at;
            at_low *= 0.5L;
        } else {
            low = x;
            at_low = at;
            at_high *= 0.5L;
        }
    }
    return high;
}

// ---------------------------------------------------------------------------------------------------------------------
// The contact
// ---------------------------------------------------------------------------------------------------------------------

// Lower incomplete gamma function of s = 3/2 and 5/2: x^s e^-x sum of x^k / (s (s + 1) .. (s + k)), for large
// x by erf.
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

// What F_n and sigma are over their power of e^(-lambda d / R_q), and the derivatives of their logarithms by
// E.
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
    bool elastic;   // the law is ElasticPlastic
    bool bounded;   // a bristle has a bound: ElasticPlastic's, or the limit of Dahl's and LuGre's that moves
    bool open;      // nothing touches
    bool open_ends; // a bristle is taken as if it had no bound: for the map of a period that touches none
    Real S;         // N
    Real top;       // m/s, the largest |V|
    const Rule* rule;
    int fineness;
    Real panels;
} World;

// At a local time; rates are time derivatives of logarithms, found only when they are asked for.
typedef struct {
    Real V;
    Real sigma;
    Real coulomb;                  // N, F_C or mu F_n
    Real g;                        // N, the limit of the bristle's force
    Real B;                        // N, the bound of a bristle that does not slip
    Real bound_rate, kinetic_rate; // of ln(B / sigma), ln(g / sigma)
} At;

// Sine of x + shift pi / 2. The library's own reduction to a quarter turn would take half of all time; pi / 2
// in two parts, the first of 41 bits, is as good for some thousand turns.
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

// sigma [N/m] at those F_n and d.
static Real stiffness_at(const ReferenceScene* s, const AtModulus* at, Real force, Real d) {
    const Real share = force / at->force;
    return s->contact == CONTACT_CONSTANT  ? (Real)s->contact_sigma
           : s->contact == CONTACT_MINDLIN ? at->stiffness * share
                                           : at->stiffness * share * share / (d * d * d);
}

// F_n [N] and sigma [N/m]; the rate of ln(limit / sigma) without Stribeck's curve, and without its terms that
// cancel.
static void contact_at(const World* w, Real t, bool with_rates, Real* force, Real* sigma, Real* ratio_rate) {
    const ReferenceScene* s = &w->scene;
    *sigma = s->contact_sigma;
    *ratio_rate = *force = 0.0L;
    if (w->open || (s->contact == CONTACT_CONSTANT && s->limit == LIMIT_CONSTANT)) {
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
    return w->elastic ? 0.0L : at->sigma * (Real)side * at->V / at->g;
}

// The bound [m] of a bristle that sticks, or of one that slips, and how fast it moves [m/s].
static Real bound(const World* w, const At* at, bool sticks) {
    return (sticks || !w->elastic ? at->B : at->g) / at->sigma;
}
static Real bound_rate(const World* w, const At* at, bool sticks) {
    return bound(w, at, sticks) * (sticks || !w->elastic ? at->bound_rate : at->kinetic_rate);
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

static Real openness(const void* world, Real t) { return is_open(world, t) ? 1.0L : -1.0L; }

static Closed closed_part(const World* w) {
    const bool at_start = is_open(w, 0.0L), at_end = is_open(w, w->h);
    if (at_start == at_end) {
        return (Closed){at_start ? w->h : 0.0L, w->h};
    }
    const Real t = crossing(openness, w, 0.0L, w->h);
    return at_start ? (Closed){t, w->h} : (Closed){0.0L, t};
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
    solve(n, A, Y);
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
    Sums sums = {.path = fabsl(travel(w, a, b)), .end = delta};
    At at[MOST_STAGES];
    Real r[MOST_STAGES] = {0}, rate[MOST_STAGES] = {0}, at_delta[MOST_STAGES] = {0};
    for (int i = 0; i < n; i++) {
        const Real t = a + size * rule->node[i];
        at[i] = scene_at(w, t, motion->slip != 0);
        if (motion->slip) {
            at_delta[i] = (Real)motion->slip * bound(w, &at[i], false);
            rate[i] = (Real)motion->slip * bound_rate(w, &at[i], false);
        } else if (bristle && w->elastic) {
            at_delta[i] = delta + travel(w, a, t);
            rate[i] = at[i].V;
        } else if (bristle) {
            r[i] = relaxation(w, &at[i], motion->sign);
        }
    }
    sums.change = motion->slip ? at_delta[last] - delta : bristle && w->elastic ? travel(w, a, b) : 0.0L;
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
    Real* time;
    size_t count, room;
} Cuts;

static void* memory(void* old, size_t size) {
    void* found = realloc(old, size);
    if (found == NULL) {
        abort();
    }
    return found;
}

static void cut(Cuts* cuts, Real t) {
    if (cuts->count == cuts->room) {
        cuts->room = cuts->room ? 2 * cuts->room : 256;
        cuts->time = memory(cuts->time, cuts->room * sizeof *cuts->time);
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

typedef struct {
    const World* w;
    Real level; // m/s, of V
    int side;   // of a bound
    bool sticks;
} Zero;

static Real velocity_less(const void* context, Real t) {
    const Zero* zero = context;
    return velocity(zero->w, t) - zero->level;
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
    static const Real MULTIPLES[] = {0.0L, 0.25L, 0.5L, 1.0L, 1.5L, 2.0L, 3.0L, 4.0L, 6.0L, 9.0L};
    const size_t count = cuts->count, levels = w->excess == 0.0L ? 1 : sizeof MULTIPLES / sizeof *MULTIPLES;
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
    Motion motion = {.sign = sign_of(velocity(w, middle))};
    while (a < b) {
        if (march->slip && !(outward(w, middle, march->slip, false) > 0.0L)) {
            march->slip = 0; // it sticks, or leaves the bound
        }
        const int slip = march->slip;
        march->slipped = march->slipped || slip;
        march->met = 0;
        for (int side = 1; side >= -1; side -= 2) {
            march->watch[side < 0] = w->bounded && !w->open && !w->open_ends &&
                                     (slip ? side == slip : outward(w, middle, side, true) > 0.0L);
        }
        // on the bound, or catching up
        const bool lies = slip && gap(w, a, march->delta, slip, false) <= 1e-18L * fabsl(march->delta);
        motion.slip = lies ? slip : 0;
        go_over(march, &motion, a, b);
        a = march->met ? march->met_at : b;
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

// Goes n periods on, INFINITY for ever: then *cycle is the sums of the periods that repeat at last, *length
// their number, and the state that at the end of the first of them. False if none repeat.
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
// An input that jumps: the limit of a fast ramp
// ---------------------------------------------------------------------------------------------------------------------

// The ends of the ramp: its linear quantities, and those with a linear logarithm.
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
    on.g = ramp->w->elastic ? coulomb * (1.0L + (ratio - 1.0L) * expl(-slow * slow)) : on.B;
    return on;
#undef LINEAR
}

// Integral of g |dD| over [a, b], on which D = g / sigma falls: D' by the rule's matrix, and by halves until
// they agree.
static Real heat_along(const Ramp* ramp, Real a, Real b, int depth) {
    const Rule* rule = ramp->w->rule;
    const Real half[3] = {a, 0.5L * (a + b), b};
    Real sum[3] = {0}; // of the halves, of the whole
    for (int part = 0; part < 3; part++) {
        const Real from = half[part % 2], to = part == 2 ? b : half[part + 1];
        const OnRamp first = ramp_at(ramp, from);
        Real A[MOST_STAGES][MOST_STAGES], D[MOST_STAGES], g[MOST_STAGES];
        for (int i = 0; i < rule->stages; i++) {
            const OnRamp on = ramp_at(ramp, from + (to - from) * rule->node[i]);
            g[i] = on.g;
            D[i] = on.g / on.sigma - first.g / first.sigma;
            for (int j = 0; j < rule->stages; j++) {
                A[i][j] = rule->to[i][j];
            }
        }
        solve(rule->stages, A, D);
        for (int i = 0; i < rule->stages; i++) {
            sum[part] -= rule->weight[i] * g[i] * D[i];
        }
    }
    const OnRamp on = ramp_at(ramp, a);
    const Real least = 1e-17L * on.g * on.g / on.sigma;
    const bool agree = fabsl(sum[0] + sum[1] - sum[2]) <= 1e-14L * fabsl(sum[2]) + least;
    return agree || depth == 0
               ? sum[0] + sum[1]
               : heat_along(ramp, a, half[1], depth - 1) + heat_along(ramp, half[1], b, depth - 1);
}

// A length [m] and the bound on the ramp that it is to hold.
typedef struct {
    const Ramp* ramp;
    Real length;
    bool sticks;
} Held;

static Real excess_length(const void* context, Real x) {
    const Held* held = context;
    const OnRamp on = ramp_at(held->ramp, x);
    return held->length - (held->sticks ? on.B : on.g) / on.sigma;
}

// Where in [a, b] the bound is the lowest: at an end, or inside if it falls at a, and rises at b or is higher
// there.
static Real lowest(const Held* held, Real a, Real b) {
    const Real near = 1e-6L * (b - a);
    const Real at_a = excess_length(held, a), at_b = excess_length(held, b);
    if (excess_length(held, a + near) > at_a && fmaxl(excess_length(held, b - near), at_a) > at_b) {
        for (int k = 0; k < 45; k++) { // golden section
            const Real x = a + 0.381966L * (b - a), y = b - 0.381966L * (b - a);
            *(excess_length(held, x) > excess_length(held, y) ? &b : &a) =
                excess_length(held, x) > excess_length(held, y) ? y : x;
        }
        return 0.5L * (a + b);
    }
    return at_a > at_b ? a : b;
}

// Moves the bristle along the ramp from before to the start of w; returns the heat.
static Real ride(const World* before, const World* w, Real* delta, int* slip) {
    enum { CELLS = 64 };
    const Ramp ramp = {w, corner_of(before), corner_of(w)};
    const int side = sign_of(*delta);
    const bool sticks = w->elastic && w->excess + before->excess > 0.0L && *slip == 0;
    Held held = {&ramp, fabsl(*delta), sticks};
    Real heat = 0.0L;
    for (int k = 0; k < CELLS; k++) {
        Real from = (Real)k / CELLS;
        for (;;) {
            const Real to = lowest(&held, from, (Real)(k + 1) / CELLS);
            // neither the rounding of the state nor that of a bound that stands still is an excess
            if (!(excess_length(&held, to) > (held.sticks ? 1e-11L : 1e-16L) * held.length)) {
                break;
            }
            from = excess_length(&held, from) > 0.0L ? from : crossing(excess_length, &held, from, to);
            const OnRamp there = ramp_at(&ramp, from), end = ramp_at(&ramp, to);
            if (held.sticks) { // it breaks away
                const Real kinetic = there.g / there.sigma;
                heat += 0.5L * there.sigma * (held.length - kinetic) * (held.length + kinetic);
                held.length = kinetic;
                held.sticks = false;
                *slip = side;
            } else {
                heat += heat_along(&ramp, from, to, 12);
                held.length = end.g / end.sigma;
                from = to;
            }
        }
    }
    *delta = (Real)side * held.length;
    return heat;
}

// ---------------------------------------------------------------------------------------------------------------------
// The step
// ---------------------------------------------------------------------------------------------------------------------

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
    const bool bristle = s->law != LAW_COULOMB;
    Real S = (1.0L + w->excess) * fmaxl(mean_limit(w, 0.0L), mean_limit(w, w->h));
    if (bristle && !is_open(w, 0.0L)) {
        S = fmaxl(S, scene_at(w, 0.0L, false).sigma * fabsl(delta));
    }
    return fmaxl(S, ((bristle ? (Real)s->sigma_1 : 0.0L) + s->sigma_2) * w->top);
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
    World w = {.scene = *scene, .h = h, .fineness = fineness, .elastic = scene->law == LAW_ELASTIC_PLASTIC};
    w.bounded = w.elastic || (scene->law != LAW_COULOMB && scene->limit == LIMIT_LOAD);
    w.top = fmaxl(fabsl((Real)scene->V), fabsl((Real)scene->V + scene->V_rate * h)) + fabsl((Real)scene->V_1);
    w.excess =
        scene->law == LAW_LUGRE || scene->law == LAW_ELASTIC_PLASTIC ? (Real)scene->staticRatio - 1.0L : 0.0L;
    w.omega = 2.0L * PI * scene->f;
    // f start less its whole number, exactly: the product and its rounding error
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
        slip && fabsl((Real)slip * lies - delta) <= 1e-11L * lies && outward(w, t, slip, false) > 0.0L;
    const Real rate =
        slips ? (Real)slip * bound_rate(w, &at, false) : at.V - relaxation(w, &at, sign_of(at.V)) * delta;
    return at.sigma * delta + s->sigma_1 * rate + s->sigma_2 * at.V;
}

// Takes the bristle through the jump of the inputs, or from a start beyond the bound; returns the heat.
static Real jump(const ReferenceScene* before, const World* w, Real* delta, int* slip) {
    const ReferenceScene* s = &w->scene;
    const World past = before ? make_world(before, 0.0L, w->fineness) : *w;
    if (is_open(w, 0.0L) || is_open(&past, 0.0L)) {
        const bool slides = s->contact == CONTACT_CONSTANT && s->limit == LIMIT_LOAD && !is_open(&past, 0.0L);
        const Real heat = slides ? 0.5L * s->contact_sigma * *delta * *delta : 0.0L;
        *delta = 0.0L;
        *slip = 0;
        return heat;
    }
    if (!w->bounded) {
        return 0.0L;
    }
    if (before != NULL) {
        return ride(&past, w, delta, slip);
    }
    const At at = scene_at(w, 0.0L, false);
    const Real length = fabsl(*delta), lies = bound(w, &at, false);
    if (length <= (1.0L + 1e-11L) * bound(w, &at, *slip == 0)) {
        return 0.0L;
    }
    *slip = w->elastic ? sign_of(*delta) : 0;
    *delta = (Real)sign_of(*delta) * lies;
    return 0.5L * at.sigma * (length - lies) * (length + lies);
}

// The deflection at the start that the periodic state of held inputs has, without vibration the one of
// sliding for ever.
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
        slip = 0;
        result->known = settle(&w, &delta, &slip, &cycle, &length);
    } else if (scene->law != LAW_COULOMB) {
        sums.heat = jump(before, &w, &delta, &slip);
    }
    int slip_start = slip;
    if (w.bounded && !(w.elastic && w.excess != 0.0L) && !is_open(&w, 0.0L)) {
        const At at = scene_at(&w, 0.0L, false); // a state that was rounded may lie next to its bound
        slip_start = fabsl(delta) >= (1.0L - 1e-11L) * bound(&w, &at, true) ? sign_of(delta) : 0;
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

bool reference_is_open(const ReferenceScene* scene) {
    const World w = make_world(scene, 0.0L, 1);
    return is_open(&w, 0.0L);
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
    slip = 0;
    const bool known = settle(&w, &delta, &slip, &cycle, &length);
    *force = (double)(cycle.impulse / (length / still.f));
    return known;
}
