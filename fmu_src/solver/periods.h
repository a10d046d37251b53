// Many vibration periods for the price of one.
//
// With the inputs held, every period of the vibration is the same affine map of the deflection, so n periods are the
// n-th power of one. With moving inputs the periods differ and are gone through one by one.
#ifndef FC_SOLVER_PERIODS_H
#define FC_SOLVER_PERIODS_H

#include <stdbool.h>

#include "solver/affine_map.h"
#include "solver/solver.h"

// What a map must hold for: the deflection delta_0 at the start alone, which is cheaper, or any.
typedef enum { FC_MAP_THIS_START, FC_MAP_ANY_START } FcMapScope;

// Integrates the scene over [0, duration] from delta_0 [m]. Adds what it spends to *evaluations.
typedef FcMap (*FcIntervalMap)(const FcScene* scene, const FcSolverOptions* options, double duration,
                               double delta_0, FcMapScope scope, double* evaluations);

// How a step of h [s] >= 0 divides: whole periods of the vibration, and what is left [s]. None without vibration.
typedef struct {
    double count;
    double rest;
} FcPeriods;
FcPeriods fc_periods_in(const FcScene* scene, double h);

// Whether a step of h [s] may be computed and has cost no more evaluations than FC_MOST_EVALUATIONS: false, with
// *message filled, if not, or if it holds too many periods that differ.
bool fc_periods_check(const FcScene* scene, double h, double evaluations, FcMessage* message);

// The step [0, h], h [s] >= 0, from delta_0 [m]. Returns false, with *message filled and *result as it was, where the
// periods or the evaluations are too many.
bool fc_periods_step(FcIntervalMap interval, const FcScene* scene, const FcSolverOptions* options, double h,
                     double delta_0, FcStepResult* result, FcMessage* message);

#endif
