// Sequences drawn at random, in the domain of docs/numerics.md; half of them from signals as users have them.
#ifndef HUNT_SCENES_H
#define HUNT_SCENES_H

#include <stdint.h>

#include "sequence.h"

typedef struct {
    int law, limit; // 0: any
} Grammar;

// The same for the same seed and number, whatever is drawn besides.
Sequence sequence_drawn(uint64_t seed, uint64_t number, const Grammar* grammar);

// From bytes that a fuzzer chose.
Sequence sequence_from_bytes(const uint8_t* bytes, size_t size, const Grammar* grammar);

// sigma V / (2 pi f limit), by rules of thumb, at the scene's start.
double scene_kappa(const ReferenceScene* scene);

#endif
