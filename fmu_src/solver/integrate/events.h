// Event location for a bounded bristle: where it meets its bound, where its slip ends, and what happens there.
// The transitions are those of model/bound.h. The polynomial through a
// panel's points finds an event and places it; the meeting of a stuck bristle is placed by its exact motion.
#ifndef FC_SOLVER_INTEGRATE_EVENTS_H
#define FC_SOLVER_INTEGRATE_EVENTS_H

#include "solver/integrate/integrator.h"

// The next panel of a bristle that is free, up to its meeting with the bound; and of one that slips, up to the
// end of its slip.
void fc_free_until_event(FcIntegrator* integrator);
void fc_slip_until_event(FcIntegrator* integrator);

// A free bristle at its bound slips if it is pushed, or surely; one with static friction breaks away. False if it is
// not pushed.
bool fc_begin_slip(FcIntegrator* integrator, bool surely);
// Whether a bristle that slips in the direction n is not pushed now. A push of 0 is decided just after.
bool fc_is_unloading(const FcIntegrator* integrator, FcVector n);
void fc_end_slip(FcIntegrator* integrator);

#endif
