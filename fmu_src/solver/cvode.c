// SUNDIALS CVODE: variable-order BDF with the exact Jacobian.
//
//     y = delta / L,     y' = (a(t) delta + V(t)) / L,     a = -sigma |V| / g          (Eq. 2)
//
// L is g / sigma at the stiffest moment of the step, so that an error of y is at least as large as the error
// of F_t / F_C. L is smaller if the surfaces move less than g / sigma. The step is cut at the reversals of V.
// CVODE is started anew on every piece, in a time that begins at 0: it never steps over a kink, and no
// history outlives a step. The error of y has an absolute bound, because y is large in a soft contact, and an
// error made there is multiplied when the contact stiffens. A Stribeck curve is a bump of g around V = 0:
// steps shrink with |V| so that none passes it unseen.
//
// Impulse, work, heat and drag are states besides. Each has its own scale, so that all errors are bounded
// alike.
#include <stdio.h>

#include "solver/methods.h"

// FC_NO_CVODE leaves it out of any build: SUNDIALS takes memory from the heap, which some targets do not have.
#if defined(FC_WITH_SUNDIALS) && !defined(FC_NO_CVODE)

#include <assert.h>
#include <cvode/cvode.h>
#include <float.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

// All are chosen empirically but for the rules of quadrature: half of a fraction costs steps, twice of it
// doubles the error that passes (tests/solver/test_cvode.py). CVODE bounds the local error of one step. This
// fraction of solver.tolerance keeps the sum of the errors within it.
#define LOCAL_ERROR_FRACTION 0.01
// Below the smallest, 45 eps, rounding limits the accuracy: the true error stops following solver.tolerance
// between 1e-10 and 1e-12. Above the largest an error is not small beside the force.
#define SMALLEST_LOCAL_ERROR 1e-14
#define LARGEST_LOCAL_ERROR 1e-3

#define MOST_PERIODS 1e5     // vibration periods in one communication step: minutes of computing
#define STEPS_PER_PERIOD 8.0 // at least: the vibration can't slip between two steps
#define MOST_FAILED_TRIES 50 // error test or convergence failures of one step of CVODE

// A Stribeck curve falls from its peak within some V_S. In a step V moves by at most half of |V|, so that
// steps approach the peak geometrically, and on the peak by this fraction of V_S.
#define STRIBECK_STEP 0.25
#define SHORTEST_STRIBECK_STEP 1e-10 // of the piece: a peak that takes less time is not resolved

// The states: y, and the integrals of FcStepResult.
enum { DEFLECTION, IMPULSE, WORK, HEAT, DRAG, STATES };

struct FcCvode {
    SUNContext context;
    N_Vector y;
    N_Vector allowed; // local errors
    SUNMatrix matrix;
    SUNLinearSolver linear_solver;
    void* cvode;
    // The present piece, for the callbacks.
    const FcScene* scene;
    double start;       // s, local time at which the piece starts; CVODE's time is 0 there
    double L;           // m
    double evaluations; // of a(t), b(t)
    double last_tau;    // of the last evaluation on this piece; NaN before the first
    FcCoefficients last;
    char reason[160]; // CVODE's last error message
};

// CVODE asks for the right-hand side and for its Jacobian at the same time, one after the other.
static FcCoefficients coefficients_at(FcCvode* solver, double tau) {
    if (tau != solver->last_tau) {
        solver->evaluations += 1.0;
        solver->last_tau = tau;
        solver->last = fc_scene_coefficients(solver->scene, solver->start + tau);
    }
    return solver->last;
}

static int right_hand_side(realtype tau, N_Vector y, N_Vector slope, void* user) {
    FcCvode* solver = user;
    const FcCoefficients at = coefficients_at(solver, tau);
    const double delta = solver->L * NV_Ith_S(y, DEFLECTION);
    const double F = at.sigma * delta;
    const double slip = fc_relaxation_rate(&at) * delta; // V - delta'
    NV_Ith_S(slope, DEFLECTION) = (at.V - slip) / solver->L;
    NV_Ith_S(slope, IMPULSE) = F;
    NV_Ith_S(slope, WORK) = F * at.V;
    NV_Ith_S(slope, HEAT) = F * slip;
    NV_Ith_S(slope, DRAG) = (at.V - slip) * at.V;
    return 0;
}

