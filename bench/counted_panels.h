// How many panels of each kind the default takes.
#ifndef COUNTED_PANELS_H
#define COUNTED_PANELS_H

#include "model/scene.h"

enum { KINDS = 6, RADAU_KINDS = 2 };
static const int NODES[KINDS] = {5, 9, 4, 6, 8, 12}; // Radau, then Gauss

typedef struct {
    double judged[KINDS];     // by their estimates
    double bounded[KINDS];    // beforehand, and not judged; none of Radau's
    double other_evaluations; // that tell what relaxes, and of closed forms
} PanelCounts;

// Over [0, duration] from the deflection delta_0 [m].
PanelCounts count_panels(const FcScene* scene, double tolerance, double duration, double delta_0);

#endif
