// The steps of the FMU's core.
#ifndef HUNT_FMU_STEP_H
#define HUNT_FMU_STEP_H

#include "friction_contact.h"
#include "reference.h"

typedef struct {
    double result[RESULTS]; // as of the reference; the heat of the first step includes that of the start
    double delta, delta_y;  // m, at the end
    double delta_start, delta_y_start; // m, before the step and its inputs
    int slips_start;
} FmuStep;

typedef struct {
    FcFrictionContact contact;
    FcMessage message;     // why the core refused
    bool started;          // the core did not refuse to
    FcFrictionState after; // the last step, whose work and heat were counted
} FmuRun;

// Starts a contact at the start of the scene, for fmu_close.
void fmu_open(FmuRun* run, const ReferenceScene* scene, int method, double tolerance);
void fmu_close(FmuRun* run);

// The next two return false if the core refuses it, or refused to start.

// One step with the scene's inputs and tunable parameters, from the end of the last one.
bool fmu_step(FmuRun* run, const ReferenceScene* scene, FmuStep* step);

// F_t_settled and F_y_settled [N] at the inputs with which the run was opened.
bool fmu_settled_force(FmuRun* run, double force[2]);

#endif
