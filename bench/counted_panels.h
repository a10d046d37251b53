// How many panels of each kind the default takes.
#ifndef COUNTED_PANELS_H
#define COUNTED_PANELS_H

#include "model/scene.h"

enum { RADAU_RULES = 2, GAUSS_RULES = 4 };
static const int RADAU_STAGES[RADAU_RULES] = {5, 9};
static const int GAUSS_NODES[GAUSS_RULES] = {4, 6, 8, 12};

typedef struct {
    double radau[RADAU_RULES];
    double judged[GAUSS_RULES];   // Gauss panels, by their estimates
    double unjudged[GAUSS_RULES]; // bounded beforehand
    double other_evaluations;     // that tell what relaxes, and of closed forms
} PanelCounts;

// Over [0, duration] from the deflection delta_0 [m].
PanelCounts count_panels(const FcScene* scene, double tolerance, double duration, double delta_0);

#endif
