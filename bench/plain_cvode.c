// CVODE as a host uses it that knows nothing of the equation: BDF, Newton, its own difference-quotient Jacobian and
// step sizes, no stop at reversals; restarted only where an input of a communication step jumps or bends.
//
//     y = (delta, integral of F_t dt)        rtol as given, atol = rtol times F_C / sigma_ref and F_C H
//     sigma = sigma_ref (d_ref / d)^3 exp(-2 decay (d - d_ref)), or sigma_ref where decay is 0
//
//     plain_cvode < job        see job.h; its value references are the numbers of the enumeration below.
//
// Outputs are F_t and its mean over the step. The set-up is not timed, as that of an FMU is not.
#include <cvode/cvode.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <string.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "job.h"

enum { V, D, F_C, SIGMA_REF, D_REF, DECAY, F, V_1, A_D, PHASE_D, TOLERANCE, DELTA_0, PARAMETERS };

static const double TWO_PI = 6.283185307179586;
static const long MOST_STEPS = 1000000; // of CVODE in a communication step

typedef struct {
    double p[PARAMETERS]; // m, N, s; p[V] and p[D] are those at the start of the step
    double start;         // s, of the present communication step
    double V_rate;        // m/s2
    double d_rate;        // m/s
    double evaluations;
    char* reason;
    size_t reason_size;
} Model;

typedef struct {
    SUNContext context;
    N_Vector y;
    N_Vector tolerance;
    SUNMatrix matrix;
    SUNLinearSolver linear_solver;
    void* cvode;
} Solver;

static double speed(const Model* m, double t) {
    return m->p[V] + m->V_rate * (t - m->start) + m->p[V_1] * cos(TWO_PI * m->p[F] * t);
}

static double stiffness(const Model* m, double t) {
    const double* p = m->p;
    if (p[DECAY] == 0.0) {
        return p[SIGMA_REF];
    }
    const double d = p[D] + m->d_rate * (t - m->start) + p[A_D] * cos(TWO_PI * p[F] * t + p[PHASE_D]);
    const double ratio = p[D_REF] / d;
    return p[SIGMA_REF] * ratio * ratio * ratio * exp(-2.0 * p[DECAY] * (d - p[D_REF])); // Eq. 3
}

static int right_hand_side(realtype t, N_Vector y, N_Vector slope, void* user) {
    Model* m = user;
    const double v = speed(m, t);
    const double force = stiffness(m, t) * NV_Ith_S(y, 0); // Eq. 1
    NV_Ith_S(slope, 0) = v - fabs(v) * force / m->p[F_C];  // Eq. 2
    NV_Ith_S(slope, 1) = force;
    m->evaluations += 1.0;
    return 0;
}

static void keep_reason(int code, const char* module, const char* function, char* text, void* user) {
    (void)module, (void)function;
    Model* m = user;
    if (code < 0) {
        snprintf(m->reason, m->reason_size, "%s", text);
        m->reason[strcspn(m->reason, "\n")] = '\0';
    }
}

static Model model_of(const Job* job, Run* run) {
    Model m = {.start = job->start, .reason = run->reason, .reason_size = sizeof run->reason};
    for (int i = 0; i < job->values; i++) {
        if (job->value[i].reference < PARAMETERS) {
            m.p[job->value[i].reference] = job->value[i].value;
        }
    }
    return m;
}

static int open_solver(Solver* s, Model* m, const Job* job) {
    if (SUNContext_Create(NULL, &s->context) != 0) {
        return 0;
    }
    s->y = N_VNew_Serial(2, s->context);
    s->tolerance = N_VNew_Serial(2, s->context);
    s->matrix = SUNDenseMatrix(2, 2, s->context);
    s->linear_solver = SUNLinSol_Dense(s->y, s->matrix, s->context);
    s->cvode = CVodeCreate(CV_BDF, s->context);
    NV_Ith_S(s->y, 0) = m->p[DELTA_0];
    NV_Ith_S(s->y, 1) = 0.0;
    NV_Ith_S(s->tolerance, 0) = m->p[TOLERANCE] * m->p[F_C] / m->p[SIGMA_REF];
    NV_Ith_S(s->tolerance, 1) = m->p[TOLERANCE] * m->p[F_C] * job->step;
    return CVodeInit(s->cvode, right_hand_side, job->start, s->y) == CV_SUCCESS &&
           CVodeSVtolerances(s->cvode, m->p[TOLERANCE], s->tolerance) == CV_SUCCESS &&
           CVodeSetUserData(s->cvode, m) == CV_SUCCESS &&
           CVodeSetErrHandlerFn(s->cvode, keep_reason, m) == CV_SUCCESS &&
           CVodeSetMaxNumSteps(s->cvode, MOST_STEPS) == CV_SUCCESS &&
           CVodeSetLinearSolver(s->cvode, s->linear_solver, s->matrix) == CVLS_SUCCESS;
}

static void close_solver(Solver* s) {
    CVodeFree(&s->cvode);
    SUNLinSolFree(s->linear_solver);
    SUNMatDestroy(s->matrix);
    N_VDestroy(s->tolerance);
    N_VDestroy(s->y);
    SUNContext_Free(&s->context);
}

static void set_inputs(Model* m, const Job* job, int k) {
    m->start = job->start + k * job->step;
    for (int i = 0; i < job->inputs; i++) {
        const double now = job_sample(&job->input[i], k);
        const double rate = job->linear ? (job_sample(&job->input[i], k + 1) - now) / job->step : 0.0;
        m->p[job->input[i].reference] = now;
        *(job->input[i].reference == V ? &m->V_rate : &m->d_rate) = rate;
    }
}

static int step(Solver* s, Model* m, const Job* job, int k, double* row) {
    const double end = job->start + (k + 1) * job->step;
    const double impulse = NV_Ith_S(s->y, 1);
    if (job->inputs > 0) {
        set_inputs(m, job, k);
        if (CVodeReInit(s->cvode, m->start, s->y) != CV_SUCCESS ||
            CVodeSetStopTime(s->cvode, end) != CV_SUCCESS) {
            return 0;
        }
    }
    double reached = 0.0;
    if (CVode(s->cvode, end, s->y, &reached, CV_NORMAL) < 0) {
        return 0;
    }
    row[0] = stiffness(m, end) * NV_Ith_S(s->y, 0);
    row[1] = (NV_Ith_S(s->y, 1) - impulse) / job->step;
    return 1;
}

static void run_job(const Job* job, Run* run) {
    Model m = model_of(job, run);
    Solver s;
    run->failed_at = open_solver(&s, &m, job) ? -1 : 0;
    const double cpu = cpu_seconds();
    const double wall = wall_seconds();
    for (int k = 0; k < job->count && run->failed_at < 0; k++) {
        if (!step(&s, &m, job, k, run->row + k * job->outputs)) {
            run->failed_at = k;
        }
    }
    run->wall = wall_seconds() - wall;
    run->cpu = cpu_seconds() - cpu;
    run->evaluations = m.evaluations;
    close_solver(&s);
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
