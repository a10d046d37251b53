// SUNDIALS CVODE: variable-order BDF with the exact 1x1 Jacobian.
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
// Impulse, work, heat and drag are quadratures on the dense output. sigma, V or delta^2 may be less smooth
// than delta. So a step of CVODE is halved until two rules agree, at no cost to CVODE.
#include <stdio.h>

#include "solver/methods/methods.h"

#ifdef FC_WITH_SUNDIALS

#include <assert.h>
#include <cvode/cvode.h>
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

// Lobatto's rule with four nodes on [-1, 1], exact for the degree 5, which is that of CVODE's dense output,
// and its Kronrod extension with seven, exact for the degree 9: W. Gander, W. Gautschi, BIT 40 (2000) 84. The
// result is the latter. Their difference may be this fraction of solver.tolerance, in each quadrature of a
// piece.
#define QUADRATURE_FRACTION 0.1
#define QUADRATURE_ROUNDING 1e-13 // 450 eps, of the integral of the magnitude: a smaller one is rounding
#define MOST_STEP_HALVINGS 40     // of a step of CVODE, to 1e-12 of it
enum { KRONROD_NODES = 7 };
static const double node_at[KRONROD_NODES] = {-1.0, -0.81649658092772603273, -0.44721359549995793928,
                                              0.0,  0.44721359549995793928,  0.81649658092772603273,
                                              1.0};
static const double lobatto[KRONROD_NODES] = {1.0 / 6.0, 0.0, 5.0 / 6.0, 0.0, 5.0 / 6.0, 0.0, 1.0 / 6.0};
static const double kronrod[KRONROD_NODES] = {11.0 / 210.0,  72.0 / 245.0, 125.0 / 294.0, 16.0 / 35.0,
                                              125.0 / 294.0, 72.0 / 245.0, 11.0 / 210.0};

// The integrals beside the deflection; see FcStepResult.
enum { IMPULSE, WORK, HEAT, DRAG, INTEGRALS };
typedef struct {
    double of[INTEGRALS];
} Integrals;

