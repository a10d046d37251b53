#include "friction_contact.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "solver/methods/method.h"

// The smallest limit mu F_n that is computed. By hand: eight decades above the smallest normal number, for what it is divided by.
static const double SMALLEST_LIMIT = 1e-300; // N

// Vibration periods since time 0 beyond which its phase is refused. By hand: neighbouring numbers of time are then more than
// 2^-52 of it, 1/64 of a period, apart.
static const double MOST_CYCLES = 0x1p46;

// The largest |V| + V_1 that is computed. By hand, beyond any machine: from about 1e33 F_C vibration.f / sigma on the numbers
// of a step overflow.
static const double MOST_SPEED = 1e15; // m/s

static bool fail_stiffness(FcMessage* message, double d, double E) {
    return fc_message_set(
        message,
        "the contact stiffness at d = %.9g m, E = %.9g Pa is beyond the largest number: check d and the "
        "parameters contact.*",
        d, E);
}

static bool are_equal(const FcContactParameters* a, const FcContactParameters* b) {
    return a->model == b->model && a->input == b->input && a->sigma == b->sigma &&
           a->stiffnessScale == b->stiffnessScale && a->R_q == b->R_q && a->R == b->R && a->eta == b->eta &&
           a->A_n == b->A_n && a->nu == b->nu && a->Y == b->Y && a->c == b->c && a->lambda == b->lambda;
}

_Static_assert(sizeof(FcContactParameters) == 10 * sizeof(double) + 2 * sizeof(int),
               "a new member of FcContactParameters must be compared in are_equal");

// The contact at the modulus E [Pa] with the present parameters: computed anew where they or E have changed.
static const FcContactAtModulus* contact_at(FcFrictionContact* contact, double E) {
    const FcContactParameters* parameters = &contact->state.variables.contact;
    if (contact->at_E_E != E || !are_equal(&contact->at_E_of, parameters)) {
        contact->at_E = fc_contact_at_modulus(parameters, E);
        contact->at_E_of = *parameters;
        contact->at_E_E = E;
    }
    return &contact->at_E;
}

// The scene from the absolute time start + rest on, the inputs moving at these rates for ahead [s] before it begins.
static FcScene scene_from(FcFrictionContact* contact, double start, double rest,
                          const double rate[FC_INPUT_COUNT], double ahead) {
    const FcVariables* v = &contact->state.variables;
    const FcLinearInput V = {v->V + rate[FC_INPUT_V] * ahead, rate[FC_INPUT_V]};
    const FcLinearInput d = {v->d + rate[FC_INPUT_D] * ahead, rate[FC_INPUT_D]};
    FcLinearInput E = {v->E, rate[FC_INPUT_E]};
    FcLinearInput load = {v->load, rate[FC_INPUT_LOAD]};
    E.value = fc_input_after(E, ahead);
    load.value = fc_input_after(load, ahead);
    const FcDrive drive = fc_drive_make(V, d, E, load, v->vibration, start, rest);
    return fc_scene_make(&v->contact, contact_at(contact, E.value), &v->friction, v->F_C, &drive);
}

FcScene fc_friction_contact_scene(FcFrictionContact* contact) {
    const FcFrictionState* state = &contact->state;
    return scene_from(contact, state->time, state->time_rest,
                      state->next_rate_set ? state->next_rate : state->rate, 0.0);
}

static bool fail_separation(const FcScene* scene, double h, FcMessage* message) {
    const FcDrive* drive = &scene->drive;
    const double a_d = drive->vibration.a_d;
    if (scene->contact->input == FC_CONTACT_LOAD) {
        const FcContactAtModulus* at_E = &scene->at_E;
        return fc_message_set(message,
                              "load = %.9g N presses the surfaces together: with vibration.a_d = %.9g m the "
                              "separation must stay "
                              "above 0 m, which it does up to %.9g N",
                              fmax(drive->load.value, fc_drive_load(drive, h)), a_d,
                              at_E->load_0 * exp(scene->log_swell - at_E->decay * a_d));
    }
    if (drive->d.rate == 0.0) {
        return fc_message_set(
            message,
            "vibration.a_d = %.9g m must be below d = %.9g m: the separation d - a_d must stay above 0 m",
            a_d, drive->d.value);
    }
    return fc_message_set(message,
                          "d moves from %.9g m to %.9g m in the step: with vibration.a_d = %.9g m the "
                          "separation must stay above 0 m",
                          drive->d.value, drive->d.value + drive->d.rate * h, a_d);
}

