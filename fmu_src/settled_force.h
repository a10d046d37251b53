// F_t_settled [N]: the mean of F_t over a period of the vibration once the bristle has settled at the present inputs, held.
//
// It is a function of the inputs and parameters alone: where several periodic states are possible, or nothing moves, it is
// the one that delta_0 leads to from the phase of time 0. Damping has no mean over a settled period; viscous friction has
// sigma_2 V. Without vibration it is the force of sliding at V for ever.
#ifndef FC_SETTLED_FORCE_H
#define FC_SETTLED_FORCE_H

#include "friction_contact.h"

// To the tolerance, whatever solver.method is. Returns false, with *message filled, where the inputs and parameters do not go
// together, or the period needs more than FC_MOST_EVALUATIONS.
bool fc_settled_force(const FcFrictionContact* contact, double* force, FcMessage* message);

// Its partial derivative by one input [N over the input's unit], from one side where it has a kink: by differences, of which
// docs/solver.md says how accurate they are. Returns false as fc_settled_force does.
bool fc_settled_force_slope(const FcFrictionContact* contact, FcInput input, double* slope,
                            FcMessage* message);

#endif
