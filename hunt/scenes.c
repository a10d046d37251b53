#include "scenes.h"

#include <math.h>
#include <stdbool.h>

#include "random.h"

static const double TURN = 6.283185307179586;
static const double TOLERANCES[] = {1e-2, 1e-3, 1e-4, 1e-6, 1e-8}; // of the sequences in turn
// The domain of docs/numerics.md.
static const double MAX_KAPPA = 1e8;
static const double MAX_PLANAR = 30.0;   // periods of a step,
static const double MAX_LEAP = 400.0;    // and of a leap: of one whose inputs move
static const double SHORTEST = 1e-9;     // s, of a step
static const double NEARLY_NONE = 1e-9;  // m/s, across
static const double MAX_PERIODS = 1e6;   // of a step
static const double MAX_MOVING = 2000.0; // periods of a step whose inputs move, for the reference's sake

static double between(double low, double high) { return low + (high - low) * random_01(); }
static double sign(void) { return random_chance(0.5) ? 1.0 : -1.0; }

// ---- Parts of a scene ----

static double top_speed(const ReferenceScene* s) {
    return fmax(fmax(hypot(s->V, s->V_y), fmax(s->V_1, s->V_2)), 1e-6);
}

// Next to a vibration also dips of |V|, and grazing reversals.
static double velocity_along(double V_1) {
    const double kind = random_01();
    const bool swings = V_1 > 0.0 && kind < 0.8;
    return kind < 0.05   ? 0.0
           : !swings     ? sign() * random_log(1e-5, 10.0)
           : kind < 0.25 ? sign() * V_1 * (1.0 + sign() * random_log(1e-9, 1e-1))
           : kind < 0.35 ? sign() * V_1 * random_log(1e-9, 1.0)
                         : V_1 * between(-3.0, 3.0);
}

// In the plane: zeta, and any direction, or along or transverse.
static void velocity(const ReferenceScene* s, double* V, double* V_y) {
    if (s->V_2 == 0.0) {
        *V = velocity_along(s->V_1);
        *V_y = 0.0;
        return;
    }
    const double most = fmax(s->V_1, s->V_2);
    if (random_chance(0.2)) { // V passes or touches 0 in each period, or nearly
        const bool on_line = s->V_1 == 0.0 || s->phase_2 == 0.0;
        const double phase = on_line ? TURN / 2.0 * random_below(2) : between(0.0, TURN);
        const double nearly = 1.0 + sign() * random_log(1e-10, 0.1);
        *V = -nearly * s->V_1 * cos(phase) + most * sign() * random_log(1e-7, 0.1);
        *V_y = -nearly * s->V_2 * cos(phase + s->phase_2) + (on_line ? 0.0 : most * random_log(1e-7, 0.1));
        return;
    }
    const double size = most * random_log(1e-4, 10.0);
    const double angle = random_chance(0.5) ? TURN / 4.0 * random_below(4) : between(0.0, TURN);
    *V = size * cos(angle) * (fabs(cos(angle)) > 1e-9);
    *V_y = size * sin(angle) * (fabs(sin(angle)) > 1e-9);
}

// A transverse vibration alone, or on a line, a circle or any ellipse.
static void planar_vibration(ReferenceScene* s) {
    const double kind = random_01();
    s->V_2 = random_log(1e-3, 3.0);
    s->V_1 = kind < 0.3 ? 0.0 : s->V_2 * (kind < 0.5 ? 1.0 : random_log(1e-3, 10.0));
    s->phase_2 = kind < 0.5 ? TURN / 4.0 * sign() : kind < 0.6 ? 0.0 : between(-TURN, TURN);
}

static void surfaces(ReferenceScene* s) {
    if (random_chance(0.25)) {
        double* const sizes[] = {&s->R_q, &s->R, &s->eta, &s->A_n, &s->c, &s->lambda};
        for (int k = 0; k < 6; k++) {
            *sizes[k] *= random_log(0.7, 1.4);
        }
        s->nu = between(0.0, 0.49);
        s->Y *= random_log(0.3, 30.0);
    }
    s->E = random_chance(0.7) ? between(20e9, 90e9) : random_log(5e9, 5e11);
    const double length = s->R_q / s->lambda;
    s->d = length * (random_chance(0.9) ? between(5.0, 9.0) : random_log(1.5, 60.0));
    if (random_chance(0.65)) {
        s->a_d = length * random_log(1e-4, 1.3);
        s->a_d = fmin(s->a_d, 0.7 * s->d);
        s->phase_d = random_chance(0.2) ? TURN / 4.0 * random_below(4) : between(-TURN, TURN);
    }
}

