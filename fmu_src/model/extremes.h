// fmin and fmax in line: compilers call the library for them, since it says which sign a 0 has. A NaN is passed over, without
// a floating-point exception.
#ifndef FC_MODEL_EXTREMES_H
#define FC_MODEL_EXTREMES_H

#include <math.h>

static inline double fc_min(double a, double b) { return isless(b, a) || a != a ? b : a; }
static inline double fc_max(double a, double b) { return isgreater(b, a) || a != a ? b : a; }

#endif
