// An interval of time in which sigma and the limit stand still, so that the bristle is known by the path x of V alone.
// Between two reversals, with the settled deflection D = s g / sigma, s = sgn V,
//
//     delta = D + (delta_0 - D) e^(-x / |D|)
//
// What it becomes, its work and its heat are closed forms of the whole path, whatever V does on the way. Left for
// quadrature are the mean of the force and the work of damping: the integrals of e^(-x / |D|) over time, and times V^2.
#ifndef FC_SOLVER_CONSTANT_CONTACT_H
#define FC_SOLVER_CONSTANT_CONTACT_H

#include "solver/panel.h"
#include "solver/periods.h"

// Whether sigma and the limit stand still in the scene.
bool fc_is_constant_contact(const FcScene* scene);

// The map of [0, duration] in a scene of constant contact, as an FcIntervalMap; false where the bristle relaxes so much
// between two reversals that a Gauss rule does not hold the tolerance.
bool fc_constant_contact_interval(const FcScene* scene, double tolerance, double duration, double delta_0,
                                  FcMapScope scope, FcMap* map, double* evaluations);

#endif
