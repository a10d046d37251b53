// Many vibration periods for the price of a few.
//
// With the inputs held, every period of the vibration is the same map of the deflection, affine unless a bound is
// touched:
//
//     delta -> clamp(P delta + Q, lo, hi),  0 <= P <= 1
//
// It rises with delta, so the deflection goes one way from period to period. Until it touches, n periods are the n-th
// power of the affine map, and n is known in closed form; a period that touches ends on lo or hi, whatever its start, so
// that soon all that follow are alike. With moving inputs the periods differ and are gone through one by one.
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

// The map of a period for the starts between lowest and highest [m], from which no bound is touched; there are none where
// lowest > highest.
typedef struct {
    FcMap map;
    double lowest, highest; // m
} FcFreePeriod;

// That of a scene with its inputs held, of the size of the start delta_0 [m]. Adds what it spends to *evaluations.
typedef FcFreePeriod (*FcFreePeriodOf)(const FcScene* scene, const FcSolverOptions* options, double delta_0,
                                       double* evaluations);

// How a law is integrated: interval for one start, free_period for many; NULL where there is no bound, and interval holds
// for any start.
typedef struct {
    FcIntervalMap interval;
    FcFreePeriodOf free_period;
} FcIntegration;

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
bool fc_periods_step(FcIntegration law, const FcScene* scene, const FcSolverOptions* options, double h,
                     double delta_0, FcStepResult* result, FcMessage* message);

// What delta_0 [m] tends to after infinitely many periods of a scene that vibrates with its inputs held; delta_0 where
// that is beyond any number. Adds what it spends to *evaluations.
double fc_periods_settled(FcIntegration law, const FcScene* scene, const FcSolverOptions* options,
                          double delta_0, double* evaluations);

// The mean of F (solver.h) over a period from there on [N].
double fc_periods_settled_force(FcIntegration law, const FcScene* scene, const FcSolverOptions* options,
                                double delta_0, double* evaluations);

#endif