static bool check_limit(const FcScene* scene, double h, FcMessage* message) {
    const double limit = fc_scene_smallest_limit(scene, h);
    if (limit >= SMALLEST_LIMIT && isfinite(fc_scene_force_scale(scene))) {
        return true;
    }
    return fc_message_set(message,
                          "friction.mu = %.9g times the normal force is %.9g N in the step: the limit of the "
                          "friction must be finite and at least %.9g N; check d, load and contact.*",
                          scene->friction->mu, limit, SMALLEST_LIMIT);
}

static bool fail_speed(const FcDrive* drive, double h, FcMessage* message) {
    const double V_1 = drive->vibration.V_1;
    if (drive->V.rate == 0.0) {
        return fc_message_set(
            message, "V = %.9g m/s with vibration.V_1 = %.9g m/s: the speed must stay at most %.9g m/s",
            drive->V.value, V_1, MOST_SPEED);
    }
    return fc_message_set(message,
                          "V moves from %.9g m/s to %.9g m/s in the step with vibration.V_1 = %.9g m/s: the "
                          "speed must stay at most %.9g m/s",
                          drive->V.value, drive->V.value + drive->V.rate * h, V_1, MOST_SPEED);
}

// Separation, modulus, load and limit must stay positive, the speed below its bound and the stiffness a number over
// the step [0, h].
static bool check_scene(const FcScene* scene, double h, FcMessage* message) {
    const FcDrive* drive = &scene->drive;
    if (!(fc_drive_smallest_E(drive, h) > 0.0)) {
        return fc_message_set(message, "E moves from %.9g Pa to %.9g Pa in the step: it must stay above 0 Pa",
                              drive->E.value, drive->E.value + drive->E.rate * h);
    }
    if (scene->contact->input == FC_CONTACT_LOAD && !(fc_drive_load(drive, h) > 0.0)) {
        return fc_message_set(message, "load moves from %.9g N to %.9g N in the step: it must stay above 0 N",
                              drive->load.value, fc_drive_load(drive, h));
    }
    const double d = fc_scene_smallest_d(scene, h);
    if (!(d > 0.0)) {
        return fail_separation(scene, h, message);
    }
    if (!isfinite(fc_scene_largest_stiffness(scene, h)) || !isfinite(scene->at_E.area_0) ||
        !isfinite(scene->at_E.load_0)) {
        return fail_stiffness(message, d, fc_drive_largest_E(drive, h));
    }
    if (!(fc_drive_largest_speed(drive, h) <= MOST_SPEED)) {
        return fail_speed(drive, h, message);
    }
    return check_limit(scene, h, message);
}

// Single bounds say enough where nothing moves and no load decides.
static bool is_to_be_checked(const FcScene* scene) {
    return !fc_drive_is_constant(&scene->drive) || scene->contact->input == FC_CONTACT_LOAD ||
           fc_limit_follows_load(scene->friction);
}

// The outputs at the beginning of the scene; false where one of them is beyond the largest number.
static bool find_outputs(const FcScene* scene, double delta, FcOutputs* outputs, FcMessage* message) {
    *outputs = fc_scene_outputs(scene, 0.0, delta);
    if (!isfinite(delta)) {
        return fc_message_set(
            message, "delta is beyond the largest number: V = %.9g m/s with vibration.V_1 = %.9g m/s",
            scene->drive.V.value, scene->drive.vibration.V_1);
    }
    if (!isfinite(outputs->sigma) || !isfinite(outputs->A_r) || !isfinite(outputs->F_n)) {
        return fail_stiffness(message, scene->drive.d.value, scene->drive.E.value);
    }
    if (!isfinite(outputs->F_t)) {
        return fc_message_set(
            message, "F_t = sigma delta is beyond the largest number: sigma = %.9g N/m, delta = %.9g m",
            outputs->sigma, delta);
    }
    return true;
}

