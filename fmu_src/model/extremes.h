// fmin and fmax in line: compilers call the library for them, since it says which sign a 0 has. A NaN is passed over.
#ifndef FC_MODEL_EXTREMES_H
#define FC_MODEL_EXTREMES_H

static inline double fc_least(double a, double b) { return b < a || a != a ? b : a; }
static inline double fc_most(double a, double b) { return b > a || a != a ? b : a; }

#endif
