#include "solver/march/points.h"

#include <assert.h>
#include <float.h>
#include <math.h>

#include "solver/panels/nodes.h"

static const FcGaussRule* const RULE[FC_RULES] = {&FC_GAUSS_6, &FC_GAUSS_8, &FC_GAUSS_12};
static const int NODES[FC_RULES] = {6, 8, 12};

// The longest panel of 12 nodes, over 12 and over the time in which the scene moves by 1: planned for three
// digits, 10^(-3 / 24). Chosen empirically: points farther apart show too little of the motion between them.
// Half of it costs panels.
static const double LONGEST_OF_12 = 0.75;

// The number of refused panels in a row, after which the next one is accepted: 2^-22 of the planned length,
// at which rounding limits it. Twice as many would cost time alone.
enum { MOST_TRIES = 25 };

FcPlanner fc_planner(double tolerance) {
    const double of_12 = fmin(LONGEST_OF_12, pow(tolerance, 1.0 / 24.0)); // 10^(-digits / 2 n)
    return (FcPlanner){.longest = {6.0 * of_12 * of_12, 8.0 * of_12 * sqrt(of_12), 12.0 * of_12}};
}

double fc_plan_panel(const FcPlanner* planner, double left, double smooth_time, int* rule) {
    const double panels = ceil(left / (planner->longest[FC_RULES - 1] * smooth_time));
    const double h = left / fmax(1.0, panels);
    *rule = 0;
    while (*rule < FC_RULES - 1 && h > planner->longest[*rule] * smooth_time) {
        ++*rule;
    }
    return h;
}

double fc_panel_end(double t, double h, double end) {
    const double next = t + h;
    return end - next <= 4.0 * DBL_EPSILON * end || !(next > t) ? end : next;
}

bool fc_refine_panel(double* h, int* rule, int tries) {
    if (tries >= MOST_TRIES) {
        return false;
    }
    if (*rule < FC_RULES - 1) {
        ++*rule;
    } else {
        *h *= 0.5;
    }
    return true;
}

static void set_point(const FcScene* scene, double t, int i, FcPoints* at) {
    const FcCoefficients now = fc_scene_coefficients(scene, t);
    at->t[i] = t;
    at->V[i] = now.V;
    at->sigma[i] = now.sigma;
    at->limit[i] = now.limit;
}

void fc_points(const FcScene* scene, double t, double h, int rule, FcPoints* at, double* evaluations) {
    const int n = NODES[rule];
    FcNodeCoefficients nodes;
    at->rule = RULE[rule];
    at->n = n;
    at->count = n + 2;
    at->h = h;
    fc_node_coefficients(scene, t, h, at->rule->node, n, &nodes);
    set_point(scene, t, 0, at);
    for (int i = 0; i < n; i++) {
        at->t[i + 1] = t + (0.5 + at->rule->node[i]) * h;
        at->V[i + 1] = nodes.V[i];
        at->sigma[i + 1] = nodes.sigma[i];
        at->limit[i + 1] = nodes.limit[i];
    }
    set_point(scene, t + h, n + 1, at);
    *evaluations += n + 2;
}

double fc_error_at_points(const FcPoints* at, const double* f) {
    double FC_PAIRED nodes[FC_GAUSS_MOST_NODES];
    for (int i = 0; i < at->n; i++) {
        nodes[i] = f[i + 1];
    }
    return fc_gauss_error(at->rule, at->n, nodes);
}
