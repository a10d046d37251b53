#include "friction_contact.h"

#include <math.h>
#include <stdio.h>

#include "coulomb.h"
#include "dahl.h"

static int fail(Message* message, const char* format, double a, double b, double c) {
    snprintf(message->text, sizeof message->text, format, a, b, c);
    return 0;
}

static int fail_stiffness(Message* message, double d, double E) {
    return fail(
        message,
        "the contact stiffness at d = %.9g m, E = %.9g Pa is beyond the largest number: check d and the "
        "parameters contact.*",
        d, E, 0.0);
}

// The drive from the absolute time start + rest on, the inputs moving at these rates.
static Drive drive_from(const FrictionState* state, double start, double rest,
                        const double rate[INPUT_COUNT]) {
    const Variables* v = &state->variables;
    return drive_make((LinearInput){v->V, rate[INPUT_V]}, (LinearInput){v->d, rate[INPUT_D]},
                      (LinearInput){v->E, rate[INPUT_E]}, v->vibration, start, rest);
}

// The problem at the present time, with the rates of the last step or, where they have been set, of the next.
static DahlProblem problem_now(const FrictionState* state) {
    const Drive drive = drive_from(state, state->time, state->time_rest,
                                   state->next_rate_set ? state->next_rate : state->rate);
    return dahl_problem(&state->variables.contact, &drive, state->variables.F_C);
}

// The separation and the modulus must stay positive and the stiffness a number over the step [0, h].
static int check_drive(const DahlProblem* problem, double h, Message* message) {
    const Drive* drive = &problem->drive;
    const double d = drive_smallest_d(drive, h);
    const double a_d = drive->vibration.a_d;
    if (!(d > 0.0)) {
        return drive->d.rate == 0.0
                   ? fail(message,
                          "vibration.a_d = %.9g m must be below d = %.9g m: the separation d - a_d must stay "
                          "above 0 m",
                          a_d, drive->d.value, 0.0)
                   : fail(message,
                          "d moves from %.9g m to %.9g m in the step: with vibration.a_d = %.9g m the "
                          "separation must stay above 0 m",
                          drive->d.value, drive->d.value + drive->d.rate * h, a_d);
    }
    if (!(drive_smallest_E(drive, h) > 0.0)) {
        return fail(message, "E moves from %.9g Pa to %.9g Pa in the step: it must stay above 0 Pa",
                    drive->E.value, drive->E.value + drive->E.rate * h, 0.0);
    }
    if (!isfinite(dahl_largest_stiffness(problem, h)) || !isfinite(problem->at_E.area_0)) {
        return fail_stiffness(message, d, drive_largest_E(drive, h));
    }
    if (!isfinite(drive_largest_speed(drive, h))) {
        return fail(message, "V moves from %.9g m/s to %.9g m/s in the step: it must stay a finite number",
                    drive->V.value, drive->V.value + drive->V.rate * h, 0.0);
    }
    return 1;
}

int friction_contact_check(const FrictionContact* contact, Message* message) {
    const double held[INPUT_COUNT] = {0};
    const Drive drive = drive_from(&contact->state, contact->state.time, contact->state.time_rest, held);
    const DahlProblem problem =
        dahl_problem(&contact->state.variables.contact, &drive, contact->state.variables.F_C);
    return check_drive(&problem, 0.0, message);
}

int friction_contact_initialize(FrictionContact* contact, double start, Message* message) {
    FrictionContact fresh = *contact;
    fresh.state.time = start;
    fresh.state.time_rest = 0.0;
    fresh.state.W_f_rest = 0.0;
    if (!friction_contact_check(&fresh, message)) {
        return 0;
    }
    Variables* v = &fresh.state.variables;
    v->delta = v->friction.model == FRICTION_DAHL ? v->delta_0 : 0.0;
    v->W_f = 0.0;
    v->solver.evaluations = 0.0;
    for (int i = 0; i < INPUT_COUNT; i++) {
        fresh.state.rate[i] = 0.0;
    }
    friction_contact_update_outputs(&fresh);
    v->F_t_mean = v->F_t;
    if (!isfinite(v->F_t)) {
        return fail(message,
                    "F_t = sigma delta_0 is beyond the largest number: delta_0 = %.9g m, sigma = %.9g N/m",
                    v->delta_0, v->sigma, 0.0);
    }
    if (v->solver.method == METHOD_CVODE && fresh.cvode == NULL) {
        fresh.cvode = cvode_solver_new(message);
        if (fresh.cvode == NULL) {
            return 0;
        }
    }
    *contact = fresh;
    return 1;
}

void friction_contact_free(FrictionContact* contact) {
    cvode_solver_free(contact->cvode);
    contact->cvode = NULL;
}

