// V, sigma and g at the nodes of a short step: what a collocation step spends most of its time on.
//
// Over a short step the phase and ln(sigma) move little, so one sine, cosine and exponential at its middle and Taylor
// series around it give all the nodes, to the rounding of a double and several times faster than a call for each.
#ifndef FC_SOLVER_NODES_H
#define FC_SOLVER_NODES_H

#include "model/scene.h"

enum { FC_NODE_COUNT = 9 };

typedef struct {
    double V[FC_NODE_COUNT];     // m/s
    double sigma[FC_NODE_COUNT]; // N/m
    double limit[FC_NODE_COUNT]; // N
} FcNodeCoefficients;

// At the times t + node h, node in [0, 1].
void fc_node_coefficients(const FcScene* scene, double t, double h, const double node[FC_NODE_COUNT],
                          FcNodeCoefficients* at);

#endif
