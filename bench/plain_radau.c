// Radau IIA of order 5, 9 or 13 with the step control of RADAU (Hairer, Wanner, Solving ODEs II, IV.8), which stops
// at reversals: what a host does that knows when V turns and that the equation is affine, but nothing of friction.
// One program for each order; STAGES is 3, 5 or 7 by the compiler's command line.
//
//     y = (delta, integral of F_t dt)        rtol as given, atol = rtol times F_C / sigma_ref and F_C H
//
//     plain_radau_9 < job        see job.h and plain_equation.h
//
// The equation is affine, so the stages are one linear system of their number and need no iteration.
#include <math.h>
#include <stdio.h>

#include "plain_equation.h"

static double node[STAGES];
static double A[STAGES][STAGES];
// The embedded error estimate: (eigenvalue / h - J)^-1 (f_0 + sum of dd z / h), the one real eigenvalue of A^-1.
static double eigenvalue;
static double dd[STAGES];
static const double SAFETY = 0.9, LARGEST_GROWTH = 8.0, LARGEST_CUT = 5.0;
static const long MAX_STEPS = 10000000; // in a communication step

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

// Coefficients, in powers of the nodes, of the Lagrange polynomial that is 1 at the node j and 0 at the others.
static void lagrange(const long double c[STAGES], int j, long double coefficient[STAGES]) {
    for (int power = 0; power < STAGES; power++) {
        coefficient[power] = power == 0 ? 1.0L : 0.0L;
    }
    int degree = 0;
    for (int i = 0; i < STAGES; i++) {
        if (i == j) {
            continue;
        }
        degree++;
        for (int power = degree; power >= 0; power--) { // times (x - c_i) / (c_j - c_i)
            const long double lower = power > 0 ? coefficient[power - 1] : 0.0L;
            coefficient[power] = (lower - c[i] * coefficient[power]) / (c[j] - c[i]);
        }
    }
}

// P_n - P_(n-1) of Legendre at x, n the number of stages, and its derivative (by x^2 < 1).
static long double radau_polynomial(long double x, long double* slope) {
    long double before = 1.0L, now = x, older = 0.0L;
    for (int n = 1; n < STAGES; n++) {
        older = before;
        before = now;
        now = ((2 * n + 1) * x * before - n * older) / (n + 1);
    }
    const long double slope_now = STAGES * (before - x * now) / (1.0L - x * x);
    const long double slope_before = (STAGES - 1) * (older - x * before) / (1.0L - x * x);
    *slope = slope_now - slope_before;
    return now - before;
}

// The denominator of the method's stability function, whose one real zero is the real eigenvalue of A^-1.
static long double denominator(long double z, long double* slope) {
    long double term = 1.0L,
                value = 1.0L; // the coefficient of (-z)^k is s! (2 s - 1 - k)! / ((2 s - 1)! k! (s - k)!)
    *slope = 0.0L;
    for (int k = 1; k <= STAGES; k++) {
        term *= -(long double)(STAGES - k + 1) / ((2 * STAGES - k) * k);
        *slope += k * term * powl(z, k - 1);
        value += term * powl(z, k);
    }
    return value;
}

// Nodes, A, its eigenvalue and dd, each from its definition.
static void make_tables(void) {
    long double c[STAGES], slope, z = STAGES;
    c[STAGES - 1] = 1.0L;
    for (int i = 0; i + 1 < STAGES; i++) {
        long double x = -cosl(acosl(-1.0L) * (2 * i + 1) / (2 * STAGES - 1));
        for (int n = 0; n < 50; n++) {
            x -= radau_polynomial(x, &slope) / slope;
        }
        c[i] = 0.5L * (1.0L + x);
    }
    for (int n = 0; n < 100; n++) {
        z -= denominator(z, &slope) / slope;
    }
    eigenvalue = (double)z;
    double transposed[STAGES][STAGES], right[STAGES];
    for (int j = 0; j < STAGES; j++) {
        long double polynomial[STAGES];
        lagrange(c, j, polynomial);
        node[j] = (double)c[j];
        right[j] = -(double)polynomial[0]; // the weights that give -1 for a constant and 0 for higher powers
        for (int i = 0; i < STAGES; i++) {
            long double integral = 0.0L;
            for (int power = STAGES - 1; power >= 0; power--) {
                integral = (integral + polynomial[power] / (power + 1)) * c[i];
            }
            A[i][j] = transposed[j][i] = (double)integral;
        }
    }
    solve(transposed, right, dd);
}

static Stages stages(Radau* r, double h) {
    PlainCoefficients at[STAGES];
    for (int i = 0; i < STAGES; i++) {
        at[i] = plain_at(&r->plain, r->t + node[i] * h);
    }
    double matrix[STAGES][STAGES];
    double right[STAGES] = {0.0};
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
static double root(double x) { return STAGES == 3 ? sqrt(sqrt(x)) : pow(x, 1.0 / (STAGES + 1)); }

// Estimated local error over the tolerances.
static double error_of(const Radau* r, const Stages* z, double h, int is_new) {
    const double gamma = eigenvalue / h;
    double slope = r->at.rate * r->delta + r->at.V;
    double force = r->at.sigma * r->delta;
    for (int i = 0; i < STAGES; i++) {
        slope += dd[i] * z->delta[i] / h;
        force += dd[i] * z->impulse[i] / h;
    }
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
    for (long n = 0; n < MAX_STEPS; n++) {
        const int is_last = r->t + 1.0001 * r->h >= end;
        const double h = is_last ? end - r->t : r->h;
        const Stages z = stages(r, h);
        const double error = error_of(r, &z, h, is_new);
        double quotient = fmax(1.0 / LARGEST_GROWTH, fmin(LARGEST_CUT, root(error) / SAFETY));
        if (!(error < 1.0)) {
            is_new = 1;
            r->h = h / quotient;
            if (!(r->h > 1e-15 * fabs(r->t))) {
                break;
            }
            continue;
        }
        if (r->accepted_h > 0.0) { // Gustafsson's prediction
            const double trend = r->accepted_h / h * root(error * error / r->accepted_error) / SAFETY;
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
    make_tables();
    const Job job = job_read();
    job_measure(&job, run_job);
    return 0;
}
