// What is promised: for which steps solver.tolerance is held, and by how much others may miss it. docs/numerics.md has the
// same table, with the reasons.
#ifndef HUNT_PROMISE_H
#define HUNT_PROMISE_H

#include "reference.h"

// In the order in which a step is given to the first that fits.
enum {
    CLASS_FIXED, // Dahl and LuGre by fixed steps, or by cvode while inputs move by decades
    CLASS_BEYOND_BY_DECADES, // the bristle's force, or its damping, at more than three times the limit, while in the step E,
    // the load, or what d makes of load or stiffness moves by a factor of 3 and more, or the
    // vibration of d moves the load by 1e6
    CLASS_HELD, // all others
    CLASSES
};

int promise_class(const ReferenceScene* scene, const ReferenceStep* truth, int method);
const char* promise_name(int kind);

// How many times the tolerance an error of a step of this class may be.
double promise_factor(int kind, double tolerance);

// Prints the table.
void promise_print(void);

#endif
