// F_t_settled and F_y_settled [N]: the means of F_t and F_y over a period of the vibration after the bristle
// has settled at the present inputs, held.
//
// They are functions of the inputs and parameters alone. If several periodic states are possible, or nothing
// moves, the means are those of the state to which delta_0 and delta_y_0 lead from the phase of time 0.
// Damping has no mean over a settled period; viscous friction adds sigma_2 V. Without vibration the state is
// steady sliding at V.
#ifndef FC_CONTACT_SETTLED_FORCE_H
#define FC_CONTACT_SETTLED_FORCE_H

#include <stddef.h>

#include "contact/friction_contact.h"

// Within the tolerance, for any solver.method. Returns false, with *message filled, if the inputs and
// parameters are not a valid combination, or if the period needs more than FC_MAX_EVALUATIONS.
// contact->scatters says whether the means are those of many periods that differ.
bool fc_settled_force(FcFrictionContact* contact, FcVector* force, FcMessage* message);

// Their partial derivatives by one input or tunable parameter, at this place in FcVariables [N over its unit],
// one-sided at a kink: by differences, whose accuracy docs/solver.md states. Returns false as fc_settled_force
// does.
bool fc_settled_force_slope(const FcFrictionContact* contact, size_t variable, FcVector* slope,
                            FcMessage* message);

#endif
