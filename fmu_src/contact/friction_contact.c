#include "contact/friction_contact.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "contact/checks.h"
#include "model/extremes.h"
#include "model/pi.h"
#include "solver/method.h"

static bool are_equal(const FcContactParameters* a, const FcContactParameters* b) {
    return a->model == b->model && a->input == b->input && a->sigma == b->sigma &&
           a->stiffnessScale == b->stiffnessScale && a->R_q == b->R_q && a->R == b->R && a->eta == b->eta &&
           a->A_n == b->A_n && a->nu == b->nu && a->Y == b->Y && a->c == b->c && a->lambda == b->lambda;
}

_Static_assert(sizeof(FcContactParameters) == 10 * sizeof(double) + 2 * sizeof(int),
               "a new member of FcContactParameters must be compared in are_equal");

// The contact at the modulus E [Pa] with the present parameters: computed anew if they or E have changed.
static const FcContactAtModulus* contact_at(FcFrictionContact* contact, double E) {
    const FcContactParameters* parameters = &contact->state.variables.contact;
    if (contact->at_E_E != E || !are_equal(&contact->at_E_of, parameters)) {
        contact->at_E = fc_contact_at_modulus(parameters, E);
        contact->at_E_of = *parameters;
        contact->at_E_E = E;
    }
    return &contact->at_E;
}

// The load after a step in which it moves: 0 if the step opens or closes the contact at its very end
// (fc_scene_segment).
static double load_after(FcLinearInput load, double h) {
    const double after = fc_input_after(load, h);
    return after <= FC_NEARLY_OPEN * fabs(load.rate) * h ? fc_min(after, 0.0) : after;
}

// V or V_y after a step: 0 within the rounding of its rate and of the product, so that a ramp to 0 ends there.
static double velocity_after(double V, double rate, double h) {
    const double after = V + rate * h;
    return fabs(after) > DBL_EPSILON * fabs(V) ? after : 0.0;
}

// Whether a scene whose law does not use the separation has one above 0, with finite results.
static bool has_contact(const FcScene* scene) {
    return scene->drive.d.value > scene->drive.vibration.a_d && isfinite(scene->at_E.area_0) &&
           isfinite(scene->at_E.load_0);
}

// The scene from the absolute time start + rest on, with the inputs moving at these rates for ahead [s]
// before it begins. Inputs that the law does not use stand still, and without a separation above 0 they count as an
// open contact.
static void scene_from(FcFrictionContact* contact, double start, double rest,
                       const double rate[FC_INPUT_COUNT], double ahead, FcScene* scene) {
    const FcVariables* v = &contact->state.variables;
    const bool is_used = fc_uses_separation(&v->friction, v->contact.model);
    FcDrive* drive = &scene->drive;
    drive->V = (FcLinearInput){velocity_after(v->V, rate[FC_INPUT_V], ahead), rate[FC_INPUT_V]};
    drive->V_y = (FcLinearInput){velocity_after(v->V_y, rate[FC_INPUT_V_Y], ahead), rate[FC_INPUT_V_Y]};
    drive->d = (FcLinearInput){v->d + rate[FC_INPUT_D] * ahead, rate[FC_INPUT_D]};
    drive->E = (FcLinearInput){v->E, rate[FC_INPUT_E]};
    drive->load = (FcLinearInput){v->load, rate[FC_INPUT_LOAD]};
    drive->E.value = fc_input_after(drive->E, ahead);
    drive->load.value = load_after(drive->load, ahead);
    drive->vibration = v->vibration;
    if (!is_used) {
        drive->d.rate = drive->E.rate = drive->load.rate = 0.0;
    }
    const bool has_E = drive->E.value > 0.0;
    if (!has_E) { // it is not used, or will be refused
        drive->E = (FcLinearInput){1.0, 0.0};
    }
    fc_drive_start(drive, start, rest);
    fc_scene_make(scene, &v->contact, contact_at(contact, drive->E.value), &v->friction, v->F_C);
    if (!is_used && !(has_E && has_contact(scene))) {
        scene->drive.d.value = 1.0 + drive->vibration.a_d; // apart at any phase
        scene->is_open = true;
    }
}

static const double* present_rates(const FcFrictionState* state) {
    return state->rates.next_is_set ? state->rates.next : state->rates.last;
}

