#include "contact/ode.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stddef.h>

#include "contact/checks.h"
#include "model/extremes.h"
#include "model/pi.h"
#include "model/plane.h"
#include "model/root.h"

// The part of its bound below which a bristle of ElasticPlastic that turns back does not meet it. Half of it
// makes more events; a value nearer to 1 trusts that the inputs stay.
static const double NEAR_THE_BOUND = 0.9;

// The shortest time that determines an input's speed, over the time itself. Rounding leaves the speed four
// digits; half of it doubles the error of the speed.
static const double SHORTEST_SAMPLE = 1e4 * DBL_EPSILON;

// Parts of a vibration period, or changes of V over V_S in Stribeck's peak, within which a push turns at most
// once. A slip between two turns within a part is below 1e-3 of the vibration's amplitude. Twice the part
// allows an eightfold slip, half of it costs twice the evaluations.
static const double PART_OF_PERIOD = 1.0 / 32.0;
static const double PART_OF_PEAK = 0.5;
static const double MIN_PART_OF_PERIOD = 1e-4;

// The largest part of a period up to a time event. At places half a period apart |V|, and with it the rates, may be
// alike, as if nothing happened between them; at three places in a period no error control takes them for that. Half of
// it costs twice the events.
static const double LONGEST_AHEAD = 1.0 / 3.0;

// The slope in the plane: V + SLANT V_y passes 0 at a reversal in any direction. Chosen empirically:
// tan(1/2), a ratio of V_y to V that hosts are unlikely to have. With such a ratio a reversal would be
// missed.
static const double SLANT = -0.5463024898437905;

// The part of a period by which a time event is later than its turn. Chosen empirically: the indicators see
// the turn first, and an event at a turn does not cause a second event. Half of it does the same.
static const double AFTER_TURN = 1e-9;

bool fc_ode_allows(FcFrictionContact* contact, FcMessage* message) {
    if (!fc_has_bristle(&contact->state.variables.friction)) {
        return fc_message_set(
            message, "friction.model = Coulomb (2) is not for model exchange: it has no state, and its force "
                     "jumps with the sign of V, so that a mass could not stick; take ElasticPlastic (3), or "
                     "co-simulation");
    }
    if (contact->state.variables.body.m != 0.0) {
        return fc_message_set(
            message,
            "body.m = %.9g kg must be 0 kg in model exchange: give the mass to your tool, or take "
            "co-simulation",
            contact->state.variables.body.m);
    }
    double nominals[FC_STATE_COUNT] = {0.0};
    return fc_ode_nominals(contact, nominals, message);
}

void fc_ode_start(FcFrictionContact* contact) {
    double nominals[FC_STATE_COUNT] = {0.0};
    FcMessage ignored;
    if (fc_ode_nominals(contact, nominals, &ignored)) {
        contact->state.ode.nominal_delta = nominals[0];
        contact->state.ode.nominal_energy = nominals[1];
    }
    fc_ode_event_ends(contact);
}

void fc_ode_set_time(FcFrictionContact* contact, double time) {
    contact->state.clock.time = time;
    contact->state.clock.rest = 0.0;
}

static FcBristleState state_of(const FcFrictionContact* contact) {
    return (FcBristleState)contact->state.bristle.state;
}

// The speeds of the inputs since the last step, or those in it if the time since then is too short. Returns
// whether it is long enough.
static bool find_speeds(FcFrictionContact* contact, double speed[FC_INPUT_COUNT]) {
    const FcOdeState* ode = &contact->state.ode;
    const double passed = contact->state.clock.time - ode->seen_time;
    const bool is_long = passed > SHORTEST_SAMPLE * fabs(contact->state.clock.time);
    for (int i = 0; i < FC_INPUT_COUNT; i++) {
        const double input = *fc_input_of(&contact->state.variables, (FcInput)i);
        const double now = is_long ? (input - ode->seen[i]) / passed : ode->speed[i];
        speed[i] = isfinite(now) ? now : 0.0;
    }
    return is_long;
}

static void sample_inputs(FcFrictionContact* contact) {
    FcOdeState* ode = &contact->state.ode;
    ode->seen_time = contact->state.clock.time;
    for (int i = 0; i < FC_INPUT_COUNT; i++) {
        ode->seen[i] = *fc_input_of(&contact->state.variables, (FcInput)i);
    }
}

// The contact with its present inputs and their estimated speeds, and its bristle's bound.
typedef struct {
    FcScene scene;
    FcPlane plane; // points to scene
    FcBristleState state;
    int side; // of the bound that ends its state: 0 for either
} BoundView;

