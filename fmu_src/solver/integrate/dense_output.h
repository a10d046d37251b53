// The dense output of a panel, the polynomial through its points, and its first upcrossing of 0.
#ifndef FC_SOLVER_INTEGRATE_DENSE_OUTPUT_H
#define FC_SOLVER_INTEGRATE_DENSE_OUTPUT_H

#include "solver/panel/arithmetic.h"
#include "solver/panel/panel_tables.h"

// The place in a panel, over its length, at which a function that is known at its points rises above 0, and
// then above `over` >= 0; 2 if there is none. A function that begins above `over` must fall first.
double fc_first_upcrossing(const double at_points[FC_POINTS], double over);
FC_TWICE(fc_first_upcrossing);

#endif