static FcBody body_of(const FcVariables* v, const double rate[FC_INPUT_COUNT]) {
    return (FcBody){.m = v->body.m, .F = {v->body.F, rate[FC_INPUT_F]}, .v = v->body.v, .x = v->body.x};
}

FcBody fc_friction_contact_body(const FcFrictionContact* contact) {
    return body_of(&contact->state.variables, present_rates(&contact->state));
}

// The scene at the time t [s] with the motion of the body: first as before a jump of the inputs, by
// which the force that moves the body is that of the deflection after it.
static FcScene scene_with_body(const FcFrictionContact* contact, const FcScene* scene, double t,
                               const double rate[FC_INPUT_COUNT]) {
    const FcBody body = body_of(&contact->state.variables, rate);
    double heat;
    const FcBristle bristle = fc_friction_contact_bristle(contact);
    const FcScene before = fc_body_scene(scene, &body, bristle);
    return fc_body_scene(scene, &body,
                         fc_input_jump(&before, t, &contact->state.bristle.past, &bristle, &heat));
}

static FcScene present_scene(FcFrictionContact* contact, const double rate[FC_INPUT_COUNT]) {
    const FcFrictionState* state = &contact->state;
    FcScene scene;
    scene_from(contact, state->clock.time, state->clock.rest, rate, 0.0, &scene);
    return state->variables.body.m > 0.0 ? scene_with_body(contact, &scene, state->clock.time, rate) : scene;
}

FcScene fc_friction_contact_scene(FcFrictionContact* contact) {
    return present_scene(contact, present_rates(&contact->state));
}

// (F_t, F_y) of a bristle within its bound, or of a mass at rest by Coulomb's law; false if an output is beyond the
// largest number.
static bool find_force(const FcScene* scene, const FcContactResponse* contact, const FcBody* body,
                       FcBristle bristle, FcVector* force, FcMessage* message) {
    *force = fc_force(scene, contact, bristle);
    if (body->m > 0.0 && !fc_has_bristle(scene->friction) && fc_body_rests(scene, body)) {
        bool sticks;
        force->x = fc_body_rigid_force(scene, body, &sticks);
    }
    if (!isfinite(bristle.delta) || !isfinite(bristle.delta_y)) {
        const FcFastest of = fc_fastest(&scene->drive);
        return fc_message_set(message, "%s is beyond the largest number: %s = %.9g m/s with %s = %.9g m/s",
                              isfinite(bristle.delta) ? "delta_y" : "delta", of.name, of.V, of.vibration,
                              of.amplitude);
    }
    if (!isfinite(contact->sigma) || !isfinite(contact->A_r) || !isfinite(contact->F_n)) {
        return fc_fail_stiffness(message, scene->drive.d.value, scene->drive.E.value);
    }
    if (!isfinite(force->x) || !isfinite(force->y)) {
        const bool along = !isfinite(force->x);
        return fc_message_set(message,
                              "%s = sigma %s is beyond the largest number: sigma = %.9g N/m, %s = %.9g m",
                              along ? "F_t" : "F_y", along ? "delta" : "delta_y", contact->sigma,
                              along ? "delta" : "delta_y", along ? bristle.delta : bristle.delta_y);
    }
    return true;
}

void fc_set_outputs(FcVariables* v, FcVector force, FcVector mean, const FcContactResponse* contact) {
    v->F_t = force.x;
    v->F_y = force.y;
    v->F_t_mean = mean.x;
    v->F_y_mean = mean.y;
    v->F_n = contact->F_n;
    v->sigma = contact->sigma;
    v->A_r = contact->A_r;
}

FcBristle fc_friction_contact_bristle(const FcFrictionContact* contact) {
    const FcVariables* v = &contact->state.variables;
    return (FcBristle){
        .delta = v->delta, .state = (FcBristleState)contact->state.bristle.state, .delta_y = v->delta_y};
}

FcBristle fc_friction_contact_reached(const FcFrictionContact* contact, const FcScene* scene) {
    double heat;
    const FcBristle bristle = fc_friction_contact_bristle(contact);
    return fc_input_jump(scene, contact->state.clock.time, &contact->state.bristle.past, &bristle, &heat);
}

