// SUNDIALS CVODE: variable-order BDF with the exact 1x1 Jacobian.
//
//     y = delta / L,     y' = a(t) y + V(t) / L,     a = -sigma |V| / g                         (Eq. 2)
//
// L = g / sigma at the stiffest moment of the step, so that an error of y is at least as large as the error
// of F_t / F_C; less where the surfaces move less than that. The step is cut at the reversals of V. CVODE is
// started anew, in a time that begins at 0, on every piece: it never steps over a kink and no history
// outlives a step. The error of y is bounded absolutely: y is large where the contact is soft, and an error
// made there is multiplied when it stiffens. The impulse and the work are Gauss quadratures of sigma delta
// and sigma delta V on the dense output.
#include <stdio.h>

#include "solver/cvode.h"

#ifdef FC_WITH_SUNDIALS

#include <assert.h>
#include <cvode/cvode.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

// CVODE bounds the local error of one step: this fraction of solver.tolerance keeps the sum of them within
// it.
#define LOCAL_ERROR_FRACTION 0.01
// Below this rounding governs: the true error stops following solver.tolerance between 1e-10 and 1e-12.
#define SMALLEST_LOCAL_ERROR 1e-14
#define LARGEST_LOCAL_ERROR 1e-3

#define MOST_PERIODS 1e5      // vibration periods in one communication step: minutes of computing
#define STEPS_PER_PERIOD 8.0  // at least: the vibration can't slip between two steps
#define SHORTEST_PIECE 1e-150 // s; CVODE multiplies two durations, which gives 0 below 1e-162 s
#define MOST_FAILED_TRIES 50  // error test or convergence failures of one step of CVODE

// Five-point Gauss-Legendre on [-1, 1]: exact for the degree 9.
#define GAUSS_POINTS 5
static const double gauss_node[GAUSS_POINTS] = {-0.90617984593866399280, -0.53846931010568309104, 0.0,
                                                0.53846931010568309104, 0.90617984593866399280};
static const double gauss_weight[GAUSS_POINTS] = {0.23692688505618908751, 0.47862867049936646804,
                                                  0.56888888888888888889, 0.47862867049936646804,
                                                  0.23692688505618908751};

struct FcCvode {
    SUNContext context;
    N_Vector y;
    N_Vector dense;
    SUNMatrix matrix;
    SUNLinearSolver linear_solver;
    void* cvode;
    // The piece under way, as the callbacks see it.
    const FcScene* scene;
    double start;       // s, local time at which the piece starts; CVODE's time is 0 there
    double unit;        // s, of CVODE's time: 1 s, or the piece's duration where that is very short
    double L;           // m
    double evaluations; // of a(t), b(t)
    char reason[160];   // CVODE's last error message
};

static FcCoefficients coefficients_at(FcCvode* solver, double tau) {
    solver->evaluations += 1.0;
    return fc_scene_coefficients(solver->scene, solver->start + solver->unit * tau);
}

static int right_hand_side(realtype tau, N_Vector y, N_Vector slope, void* user) {
    FcCvode* solver = user;
    const FcCoefficients at = coefficients_at(solver, tau);
    NV_Ith_S(slope, 0) = solver->unit * (fc_coefficients_rate(&at) * NV_Ith_S(y, 0) + at.V / solver->L);
    return 0;
}