// Only the deflection acts on the rates.
static int jacobian(realtype tau, N_Vector y, N_Vector slope, SUNMatrix J, void* user, N_Vector t1,
                    N_Vector t2, N_Vector t3) {
    (void)slope, (void)t1, (void)t2, (void)t3;
    FcCvode* solver = user;
    const FcCoefficients at = coefficients_at(solver, tau);
    const double r = fc_relaxation_rate(&at);
    const double F_rate = at.sigma * solver->L; // of F over y
    SM_ELEMENT_D(J, DEFLECTION, DEFLECTION) = -r;
    SM_ELEMENT_D(J, IMPULSE, DEFLECTION) = F_rate;
    SM_ELEMENT_D(J, WORK, DEFLECTION) = F_rate * at.V;
    SM_ELEMENT_D(J, HEAT, DEFLECTION) = 2.0 * F_rate * r * solver->L * NV_Ith_S(y, DEFLECTION);
    SM_ELEMENT_D(J, DRAG, DEFLECTION) = -r * solver->L * at.V;
    return 0;
}

static void keep_reason(int code, const char* module, const char* function, char* text, void* user) {
    (void)module, (void)function;
    FcCvode* solver = user;
    if (code < 0) {
        snprintf(solver->reason, sizeof solver->reason, "%s", text);
    }
}

static bool set_up(FcCvode* solver) {
    if (SUNContext_Create(NULL, &solver->context) != 0) {
        return false;
    }
    solver->y = N_VNew_Serial(STATES, solver->context);
    solver->allowed = N_VNew_Serial(STATES, solver->context);
    solver->matrix = SUNDenseMatrix(STATES, STATES, solver->context);
    if (!solver->y || !solver->allowed || !solver->matrix) {
        return false;
    }
    solver->linear_solver = SUNLinSol_Dense(solver->y, solver->matrix, solver->context);
    solver->cvode = CVodeCreate(CV_BDF, solver->context);
    if (!solver->linear_solver || !solver->cvode) {
        return false;
    }
    N_VConst(0.0, solver->y);
    void* cvode = solver->cvode;
    return CVodeSetErrHandlerFn(cvode, keep_reason, solver) == CV_SUCCESS &&
           CVodeInit(cvode, right_hand_side, 0.0, solver->y) == CV_SUCCESS &&
           CVodeSetUserData(cvode, solver) == CV_SUCCESS &&
           CVodeSetLinearSolver(cvode, solver->linear_solver, solver->matrix) == CVLS_SUCCESS &&
           CVodeSetJacFn(cvode, jacobian) == CVLS_SUCCESS &&
           // A fresh Jacobian costs no more than an iteration.
           CVodeSetLSetupFrequency(cvode, 1) == CV_SUCCESS &&
           CVodeSetJacEvalFrequency(cvode, 1) == CVLS_SUCCESS &&
           CVodeSetMaxErrTestFails(cvode, MOST_FAILED_TRIES) == CV_SUCCESS &&
           CVodeSetMaxConvFails(cvode, MOST_FAILED_TRIES) == CV_SUCCESS &&
           CVodeSetMaxHnilWarns(cvode, -1) == CV_SUCCESS;
}

FcCvode* fc_cvode_new(FcMessage* message) {
    FcCvode* solver = calloc(1, sizeof *solver);
    if (solver && set_up(solver)) {
        return solver;
    }
    fc_cvode_free(solver);
    fc_message_set(message, "solver.method = cvode: no memory for CVODE");
    return NULL;
}

void fc_cvode_free(FcCvode* solver) {
    if (!solver) {
        return;
    }
    CVodeFree(&solver->cvode);
    if (solver->linear_solver) {
        SUNLinSolFree(solver->linear_solver);
    }
    if (solver->matrix) {
        SUNMatDestroy(solver->matrix);
    }
    if (solver->allowed) {
        N_VDestroy(solver->allowed);
    }
    if (solver->y) {
        N_VDestroy(solver->y);
    }
    SUNContext_Free(&solver->context);
    free(solver);
}

