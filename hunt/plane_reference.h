// One communication step in the plane by brute force in extended precision: the laws of reference.h with a velocity, a
// deflection and a force across the sliding.
//
// Where a bristle sticks its deflection is a closed form. Where it is Dahl's or LuGre's, both components are solved by one
// Radau collocation; where it slips along its bound, the angle of its deflection is. Panels are halved until one panel and
// its two halves agree, and until no bound can be met unseen between two nodes.
#ifndef HUNT_PLANE_REFERENCE_H
#define HUNT_PLANE_REFERENCE_H

#include "reference.h"

// Whether the scene, or the one before it, has anything across the sliding.
bool plane_is_needed(const ReferenceScene* before, const ReferenceScene* scene);

// As reference_step. A bristle with static friction that slips, slips along its deflection.
void plane_step(const ReferenceScene* before, const ReferenceScene* scene, int fineness,
                ReferenceStep* result);

// As reference_settled_force: F_t_settled and F_y_settled [N].
bool plane_settled_force(const ReferenceScene* scene, double force[2], double* S);

#endif
