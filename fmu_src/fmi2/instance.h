// One FMU instance: a contact, where it is in the life of an FMI instance, and how it talks to its host.
#ifndef FC_INSTANCE_H
#define FC_INSTANCE_H

#include "fmi2/call_table.h"
#include "fmi2Functions.h"
#include "friction_contact.h"

// What FMI knows of a run beside the contact; plain data, part of a saved state.
typedef struct {
    int state;            // one InstanceState
    int outputs_stale;    // a value was set since the outputs were computed
    int tolerance_is_set; // by the user, so the tolerance of the experiment does not apply
    int has_stop_time;
    double start_time; // s
    double stop_time;  // s, when has_stop_time
} Machine;

typedef struct {
    FrictionContact contact;
    Machine machine;
    fmi2CallbackFunctions callbacks; // a copy: the host may forget its own
    unsigned log_mask;               // bit i: category variables_log_categories[i] is on
    int undersampling_told;          // the warning of fmi2DoStep is given once
    char name[];
} Instance;

_Static_assert(sizeof(Instance) <= 4096, "an instance fits into a page of memory");

// The instance if the call is legal in its state. Otherwise NULL: c was NULL, or the refusal has been logged.
Instance* instance_enter(fmi2Component c, Call call);

// As freshly instantiated: start values of modelDescription.xml, time 0, no stop time.
void instance_set_start_values(Instance* instance);

// Makes F_t, sigma and A_r agree with the present inputs and parameters; in initialization mode all outputs,
// from the start values set so far. Returns 1, or 0 with *message filled when those values do not go
// together.
int instance_refresh_outputs(Instance* instance, Message* message);

#endif
