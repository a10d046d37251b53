#include "plain_sundials.h"

#include <stdio.h>
#include <string.h>

int plain_solver_open(PlainSolver* solver, const Job* job, Run* run) {
    *solver = (PlainSolver){.plain = plain_of(job, run)};
    if (SUNContext_Create(NULL, &solver->context) != 0) {
        return 0;
    }
    const double* p = solver->plain.p;
    solver->y = N_VNew_Serial(2, solver->context);
    solver->tolerance = N_VNew_Serial(2, solver->context);
    solver->matrix = SUNDenseMatrix(2, 2, solver->context);
    solver->linear_solver = SUNLinSol_Dense(solver->y, solver->matrix, solver->context);
    if (!solver->y || !solver->tolerance || !solver->matrix || !solver->linear_solver) {
        return 0;
    }
    NV_Ith_S(solver->y, 0) = p[PLAIN_DELTA_0];
    NV_Ith_S(solver->y, 1) = 0.0;
    NV_Ith_S(solver->tolerance, 0) = p[PLAIN_TOLERANCE] * p[PLAIN_F_C] / p[PLAIN_SIGMA_REF];
    NV_Ith_S(solver->tolerance, 1) = p[PLAIN_TOLERANCE] * p[PLAIN_F_C] * job->step;
    return 1;
}

void plain_solver_close(PlainSolver* solver) {
    SUNLinSolFree(solver->linear_solver);
    SUNMatDestroy(solver->matrix);
    N_VDestroy(solver->tolerance);
    N_VDestroy(solver->y);
    SUNContext_Free(&solver->context);
}

int plain_right_hand_side(realtype t, N_Vector y, N_Vector slope, void* user) {
    const PlainCoefficients at = plain_at(user, t);
    NV_Ith_S(slope, 0) = at.V + at.rate * NV_Ith_S(y, 0);
    NV_Ith_S(slope, 1) = at.sigma * NV_Ith_S(y, 0);
    return 0;
}

void plain_keep_reason(int code, const char* module, const char* function, char* text, void* user) {
    (void)module, (void)function;
    Plain* plain = user;
    if (code < 0) {
        snprintf(plain->reason, plain->reason_size, "%s", text);
        plain->reason[strcspn(plain->reason, "\n")] = '\0';
    }
}

void plain_write_row(PlainSolver* solver, const Job* job, double end, double impulse, double* row) {
    row[0] = plain_at(&solver->plain, end).sigma * NV_Ith_S(solver->y, 0);
    row[1] = (NV_Ith_S(solver->y, 1) - impulse) / job->step;
}
