// Climbs to wrong answers: draws sequences, keeps the dozen with the largest error over its allowed error, and changes a few
// numbers of these by up to 50, 10 or 2 % while that ratio grows.
#ifndef HUNT_CLIMB_H
#define HUNT_CLIMB_H

#include "scenes.h"

enum { KEPT = 12 };

typedef struct {
    uint64_t seed;
    Kind kind;
    const char* where;      // name=value ..: the first step of each sequence has these
    double seconds, trials; // at the most. Unless the seconds end it, the rest decides the result
    Sequence kept[KEPT];
    double ratio[KEPT]; // of its worst step, -1 if none is judged
} Climb;

// Tries a sequence; returns the ratio of its worst step, -1 if none is judged.
typedef double TrySequence(void* context, const Sequence* sequence);

void climb(Climb* climb, TrySequence* try_it, void* context);

#endif
