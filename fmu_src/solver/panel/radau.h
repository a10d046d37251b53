// Radau IIA of 9 stages: order 17, L-stable, stiffly accurate. More stages need a larger linear system, fewer need more panels
// for the same error. The linear systems of a panel, and its errors from functions that are known at its points.
#ifndef FC_SOLVER_PANEL_RADAU_H
#define FC_SOLVER_PANEL_RADAU_H

#include <assert.h>
#include <math.h>
#include <stdbool.h>

#include "solver/panel/panel_tables.h"

// The linear systems: A^-1 of the method with a diagonal added.
// The lengths of the loops below are known only once the outer one is unrolled; then they become vector
// instructions.
#ifdef FC_NO_UNROLLING
#define FC_UNROLL
#elif defined __clang__
#define FC_UNROLL _Pragma("unroll")
#else
#define FC_UNROLL _Pragma("GCC unroll 16")
#endif

// The matrix, and up to three right-hand sides, which become the solutions: the first in column 9, a pair in columns
// 10 and 11.
enum { FC_FIRST = FC_STAGES, FC_PAIR = FC_STAGES + 1, FC_COLUMNS = FC_STAGES + 3 };
typedef double FcSystem[FC_STAGES][FC_COLUMNS] FC_PAIRED;

// A^-1 + diag(z), without right-hand sides.
FC_INLINE void fc_collocation_begin(FcSystem row, const double* z) {
    for (int i = 0; i < FC_STAGES; i++) {
        for (int j = 0; j < FC_STAGES; j++) {
            row[i][j] = FC_RADAU.inverse[i][j];
        }
        row[i][i] += z[i];
        row[i][FC_FIRST] = 0.0; // which pairs with column 8
    }
}

// Gaussian elimination without pivoting.
FC_INLINE void fc_collocation_solve(FcSystem row, bool has_first, bool has_pair) {
    const int columns = has_pair ? FC_COLUMNS : FC_PAIR;
    FC_UNROLL
    for (int k = 0; k < FC_STAGES; k++) {
        const double pivot = 1.0 / row[k][k];
        FC_UNROLL
        for (int i = k + 1; i < FC_STAGES; i++) {
            const double factor = row[i][k] * pivot;
            FC_UNROLL
            for (int j = (k + 1) & ~1; j < columns; j += 2) {
                fc_pair_put(&row[i][j], fc_pair(&row[i][j]) - factor * fc_pair(&row[k][j]));
            }
        }
        row[k][k] = pivot;
    }
    FC_UNROLL
    for (int k = FC_STAGES - 1; k >= 0; k--) {
        if (has_pair) {
            const FcPair solved = row[k][k] * fc_pair(&row[k][FC_PAIR]);
            fc_pair_put(&row[k][FC_PAIR], solved);
            FC_UNROLL
            for (int i = 0; i < k; i++) {
                fc_pair_put(&row[i][FC_PAIR], fc_pair(&row[i][FC_PAIR]) - row[i][k] * solved);
            }
        }
        if (has_first) {
            const double solved = row[k][k] * row[k][FC_FIRST];
            row[k][FC_FIRST] = solved;
            FC_UNROLL
            for (int i = 0; i < k; i++) {
                row[i][FC_FIRST] -= row[i][k] * solved;
            }
        }
    }
}

// The errors.
// The part of a function that the polynomial through the stages does not resolve, by its Legendre coefficients: the larger
// of the degrees 7 and 8, and by what they fall from degree to degree. A fall is small by chance in one place, so the least
// steep of three counts: to degree 9, from 5 and 6 to 7 and 8, and from 1 and 2 to 5 and 6. At the stages P_9 is P_8, at
// the panel's start -P_8. So degree 9 is half of at_start, the function there less the polynomial.
typedef struct {
    double top;
    double fall;
} FcTail;

FC_INLINE double fc_larger(FcPair pair) { return fc_max(fabs(pair[0]), fabs(pair[1])); }

// a / b, at the most 1. No quotient overflows.
FC_INLINE double fc_fall(double a, double b) {
    const double over = b + FC_MIN_DIVISOR;
    return fc_min(a, over) / over;
}

FC_INLINE FcTail fc_tail_of(const double* f, double at_start) {
    FcPair high = {0.0, 0.0};
    FcPair middle = {0.0, 0.0};
    FcPair low = {0.0, 0.0};
    for (int j = 0; j < FC_STAGES; j++) {
        high += f[j] * fc_pair(FC_RADAU.tail[j]);
        middle += f[j] * fc_pair(FC_RADAU.tail[j] + 2);
        low += f[j] * fc_pair(FC_RADAU.tail[j] + 4);
    }
    const double top = fc_larger(high);
    const double before = fc_larger(middle);
    const double square = fc_max(fc_max(fc_fall(0.5 * fabs(at_start), top), fc_fall(top, before)),
                                 sqrt(fc_fall(before, fc_larger(low))));
    return (FcTail){top, sqrt(square)};
}

// x^6: the rest of an error that is orthogonal to the polynomials of degree 7, weighted with a function whose
// Legendre coefficients fall by x. The exponent is three quarters of 8, since x is an estimate.
FC_INLINE double fc_acting_part(double x) {
    assert(!(x > 1.0));
    const double x_3 = x * x * x;
    return x_3 * x_3;
}

// The part of the slope that the collocation does not resolve and that acts on the end. at_start is the
// defect at the panel's start, where it is largest. The continuation of the tail counts if at_start happens
// to vanish.
FC_INLINE double fc_radau_unresolved(const double* slope, double z) {
    const double at_start = fc_dot(FC_POINTS, FC_RADAU.start, slope);
    const FcTail tail = fc_tail_of(slope, 0.0); // at_start counts itself, and may be rounding
    const double acts = fc_min(1.0, z / (z + 2.0 * FC_STAGES) + tail.fall);
    return fc_max(fabs(at_start), tail.top * tail.fall) * fc_acting_part(acts);
}

// The tail of a function that is rounded, over it. Derived: some 130 eps, by the sums over the points.
static const double FC_ROUNDING_OF_TAIL = 3e-14;

// The error of the integral of f over the panel, which is 1 long. A tail within the rounding of f counts as none.
FC_INLINE double fc_radau_quadrature_error(const double* f) {
    double largest = 0.0;
    for (int i = 0; i < FC_STAGES; i++) {
        largest = fc_max(largest, fabs(f[i]));
    }
    const FcTail tail = fc_tail_of(f, fc_dot(FC_POINTS, FC_RADAU.start, f));
    return fc_max(0.0, tail.top - FC_ROUNDING_OF_TAIL * largest) * tail.fall * fc_acting_part(tail.fall);
}

#endif
