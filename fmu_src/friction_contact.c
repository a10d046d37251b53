#include "friction_contact.h"

#include <math.h>
#include <stdio.h>

#include "coulomb.h"
#include "dahl.h"

static int fail(Message* message, const char* format, double a, double b, double c) {
    snprintf(message->text, sizeof message->text, format, a, b, c);
    return 0;
}

// The drive of a step from the absolute time start on, the inputs moving at these rates.
static Drive drive_from(const FrictionState* state, double start, const double rate[INPUT_COUNT]) {
    const Variables* v = &state->variables;
    return drive_make((LinearInput){v->V, rate[INPUT_V]}, (LinearInput){v->d, rate[INPUT_D]},
                      (LinearInput){v->E, rate[INPUT_E]}, v->vibration, start);
}

// The problem at the present time, with the rates of the last step or, where they have been set, of the next.
static DahlProblem problem_now(const FrictionState* state) {
    const Drive drive = drive_from(state, state->time, state->next_rate_set ? state->next_rate : state->rate);
    return dahl_problem(&state->variables.contact, &drive, state->variables.F_C);
}

// The separation and the modulus must stay positive and the stiffness a number over the step [0, h].
static int check_drive(const DahlProblem* problem, double h, Message* message) {
    const Drive* drive = &problem->drive;
    const double d = drive_smallest_d(drive, h);
    const double a_d = drive->vibration.a_d;
    if (!(d > 0.0)) {
        return drive->d.rate == 0.0
                   ? fail(message, "vibration.a_d = %.9g m must be below d = %.9g m: the separation d - a_d must stay "
                                   "above 0 m",
                          a_d, drive->d.value, 0.0)
                   : fail(message, "d moves from %.9g m to %.9g m in the step: with vibration.a_d = %.9g m the "
                                   "separation must stay above 0 m",
                          drive->d.value, drive->d.value + drive->d.rate * h, a_d);
    }
    if (!(drive_smallest_E(drive, h) > 0.0)) {
        return fail(message, "E moves from %.9g Pa to %.9g Pa in the step: it must stay above 0 Pa", drive->E.value,
                    drive->E.value + drive->E.rate * h, 0.0);
    }
    const ContactAtModulus stiffest = contact_at_modulus(&problem->contact, drive_largest_E(drive, h));
    if (!isfinite(contact_stiffness(&stiffest, d)) || !isfinite(stiffest.area_0)) {
        return fail(message, "the contact stiffness at d = %.9g m, E = %.9g Pa is beyond the largest number: check d "
                             "and the parameters contact.*",
                    d, drive_largest_E(drive, h), 0.0);
    }
    if (!isfinite(drive_largest_speed(drive, h))) {
        return fail(message, "V moves from %.9g m/s to %.9g m/s in the step: it must stay a finite number",
                    drive->V.value, drive->V.value + drive->V.rate * h, 0.0);
    }
    return 1;
}

int friction_contact_check(const FrictionContact* contact, Message* message) {
    const double held[INPUT_COUNT] = {0};
    const Drive drive = drive_from(&contact->state, contact->state.time, held);
    const DahlProblem problem =
        dahl_problem(&contact->state.variables.contact, &drive, contact->state.variables.F_C);
    return check_drive(&problem, 0.0, message);
}

int friction_contact_initialize(FrictionContact* contact, double start, Message* message) {
    FrictionContact fresh = *contact;
    fresh.state.time = start;
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
        return fail(message, "F_t = sigma delta_0 is beyond the largest number: delta_0 = %.9g m, sigma = %.9g N/m",
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
        return fixed_step_step(problem, (SolverMethod)v->solver.method, &options, h, v->delta, result, message);
    }
}

int friction_contact_advance(FrictionContact* contact, double t, double h, Message* message) {
    const Drive drive = drive_from(&contact->state, t, contact->state.next_rate);
    const DahlProblem problem =
        dahl_problem(&contact->state.variables.contact, &drive, contact->state.variables.F_C);
    if (!(h >= 0.0) || !isfinite(t + h)) {
        return fail(message, "the step from t = %.9g s by h = %.9g s: h must be a finite number of at least 0 s", t, h,
                    0.0);
    }
    if (!drive_is_constant(&drive) && !check_drive(&problem, h, message)) {
        return 0;
    }
    StepResult result;
    if (!step(contact, &problem, h, &result, message)) {
        return 0;
    }

    FrictionState next = contact->state;
    Variables* v = &next.variables;
    next.time = t + h;
    v->V = drive.V.value + drive.V.rate * h;
    v->d = drive.d.value + drive.d.rate * h;
    v->E = drive.E.value + drive.E.rate * h;
    v->delta = result.delta;
    v->W_f += result.work;
    v->solver.evaluations += result.evaluations;
    for (int i = 0; i < INPUT_COUNT; i++) {
        next.rate[i] = next.next_rate[i];
        next.next_rate[i] = 0.0;
    }
    next.next_rate_set = 0;
    FrictionContact after = {.state = next, .cvode = contact->cvode};
    friction_contact_update_outputs(&after);
    v = &after.state.variables;
    v->F_t_mean = h > 0.0 ? result.impulse / h : v->F_t;
    if (!isfinite(v->F_t) || !isfinite(v->F_t_mean) || !isfinite(v->W_f) || !isfinite(v->delta)) {
        return fail(message, "the step by h = %.9g s gives a result beyond the largest number at V = %.9g m/s, "
                             "d = %.9g m",
                    h, drive.V.value, drive.d.value);
    }
    *contact = after;
    return 1;
}

void friction_contact_update_outputs(FrictionContact* contact) {
    Variables* v = &contact->state.variables;
    const DahlProblem problem = problem_now(&contact->state);
    v->sigma = dahl_stiffness(&problem, 0.0);
    v->A_r = contact_area(&problem.at_E, drive_d(&problem.drive, 0.0));
    v->F_t = v->friction.model == FRICTION_COULOMB ? coulomb_force(drive_V(&problem.drive, 0.0), v->F_C)
                                                   : v->sigma * v->delta;
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
    const ContactGradient slope = contact_stiffness_gradient(&v->contact, drive_d(drive, 0.0), drive->E.value);
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
