#include "reference.h"

#include <complex.h>
#include <float.h>
#include <math.h>
#include <stddef.h>

typedef long double Real;

static const Real PI = 3.141592653589793238462643383279502884L;

// The real part is along the sliding, the imaginary one across.
typedef long double _Complex Vector;

// ---- Roots; Radau's right rule on [0, 1] and its collocation matrix; linear equations ----

typedef Real Function(const void* context, Real x);

// The zero of a function between low and high, on the side of high: by bisection.
static Real crossing(Function* function, const void* context, Real low, Real high) {
    const bool above = function(context, low) > 0.0L;
    for (;;) {
        const Real x = 0.5L * (low + high);
        if (!(x > low && x < high)) {
            return high;
        }
        *(above == (function(context, x) > 0.0L) ? &low : &high) = x;
    }
}

enum { STAGES = 10 };

// Radau's right rule on [0, 1] and its collocation matrix.
typedef struct {
    Real node[STAGES + 1];   // the first one is 0 and no stage, the last one is 1
    Real weight[STAGES];     // sum 1
    Real to[STAGES][STAGES]; // to[i][j]: integral of the j-th Lagrange polynomial over [0, node i + 1]
} Rule;

// P_0 .. P_STAGES of Legendre at x.
static void legendre(Real x, Real P[STAGES + 1]) {
    P[0] = 1.0L;
    P[1] = x;
    for (int m = 1; m < STAGES; m++) {
        P[m + 1] = ((Real)(2 * m + 1) * x * P[m] - (Real)m * P[m - 1]) / (Real)(m + 1);
    }
}

// Its zeros are the nodes.
static Real radau(const void* unused, Real x) {
    Real P[STAGES + 1];
    (void)unused;
    legendre(x, P);
    return P[STAGES] - P[STAGES - 1];
}

