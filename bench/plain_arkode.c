// ARKODE as a host uses it that knows when V turns: it stops at reversals, and needs no new start there.
//
//     plain_arkode implicit < job      ESDIRK of order 5 with the exact Jacobian
//     plain_arkode explicit < job      Runge-Kutta of order 8
//
// See job.h, plain_equation.h and plain_sundials.h. The set-up is not timed, as that of an FMU is not.
#include <arkode/arkode_arkstep.h>
#include <string.h>

#include "plain_sundials.h"

enum { IMPLICIT_ORDER = 5, EXPLICIT_ORDER = 8 };
static const long MOST_STEPS = 1000000; // of ARKODE between two reversals
static int is_explicit = 0;

static int jacobian(realtype t, N_Vector y, N_Vector slope, SUNMatrix J, void* user, N_Vector t1, N_Vector t2,
                    N_Vector t3) {
    (void)y, (void)slope, (void)t1, (void)t2, (void)t3;
    const PlainCoefficients at = plain_at(user, t);
    SM_ELEMENT_D(J, 0, 0) = at.rate;
    SM_ELEMENT_D(J, 1, 0) = at.sigma;
    SM_ELEMENT_D(J, 0, 1) = 0.0;
    SM_ELEMENT_D(J, 1, 1) = 0.0;
    return 0;
}

static int open_solver(PlainSolver* s, const Job* job, Run* run) {
    if (!plain_solver_open(s, job, run)) {
        return 0;
    }
    s->integrator = ARKStepCreate(is_explicit ? plain_right_hand_side : NULL,
                                  is_explicit ? NULL : plain_right_hand_side, job->start, s->y, s->context);
    if (!s->integrator ||
        ARKStepSVtolerances(s->integrator, s->plain.p[PLAIN_TOLERANCE], s->tolerance) != ARK_SUCCESS ||
        ARKStepSetUserData(s->integrator, &s->plain) != ARK_SUCCESS ||
        ARKStepSetErrHandlerFn(s->integrator, plain_keep_reason, &s->plain) != ARK_SUCCESS ||
        ARKStepSetMaxNumSteps(s->integrator, MOST_STEPS) != ARK_SUCCESS ||
        ARKStepSetOrder(s->integrator, is_explicit ? EXPLICIT_ORDER : IMPLICIT_ORDER) != ARK_SUCCESS) {
        return 0;
    }
    return is_explicit ||
           (ARKStepSetLinearSolver(s->integrator, s->linear_solver, s->matrix) == ARKLS_SUCCESS &&
            ARKStepSetJacFn(s->integrator, jacobian) == ARKLS_SUCCESS &&
            ARKStepSetLinear(s->integrator, 1) == ARK_SUCCESS &&
            ARKStepSetDeduceImplicitRhs(s->integrator, 1) == ARK_SUCCESS);
}

static int step(void* solver, const Job* job, int k, double* row) {
    PlainSolver* s = solver;
    const double end = job->start + (k + 1) * job->step;
    const double impulse = NV_Ith_S(s->y, 1);
    double t = job->start + k * job->step;
    if (job->inputs > 0) {
        plain_set_inputs(&s->plain, job, k);
        if (ARKStepReset(s->integrator, t, s->y) != ARK_SUCCESS) { // the stored slope is that of other inputs
            return 0;
        }
    }
    while (t < end) {
        const double stop = plain_next_reversal(&s->plain, t, end);
        if (ARKStepSetStopTime(s->integrator, stop) != ARK_SUCCESS ||
            ARKStepEvolve(s->integrator, stop, s->y, &t, ARK_NORMAL) < 0) {
            return 0;
        }
        t = stop;
    }
    plain_write_row(s, job, end, impulse, row);
    return 1;
}

static void run_job(const Job* job, Run* run) {
    PlainSolver s;
    plain_run(job, run, open_solver(&s, job, run), step, &s);
    run->evaluations = s.plain.evaluations;
    ARKStepFree(&s.integrator);
    plain_solver_close(&s);
}

int main(int count, char** words) {
    is_explicit = count > 1 && strcmp(words[1], "explicit") == 0;
    const Job job = job_read();
    job_measure(&job, run_job);
    return 0;
}
