// Arithmetic for the loops over the nodes of a panel: two numbers side by side, which a processor adds and
// multiplies at once, and e^x.
#ifndef FC_SOLVER_PANEL_ARITHMETIC_H
#define FC_SOLVER_PANEL_ARITHMETIC_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "model/extremes.h"

// Compilers do not find all such pairs by themselves. The first has an even place in an array that is
// FC_PAIRED.
typedef double FcPair __attribute__((vector_size(16), may_alias));

#define FC_PAIRED __attribute__((aligned(16))) // the bytes of two

static inline FcPair fc_pair(const double* first) { return *(const FcPair*)first; }

static inline void fc_pair_put(double* first, FcPair pair) { *(FcPair*)first = pair; }

static inline double fc_pair_sum(FcPair pair) { return pair[0] + pair[1]; }

// The loops of a panel run over constants once these are inlined.
#define FC_INLINE static inline __attribute__((always_inline))

// The least divisor. Chosen: far below any limit and slope, and a quotient of usual numbers by it is finite.
static const double FC_MIN_DIVISOR = 1e-300;

// The product of two arrays of an even number n.
FC_INLINE double fc_dot(int n, const double* a, const double* b) {
    FcPair sum = {0.0, 0.0};
    for (int i = 0; i < n; i += 2) {
        sum += fc_pair(a + i) * fc_pair(b + i);
    }
    return fc_pair_sum(sum);
}

// The largest argument of this series and of those of nodes.c. Derived: their remainders are then below
// 1e-17.
static const double FC_SERIES_RANGE = 0.25;

// By Taylor series, in pairs of terms. A processor adds them side by side, whereas Horner's scheme waits for
// each sum.
static inline double fc_series_exp_less_1(double x) {
    const double x_2 = x * x;
    const double x_4 = x_2 * x_2;
    const double low = (1.0 / 2 + x * (1.0 / 6)) + x_2 * (1.0 / 24 + x * (1.0 / 120));
    const double middle = (1.0 / 720 + x * (1.0 / 5040)) + x_2 * (1.0 / 40320 + x * (1.0 / 362880));
    const double high = (1.0 / 3628800 + x * (1.0 / 39916800)) + x_2 * (1.0 / 479001600);
    return x + x_2 * (low + x_4 * (middle + x_4 * high));
}

// e^x - c for -700 <= x <= 0, c being 0 or 1, each to two roundings: 2^k times the square of the series of half of what is
// left of x without k ln 2, which is taken off in two parts. Without a branch, so that points go side by side.
static inline double fc_exp_less(double x, double c) {
    const double shift = 0x1.8p52; // a sum with it is rounded to a whole number, which its last bits hold
    const double shifted = x * 0x1.71547652b82fep0 + shift;
    const double k = shifted - shift;
    const double half =
        fc_series_exp_less_1(0.5 * ((x - k * 0x1.62e42fefa0000p-1) - k * 0x1.cf79abc9e3b3ap-40));
    uint64_t bits;
    memcpy(&bits, &shifted, sizeof bits);
    bits = (bits + 1023) << 52;
    double power;
    memcpy(&power, &bits, sizeof power);
    return (power - c) + power * (half * (2.0 + half));
}

// Loops over the points of a panel that are there twice where cmake/Options.cmake says so: for any processor, and under a name
// that ends in _avx for one with AVX. Both compute the same numbers, since no product and sum are contracted. Panels take 0.8 to
// 0.9 of the time.
extern bool
    fc_has_avx; // this processor, where they are there twice; set while the library is loaded, and never again

#ifdef FC_WITH_AVX
#define FC_FASTEST(name) (fc_has_avx ? name##_avx : (name))
#define FC_TWICE(name) extern __typeof__(name) name##_avx
#else
#define FC_FASTEST(name) name
#define FC_TWICE(name) extern __typeof__(name) name
#endif

#endif
