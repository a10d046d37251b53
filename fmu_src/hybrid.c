#include "hybrid.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "model/constants.h"

// What an event is late by, of the bound and of the velocities. By hand: far above rounding, far below what a host's
// integrator tells apart.
static const double HYSTERESIS = 1e-10;

// At an event a bristle deflected by this much of its bound lies on it. By hand: 4500 eps, and a hundredth of HYSTERESIS.
static const double ON_BOUND_AT_EVENT = 1.0 - 1e-12;

// A bristle that turns back farther from its bound has not met it between two steps of an integrator. By hand: less makes
// more events, more may pass over such a meeting.
static const double NEAR_THE_BOUND = 0.9;

// The shortest time, over the time itself, that tells an input's speed. By hand: rounding leaves it four digits.
static const double SHORTEST_LOOK = 1e4 * DBL_EPSILON;

bool fc_hybrid_allows(FcFrictionContact* contact, FcMessage* message) {
    if (contact->state.variables.friction.model == FC_COULOMB) {
        return fc_message_set(
            message, "friction.model = Coulomb (2) is not for model exchange: it has no state, and its force "
                     "jumps with the sign of V, so that a mass could not stick; take ElasticPlastic (3), or "
                     "co-simulation");
    }
    FcStates nominals = {{0.0}};
    return fc_hybrid_nominals(contact, &nominals, message);
}

void fc_hybrid_start(FcFrictionContact* contact) {
    FcStates nominals = {{0.0}};
    FcMessage unheard;
    if (fc_hybrid_nominals(contact, &nominals, &unheard)) {
        contact->state.hybrid.nominal_delta = nominals.of[0];
        contact->state.hybrid.nominal_energy = nominals.of[1];
    }
    fc_hybrid_event_ends(contact);
}

void fc_hybrid_set_time(FcFrictionContact* contact, double time) {
    contact->state.time = time;
    contact->state.time_rest = 0.0;
}

// The bound of the bristle at the start of a scene.
static double bound_of(const FcFrictionContact* contact, const FcScene* scene) {
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(scene, contact->state.slips, &friction);
    return fc_bound(&bound, 0.0);
}

static double push_of(const FcFrictionContact* contact, const FcScene* scene, int side) {
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(scene, contact->state.slips, &friction);
    return fc_push(scene, &bound, 0.0, side);
}

static double bound_rate_of(const FcFrictionContact* contact, const FcScene* scene) {
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(scene, contact->state.slips, &friction);
    return fc_bound_rate(&bound, 0.0);
}

static FcRegime regime_of(const FcFrictionContact* contact) { return (FcRegime)contact->state.hybrid.regime; }

static bool fail_rates(const FcVariables* v, FcMessage* message) {
    return fc_message_set(message,
                          "F_t or the rate of delta, W_f or Q_f is beyond the largest number: V = %.9g m/s "
                          "with vibration.V_1 = %.9g m/s, delta = %.9g m",
                          v->V, v->vibration.V_1, v->delta);
}

bool fc_hybrid_refresh(FcFrictionContact* contact, FcMessage* message) {
    if (!fc_friction_contact_check(contact, message)) {
        return false;
    }
    FcVariables* v = &contact->state.variables;
    const FcScene scene = fc_friction_contact_scene_moving(contact, NULL);
    const FcContactResponse response = fc_scene_contact(&scene, 0.0);
    const FcMotion now = fc_motion(&scene, regime_of(contact), v->delta);
    if (!isfinite(now.F_t) || !isfinite(now.rates.delta) || !isfinite(now.rates.W_f) ||
        !isfinite(now.rates.Q_f)) {
        return fail_rates(v, message);
    }
    v->F_t = now.F_t;
    v->F_t_mean = now.F_t;
    v->F_n = response.F_n;
    v->sigma = response.sigma;
    v->A_r = response.A_r;
    v->der = now.rates;
    return true;
}

// What pushes a bristle that slips, with hysteresis [m/s].
static double push(FcFrictionContact* contact, int side) {
    const FcScene moving = fc_friction_contact_scene_moving(contact, contact->state.hybrid.speed);
    const FcDrive* drive = &moving.drive;
    const double speed = fabs(drive->V.value) + drive->vibration.V_1 + fabs(bound_rate_of(contact, &moving));
    return push_of(contact, &moving, side) + HYSTERESIS * speed;
}

