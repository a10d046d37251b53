// A few steps of one contact, with inputs and tunable parameters that change between them. A hunt draws,
// replays and simplifies such sequences.
#ifndef HUNT_SEQUENCE_H
#define HUNT_SEQUENCE_H

#include <stdbool.h>
#include <stddef.h>

#include "contact/friction_contact.h"
#include "reference.h"

enum { MAX_STEPS = 10, SEQUENCE_TEXT = 8000 };

typedef struct {
    double tolerance; // solver.tolerance
    int method;       // number of solver.method
    int steps;
    ReferenceScene step[MAX_STEPS]; // of the later ones delta_0, v_0, x_0 and slips are not used
} Sequence;

// The start values of modelDescription.xml, and a step of 0.1 ms.
ReferenceScene start_values(void);

const char* law_name(double law);
int laws(void); // how many the FMU has

// The variables of the FMU that a scene has.
void put_scene(const ReferenceScene* scene, FcVariables* variables);

// The scene that a step leaves: inputs at their ends and then held, and the parameters.
ReferenceScene scene_after(const ReferenceScene* before);

// The tolerance, and name=value for each value that is not the start value. "then" precedes each later step, which has its
// changes alone.
void sequence_text(const Sequence* sequence, char* text, size_t size);

// The text with another word, and its space, or with none, in place of the word that begins there.
void with_word(char* changed, const char* text, size_t begin, const char* word);

// Makes the text of a sequence plain as long as it still shows the miss: without each word, else with the fewest digits,
// until nothing changes.
typedef bool StillShows(const Sequence* sequence);
void make_plain(char* text, StillShows* shows);

// Ends the program, with 2, at a word that is not a name=value of a scene.
Sequence sequence_read(const char* text);

#endif
