// The segments of an interval that are crossed one after the other (fc_scene_segment): a load that moves by
// decades, and a contact that opens and closes.
#ifndef FC_SOLVER_PERIODS_SEGMENTS_H
#define FC_SOLVER_PERIODS_SEGMENTS_H

#include <stdbool.h>

#include "solver/solver.h"

typedef struct {
    const FcScene* of;
    double whole, t;      // s, the interval, and the start of the next segment
    const FcScene* scene; // of the segment
    double h;             // s, its length
    FcScene own;          // the segment's, if it is not the interval's
} FcSegments;

// The interval [0, whole] of the scene. Keeps the pointer, and points into itself.
void fc_segments_start(FcSegments* segments, const FcScene* scene, double whole);

// Takes the next segment; false if there is none. Even an interval of no length has one.
bool fc_next_segment(FcSegments* segments);

// A step of any length without contact: the bristle is lost. It has no energy: with a constant stiffness its
// bound has fallen to 0 before, else the stiffness has.
void fc_open_contact_step(FcStepResult* result);

// The bristle of the result at the start of the scene, beyond whose bound a step has taken it: fc_project_onto_bound. The
// energy that it loses is heat.
void fc_project_result(const FcScene* scene, FcStepResult* result);

// Takes *total over an interval of at most a period, segment by segment.
void fc_march_segments(const FcScene* scene, const FcSolverOptions* options, double duration,
                       FcStepResult* total);

#endif
