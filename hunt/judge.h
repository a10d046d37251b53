// How far a step of the FMU is from the reference.
#ifndef HUNT_JUDGE_H
#define HUNT_JUDGE_H

#include "fmu_step.h"
#include "reference.h"

enum { OF_FORCE, OF_MEAN, OF_WORK, OF_HEAT, OF_DEFLECTION, OF_START, JUDGED };

// Errors over what the tolerance is relative to: forces over the scale of the reference, which is no larger than that of
// the FMU; work and heat over it times the path and what the bristle yields; the deflection times the stiffness at the end
// over it.
typedef struct {
    double error[JUDGED];
} Errors;

Errors judge_errors(const ReferenceScene* scene, const ReferenceStep* truth, const FmuStep* step,
                    double tolerance);

// The largest of the errors over the tolerance, and which it is. Rounding is granted: no tolerance is held to less than
// 1e-10, nor to less than 1e-11 of the largest force or 1e-14 of the damping of all of V; a time in the step is known to its rounding, so that E or a load
// that falls by decades loses as many digits of the force.
double judge_ratio(const ReferenceScene* scene, const Errors* errors, const ReferenceStep* truth,
                   double tolerance, int* which);

#endif