static bool failed(const FcCvode* solver, double tau, double h, const char* reason, FcMessage* message) {
    return fc_message_set(message,
                          "solver.method = cvode failed %.9g s into the communication step of %.5g s: %s",
                          solver->start + tau, h, reason);
}

// The deflection's scale over a step of h [s] from delta_0, see the head of this file.
static double deflection_scale(const FcScene* scene, double h, double delta_0) {
    const double saturated = fc_scene_smallest_saturation(scene, h);
    const double moved = fabs(delta_0) + fc_drive_largest_speed(&scene->drive, h) * h;
    const double L = moved > 0.0 ? fmin(saturated, moved) : saturated;
    return isfinite(L) && L > 0.0 ? L : 1.0;
}

// The errors of as many vibration periods as the bristle remembers, a path of L, add up in its deflection.
static double local_error_bound(const FcScene* scene, double tolerance, double h, double L) {
    const FcDrive* drive = &scene->drive;
    const double memory = fmin(h, L / fc_drive_largest_speed(drive, h));
    const double periods = fc_drive_vibrates(drive) ? fmax(1.0, memory * drive->vibration.f) : 1.0;
    const double local_error = LOCAL_ERROR_FRACTION * tolerance / periods;
    return fmin(fmax(local_error, SMALLEST_LOCAL_ERROR), LARGEST_LOCAL_ERROR);
}

// First step on a piece: backward Euler has the required error with it in the layer of width w, which is
// sqrt(2 F_C / (sigma |V'|)) after a reversal and F_C / (sigma |V|) elsewhere.
static double initial_step(FcCvode* solver, double duration, double local_error) {
    const FcCoefficients at = coefficients_at(solver, 0.0);
    const double V_rate = fabs(fc_drive_V_rate(&solver->scene->drive, solver->start));
    const double ramp = at.sigma * V_rate / (2.0 * at.limit);
    const double inverse_width = fmax(fc_relaxation_rate(&at), sqrt(ramp));
    return fmin(duration, sqrt(local_error) / fmax(inverse_width, 1.0 / duration));
}

// Longest step [s] from the time t [s] that can't go over the peak of a Stribeck curve; INFINITY without one.
static double stribeck_step(const FcScene* scene, double t) {
    if (!fc_has_stribeck_curve(scene->friction)) {
        return INFINITY;
    }
    const FcDrive* drive = &scene->drive;
    const double V_rate = fabs(drive->V.rate) + drive->omega * fabs(drive->vibration.V_1); // at most
    const double change = fmax(STRIBECK_STEP * scene->friction->V_S, 0.5 * fabs(fc_drive_V(drive, t)));
    return V_rate > 0.0 ? change / V_rate : INFINITY;
}

// The allowed local errors of the states over a step of h [s]: that of y, times the integrals of a force of
// the size of the tolerance's scale. |delta'| is at most about |V| whenever it counts.
static void set_allowed(FcCvode* solver, const FcScene* scene, const FcSolverOptions* options, double h,
                        double local_error) {
    const double speed = fc_drive_largest_speed(&scene->drive, h);
    const double force = local_error * options->force;
    const double of[STATES] = {[DEFLECTION] = local_error,
                               [IMPULSE] = force * h,
                               [WORK] = force * speed * h,
                               [HEAT] = force * speed * h,
                               [DRAG] = local_error * speed * speed * h};
    for (int k = 0; k < STATES; k++) {
        NV_Ith_S(solver->allowed, k) = fmax(of[k], DBL_MIN); // CVODE refuses 0
    }
}

