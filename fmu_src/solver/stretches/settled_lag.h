// The mean of the lag behind a limit that stands still while sigma moves, as far as it is of first order.
//
// In the force the bristle lags by L = rho / r times the limit g, with rho = sigma' / sigma and r = sigma |V| / g, so
//
//     L = -(1 / sigma)' g / |V|
//
// which has a pole c / distance at every reversal, cut off by the layer there. With the poles of the start and of the end
// taken out, what is left is smooth, and a Gauss rule of 12 nodes integrates it; (1 / sigma)' is the slope of the polynomial
// through them. Up to the reversal ahead, whose layer is w wide, the bristle lags by
//
//     c e^x^2 integral_x^inf e^-s^2 ds 2 / w,    x = distance / w;      the integral is c (ln(2 T / w) + gamma / 2)
#ifndef FC_SOLVER_SETTLED_LAG_H
#define FC_SOLVER_SETTLED_LAG_H

#include "solver/stretches/stretch.h"

// Of that rule. By hand: the largest there is (gauss_rule.h); error_of_rule is fitted for it.
enum { FC_LAG_NODES = 12 };

// Where the bristle follows its limit, from here to there, the stretch's end or before.
typedef struct {
    const FcStretch* stretch;
    double t, end; // s
    double rate;   // 1/s, r at the start
    FcVelocity V_at_t, V_at_end;
    FcCoefficients at_end;
    double rho;     // 1/s, at the end
    double allowed; // s, error of the integral
} FcLagSpan;

typedef struct {
    double time; // s, integral of L, less that of a transient which starts without it
    double drag; // m2/(N s), integral of V (1 / sigma)'
} FcLag;

// false where an error may be too large, with *too_long [s] the span, or 0 where no shorter one up to that end will do. Adds
// to *evaluations what it takes.
bool fc_settled_lag(const FcLagSpan* span, FcLag* lag, double* too_long, double* evaluations);

#endif
