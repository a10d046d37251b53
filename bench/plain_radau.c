// Radau IIA of order 5 with the step control of RADAU5 (Hairer, Wanner, Solving ODEs II, IV.8), which stops at
// reversals: what a host does that knows when V turns and that the equation is affine, but nothing of friction.
//
//     y = (delta, integral of F_t dt)        rtol as given, atol = rtol times F_C / sigma_ref and F_C H
//
//     plain_radau < job        see job.h and plain_equation.h
//
// The equation is affine, so the three stages are one linear system of that size and need no iteration.
#include <math.h>
#include <stdio.h>

#include "plain_equation.h"

enum { STAGES = 3 };

#define ROOT_6 2.449489742783178
static const double NODE[STAGES] = {(4.0 - ROOT_6) / 10.0, (4.0 + ROOT_6) / 10.0, 1.0};
static const double A[STAGES][STAGES] = {
    {(88.0 - 7.0 * ROOT_6) / 360.0, (296.0 - 169.0 * ROOT_6) / 1800.0, (-2.0 + 3.0 * ROOT_6) / 225.0},
    {(296.0 + 169.0 * ROOT_6) / 1800.0, (88.0 + 7.0 * ROOT_6) / 360.0, (-2.0 - 3.0 * ROOT_6) / 225.0},
    {(16.0 - ROOT_6) / 36.0, (16.0 + ROOT_6) / 36.0, 1.0 / 9.0}};
// The embedded error estimate: (GAMMA / h - J)^-1 (f_0 + sum of DD z / h), 1 / GAMMA the real eigenvalue of A.
static const double GAMMA = 3.637834252744496;
static const double DD[STAGES] = {-(13.0 + 7.0 * ROOT_6) / 3.0, (-13.0 + 7.0 * ROOT_6) / 3.0, -1.0 / 3.0};
static const double SAFETY = 0.9, LARGEST_GROWTH = 8.0, LARGEST_CUT = 5.0;
static const long MOST_STEPS = 10000000; // in a communication step

typedef struct {
    Plain plain;
    double t;             // s
    double delta;         // m
    double impulse;       // N s, since the start of the communication step
    double h;             // s, that the step control proposes
    double first_h;       // s, of the last step taken after a reversal or a jump
    PlainCoefficients at; // at t
    double accepted_h;    // s, of the last step; 0 at the start
    double accepted_error;
    double atol_delta, atol_impulse;
} Radau;

typedef struct {
    double delta[STAGES];   // m, less that at the start of the step
    double impulse[STAGES]; // N s, the same
    PlainCoefficients last;
} Stages;

// x of matrix x = right, by Gauss elimination; the diagonal is far from 0, as h J <= 0 and A is what it is.
static void solve(double matrix[STAGES][STAGES], double right[STAGES], double x[STAGES]) {
    for (int i = 0; i < STAGES; i++) {
        for (int k = i + 1; k < STAGES; k++) {
            const double factor = matrix[k][i] / matrix[i][i];
            for (int j = i; j < STAGES; j++) {
                matrix[k][j] -= factor * matrix[i][j];
            }
            right[k] -= factor * right[i];
        }
    }
    for (int i = STAGES - 1; i >= 0; i--) {
        x[i] = right[i];
        for (int j = i + 1; j < STAGES; j++) {
            x[i] -= matrix[i][j] * x[j];
        }
        x[i] /= matrix[i][i];
    }
}

static Stages stages(Radau* r, double h) {
    PlainCoefficients at[STAGES];
    for (int i = 0; i < STAGES; i++) {
        at[i] = plain_at(&r->plain, r->t + NODE[i] * h);
    }
    double matrix[STAGES][STAGES];
    double right[STAGES] = {0.0, 0.0, 0.0};
    for (int i = 0; i < STAGES; i++) {
        for (int j = 0; j < STAGES; j++) {
            matrix[i][j] = (i == j ? 1.0 : 0.0) - h * A[i][j] * at[j].rate;
            right[i] += h * A[i][j] * (at[j].rate * r->delta + at[j].V);
        }
    }
    Stages z = {.last = at[STAGES - 1]};
    solve(matrix, right, z.delta);
    for (int i = 0; i < STAGES; i++) {
        for (int j = 0; j < STAGES; j++) {
            z.impulse[i] += h * A[i][j] * at[j].sigma * (r->delta + z.delta[j]);
        }
    }
    return z;
}

static double norm(double x, double y) { return sqrt(0.5 * (x * x + y * y)); }
static double fourth_root(double x) { return sqrt(sqrt(x)); }

