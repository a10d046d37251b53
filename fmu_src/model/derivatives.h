// How the outputs of a scene change at its start: in time, and with its inputs.
#ifndef FC_MODEL_DERIVATIVES_H
#define FC_MODEL_DERIVATIVES_H

#include <stddef.h>

#include "model/scene.h"

// Time derivative of F_t [N/s] of a bristle deflected by delta [m], the inputs moving as the drive says.
double fc_force_rate(const FcScene* scene, double delta);

// Derivatives of ln(sigma), ln(A_r) and ln(F_n) with respect to an input, the separation following where it floats: per m,
// Pa and N.
typedef struct {
    FcContactLogSlope by_d, by_E, by_load;
} FcLogSlopes;
FcLogSlopes fc_log_slopes(const FcScene* scene);

// Partial derivatives with respect to one input, at the given deflection and rates of the inputs.
typedef struct {
    double F_t;
    double F_n;
    double sigma;
    double A_r;
} FcSlopes;

typedef struct {
    FcSlopes by_V;
    FcSlopes by_d;
    FcSlopes by_E;
    FcSlopes by_load;
} FcGradient;
FcGradient fc_gradient(const FcScene* scene, double delta);

// The derivative of the bound's rate D' at the start of the scene by the input at this offset in FcDrive, by a central
// difference over 1e-5 of the input, or of V_S for V.
double fc_bound_rate_slope(const FcScene* scene, size_t input);

#endif
