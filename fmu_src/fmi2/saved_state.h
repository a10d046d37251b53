// A saved FMU state (fmi2FMUstate): a plain copy of the contact's state and of what FMI knows of the run.
// The instance's name, its callbacks and its log switches are not part of it.
#ifndef FC_FMI2_SAVED_STATE_H
#define FC_FMI2_SAVED_STATE_H

#include "fmi2/instance.h"

// Tells a saved state from other memory, as far as that is possible. By hand: the letters FCST.
enum { FC_SAVED_STATE_MARK = 0x46435354 };

typedef struct {
    int mark;
    FcFrictionState friction;
    FcExperiment experiment;
} FcSavedState;

// The saved state behind the handle; NULL after logging that it is none.
FcSavedState* fc_saved_state_of(const FcInstance* instance, FcCall call, fmi2FMUstate state);

// The saved state behind *state to be filled, allocated when *state is NULL; NULL after logging why not.
FcSavedState* fc_saved_state_to_fill(const FcInstance* instance, FcCall call, fmi2FMUstate* state);

#endif
