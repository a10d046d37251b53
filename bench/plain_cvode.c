// CVODE as a host uses it that knows nothing of the equation: BDF, Newton, its own difference-quotient Jacobian and
// step sizes, no stop at reversals; restarted only where an input of a communication step jumps or bends.
//
//     plain_cvode < job        see job.h, plain_equation.h and plain_sundials.h
//
// The set-up is not timed, as that of an FMU is not.
#include <cvode/cvode.h>
#include <stdio.h>

#include "plain_sundials.h"

static const long MOST_STEPS = 1000000; // of CVODE in a communication step

static int open_solver(PlainSolver* s, const Job* job, Run* run) {
    if (!plain_solver_open(s, job, run)) {
        return 0;
    }
    s->integrator = CVodeCreate(CV_BDF, s->context);
    return CVodeInit(s->integrator, plain_right_hand_side, job->start, s->y) == CV_SUCCESS &&
           CVodeSVtolerances(s->integrator, s->plain.p[PLAIN_TOLERANCE], s->tolerance) == CV_SUCCESS &&
           CVodeSetUserData(s->integrator, &s->plain) == CV_SUCCESS &&
           CVodeSetErrHandlerFn(s->integrator, plain_keep_reason, &s->plain) == CV_SUCCESS &&
           CVodeSetMaxNumSteps(s->integrator, MOST_STEPS) == CV_SUCCESS &&
           CVodeSetLinearSolver(s->integrator, s->linear_solver, s->matrix) == CVLS_SUCCESS;
}

static int step(void* solver, const Job* job, int k, double* row) {
    PlainSolver* s = solver;
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
    plain_write_row(s, job, end, impulse, row);
    return 1;
}

static void run_job(const Job* job, Run* run) {
    PlainSolver s;
    plain_run(job, run, open_solver(&s, job, run), step, &s);
    run->evaluations = s.plain.evaluations;
    CVodeFree(&s.integrator);
    plain_solver_close(&s);
}

int main(void) {
    const Job job = job_read();
    if (job.outputs != 2) {
        fprintf(stderr, "error: this job needs 2 lines of output, not %d\n", job.outputs);
        return 2;
    }
    job_measure(&job, run_job);
    return 0;
}