static void make_view(FcFrictionContact* contact, BoundView* view) {
    double speed[FC_INPUT_COUNT];
    find_speeds(contact, speed);
    view->scene = fc_friction_contact_scene_moving(contact, speed);
    fc_plane_make(&view->plane, &view->scene);
    view->state = state_of(contact);
    view->side = view->state != FC_FREE ? fc_side(fc_friction_contact_bristle(contact)) : 0;
}

bool fc_ode_refresh(FcFrictionContact* contact, FcMessage* message) {
    if (!fc_friction_contact_check(contact, message)) {
        return false;
    }
    FcVariables* v = &contact->state.variables;
    const FcScene scene = fc_friction_contact_scene_moving(contact, NULL);
    const FcContactResponse response = fc_scene_contact(&scene, 0.0);
    const FcMotion now = fc_motion(&scene, fc_friction_contact_bristle(contact));
    if (!fc_motion_is_finite(&now)) {
        return fc_fail_motion(&scene, v, message);
    }
    fc_set_outputs(v, now.force, now.force, &response);
    v->der = now.rates;
    return true;
}

bool fc_ode_indicators(FcFrictionContact* contact, double z[FC_EVENT_INDICATOR_COUNT], FcMessage* message) {
    if (!fc_friction_contact_check(contact, message)) {
        return false;
    }
    const FcVariables* v = &contact->state.variables;
    BoundView now;
    make_view(contact, &now);
    const FcBristle bristle = fc_friction_contact_bristle(contact);
    z[0] = z[1] = z[2] = z[3] = 1.0;
    if (fc_scene_depends_on_d(&now.scene)) {
        const double closed_by = fc_scene_closed_by(&now.scene);
        // An open contact leaves no past, nor does a closed one whose stiffness is below the least number.
        const bool was_open = contact->state.bristle.past.sigma == 0.0 &&
                              (closed_by <= 0.0 || fc_scene_stiffness(&now.scene, 0.0) > 0.0);
        z[3] = was_open ? -closed_by : closed_by;
    }
    if (!fc_scene_is_separated(&now.scene)) {
        if (!fc_may_stick(&v->friction)) {
            const FcDrive* drive = &now.scene.drive;
            z[0] = fc_drive_V(drive, 0.0) + SLANT * fc_drive_V_y(drive, 0.0);
        }
        fc_bound_indicators(&now.scene, bristle, &z[1]);
    }
    for (int i = 0; i < FC_EVENT_INDICATOR_COUNT; i++) {
        if (!isfinite(z[i])) {
            return fc_fail_motion(&now.scene, v, message);
        }
    }
    return true;
}

static void update_speeds(FcFrictionContact* contact) {
    if (find_speeds(contact, contact->state.ode.speed)) {
        sample_inputs(contact);
    }
}

// A slipping bristle: the lag of delta behind the bound, its deflection without the lag, and its force there.
typedef struct {
    double lag;     // m, of |delta|
    FcVector delta; // m
    double force;   // N
} Slip;

// False if no bristle slips, or if the contact has opened and the stiffness is 0.
static bool slips_along(FcFrictionContact* contact, Slip* slip) {
    FcMessage ignored;
    if (state_of(contact) != FC_SLIPPING || !fc_friction_contact_check(contact, &ignored)) {
        return false;
    }
    BoundView now;
    make_view(contact, &now);
    const double sigma = fc_scene_contact(&now.scene, 0.0).sigma;
    const double D = fc_scene_is_separated(&now.scene) ? 0.0 : fc_bound(&now.plane, now.state, 0.0).D;
    const FcBristle bristle = fc_friction_contact_bristle(contact);
    const double size = fc_size(bristle);
    const double onto = size > 0.0 ? D / size : 0.0;
    *slip = (Slip){D - size, {onto * bristle.delta, onto * bristle.delta_y}, sigma * D};
    return sigma != 0.0;
}

// The rates do not contain the motion of the bound by the inputs, so delta lags behind it. Q_f lags by the
// integral of the bristle's force over that lag, here by the trapezoidal rule from step to step.
static void update_lag(FcFrictionContact* contact) {
    FcOdeState* ode = &contact->state.ode;
    Slip slip;
    if (slips_along(contact, &slip)) {
        const double heat = ode->lag_heat - 0.5 * (slip.force + ode->lag_force) * (slip.lag - ode->lag);
        if (isfinite(slip.lag) && isfinite(slip.force) && isfinite(heat)) {
            ode->lag = slip.lag;
            ode->lag_force = slip.force;
            ode->lag_heat = heat;
        }
    }
}

bool fc_ode_step_completed(FcFrictionContact* contact) {
    update_speeds(contact);
    update_lag(contact);
    double z[FC_EVENT_INDICATOR_COUNT];
    FcMessage ignored;
    return fc_ode_indicators(contact, z, &ignored) && (z[1] <= 0.0 || z[2] <= 0.0 || z[3] <= 0.0);
}

