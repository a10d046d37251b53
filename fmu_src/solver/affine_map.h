// The effect of an interval on a bristle's deflection.
//
// The bristle's equation is affine in delta, so any interval is an affine map of the deflection at its start.
// The impulse of the force, its work and its drag over the interval are affine, too. The heat is quadratic.
// Maps compose, and n equal intervals are the n-th power of one map.
#ifndef FC_SOLVER_AFFINE_MAP_H
#define FC_SOLVER_AFFINE_MAP_H

#include <math.h>

#include "solver/solver.h"

typedef struct {
    double relaxation;     // 1      delta_1 = (1 - relaxation) delta_0 + offset
    double offset;         // m
    double impulse_slope;  // N s/m  integral F dt = impulse_slope delta_0 + impulse_offset
    double impulse_offset; // N s
    double work_slope;     // N      integral F V dt = work_slope delta_0 + work_offset
    double work_offset;    // J
    double drag_slope;     // m/s    integral delta' V dt = drag_slope delta_0 + drag_offset
    double drag_offset;    // m2/s
    double heat_square;    // N/m    integral F (V - delta') dt
    double heat_slope;     // N                = heat_square delta_0^2 + heat_slope delta_0 + heat_offset
    double heat_offset;    // J
} FcMap;

// The excess of a factor over 1 that is rounding: some 4500 eps, over the panels of an interval.
#define FC_ROUNDING_OF_FACTOR 1e-12

// Whether the map leads no two starts farther apart, but for rounding. Any does: the equation contracts, and so does a Radau
// method, which is algebraically stable.
static inline bool fc_map_contracts(const FcMap* map) {
    return !(fabs(1.0 - map->relaxation) > 1.0 + FC_ROUNDING_OF_FACTOR);
}

void fc_map_append(FcMap* map, const FcMap* next); // the map, then the next one
FcMap fc_map_power(const FcMap* one, double n);    // n a non-negative whole number

// The map of an interval for one start alone, the one that led to this result.
FcMap fc_map_of_one_start(const FcStepResult* result);

// Takes result->delta over the interval and adds the interval's integrals.
void fc_map_apply(const FcMap* map, FcStepResult* result);
void fc_map_apply_across(const FcMap* map, FcStepResult* result); // to delta_y

// One interval of constant coefficients: exact for any duration h [s] >= 0.
FcMap fc_map_of_constant_scene(const FcCoefficients* at, double h);

#endif
