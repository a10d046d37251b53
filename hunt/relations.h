// What must not change a step's answer by more than its tolerance. No reference is needed, so steps may be long.
#ifndef HUNT_RELATIONS_H
#define HUNT_RELATIONS_H

#include "fmu_step.h"
#include "reference.h"

enum {
    RELATION_SPLIT,    // the step taken as two
    RELATION_MIRROR,   // everything that moves to the other side: forces and deflections change their sign
    RELATION_SHIFT,    // 1024 periods later
    RELATION_RESTORED, // taken again from the saved state, another step in between: not a bit may differ
    RELATIONS
};

// The largest change over the tolerance, as judge_ratio has it; truth gives what errors are relative to. -1 where the
// relation does not hold exactly (the phase of the other time would be rounded) or the core refuses the scene.
double relation_ratio(int relation, const ReferenceScene* scene, const ReferenceStep* truth, int method,
                      double tolerance);

// The error of a step over the tolerance, were the same step by the default exact that is taken as two from where the FMU
// stood, with a tolerance a hundred times finer; frame gives what errors are relative to. Infinite where the parts are
// refused.
double parts_ratio(const ReferenceScene* scene, const FmuStep* step, const ReferenceStep* frame,
                   double tolerance);

#endif
