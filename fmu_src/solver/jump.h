// An input, or a parameter, that jumps between two steps, taken as the limit of a fast ramp. The separation, E and V go along it
// in straight lines from what the last step left to what the next one begins with; what parameters change goes
// geometrically. V does not move the bristle meanwhile. Only its bound does, where it comes to lie below |delta|:
//
//     heat = integral of g |dD|      from where D = |delta| on
//
// With a constant g that is g (|delta| - D), with a constant sigma sigma (delta^2 - D^2) / 2. A bristle of ElasticPlastic that sticks
// breaks away on the ramp, where the static bound comes to |delta|, and follows the kinetic one from there. What is stored by
// a contact that opens is heat if its stiffness is constant, and else goes to the normal drive with the stiffness.
#ifndef FC_SOLVER_JUMP_H
#define FC_SOLVER_JUMP_H

#include "model/regime.h"

// What a step leaves behind, its vibration included.
typedef struct {
    double d;     // m
    double V;     // m/s
    double E;     // Pa
    double limit; // N, F_C or mu F_n
    double ratio; // 1, static over Coulomb friction
    double V_S;   // m/s
    double sigma; // N/m, 0 for no past, or an open contact
} FcPast;

// Of a scene at its start.
FcPast fc_past(const FcScene* scene);

// The state with which the scene starts, fc_reach of the bristle but for a bound that has been lower on the way; *heat [J] is what
// the way there costs. Without a past, sigma has always been what it is.
FcBristle fc_jump(const FcScene* scene, const FcPast* past, FcBristle bristle, double* heat);

#endif