static int step(FrictionContact* contact, const DahlProblem* problem, double h, StepResult* result,
                Message* message) {
    const Variables* v = &contact->state.variables;
    const SolverOptions options = {.tolerance = v->solver.tolerance, .step_size = v->solver.stepSize};
    if (v->friction.model == FRICTION_COULOMB) {
        return coulomb_step(problem, &options, h, v->delta, result, message);
    }
    switch (v->solver.method) {
    case METHOD_COLLOCATION:
        return collocation_step(problem, &options, h, v->delta, result, message);
    case METHOD_CVODE:
        return cvode_solver_step(contact->cvode, problem, &options, h, v->delta, result, message);
    default:
        return fixed_step_step(problem, (SolverMethod)v->solver.method, &options, h, v->delta, result,
                               message);
    }
}

// F_t, Eq. 1, at the deflection delta and the local time t.
static double force(const Variables* v, const DahlProblem* problem, double t, double sigma, double delta) {
    return v->friction.model == FRICTION_COULOMB ? coulomb_force(drive_V(&problem->drive, t), v->F_C)
                                                 : sigma * delta;
}

// What a + b loses in rounding (Knuth's two-sum).
static double rounding_of_sum(double a, double b) {
    const double sum = a + b;
    const double b_part = sum - a;
    return (a - (sum - b_part)) + (b - b_part);
}

int friction_contact_advance(FrictionContact* contact, double t, double h, Message* message) {
    FrictionState* state = &contact->state;
    Variables* v = &state->variables;
    const Drive drive = drive_from(state, t, 0.0, state->next_rate);
    const DahlProblem problem = dahl_problem(&v->contact, &drive, v->F_C);
    if (!(h >= 0.0) || !isfinite(t + h)) {
        return fail(message,
                    "the step from t = %.9g s by h = %.9g s: h must be a finite number of at least 0 s", t, h,
                    0.0);
    }
    if (!drive_is_constant(&drive) && !check_drive(&problem, h, message)) {
        return 0;
    }
    StepResult result;
    if (!step(contact, &problem, h, &result, message)) {
        return 0;
    }

    const ContactState end = dahl_contact_state(&problem, h);
    if (!isfinite(end.sigma) || !isfinite(end.A_r)) {
        return fail_stiffness(message, v->d, v->E);
    }
    const double F_t = force(v, &problem, h, end.sigma, result.delta);
    const double F_t_mean = h > 0.0 ? result.impulse / h : F_t;
    const double work = result.work + state->W_f_rest;
    const double W_f = v->W_f + work;
    if (!isfinite(F_t) || !isfinite(F_t_mean) || !isfinite(W_f) || !isfinite(result.delta)) {
        return fail(message,
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
    for (int i = 0; i < INPUT_COUNT; i++) {
        state->rate[i] = state->next_rate[i];
        state->next_rate[i] = 0.0;
    }
    state->next_rate_set = 0;
    return 1;
}

void friction_contact_update_outputs(FrictionContact* contact) {
    Variables* v = &contact->state.variables;
    const DahlProblem problem = problem_now(&contact->state);
    const ContactState now = dahl_contact_state(&problem, 0.0);
    v->sigma = now.sigma;
    v->A_r = now.A_r;
    v->F_t = force(v, &problem, 0.0, now.sigma, v->delta);
}

double friction_contact_force_rate(const FrictionContact* contact) {
    const Variables* v = &contact->state.variables;
    if (v->friction.model == FRICTION_COULOMB) {
        return 0.0;
    }
    const DahlProblem problem = problem_now(&contact->state);
    const Drive* drive = &problem.drive;
    const double sigma = dahl_stiffness(&problem, 0.0);
    const double V = drive_V(drive, 0.0);
    const ContactGradient slope =
        contact_stiffness_gradient(&v->contact, drive_d(drive, 0.0), drive->E.value);
    const double sigma_rate = slope.by_d * drive_d_rate(drive, 0.0) + slope.by_E * drive->E.rate;
    return sigma * (V - sigma * fabs(V) * v->delta / v->F_C) + sigma_rate * v->delta; // Eq. 1, 2
}

OutputGradient friction_contact_output_gradient(const FrictionContact* contact) {
    const Variables* v = &contact->state.variables;
    const DahlProblem problem = problem_now(&contact->state);
    const double d = drive_d(&problem.drive, 0.0);
    const ContactGradient stiffness = contact_stiffness_gradient(&v->contact, d, v->E);
    const ContactGradient area = contact_area_gradient(&v->contact, d, v->E);
    OutputGradient gradient = {0};
    gradient.sigma[INPUT_D] = stiffness.by_d;
    gradient.sigma[INPUT_E] = stiffness.by_E;
    gradient.A_r[INPUT_D] = area.by_d;
    gradient.A_r[INPUT_E] = area.by_E;
    if (v->friction.model == FRICTION_DAHL) {
        gradient.F_t[INPUT_D] = stiffness.by_d * v->delta;
        gradient.F_t[INPUT_E] = stiffness.by_E * v->delta;
    }
    return gradient;
}

int friction_contact_undersamples(const FrictionContact* contact, double h) {
    const Vibration* vibration = &contact->state.variables.vibration;
    return (vibration->V_1 != 0.0 || vibration->a_d != 0.0) && h * vibration->f > 0.5;
}
