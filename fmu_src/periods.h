// Many vibration periods for the price of one.
//
// With the inputs held, every period of the vibration is the same affine map of the deflection, so n periods are the
// n-th power of one. With moving inputs the periods differ and are gone through one by one.
#ifndef FC_PERIODS_H
#define FC_PERIODS_H

#include "dahl.h"
#include "message.h"
#include "solver.h"

// What a map must hold for: the deflection delta_0 at the start alone, which is cheaper, or any.
typedef enum { MAP_THIS_START, MAP_ANY_START } MapScope;

// Integrates the problem over [0, duration] from delta_0 [m]. Adds what it spends to *evaluations.
typedef DahlMap (*IntervalMap)(const DahlProblem* problem, const SolverOptions* options, double duration,
                               double delta_0, MapScope scope, double* evaluations);

// More periods than this with moving inputs are refused: they would take minutes.
extern const double PERIODS_WITH_MOVING_INPUTS;

int periods_step(IntervalMap interval, const DahlProblem* problem, const SolverOptions* options, double h,
                 double delta_0, StepResult* result, Message* message);

#endif
