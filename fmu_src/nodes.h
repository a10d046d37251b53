// V and sigma at the nodes of a short step: what a collocation step spends most of its time on.
//
// Over a short step the phase and ln(sigma) move little, so one sine, cosine and exponential at its middle and Taylor
// series around it give all the nodes, to the rounding of a double and several times faster than a call for each.
#ifndef FC_NODES_H
#define FC_NODES_H

#include "dahl.h"

enum { NODE_COUNT = 9 };

typedef struct {
    double V[NODE_COUNT];     // m/s
    double sigma[NODE_COUNT]; // N/m
} NodeCoefficients;

// At the times t + node h, node in [0, 1].
void node_coefficients(const DahlProblem* problem, double t, double h, const double node[NODE_COUNT],
                       NodeCoefficients* at);

#endif
