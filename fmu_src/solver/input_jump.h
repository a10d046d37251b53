// A discontinuity: an input or a parameter that jumps between two steps, as the limit of a fast ramp. The separation, E and V
// are linear along the ramp, from their values at the end of the last step to those at the start of the next
// one. Effects of parameters are geometric. V does not move the bristle meanwhile. Only its bound moves it,
// once the bound falls below |delta|:
//
//     heat = integral of g |dD|      from D = |delta| on
//
// With a constant g that is g (|delta| - D), with a constant sigma sigma (delta^2 - D^2) / 2. A bristle of
// ElasticPlastic that sticks breaks away on the ramp when the static bound falls to |delta|, and follows the
// kinetic bound from there. One that slips sticks on the ramp if V has ceased to push it, the motion after the ramp
// does not push it, and it lies inside its bound; or if it lay inside at the start and the ramp raises the bound.
// fc_project_onto_bound decides at the end. The stored energy of a contact that opens is heat if its stiffness is constant, and else
// goes to the normal drive with the stiffness.
#ifndef FC_SOLVER_INPUT_JUMP_H
#define FC_SOLVER_INPUT_JUMP_H

#include "model/bound.h"

// The inputs and parameters at the end of a step, with its vibration.
typedef struct {
    double d;     // m
    double V;     // m/s
    double V_y;   // m/s
    double E;     // Pa
    double limit; // N, F_C or mu F_n
    double ratio; // 1, static over Coulomb friction
    double V_S;   // m/s
    double sigma; // N/m, 0 for no past, or an open contact
} FcPast;

// The past that a scene leaves at its start.
FcPast fc_past(const FcScene* scene);

// The state at the start of the scene, the time t [s]: fc_project_onto_bound of the bristle, unless the bound was lower on the
// way. *heat [J] is the heat of the ramp. Without a past, sigma has always had its present value.
FcBristle fc_input_jump(const FcScene* scene, double t, const FcPast* past, const FcBristle* from,
                        double* heat);

#endif
