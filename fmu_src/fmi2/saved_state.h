// A saved FMU state (fmi2FMUstate): a plain copy of the contact's state and of the state of the run. The
// instance's name, its callbacks and its log switches are not part of it.
//
// Its bytes are FcSavedState as it lies in memory, its padding 0, and its FNV-1a hash of 64 bits. FMI 2.0 asks
// that the same FMU on the same platform reads them. Equal states give equal bytes.
#ifndef FC_FMI2_SAVED_STATE_H
#define FC_FMI2_SAVED_STATE_H

#include <stdint.h>

#include "fmi2/instance.h"

// It distinguishes a state of this FMU from other memory and from other bytes.
typedef struct {
    char magic[8];   // FRICTION
    uint32_t layout; // version of FcSavedState; another number in another byte order
    uint32_t size;   // of the bytes
    char guid[40];   // of the FMU, then zeros
} FcSavedStateHead;

typedef struct {
    FcSavedStateHead head;
    FcFrictionState friction;
    FcExperiment experiment;
} FcSavedState;

enum { FC_SAVED_STATE_BYTES = sizeof(FcSavedState) + sizeof(uint64_t) };

// The head of each state that this FMU saves.
FcSavedStateHead fc_saved_state_head(void);

#endif