double* fc_input_of(FcVariables* v, FcInput input) {
    switch (input) { // without a default, so that the compiler tells of an input that has no case
    case FC_INPUT_V:
        return &v->V;
    case FC_INPUT_D:
        return &v->d;
    case FC_INPUT_E:
        return &v->E;
    case FC_INPUT_LOAD:
        return &v->load;
    case FC_INPUT_V_Y:
        return &v->V_y;
    case FC_INPUT_F:
        return &v->body.F;
    case FC_INPUT_COUNT:
        break;
    }
    return NULL;
}

static const double HELD[FC_INPUT_COUNT] = {0}; // rates of inputs that stand still

FcScene fc_friction_contact_scene_moving(FcFrictionContact* contact, const double rate[FC_INPUT_COUNT]) {
    return present_scene(contact, rate ? rate : HELD);
}

// Combinations that single bounds do not cover: the separation must stay positive under vibration, the
// stiffness and the limit finite and above 0, and the time must determine the phase.
bool fc_friction_contact_check(FcFrictionContact* contact, FcMessage* message) {
    FcScene scene;
    scene_from(contact, contact->state.clock.time, contact->state.clock.rest, HELD, 0.0, &scene);
    const FcVariables* v = &contact->state.variables;
    return fc_check_inputs(v, message) && fc_check_body(v, contact->state.rates.next, message) &&
           fc_check_time(&scene.drive, contact->state.clock.time, message) &&
           fc_check_scene(&scene, 0.0, message);
}

static bool update_outputs(FcFrictionContact* contact, FcMessage* message) {
    FcVariables* v = &contact->state.variables;
    const FcScene scene = fc_friction_contact_scene(contact);
    const FcContactResponse response = fc_scene_contact(&scene, 0.0);
    FcVector force;
    const FcBristle bristle = fc_friction_contact_reached(contact, &scene);
    const FcBody body = fc_friction_contact_body(contact);
    if (!find_force(&scene, &response, &body, bristle, &force, message)) {
        return false;
    }
    fc_set_outputs(v, force, (FcVector){v->F_t_mean, v->F_y_mean}, &response);
    return true;
}

bool fc_friction_contact_refresh(FcFrictionContact* contact, FcMessage* message) {
    return fc_friction_contact_check(contact, message) && update_outputs(contact, message);
}

bool fc_friction_contact_refresh_rates(FcFrictionContact* contact, FcMessage* message) {
    FcVariables* v = &contact->state.variables;
    const FcScene scene = fc_friction_contact_scene(contact);
    FcBristle bristle = fc_friction_contact_reached(contact, &scene);
    bristle.state = fc_bristle_state(&scene, bristle);
    const FcMotion now = fc_motion(&scene, bristle);
    if (!fc_motion_is_finite(&now)) {
        return fc_fail_motion(&scene, v, message);
    }
    v->der = now.rates;
    return true;
}

bool fc_friction_contact_sticks(FcFrictionContact* contact) {
    const FcScene scene = fc_friction_contact_scene(contact);
    const FcBody body = fc_friction_contact_body(contact);
    bool sticks = false;
    if (body.m > 0.0 && !fc_has_bristle(scene.friction) && fc_body_rests(&scene, &body)) {
        fc_body_rigid_force(&scene, &body, &sticks);
    }
    return sticks;
}

FcVector fc_friction_contact_force_rate(FcFrictionContact* contact) {
    FcScene scene = fc_friction_contact_scene(contact);
    const FcBody body = fc_friction_contact_body(contact);
    if (fc_friction_contact_sticks(contact)) {
        return (FcVector){body.F.rate + body.m * fc_drive_velocity(&scene.drive, 0.0).curvature, 0.0};
    }
    if (body.m > 0.0 && !fc_has_bristle(scene.friction)) {
        scene.drive.V.rate += (body.F.value - contact->state.variables.F_t) / body.m;
    }
    return fc_force_rate(&scene, fc_friction_contact_reached(contact, &scene));
}

bool fc_friction_contact_prepare(FcFrictionContact* contact, const FcVariables* of, FcMessage* message) {
    const bool has_body = of->body.m > 0.0;
    const bool is_asked = of->solver.method == FC_METHOD_CVODE;
    const bool is_second =
        has_body && fc_has_bristle(&of->friction); // for what the march cannot make accurate
    struct FcCvode** cvode = &contact->cvode[has_body];
    if ((is_asked || is_second) && *cvode == NULL) {
        *cvode = fc_cvode_new(has_body, message);
    }
    return !is_asked || *cvode != NULL;
}

