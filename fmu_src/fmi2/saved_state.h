// A saved FMU state (fmi2FMUstate): a plain copy of the contact's state and of the state of the run. The
// instance's name, its callbacks and its log switches are not part of it.
#ifndef FC_FMI2_SAVED_STATE_H
#define FC_FMI2_SAVED_STATE_H

#include "fmi2/instance.h"

// The mark by which a saved state is distinguished from other memory. Chosen empirically: the letters FCST. A
// shorter mark is found by chance more often.
enum { FC_SAVED_STATE_MARK = 0x46435354 };

typedef struct {
    int mark;
    FcFrictionState friction;
    FcExperiment experiment;
} FcSavedState;

// The saved state of the handle; NULL, after logging, if the handle is not a saved state.
FcSavedState* fc_saved_state_of(const FcInstance* instance, FcCall call, fmi2FMUstate state);

// The saved state of *state, to be filled; allocated if *state is NULL. NULL after logging the reason.
FcSavedState* fc_saved_state_to_fill(const FcInstance* instance, FcCall call, fmi2FMUstate* state);

#endif
