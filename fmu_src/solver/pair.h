// Two numbers side by side, which a processor adds and multiplies at once. Compilers do not find all such pairs by themselves.
// The first has an even place in an array that is FC_PAIRED.
#ifndef FC_SOLVER_PAIR_H
#define FC_SOLVER_PAIR_H

typedef double FcPair __attribute__((vector_size(16), may_alias));

#define FC_PAIRED __attribute__((aligned(16)))

static inline FcPair fc_pair(const double* first) { return *(const FcPair*)first; }

static inline void fc_pair_put(double* first, FcPair pair) { *(FcPair*)first = pair; }

static inline double fc_pair_sum(FcPair pair) { return pair[0] + pair[1]; }

#endif
