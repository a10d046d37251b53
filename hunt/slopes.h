// F_t's derivatives at the start of a step against differences of the reference.
#ifndef HUNT_SLOPES_H
#define HUNT_SLOPES_H

#include "fmu_step.h"
#include "reference.h"

// The largest error of the derivative in time, the inputs moving, and of those by V, d, E and load, the inputs held: over
// 1e-6 of the derivative and of the largest force over the scale on which the input moves it. At a kink anything between
// both sides will do. -1 where the differences tell nothing: a kink lies next to the start.
double slopes_ratio(const ReferenceScene* scene, const ReferenceStep* truth, const FmuStep* step);

#endif
