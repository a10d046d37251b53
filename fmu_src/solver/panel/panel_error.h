// The error estimates of a panel: of its force, work and heat.
#ifndef FC_SOLVER_PANEL_PANEL_ERROR_H
#define FC_SOLVER_PANEL_PANEL_ERROR_H

#include <assert.h>

#include "solver/integrate/tuning.h"
#include "solver/panel/panel.h"
#include "solver/panel/radau.h"

// The error of the mean over the panel of a function of its points.
FC_INLINE double fc_error_of_mean(const FcNodes* nodes, const double* f) {
    double FC_PAIRED weighted[FC_POINTS];
    for (int i = 0; i < FC_POINTS; i++) {
        weighted[i] = f[i] * nodes->tau[i] / nodes->duration;
    }
    return fc_radau_quadrature_error(weighted);
}

// The error of the mean over the panel of a force [N], its work over the largest speed [m/s], and its heat, together: one
// function for all three, (F - held) (1 + v + (F + held) |v| / g), v = V / speed. The integrals of the constant force
// `held` [N] are exact. A stuck bristle makes no heat.
FC_INLINE double fc_error_of_force(const FcNodes* nodes, double speed, double held, bool heats,
                                   const double* F, const double* V) {
    double FC_PAIRED f[FC_POINTS];
    const double over_duration = 1.0 / nodes->duration;
    const double over_speed = 1.0 / speed;
    for (int i = 0; i < FC_POINTS; i++) {
        const double v = V[i] * over_speed;
        const double over_limit = 1.0 / fc_max(nodes->limit[i], FC_MIN_DIVISOR);
        const double heat = heats ? (F[i] + held) * over_limit * fabs(v) : 0.0;
        f[i] = (F[i] - held) * (1.0 + v + heat) * (nodes->tau[i] * over_duration);
    }
    return fc_radau_quadrature_error(f);
}

// Sets the errors of the end and the mean due to an unresolved part of the slope, which acts as that force [N] times it,
// and to the quadrature. z_first and z_last are the relaxations by the rates at the panel's ends. Relaxation damps a defect: at the
// end by the rate there, inside by the least rate of the panel.
FC_INLINE void fc_set_errors(FcPanel* panel, double z_first, double z_last, double force, double unresolved,
                             double quadrature) {
    assert(!(force < 0.0 || unresolved < 0.0 || quadrature < 0.0));
    const double whole = fc_max(0.0, panel->z);
    const double z_end = fc_max(0.0, fc_min(z_last, whole));
    const double z_least = fc_max(fc_min(z_end, z_first), fc_min(whole, sqrt(whole)));
    const double weight = FC_RADAU.weight[FC_STAGES - 1];
    panel->end_error = force * unresolved / (1.0 + z_end);
    panel->mean_error = quadrature + FC_MEAN_OF_DEFECT * force * unresolved *
                                         fc_max(1.0 / (1.0 + z_least), weight / (1.0 + z_end));
}

#endif
