#include "scenes.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "fmu_step.h"
#include "names.h"

static const double TURN = 6.283185307179586;
static const double MOST_PERIODS = 30.0; // of a step, but for a few long ones

// ---------------------------------------------------------------------------------------------------------------------
// Random numbers: splitmix64, or bytes that a fuzzer chose, four for each number and zeros where they end
// ---------------------------------------------------------------------------------------------------------------------

typedef struct {
    uint64_t state;
    const uint8_t* bytes; // NULL: splitmix64
    size_t left;
} Draw;

static uint64_t next(Draw* draw) {
    if (draw->bytes != NULL) {
        uint64_t value = 0;
        for (int k = 0; k < 4 && draw->left > 0; k++, draw->left--) {
            value = value << 8 | *draw->bytes++;
        }
        return value << 32;
    }
    uint64_t z = draw->state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static double unit(Draw* draw) { return (double)(next(draw) >> 11) / 9007199254740992.0; }
static double between(Draw* draw, double low, double high) { return low + (high - low) * unit(draw); }
static double log_between(Draw* draw, double low, double high) { return low * pow(high / low, unit(draw)); }
static bool chance(Draw* draw, double probability) { return unit(draw) < probability; }
static double sign(Draw* draw) { return chance(draw, 0.5) ? 1.0 : -1.0; }
static int pick(Draw* draw, int count) { return (int)(unit(draw) * count); }

// ---------------------------------------------------------------------------------------------------------------------
// Parts of a scene
// ---------------------------------------------------------------------------------------------------------------------

static double top_speed(const ReferenceScene* s) { return fmax(fmax(fabs(s->V), s->V_1), 1e-6); }

static double velocity(Draw* draw, double V_1) {
    const double kind = unit(draw);
    if (kind < 0.05) {
        return 0.0;
    }
    if (V_1 > 0.0 && kind < 0.25) { // dips and grazing reversals
        return sign(draw) * V_1 * (1.0 + sign(draw) * log_between(draw, 1e-13, 1e-1));
    }
    if (V_1 > 0.0 && kind < 0.35) {
        return sign(draw) * V_1 * log_between(draw, 1e-9, 1.0);
    }
    if (V_1 > 0.0 && kind < 0.8) {
        return V_1 * between(draw, -3.0, 3.0);
    }
    return sign(draw) * log_between(draw, 1e-5, 10.0);
}

static void surfaces(Draw* draw, ReferenceScene* s) {
    if (chance(draw, 0.25)) {
        double* const sizes[] = {&s->R_q, &s->R, &s->eta, &s->A_n, &s->c, &s->lambda};
        for (int k = 0; k < 6; k++) {
            *sizes[k] *= log_between(draw, 0.7, 1.4);
        }
        s->nu = between(draw, 0.0, 0.49);
        s->Y *= log_between(draw, 0.3, 30.0);
    }
    s->E = chance(draw, 0.7) ? between(draw, 20e9, 90e9) : log_between(draw, 1e9, 1e12);
    const double length = s->R_q / s->lambda;
    s->d = length * (chance(draw, 0.8) ? between(draw, 5.0, 9.0) : log_between(draw, 0.3, 60.0));
    if (chance(draw, 0.65)) {
        s->a_d = length * log_between(draw, 1e-4, 1.3);
        if (chance(draw, 0.1)) { // down to contact
            s->a_d = s->d * (1.0 - log_between(draw, 1e-2, 0.5));
        }
        s->phase_d = chance(draw, 0.2) ? TURN / 4.0 * pick(draw, 4) : between(draw, -TURN, TURN);
    }
}

// F_n e^(lambda d / R_q) [N], by its plastic part, which is nearly all of it: good enough to choose a scale.
static double pressed(const ReferenceScene* s) {
    const double p_m = (1.234 + 1.256 * s->nu) * (1.0 - s->nu * s->nu) * s->Y;
    return s->eta * s->A_n * s->c * 2.0 * TURN / 2.0 * s->R * s->R_q * p_m / (s->lambda * s->lambda);
}

static double rest_separation(const ReferenceScene* s) {
    return s->input == INPUT_LOAD ? s->R_q / s->lambda * log(pressed(s) / s->load) : s->d;
}

static double limit_now(const ReferenceScene* s) {
    const double force = pressed(s) * exp(-s->lambda * rest_separation(s) / s->R_q);
    return s->limit == LIMIT_LOAD ? s->mu * force : s->F_C;
}

static double stiffness_now(const ReferenceScene* s) {
    if (s->contact == CONTACT_CONSTANT) {
        return s->contact_sigma;
    }
    const double d = rest_separation(s), e = exp(-s->lambda * d / s->R_q);
    if (s->contact == CONTACT_ASPERITIES) {
        const double area =
            2.0 * s->c * TURN / 2.0 * s->eta * s->R * s->R_q * s->A_n / (s->lambda * s->lambda) * e;
        return s->stiffnessScale * s->E * area * area / (d * d * d);
    }
    const double tangential = 2.0 * (1.0 - s->nu) / (2.0 - s->nu);
    return s->stiffnessScale * s->eta * s->A_n * s->c * e * 2.0 * s->E * tangential * sqrt(s->R * s->R_q) *
           0.443 * pow(2.0 / s->lambda, 1.5);
}

double scene_kappa(const ReferenceScene* s) {
    return stiffness_now(s) * top_speed(s) / (TURN * s->f * limit_now(s));
}

static void friction(Draw* draw, const Grammar* grammar, ReferenceScene* s) {
    s->law = grammar->law ? grammar->law : 1 + pick(draw, 4);
    s->limit = grammar->limit ? grammar->limit : chance(draw, 0.45) ? LIMIT_LOAD : LIMIT_CONSTANT;
    s->F_C = log_between(draw, 1e-2, 1e4);
    s->mu = log_between(draw, 0.03, 1.0);
    s->contact = 1 + pick(draw, 3);
    s->input = chance(draw, 0.35) ? INPUT_LOAD : INPUT_SEPARATION;
    s->load = log_between(draw, 1e-1, 1e3);
    const double kappa = log_between(draw, 1e-3, 1e12);
    const double scale = kappa / scene_kappa(s);
    if (s->contact == CONTACT_CONSTANT) {
        s->contact_sigma = fmax(1e-6, s->contact_sigma * scale);
    } else {
        s->stiffnessScale = fmax(1e-15, scale);
    }
    if (s->law == LAW_LUGRE || s->law == LAW_ELASTIC_PLASTIC) {
        s->staticRatio = chance(draw, 0.15) ? 1.0 : 1.0 + log_between(draw, 1e-3, 3.0);
        s->V_S = top_speed(s) * log_between(draw, 1e-6, 10.0);
    }
    const double damping = limit_now(s) / top_speed(s);
    if (s->law != LAW_COULOMB && chance(draw, 0.3)) {
        s->sigma_1 = damping * log_between(draw, 1e-4, chance(draw, 0.15) ? 1e4 : 1.0);
    }
    if (chance(draw, 0.3)) {
        s->sigma_2 = damping * log_between(draw, 1e-4, 1.0);
    }
}

// A time [s] near one at which V reverses or vibrates through its extremes, of a period near the given one.
static double eventful(Draw* draw, const ReferenceScene* s, double near) {
    const double ratio = s->V_1 > 0.0 ? -s->V / s->V_1 : 0.0;
    const double angle = fabs(ratio) < 1.0 ? acos(ratio) : ratio > 0.0 ? 0.0 : TURN / 2.0;
    const double cycle = floor(near * s->f) + sign(draw) * angle / TURN;
    const double off = chance(draw, 0.2) ? 0.0 : sign(draw) * log_between(draw, 1e-16, 1e-2);
    return (cycle + off) / s->f;
}

static void times(Draw* draw, ReferenceScene* s, bool linear) {
    if (chance(draw, 0.6)) {
        s->start = log_between(draw, 1e-2, chance(draw, 0.1) ? 1e8 : 1e3) / s->f;
    }
    const bool at_event = chance(draw, 0.3);
    if (at_event) {
        s->start = eventful(draw, s, s->start);
    }
    s->h = log_between(draw, 1e-3, linear ? 4.0 : MOST_PERIODS) / s->f;
    if (chance(draw, at_event ? 0.4 : 0.05)) { // so short that an event just after the start counts
        s->h = log_between(draw, 1e-9, 1e-3) / s->f;
    }
    if (chance(draw, 0.2)) {
        const double end = eventful(draw, s, s->start + s->h);
        s->h = end > s->start ? end - s->start : s->h;
    }
    if (!linear && chance(draw, 0.04)) {
        s->h = log_between(draw, MOST_PERIODS, 1e6) / s->f;
    }
}

// A frequency and a start whose phase has no rounding, nor half a period later, nor many periods.
static void put_on_grid(ReferenceScene* s) {
    s->f = exp2(rint(log2(s->f)));
    s->start = ldexp(rint(ldexp(fmod(s->start * s->f, 1024.0), 30)), -30) / s->f;
}

static void rates(Draw* draw, ReferenceScene* s) {
    const double top = top_speed(s);
    if (chance(draw, 0.6)) {
        double to = velocity(draw, s->V_1);
        if (chance(draw, 0.3)) { // V passes zero in the step, or just misses it
            to = -s->V * log_between(draw, 1e-9, 10.0);
        }
        s->V_rate = fmax(-3.0 * top, fmin(3.0 * top, to - s->V)) / s->h;
    }
    if (chance(draw, 0.5)) {
        const double room = s->d - s->a_d, kind = unit(draw);
        const double most = kind < 0.1 ? 18.0 : kind < 0.4 ? 5.0 : 0.3; // the load falls by eight decades
        const double to = fmax(0.02 * room, room + between(draw, -1.0, 1.0) * most * s->R_q / s->lambda);
        s->d_rate = (to - room) / s->h;
    }
    if (chance(draw, 0.4)) {
        const double to = chance(draw, 0.7) ? between(draw, 0.7, 1.3) : log_between(draw, 1e-8, 10.0);
        s->E_rate = s->E * (to - 1.0) / s->h;
    }
    if (chance(draw, 0.6)) {
        const double to = chance(draw, 0.5) ? between(draw, 0.5, 2.0) : log_between(draw, 1e-8, 10.0);
        s->load_rate = s->load * (to - 1.0) / s->h;
    }
}

static double deflection(Draw* draw, const ReferenceScene* s) {
    const double most = limit_now(s) / stiffness_now(s) * s->staticRatio;
    const double kind = unit(draw);
    if (kind < 0.2) {
        return 0.0;
    }
    if (kind < 0.3) {
        return sign(draw) * most;
    }
    return most * (kind < 0.4 ? between(draw, -3.0, 3.0) : between(draw, -1.0, 1.0));
}

static ReferenceScene first_step(Draw* draw, const Grammar* grammar) {
    ReferenceScene s = reference_scene();
    s.f = log_between(draw, 1e2, 1e5);
    s.V_1 = chance(draw, 0.75) ? log_between(draw, 1e-3, 3.0) : 0.0;
    s.V = velocity(draw, s.V_1);
    surfaces(draw, &s);
    friction(draw, grammar, &s);
    const bool linear = chance(draw, 0.4);
    times(draw, &s, linear);
    if (linear) {
        rates(draw, &s);
    }
    s.delta_0 = s.law == LAW_COULOMB ? 0.0 : deflection(draw, &s);
    const double settles = s.sigma_1 > 0.0 ? 0.3 : 0.1;
    if (grammar->settled == 2 || (grammar->settled == 1 && chance(draw, settles))) {
        s.initial = START_SETTLED;
    }
    if (chance(draw, 0.3)) {
        put_on_grid(&s);
    }
    return s;
}

static void scale(Draw* draw, double* value, double most) {
    if (chance(draw, 0.2)) {
        *value *= log_between(draw, 1.0 / most, most);
    }
}

// What a later step changes: inputs that jump, tunable parameters, the length of the step and its rates.
static ReferenceScene later_step(Draw* draw, const ReferenceScene* before) {
    ReferenceScene usual = scene_after(before, 0.0), s = usual;
    scale(draw, &s.V_1, 3.0);
    if (chance(draw, 0.3)) {
        s.V = velocity(draw, s.V_1);
    }
    scale(draw, &s.d, 1.1);
    scale(draw, &s.E, 1.5);
    scale(draw, &s.load, 2.0);
    scale(draw, &s.f, 2.0);
    scale(draw, &s.a_d, 1.1);
    if (chance(draw, 0.1)) {
        s.phase_d = between(draw, -TURN, TURN);
    }
    double* const factors[] = {&s.F_C, &s.mu, &s.V_S, &s.sigma_1, &s.sigma_2};
    for (int k = 0; k < 5; k++) {
        scale(draw, factors[k], 3.0);
    }
    scale(draw, s.contact == CONTACT_CONSTANT ? &s.contact_sigma : &s.stiffnessScale, 3.0);
    if (s.staticRatio != 1.0 && chance(draw, 0.2)) {
        s.staticRatio = 1.0 + log_between(draw, 1e-3, 3.0);
    }
    if (chance(draw, 0.5)) {
        s.h = log_between(draw, 1e-3, 4.0) / s.f;
    }
    if (chance(draw, 0.3)) {
        s.h = fmin(s.h, MOST_PERIODS / s.f); // each period costs its own while inputs move
        rates(draw, &s);
    }
    ReferenceScene changes = no_change();
    for (int k = 0; k < REFERENCE_DOUBLES; k++) {
        if (*scene_value(&s, k) != *scene_value(&usual, k)) {
            *scene_value(&changes, k) = *scene_value(&s, k);
        }
    }
    return changes;
}

static Sequence sequence_of(Draw draw, const Grammar* grammar) {
    Sequence sequence = {.method = grammar->method, .steps = 1};
    sequence.step[0] = first_step(&draw, grammar);
    const double more = unit(&draw);
    sequence.steps += (more > 0.7) + (more > 0.9);
    ReferenceScene before = sequence.step[0];
    for (int k = 1; k < sequence.steps; k++) {
        sequence.step[k] = later_step(&draw, &before);
        before = sequence_scene(&sequence, k, &before, 0.0);
    }
    if (sequence.method == 0) {
        sequence.method = unit(&draw) > 0.9 ? FMU_CVODE : FMU_COLLOCATION;
    }
    if (sequence.method == FMU_CVODE && sequence.step[0].h * sequence.step[0].f > MOST_PERIODS) {
        sequence.step[0].h = 1.0 / sequence.step[0].f; // for it each period costs its own
    }
    return sequence;
}

Sequence sequence_drawn(uint64_t seed, uint64_t number, const Grammar* grammar) {
    Draw draw = {.state = seed * 0xd1342543de82ef95u + number};
    next(&draw);
    draw.state ^= next(&draw);
    return sequence_of(draw, grammar);
}

Sequence sequence_from_bytes(const uint8_t* bytes, size_t size, const Grammar* grammar) {
    return sequence_of((Draw){.bytes = bytes, .left = size}, grammar);
}
