// A few steps of one contact, its inputs and tunable parameters changed between them: what a hunt draws, replays and makes
// plain.
#ifndef HUNT_SEQUENCE_H
#define HUNT_SEQUENCE_H

#include <stdbool.h>
#include <stddef.h>

#include "reference.h"

enum { MOST_STEPS = 10, SEQUENCE_TEXT = 8000 };

typedef struct {
    int method; // one of solver.method's numbers
    int steps;
    // The first scene is whole. Of those after it a number is NaN where it goes on as the step before left it; their
    // enumerations, start and delta_0 are not used.
    ReferenceScene step[MOST_STEPS];
} Sequence;

// What a step leaves to the next one: inputs where they end and then held, and the parameters.
ReferenceScene scene_after(const ReferenceScene* before);

// The scene after that one, with all that the sequence's step k changes.
ReferenceScene sequence_scene(const Sequence* sequence, int k, const ReferenceScene* before);

// A later step that changes nothing.
ReferenceScene no_change(void);

// As name=value of what is not the start value; "then" stands before each later step, of which the changes are named.
void sequence_text(const Sequence* sequence, char* text, size_t size);

// Returns false where the text names something unknown, which goes into wrong.
bool sequence_read(const char* text, Sequence* sequence, char* wrong, size_t size);

#endif
