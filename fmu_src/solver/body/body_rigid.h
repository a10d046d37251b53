// A mass on a contact without a bristle: Coulomb's law, or an open contact.
#ifndef FC_SOLVER_BODY_BODY_RIGID_H
#define FC_SOLVER_BODY_BODY_RIGID_H

#include "solver/body/body.h"

// Takes *result and the body over a segment.
bool fc_body_rigid_step(const FcScene* scene, const FcSolverOptions* options, double h, FcBody* body,
                        FcStepResult* result, FcMessage* message);

#endif
