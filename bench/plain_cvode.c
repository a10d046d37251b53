// CVODE as a host uses it that knows nothing of the equation: BDF, Newton, its own difference-quotient Jacobian and
// step sizes, no stop at reversals; restarted only when an input of a communication step jumps or bends.
//
//     y = (delta, integral of F_t dt)        rtol as given, atol = rtol times F_C / sigma_ref and F_C H
//
//     plain_cvode < job        see job.h and plain_equation.h
//
// The set-up is not timed, as that of an FMU is not.
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <string.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "plain_equation.h"

static const long MAX_STEPS = 1000000; // of CVODE in a communication step

typedef struct {
    Plain plain;
    SUNContext context;
    N_Vector y;
    N_Vector tolerance; // absolute
    SUNMatrix matrix;
    SUNLinearSolver linear_solver;
    void* integrator;
} Cvode;

static int right_hand_side(realtype t, N_Vector y, N_Vector slope, void* user) {
    const PlainCoefficients at = plain_at(user, t);
    NV_Ith_S(slope, 0) = at.V + at.rate * NV_Ith_S(y, 0);
    NV_Ith_S(slope, 1) = at.sigma * NV_Ith_S(y, 0);
    return 0;
}

static void keep_reason(int code, const char* module, const char* function, char* text, void* user) {
    (void)module, (void)function;
    Plain* plain = user;
    if (code < 0) {
        snprintf(plain->reason, plain->reason_size, "%s", text);
        plain->reason[strcspn(plain->reason, "\n")] = '\0';
    }
}

static int open_solver(Cvode* s, const Job* job, Run* run) {
    *s = (Cvode){.plain = plain_of(job, run)};
    if (SUNContext_Create(NULL, &s->context) != 0) {
        return 0;
    }
    const double* p = s->plain.p;
    s->y = N_VNew_Serial(2, s->context);
    s->tolerance = N_VNew_Serial(2, s->context);
    s->matrix = SUNDenseMatrix(2, 2, s->context);
    s->linear_solver = SUNLinSol_Dense(s->y, s->matrix, s->context);
    s->integrator = CVodeCreate(CV_BDF, s->context);
    if (!s->y || !s->tolerance || !s->matrix || !s->linear_solver || !s->integrator) {
        return 0;
    }
    NV_Ith_S(s->y, 0) = p[PLAIN_DELTA_0];
    NV_Ith_S(s->y, 1) = 0.0;
    NV_Ith_S(s->tolerance, 0) = p[PLAIN_TOLERANCE] * p[PLAIN_F_C] / p[PLAIN_SIGMA_REF];
    NV_Ith_S(s->tolerance, 1) = p[PLAIN_TOLERANCE] * p[PLAIN_F_C] * job->step;
    return CVodeInit(s->integrator, right_hand_side, job->start, s->y) == CV_SUCCESS &&
           CVodeSVtolerances(s->integrator, p[PLAIN_TOLERANCE], s->tolerance) == CV_SUCCESS &&
           CVodeSetUserData(s->integrator, &s->plain) == CV_SUCCESS &&
           CVodeSetErrHandlerFn(s->integrator, keep_reason, &s->plain) == CV_SUCCESS &&
           CVodeSetMaxNumSteps(s->integrator, MAX_STEPS) == CV_SUCCESS &&
           CVodeSetLinearSolver(s->integrator, s->linear_solver, s->matrix) == CVLS_SUCCESS;
}

static void close_solver(Cvode* s) {
    CVodeFree(&s->integrator);
    SUNLinSolFree(s->linear_solver);
    SUNMatDestroy(s->matrix);
    N_VDestroy(s->tolerance);
    N_VDestroy(s->y);
    SUNContext_Free(&s->context);
}

static int step(void* solver, const Job* job, int k, double* row) {
    Cvode* s = solver;
    const double end = job->start + (k + 1) * job->step;
    const double impulse = NV_Ith_S(s->y, 1);
    if (job->inputs > 0) {
        plain_set_inputs(&s->plain, job, k);
        if (CVodeReInit(s->integrator, s->plain.start, s->y) != CV_SUCCESS ||
            CVodeSetStopTime(s->integrator, end) != CV_SUCCESS) {
            return 0;
        }
    }
    double reached = 0.0;
    if (CVode(s->integrator, end, s->y, &reached, CV_NORMAL) < 0) {
        return 0;
    }
    row[0] = plain_at(&s->plain, end).sigma * NV_Ith_S(s->y, 0);
    row[1] = (NV_Ith_S(s->y, 1) - impulse) / job->step;
    return 1;
}

static void run_job(const Job* job, Run* run) {
    Cvode s;
    plain_run(job, run, open_solver(&s, job, run), step, &s);
    run->evaluations = s.plain.evaluations;
    close_solver(&s);
}

int main(void) {
    const Job job = job_read();
    job_measure(&job, run_job);
    return 0;
}
