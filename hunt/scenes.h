// Sequences drawn at random, by a grammar that knows what is near what.
#ifndef HUNT_SCENES_H
#define HUNT_SCENES_H

#include <stddef.h>
#include <stdint.h>

#include "sequence.h"

// What a hunt draws from.
typedef struct {
    int law;     // one of LAW_, or 0 for any
    int limit;   // one of LIMIT_, or 0
    int settled; // 0: no settled starts; 1: some; 2: all
    int method;  // one of solver.method's numbers, or 0 for the default and now and then cvode
} Grammar;

// The sequence of this number.
Sequence sequence_drawn(uint64_t seed, uint64_t number, const Grammar* grammar);

// The sequence that these bytes stand for, whatever they are.
Sequence sequence_from_bytes(const uint8_t* bytes, size_t size, const Grammar* grammar);

// sigma V / (2 pi f limit) at the start, V being the larger of |V| and V_1.
double scene_kappa(const ReferenceScene* scene);

#endif