// Estimated local error over the tolerances.
static double error_of(const Radau* r, const Stages* z, double h, int is_new) {
    const double gamma = GAMMA / h;
    const double sum_delta = (DD[0] * z->delta[0] + DD[1] * z->delta[1] + DD[2] * z->delta[2]) / h;
    const double sum_impulse = (DD[0] * z->impulse[0] + DD[1] * z->impulse[1] + DD[2] * z->impulse[2]) / h;
    const double slope = r->at.rate * r->delta + r->at.V + sum_delta;
    const double force = r->at.sigma * r->delta + sum_impulse;
    const double rtol = r->plain.p[PLAIN_TOLERANCE];
    const double scale_delta = r->atol_delta + rtol * fabs(r->delta);
    const double scale_impulse = r->atol_impulse + rtol * fabs(r->impulse);
    double delta = slope / (gamma - r->at.rate);
    double impulse = (force + r->at.sigma * delta) / gamma;
    double error = norm(delta / scale_delta, impulse / scale_impulse);
    if (error >= 1.0 && is_new) { // filtered once more, for stiff transients
        const double again = r->at.rate * delta, force_again = r->at.sigma * delta;
        delta = (slope + again) / (gamma - r->at.rate);
        impulse = (force + force_again + r->at.sigma * delta) / gamma;
        error = norm(delta / scale_delta, impulse / scale_impulse);
    }
    return fmax(error, 1e-10);
}

// To the time end [s], before which V does not reverse. A transient begins here after a reversal or a jump.
static int advance(Radau* r, double end, int transient) {
    int is_new = 1; // the first step, or the last was rejected
    r->accepted_h = 0.0;
    const double usual = transient ? r->first_h : r->h;
    r->h = usual > 0.0 ? usual : 1e-3 * (end - r->t);
    for (long n = 0; n < MOST_STEPS; n++) {
        const int is_last = r->t + 1.0001 * r->h >= end;
        const double h = is_last ? end - r->t : r->h;
        const Stages z = stages(r, h);
        const double error = error_of(r, &z, h, is_new);
        double quotient = fmax(1.0 / LARGEST_GROWTH, fmin(LARGEST_CUT, fourth_root(error) / SAFETY));
        if (!(error < 1.0)) {
            is_new = 1;
            r->h = h / quotient;
            if (!(r->h > 1e-15 * fabs(r->t))) {
                break;
            }
            continue;
        }
        if (r->accepted_h > 0.0) { // Gustafsson's prediction
            const double trend = r->accepted_h / h * fourth_root(error * error / r->accepted_error) / SAFETY;
            quotient = fmax(quotient, fmax(1.0 / LARGEST_GROWTH, fmin(LARGEST_CUT, trend)));
        } else if (transient) {
            r->first_h = h;
        }
        r->accepted_h = h;
        r->accepted_error = fmax(1e-2, error);
        r->t += h;
        r->delta += z.delta[STAGES - 1];
        r->impulse += z.impulse[STAGES - 1];
        r->at = z.last;
        r->h = is_new ? fmin(h, h / quotient) : h / quotient;
        is_new = 0;
        if (is_last) {
            r->t = end;
            return 1;
        }
    }
    snprintf(r->plain.reason, r->plain.reason_size, "the step becomes 0, or too many steps");
    return 0;
}

static int step(void* solver, const Job* job, int k, double* row) {
    Radau* r = solver;
    const double end = job->start + (k + 1) * job->step;
    if (job->inputs > 0) {
        plain_set_inputs(&r->plain, job, k);
    }
    r->impulse = 0.0;
    r->at = plain_at(&r->plain, r->t);
    const int jumps = k == 0 || (job->inputs > 0 && !job->linear);
    for (int transient = jumps; r->t < end; transient = 1) {
        if (!advance(r, plain_next_reversal(&r->plain, r->t, end), transient)) {
            return 0;
        }
    }
    row[0] = r->at.sigma * r->delta;
    row[1] = r->impulse / job->step;
    return 1;
}

static void run_job(const Job* job, Run* run) {
    Radau r = {.plain = plain_of(job, run), .t = job->start};
    const double* p = r.plain.p;
    r.delta = p[PLAIN_DELTA_0];
    r.atol_delta = p[PLAIN_TOLERANCE] * p[PLAIN_F_C] / p[PLAIN_SIGMA_REF];
    r.atol_impulse = p[PLAIN_TOLERANCE] * p[PLAIN_F_C] * job->step;
    plain_run(job, run, 1, step, &r);
    run->evaluations = r.plain.evaluations;
}

int main(void) {
    const Job job = job_read();
    job_measure(&job, run_job);
    return 0;
}