// A length [m] over that at which a bristle has the limit for its force.
static double over_limit(const ReferenceScene* s, double length) {
    const ReferenceRest rest = reference_rest(s);
    return rest.sigma * length / fmax(rest.limit, 1e-250);
}

double scene_kappa(const ReferenceScene* s) { return over_limit(s, top_speed(s) / (TURN * s->f)); }
double scene_start_over_limit(const ReferenceScene* s) {
    return over_limit(s, hypot(s->delta_0, s->delta_y_0));
}

double scene_gain(const ReferenceScene* s) {
    const ReferenceRest rest = reference_rest(s);
    const double force = rest.limit * s->staticRatio + fabs(s->F) + fabs(s->F_rate) * s->h;
    const double turns = TURN * s->f, of_mass = s->m > 0.0 ? force / s->m : 0.0;
    const double V_rate = turns * hypot(s->V_1, s->V_2) + hypot(s->V_rate, s->V_y_rate) + of_mass;
    if (s->law != LAW_ELASTIC_PLASTIC || V_rate == 0.0) {
        return 0.0;
    }
    return 2.0 * rest.limit / rest.sigma * (s->staticRatio - 1.0) * V_rate / (s->V_S * s->V_S);
}

static double* stiffness(ReferenceScene* s) {
    return s->contact == CONTACT_CONSTANT ? &s->contact_sigma : &s->stiffnessScale;
}

static double static_ratio(double chance_of_1) {
    return random_chance(chance_of_1) ? 1.0 : 1.0 + random_log(1e-3, 2.0);
}

static void friction(ReferenceScene* s) {
    s->law = 1 + random_below(laws());
    s->limit = random_chance(0.45) ? LIMIT_LOAD : LIMIT_CONSTANT;
    s->F_C = random_log(1e-2, 1e4);
    s->mu = random_log(0.03, 1.0);
    s->contact = 1 + random_below(3);
    s->input = random_chance(0.45) ? INPUT_LOAD : INPUT_SEPARATION;
    s->load = random_log(1e-1, 1e3);
    const double most = random_chance(0.5) ? 1e3 : MAX_KAPPA;
    const double scale = random_log(MIN_KAPPA, most) / scene_kappa(s);
    *stiffness(s) *= scale;
    if (s->law == LAW_LUGRE || s->law == LAW_ELASTIC_PLASTIC) {
        s->staticRatio = static_ratio(0.15);
        s->V_S = top_speed(s) * random_log(1e-3, 10.0);
    }
    const double damping = reference_rest(s).limit / top_speed(s);
    if (s->law != LAW_COULOMB && random_chance(0.3)) {
        s->sigma_1 = damping * random_log(1e-4, 1.0);
    }
    if (random_chance(0.3)) {
        s->sigma_2 = damping * random_log(1e-4, 1.0);
    }
}

static double deflection(const ReferenceScene* s) {
    const ReferenceRest rest = reference_rest(s);
    const double limit = rest.limit / rest.sigma, kind = random_01();
    return kind < 0.4    ? 0.0
           : kind < 0.45 ? limit * s->staticRatio * sign()
           : kind < 0.6  ? limit * sign() * random_log(1.0, LARGEST_START)
                         : limit * s->staticRatio * between(-1.0, 1.0);
}

// The length of a step [s]. If inputs move, the reference goes through each period, so there are fewer
// periods.
static double length(const ReferenceScene* s, double most_periods) {
    const double kind = random_01();
    const double periods = kind < 0.1    ? random_log(1e-6, 1e-3)
                           : kind < 0.9  ? random_log(1e-3, 4.0)
                           : kind < 0.96 ? random_log(4.0, 30.0)
                                         : random_log(30.0, most_periods);
    return fmax(SHORTEST, periods / s->f);
}

