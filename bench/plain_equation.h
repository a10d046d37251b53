// Eq. 1 and 2 as a host writes them that knows no more: the state is (delta, integral of F_t dt), no law of
// the FMU's own solver is used. For the peers plain_*.c, which read their scene from a job (see job.h):
//
//     delta' = V - sigma |V| delta / F_C        F_t = sigma delta
//     sigma = sigma_ref (d_ref / d)^3 exp(-2 decay (d - d_ref)), or sigma_ref where decay is 0        (Eq. 3)
//
// The job's value references are the numbers of the enumeration; its outputs are F_t and its mean over the step.
#ifndef BENCH_PLAIN_EQUATION_H
#define BENCH_PLAIN_EQUATION_H

#include "job.h"

enum {
    PLAIN_V,
    PLAIN_D,
    PLAIN_F_C,
    PLAIN_SIGMA_REF,
    PLAIN_D_REF,
    PLAIN_DECAY,
    PLAIN_F,
    PLAIN_V_1,
    PLAIN_A_D,
    PLAIN_PHASE_D,
    PLAIN_TOLERANCE,
    PLAIN_DELTA_0,
    PLAIN_PARAMETERS
};

typedef struct {
    double p[PLAIN_PARAMETERS];  // m, N, s; p[PLAIN_V] and p[PLAIN_D] are those at the start of the step
    double cos_phase, sin_phase; // of p[PLAIN_PHASE_D]
    double start;                // s, of the present communication step
    double V_rate;               // m/s2
    double d_rate;               // m/s
    double evaluations;          // of the equation's coefficients
    char* reason;                // room for why a solver failed
    size_t reason_size;
} Plain;

typedef struct {
    double V;     // m/s
    double sigma; // N/m
    double rate;  // 1/s, -sigma |V| / F_C
} PlainCoefficients;

Plain plain_of(const Job* job, Run* run);
void plain_set_inputs(Plain* plain, const Job* job, int k); // of the communication step k
PlainCoefficients plain_at(Plain* plain, double t);

// The first time after t and before end [s] where V changes sign, or end. One of V' and V_1 must be 0.
double plain_next_reversal(const Plain* plain, double t, double end);

// Takes the communication step k with a solver and writes F_t and its mean to row; false where it fails.
typedef int (*PlainStep)(void* solver, const Job* job, int k, double* row);

// All steps of the job between two looks at the clock, unless the solver could not be opened.
void plain_run(const Job* job, Run* run, int is_open, PlainStep step, void* solver);

#endif
