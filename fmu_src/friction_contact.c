#include "friction_contact.h"

#include <math.h>
#include <stddef.h>

#include "solver/collocation.h"
#include "solver/coulomb.h"
#include "solver/cvode.h"
#include "solver/fixed_step.h"

static bool fail_stiffness(FcMessage* message, double d, double E) {
    return fc_message_set(
        message,
        "the contact stiffness at d = %.9g m, E = %.9g Pa is beyond the largest number: check d and the "
        "parameters contact.*",
        d, E);
}

// The drive from the absolute time start + rest on, the inputs moving at these rates.
static FcDrive drive_from(const FcFrictionState* state, double start, double rest,
                          const double rate[FC_INPUT_COUNT]) {
    const FcVariables* v = &state->variables;
    return fc_drive_make((FcLinearInput){v->V, rate[FC_INPUT_V]}, (FcLinearInput){v->d, rate[FC_INPUT_D]},
                         (FcLinearInput){v->E, rate[FC_INPUT_E]}, v->vibration, start, rest);
}

// The scene at the present time, with the rates of the last step or, where they have been set, of the next.
static FcScene scene_now(const FcFrictionState* state) {
    const FcDrive drive = drive_from(state, state->time, state->time_rest,
                                     state->next_rate_set ? state->next_rate : state->rate);
    return fc_scene_make(&state->variables.contact, &drive, state->variables.F_C);
}

// The separation and the modulus must stay positive and the stiffness a number over the step [0, h].
static bool check_drive(const FcScene* scene, double h, FcMessage* message) {
    const FcDrive* drive = &scene->drive;
    const double d = fc_drive_smallest_d(drive, h);
    const double a_d = drive->vibration.a_d;
    if (!(d > 0.0)) {
        return drive->d.rate == 0.0
                   ? fc_message_set(
                         message,
                         "vibration.a_d = %.9g m must be below d = %.9g m: the separation d - a_d must stay "
                         "above 0 m",
                         a_d, drive->d.value)
                   : fc_message_set(
                         message,
                         "d moves from %.9g m to %.9g m in the step: with vibration.a_d = %.9g m the "
                         "separation must stay above 0 m",
                         drive->d.value, drive->d.value + drive->d.rate * h, a_d);
    }
    if (!(fc_drive_smallest_E(drive, h) > 0.0)) {
        return fc_message_set(message, "E moves from %.9g Pa to %.9g Pa in the step: it must stay above 0 Pa",
                              drive->E.value, drive->E.value + drive->E.rate * h);
    }
    if (!isfinite(fc_scene_largest_stiffness(scene, h)) || !isfinite(scene->at_E.area_0)) {
        return fail_stiffness(message, d, fc_drive_largest_E(drive, h));
    }
    if (!isfinite(fc_drive_largest_speed(drive, h))) {
        return fc_message_set(message,
                              "V moves from %.9g m/s to %.9g m/s in the step: it must stay a finite number",
                              drive->V.value, drive->V.value + drive->V.rate * h);
    }
    return true;
}

bool fc_friction_contact_check(const FcFrictionContact* contact, FcMessage* message) {
    const double held[FC_INPUT_COUNT] = {0};
    const FcDrive drive = drive_from(&contact->state, contact->state.time, contact->state.time_rest, held);
    const FcScene scene =
        fc_scene_make(&contact->state.variables.contact, &drive, contact->state.variables.F_C);
    return check_drive(&scene, 0.0, message);
}

bool fc_friction_contact_prepare(FcFrictionContact* contact, int method, FcMessage* message) {
    if (method == FC_METHOD_CVODE && contact->cvode == NULL) {
        contact->cvode = fc_cvode_new(message);
    }
    return method != FC_METHOD_CVODE || contact->cvode != NULL;
}