// The finest tolerance of the bristle's force. Rounding: 4500 eps. A finer one would need digits that do not
// exist.
static const double SMALLEST_TOLERANCE = 1e-12;

// The bristle's force [N]: the largest of the limit at both ends of the step and the force at its start.
static double force_of_bristle(const FcScene* scene, double h, FcBristle from) {
    const FcFriction* friction = scene->friction;
    double limit = fc_scene_mean_limit(scene, 0.0);
    if (fc_scene_has_segments(scene)) {
        limit = fc_max(limit, fc_scene_mean_limit(scene, h));
    }
    const double delta = fc_size(from);
    const double elastic = !fc_has_bristle(friction) || delta == 0.0 || fc_scene_is_separated(scene)
                               ? 0.0
                               : fabs(fc_scene_stiffness(scene, 0.0) * delta);
    return fc_max(fc_max(fc_static_ratio(friction) * limit, elastic), DBL_MIN);
}

// The least limit of the step. If the contact opens or closes in the step, the mean limit at its closed end.
static double least_limit(const FcScene* scene, double h) {
    const double at_ends = fc_min(fc_scene_mean_limit(scene, 0.0), fc_scene_mean_limit(scene, h));
    return at_ends > 0.0 ? fc_scene_smallest_limit(scene, h)
                         : fc_max(fc_scene_mean_limit(scene, 0.0), fc_scene_mean_limit(scene, h));
}

// solver.tolerance is relative to the largest of the forces of bristle, damping and viscosity. An error of
// the deflection acts through sigma delta and, since delta' = V - sigma |V| delta / g, through sigma_1
// delta', where it is multiplied by sigma |V| / g. So the damping divides the allowed error of the bristle's
// force.
static FcSolverOptions solver_options(const FcVariables* v, const FcScene* scene, double h, FcBristle from) {
    const double sigma_1 = !fc_has_bristle(&v->friction) ? 0.0 : v->friction.sigma_1;
    const double sigma_2 = v->friction.sigma_2;
    const double speed = sigma_1 != 0.0 || sigma_2 != 0.0 ? fc_drive_largest_speed(&scene->drive, h) : 0.0;
    const double damping = sigma_1 * speed;
    const double bristle = force_of_bristle(scene, h, from);
    const double limit = damping != 0.0 ? least_limit(scene, h) : 0.0;
    const double largest = fc_max(bristle, damping + sigma_2 * speed);
    double force = largest;
    if (limit > 0.0) {
        force = fc_max(fc_force_beside_damping(largest, damping, limit),
                       bristle * SMALLEST_TOLERANCE / v->solver.tolerance);
    }
    return (FcSolverOptions){.tolerance = fc_max(SMALLEST_TOLERANCE, v->solver.tolerance),
                             .force = force,
                             .largest = largest,
                             .damping = damping,
                             .step_size = v->solver.stepSize};
}

// The bristle at the start.
static FcBristle first_bristle(FcFrictionContact* contact) {
    FcVariables* v = &contact->state.variables;
    if (!fc_has_bristle(&v->friction)) {
        return (FcBristle){0};
    }
    if (v->initialState == FC_STATE_GIVEN) {
        return (FcBristle){.delta = v->delta_0, .delta_y = v->delta_y_0};
    }
    FcScene scene = fc_friction_contact_scene_moving(contact, NULL);
    scene.drive.V.rate = 0.0; // a mass keeps its velocity
    const FcBristle start =
        fc_project_onto_bound(&scene, (FcBristle){.delta = v->delta_0, .delta_y = v->delta_y_0});
    const double period = fc_drive_vibrates(&scene.drive) ? 1.0 / v->vibration.f : 0.0;
    const FcSolverOptions options = solver_options(v, &scene, period, start);
    FcVector force;
    return fc_method_settled(&scene, &options, start, &force, &v->solver.evaluations, &contact->scatters);
}

