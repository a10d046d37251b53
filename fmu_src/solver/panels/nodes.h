// V, sigma and g at the nodes of a panel, which take most of the time of a collocation step.
//
// One sine, cosine and exponential at the panel's middle and Taylor series around it give all nodes, several
// times faster than a call for each. Arguments beyond the range of the series are halved until they fit. The
// functions are doubled back by sin 2x, cos 2x and e^2x.
#ifndef FC_SOLVER_NODES_H
#define FC_SOLVER_NODES_H

#include "model/scene.h"
#include "solver/panels/arithmetic.h"

// Of the largest rule: 12 nodes of Gauss. A Radau panel has 10.
enum { FC_MOST_NODES = 12 };

typedef struct {
    double V[FC_MOST_NODES];     // m/s
    double sigma[FC_MOST_NODES]; // N/m
    double limit[FC_MOST_NODES]; // N
} FC_PAIRED FcNodeCoefficients;

// At the times t + (1/2 + node) h, node in [-1/2, 1/2]: those of a Gauss rule, symmetric about 0, or the 10
// of a Radau panel. count is even, so that the loops become vector instructions.
void fc_node_coefficients(const FcScene* scene, double t, double h, const double* node, int count,
                          FcNodeCoefficients* at);

#endif