static void set_outputs(FcVariables* v, const FcOutputs* now) {
    v->F_t = now->F_t;
    v->F_n = now->F_n;
    v->sigma = now->sigma;
    v->A_r = now->A_r;
}

static const double HELD[FC_INPUT_COUNT] = {0}; // rates of inputs that stand still

// The time t [s] must tell the phase of the vibration.
static bool check_time(const FcDrive* drive, double t, FcMessage* message) {
    const double f = drive->vibration.f;
    if (!fc_drive_vibrates(drive) || fabs(t) * f <= MOST_CYCLES) {
        return true;
    }
    return fc_message_set(
        message,
        "time = %.9g s is too large for vibration.f = %.9g Hz: beyond %.9g s its neighbouring "
        "numbers are more than 1/64 of a period apart",
        t, f, MOST_CYCLES / f);
}

FcScene fc_friction_contact_scene_moving(FcFrictionContact* contact, const double rate[FC_INPUT_COUNT]) {
    return scene_from(contact, contact->state.time, contact->state.time_rest, rate ? rate : HELD, 0.0);
}

// Single bounds do not see all: the separation must stay positive under vibration, the stiffness and the limit be
// finite numbers above 0, the time tell the phase.
bool fc_friction_contact_check(FcFrictionContact* contact, FcMessage* message) {
    const FcScene scene = fc_friction_contact_scene_moving(contact, NULL);
    return check_time(&scene.drive, contact->state.time, message) && check_scene(&scene, 0.0, message);
}

static bool update_outputs(FcFrictionContact* contact, FcMessage* message) {
    FcVariables* v = &contact->state.variables;
    const FcScene scene = fc_friction_contact_scene(contact);
    FcOutputs now;
    if (!find_outputs(&scene, v->delta, &now, message)) {
        return false;
    }
    set_outputs(v, &now);
    return true;
}

bool fc_friction_contact_refresh(FcFrictionContact* contact, FcMessage* message) {
    return fc_friction_contact_check(contact, message) && update_outputs(contact, message);
}

bool fc_friction_contact_refresh_rates(FcFrictionContact* contact, FcMessage* message) {
    FcVariables* v = &contact->state.variables;
    const FcScene scene = fc_friction_contact_scene(contact);
    double delta = v->delta;
    FcRegime regime = FC_FREE;
    if (fc_is_bounded(scene.friction)) {
        const double D = fc_regime_bound(&scene);
        delta = fmax(-D, fmin(D, delta));
        regime = (FcRegime)fc_scene_slip_side(&scene, 0.0, delta);
    }
    const FcStateRates rates = fc_motion(&scene, regime, delta).rates;
    if (!isfinite(rates.delta) || !isfinite(rates.W_f) || !isfinite(rates.Q_f)) {
        return fc_message_set(message,
                              "the rate of delta, W_f or Q_f is beyond the largest number: V = %.9g m/s with "
                              "vibration.V_1 = %.9g m/s, F_t = %.9g N",
                              v->V, v->vibration.V_1, v->F_t);
    }
    v->der = rates;
    return true;
}

bool fc_friction_contact_prepare(FcFrictionContact* contact, int method, FcMessage* message) {
    if (method == FC_METHOD_CVODE && contact->cvode == NULL) {
        contact->cvode = fc_cvode_new(message);
    }
    return method != FC_METHOD_CVODE || contact->cvode != NULL;
}

// The finest tolerances that the solver is given, of a force, and, where the damping multiplies its error, of the least limit.
// Rounding: 4500 and 5 eps; there are no more digits.
static const double SMALLEST_TOLERANCE = 1e-12;
static const double SMALLEST_DAMPED = 1e-15;