static int jacobian(realtype tau, N_Vector y, N_Vector slope, SUNMatrix J, void* user, N_Vector t1,
                    N_Vector t2, N_Vector t3) {
    (void)y, (void)slope, (void)t1, (void)t2, (void)t3;
    FcCvode* solver = user;
    const FcCoefficients at = coefficients_at(solver, tau);
    SM_ELEMENT_D(J, 0, 0) = solver->unit * fc_coefficients_rate(&at);
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
    solver->y = N_VNew_Serial(1, solver->context);
    solver->dense = N_VNew_Serial(1, solver->context);
    solver->matrix = SUNDenseMatrix(1, 1, solver->context);
    if (!solver->y || !solver->dense || !solver->matrix) {
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
           // A fresh 1x1 Jacobian costs no more than an iteration, and with it one iteration is exact.
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
    if (solver->dense) {
        N_VDestroy(solver->dense);
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
                          solver->start + solver->unit * tau, h, reason);
}

// The deflection's scale over a step of h [s] from delta_0, see the head of this file.
static double deflection_scale(const FcScene* scene, double h, double delta_0) {
    const double saturated = fc_scene_smallest_saturation(scene, h);
    const double moved = fabs(delta_0) + fc_drive_largest_speed(&scene->drive, h) * h;
    const double L = moved > 0.0 ? fmin(saturated, moved) : saturated;
    return isfinite(L) && L > 0.0 ? L : 1.0;
}

// The errors of as many vibration periods as the bristle remembers, a path of L, add up in its deflection.
static double local_error_bound(const FcDrive* drive, double tolerance, double h, double L) {
    const double memory = fmin(h, L / fc_drive_largest_speed(drive, h));
    const double periods = fc_drive_vibrates(drive) ? fmax(1.0, memory * drive->vibration.f) : 1.0;
    return fmin(fmax(LOCAL_ERROR_FRACTION * tolerance / periods, SMALLEST_LOCAL_ERROR), LARGEST_LOCAL_ERROR);
}

// First step on a piece: where its layer of width w, sqrt(2 F_C / (sigma |V'|)) after a reversal and
// F_C / (sigma |V|) elsewhere, lets backward Euler have the asked error.
static double initial_step(FcCvode* solver, double duration, double local_error) {
    const FcCoefficients at = coefficients_at(solver, 0.0);
    const double V_rate = fabs(fc_drive_V_rate(&solver->scene->drive, solver->start));
    const double ramp = at.sigma * V_rate / (2.0 * at.limit);
    const double inverse_width = fmax(fabs(fc_coefficients_rate(&at)), sqrt(ramp));
    return fmin(duration, sqrt(local_error) / fmax(inverse_width, 1.0 / duration));
}

// Integrates from solver->start for duration [s], between two reversals. y is taken from and left in
// solver->y.
static bool integrate_piece(FcCvode* solver, double duration, double local_error, double h, FcStepResult* sum,
                            FcMessage* message) {
    void* cvode = solver->cvode;
    const FcDrive* drive = &solver->scene->drive;
    const double longest =
        fc_drive_vibrates(drive) ? 1.0 / (STEPS_PER_PERIOD * drive->vibration.f) : duration;
    const double unit = duration < SHORTEST_PIECE ? duration : 1.0;
    const double end = duration / unit;
    solver->unit = unit;
    solver->reason[0] = '\0';
    if (CVodeReInit(cvode, 0.0, solver->y) != CV_SUCCESS ||
        CVodeSStolerances(cvode, SMALLEST_LOCAL_ERROR, local_error) != CV_SUCCESS ||
        CVodeSetMaxStep(cvode, longest / unit) != CV_SUCCESS ||
        CVodeSetInitStep(cvode, initial_step(solver, duration, local_error) / unit) != CV_SUCCESS ||
        CVodeSetStopTime(cvode, end) != CV_SUCCESS) {
        return failed(solver, 0.0, h, solver->reason, message);
    }
    double tau = 0.0;
    while (tau < end) {
        if (solver->evaluations > FC_MOST_EVALUATIONS) {
            return failed(solver, tau, h, "too many evaluations in one step", message);
        }
        double tau_next = tau;
        if (CVode(cvode, end, solver->y, &tau_next, CV_ONE_STEP) < 0) {
            return failed(solver, tau, h, solver->reason, message);
        }
        const double half = 0.5 * (tau_next - tau);
        for (int i = 0; i < GAUSS_POINTS; ++i) {
            const double node = tau + half * (1.0 + gauss_node[i]);
            if (CVodeGetDky(cvode, node, 0, solver->dense) != CV_SUCCESS) {
                return failed(solver, node, h, solver->reason, message);
            }
            const FcCoefficients at = coefficients_at(solver, node);
            const double delta = solver->L * NV_Ith_S(solver->dense, 0);
            const double F = at.sigma * delta;
            const double slip = -fc_coefficients_rate(&at) * delta; // V - delta'
            const double weight = unit * half * gauss_weight[i];
            sum->impulse += weight * F;
            sum->work += weight * F * at.V;
            sum->heat += weight * F * slip;
            sum->drag += weight * (at.V - slip) * at.V;
        }
        tau = tau_next;
    }
    return true;
}

bool fc_cvode_step(FcCvode* solver, const FcScene* scene, const FcSolverOptions* options, double h,
                   double delta_0, FcStepResult* result, FcMessage* message) {
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
    solver->L = deflection_scale(scene, h, delta_0);
    const double local_error = local_error_bound(drive, options->tolerance, h, solver->L);
    solver->evaluations = 0.0;
    N_VConst(delta_0 / solver->L, solver->y);

    FcStepResult sum = {.delta = delta_0};
    double t = 0.0;
    while (t < h) {
        const double t_next = fc_drive_next_event(drive, t, h).time;
        solver->start = t;
        if (!(t_next > t)) {
            return failed(solver, 0.0, h, "no next reversal found", message);
        }
        if (!integrate_piece(solver, t_next - t, local_error, h, &sum, message)) {
            return false;
        }
        t = t_next;
    }
    sum.delta = h > 0.0 ? solver->L * NV_Ith_S(solver->y, 0) : delta_0;
    sum.evaluations = solver->evaluations;
    if (!isfinite(sum.delta) || !isfinite(sum.impulse) || !isfinite(sum.work) || !isfinite(sum.heat) ||
        !isfinite(sum.drag)) {
        return failed(solver, 0.0, h, "the deflection, the impulse or the work is not a finite number",
                      message);
    }
    *result = sum;
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
                   double delta_0, FcStepResult* result, FcMessage* message) {
    (void)solver, (void)scene, (void)options, (void)h, (void)delta_0, (void)result;
    return fc_message_set(message, "solver.method = cvode is not in this build");
}

#endif
