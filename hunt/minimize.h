// Makes a sequence that misses as plain as it can be.
#ifndef HUNT_MINIMIZE_H
#define HUNT_MINIMIZE_H

#include <stdbool.h>

#include "sequence.h"

// Whether the sequence still shows what it is to show.
typedef bool StillShows(const Sequence* sequence, const void* context);

// The sequence with as few steps, as many start values, and numbers of as few digits, as still show it: greedily, one
// after the other, until nothing changes any more.
Sequence minimized(const Sequence* sequence, StillShows* shows, const void* context);

#endif