bool fc_friction_contact_initialize(FcFrictionContact* contact, double start, FcMessage* message) {
    FcFrictionContact fresh = *contact;
    FcFrictionState* state = &fresh.state;
    state->clock.time = start;
    state->clock.rest = 0.0;
    state->rest.W_f = 0.0;
    state->rest.Q_f = 0.0;
    memcpy(state->rates.last, HELD, sizeof state->rates.last);
    memset(&state->bristle, 0, sizeof state->bristle); // what an earlier start has left is no past
    state->ode = (FcOdeState){0};
    FcVariables* v = &state->variables;
    v->body.v = v->body.m > 0.0 ? v->body.v_0 : 0.0;
    v->body.x = v->body.m > 0.0 ? v->body.x_0 : 0.0;
    if (!fc_friction_contact_check(&fresh, message)) {
        return false;
    }
    v->W_f = 0.0;
    v->Q_f = 0.0;
    v->solver.evaluations = 0.0;
    const FcBristle first = first_bristle(&fresh);
    v->delta = first.delta;
    v->delta_y = first.delta_y;
    state->bristle.state = (int)first.state;
    const FcScene scene = fc_friction_contact_scene_moving(&fresh, NULL);
    const double within = (1.0 + FC_ROUNDING_OF_BOUND) * fc_size(fc_project_onto_bound(&scene, first));
    const bool is_within = fc_is_bounded(&v->friction) && fc_size(first) <= within;
    state->bristle.past = is_within ? fc_past(&scene) : (FcPast){.sigma = 0.0}; // an excess becomes heat
    if (v->solver.evaluations > FC_MAX_EVALUATIONS) {
        return fc_message_set(
            message,
            "initialState = Settled needs more than %.0e evaluations of a vibration period: vibration.a_d = "
            "%.9g m at d = %.9g m moves the contact over too many orders of magnitude, or "
            "no period is like another",
            FC_MAX_EVALUATIONS, v->vibration.a_d, v->d);
    }
    if (!update_outputs(&fresh, message) || !fc_friction_contact_prepare(&fresh, v, message)) {
        return false;
    }
    v->F_t_mean = v->F_t;
    v->F_y_mean = v->F_y;
    *contact = fresh;
    return true;
}

void fc_friction_contact_free(FcFrictionContact* contact) {
    for (int has_body = 0; has_body <= 1; has_body++) {
        fc_cvode_free(contact->cvode[has_body]);
        contact->cvode[has_body] = NULL;
    }
}

// Adds the damping of the bristle, which Coulomb's law does not have, and the viscous friction to the result
// of the method.
static void add_damping(const FcScene* scene, double h, FcBristle start, FcStepResult* result) {
    const double sigma_1 = scene->friction->sigma_1;
    const double sigma_2 = scene->friction->sigma_2;
    if (sigma_1 != 0.0) {
        result->impulse += sigma_1 * (result->delta - start.delta + result->lost);
        result->impulse_y += sigma_1 * (result->delta_y - start.delta_y + result->lost_y);
        result->work += sigma_1 * result->drag;
        result->heat += sigma_1 * result->drag;
    }
    if (sigma_2 != 0.0) {
        double square = fc_drive_square(&scene->drive, 0.0, h);
        result->impulse += sigma_2 * fc_drive_displacement(&scene->drive, 0.0, h);
        if (fc_drive_is_planar(&scene->drive)) {
            const FcDrive across = fc_drive_across(&scene->drive);
            square += fc_drive_square(&across, 0.0, h);
            result->impulse_y += sigma_2 * fc_drive_displacement(&across, 0.0, h);
        }
        const double viscous = sigma_2 * square;
        result->work += viscous;
        result->heat += viscous;
    }
}

// The rounding error of a + b (Knuth's two-sum).
static double rounding_of_sum(double a, double b) {
    const double sum = a + b;
    const double b_part = sum - a;
    return (a - (sum - b_part)) + (b - b_part);
}

// Adds part to *sum. *rest collects the rounding errors.
static void accumulate(double* sum, double* rest, double part) {
    const double all = part + *rest;
    *rest = rounding_of_sum(*sum, all);
    *sum += all;
}

