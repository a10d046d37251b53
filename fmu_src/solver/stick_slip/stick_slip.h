// A bounded bristle over an interval, event by event.
//
// While |delta| < D it moves as if there were no bound: it sticks in ElasticPlastic, delta' = V (Prandtl, Jenkins), and
// relaxes in Dahl and LuGre. From the moment it meets +D or -D it slips along that, until the bound recedes faster than it
// would move. From turning point to turning point (turning_points.h) it meets each bound at most once, and does so if it
// would be beyond at the end; the moment is the root of how far it would be beyond.
//
// Over any interval delta becomes clamp(P delta + Q, lo, hi), and such maps compose. With held inputs a period is one of
// them, in ElasticPlastic with P = 1:
//
//     delta  hi  - - - - - - - - - - - .--.--.      a small mean velocity V makes the bristle creep by V / f a period,
//                              .  ' '               for a number of periods that is known at once; the period that
//                     .  ' '                        touches the bound ends on hi, and so do all that follow
//         delta_0 ' '
#ifndef FC_SOLVER_STICK_SLIP_H
#define FC_SOLVER_STICK_SLIP_H

#include "solver/methods/periods.h"

// An FcIntervalMap for the start delta_0 [m] alone, whatever the scope. A bristle that starts beyond the bound is taken
// onto it at once, and what it loses, sigma (delta_0^2 - D^2) / 2, is heat. The error of force, mean and work is within
// options->tolerance, times fc_scene_force_scale, and that of rounding where D is constant. It breaks off where
// *evaluations exceed FC_MOST_EVALUATIONS.
FcMap fc_stick_slip_interval(const FcScene* scene, const FcSolverOptions* options, double duration,
                             double delta_0, FcMapScope scope, double* evaluations);

// An FcFreePeriodOf.
FcFreePeriod fc_stick_slip_free_period(const FcScene* scene, const FcSolverOptions* options, double delta_0,
                                       double* evaluations);

// delta [m], taken onto the bound at the start of the scene where it lies beyond; *loss is what it loses by that [J].
double fc_stick_slip_reached(const FcScene* scene, double delta, double* loss);

// delta [m] at the end h [s] of a step of the scene, on the bound there where it lies on it but for the rounding of an input
// that has fallen by decades: whether it slips then decides delta'.
double fc_stick_slip_end(const FcScene* scene, double h, double delta);

// Whether a bristle that starts between the bounds may touch one in the step: one that relaxes does not while they stand
// still or recede.
bool fc_stick_slip_may_touch(const FcScene* scene);

#endif
