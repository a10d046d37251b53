#include "moment.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

// ---- The contact ----

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

// By an angle of at most an eighth of a turn, which the library need not reduce.
Vector direction(Real turns) {
    const Real quarters = rintl(4.0L * turns), rest = 2.0L * PI * (turns - 0.25L * quarters);
    const Real x = cosl(rest), y = sinl(rest);
    const Vector of[] = {CMPLXL(x, y), CMPLXL(-y, x), CMPLXL(-x, -y), CMPLXL(y, -x)};
    return of[(long)quarters & 3];
}

Real dot(Vector a, Vector b) { return creall(a) * creall(b) + cimagl(a) * cimagl(b); }
Vector across(Vector a) { return CMPLXL(-cimagl(a), creall(a)); }
Real length_of(Vector a) { return cimagl(a) == 0.0L ? fabsl(creall(a)) : sqrtl(dot(a, a)); }
Vector along(Vector a, Real length) {
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

void velocities(const World* w, Real t, int order, Vector* V) {
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

// F_n, sigma and the rate of ln(limit / sigma) without Stribeck's curve. The terms that cancel in it are left out.
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
    at.bound_rate = by_E * s->E_rate + by_d * d_rate;
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

At scene_at(const World* w, Real t) {
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
        at.bound_rate += w->ln_rate.limit - w->ln_rate.scale;
    }
    at.kinetic_rate = at.bound_rate;
    at.bound_rate += w->ln_rate.ratio;
    at.B = at.coulomb * (1.0L + excess);
    at.g = at.coulomb;
    if (excess != 0.0L) {
        const Real square = dot(V, V) / (V_S * V_S), fall = expl(-square);
        const Real curve = 1.0L + excess * fall;
        at.g *= curve;
        Vector moves[2];
        velocities(w, t, 1, moves);
        const Real squares = 2.0L * (square * w->ln_rate.V_S - dot(V, moves[1]) / (V_S * V_S));
        at.kinetic_rate += ((1.0L + excess) * w->ln_rate.ratio + excess * squares) * fall / curve;
    }
    return at;
}

Real bound(const World* w, const At* at, bool sticks) {
    return (sticks || !w->elastic ? at->B : at->g) / at->sigma;
}
Real bound_rate(const World* w, const At* at, bool sticks) {
    return bound(w, at, sticks) * (sticks || !w->elastic ? at->bound_rate : at->kinetic_rate);
}

// ---- The step ----

Real mean_limit(const World* w, Real t) {
    World rest = at_rest(w);
    rest.open = is_open(w, t);
    return scene_at(&rest, t).coulomb * (w->scene.limit == LIMIT_LOAD ? w->swell : 1.0L);
}

// The largest speed [m/s] of a component, with its vibration.
static Real fastest(Real V, Real rate, Real swing, Real h) {
    return fmaxl(fabsl(V), fabsl(V + rate * h)) + fabsl(swing);
}

World make_world(const ReferenceScene* scene, Real h, int fineness) {
    World w = {.scene = *scene, .h = h, .fineness = fineness, .elastic = scene->law == LAW_ELASTIC_PLASTIC};
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
    w.start = CMPLXL(scene->V, scene->V_y) + vibration(&w, 1.0L);
    w.rate = CMPLXL(scene->V_rate, scene->V_y_rate);
    w.top = hypotl(fastest(scene->V, scene->V_rate, scene->V_1, h),
                   fastest(scene->V_y, scene->V_y_rate, scene->V_2, h));
    w.decay = (Real)scene->lambda / scene->R_q;
    w.swell = bessel_I0(w.decay * scene->a_d);
    w.held = at_modulus(scene, scene->E);
    w.d = scene->d;
    w.d_rate = scene->d_rate;
    return w;
}

Real separation(const World* w) {
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