static ReferenceScene contact_drawn(bool plane) {
    ReferenceScene s = start_values();
    s.f = random_log(1e2, 1e5);
    s.V_1 = random_chance(0.65) ? random_log(1e-3, 3.0) : 0.0;
    if (plane) {
        planar_vibration(&s);
    }
    velocity(&s, &s.V, &s.V_y);
    surfaces(&s);
    friction(&s);
    if (s.law != LAW_COULOMB) {
        const double delta = deflection(&s), angle = plane ? between(0.0, TURN) : 0.0;
        s.delta_0 = delta * cos(angle);
        s.delta_y_0 = delta * sin(angle);
    }
    s.initial = random_chance(0.15) ? START_SETTLED : START_GIVEN;
    if (random_chance(0.6)) {
        s.start = random_log(1e-2, random_chance(0.1) ? 1e6 : 1e3) / s.f;
    }
    return s;
}

// ---- A mass ----

static const double STIFFNESSES[] = {6e4, 6e12}, MASSES[] = {1e-3, 1e3}; // N/m; kg
static const double MAX_RINGING = 60.0, LONGEST_OF_MASS = 1e-2;          // rad, of a stuck mass in a step; s
enum { STEPS_OF_MASS = 3 };

static double force_on_mass(const ReferenceScene* s) { // a normal distribution, nearly
    const double spread = random_01() + random_01() + random_01() + random_01() - 2.0;
    return sqrt(3.0) * spread * reference_rest(s).limit * s->staticRatio;
}

// The force on the mass and V held or linear, and with them at times the load and the separation.
static void step_of_mass(ReferenceScene* s) {
    const ReferenceRest rest = reference_rest(s);
    const double ringing = s->law == LAW_COULOMB ? INFINITY : MAX_RINGING / sqrt(rest.sigma / s->m);
    const double most = random_chance(0.1) ? LONGEST_OF_MASS : 0.1 * LONGEST_OF_MASS;
    s->h = fmin(random_chance(0.5) ? most : random_log(1e-6, most), ringing * random_log(1e-2, 1.0));
    s->F = random_chance(0.6) ? force_on_mass(s) : s->F;
    if (random_chance(0.5)) {
        s->F_rate = (force_on_mass(s) - s->F) / s->h;
        s->V_rate = random_chance(0.3) ? sign() * random_log(1e-3, 1.0) / s->h : 0.0;
        s->load_rate = random_chance(0.2) ? s->load * between(-1.1, 1.0) / s->h : 0.0;
        s->d_rate = random_chance(0.2) ? s->R_q / s->lambda * between(-0.5, 2.0) / s->h : 0.0;
    }
}

static ReferenceScene mass_drawn(void) {
    ReferenceScene s = start_values();
    s.f = random_chance(0.8) ? 20e3 : random_log(1e3, 1e5);
    s.V_1 = random_chance(0.5) ? random_log(1e-2, 3.0) : 0.0;
    surfaces(&s);
    s.a_d = random_chance(0.6) ? 0.0 : s.a_d;
    s.law = 1 + random_below(laws());
    s.limit = random_chance(0.3) ? LIMIT_LOAD : LIMIT_CONSTANT;
    s.contact = random_chance(0.6) ? CONTACT_CONSTANT : 1 + random_below(3);
    s.input = 1 + random_below(2);
    s.load = random_log(1.0, 1e3);
    s.mu = random_log(0.03, 1.0);
    s.m = random_log(MASSES[0], MASSES[1]);
    *stiffness(&s) *= random_log(STIFFNESSES[0], STIFFNESSES[1]) / reference_rest(&s).sigma;
    const ReferenceRest rest = reference_rest(&s);
    if (s.law == LAW_LUGRE || s.law == LAW_ELASTIC_PLASTIC) {
        s.staticRatio = random_chance(0.4) ? 1.0 : 1.0 + random_log(1e-2, 1.0);
        s.V_S = random_log(1e-3, 1.0);
    }
    if (s.law != LAW_COULOMB && random_chance(0.4)) {
        s.sigma_1 = 2.0 * random_log(1e-2, 1.0) * sqrt(rest.sigma * s.m);
    }
    s.sigma_2 = random_chance(0.3) ? random_log(1e-2, 100.0) : 0.0;
    s.V = random_chance(0.6) ? 0.0 : sign() * random_log(1e-3, 3.0);
    s.v_0 = random_chance(0.5) ? 0.0 : random_chance(0.3) ? -s.V : sign() * random_log(1e-4, 3.0);
    s.x_0 = random_chance(0.8) ? 0.0 : between(-0.1, 0.1);
    s.delta_0 =
        s.law != LAW_COULOMB && random_chance(0.4) ? rest.limit / rest.sigma * between(-1.0, 1.0) : 0.0;
    s.start = random_chance(0.5) ? 0.0 : random_log(1e-6, 10.0);
    return s;
}

