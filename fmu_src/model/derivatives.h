// Derivatives of the contact's stiffness, area and force by the inputs at the start of a scene.
#ifndef FC_MODEL_DERIVATIVES_H
#define FC_MODEL_DERIVATIVES_H

#include <stddef.h>

#include "model/scene.h"

// Derivatives of ln(sigma), ln(A_r) and ln(F_n) with respect to an input [1/m, 1/Pa, 1/N]. With a load they
// include the motion of the separation. All 0 for an open contact.
typedef struct {
    FcContactLogSlope by_d, by_E, by_load;
} FcLogSlopes;
FcLogSlopes fc_log_slopes(const FcScene* scene);

// The derivative of the rate D' of the bound of a scene (model/regime.h) by the input at this offset in
// FcDrive, by a central difference over 1e-5 of the input, or of V_S for V and V_y.
double fc_bound_rate_slope(const FcScene* bound, size_t input);

#endif
