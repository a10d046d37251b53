// Sequences drawn at random, in the domain of docs/numerics.md; half of them from signals as users have them.
#ifndef HUNT_SCENES_H
#define HUNT_SCENES_H

#include <stdint.h>

#include "sequence.h"

// The same for the same seed and number, whatever is drawn besides. plane: with a vibration across the sliding.
Sequence sequence_drawn(uint64_t seed, uint64_t number, bool plane);

// sigma V / (2 pi f limit), by rules of thumb, at the scene's start.
double scene_kappa(const ReferenceScene* scene);

// By how much a drop at break-away that sticks at once multiplies an error of the deflection (docs/reliability.md).
double scene_gain(const ReferenceScene* scene);

// The least kappa of a vibration that the promise covers.
#define LEAST_KAPPA 1e-3

#endif
