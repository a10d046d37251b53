// F_t_settled and F_y_settled [N]: the means of F_t and F_y over a period of the vibration once the bristle has settled at the present
// inputs, held.
//
// They are functions of the inputs and parameters alone: where several periodic states are possible, or nothing moves, it is
// the one that delta_0 and delta_y_0 lead to from the phase of time 0. Damping has no mean over a settled period; viscous friction
// has sigma_2 V. Without vibration it is the force of sliding at V for ever.
#ifndef FC_SETTLED_FORCE_H
#define FC_SETTLED_FORCE_H

#include "friction_contact.h"

// To the tolerance, whatever solver.method is. Returns false, with *message filled, where the inputs and parameters do not go
// together, or the period needs more than FC_MOST_EVALUATIONS.
bool fc_settled_force(const FcFrictionContact* contact, FcVector* force, FcMessage* message);

// Their partial derivatives by one input [N over the input's unit], from one side where there is a kink: by differences, of which
// docs/solver.md says how accurate they are. Returns false as fc_settled_force does.
bool fc_settled_force_slope(const FcFrictionContact* contact, FcInput input, FcVector* slope,
                            FcMessage* message);

#endif