bool fc_friction_contact_initialize(FcFrictionContact* contact, double start, FcMessage* message) {
    FcFrictionContact fresh = *contact;
    fresh.state.time = start;
    fresh.state.time_rest = 0.0;
    fresh.state.W_f_rest = 0.0;
    if (!fc_friction_contact_check(&fresh, message)) {
        return false;
    }
    FcVariables* v = &fresh.state.variables;
    v->delta = v->friction.model == FC_FRICTION_DAHL ? v->delta_0 : 0.0;
    v->W_f = 0.0;
    v->solver.evaluations = 0.0;
    for (int i = 0; i < FC_INPUT_COUNT; i++) {
        fresh.state.rate[i] = 0.0;
    }
    fc_friction_contact_update_outputs(&fresh);
    v->F_t_mean = v->F_t;
    if (!isfinite(v->F_t)) {
        return fc_message_set(
            message, "F_t = sigma delta_0 is beyond the largest number: delta_0 = %.9g m, sigma = %.9g N/m",
            v->delta_0, v->sigma);
    }
    if (!fc_friction_contact_prepare(&fresh, v->solver.method, message)) {
        return false;
    }
    *contact = fresh;
    return true;
}

void fc_friction_contact_free(FcFrictionContact* contact) {
    fc_cvode_free(contact->cvode);
    contact->cvode = NULL;
}

// Applies the periods of the vibration, or the whole step, to the method.
static bool step(FcFrictionContact* contact, const FcScene* scene, double h, FcStepResult* result,
                 FcMessage* message) {
    const FcVariables* v = &contact->state.variables;
    const FcSolverOptions options = {.tolerance = v->solver.tolerance, .step_size = v->solver.stepSize};
    if (v->friction.model == FC_FRICTION_COULOMB) {
        return fc_periods_step(fc_coulomb_interval, scene, &options, h, v->delta, result, message);
    }
    switch (v->solver.method) {
    case FC_METHOD_COLLOCATION:
        if (fc_drive_is_constant(&scene->drive)) {
            fc_collocation_constant(scene, h, v->delta, result);
            return true;
        }
        return fc_periods_step(fc_collocation_interval, scene, &options, h, v->delta, result, message);
    case FC_METHOD_CVODE:
        return fc_cvode_step(contact->cvode, scene, &options, h, v->delta, result, message);
    default:
        return fc_fixed_step(scene, (FcMethod)v->solver.method, &options, h, v->delta, result, message);
    }
}

// F_t, Eq. 1, at the deflection delta and the local time t.
static double force(const FcVariables* v, const FcScene* scene, double t, double sigma, double delta) {
    return v->friction.model == FC_FRICTION_COULOMB ? fc_coulomb_force(fc_drive_V(&scene->drive, t), v->F_C)
                                                    : sigma * delta;
}

// What a + b loses in rounding (Knuth's two-sum).
static double rounding_of_sum(double a, double b) {
    const double sum = a + b;
    const double b_part = sum - a;
    return (a - (sum - b_part)) + (b - b_part);
}

