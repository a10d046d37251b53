// One FMU instance: a contact, its state in the life of an FMI instance, and its connection to the host.
#ifndef FC_FMI2_INSTANCE_H
#define FC_FMI2_INSTANCE_H

#include <stdbool.h>

#include "contact/friction_contact.h"
#include "contact/ode.h"
#include "fmi2/call_table.h"
#include "fmi2Functions.h"

// The state of a run besides the contact; plain data, part of a saved state.
typedef struct {
    int interface;        // one FcInterface
    int mode;             // one FcMode
    int outputs_stale;    // a value was set since the outputs were computed
    int tolerance_is_set; // by the user, so the tolerance of the experiment does not apply
    int has_stop_time;
    int no_hole;       // 0, so that sizeof tells of every new member (saved_state.c)
    double start_time; // s
    double stop_time;  // s, when has_stop_time
} FcExperiment;

typedef struct {
    FcFrictionContact contact;
    FcExperiment experiment;
    fmi2CallbackFunctions callbacks; // a copy: the host may forget its own
    unsigned log_mask;               // bit i: category fc_log_categories[i] is on
    unsigned told;                   // warnings that are given once and were (step.c, plausibility.c)
    FcVector settled_force;          // N, (F_t_settled, F_y_settled) as they were last computed
    FcVariables settled_force_of;    // of these inputs and parameters; zeros before the first time
    char name[];
} FcInstance;

_Static_assert(sizeof(FcInstance) <= 4096, "an instance fits into a page of memory");

// The instance if the call is legal in its state. Otherwise NULL: c was NULL, or the refusal has been logged.
FcInstance* fc_instance_enter(fmi2Component c, FcCall call);

// As freshly instantiated: start values of modelDescription.xml, time 0, no stop time.
void fc_instance_set_start_values(FcInstance* instance);

// Model exchange, and initialized: the contact is the differential equation of ode.h.
bool fc_instance_is_ode(const FcInstance* instance);

// Computes F_t, sigma and A_r from the present inputs and parameters; in initialization mode all outputs,
// from the start values set so far. Returns 1, or 0 with *message filled if these values are not a valid
// combination.
bool fc_instance_refresh_outputs(FcInstance* instance, FcMessage* message);

// The same, and the rates of the states.
bool fc_instance_refresh_rates(FcInstance* instance, FcMessage* message);

#endif
