// Sensitivities of outputs and rates along a direction of inputs, tunable parameters, time and states. All are formulas
// except those of F_t_settled and F_y_settled (contact/settled_force.c), and the part of the rate of a bound for a slipping
// bristle, in F_t and F_y by its damping, in der(delta), der(delta_y) and der(Q_f), and the deflection after a jump. These are
// differences.
#ifndef FC_FMI2_SENSITIVITY_H
#define FC_FMI2_SENSITIVITY_H

#include "fmi2/instance.h"
#include "fmi2/variables.h"

// The variable of the reference if it has the causality; otherwise NULL, after logging the reason.
const FcVariableInfo* fc_expect_variable(const FcInstance* instance, FcCall call, fmi2ValueReference vr,
                                         FcCausality causality);

// Whether there are derivatives by the variable in every mode: an input, a tunable parameter or time.
bool fc_has_sensitivity(const FcVariableInfo* info);

// All derivatives along a direction of inputs, parameters and states, at the places of the variables; those of
// F_t_settled and F_y_settled stay 0. So do those of outputs that do not depend on the present values.
FcVariables fc_sensitivities(FcInstance* instance, const FcVariables* along);

// The derivatives of F_t_settled and F_y_settled along the direction, which cost many periods of the vibration.
bool fc_settled_sensitivities(const FcFrictionContact* contact, FcVariables along, FcVector* derivative,
                              FcMessage* message);

#endif
