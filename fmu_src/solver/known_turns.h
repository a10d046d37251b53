// When a bound starts to recede, where that is known but for small windows: with V, d and E held, and
//
//     a bound that moves slowly,   |D'| < |V|  but around the reversals of V: there the bound that V has led to recedes;
//     one that moves fast,         |D'| > |V|  but around the largest and the least D: at the least both bounds recede,
//
// with slopes V' and D'' that do not let the bound turn twice in a window. With x = d less its mean, L = |(ln D)'| by d,
// at the most at the least d, A = L a_d and phi the angle of d,
//
//     D <= D_mean e^(A cos phi),    |D'| <= omega D_mean A e^(A cos phi) |sin phi| <= omega D_mean A e^(A^2/2 or A - 1/2)
//     |D''| <= omega^2 D_mean e^A (A + 3 a_d^2 / d^2)
//
// the first power from ln |sin phi| <= -cos^2 phi / 2, for A below 1 and beyond.
#ifndef FC_SOLVER_KNOWN_TURNS_H
#define FC_SOLVER_KNOWN_TURNS_H

#include <stdbool.h>

#include "solver/bound.h"

// The n-th turn, n = 0, 1, ..., lies within a quarter of a period of middle[n % 2] + (n / 2) cycle and is the only one
// of its bound there; none else counts.
typedef struct {
    bool known;
    int which[2];     // 0: the upper bound, 1: the lower one
    double middle[2]; // s
    double guess[2];  // s, near the turn
    double cycle;     // s
} FcKnownTurns;

// In [0, end], for a bristle that starts between lowest and highest [m], and the motion at the start. Its turns before the
// start may be among them.
FcKnownTurns fc_known_turns(const FcScene* scene, const FcBoundMotion* start, double end, double lowest,
                            double highest);

#endif