// Moves delta and adds heat [J], if both stay finite.
static void move_to(FcFrictionContact* contact, FcVector delta, double heat) {
    FcVariables* v = &contact->state.variables;
    if (isfinite(delta.x) && isfinite(delta.y) && (delta.x != v->delta || delta.y != v->delta_y)) {
        contact->state.ode.changed = 1;
        v->delta = delta.x;
        v->delta_y = delta.y;
    }
    if (isfinite(v->Q_f + heat) && heat != 0.0) {
        contact->state.ode.changed = 1;
        v->Q_f += heat;
    }
}

// Takes the state from the past to the present inputs, and sets the state and the new past.
static void begin_state(FcFrictionContact* contact) {
    FcFrictionState* state = &contact->state;
    BoundView now;
    make_view(contact, &now);
    double heat;
    const FcBristle before = fc_friction_contact_bristle(contact);
    const FcBristle bristle =
        fc_input_jump(&now.scene, state->clock.time, &state->bristle.past, &before, &heat);
    move_to(contact, fc_delta(bristle), heat);
    state->bristle.state = (int)fc_bristle_state_at_event(&now.scene, bristle);
    state->bristle.past = fc_past(&now.scene);
    Slip slip;
    if (slips_along(contact, &slip)) { // it is there, apart from rounding
        move_to(contact, slip.delta, 0.0);
    }
}

// The effect of the drop at break-away, which is motion, on the bristle's damper.
static void add_drop(FcFrictionContact* contact, FcVector before) {
    FcVariables* v = &contact->state.variables;
    const FcScene scene = fc_friction_contact_scene_moving(contact, NULL);
    const FcVector drop = {v->delta - before.x, v->delta_y - before.y};
    const FcVector V = {fc_drive_V(&scene.drive, 0.0), fc_drive_V_y(&scene.drive, 0.0)};
    const double work = v->friction.sigma_1 * fc_product(drop, V);
    if (fc_has_static_friction(&v->friction) && !fc_scene_is_separated(&scene) && isfinite(v->W_f + work)) {
        v->W_f += work;
        move_to(contact, (FcVector){v->delta, v->delta_y}, work);
    }
}

void fc_ode_event_begins(FcFrictionContact* contact) {
    update_speeds(contact);
    update_lag(contact);
    FcOdeState* ode = &contact->state.ode;
    const FcVariables* v = &contact->state.variables;
    Slip slip;
    const bool slips = slips_along(contact, &slip);
    move_to(contact, slips ? slip.delta : (FcVector){v->delta, v->delta_y}, ode->lag_heat);
    ode->lag = ode->lag_heat = ode->lag_force = 0.0;
    contact->state.bristle.past = (FcPast){.sigma = 0.0};
    FcMessage ignored;
    if (fc_friction_contact_check(contact, &ignored)) {
        const FcVector before = {v->delta, v->delta_y};
        begin_state(contact);
        add_drop(contact, before);
    }
}

bool fc_ode_update(FcFrictionContact* contact, bool* changed, bool* nominals_changed, FcMessage* message) {
    double nominals[FC_STATE_COUNT] = {0.0};
    if (!fc_ode_nominals(contact, nominals, message)) {
        return false;
    }
    FcOdeState* ode = &contact->state.ode;
    begin_state(contact);
    *changed = ode->changed;
    *nominals_changed = nominals[0] != ode->nominal_delta || nominals[1] != ode->nominal_energy;
    ode->changed = 0;
    ode->nominal_delta = nominals[0];
    ode->nominal_energy = nominals[1];
    return true;
}

// The time [s] from t on within which the push turns at most once.
static double part_of_period(const BoundView* view, double t, double period) {
    const FcFriction* friction = view->scene.friction;
    double part = PART_OF_PERIOD * period;
    if (fc_has_static_friction(friction) && view->side != 0) {
        const FcVelocity at = fc_drive_velocity(&view->scene.drive, t);
        const double change =
            fc_max(PART_OF_PEAK * friction->V_S, fabs(at.V) - FC_END_OF_PEAK * friction->V_S);
        part = fc_min(part, fc_velocity_time_of_change(&at, change));
    }
    assert(!(part < 0.0) && period > 0.0);
    return fc_max(part, MIN_PART_OF_PERIOD * period);
}

// The first local time up to `end` at which the push towards the bound of that side ends; else `end`.
static double first_turn(const BoundView* view, int side, double start, double period, double end) {
    if (!(start < end)) { // an input may be 0 at the start
        return end;
    }
    FcPushed of = {&view->plane, view->state, {side, 0.0}};
    double evaluations = 0.0;
    double before = fc_push_at(&of, start);
    double t = start;
    while (t < end) {
        const double next = fc_min(end, t + part_of_period(view, t, period));
        const double after = fc_push_at(&of, next);
        if (before > 0.0 && after <= 0.0) {
            return fc_root_between(fc_push_at, &of, t, before, next, after, 0.0, &evaluations);
        }
        before = after;
        t = next;
    }
    return end;
}