// The tolerance of a force, over what the damping multiplies an error with. An error of the deflection acts through sigma delta
// and, since delta' = V - sigma |V| delta / g, through sigma_1 delta': there times sigma |V| / g.
static double damped_tolerance(const FcScene* scene, double h, double tolerance) {
    const double limit = fc_scene_smallest_limit(scene, h);
    const double gain = 1.0 + scene->friction->sigma_1 * fc_drive_largest_speed(&scene->drive, h) / limit;
    const double rounding = SMALLEST_DAMPED * limit / fc_scene_force_scale(scene);
    return fmax(fmax(DBL_MIN, rounding), tolerance / gain);
}

static FcSolverOptions solver_options(const FcVariables* v, const FcScene* scene, double h) {
    const double tolerance = fmax(SMALLEST_TOLERANCE, v->solver.tolerance);
    return (FcSolverOptions){.tolerance = v->friction.sigma_1 == 0.0 ? tolerance
                                                                     : damped_tolerance(scene, h, tolerance),
                             .step_size = v->solver.stepSize};
}

// The deflection at the start [m].
static double first_deflection(FcFrictionContact* contact) {
    FcVariables* v = &contact->state.variables;
    if (v->friction.model == FC_COULOMB) {
        return 0.0;
    }
    if (v->initialState == FC_STATE_GIVEN) {
        return v->delta_0;
    }
    const FcScene scene = fc_friction_contact_scene_moving(contact, NULL);
    const double period = fc_drive_vibrates(&scene.drive) ? 1.0 / v->vibration.f : 0.0;
    const FcSolverOptions options = solver_options(v, &scene, period);
    return fc_method_settled(&scene, &options, v->delta_0, &v->solver.evaluations);
}

bool fc_friction_contact_initialize(FcFrictionContact* contact, double start, FcMessage* message) {
    FcFrictionContact fresh = *contact;
    FcFrictionState* state = &fresh.state;
    state->time = start;
    state->time_rest = 0.0;
    state->W_f_rest = 0.0;
    state->Q_f_rest = 0.0;
    memcpy(state->rate, HELD, sizeof state->rate);
    state->hybrid = (FcHybrid){0};
    if (!fc_friction_contact_check(&fresh, message)) {
        return false;
    }
    FcVariables* v = &state->variables;
    v->W_f = 0.0;
    v->Q_f = 0.0;
    v->solver.evaluations = 0.0;
    v->delta = first_deflection(&fresh);
    if (v->solver.evaluations > FC_MOST_EVALUATIONS) {
        return fc_message_set(
            message,
            "initialState = Settled needs more than %.0e evaluations of a vibration period: vibration.a_d = "
            "%.9g m at d = %.9g m moves the contact over too many orders of magnitude",
            FC_MOST_EVALUATIONS, v->vibration.a_d, v->d);
    }
    if (!update_outputs(&fresh, message) || !fc_friction_contact_prepare(&fresh, v->solver.method, message)) {
        return false;
    }
    v->F_t_mean = v->F_t;
    *contact = fresh;
    return true;
}

void fc_friction_contact_free(FcFrictionContact* contact) {
    fc_cvode_free(contact->cvode);
    contact->cvode = NULL;
}

// Adds the damping of the bristle, which Coulomb's law has none of, and the viscous friction to what the method gives.
static void add_damping(const FcScene* scene, double h, double delta_0, FcStepResult* result) {
    const double sigma_1 = scene->friction->sigma_1;
    const double sigma_2 = scene->friction->sigma_2;
    if (sigma_1 != 0.0) {
        result->impulse += sigma_1 * (result->delta - fc_method_start(scene, delta_0));
        result->work += sigma_1 * result->drag;
        result->heat += sigma_1 * result->drag;
    }
    if (sigma_2 != 0.0) {
        const double viscous = sigma_2 * fc_drive_square(&scene->drive, 0.0, h);
        result->impulse += sigma_2 * fc_drive_displacement(&scene->drive, 0.0, h);
        result->work += viscous;
        result->heat += viscous;
    }
}

