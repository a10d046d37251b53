// The numbers and enumerations of a scene by name.
#ifndef HUNT_NAMES_H
#define HUNT_NAMES_H

#include <stdbool.h>
#include <stddef.h>

#include "reference.h"

// Numbers of a scene by index: every double of ReferenceScene.
extern const char* const SCENE_NAMES[REFERENCE_DOUBLES];
double* scene_value(ReferenceScene* scene, int index);

// Its enumerations by index, the law first.
enum { SCENE_CHOICES = 5 };
int* scene_choice(ReferenceScene* scene, int index);

// Appends name=value of each number and enumeration that differs from the usual scene.
void scene_text(const ReferenceScene* scene, const ReferenceScene* usual, char* text, size_t size);

// Sets what the word name=value names. Returns false where it is unknown or no number.
bool scene_read(const char* word, ReferenceScene* scene);

#endif