// Stores the ends of the inputs, the deflection and the sums. The rates of the next step become those of the
// last one.
static void commit(FcFrictionState* state, double h, const FcStepResult* result, FcBristle reached,
                   const FcPast* past) {
    FcVariables* v = &state->variables;
    v->body.F += state->rates.next[FC_INPUT_F] * h;
    state->bristle.state = (int)reached.state;
    state->bristle.past = *past;
    v->V = velocity_after(v->V, state->rates.next[FC_INPUT_V], h);
    v->V_y = velocity_after(v->V_y, state->rates.next[FC_INPUT_V_Y], h);
    v->d += state->rates.next[FC_INPUT_D] * h;
    v->E = fc_input_after((FcLinearInput){v->E, state->rates.next[FC_INPUT_E]}, h);
    v->load = load_after((FcLinearInput){v->load, state->rates.next[FC_INPUT_LOAD]}, h);
    v->delta = reached.delta;
    v->delta_y = reached.delta_y;
    v->solver.evaluations += result->evaluations;
    accumulate(&v->W_f, &state->rest.W_f, result->work);
    accumulate(&v->Q_f, &state->rest.Q_f, result->heat);
    memcpy(state->rates.last, state->rates.next, sizeof state->rates.last);
    memset(state->rates.next, 0, sizeof state->rates.next);
    state->rates.next_is_set = 0;
}

static bool inputs_move(const double rate[FC_INPUT_COUNT]) {
    bool moves = false;
    for (int input = 0; input < FC_INPUT_COUNT; input++) {
        moves = moves || rate[input] != 0.0;
    }
    return moves;
}

// A step by h [s]: what it begins with, and its result.
typedef struct {
    FcScene scene; // without the body
    FcScene moved; // with the body at the start; then the scene of the end, if that is another one
    FcBody body;
    FcContactResponse response; // at the start if nothing moves; then at the end
    FcStepResult result;
} Step;

// Whether time, inputs, mass and contact allow a step.
static bool check_step(FcFrictionContact* contact, double t, double h, Step* step, FcMessage* message) {
    if (!(h == 0.0 || h >= DBL_MIN) || !isfinite(t + h)) {
        fc_message_set(message,
                       "the step from t = %.9g s by h = %.9g s: h must be 0 s, or a finite number of at "
                       "least %.9g s",
                       t, h, DBL_MIN);
        return false; // also clang-tidy sees that no step follows
    }
    const FcFrictionState* before = &contact->state;
    FcScene* scene = &step->scene;
    scene_from(contact, t, 0.0, before->rates.next, 0.0, scene);
    step->body = body_of(&before->variables, before->rates.next);
    return fc_check_inputs(&before->variables, message) &&
           fc_check_body(&before->variables, before->rates.next, message) &&
           fc_check_time(&scene->drive, t, message) && fc_check_time(&scene->drive, t + h, message) &&
           (!fc_scene_is_to_be_checked(scene) || fc_check_scene(scene, h, message));
}

// The inputs jump to those of the step; then the method takes bristle and body through it.
static bool take_step(FcFrictionContact* contact, double t, double h, Step* step, FcMessage* message) {
    const FcFrictionState* before = &contact->state;
    const FcScene* scene = &step->scene;
    const bool has_body = step->body.m > 0.0;
    const bool moves = !fc_drive_is_constant(&scene->drive);
    if (has_body) {
        step->moved = scene_with_body(contact, scene, t, before->rates.next);
    }
    const FcScene* seen = has_body ? &step->moved : scene;
    double heat;
    const FcBristle bristle = fc_friction_contact_bristle(contact);
    const FcBristle start = fc_input_jump(seen, t, &before->bristle.past, &bristle, &heat);
    const FcMethod method = (FcMethod)before->variables.solver.method;
    if (!moves) {
        step->response = fc_scene_contact(scene, 0.0);
    }
    if (has_body || moves || !fc_method_formula(scene, &step->response, method, h, start, &step->result)) {
        const FcSolverOptions options = solver_options(&before->variables, seen, h, bristle);
        if (has_body ? !fc_body_step(scene, method, contact->cvode[1], &options, h, start, &step->body,
                                     &step->result, message)
                     : !fc_method_step(scene, method, contact->cvode[0], &options, h, start, &step->result,
                                       message)) {
            return false;
        }
    }
    step->result.heat += heat;
    if (!has_body) {
        add_damping(scene, h, start, &step->result);
    }
    return true;
}

