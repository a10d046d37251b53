// A few steps of one contact, with inputs and tunable parameters that change between them. A hunt draws,
// replays and simplifies such sequences.
#ifndef HUNT_SEQUENCE_H
#define HUNT_SEQUENCE_H

#include <stdbool.h>
#include <stddef.h>

#include "reference.h"

enum { MOST_STEPS = 10, SEQUENCE_TEXT = 8000 };

typedef struct {
    double tolerance; // solver.tolerance
    int method;       // number of solver.method
    int steps;
    // The first scene is complete. In the others a NaN is a number that keeps its value from the step before;
    // their enumerations, start and delta_0 are not used.
    ReferenceScene step[MOST_STEPS];
} Sequence;

// Table 1's surfaces and the start values of modelDescription.xml.
ReferenceScene start_values(void);

// The numbers of a scene by their index, its enumerations after them, the law first.
enum { LAW_FIELD = REFERENCE_DOUBLES, FIELDS = LAW_FIELD + 5 };
double scene_get(const ReferenceScene* scene, int field);
void scene_set(ReferenceScene* scene, int field, double value);

extern const char* const LAW_NAMES[]; // of the numbers from 1 on; NULL ends them

// The scene that a step leaves: inputs at their ends and then held, and the parameters.
ReferenceScene scene_after(const ReferenceScene* before);

// The scene after that one, with the changes of the sequence's step k.
ReferenceScene sequence_scene(const Sequence* sequence, int k, const ReferenceScene* before);

// The changes of a step: all NaN (0 for an enumeration), or those from the scene that was left to this scene.
ReferenceScene changes_between(const ReferenceScene* left, const ReferenceScene* scene);

// A sequence that still shows the miss, with the fewest steps, the most start values and the fewest digits:
// greedily, one after the other, until nothing changes.
typedef bool StillShows(const Sequence* sequence);
Sequence minimized(const Sequence* sequence, StillShows* shows);

// The tolerance, and name=value for each value that is not the start value. "then" precedes each later step, which has its
// changes alone.
void sequence_text(const Sequence* sequence, char* text, size_t size);

// Returns false if the text has an unknown name, which goes into wrong.
bool sequence_read(const char* text, Sequence* sequence, char* wrong, size_t size);

#endif
