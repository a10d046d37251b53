// F_t_settled against the reference.
#ifndef HUNT_SETTLED_H
#define HUNT_SETTLED_H

#include "reference.h"

typedef struct {
    double ratio;   // the error over the tolerance; -1 where there is none
    double granted; // what it may be
    int kind;       // class of the promise
} SettledGrade;

// At the inputs with which the scene starts, held, and the deflection that the FMU has started with.
SettledGrade settled_grade(const ReferenceScene* scene, double tolerance);

#endif