// Of a bristle of ElasticPlastic that sticks near a bound that moves: the velocity [m/s] at which it comes nearer. Where it
// turns back it may have met the bound and left it again since the integrator's last step: an event there shows it.
static double approach(FcFrictionContact* contact) {
    const FcScene moving = fc_friction_contact_scene_moving(contact, contact->state.hybrid.speed);
    const double delta = contact->state.variables.delta;
    if (bound_rate_of(contact, &moving) == 0.0 || fabs(delta) < NEAR_THE_BOUND * bound_of(contact, &moving)) {
        return 1.0;
    }
    return push_of(contact, &moving, delta < 0.0 ? -1 : 1);
}

bool fc_hybrid_indicators(FcFrictionContact* contact, FcEventIndicators* indicators, FcMessage* message) {
    if (!fc_friction_contact_check(contact, message)) {
        return false;
    }
    const FcVariables* v = &contact->state.variables;
    const FcScene scene = fc_friction_contact_scene_moving(contact, NULL);
    double* z = indicators->of;
    z[0] = v->friction.model == FC_ELASTIC_PLASTIC ? 1.0 : fc_drive_V(&scene.drive, 0.0);
    z[1] = z[2] = z[3] = 1.0;
    if (regime_of(contact) != FC_FREE) {
        z[3] = push(contact, regime_of(contact));
    } else if (fc_is_bounded(scene.friction)) {
        const double reached = v->delta / bound_of(contact, &scene);
        z[1] = (1.0 - reached) + HYSTERESIS;
        z[2] = (1.0 + reached) + HYSTERESIS;
        if (v->friction.model == FC_ELASTIC_PLASTIC) {
            z[0] = approach(contact);
        }
    }
    for (int i = 0; i < FC_EVENT_INDICATOR_COUNT; i++) {
        if (!isfinite(z[i])) {
            return fail_rates(v, message);
        }
    }
    return true;
}

// The inputs in the order of FcInput.
static void copy_inputs(const FcVariables* v, double inputs[FC_INPUT_COUNT]) {
    inputs[FC_INPUT_V] = v->V;
    inputs[FC_INPUT_D] = v->d;
    inputs[FC_INPUT_E] = v->E;
    inputs[FC_INPUT_LOAD] = v->load;
}

static void look_at_inputs(FcFrictionContact* contact) {
    FcHybrid* hybrid = &contact->state.hybrid;
    double inputs[FC_INPUT_COUNT];
    copy_inputs(&contact->state.variables, inputs);
    const double passed = contact->state.time - hybrid->seen_time;
    if (!(passed > SHORTEST_LOOK * fabs(contact->state.time))) {
        return;
    }
    for (int i = 0; i < FC_INPUT_COUNT; i++) {
        const double speed = (inputs[i] - hybrid->seen[i]) / passed;
        hybrid->speed[i] = isfinite(speed) ? speed : 0.0;
    }
    memcpy(hybrid->seen, inputs, sizeof inputs);
    hybrid->seen_time = contact->state.time;
}

// Where the bound is that the bristle slips along, with its sign [m], and the bristle's force there [N]; false where none slips.
static bool slips_along(FcFrictionContact* contact, double* bound, double* force) {
    FcMessage unheard;
    if (regime_of(contact) == FC_FREE || !fc_friction_contact_check(contact, &unheard)) {
        return false;
    }
    const FcScene scene = fc_friction_contact_scene_moving(contact, NULL);
    *bound = (double)regime_of(contact) * bound_of(contact, &scene);
    *force = fc_scene_stiffness(&scene, 0.0) * *bound;
    return true;
}

// The rates do not see how inputs move the bound: delta lags behind it. What Q_f lags behind by is the integral of the
// bristle's force over that lag, here by the trapezoidal rule from step to step.
static void look_at_lag(FcFrictionContact* contact) {
    FcHybrid* hybrid = &contact->state.hybrid;
    double bound;
    double force;
    if (slips_along(contact, &bound, &force)) {
        const double lag = bound - contact->state.variables.delta;
        const double heat = hybrid->lag_heat - 0.5 * (force + hybrid->lag_force) * (lag - hybrid->lag);
        if (isfinite(lag) && isfinite(force) && isfinite(heat)) {
            hybrid->lag = lag;
            hybrid->lag_force = force;
            hybrid->lag_heat = heat;
        }
    }
}