struct FcCvode {
    SUNContext context;
    N_Vector y;
    N_Vector dense;
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
    Integrals allowed; // difference of the two rules
    Integrals sum;     // over the step so far
    char reason[160];  // CVODE's last error message
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

static double deflection(const FcCvode* solver, double y) { return solver->L * y; }

static int right_hand_side(realtype tau, N_Vector y, N_Vector slope, void* user) {
    FcCvode* solver = user;
    const FcCoefficients at = coefficients_at(solver, tau);
    const double delta = deflection(solver, NV_Ith_S(y, 0));
    NV_Ith_S(slope, 0) = (at.V - fc_relaxation_rate(&at) * delta) / solver->L;
    return 0;
}

static int jacobian(realtype tau, N_Vector y, N_Vector slope, SUNMatrix J, void* user, N_Vector t1,
                    N_Vector t2, N_Vector t3) {
    (void)y, (void)slope, (void)t1, (void)t2, (void)t3;
    FcCvode* solver = user;
    const FcCoefficients at = coefficients_at(solver, tau);
    SM_ELEMENT_D(J, 0, 0) = -fc_relaxation_rate(&at);
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

// The allowed difference of the two rules on the piece: a part of the tolerance, times the integrals of a
// force of the size of the tolerance's scale. |delta'| is at most about |V| whenever it counts.
static Integrals allowed_difference(const FcScene* scene, double start, double duration, double h,
                                    const FcSolverOptions* options) {
    const double path = fabs(fc_drive_displacement(&scene->drive, start, start + duration));
    const double share = QUADRATURE_FRACTION * fmax(options->tolerance, QUADRATURE_ROUNDING);
    const double force = share * options->force;
    return (Integrals){{force * duration, force * path, force * path,
                        share * path * fc_drive_largest_speed(&scene->drive, h)}};
}

// The integrands at CVODE's time tau, for the scaled deflection y.
static Integrals integrands(FcCvode* solver, double tau, double y) {
    const FcCoefficients at = coefficients_at(solver, tau);
    const double delta = deflection(solver, y);
    const double F = at.sigma * delta;
    const double slip = fc_relaxation_rate(&at) * delta; // V - delta'
    return (Integrals){{F, F * at.V, F * slip, (at.V - slip) * at.V}};
}

// Adds the integrals over [tau, tau_end], within CVODE's last step, given the integrands at both ends. False
// if CVODE has no dense output there.
// NOLINTNEXTLINE(misc-no-recursion): MOST_STEP_HALVINGS deep
static bool add_integrals(FcCvode* solver, double tau, double tau_end, Integrals first, Integrals last,
                          int halvings) {
    const double half = 0.5 * (tau_end - tau);
    Integrals at[KRONROD_NODES] = {[0] = first, [KRONROD_NODES - 1] = last};
    for (int i = 1; i < KRONROD_NODES - 1; ++i) {
        const double node = tau + half * (1.0 + node_at[i]);
        if (CVodeGetDky(solver->cvode, node, 0, solver->dense) != CV_SUCCESS) {
            return false;
        }
        at[i] = integrands(solver, node, NV_Ith_S(solver->dense, 0));
    }
    Integrals sum = {{0.0}};
    bool agree = true;
    for (int k = 0; k < INTEGRALS; ++k) {
        double difference = 0.0;
        double size = 0.0;
        for (int i = 0; i < KRONROD_NODES; ++i) {
            sum.of[k] += half * kronrod[i] * at[i].of[k];
            difference += half * (kronrod[i] - lobatto[i]) * at[i].of[k];
            size += half * kronrod[i] * fabs(at[i].of[k]);
        }
        agree = agree && !(fabs(difference) > fmax(solver->allowed.of[k], QUADRATURE_ROUNDING * size));
    }
    if (!agree && halvings < MOST_STEP_HALVINGS && solver->evaluations <= FC_MOST_EVALUATIONS) {
        const Integrals middle = at[KRONROD_NODES / 2];
        return add_integrals(solver, tau, tau + half, first, middle, halvings + 1) &&
               add_integrals(solver, tau + half, tau_end, middle, last, halvings + 1);
    }
    for (int k = 0; k < INTEGRALS; ++k) {
        solver->sum.of[k] += sum.of[k];
    }
    return true;
}

// Integrates from solver->start for duration [s], between two reversals. y is taken from and left in
// solver->y.
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
        CVodeSStolerances(cvode, SMALLEST_LOCAL_ERROR, local_error) != CV_SUCCESS ||
        CVodeSetMaxStep(cvode, longest) != CV_SUCCESS ||
        CVodeSetInitStep(cvode, initial_step(solver, duration, local_error)) != CV_SUCCESS) {
        return failed(solver, 0.0, h, solver->reason, message);
    }
    double tau = 0.0;
    Integrals now = integrands(solver, tau, NV_Ith_S(solver->y, 0));
    while (tau < end) {
        double tau_next = tau;
        const double step = stribeck_step(solver->scene, solver->start + tau);
        const double stop = tau + fmax(step, SHORTEST_STRIBECK_STEP * end);
        if (CVodeSetStopTime(cvode, fmin(stop, end)) != CV_SUCCESS ||
            CVode(cvode, end, solver->y, &tau_next, CV_ONE_STEP) < 0) {
            return failed(solver, tau, h, solver->reason, message);
        }
        const Integrals next = integrands(solver, tau_next, NV_Ith_S(solver->y, 0));
        if (!add_integrals(solver, tau, tau_next, now, next, 0)) {
            return failed(solver, tau, h, solver->reason, message);
        }
        if (solver->evaluations > FC_MOST_EVALUATIONS) {
            return failed(solver, tau, h, "too many evaluations in one step", message);
        }
        now = next;
        tau = tau_next;
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
    solver->evaluations = 0.0;
    N_VConst(result->delta / solver->L, solver->y);

    solver->sum = (Integrals){{0.0}};
    double t = 0.0;
    while (t < h) {
        const double t_next = fc_drive_next_event(drive, t, h).time;
        solver->start = t;
        if (!(t_next > t)) {
            return failed(solver, 0.0, h, "no next reversal found", message);
        }
        solver->allowed = allowed_difference(scene, t, t_next - t, h, options);
        if (!integrate_piece(solver, t_next - t, local_error, h, message)) {
            return false;
        }
        t = t_next;
    }
    const double delta = deflection(solver, NV_Ith_S(solver->y, 0));
    const Integrals* sum = &solver->sum;
    if (!isfinite(delta) || !isfinite(sum->of[IMPULSE]) || !isfinite(sum->of[WORK]) ||
        !isfinite(sum->of[HEAT]) || !isfinite(sum->of[DRAG])) {
        return failed(solver, 0.0, h, "the deflection, the impulse or the work is not a finite number",
                      message);
    }
    result->delta = delta;
    result->impulse += sum->of[IMPULSE];
    result->work += sum->of[WORK];
    result->heat += sum->of[HEAT];
    result->drag += sum->of[DRAG];
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
