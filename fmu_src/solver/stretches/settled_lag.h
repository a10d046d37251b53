// The mean of the first order of the lag behind a limit that stands still while sigma moves.
//
// In the force the bristle lags by L = rho / r times the limit g, with rho = sigma' / sigma and r = sigma |V|
// / g, so
//
//     L = -(1 / sigma)' g / |V|
//
// which has a pole c / distance at every reversal, cut off by the layer there. Without the poles of the start
// and of the end the rest is smooth, and a Gauss rule of 12 nodes integrates it. (1 / sigma)' is the slope of
// the polynomial through the nodes. Up to the reversal ahead, whose layer is w wide, the bristle lags by
//
//     c e^x^2 integral_x^inf e^-s^2 ds 2 / w,    x = distance / w;      the integral is c (ln(2 T / w) + gamma / 2)
#ifndef FC_SOLVER_SETTLED_LAG_H
#define FC_SOLVER_SETTLED_LAG_H

#include "solver/stretches/stretch.h"

// The nodes of that rule: the largest one (gauss_rule.h), for which error_of_rule is fitted.
enum { FC_LAG_NODES = 12 };

// The span over which the bristle follows its limit, up to the stretch's end or less.
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
    double time; // s, integral of L, less that of the transient of a start without lag
    double drag; // m2/(N s), integral of V (1 / sigma)'
} FcLag;

// False if an error may be too large. Then *too_long [s] is the span, or 0 if no shorter span up to that end
// is accurate. Adds its evaluations to *evaluations.
bool fc_settled_lag(const FcLagSpan* span, FcLag* lag, double* too_long, double* evaluations);

#endif