// Integrates solver->y from solver->start for duration [s], between two reversals.
static bool integrate_piece(FcCvode* solver, double duration, double local_error, double h,
                            FcMessage* message) {
    void* cvode = solver->cvode;
    const FcDrive* drive = &solver->scene->drive;
    const double longest =
        fc_drive_vibrates(drive) ? 1.0 / (STEPS_PER_PERIOD * drive->vibration.f) : duration;
    const double end = duration;
    solver->last_tau = NAN;
    solver->reason[0] = '\0';
    if (CVodeReInit(cvode, 0.0, solver->y) != CV_SUCCESS ||
        CVodeSVtolerances(cvode, SMALLEST_LOCAL_ERROR, solver->allowed) != CV_SUCCESS ||
        CVodeSetMaxStep(cvode, longest) != CV_SUCCESS ||
        CVodeSetInitStep(cvode, initial_step(solver, duration, local_error)) != CV_SUCCESS) {
        return failed(solver, 0.0, h, solver->reason, message);
    }
    double tau = 0.0;
    while (tau < end) {
        const double step = stribeck_step(solver->scene, solver->start + tau);
        const double stop = tau + fmax(step, SHORTEST_STRIBECK_STEP * end);
        if (CVodeSetStopTime(cvode, fmin(stop, end)) != CV_SUCCESS ||
            CVode(cvode, end, solver->y, &tau, CV_ONE_STEP) < 0) {
            return failed(solver, tau, h, solver->reason, message);
        }
        if (solver->evaluations > FC_MOST_EVALUATIONS) {
            return failed(solver, tau, h, "too many evaluations in one step", message);
        }
    }
    return true;
}

bool fc_cvode_step(FcCvode* solver, const FcScene* scene, const FcSolverOptions* options, double h,
                   FcStepResult* result, FcMessage* message) {
    assert(solver && h >= 0.0 && options->tolerance > 0.0);
    const FcDrive* drive = &scene->drive;
    const double periods = fc_drive_vibrates(drive) ? h * drive->vibration.f : 0.0;
    if (!(periods <= MOST_PERIODS)) {
        fc_message_set(
            message,
            "solver.method = cvode: the communication step of %.5g s holds %.5g periods of vibration.f "
            "= %.5g Hz; "
            "at most %.0e are allowed; use smaller steps or collocation",
            h, periods, drive->vibration.f, MOST_PERIODS);
        return false;
    }
    solver->scene = scene;
    solver->L = deflection_scale(scene, h, result->delta);
    const double local_error = local_error_bound(scene, options->tolerance, h, solver->L);
    set_allowed(solver, scene, options, h, local_error);
    solver->evaluations = 0.0;
    N_VConst(0.0, solver->y);
    NV_Ith_S(solver->y, DEFLECTION) = result->delta / solver->L;

    double t = 0.0;
    while (t < h) {
        const double t_next = fc_drive_next_event(drive, t, h).time;
        solver->start = t;
        if (!(t_next > t)) {
            return failed(solver, 0.0, h, "no next reversal found", message);
        }
        if (!integrate_piece(solver, t_next - t, local_error, h, message)) {
            return false;
        }
        t = t_next;
    }
    const double* y = NV_DATA_S(solver->y);
    for (int k = 0; k < STATES; k++) {
        if (!isfinite(y[k])) {
            return failed(solver, 0.0, h, "the deflection, the impulse or the work is not a finite number",
                          message);
        }
    }
    result->delta = solver->L * y[DEFLECTION];
    result->impulse += y[IMPULSE];
    result->work += y[WORK];
    result->heat += y[HEAT];
    result->drag += y[DRAG];
    result->evaluations += solver->evaluations;
    return true;
}

#else

FcCvode* fc_cvode_new(FcMessage* message) {
    fc_message_set(message,
                   "solver.method = cvode is not in this build (built without SUNDIALS); rebuild with "
                   "-DWITH_SUNDIALS=ON "
                   "or use collocation");
    return NULL;
}

void fc_cvode_free(FcCvode* solver) { (void)solver; }

bool fc_cvode_step(FcCvode* solver, const FcScene* scene, const FcSolverOptions* options, double h,
                   FcStepResult* result, FcMessage* message) {
    (void)solver, (void)scene, (void)options, (void)h, (void)result;
    return fc_message_set(message, "solver.method = cvode is not in this build");
}

#endif