bool fc_friction_contact_advance(FcFrictionContact* contact, double t, double h, FcMessage* message) {
    FcFrictionState* state = &contact->state;
    FcVariables* v = &state->variables;
    const FcDrive drive = drive_from(state, t, 0.0, state->next_rate);
    const FcScene scene = fc_scene_make(&v->contact, &drive, v->F_C);
    if (!(h >= 0.0) || !isfinite(t + h)) {
        return fc_message_set(
            message, "the step from t = %.9g s by h = %.9g s: h must be a finite number of at least 0 s", t,
            h);
    }
    if (!fc_drive_is_constant(&drive) && !check_drive(&scene, h, message)) {
        return false;
    }
    FcStepResult result;
    if (!step(contact, &scene, h, &result, message)) {
        return false;
    }

    const FcContactResponse end = fc_scene_contact(&scene, h);
    if (!isfinite(end.sigma) || !isfinite(end.A_r)) {
        return fail_stiffness(message, v->d, v->E);
    }
    const double F_t = force(v, &scene, h, end.sigma, result.delta);
    const double F_t_mean = h > 0.0 ? result.impulse / h : F_t;
    const double work = result.work + state->W_f_rest;
    const double W_f = v->W_f + work;
    if (!isfinite(F_t) || !isfinite(F_t_mean) || !isfinite(W_f) || !isfinite(result.delta)) {
        return fc_message_set(
            message,
            "the step by h = %.9g s gives a result beyond the largest number at V = %.9g m/s, "
            "d = %.9g m",
            h, v->V, v->d);
    }
    state->time = t + h;
    state->time_rest = rounding_of_sum(t, h);
    state->W_f_rest = rounding_of_sum(v->W_f, work);
    v->V += drive.V.rate * h;
    v->d += drive.d.rate * h;
    v->E += drive.E.rate * h;
    v->F_t = F_t;
    v->F_t_mean = F_t_mean;
    v->W_f = W_f;
    v->sigma = end.sigma;
    v->A_r = end.A_r;
    v->delta = result.delta;
    v->solver.evaluations += result.evaluations;
    for (int i = 0; i < FC_INPUT_COUNT; i++) {
        state->rate[i] = state->next_rate[i];
        state->next_rate[i] = 0.0;
    }
    state->next_rate_set = 0;
    return true;
}

void fc_friction_contact_update_outputs(FcFrictionContact* contact) {
    FcVariables* v = &contact->state.variables;
    const FcScene scene = scene_now(&contact->state);
    const FcContactResponse now = fc_scene_contact(&scene, 0.0);
    v->sigma = now.sigma;
    v->A_r = now.A_r;
    v->F_t = force(v, &scene, 0.0, now.sigma, v->delta);
}

double fc_friction_contact_force_rate(const FcFrictionContact* contact) {
    const FcVariables* v = &contact->state.variables;
    if (v->friction.model == FC_FRICTION_COULOMB) {
        return 0.0;
    }
    const FcScene scene = scene_now(&contact->state);
    const FcDrive* drive = &scene.drive;
    const double sigma = fc_scene_stiffness(&scene, 0.0);
    const double V = fc_drive_V(drive, 0.0);
    const FcContactGradient slope =
        fc_contact_stiffness_gradient(&v->contact, fc_drive_d(drive, 0.0), drive->E.value);
    const double sigma_rate = slope.by_d * fc_drive_d_rate(drive, 0.0) + slope.by_E * drive->E.rate;
    return sigma * (V - sigma * fabs(V) * v->delta / v->F_C) + sigma_rate * v->delta; // Eq. 1, 2
}

FcOutputGradient fc_friction_contact_output_gradient(const FcFrictionContact* contact) {
    const FcVariables* v = &contact->state.variables;
    const FcScene scene = scene_now(&contact->state);
    const double d = fc_drive_d(&scene.drive, 0.0);
    const FcContactGradient stiffness = fc_contact_stiffness_gradient(&v->contact, d, v->E);
    const FcContactGradient area = fc_contact_area_gradient(&v->contact, d, v->E);
    FcOutputGradient gradient = {0};
    gradient.sigma[FC_INPUT_D] = stiffness.by_d;
    gradient.sigma[FC_INPUT_E] = stiffness.by_E;
    gradient.A_r[FC_INPUT_D] = area.by_d;
    gradient.A_r[FC_INPUT_E] = area.by_E;
    if (v->friction.model == FC_FRICTION_DAHL) {
        gradient.F_t[FC_INPUT_D] = stiffness.by_d * v->delta;
        gradient.F_t[FC_INPUT_E] = stiffness.by_E * v->delta;
    }
    return gradient;
}

bool fc_friction_contact_undersamples(const FcFrictionContact* contact, double h) {
    const FcVibration* vibration = &contact->state.variables.vibration;
    return (vibration->V_1 != 0.0 || vibration->a_d != 0.0) && h * vibration->f > 0.5;
}