// What a + b loses in rounding (Knuth's two-sum).
static double rounding_of_sum(double a, double b) {
    const double sum = a + b;
    const double b_part = sum - a;
    return (a - (sum - b_part)) + (b - b_part);
}

// Adds part to *sum, *rest being what rounding cuts off.
static void accumulate(double* sum, double* rest, double part) {
    const double all = part + *rest;
    *rest = rounding_of_sum(*sum, all);
    *sum += all;
}

// The inputs where they end, the deflection, the sums; the rates of the next step are those of the last one now.
static void commit(FcFrictionState* state, double h, const FcStepResult* result) {
    FcVariables* v = &state->variables;
    v->V += state->next_rate[FC_INPUT_V] * h;
    v->d += state->next_rate[FC_INPUT_D] * h;
    v->E = fc_input_after((FcLinearInput){v->E, state->next_rate[FC_INPUT_E]}, h);
    v->load = fc_input_after((FcLinearInput){v->load, state->next_rate[FC_INPUT_LOAD]}, h);
    v->delta = result->delta;
    v->solver.evaluations += result->evaluations;
    accumulate(&v->W_f, &state->W_f_rest, result->work);
    accumulate(&v->Q_f, &state->Q_f_rest, result->heat);
    memcpy(state->rate, state->next_rate, sizeof state->rate);
    memset(state->next_rate, 0, sizeof state->next_rate);
    state->next_rate_set = 0;
}

bool fc_friction_contact_advance(FcFrictionContact* contact, double t, double h, FcMessage* message) {
    if (!(h == 0.0 || h >= DBL_MIN) || !isfinite(t + h)) {
        return fc_message_set(
            message,
            "the step from t = %.9g s by h = %.9g s: h must be 0 s, or a finite number of at "
            "least %.9g s",
            t, h, DBL_MIN);
    }
    const FcFrictionState* before = &contact->state;
    const FcScene scene = scene_from(contact, t, 0.0, before->next_rate, 0.0);
    if (!check_time(&scene.drive, t, message) || !check_time(&scene.drive, t + h, message)) {
        return false;
    }
    if (is_to_be_checked(&scene) && !check_scene(&scene, h, message)) {
        return false;
    }
    const FcVariables* v = &before->variables;
    const FcSolverOptions options = solver_options(v, &scene, h);
    FcStepResult result;
    if (!fc_method_step(&scene, (FcMethod)v->solver.method, contact->cvode, &options, h, v->delta, &result,
                        message)) {
        return false;
    }
    add_damping(&scene, h, v->delta, &result);

    // Evaluated at the phase of t + h itself, which is also that of the next step: a phase that is carried on from the
    // step's start loses digits with every period of it.
    const double time_rest = rounding_of_sum(t, h);
    const bool moves = !fc_drive_is_constant(&scene.drive);
    const FcScene end = moves ? scene_from(contact, t + h, time_rest, before->next_rate, h) : scene;
    FcOutputs now;
    if (!find_outputs(&end, result.delta, &now, message)) {
        return false;
    }
    const double F_t_mean = h > 0.0 ? result.impulse / h : now.F_t;
    if (!isfinite(F_t_mean) || !isfinite(result.delta) || !isfinite(v->W_f + result.work) ||
        !isfinite(v->Q_f + result.heat)) {
        return fc_message_set(
            message,
            "the step by h = %.9g s gives a result beyond the largest number at V = %.9g m/s, "
            "d = %.9g m",
            h, v->V, v->d);
    }
    commit(&contact->state, h, &result);
    set_outputs(&contact->state.variables, &now);
    contact->state.variables.F_t_mean = F_t_mean;
    contact->state.time = t + h;
    contact->state.time_rest = time_rest;
    return true;
}

bool fc_friction_contact_undersamples(const FcFrictionContact* contact, double h) {
    const FcVibration* vibration = &contact->state.variables.vibration;
    return (vibration->V_1 != 0.0 || vibration->a_d != 0.0) && h * vibration->f > 0.5;
}
