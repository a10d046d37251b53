// Where a function that is known at the points of a panel passes zero.
#ifndef FC_SOLVER_RISE_H
#define FC_SOLVER_RISE_H

#include "solver/panels/radau_error.h"

// The place of a panel, of its length, at which a function that is known at its points rises above 0, and then above `over`; 2 for none.
// One that begins above `over` has to come down first.
double fc_first_rise(const double* f, double over);

#endif
