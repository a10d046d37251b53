// The linear systems of a collocation: A^-1 of the method with a diagonal added.
#ifndef FC_SOLVER_COLLOCATION_H
#define FC_SOLVER_COLLOCATION_H

#include <stdbool.h>

#include "solver/panel_tables.h"

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

#endif