// Each thread makes it once.
static const Rule* the_rule(void) {
    enum { n = STAGES };
    static _Thread_local Rule rule;
    if (rule.node[n] != 0.0L) {
        return &rule;
    }
    Real x[n], P[n][n + 1];
    for (int i = 0; i < n; i++) {
        const Real angle = PI * ((Real)(n - i) - 0.75L) / n; // near to that of the zero
        const Real low = cosl(angle + 0.5L * PI / n), high = cosl(angle - 0.5L * PI / n);
        x[i] = i < n - 1 ? crossing(radau, NULL, low, high) : 1.0L;
        legendre(x[i], P[i]);
        rule.node[i + 1] = 0.5L * (1.0L + x[i]);
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
    return &rule;
}

// Solves linear equations without pivoting: the right sides become the solution.
static void solve(Real A[STAGES][STAGES], Vector* side) {
    for (int k = 0; k < STAGES; k++) {
        for (int i = k + 1; i < STAGES; i++) {
            const Real factor = A[i][k] / A[k][k];
            for (int j = k + 1; j < STAGES; j++) {
                A[i][j] -= factor * A[k][j];
            }
            side[i] -= factor * side[k];
        }
    }
    for (int k = STAGES - 1; k >= 0; k--) {
        for (int j = k + 1; j < STAGES; j++) {
            side[k] -= A[k][j] * side[j];
        }
        side[k] /= A[k][k];
    }
}

// The same of a step of Newton's, which needs no more digits than a double has.
enum { UNKNOWNS = 2 * STAGES };
static void solve_roughly(double A[UNKNOWNS][UNKNOWNS], double side[UNKNOWNS]) {
    for (int k = 0; k < UNKNOWNS; k++) {
        for (int i = k + 1; i < UNKNOWNS; i++) {
            const double factor = A[i][k] / A[k][k];
            side[i] -= factor * side[k];
            for (int j = k + 1; j < UNKNOWNS; j++) {
                A[i][j] -= factor * A[k][j];
            }
        }
    }
    for (int k = UNKNOWNS - 1; k >= 0; k--) {
        for (int j = k + 1; j < UNKNOWNS; j++) {
            side[k] -= A[k][j] * side[j];
        }
        side[k] /= A[k][k];
    }
}

// ---- The contact ----

// The factors of F_n and sigma before their powers of e^(-lambda d / R_q), and the derivatives of their logarithms by E.
typedef struct {
    Real force, by_force;         // N
    Real stiffness, by_stiffness; // N/m; N m2 for Asperities
} AtModulus;

static Real power_3_2(Real x) { return x * sqrtl(x); }

// gamma(3/2, x); its rounding is that of Gamma(3/2).
static Real lower_gamma_3_2(Real x) { return 0.5L * sqrtl(PI) * erfl(sqrtl(x)) - sqrtl(x) * expl(-x); }

static Real bessel_I0(Real x) {
    const Real quarter = 0.25L * x * x;
    Real term = 1.0L, sum = 1.0L;
    for (int k = 1; k < 100000 && term > 1e-22L * sum; k++) {
        term *= quarter / ((Real)k * (Real)k);
        sum += term;
    }
    return sum;
}

static AtModulus at_modulus(const ReferenceScene* scene, Real E) {
    const Real R = scene->R, R_q = scene->R_q, lambda = scene->lambda, nu = scene->nu;
    const Real density = (Real)scene->eta * scene->A_n * scene->c;
    const Real p_m = (1.234L + 1.256L * nu) * (1.0L - nu * nu) * scene->Y;
    const Real yields = PI * p_m / (2.0L * E);
    const Real x = lambda * yields * yields * R / R_q;
    const Real x_E = -2.0L * x / E;
    const Real decay = expl(-x);
    const Real elastic = 4.0L / 3.0L * sqrtl(R) * power_3_2(R_q / lambda) / lambda;
    const Real plastic = PI * R * R_q * p_m / (lambda * lambda);
    const Real gamma = 1.5L * lower_gamma_3_2(x) - power_3_2(x) * decay; // gamma(5/2, x)
    const Real force = elastic * E * gamma + plastic * (2.0L + x) * decay;
    const Real force_E =
        elastic * (gamma + E * power_3_2(x) * decay * x_E) - plastic * (1.0L + x) * decay * x_E;
    AtModulus at = {.force = density * force, .by_force = force_E / force, .stiffness = scene->contact_sigma};
    if (scene->contact == CONTACT_ASPERITIES) {
        const Real area = scene->c * PI * (Real)scene->eta * R * R_q * scene->A_n / (lambda * lambda);
        const Real bracket = 1.0L + decay;
        at.stiffness = scene->stiffnessScale * E * area * area * bracket * bracket;
        at.by_stiffness = 1.0L / E - 2.0L * decay * x_E / bracket;
    } else if (scene->contact == CONTACT_MINDLIN) {
        const Real half = expl(-0.5L * x), yielded = 0.5L * power_3_2(2.0L / lambda);
        const Real upper = 0.5L * sqrtl(PI) - lower_gamma_3_2(0.5L * x);
        const Real sum = lower_gamma_3_2(x) / power_3_2(lambda) + yielded * half * upper;
        const Real slope =
            sqrtl(x) * decay / power_3_2(lambda) - 0.5L * yielded * half * (upper + sqrtl(0.5L * x) * half);
        const Real tangential = 2.0L * (1.0L - nu) / (2.0L - nu);
        at.stiffness = scene->stiffnessScale * density * 2.0L * E * tangential * sqrtl(R * R_q) * sum;
        at.by_stiffness = 1.0L / E + slope * x_E / sum;
    }
    return at;
}

// ---- The scene at a time ----

typedef struct {
    ReferenceScene scene;
    // The velocity [m/s] is start + rate t + Re(x turn), Re(y turn), with turn = e^(i omega t) - 1.
    Vector start, rate, x, y;
    // The separation [m] is d + d_rate t + Re(swing e^(i omega t)).
    Real d, d_rate;
    Vector swing;
    Real h, omega, decay, swell, excess;
    Real m;         // kg, the mass that moves along; 0 if there is none, or while a bristle jumps or settles
    Real cycle;     // 1, the part of a period before the start
    AtModulus held; // at the modulus of the start
    bool elastic;   // the law is ElasticPlastic
    bool bounded;   // a bristle has a bound: ElasticPlastic's, or the limit of Dahl's and LuGre's that moves
    bool open;      // nothing touches
    bool ramp;      // between two steps: nothing moves a bristle but its bound
    bool pushed;    // after the ramp, a bristle that has broken away
    // On a ramp: rates [1/s] of the logarithms of F_C or mu, of the stiffness's factor, ..
    struct {
        Real limit, scale, ratio, V_S;
    } ln_rate;
    Real S;   // N
    Real top; // m/s, the largest |V|
    int fineness;
    Real panels; // taken so far
} World;

// At a local time.
typedef struct {
    Vector V;                 // m/s, 0 on a ramp
    Vector input;             // m/s, the same on a ramp too
    Real F_n, sigma;          // N, N/m
    Real coulomb;             // N, F_C or mu F_n
    Real g;                   // N, the force to which a bristle tends
    Real D, D_rate, D_static; // m, m/s, m: the bounds of a bristle that slips, and of one that sticks
    Real rate;                // 1/s, of ln(limit / sigma) without Stribeck's curve
} At;

// (cos, sin) of 2 pi turns: by an angle of at most an eighth of a turn, which the library need not reduce.
static Vector direction(Real turns) {
    const Real quarters = rintl(4.0L * turns), rest = 2.0L * PI * (turns - 0.25L * quarters);
    const Real x = cosl(rest), y = sinl(rest);
    const Vector of[] = {CMPLXL(x, y), CMPLXL(-y, x), CMPLXL(-x, -y), CMPLXL(y, -x)};
    return of[(long)quarters & 3];
}

static Real dot(Vector a, Vector b) { return creall(a) * creall(b) + cimagl(a) * cimagl(b); }
// Turned by a quarter.
static Vector across(Vector a) { return CMPLXL(-cimagl(a), creall(a)); }
static Real length_of(Vector a) { return cimagl(a) == 0.0L ? fabsl(creall(a)) : sqrtl(dot(a, a)); }
// Of that length along another, or 0.
static Vector along(Vector a, Real length) {
    const Real now = length_of(a);
    return now > 0.0L ? (length / now * a) : a;
}

bool vibrates(const ReferenceScene* s) { return s->V_1 != 0.0 || s->V_2 != 0.0 || s->a_d != 0.0; }

// (cos(omega t) - 1, sin(omega t)). The first keeps its digits: a step of 1e-14 s may lie next to a reversal.
static Vector turn_at(const World* w, Real t) {
    const Vector half = vibrates(&w->scene) ? direction(0.5L * w->scene.f * t) : 1.0L;
    return 2.0L * cimagl(half) * across(half);
}

static Vector vibration(const World* w, Vector turn) {
    return CMPLXL(creall(w->x * turn), creall(w->y * turn));
}

static Vector velocity(const World* w, Real t, Vector turn) {
    return w->start + t * w->rate + vibration(w, turn);
}

// The velocity at a time and its derivatives up to that order.
static void velocities(const World* w, Real t, int order, Vector* V) {
    Vector turn = turn_at(w, t);
    V[0] = velocity(w, t, turn);
    turn += 1.0L;
    for (int k = 1; k <= order; k++) {
        turn = w->omega * across(turn);
        V[k] = vibration(w, turn);
    }
    V[1] = order > 0 ? (V[1] + w->rate) : V[1];
}

// The bristle, or Coulomb's limit, depends on the separation.
static bool knows_contact(const ReferenceScene* s) {
    return s->limit == LIMIT_LOAD || s->contact != CONTACT_CONSTANT;
}

// F_n, sigma and the rate; the terms that cancel in it are left out.
static At contact_at(const World* w, Real t, Vector turn) {
    const ReferenceScene* s = &w->scene;
    At at = {.sigma = s->contact_sigma};
    if (w->open || !knows_contact(s)) {
        return at;
    }
    const AtModulus of = s->E_rate == 0.0 ? w->held : at_modulus(s, (Real)s->E + s->E_rate * t);
    const Vector swing = w->swing * (1.0L + turn);
    Real d, d_rate = -w->omega * cimagl(swing);
    if (s->input == INPUT_LOAD) {
        const Real rate = s->load_rate, load = rate == 0.0L ? s->load : rate * (t + s->load / rate);
        at.F_n = load / w->swell * expl(-w->decay * creall(swing));
        d = logl(of.force * w->swell / load) / w->decay + creall(swing);
        d_rate += (of.by_force * s->E_rate - s->load_rate / load) / w->decay;
    } else {
        d = w->d + w->d_rate * t + creall(swing);
        at.F_n = of.force * expl(-w->decay * d);
        d_rate += w->d_rate;
    }
    const bool asperities = s->contact == CONTACT_ASPERITIES, mindlin = s->contact == CONTACT_MINDLIN;
    const Real share = at.F_n / of.force;
    at.sigma = asperities ? of.stiffness * share * share / (d * d * d)
               : mindlin  ? of.stiffness * share
                          : of.stiffness;
    // The powers of F_n in the limit and in the stiffness.
    const Real of_limit = s->limit == LIMIT_LOAD ? 1.0L : 0.0L, of_sigma = asperities ? 2.0L : mindlin;
    const Real by_E = of_limit * of.by_force - of.by_stiffness;
    const Real by_d = (of_sigma - of_limit) * w->decay + (asperities ? 3.0L / d : 0.0L);
    at.rate = by_E * s->E_rate + by_d * d_rate;
    return at;
}

static World at_rest(const World* w) {
    World rest = *w;
    rest.swing = 0.0L;
    return rest;
}

static const Real OPEN = 1e-100L; // N or N/m, of F_n and sigma without vibration

bool is_open(const World* w, Real t) {
    World rest = at_rest(w);
    rest.open = false;
    const At at = contact_at(&rest, t, 0.0L);
    return knows_contact(&w->scene) && !(at.F_n >= OPEN && at.sigma >= OPEN);
}

static At scene_at(const World* w, Real t) {
    const ReferenceScene* s = &w->scene;
    const Vector turn = turn_at(w, t);
    At at = contact_at(w, t, turn);
    const Vector V = velocity(w, t, turn);
    Real excess = w->excess, V_S = s->V_S;
    at.V = w->ramp ? 0.0L : V;
    at.input = V;
    at.coulomb = s->limit == LIMIT_LOAD ? s->mu * at.F_n : s->F_C;
    if (w->ramp) {
        at.sigma *= expl(w->ln_rate.scale * t);
        at.coulomb *= expl(w->ln_rate.limit * t);
        excess = (1.0L + w->excess) * expl(w->ln_rate.ratio * t) - 1.0L;
        V_S *= expl(w->ln_rate.V_S * t);
        at.rate += w->ln_rate.limit - w->ln_rate.scale;
    }
    at.g = at.coulomb;
    Real curve_rate = 0.0L;
    if (excess != 0.0L) {
        const Real square = dot(V, V) / (V_S * V_S), fall = expl(-square);
        const Real curve = 1.0L + excess * fall;
        at.g *= curve;
        Vector moves[2];
        velocities(w, t, 1, moves);
        const Real squares = 2.0L * (square * w->ln_rate.V_S - dot(V, moves[1]) / (V_S * V_S));
        curve_rate = ((1.0L + excess) * w->ln_rate.ratio + excess * squares) * fall / curve;
    }
    at.D_static = at.coulomb * (1.0L + excess) / at.sigma;
    at.D = w->elastic ? at.g / at.sigma : at.D_static;
    at.D_rate = at.D * (at.rate + (w->elastic ? curve_rate : w->ln_rate.ratio));
    return at;
}

// The force on the mass [N].
static Real push_at(const World* w, Real t) { return (Real)w->scene.F + w->scene.F_rate * t; }

// The velocity that the mass has gained since the start of the step [m/s], and its acceleration [m/s2] move the scene.
static At moved_at(const World* w, Real t, Real gained, Real acceleration) {
    World there = *w;
    there.rate += acceleration;
    there.start += gained - acceleration * t;
    return scene_at(&there, t);
}

// ---- The step ----

// Mean of the limit over a period of the vibration with the inputs of a time [N].
static Real mean_limit(const World* w, Real t) {
    World rest = at_rest(w);
    rest.open = is_open(w, t);
    return scene_at(&rest, t).coulomb * (w->scene.limit == LIMIT_LOAD ? w->swell : 1.0L);
}

// The largest speed [m/s] of a component, with its vibration.
static Real fastest(Real V, Real rate, Real swing, Real h) {
    return fmaxl(fabsl(V), fabsl(V + rate * h)) + fabsl(swing);
}

static World make_world(const ReferenceScene* scene, Real h, int fineness) {
    World w = {.scene = *scene,
               .h = h,
               .m = scene->m,
               .fineness = fineness,
               .elastic = scene->law == LAW_ELASTIC_PLASTIC};
    w.bounded = w.elastic || (scene->law != LAW_COULOMB && scene->limit == LIMIT_LOAD);
    w.excess = scene->law == LAW_LUGRE || w.elastic ? (Real)scene->staticRatio - 1.0L : 0.0L;
    w.omega = 2.0L * PI * scene->f;
    // The whole periods are taken off f start exactly: off the product and the remainder of its rounding.
    const double cycles = scene->f * scene->start;
    const double lost = fma(scene->f, scene->start, -cycles);
    w.cycle = (Real)(cycles - floor(cycles)) + lost;
    w.x = scene->V_1 * direction(w.cycle);
    w.y = scene->V_2 * direction(w.cycle + scene->phase_2 / (2.0L * PI));
    w.swing = scene->a_d * direction(w.cycle + scene->phase_d / (2.0L * PI));
    const Real V = (Real)scene->V + (scene->m > 0.0 ? scene->v_0 : 0.0);
    w.start = CMPLXL(V, scene->V_y) + vibration(&w, 1.0L);
    w.rate = CMPLXL(scene->V_rate, scene->V_y_rate);
    w.top =
        hypotl(fastest(V, scene->V_rate, scene->V_1, h), fastest(scene->V_y, scene->V_y_rate, scene->V_2, h));
    w.decay = (Real)scene->lambda / scene->R_q;
    w.swell = bessel_I0(w.decay * scene->a_d);
    w.held = at_modulus(scene, scene->E);
    w.d = scene->d;
    w.d_rate = scene->d_rate;
    return w;
}

// The separation [m] at the start, with the vibration.
static Real separation(const World* w) {
    const ReferenceScene* s = &w->scene;
    return creall(w->swing) +
           (s->input == INPUT_LOAD ? logl(w->held.force * w->swell / s->load) / w->decay : w->d);
}

ReferenceRest reference_rest(const ReferenceScene* scene) {
    ReferenceScene loaded = *scene;
    loaded.load = fmax(scene->load, 1e-99);
    const World moves = make_world(&loaded, 0.0L, 1), w = at_rest(&moves);
    const At at = scene_at(&w, 0.0L);
    return (ReferenceRest){(double)separation(&w), (double)at.coulomb, (double)at.sigma};
}

// ---- Panels ----

typedef struct {
    Vector end;            // m, delta at the end
    Vector change;         // m, of delta: a soft bristle's has more digits than the difference
    Vector impulse;        // N s
    Real work, heat, path; // J, J, m
    Real gained;           // m/s, what the mass has gained since the start of the step, at the end
    Real moved;            // m, its time integral
    Real length;           // m, the scale of errors of delta
    Real blur;             // m, of delta by the rounding of time
} Sums;

static void add_times(Sums* sums, const Sums* one, Real factor) {
    sums->impulse += factor * one->impulse;
    sums->work += factor * one->work;
    sums->heat += factor * one->heat;
    sums->path += factor * one->path;
    sums->moved += factor * one->moved;
}

static void add(Sums* sums, const Sums* part) {
    add_times(sums, part, 1.0L);
    sums->end = part->end;
    sums->gained = part->gained;
    sums->change += part->change;
    sums->length = part->length;
    sums->blur = part->blur;
}

// Adds a time [s] with that force of the bristle, rate of its deflection and velocity.
static void account(const World* w, Sums* sums, Vector spring, Vector rate, Vector V, Real time) {
    const Vector rest = w->scene.sigma_2 * V + w->scene.sigma_1 * rate;
    sums->impulse += time * (spring + w->scene.sigma_2 * V);
    sums->work += time * (dot(spring, V) + dot(rest, V));
    sums->heat += time * (dot(spring, V - rate) + dot(rest, V));
    sums->path += time * length_of(V);
}

// -d(delta') / d(delta) [1/s].
static Real relaxation(const World* w, const At* at) {
    return w->elastic ? 0.0L : at->sigma * length_of(at->V) / at->g;
}

// The rate [m/s] of a bristle by its law, or of one that slips along its bound.
static Vector rate_of(const World* w, const At* at, Vector delta, bool slips) {
    if (!slips) {
        return at->V - relaxation(w, at) * delta;
    }
    const Vector n = along(delta, 1.0L);
    return (at->D_rate * n) + dot(at->V, across(n)) * across(n);
}

// The speed [m/s] at which the law alone would carry a bristle of that direction beyond its kinetic bound.
static Real outward(const World* w, const At* at, Vector delta) {
    const Real own = dot(along(delta, 1.0L), at->V) - relaxation(w, at) * at->D;
    return own - at->D_rate;
}

// The motion continues as long as both signs are positive. A sign is INFINITY if it cannot end the motion.
typedef struct {
    Real room; // m, to the bound; N of Coulomb's stick, to the limit
    Real lead; // m/s, outward
    Real turn; // of a mass: its velocity where it slides [m/s]; its inertia over m where a bristle slips
} Signs;

static const Real ROUNDING = 1e-17L; // of the terms of a sign
static const Real ON_BOUND =
    1e-10L; // of a bound: the rounding of a phase may leave a bristle that slips so far inside
static const Real AS_DOUBLE = 1e-15L; // of a bound: the rounding of a deflection that is a double
static const Real AT_REST =
    4e-15L; // of the largest |V|: that of the velocity of a mass, and of a vibration's phase

// The bristle between two marches. Inside its bound it follows its law, if it has broken away until it catches up.
typedef struct {
    Vector delta; // m
    bool broke;   // with static friction: it has broken away, and slips or catches up
    Real gained;  // m/s, what the mass has gained since the start of the step
    int side;     // of a mass: the sign of V in the law, 0 if Coulomb's sticks
} State;

// The state of a march through the step.
typedef struct {
    World* w;
    Sums sums;
    State state;
    bool slips;    // along its bound
    bool slipped;  // at any time
    Real from;     // its last motion came to its end after this time,
    Real met_at;   // then,
    bool at_bound; // at its bound, not by its lead
    bool turned;   // with a mass: V has turned back
} March;

static bool has_bound(const World* w) { return w->bounded && !w->open; }
static bool has_curve(const World* w) { return w->excess + w->ln_rate.ratio != 0.0L; }
static bool has_static(const World* w) { return w->elastic && has_curve(w); }

// Whether a mass is at rest on Coulomb's friction.
static bool sticks(const March* march) {
    return march->w->m > 0.0L && march->w->scene.law == LAW_COULOMB && march->state.side == 0;
}

// What a mass at rest on Coulomb's friction leaves to it [N]: the force on the mass less what moves it with V.
static Real held_force(const World* w, Real t) {
    Vector V[2];
    velocities(w, t, 1, V);
    return push_at(w, t) + w->m * creall(V[1]);
}

// The slope by V [m s/m, s] of the bound of a bristle, or of the force g, along Stribeck's curve; 0 without one.
static Real curve_slope(const World* w, const At* at) {
    return w->excess == 0.0L
               ? 0.0L
               : -2.0L * creall(at->V) / ((Real)w->scene.V_S * w->scene.V_S) * (at->g - at->coulomb);
}

// The mass [kg] with what a bristle that slips adds by its damping, as its bound moves with V. At 0 V jumps.
static const Real AT_JUMP = 1e-4L;
static Real inertia(const World* w, const At* at, Vector delta) {
    return w->m + w->scene.sigma_1 * copysignl(1.0L, creall(delta)) * curve_slope(w, at) / at->sigma;
}

// Each sign has a slack of little more than its rounding.
static Signs signs_at(const March* march, const At* at, Real t, Vector delta) {
    const World* w = march->w;
    Signs signs = {INFINITY, INFINITY, INFINITY};
    if (sticks(march)) {
        signs.room = at->coulomb * (1.0L + ROUNDING) - fabsl(held_force(w, t));
    } else if (w->m > 0.0L && w->elastic) {
        signs.turn =
            march->slips && w->scene.sigma_1 != 0.0 ? inertia(w, at, delta) / w->m - AT_JUMP : INFINITY;
    } else if (w->m > 0.0L) {
        signs.turn = march->state.side * creall(at->V) + ROUNDING * (w->top + w->S * w->h / w->m);
    }
    if (!has_bound(w)) {
        return signs;
    }
    if (!march->slips) {
        // on a ramp in which nothing moves the deflection is a double
        const Real slack = w->ramp && has_static(w) && !march->state.broke ? 1e-11L : ROUNDING;
        // smooth where delta is 0
        const Real D = (march->state.broke ? at->D : at->D_static) * (1.0L + slack),
                   length = length_of(delta);
        signs.room = (D - length) * (0.5L + 0.5L * length / D);
    }
    if (!march->slips && march->state.broke && w->ramp) {
        signs.lead = w->pushed ? INFINITY : dot(along(delta, 1.0L), at->input);
    } else if (march->slips || march->state.broke) {
        signs.lead = outward(w, at, delta) + ROUNDING * (w->top + fabsl(at->D_rate));
    }
    return signs;
}

typedef struct {
    Sums sums;
    Signs sign[STAGES + 1]; // at the start and at the nodes
    Real V[STAGES + 1];     // m/s
} Panel;

// That direction, turned by an angle [rad].
static Vector turned(Vector n, Real angle) { return angle == 0.0L ? n : direction(angle / (2.0L * PI)) * n; }

// At the nodes the changes Y of delta, or the angles from its direction if it slips along its bound, by Newton from 0:
// Y_i = size sum_j to_ij rate_j(Y_j). Returns false if that does not converge; without slip the equations are linear.
static bool collocate(const World* w, const At* at, Real size, Vector delta, bool slips, Vector* Y) {
    for (int k = 0; k < 25; k++) {
        Real A[STAGES][STAGES], most = 0.0L;
        Vector step[STAGES];
        for (int i = 0; i < STAGES; i++) {
            step[i] = -Y[i];
        }
        for (int j = 0; j < STAGES; j++) {
            const Vector n = turned(along(delta, 1.0L), creall(Y[j]));
            const Real lies = at[j].D, r = relaxation(w, &at[j]);
            const Vector rate = slips ? dot(at[j].V, across(n)) / lies : at[j].V - r * delta;
            const Real slope = slips ? -dot(at[j].V, n) / lies : -r;
            if (!(size * slope < 1.0L)) { // an unstable direction: a long panel would not leave it
                return false;
            }
            for (int i = 0; i < STAGES; i++) {
                const Real weight = size * the_rule()->to[i][j];
                A[i][j] = (i == j ? 1.0L : 0.0L) - weight * slope;
                step[i] += weight * rate;
            }
        }
        solve(A, step);
        for (int i = 0; i < STAGES; i++) {
            Y[i] += step[i];
            most = fmaxl(most, length_of(step[i]));
        }
        if (!slips || most < 1e-9L) { // the next would be 1e-18
            return true;
        }
        if (!(most < 3.0L)) {
            return false;
        }
    }
    return false;
}

// ---- A mass on the contact: m v' = F - F_t, along a line ----

// Adds to the rate of a bound that moves with V what the acceleration of the mass adds.
static void accelerate(const World* w, At* at, Real t, Real delta, bool slips) {
    const Real by_V = has_static(w) ? curve_slope(w, at) / at->sigma : 0.0L, V = creall(at->V);
    const Real sigma_1 = w->scene.sigma_1, n = slips ? copysignl(1.0L, delta) : 0.0L;
    const Real force = at->sigma * delta + w->scene.sigma_2 * V + sigma_1 * (slips ? n * at->D_rate : V);
    at->D_rate += by_V * (push_at(w, t) - force) / (slips ? inertia(w, at, delta) : w->m);
}

// The scene of a state.
static At at_state(const World* w, Real t, State state, bool slips) {
    At at = moved_at(w, t, state.gained, 0.0L);
    if (w->m > 0.0L && !w->open && w->scene.law != LAW_COULOMB) {
        accelerate(w, &at, t, creall(state.delta), slips);
    }
    return at;
}

// The law at a node. The sign of V in it is that of the motion, so all is smooth.
typedef struct {
    Real rate, rate_by_delta, rate_by_V;    // m/s, 1/s, 1
    Real force, force_by_delta, force_by_V; // N, N/m, N s/m, without sigma_1
} Law;

static Law law_at(const March* march, const At* at, bool bristle, bool slips, Real delta) {
    const World* w = march->w;
    const Real V = creall(at->V), sigma_2 = w->scene.sigma_2, slope = curve_slope(w, at);
    if (!bristle) {
        const Real coulomb = w->scene.law == LAW_COULOMB ? at->coulomb : 0.0L;
        return (Law){.force = march->state.side * coulomb + sigma_2 * V, .force_by_V = sigma_2};
    }
    if (slips) { // the deflection less the bound, in place of a rate
        const Real n = copysignl(1.0L, delta), by_V = w->elastic ? slope / at->sigma : 0.0L;
        return (Law){n * at->D, 0.0L, n * by_V, at->sigma * delta + sigma_2 * V, at->sigma, sigma_2};
    }
    const Real r = w->elastic ? 0.0L : at->sigma * march->state.side / at->g;
    return (Law){.rate = V - r * V * delta,
                 .rate_by_delta = -r * V,
                 .rate_by_V = 1.0L - r * delta * (1.0L - V * slope / at->g),
                 .force = at->sigma * delta + sigma_2 * V,
                 .force_by_delta = at->sigma,
                 .force_by_V = sigma_2};
}

// At the nodes the scene, the change of delta and the velocity gained, by Newton from none. Returns false if that does not
// converge.
static bool collocate_mass(const March* march, const Real t[STAGES], Real size, State from, At at[STAGES],
                           Vector change[STAGES], Real gained[STAGES]) {
    const World* w = march->w;
    const bool bristle = !w->open && w->scene.law != LAW_COULOMB, slips = march->slips;
    const Real sigma_1 = bristle ? w->scene.sigma_1 : 0.0L, delta = creall(from.delta);
    Real length = 0.0L, last = INFINITY;
    for (int i = 0; i < STAGES; i++) {
        gained[i] = from.gained;
        if (sticks(march)) {
            at[i] = scene_at(w, t[i]);
            gained[i] = -creall(at[i].V);
            at[i].V = 0.0L;
        }
    }
    for (int k = 0; k < 40 && !sticks(march); k++) {
        double A[UNKNOWNS][UNKNOWNS] = {{0.0}}, rough[UNKNOWNS];
        Real step[UNKNOWNS];
        for (int i = 0; i < STAGES; i++) {
            step[i] = -creall(change[i]);
            step[STAGES + i] = -w->m * (gained[i] - from.gained) - sigma_1 * creall(change[i]);
            A[i][i] = 1.0;
            A[STAGES + i][i] = (double)sigma_1;
            A[STAGES + i][STAGES + i] = (double)w->m;
        }
        for (int j = 0; j < STAGES; j++) {
            at[j] = moved_at(w, t[j], gained[j], 0.0L);
            const Law law = law_at(march, &at[j], bristle, slips, delta + creall(change[j]));
            length = bristle ? fmaxl(length, at[j].g / at[j].sigma) : 1.0L;
            for (int i = 0; i < STAGES; i++) {
                const Real weight = size * the_rule()->to[i][j], direct = slips ? (Real)(i == j) : weight;
                step[i] += direct * (law.rate - (slips ? delta : 0.0L));
                step[STAGES + i] += weight * (push_at(w, t[j]) - law.force);
                A[i][j] -= (double)(direct * law.rate_by_delta);
                A[i][STAGES + j] -= (double)(direct * law.rate_by_V);
                A[STAGES + i][j] += (double)(weight * law.force_by_delta);
                A[STAGES + i][STAGES + j] += (double)(weight * law.force_by_V);
            }
        }
        for (int i = 0; i < UNKNOWNS; i++) {
            rough[i] = (double)step[i];
        }
        solve_roughly(A, rough);
        Real most = 0.0L;
        for (int i = 0; i < STAGES; i++) {
            change[i] += rough[i];
            gained[i] += rough[STAGES + i];
            const Real speed = w->S * size / w->m + 1e-8L * (w->top + fabsl(gained[i]));
            most = fmaxl(most, fmaxl(fabs(rough[i]) / length, fabs(rough[STAGES + i]) / speed));
        }
        if (most < 1e-11L || (most < 1e-7L && most >= 0.1L * last)) { // the next is its square, or rounding
            return true;
        }
        if (!(most < 1e6L)) {
            return false;
        }
        last = most;
    }
    return sticks(march);
}

// The motion that begins: the sign of V, or of V soon if it is 0.
static void choose_side(March* march, Real t) {
    const World* w = march->w;
    if (w->m == 0.0L) {
        return;
    }
    const At at = moved_at(w, t, march->state.gained, 0.0L);
    const Real V = creall(at.V), force = held_force(w, t);
    const bool coulomb = w->scene.law == LAW_COULOMB;
    const Real soon = coulomb ? force : force - (w->open ? 0.0L : at.sigma * creall(march->state.delta));
    const bool rests = fabsl(V) <= AT_REST * w->top || march->turned;
    march->state.side = !rests                                  ? (V > 0.0L ? 1 : -1)
                        : coulomb && fabsl(force) <= at.coulomb ? 0
                        : march->turned && !coulomb             ? -march->state.side
                                                                : (soon >= 0.0L ? 1 : -1);
    march->turned = false;
}

// Coulomb's force. At the end of a panel V may be 0 but for rounding: it comes there against its rate.
static Vector coulomb_force(const World* w, const At* at, Real t, bool ends) {
    Vector V[2] = {at->V};
    if (ends && length_of(at->V) <= 1e-17L * w->top) {
        velocities(w, t, 1, V);
        V[0] = -1.0L * V[1];
    }
    return along(V[0], at->coulomb);
}

static Panel panel(const March* march, Real a, Real b, State from) {
    enum { last = STAGES - 1 };
    World* w = march->w;
    const Rule* rule = the_rule();
    const Real size = b - a;
    const Vector delta = from.delta;
    const bool bristle = !w->open && w->scene.law != LAW_COULOMB, slips = march->slips, moves = w->m > 0.0L;
    Panel p = {.sums = {.end = delta}};
    At at[STAGES];
    Vector change[STAGES] = {0.0L};
    Real times[STAGES], gained[STAGES] = {0.0L};
    w->panels += 1.0L;
    for (int i = 0; i < STAGES; i++) {
        times[i] = a + size * rule->node[i + 1];
        at[i] = scene_at(w, times[i]);
    }
    if (moves ? !collocate_mass(march, times, size, from, at, change, gained)
              : bristle && !collocate(w, at, size, delta, slips, change)) {
        p.sums.end = (Real)NAN; // agrees with nothing
        return p;
    }
    Real relaxed = 0.0L, fastest = 0.0L;
    for (int i = 0; i < STAGES; i++) {
        const Real t = times[i];
        Vector rate = 0.0L, spring = 0.0L;
        if (slips && !moves) {
            change[i] = turned(along(delta, at[i].D), creall(change[i])) - delta;
        }
        const Vector now = delta + change[i];
        if (moves && bristle) {
            accelerate(w, &at[i], t, creall(now), slips);
        }
        if (bristle) {
            rate = rate_of(w, &at[i], now, slips);
            spring = at[i].sigma * now;
            relaxed += slips ? 0.0L : size * rule->weight[i] * relaxation(w, &at[i]);
            fastest = fmaxl(fastest, length_of(rate));
        } else if (w->scene.law == LAW_COULOMB) {
            spring = sticks(march) ? held_force(w, t)
                     : moves       ? march->state.side * at[i].coulomb
                                   : coulomb_force(w, &at[i], t, i == last);
        }
        account(w, &p.sums, spring, rate, at[i].V, size * rule->weight[i]);
        p.sums.moved += size * rule->weight[i] * gained[i];
        p.sign[i + 1] = signs_at(march, &at[i], t, now);
        p.V[i + 1] = creall(at[i].V);
    }
    p.sums.gained = gained[last];
    if (bristle) {
        p.sums.change = change[last];
        p.sums.end = delta + change[last];
        p.sums.blur = fastest * expl(-relaxed) * 2.0L * LDBL_EPSILON * b;
        p.sums.length = fmaxl(length_of(p.sums.end), at[last].g / at[last].sigma);
        p.sums.impulse += w->scene.sigma_1 * p.sums.change;
    }
    const At first = at_state(w, a, from, slips);
    p.sign[0] = signs_at(march, &first, a, delta);
    p.V[0] = creall(first.V);
    return p;
}

static const Real AGREE = 1e-13L; // the halves are then right to some 1e-17
static const Real LEAST = 1e-16L; // of the whole step: smaller errors of a panel are accepted
static const int DEEPEST = 110;
static const Real MAX_PANELS = 1e6L,
                  MAX_OF_SETTLING = 1.5e5L; // more are not taken, and the result is not known

// Whether a panel of this size [s] and its halves give the same.
static bool agree(const World* w, const Sums* one, const Sums* two, Real size) {
    const Real share = w->fineness == 1 ? 1.0L : 0.01L;
    const Real change = length_of(two->change), force = w->S + w->scene.sigma_1 * change / size;
    const Real impulse = share * force * (AGREE * size + LEAST * w->h);
    const Real way = two->path + change, whole = w->top * w->h + two->length;
    const Real energy = share * force * (AGREE * way + LEAST * whole);
    return length_of(one->end - two->end) <= share * AGREE * two->length + two->blur &&
           fabsl(one->path - two->path) <= share * (AGREE * way + LEAST * whole) &&
           length_of(one->impulse - two->impulse) <= impulse && fabsl(one->work - two->work) <= energy &&
           fabsl(one->heat - two->heat) <= energy;
}

// Whether a finite sign that is positive at three nodes may be negative between them: by the parabola through them.
static bool dips(const Real* x, Real y_0, Real y_1, Real y_2, Real rounding) {
    if (!(y_0 > rounding && y_0 < INFINITY)) {
        return false;
    }
    const Real left = (y_1 - y_0) / (x[1] - x[0]), right = (y_2 - y_1) / (x[2] - x[1]);
    const Real curve = (right - left) / (x[2] - x[0]), least = fminl(y_0, fminl(y_1, y_2));
    const Real lowest = 0.5L * (x[0] + x[1] - left / curve);
    const Real low = y_0 + (lowest - x[0]) * (left + curve * (lowest - x[1]));
    return curve > 0.0L && lowest > x[0] && lowest < x[2] && low < 0.5L * least && least - low > rounding;
}

// Whether the motion is over at node k; 0 is the start.
static bool is_over(const Panel* p, int k) {
    return p->sign[k].lead < 0.0L || p->sign[k].room < 0.0L || p->sign[k].turn < 0.0L;
}

// Whether a motion may end unseen in a panel. At its begin a sign is 0 and rises.
static bool hides(const World* w, const Panel* p) {
    const Real *x = the_rule()->node, of_room = 1e-15L * p->sums.length, of_lead = 1e-15L * w->top;
    for (int k = 0; k + 2 <= STAGES && !is_over(p, k + 2); k++) {
        const Signs* s = &p->sign[k];
        if (dips(&x[k], s[0].room, s[1].room, s[2].room, of_room) ||
            dips(&x[k], s[0].lead, s[1].lead, s[2].lead, of_lead) ||
            dips(&x[k], s[0].turn, s[1].turn, s[2].turn, of_lead)) {
            return true;
        }
    }
    // A mass may pass Stribeck's curve between two nodes.
    for (int k = 0; k < STAGES && w->m > 0.0L && has_curve(w); k++) {
        const Real slow = fminl(fabsl(p->V[k]), fabsl(p->V[k + 1])), V_S = w->scene.V_S;
        if (slow < 7.0L * V_S && fabsl(p->V[k + 1] - p->V[k]) > 0.5L * V_S) {
            return true;
        }
    }
    return false;
}

static Real beyond(const void* context, Real t) {
    const March* march = context;
    const Panel p = panel(march, march->from, t, march->state);
    const Signs s = p.sign[STAGES];
    return -fminl(s.room, fminl(s.lead, s.turn));
}

// Draws low and high together about a crossing by secants, for crossing() to end.
static void narrow(Function* function, const void* context, Real* low, Real* high) {
    Real at_low = function(context, *low), at_high = function(context, *high);
    for (int k = 0; k < 20 && at_low < 0.0L && at_high > 0.0L && isfinite(at_high - at_low); k++) {
        const Real width = *high - *low, margin = ldexpl(width, k % 3 == 2 ? -1 : -12);
        const Real secant = *low - width * at_low / (at_high - at_low);
        const Real x = fminl(fmaxl(secant + (k % 2 ? margin : -margin), *low + margin), *high - margin);
        const Real at = function(context, x);
        if (!(x > *low && x < *high) || isnan(at)) {
            return;
        }
        *(at > 0.0L ? high : low) = x;
        *(at > 0.0L ? &at_high : &at_low) = at;
    }
}

// Takes an accurate panel, up to the motion's end if that lies in it; returns whether it does.
static bool commit(March* march, Real a, Real b, const Panel* p) {
    const World* w = march->w;
    int k = 0;
    while (k <= STAGES && !is_over(p, k)) {
        k++;
    }
    Panel part = *p;
    if (k <= STAGES) {
        march->from = a;
        const Real* x = the_rule()->node;
        Real low = a + (b - a) * x[k < 2 ? 0 : k - 1], high = a + (b - a) * x[k];
        if (w->m > 0.0L && k > 1) {
            narrow(beyond, march, &low, &high);
        }
        march->met_at = k == 0 ? a : crossing(beyond, march, low, high);
        march->at_bound = p->sign[0].room < 0.0L;
        march->turned = p->sign[0].turn < 0.0L;
        if (!(march->met_at > a)) {
            return true;
        }
        part = panel(march, a, march->met_at, march->state);
        march->at_bound = part.sign[STAGES].room < 0.0L;
        march->turned = part.sign[STAGES].turn < 0.0L;
    }
    add(&march->sums, &part.sums);
    march->state.delta = part.sums.end;
    march->state.gained = part.sums.gained;
    return k <= STAGES;
}

// ---- Cuts of the step ----

typedef struct {
    const World* w;
    int order; // of the derivative of half of V^2, on a line of V for V itself
} Square;

// On a ramp V is linear, and the product V V' tells its zero, too.
static bool is_on_line(const World* w) {
    return !w->ramp && cimagl(w->start) == 0.0L && cimagl(w->rate) == 0.0L && w->y == 0.0L;
}

static Real square(const void* context, Real t) {
    const Square* of = context;
    Vector V[4];
    velocities(of->w, t, of->order, V);
    if (is_on_line(of->w)) {
        return creall(V[of->order - 1]);
    }
    return of->order == 1   ? dot(V[0], V[1])
           : of->order == 2 ? dot(V[1], V[1]) + dot(V[0], V[2])
                            : 3.0L * dot(V[1], V[2]) + dot(V[0], V[3]);
}

// The end of the piece that begins at t: pieces are equal parts of a period, or of a ramp.
static Real end_of_piece(const World* w, Real to, Real t) {
    const Real pieces = 8.0L * w->scene.f,
               first = w->cycle / w->scene.f; // 1/s; s, since the start of the period
    Real k = floorl((first + t) * pieces);
    while (!(k / pieces - first > t)) {
        k += 1.0L;
    }
    return w->ramp || vibrates(&w->scene) ? fminl(to, k / pieces - first) : to;
}

// ---- The march through the step ----

// Whether a bristle that has broken away, but does not slip, catches up with its bound; else it sticks. On a ramp V or the
// push after it decides, so that held steps come to the ramp that they sample.
static bool catches(const World* w, const At* at, Vector delta, bool pushed) {
    return w->ramp ? w->pushed || dot(delta, at->input) > 0.0L : pushed;
}

// The motion at the begin of a part. If the push is 0, the later push decides: the bristle slips if V, its bound or its own turn
// is such that it is pushed then, and sticks if not. On a ramp from V = 0 the later V decides.
static void begin(March* march, Real a, Real b) {
    World* w = march->w;
    march->slips = false;
    choose_side(march, a);
    if (!has_bound(w)) {
        march->state.broke = false;
        return;
    }
    const Real soon = ldexpl(b - a, -20);
    const At at = at_state(w, a, march->state, true);
    State then = march->state;
    if (w->m > 0.0L) {
        const Real damping = w->scene.sigma_1 + w->scene.sigma_2;
        then.gained += (push_at(w, a) - at.sigma * creall(then.delta) - damping * creall(at.V)) / w->m * soon;
    }
    const At later = at_state(w, a + soon, then, true);
    const Real D = march->state.broke ? at.D : at.D_static, length = length_of(march->state.delta);
    if (length > D && length < (1.0L + 10.0L * AS_DOUBLE) * D) {
        march->state.delta = along(march->state.delta, D); // it is beyond by its rounding alone
    }
    const Real push = outward(w, &at, march->state.delta);
    const Real rounding = ROUNDING * (w->top + fabsl(at.D_rate));
    const Vector side = across(along(march->state.delta, 1.0L));
    const Vector turns = march->state.delta + soon * dot(side, at.V) * side;
    const bool pushed = push > rounding || (push >= -rounding && outward(w, &later, turns) > 0.0L);
    const bool no_V = w->ramp && dot(march->state.delta, at.input) == 0.0L;
    const Real slack = !w->ramp ? AS_DOUBLE : march->state.broke ? ON_BOUND : 0.0L;
    const bool lies = length >= (1.0L - slack) * at.D;
    march->slips = pushed && lies && (march->state.broke || !has_static(w));
    march->state.broke =
        march->state.broke && (march->slips || catches(w, no_V ? &later : &at, march->state.delta, pushed));
    march->slipped = march->slipped || march->slips || march->state.broke;
}

// Break-away: the bristle drops along its direction, and its damping adds an impulse, which a mass takes up: at once m V +
// sigma_1 delta stays. `kick` [m/s] leads off from the bound where V jumps along it.
static void break_away(March* march, At* at, Real kick) {
    const World* w = march->w;
    const Vector from = march->state.delta;
    Vector to = along(from, at->D);
    if (w->m > 0.0L && w->scene.sigma_1 != 0.0) {
        const Real gained = march->state.gained;
        for (int k = 0; k < 10000; k++) { // to the bound at the velocity after the drop
            march->state.gained =
                gained + w->scene.sigma_1 / w->m * creall(from - to) + (k == 0 ? kick : 0.0L);
            *at = at_state(w, march->met_at, march->state, true);
            to = along(from, at->D);
        }
        at->V -= 0.5L * (march->state.gained - gained); // the mean, for the work
    }
    const Vector damping = w->scene.sigma_1 * (to - from);
    const Real lost = dot(from - to, from + to);
    march->sums.impulse += damping;
    march->sums.work += dot(damping, at->V);
    march->sums.heat += dot(damping, at->V) + 0.5L * at->sigma * lost;
    march->state.delta = to;
    march->state.broke = true;
}

// The motion after the end of another.
static void change_motion(March* march) {
    const World* w = march->w;
    if (march->turned && w->elastic) {
        At at = at_state(w, march->met_at, march->state, true);
        const Real force = at.sigma * creall(march->state.delta) + w->scene.sigma_2 * creall(at.V);
        const Real push = push_at(w, march->met_at) - force;
        march->turned = false;
        break_away(march, &at, copysignl(1e-3L * w->scene.V_S, push));
        at = at_state(w, march->met_at, march->state, true);
        march->slips = outward(w, &at, march->state.delta) > 0.0L;
        march->state.broke = march->slips;
        return;
    }
    if (march->turned || sticks(march)) {
        march->turned = true;
        choose_side(march, march->met_at);
        return;
    }
    At at = at_state(w, march->met_at, march->state, march->slips || march->at_bound);
    march->slips = false;
    if (march->at_bound) {
        if (has_static(w) && !march->state.broke) {
            break_away(march, &at, 0.0L);
            at = at_state(w, march->met_at, march->state, true);
        } else {
            march->state.delta = along(march->state.delta, at.D);
        }
        march->slips = outward(w, &at, march->state.delta) > 0.0L;
        march->slipped = true;
    }
    march->state.broke = march->state.broke && (march->slips || catches(w, &at, march->state.delta, false));
}

// Takes [a, b] in panels that are halved until one agrees with its two halves.
static void march_between(March* march, Real a, Real b) {
    World* w = march->w;
    const Real least = ldexpl(b - a, -DEEPEST);
    Real end = b;
    while (a < b && w->panels <= MAX_PANELS) {
        const Real middle = 0.5L * (a + end);
        State half = march->state;
        const Panel one = panel(march, a, end, march->state);
        const Panel left = panel(march, a, middle, march->state);
        half.delta = left.sums.end;
        half.gained = left.sums.gained;
        const Panel right = panel(march, middle, end, half);
        Sums two = left.sums;
        add(&two, &right.sums);
        const bool good = agree(w, &one.sums, &two, end - a) && !hides(w, &left) && !hides(w, &right);
        if (!good && end - a > least && middle > a && middle < end) {
            end = middle;
            continue;
        }
        const bool met = commit(march, a, middle, &left) || commit(march, middle, end, &right);
        const Real size = end - a;
        a = met ? march->met_at : end;
        end = fminl(b, a + 2.0L * size);
        if (met) {
            change_motion(march);
        }
    }
}

// Whether the load falls or rises by decades in a piece, or Stribeck's curve by more than a part: the nodes of a long panel may
// not see where.
static bool is_steep(const World* w, Real a, Real b) {
    const At first = scene_at(w, a), last = scene_at(w, b);
    const Real low = fminl(first.F_n, last.F_n), high = fmaxl(first.F_n, last.F_n);
    const Real V = length_of(first.input), V_end = length_of(last.input), V_S = w->scene.V_S;
    const bool falls = has_curve(w) && fabsl(V_end - V) > V_S && fminl(V, V_end) < 9.0L * V_S;
    return falls || high > 4.0L * low;
}

// Takes [a, b], cut at the zeros of derivatives of V^2 from this order down to the first, and in halves that are not steep.
// Between two zeros of one derivative lies at most one of the next. If V, V' and V'' are nearly 0 at once, the third
// derivative of V^2 has three zeros in a short time. So on a line V itself is looked at.
static void march_piece(March* march, Real a, Real b, int order) {
    const Square of = {march->w, order};
    Real cut = 0.5L * (a + b);
    if (order > 0) {
        cut = square(&of, a) * square(&of, b) < 0.0L ? crossing(square, &of, a, b) : b;
        march_piece(march, a, cut, order - 1);
        march_piece(march, cut, b, order - 1);
    } else if (cut > a && cut < b && is_steep(march->w, a, b)) {
        march_piece(march, a, cut, 0);
        march_piece(march, cut, b, 0);
    } else {
        march_between(march, a, b);
    }
}

// Takes [from, to], but for the edge of a closed contact: without load there is no rate.
static void march_part(March* march, Real from, Real to, bool open) {
    World* w = march->w;
    const Real edge = open ? 0.0L : ldexpl(to - from, -58);
    from += from > 0.0L ? edge : 0.0L;
    to -= to < w->h ? edge : 0.0L;
    w->open = open;
    for (Real a = from; a < to;) {
        const Real b = end_of_piece(w, to, a);
        if (a == from) {
            begin(march, a, b);
        }
        march_piece(march, a, b, w->m > 0.0L ? 0 : 3);
        a = b;
    }
}

// The contact opens; returns the heat: if the stiffness is constant, the bristle slides to 0 as the limit falls.
static Real release(const World* w, State* state) {
    const bool slides = w->scene.contact == CONTACT_CONSTANT && w->scene.law != LAW_COULOMB;
    const Real heat = slides ? 0.5L * w->scene.contact_sigma * dot(state->delta, state->delta) : 0.0L;
    state->delta = 0.0L;
    state->broke = false;
    return heat;
}

static Real openness(const void* world, Real t) { return is_open(world, t) ? 1.0L : -1.0L; }

static March march_from(World* w, State state) {
    March march = {.w = w, .state = state};
    const bool at_start = !w->ramp && is_open(w, 0.0L), at_end = !w->ramp && is_open(w, w->h);
    const Real turn = at_start == at_end ? w->h : crossing(openness, w, 0.0L, w->h);
    march_part(&march, 0.0L, turn, at_start);
    march.sums.heat += at_end && !at_start ? release(w, &march.state) : 0.0L;
    march_part(&march, turn, w->h, at_end);
    w->open = false;
    return march;
}

// The limit of a fast ramp from the start of a world to that of another, in a time of 1.
static World ramp_between(const World* from, const World* to) {
    World w = *from;
    ReferenceScene* s = &w.scene;
    const ReferenceScene* end = &to->scene;
    w.ramp = true;
    w.m = 0.0L;
    w.h = 1.0L;
    w.top = 0.0L;
    s->input = INPUT_SEPARATION;
    s->V_1 = s->V_2 = s->a_d = 0.0;
    s->f = 1.0;
    w.cycle = 0.0L;
    s->E_rate = end->E - s->E;
    w.d = separation(from);
    w.d_rate = separation(to) - w.d;
    w.rate = to->start - from->start;
    w.x = w.y = w.swing = 0.0L;
    w.ln_rate.limit = s->limit == LIMIT_LOAD ? logl((Real)end->mu / s->mu) : logl((Real)end->F_C / s->F_C);
    w.ln_rate.scale = s->contact == CONTACT_CONSTANT ? logl((Real)end->contact_sigma / s->contact_sigma)
                                                     : logl((Real)end->stiffnessScale / s->stiffnessScale);
    w.ln_rate.ratio = logl((1.0L + to->excess) / (1.0L + from->excess));
    w.ln_rate.V_S = logl((Real)end->V_S / s->V_S);
    return w;
}

// The effect of a jump of the inputs, or of a start beyond the bound, on the bristle; returns its heat.
static Real jump(const ReferenceScene* before, const World* w, State* state) {
    const World past = before ? make_world(before, 0.0L, w->fineness) : *w;
    if (is_open(w, 0.0L) ||
        (before && is_open(&past, 0.0L))) { // at the very start something held the bristle
        return release(w, state);
    }
    if (!w->bounded) {
        return 0.0L;
    }
    if (before != NULL) {
        World ramp = ramp_between(&past, w);
        const At after = at_state(w, 0.0L, *state, true);
        ramp.pushed = outward(w, &after, state->delta) > 0.0L;
        const At begin = scene_at(&ramp, 0.0L), end = scene_at(&ramp, 1.0L);
        ramp.S = fmaxl(w->S, begin.sigma * length_of(state->delta));
        // Without static friction no state tells that it slips.
        const bool slid =
            length_of(state->delta) >= (1.0L - ON_BOUND) * begin.D && dot(state->delta, begin.input) > 0.0L;
        state->broke = past.excess == 0.0L ? slid && has_static(&ramp) : state->broke;
        if (state->broke && dot(state->delta, begin.input) <= 0.0L &&
            fabsl(end.D - begin.D) <= ON_BOUND * begin.D) {
            state->broke = has_static(w);
            return 0.0L; // nothing but rounding: the next motion decides whether it slips
        }
        // The bound rises again before the bristle has caught up: it is faster than the bristle.
        state->broke = state->broke && !(length_of(state->delta) < (1.0L - ON_BOUND) * begin.D &&
                                         end.D > (1.0L + ON_BOUND) * begin.D);
        const March march = march_from(&ramp, *state);
        *state = (State){.delta = march.state.delta, .broke = march.state.broke && has_static(w)};
        return march.sums.heat;
    }
    const At at = scene_at(w, 0.0L);
    const Real length = length_of(state->delta);
    if (length <= (1.0L + 1e-11L) * (state->broke ? at.D : at.D_static)) {
        return 0.0L;
    }
    *state = (State){.delta = along(state->delta, at.D), .broke = has_static(w)};
    return 0.5L * at.sigma * (length - at.D) * (length + at.D);
}

// ---- Many equal periods ----

// As long as it touches no bound, a period maps delta in an affine way, the same along and across, and its sums are
// polynomials of degree 2 in delta: it multiplies (1, x, y, x^2 + y^2, impulse, work, heat, path) by a matrix, x = delta / unit.
enum { ROWS = 9, POWERS = 40 };
typedef struct {
    Real m[ROWS][ROWS];
} Map;

static Map find_map(const World* w, Real unit) {
    const Vector at[4] = {0.0L, 1.0L, -1.0L, CMPLXL(0.0L, 1.0L)};
    Map map = {.m = {{1.0L}}};
    Real of[4][5], way[4];
    Vector shift = 0.0L;
    World free = *w; // of a period that touches no bound
    free.bounded = false;
    for (int k = 0; k < 4; k++) {
        const March march = march_from(&free, (State){.delta = unit * at[k]});
        const Sums* s = &march.sums;
        shift = k == 0 ? (1.0L / unit * s->change) : shift;
        way[k] = creall(s->change) / unit;
        of[k][0] = creall(s->impulse), of[k][1] = cimagl(s->impulse), of[k][2] = s->work, of[k][3] = s->heat;
        of[k][4] = s->path;
    }
    const Real x = w->elastic && w->scene.V == 0.0 ? 0.0L : creall(shift); // it does not drift
    const Real y = w->elastic && w->scene.V_y == 0.0 ? 0.0L : cimagl(shift);
    const Real kept = 1.0L + (w->elastic ? 0.0L : 0.5L * (way[1] - way[2]));
    map.m[1][0] = x, map.m[1][1] = kept;
    map.m[2][0] = y, map.m[2][2] = kept;
    map.m[3][0] = x * x + y * y, map.m[3][1] = 2.0L * x * kept, map.m[3][2] = 2.0L * y * kept;
    map.m[3][3] = kept * kept;
    for (int i = 0; i < 5; i++) {
        Real* row = map.m[4 + i];
        row[0] = of[0][i];
        row[1] = 0.5L * (of[1][i] - of[2][i]);
        row[3] = 0.5L * (of[1][i] + of[2][i]) - of[0][i];
        row[2] = of[3][i] - of[0][i] - row[3];
        row[4 + i] = 1.0L;
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

// A period, and the powers 1, 2, 4, .. of its map.
typedef struct {
    World world;
    Real unit;         // m, of x
    Map power[POWERS]; // 0 before they are needed
} Period;

static const Real FOR_EVER = 0x1p39L + 1.0L; // periods: the highest power, and one

// delta after 2^k periods that touch no bound; adds their sums.
static Vector after_untouched(const Period* p, int k, Vector delta, Sums* sums) {
    const Vector x = 1.0L / p->unit * delta;
    Real of[ROWS];
    for (int i = 0; i < ROWS; i++) {
        const Real* row = p->power[k].m[i];
        of[i] = row[0] + creall(x) * row[1] + cimagl(x) * row[2] + dot(x, x) * row[3];
    }
    const Sums part = {.impulse = CMPLXL(of[4], of[5]), .work = of[6], .heat = of[7], .path = of[8]};
    add_times(sums, &part, 1.0L);
    return p->unit * CMPLXL(of[1], of[2]);
}

// Takes the periods that touch no bound, at the most n or FOR_EVER, and returns their number; the first one touches none. If a
// later one touches none, neither do those between, since delta moves along a line and such deflections are a convex set.
static Real pass_untouched(Period* p, State* state, Real n, Sums* sums) {
    World* w = &p->world;
    for (int k = 0; k < POWERS && p->power[k].m[0][0] == 0.0L; k++) {
        p->power[k] = k == 0 ? find_map(w, p->unit) : twice(&p->power[k - 1]);
    }
    Real passed = 1.0L;
    bool rises = true; // to the first power that is too high
    for (int k = 0; k >= 0; k += rises ? 1 : -1) {
        Sums after = *sums;
        const State to = {.delta = after_untouched(p, k, state->delta, &after)};
        const Real then = passed + ldexpl(1.0L, k);
        const bool fits = then <= fminl(n, FOR_EVER) && (!w->bounded || !march_from(w, to).slipped);
        if (fits) {
            *state = to;
            *sums = after;
            passed = then;
        }
        rises = rises && fits && k + 1 < POWERS;
    }
    *state = (State){.delta = after_untouched(p, 0, state->delta, sums)};
    return passed;
}

enum { MAX_CYCLE = 4096 };

typedef struct {
    State state;
    Real count; // periods before it
    Sums sums;  // up to it
} Mark;

static bool are_equal(State a, State b, Real unit) {
    return a.broke == b.broke && length_of(a.delta - b.delta) <= 3e-17L * (unit + length_of(b.delta));
}

// A length [m] of deflections.
static Real unit_of(const World* w) {
    const At at = scene_at(w, 0.0L);
    return is_open(w, 0.0L) ? 1.0L : at.D_static;
}

// Newton's step to the fixed point of a period's map, from a state and its end after the period.
static Vector newton_step(World* w, State state, Vector end, Real unit) {
    const Real drift = length_of(CMPLXL(w->scene.V, w->scene.V_y)) / w->scene.f;
    const Real step = 1e-3L * (w->elastic ? fminl(drift, unit) : unit);
    const Vector x = state.delta - step, y = state.delta - CMPLXL(0.0L, step), miss = end - state.delta;
    const Vector by_x = 1.0L / step * (end - march_from(w, (State){.delta = x}).state.delta);
    const Vector by_y = 1.0L / step * (end - march_from(w, (State){.delta = y}).state.delta);
    // of the columns 1 - by_x and i - by_y, by Cramer's rule
    const Vector a = 1.0L - by_x, b = CMPLXL(0.0L, 1.0L) - by_y;
    return CMPLXL(dot(across(b), miss), -dot(across(a), miss)) / dot(across(b), a);
}

// Takes n periods. If n is INFINITY, *mean is the mean force of the periods that repeat at last, and *state is that of the
// smallest deflection at the end of one that slips. Small slips come to periods that repeat in few of Newton's steps, though
// each changes the state by little; these are taken first if the last state does not depend on the start. Returns false if none
// of the first MAX_CYCLE that slip repeat.
static bool go_periods(const World* of, State* state, Real n, bool newton, Sums* sums, Vector* mean) {
    Period p = {.world = *of, .unit = unit_of(of)};
    World* w = &p.world;
    w->panels = 0.0L;
    Mark marks[MAX_CYCLE];
    int count = 0, steps = newton ? 60 : 0;
    for (Real done = 0.0L; done < n;) {
        const March march = march_from(w, *state);
        if (steps > 0 && w->panels > MAX_OF_SETTLING) {
            steps = 0;
            w->panels = 0.0L;
            continue;
        }
        if (w->panels > (isinf(n) ? MAX_OF_SETTLING : MAX_PANELS)) {
            return false;
        }
        if (!march.slipped && (steps == 0 || w->elastic)) { // an elastic one drifts until it slips
            const Real passed = pass_untouched(&p, state, n - done, sums);
            if (isinf(n) && passed == FOR_EVER) {
                *mean = w->scene.f * march_from(w, *state).sums.impulse;
                return true;
            }
            done += passed;
            continue;
        }
        if (steps > 0) {
            const Vector miss = march.state.delta - state->delta;
            const Vector step = newton_step(w, *state, march.state.delta, p.unit);
            if (length_of(miss) <= 1e-15L * p.unit && !(length_of(step) > 1e-12L * p.unit)) {
                *mean = w->scene.f * march.sums.impulse;
                return true;
            }
            steps--;
            const bool plain = steps % 4 == 0 || !(length_of(step) < 10.0L * p.unit); // there are kinks
            state->delta += plain ? miss : step;
            continue;
        }
        add_times(sums, &march.sums, 1.0L);
        *state = march.state;
        done += 1.0L;
        int k = count - 1;
        while (k >= 0 && !are_equal(marks[k].state, *state, p.unit)) {
            k--;
        }
        if (k < 0) {
            if (count == MAX_CYCLE) {
                return false;
            }
            marks[count++] = (Mark){*state, done, *sums};
            continue;
        }
        Sums cycle = *sums;
        add_times(&cycle, &marks[k].sums, -1.0L);
        const Real length = done - marks[k].count;
        if (isinf(n)) {
            *mean = w->scene.f / length * cycle.impulse;
            for (; k < count; k++) {
                const bool is_less = length_of(marks[k].state.delta) < length_of(state->delta);
                *state = is_less ? marks[k].state : *state;
            }
            return true;
        }
        const Real repeats = floorl((n - done) / length);
        add_times(sums, &cycle, repeats);
        done += repeats * length;
        count = 0;
    }
    return true;
}

// To the periodic state of held inputs, w of one period, or to sliding for ever; the mean force.
static bool settle(World* w, State* state, Vector* mean) {
    const ReferenceScene* s = &w->scene;
    w->m = 0.0L; // at the velocity that the mass has
    if (vibrates(s) || is_open(w, 0.0L) || s->law == LAW_COULOMB) {
        Sums sums = {0};
        const bool drifts = s->V != 0.0 || s->V_y != 0.0, swings = s->V_1 != 0.0 || s->V_2 != 0.0;
        const bool one_state = w->elastic ? drifts && w->excess == 0.0L : drifts || swings;
        return go_periods(w, state, INFINITY, one_state, &sums, mean);
    }
    const At at = scene_at(w, 0.0L);
    if (length_of(at.V) > 0.0L) {
        *state = (State){.delta = along(at.V, at.g / at.sigma), .broke = has_static(w)};
    }
    *mean = at.sigma * state->delta + s->sigma_2 * at.V;
    return true;
}

// ---- The step ----

// The same with its inputs held.
static World held_world(const World* w, Real h) {
    World held = *w;
    ReferenceScene* s = &held.scene;
    s->V += s->m > 0.0 ? s->v_0 : 0.0;
    s->V_rate = s->V_y_rate = s->d_rate = s->E_rate = s->load_rate = s->F_rate = 0.0;
    held.rate = 0.0L;
    held.d_rate = 0.0L;
    held.h = h;
    return held;
}

// The scale of the tolerance [N], for the deflection at the start.
static Real largest_force(const World* w, Vector delta) {
    const ReferenceScene* s = &w->scene;
    const bool bristle = s->law != LAW_COULOMB;
    Real S = (1.0L + w->excess) * fmaxl(mean_limit(w, 0.0L), mean_limit(w, w->h));
    if (bristle && !is_open(w, 0.0L)) {
        S = fmaxl(S, scene_at(w, 0.0L).sigma * length_of(delta));
    }
    return fmaxl(S, ((bristle ? (Real)s->sigma_1 : 0.0L) + s->sigma_2) * w->top);
}

// The force [N] at a time.
static Vector force_at(const World* w, Real t, State state) {
    const ReferenceScene* s = &w->scene;
    World there = *w;
    there.open = is_open(w, t);
    const At at = at_state(&there, t, state, state.broke);
    if (w->m > 0.0L && s->law == LAW_COULOMB && length_of(at.V) <= AT_REST * w->top) {
        return fminl(fmaxl(held_force(w, t), -at.coulomb), at.coulomb);
    }
    if (s->law == LAW_COULOMB || there.open) {
        return along(at.V, s->law == LAW_COULOMB ? at.coulomb : 0.0L) + s->sigma_2 * at.V;
    }
    const bool slips = w->bounded && (state.broke || !has_static(w)) &&
                       length_of(state.delta) >= (1.0L - ON_BOUND) * at.D &&
                       outward(w, &at, state.delta) > 0.0L;
    const Vector rate = rate_of(w, &at, state.delta, slips);
    return (at.sigma * state.delta + s->sigma_1 * rate) + s->sigma_2 * at.V;
}

static bool is_held(const ReferenceScene* s) {
    return s->V_rate == 0.0 && s->V_y_rate == 0.0 && s->d_rate == 0.0 && s->E_rate == 0.0 &&
           s->load_rate == 0.0;
}

static State start_of(const ReferenceScene* s) {
    return s->law == LAW_COULOMB ? (State){0}
                                 : (State){.delta = CMPLXL(s->delta_0, s->delta_y_0), .broke = s->slips != 0};
}

// Takes the step; returns false if it needs more panels or cycles than the reference takes.
static bool advance(World* w, State* state, Sums* sums) {
    const ReferenceScene* s = &w->scene;
    World rest = *w;
    bool known = true;
    if (is_held(s) && vibrates(s) && w->h * s->f > 4.0L && w->m == 0.0L) {
        World period = *w;
        Vector unused;
        period.h = 1.0L / s->f;
        const Real n = floorl(w->h * s->f);
        known = go_periods(&period, state, n, false, sums, &unused);
        rest.h = w->h - n / s->f;
    }
    const March march = march_from(&rest, *state);
    add_times(sums, &march.sums, 1.0L);
    *state = march.state;
    return known && rest.panels <= MAX_PANELS;
}

void reference_step(const ReferenceScene* before, const ReferenceScene* scene, int fineness,
                    ReferenceStep* result) {
    World w = make_world(scene, scene->h, fineness);
    State state = start_of(scene), seen = state; // before the rates of the inputs are known
    w.S = largest_force(&w, state.delta);
    World held = held_world(&w, 1.0L / scene->f);
    *result = (ReferenceStep){.S = (double)w.S, .known = true};
    Sums sums = {0};
    if (scene->law != LAW_COULOMB && scene->initial == START_SETTLED) {
        Vector mean;
        jump(NULL, &held, &state);
        result->known = settle(&held, &state, &mean);
        seen = state;
    } else if (scene->law != LAW_COULOMB) {
        jump(before, &held, &seen);
        sums.heat = jump(before, &w, &state);
    }
    const Vector start = force_at(&held, 0.0L, seen);
    result->known = advance(&w, &state, &sums) && result->known;
    const Vector force = force_at(&w, w.h, state), mean = 1.0L / w.h * sums.impulse;
    const Real v_0 = scene->v_0, s_0 = scene->x_0 + v_0 * scene->h;
    const Real results[RESULTS] = {creall(force),      cimagl(force),    creall(mean), cimagl(mean),
                                   creall(start),      cimagl(start),    sums.work,    sums.heat,
                                   v_0 + state.gained, s_0 + sums.moved, state.broke,  creall(state.delta),
                                   cimagl(state.delta)};
    for (int k = 0; k < RESULTS; k++) {
        result->result[k] = (double)results[k];
    }
    result->path = (double)sums.path;
}

bool reference_settled_force(const ReferenceScene* scene, double force[2], double* S) {
    ReferenceScene from_0 = *scene;
    from_0.start = 0.0;
    const World now = make_world(&from_0, 0.0L, 1);
    World w = held_world(&now, 1.0L / scene->f);
    State state = start_of(scene);
    Vector mean = {0};
    w.S = largest_force(&w, state.delta);
    jump(NULL, &w, &state);
    const bool known = settle(&w, &state, &mean);
    *S = (double)w.S;
    force[0] = (double)creall(mean), force[1] = (double)cimagl(mean);
    return known;
}
