// The march of a mass on its contact, panel by panel: what a mass moves by is known only as the panels are made, so that the
// reversals of w are roots on a panel, which cut it.
#ifndef FC_SOLVER_BODY_BODY_MARCH_H
#define FC_SOLVER_BODY_BODY_MARCH_H

#include "solver/body/body_panel.h"

// As fc_body_step, for a scene with a bristle, in one segment. If it refuses the step, *is_doubtful says whether a panel could
// not be made accurate; otherwise the work is too much.
bool fc_body_march_step(const FcScene* scene, const FcSolverOptions* options, double h, FcBody* body,
                        FcStepResult* result, bool* is_doubtful, FcMessage* message);

#endif