static Sequence sequence_of_mass(uint64_t number) {
    static const double OF_MASS[] = {1e-3, 1e-6, 1e-8};
    Sequence sequence = {.tolerance = OF_MASS[number % 3], .method = 1, .step = {mass_drawn()}};
    for (int k = 0; k < STEPS_OF_MASS; k++) {
        ReferenceScene* s = &sequence.step[k];
        *s = k == 0 ? *s : scene_after(s - 1);
        step_of_mass(s);
        if (!scene_is_in_domain(s)) {
            break;
        }
        sequence.steps++;
    }
    return sequence;
}

// ---- Steps at random ----

static void rates(ReferenceScene* s) {
    const double top = top_speed(s);
    if (random_chance(0.6)) {
        double to, to_y;
        velocity(s, &to, &to_y);
        if (s->V_2 == 0.0 && random_chance(0.3)) { // V passes zero in the step, or just misses it
            to = -s->V * random_log(1e-9, 10.0);
        }
        s->V_rate = fmax(-3.0 * top, fmin(3.0 * top, to - s->V)) / s->h;
        s->V_y_rate = fmax(-3.0 * top, fmin(3.0 * top, to_y - s->V_y)) / s->h;
    }
    if (random_chance(0.5)) {
        const double room = s->d - s->a_d, most = random_chance(0.2) ? 18.0 : 2.0;
        const double to = fmax(0.1 * room, room + between(-1.0, 1.0) * most * s->R_q / s->lambda);
        s->d_rate = (to - room) / s->h;
    }
    if (random_chance(0.3)) {
        s->E_rate = s->E * (random_log(0.11, 9.0) - 1.0) / s->h;
    }
    if (random_chance(0.6)) {
        const double share = random_chance(0.5)   ? between(0.5, 2.0)
                             : random_chance(0.6) ? random_log(1e-8, 10.0)
                                                  : between(-1.0, 0.1);
        s->load_rate = (s->load > 0.0 ? s->load * (share - 1.0) : random_log(0.1, 1e3)) / s->h;
    }
}

// Inputs and tunable parameters that jump, as where a tool lifts off and is set down, or a vibration is switched; the length of
// the step and its rates. full: the first step.
static void step_at_random(ReferenceScene* s, const ReferenceScene* full) {
    double* const scaled[] = {&s->V_1, &s->V_2, &s->f,   &s->E,       &s->load,
                              &s->F_C, &s->mu,  &s->V_S, stiffness(s)};
    for (int k = 0; k < 9; k++) {
        *scaled[k] *= random_chance(0.2) ? random_log(1.0 / 3.0, 3.0) : 1.0;
    }
    const double on = random_chance(0.2) ? random_below(2) : -1.0; // or as it is
    if (on >= 0.0) {
        s->V_1 = on * full->V_1;
        s->V_2 = on * full->V_2;
        s->a_d = on * full->a_d;
        s->load = random_chance(0.5) ? on * full->load : s->load;
        s->d = random_chance(0.5) ? full->d + (1.0 - on) * between(30.0, 600.0) * s->R_q / s->lambda : s->d;
    }
    s->d = fmax(s->d * (random_chance(0.2) ? random_log(0.9, 1.1) : 1.0), 1.1 * s->a_d);
    if (random_chance(0.3)) {
        velocity(s, &s->V, &s->V_y);
    }
    s->staticRatio = random_chance(0.2) ? static_ratio(0.2) : s->staticRatio;
    s->V_S = fmin(fmax(s->V_S, 1e-3 * top_speed(s)), 10.0 * top_speed(s));
    const bool linear = random_chance(0.4);
    s->h = length(s, s->V_2 != 0.0 ? MAX_PLANAR : linear ? MAX_MOVING : MAX_PERIODS);
    if (linear) {
        rates(s);
    }
}

