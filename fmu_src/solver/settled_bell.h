// What a bell of the Stribeck curve adds to a bristle that follows its limit through it, in closed form.
//
// Along the path x, dx = |V| dt, the deflection a = |delta| obeys a_x = 1 - a / A, A = g / sigma, and so it follows A with a lag:
//
//     a = A (1 - A_x) but for about A (A A_x)_x
//
// Next to a reversal |V| grows evenly with time, V^2 with the path, and the curve is an exponential of the path:
//
//     w = e^-(V / V_S)^2 = e^-x/l,     l = V_S^2 / (2 |V'|),     -A_x = excess w A_C / l
//
// So the lag is small up to the reversal itself where A is small against l, and what V and g give over the bell are
// integrals of w and w^2 over V, from V at its edge to infinity.
#ifndef FC_SOLVER_SETTLED_BELL_H
#define FC_SOLVER_SETTLED_BELL_H

#include "model/scene.h"

// All for V > 0 and beyond what the Coulomb limit gives.
typedef struct {
    double impulse; // N s
    double work;    // J
    double heat;    // J
    double drag;    // m2/s
    double curve;   // 1, excess w at the edge
    double lag;     // 1, of the force at the edge over its limit there
    double error;   // s, of the impulse over the Coulomb limit, at the most
    double at_edge; // 1, error of the force at the edge over that limit, at the most
} FcSettledBell;

// Whether a bell at a reversal may be followed within an error of the impulse [s] over the Coulomb limit; layer [s] is the
// time in which the bristle relaxes by 1 from the reversal on, whose square over that of V_S / |V'| is A / l.
bool fc_may_follow_in_bell(const FcFriction* friction, const FcVelocity* at_reversal, double layer,
                           double error);

// The bell that goes on from the edge to the side, 1 or -1, where V has that sign and |V| grows, up to reach Stribeck
// velocities. sigma [N/m] there changes by drift [1/s] at the most. error is infinite where it is no such bell.
FcSettledBell fc_settled_bell(const FcScene* scene, const FcVelocity* edge, double side, double sign,
                              double reach, double sigma, double drift);

#endif