bool fc_hybrid_step_completed(FcFrictionContact* contact) {
    look_at_inputs(contact);
    look_at_lag(contact);
    FcEventIndicators z;
    FcMessage unheard;
    return fc_is_bounded(&contact->state.variables.friction) && fc_hybrid_indicators(contact, &z, &unheard) &&
           (z.of[1] <= 0.0 || z.of[2] <= 0.0 || z.of[3] <= 0.0);
}

// Moves delta and adds heat [J], if both stay numbers.
static void move_to(FcFrictionContact* contact, double delta, double heat) {
    FcVariables* v = &contact->state.variables;
    if (isfinite(delta) && isfinite(v->Q_f + heat)) {
        contact->state.hybrid.changed |= delta != v->delta || heat != 0.0;
        v->delta = delta;
        v->Q_f += heat;
    }
}

void fc_hybrid_event_begins(FcFrictionContact* contact) {
    look_at_inputs(contact);
    look_at_lag(contact);
    FcHybrid* hybrid = &contact->state.hybrid;
    double bound;
    double force;
    if (slips_along(contact, &bound, &force)) {
        move_to(contact, bound, hybrid->lag_heat);
    }
    hybrid->lag = hybrid->lag_heat = hybrid->lag_force = 0.0;
}

// An input may have jumped at the event: a bristle that is now within its bound is free, one beyond is taken onto it, and
// what it stored in between is heat.
static FcRegime next_regime(FcFrictionContact* contact) {
    const FcScene scene = fc_friction_contact_scene_moving(contact, NULL);
    const double D = bound_of(contact, &scene);
    const double delta = contact->state.variables.delta;
    if (fabs(delta) < ON_BOUND_AT_EVENT * D) {
        return FC_FREE;
    }
    const int side = delta < 0.0 ? -1 : 1;
    const double sigma = fc_scene_stiffness(&scene, 0.0);
    move_to(contact, side * D, 0.5 * sigma * (delta - side * D) * (delta + side * D));
    if (regime_of(contact) == (FcRegime)side) {
        return push(contact, side) > 0.0 ? (FcRegime)side : FC_FREE;
    }
    const FcScene moving = fc_friction_contact_scene_moving(contact, contact->state.hybrid.speed);
    return push_of(contact, &moving, side) > 0.0 ? (FcRegime)side : FC_FREE;
}

bool fc_hybrid_update(FcFrictionContact* contact, bool* changed, bool* nominals_changed, FcMessage* message) {
    FcStates nominals = {{0.0}};
    if (!fc_hybrid_nominals(contact, &nominals, message)) {
        return false;
    }
    FcHybrid* hybrid = &contact->state.hybrid;
    if (fc_is_bounded(&contact->state.variables.friction)) {
        hybrid->regime = next_regime(contact);
    }
    *changed = hybrid->changed;
    *nominals_changed = nominals.of[0] != hybrid->nominal_delta || nominals.of[1] != hybrid->nominal_energy;
    hybrid->changed = 0;
    hybrid->nominal_delta = nominals.of[0];
    hybrid->nominal_energy = nominals.of[1];
    return true;
}

void fc_hybrid_event_ends(FcFrictionContact* contact) {
    FcHybrid* hybrid = &contact->state.hybrid;
    hybrid->seen_time = contact->state.time;
    copy_inputs(&contact->state.variables, hybrid->seen);
    look_at_lag(contact);
    hybrid->lag_heat = 0.0; // what it starts from
}

bool fc_hybrid_nominals(FcFrictionContact* contact, FcStates* nominals, FcMessage* message) {
    if (!fc_friction_contact_check(contact, message)) {
        return false;
    }
    const FcScene scene = fc_friction_contact_scene_moving(contact, NULL);
    const FcVibration* vibration = &scene.drive.vibration;
    const double force = fc_scene_mean_limit(&scene, 0.0);
    const double length = force / fc_contact_stiffness(&scene.at_E, scene.drive.d.value);
    const double amplitude = vibration->V_1 / (FC_TWO_PI * vibration->f);
    const double energy = force * fmax(length, amplitude);
    if (!(length > 0.0 && energy > 0.0) || !isfinite(length) || !isfinite(energy)) {
        return fc_message_set(message,
                              "the nominal values of the states are no finite numbers above 0: the limit of "
                              "the force is %.9g N, sigma = %.9g N/m",
                              force, fc_contact_stiffness(&scene.at_E, scene.drive.d.value));
    }
    *nominals = (FcStates){.of = {length, energy, energy}};
    return true;
}