// The scene at the end of a step from t by h [s], as the next step will see it, and its response. The scene is evaluated at the
// phase of t + h, which is also that of the next step. A phase carried on from the step's start would lose digits with every
// period.
static const FcScene* end_scene(FcFrictionContact* contact, double t, double h, Step* step) {
    const double* rate = contact->state.rates.next;
    FcBody* body = &step->body;
    const bool has_body = body->m > 0.0;
    // An input that moves may be one that the law does not use.
    if (!has_body && fc_drive_is_constant(&step->scene.drive) && !inputs_move(rate)) {
        return &step->scene;
    }
    scene_from(contact, t + h, rounding_of_sum(t, h), rate, h, &step->moved);
    if (has_body) {
        body->v = body->sticks ? 0.0 - fc_drive_V(&step->moved.drive, 0.0) : body->v;
        step->moved = fc_body_scene(&step->moved, body, fc_bristle_of(&step->result));
    }
    step->response = fc_scene_contact(&step->moved, 0.0);
    return &step->moved;
}

// Whether the results of a step of h [s] and the sums with them are finite.
static bool check_result(const FcVariables* v, double h, const Step* step, FcVector mean,
                         FcMessage* message) {
    const FcStepResult* result = &step->result;
    if (isfinite(mean.x) && isfinite(mean.y) && isfinite(result->delta) && isfinite(result->delta_y) &&
        isfinite(v->W_f + result->work) && isfinite(v->Q_f + result->heat) &&
        isfinite(step->body.v + step->body.x)) {
        return true;
    }
    const FcFastest of = fc_fastest(&step->scene.drive);
    return fc_message_set(message,
                          "the step by h = %.9g s gives a result beyond the largest number at %s = %.9g m/s, "
                          "d = %.9g m",
                          h, of.name, of.V, v->d);
}

// - Time, inputs, mass and contact are checked.
// - The inputs jump to those of the step, and a method takes bristle and body through it.
// - The scene at the end gives the force. A bristle that slips is moved onto its bound there.
// - Results that are finite are stored; if anything is refused, the contact stays as it was.
bool fc_friction_contact_advance(FcFrictionContact* contact, double t, double h, FcMessage* message) {
    Step step;
    if (!check_step(contact, t, h, &step, message) || !take_step(contact, t, h, &step, message)) {
        return false;
    }
    FcVariables* v = &contact->state.variables;
    const FcStepResult* result = &step.result;
    const FcScene* end = end_scene(contact, t, h, &step);
    const bool slips = h > 0.0 && result->state == FC_SLIPPING && !fc_scene_is_separated(end);
    const FcBristle reached = slips ? fc_scale_onto_bound(end, fc_bristle_of(result)) : fc_bristle_of(result);
    FcVector force;
    if (!find_force(end, &step.response, &step.body, reached, &force, message)) {
        return false;
    }
    const FcVector mean = h > 0.0 ? (FcVector){result->impulse / h, result->impulse_y / h} : force;
    if (!check_result(v, h, &step, mean, message)) {
        return false;
    }
    const FcPast past = fc_is_bounded(&v->friction) ? fc_past(end) : (FcPast){.sigma = 0.0};
    commit(&contact->state, h, result, reached, &past);
    fc_set_outputs(v, force, mean, &step.response);
    v->body.v = step.body.v;
    v->body.x = step.body.x;
    contact->state.clock.time = t + h;
    contact->state.clock.rest = rounding_of_sum(t, h);
    return true;
}

bool fc_friction_contact_undersamples(const FcFrictionContact* contact, double h) {
    const FcVibration* vibration = &contact->state.variables.vibration;
    return (vibration->V_1 != 0.0 || vibration->V_2 != 0.0 || vibration->a_d != 0.0) &&
           h * vibration->f > 0.5;
}

double fc_friction_contact_rings(const FcFrictionContact* contact, double h) {
    const FcVariables* v = &contact->state.variables;
    const FcVibration* vibration = &v->vibration;
    const bool is_free = fc_has_bristle(&v->friction) && v->friction.sigma_1 == 0.0 &&
                         vibration->V_1 == 0.0 && vibration->a_d == 0.0 && v->body.m > 0.0;
    const double periods = is_free ? h * sqrt(v->sigma / v->body.m) / FC_TWO_PI : 0.0;
    return periods > 1.0 ? periods : 0.0;
}