// ---- Sequences ----

static bool mass_is_in_domain(const ReferenceScene* s) {
    const ReferenceRest rest = reference_rest(s);
    return s->m >= MASSES[0] && s->m <= MASSES[1] && s->h >= 1e-3 * SHORTEST && s->h <= LONGEST_OF_MASS &&
           rest.sigma >= 0.9 * STIFFNESSES[0] && rest.sigma <= 1.1 * STIFFNESSES[1] &&
           (s->law == LAW_COULOMB || s->h * sqrt(rest.sigma / s->m) <= MAX_RINGING) && s->V_S >= 1e-3 &&
           s->sigma_1 <= 2.0 * sqrt(rest.sigma * s->m) && s->sigma_2 <= 100.0 && s->V_1 <= 3.0;
}

bool scene_is_in_domain(const ReferenceScene* s) {
    const ReferenceScene end = scene_after(s);
    const double E = s->E_rate == 0.0 ? 1.0 : end.E / s->E, periods = s->h * s->f;
    const double top = fmax(top_speed(s), top_speed(&end)), damping = 1.001 * reference_rest(s).limit / top;
    const double kappa = scene_kappa(s), kappa_end = scene_kappa(&end);
    const bool swings = vibrates(s) && s->law != LAW_COULOMB, drops = s->staticRatio > 1.0;
    const bool contact = s->d > s->a_d && end.d > s->a_d && E > 0.1 && E < 10.0 && s->nu >= 0.0 &&
                         s->nu < 0.5 && s->staticRatio >= 1.0 && s->staticRatio <= 3.0;
    if (s->m > 0.0) {
        return contact && mass_is_in_domain(s);
    }
    return contact &&
           !(swings && (fmin(kappa, kappa_end) < MIN_KAPPA || fmax(kappa, kappa_end) > MAX_KAPPA)) &&
           s->h >= SHORTEST && periods >= 1e-6 && periods <= MAX_PERIODS &&
           !(drops && (s->V_S < 1e-3 * top || s->V_S > 10.0 * top)) && s->sigma_1 <= damping &&
           s->sigma_2 <= damping && scene_start_over_limit(s) <= LARGEST_START &&
           (s->input == INPUT_SEPARATION ||
            fmin(reference_rest(s).d, reference_rest(&end).d) > 4.0 * s->R_q / s->lambda);
}

Sequence sequence_drawn(uint64_t seed, uint64_t number, Kind kind) {
    random_state = seed * 0xd1342543de82ef95u + number;
    random_bits();
    random_state ^= random_bits();
    if (kind == MASS) {
        return sequence_of_mass(number);
    }
    Sequence sequence = {.tolerance = TOLERANCES[number % 5], .method = 1};
    const bool plane = kind == PLANE, leaps = plane && number % 4 == 3; // inputs move over many periods
    const bool near_line = plane && number % 8 == 1; // a line, but for a V_y that is nearly none
    ReferenceScene full = contact_drawn(plane && !near_line);
    const bool linear = random_chance(0.5) || leaps;
    const double most = plane ? MAX_PLANAR : linear ? MAX_MOVING : MAX_PERIODS;
    full.h = leaps ? random_log(12.0, MAX_LEAP) / full.f : length(&full, most);
    full.V_y = near_line ? NEARLY_NONE : full.V_y;
    for (int k = 0, wanted = near_line ? 1 : 1 + random_below(4); k < wanted; k++) {
        ReferenceScene s = k == 0 ? full : scene_after(&sequence.step[k - 1]);
        if (k > 0) {
            step_at_random(&s, &full);
        } else if (linear) {
            rates(&s);
        }
        if (!scene_is_in_domain(&s)) {
            break;
        }
        sequence.step[sequence.steps++] = s;
    }
    return sequence;
}
