// The steps of the FMU's core.
#ifndef HUNT_FMU_STEP_H
#define HUNT_FMU_STEP_H

#include <stdbool.h>

#include "reference.h"

typedef struct {
    double result[RESULTS]; // as of the reference; the heat of the first step includes that of the start
    double delta, delta_y;  // m, at the end
    double delta_start, delta_y_start; // m, before the step and its inputs
    int slips_start;
    double evaluations; // 1, since the start
} FmuStep;

typedef struct FmuRun FmuRun;

// A contact at the start of the scene, for fmu_close. Ends the program if there is no memory.
FmuRun* fmu_open(const ReferenceScene* scene, int method, double tolerance);
void fmu_close(FmuRun* run);

// One step with the scene's inputs and tunable parameters, from the end of the last one. Returns false if the
// core refuses it, or refused to start.
bool fmu_step(FmuRun* run, const ReferenceScene* scene, FmuStep* step);

// F_t_settled and F_y_settled [N] at the inputs with which the run was opened. Returns false if the core
// refuses it, or refused to start.
bool fmu_settled_force(FmuRun* run, double force[2]);

// The reason why the core refused.
const char* fmu_message(const FmuRun* run);

#endif
