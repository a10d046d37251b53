// Sequences drawn at random, in the domain of docs/numerics.md.
#ifndef HUNT_SCENES_H
#define HUNT_SCENES_H

#include <stdint.h>

#include "sequence.h"

// PLANE: with a transverse vibration, or a few periods along a line with a V_y that is nearly none.
// MASS: steps of a mass on the contact.
typedef enum { ALONG, PLANE, MASS } Kind;

// A sequence, which depends only on its kind, the seed and the number.
Sequence sequence_drawn(uint64_t seed, uint64_t number, Kind kind);

bool scene_is_in_domain(const ReferenceScene* scene);

// sigma V / (2 pi f limit) at the scene's start, without its vibration.
double scene_kappa(const ReferenceScene* scene);

// The factor by which a break-away that sticks at once multiplies an error of the deflection
// (docs/reliability.md).
double scene_gain(const ReferenceScene* scene);

// |delta| at the scene's start over g / sigma there.
double scene_start_over_limit(const ReferenceScene* scene);

// The domain of the promise: the smallest kappa of a vibration, and the largest start over the limit.
#define MIN_KAPPA 1e-3
#define LARGEST_START 100.0

#endif
