// F_t_settled [N]: the mean of F_t over a period of the vibration once the bristle has settled at the present
// inputs, held.
//
// It is a function of the inputs and parameters alone. If several periodic states are possible, or nothing
// moves, it is the state to which delta_0 leads from the phase of time 0. Damping has no mean over a settled
// period; viscous friction has sigma_2 V. Without vibration it is the force of steady sliding at V.
#ifndef FC_SETTLED_FORCE_H
#define FC_SETTLED_FORCE_H

#include "friction_contact.h"

// To the tolerance, whatever solver.method is. Returns false, with *message filled, if the inputs and
// parameters do not go together, or the period needs more than FC_MOST_EVALUATIONS.
bool fc_settled_force(const FcFrictionContact* contact, double* force, FcMessage* message);

// Its partial derivative by one input [N over the input's unit], from one side at a kink, by differences.
// docs/solver.md has their accuracy. Returns false as fc_settled_force does.
bool fc_settled_force_slope(const FcFrictionContact* contact, FcInput input, double* slope,
                            FcMessage* message);

#endif
