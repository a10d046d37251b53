// Motions along a line that are closed forms, from one event of V to the next: Coulomb's law with a constant limit, and
// ElasticPlastic with a constant limit, while the bristle surely slips or, with a constant stiffness, sticks.
#ifndef FC_SOLVER_INTEGRATE_CLOSED_FORM_H
#define FC_SOLVER_INTEGRATE_CLOSED_FORM_H

#include "solver/integrate/integrator.h"

// Takes the present motion to its end or to that of the part; false if it has no closed form.
bool fc_take_closed_form(FcIntegrator* integrator);

#endif