// Whether a bristle that sticks from now on is near the bound of that side at the time t.
static bool turns_near(const BoundView* view, int side, double delta, double t) {
    return !fc_may_stick(view->scene.friction) ||
           side * (delta + fc_drive_displacement(&view->scene.drive, 0.0, t)) >
               NEAR_THE_BOUND * fc_bound(&view->plane, view->state, t).D;
}

// The time [s], at most `longest`, within which an input that falls does not come to 0.
static double before_opening(const FcDrive* drive, double longest) {
    const FcLinearInput falling[] = {
        drive->load, drive->E, {drive->d.value - drive->vibration.a_d, drive->d.rate}};
    for (int i = 0; i < 3; i++) {
        longest =
            falling[i].rate < 0.0 ? fc_min(longest, 0.5 * falling[i].value / -falling[i].rate) : longest;
    }
    return longest;
}

// The time [s] in which the vibration turns the bristle back from a bound; at most `longest`.
static double time_to_turn(const BoundView* view, double delta, double period, double longest) {
    const double start = 1e3 * AFTER_TURN * period;
    const double end = before_opening(&view->scene.drive, longest);
    double turn = longest;
    for (int side = -1; side <= 1; side += 2) {
        const double t = view->side != -side ? first_turn(view, side, start, period, end) : end;
        if (t < end && (view->side != 0 || turns_near(view, side, delta, t))) {
            turn = fc_min(turn, t);
        }
    }
    return turn;
}

bool fc_ode_next_event(FcFrictionContact* contact, double* time) {
    BoundView now;
    make_view(contact, &now);
    if (!fc_drive_vibrates(&now.scene.drive)) {
        return false;
    }
    const double period = 1.0 / now.scene.drive.vibration.f;
    double ahead = LONGEST_AHEAD * period;
    if (fc_is_bounded(now.scene.friction) && !fc_scene_is_separated(&now.scene)) {
        ahead = fc_is_planar(&now.scene, fc_friction_contact_bristle(contact))
                    ? PART_OF_PERIOD * period
                    : time_to_turn(&now, contact->state.variables.delta, period, ahead);
    }
    *time = contact->state.clock.time + ahead + AFTER_TURN * period;
    return isfinite(*time) && *time > contact->state.clock.time;
}

void fc_ode_event_ends(FcFrictionContact* contact) {
    sample_inputs(contact);
    update_lag(contact);
    contact->state.ode.lag_heat = 0.0; // its start
}

// The separation [m] whose force is the nominal one of an open contact until it has closed: the surfaces just
// touch, with e^-10 of the largest force. At half of it the nominal force would be e^5 times as large.
static double touching(const FcScene* scene) { return 10.0 / scene->at_E.decay; }

static void set_nominals(double nominals[FC_STATE_COUNT], double delta, double energy) {
    nominals[0] = nominals[3] = delta;
    nominals[1] = nominals[2] = energy;
}

bool fc_ode_nominals(FcFrictionContact* contact, double nominals[FC_STATE_COUNT], FcMessage* message) {
    if (!fc_friction_contact_check(contact, message)) {
        return false;
    }
    const FcScene scene = fc_friction_contact_scene_moving(contact, NULL);
    const FcOdeState* ode = &contact->state.ode;
    const bool open = fc_scene_is_separated(&scene);
    if (open && ode->nominal_delta > 0.0) {
        set_nominals(nominals, ode->nominal_delta, ode->nominal_energy);
        return true;
    }
    const double d = open ? touching(&scene) : scene.drive.d.value;
    const FcContactResponse at = fc_contact_response(&scene.at_E, d);
    const FcVibration* vibration = &scene.drive.vibration;
    const double force = !open                                   ? fc_scene_mean_limit(&scene, 0.0)
                         : fc_limit_follows_load(scene.friction) ? scene.friction->mu * at.F_n
                                                                 : scene.F_C;
    const double length = force / at.sigma;
    const double amplitude = hypot(vibration->V_1, vibration->V_2) / (FC_TWO_PI * vibration->f);
    const double energy = force * fc_max(length, amplitude);
    if (!(length > 0.0 && energy > 0.0) || !isfinite(length) || !isfinite(energy)) {
        return fc_message_set(message,
                              "the nominal values of the states are no finite numbers above 0: the limit of "
                              "the force is %.9g N, sigma = %.9g N/m",
                              force, at.sigma);
    }
    set_nominals(nominals, length, energy);
    return true;
}
