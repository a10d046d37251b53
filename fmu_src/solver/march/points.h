// A panel of a function that is a formula in time: a Gauss rule with the panel's ends, and its length.
#ifndef FC_SOLVER_POINTS_H
#define FC_SOLVER_POINTS_H

#include <stdbool.h>

#include "model/scene.h"
#include "solver/panels/gauss_rule.h"

// The rules: of 6, 8 and 12 nodes.
enum { FC_RULES = 3, FC_MOST_POINTS = FC_GAUSS_MOST_NODES + 2 };

// The longest panel of each rule, over the time in which the scene moves by 1: n 10^(-digits / 2 n), since
// the error goes with the length to the power 2 n.
typedef struct {
    double longest[FC_RULES];
} FcPlanner;
FcPlanner fc_planner(double tolerance);

// The length [s] of the next panel of equal ones over `left` [s], of a scene that moves by 1 in smooth_time
// [s], and its rule.
double fc_plan_panel(const FcPlanner* planner, double left, double smooth_time, int* rule);

// The end of a panel [t, t + h] on the way to `end`: `end` itself, if only rounding remains.
double fc_panel_end(double t, double h, double end);

// Refines a panel that is not accurate: more nodes, or half the length. False after too many refusals.
bool fc_refine_panel(double* h, int* rule, int tries);

// The panel [t, t + h]: its start, its nodes, its end.
typedef struct {
    const FcGaussRule* rule;
    int n, count;                 // nodes, points
    double h;                     // s
    double t[FC_MOST_POINTS];     // s
    double V[FC_MOST_POINTS];     // m/s
    double sigma[FC_MOST_POINTS]; // N/m
    double limit[FC_MOST_POINTS]; // N
} FcPoints;
void fc_points(const FcScene* scene, double t, double h, int rule, FcPoints* at, double* evaluations);

// The estimated error of the mean over the panel of a function whose values at the nodes are f.
double fc_error_at_points(const FcPoints* at, const double* f);

#endif
