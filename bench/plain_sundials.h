// What the peers of SUNDIALS share: vectors, tolerances, the equation, and the message of a failure.
//
//     y = (delta, integral of F_t dt)        rtol as given, atol = rtol times F_C / sigma_ref and F_C H
#ifndef BENCH_PLAIN_SUNDIALS_H
#define BENCH_PLAIN_SUNDIALS_H

#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "plain_equation.h"

typedef struct {
    Plain plain;
    SUNContext context;
    N_Vector y;
    N_Vector tolerance; // absolute
    SUNMatrix matrix;
    SUNLinearSolver linear_solver;
    void* integrator; // made and freed by the peer
} PlainSolver;

// y at the start of the job; false where there is no memory.
int plain_solver_open(PlainSolver* solver, const Job* job, Run* run);
void plain_solver_close(PlainSolver* solver);

// Eq. 2, and Eq. 1 as the slope of the integral. user is the Plain.
int plain_right_hand_side(realtype t, N_Vector y, N_Vector slope, void* user);

// An error handler of SUNDIALS; user is the Plain.
void plain_keep_reason(int code, const char* module, const char* function, char* text, void* user);

// F_t at the end of a step and its mean over it; impulse is the integral of F_t dt up to the step's start.
void plain_write_row(PlainSolver* solver, const Job* job, double end, double impulse, double* row);

#endif
