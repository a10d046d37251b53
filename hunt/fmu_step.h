// The FMU's core, taken through steps.
#ifndef HUNT_FMU_STEP_H
#define HUNT_FMU_STEP_H

#include <stdbool.h>

#include "reference.h"

typedef struct {
    double delta;       // m
    double F_t;         // N
    double F_t_mean;    // N
    double work;        // J, of this step
    double heat;        // J, of this step
    double delta_start; // m, before the step
    double F_t_start;   // N, before the step, with held inputs
    double evaluations; // 1, since the start
    double rate;        // N/s, of F_t at the start, the inputs moving as they do in the step
    double slopes[4];   // N per unit of V, d, E, load, of F_t_start
} FmuStep;

enum { FMU_COLLOCATION = 1, FMU_CVODE = 2 }; // numbers of solver.method

typedef struct FmuRun FmuRun;

// A contact at the start of the scene, to be closed; ends the program where there is no memory.
FmuRun* fmu_open(const ReferenceScene* scene, int method, double tolerance);
void fmu_close(FmuRun* run);

// One step with the inputs and the parameters of the scene that are tunable, from where the last one ended. Returns false
// where the core refuses it, or refused to start.
bool fmu_step(FmuRun* run, const ReferenceScene* scene, FmuStep* step);

// F_t_settled [N] at the inputs that the run was opened with. Returns false where the core refuses it, or refused to start.
bool fmu_settled_force(FmuRun* run, double* force);

// Why the core refused.
const char* fmu_message(const FmuRun* run);

// A copy of the state, as a saved FMU state is one, and the way back to it.
typedef struct FmuState FmuState;
FmuState* fmu_save(const FmuRun* run);
void fmu_restore(FmuRun* run, const FmuState* state);
void fmu_forget(FmuState* state);

#endif
