// The errors of a panel by Radau IIA of 9 stages, from functions that are known at its stages and its start.
#ifndef FC_SOLVER_RADAU_ERROR_H
#define FC_SOLVER_RADAU_ERROR_H

#include "solver/panels/panel.h"
#include "solver/panels/panel_tables.h"

// The number of stages. Chosen empirically: fewer stages need more panels for the same error, more stages a
// larger linear system. The points are the stages, and then the start.
enum { FC_RADAU_STAGES = 9, FC_RADAU_POINTS = FC_RADAU_STAGES + 1 };

// x^6: the rest of an error that is orthogonal to the polynomials of degree 7, weighted with a function whose
// Legendre coefficients fall by x. The exponent is three quarters of 8, since x is an estimate.
FC_INLINE double fc_acting_part(double x) {
    const double x_3 = x * x * x;
    return x_3 * x_3;
}

// The part of the slope that the collocation does not resolve and that acts on the end. at_start is the
// defect at the panel's start, where it is largest. The continuation of the tail counts if at_start happens
// to vanish.
FC_INLINE double fc_radau_unresolved(const double* slope, double z) {
    const double at_start = fc_dot(FC_RADAU_POINTS, FC_RADAU_9.start, slope);
    const FcTail tail = fc_tail_of(FC_RADAU_POINTS, FC_RADAU_9.tail, slope);
    const double acts = fc_least(1.0, z / (z + 2.0 * FC_RADAU_STAGES) + tail.fall);
    return fc_most(fabs(at_start), tail.top * tail.fall) * fc_acting_part(acts);
}

FC_INLINE double fc_radau_quadrature_error(const double* f) {
    const FcTail tail = fc_tail_of(FC_RADAU_POINTS, FC_RADAU_9.tail, f);
    return fc_beyond_rounding(fc_largest(FC_RADAU_STAGES, f), tail.top) * tail.fall *
           fc_acting_part(tail.fall);
}

// The part of a defect that acts on the mean over a panel, since the defect changes sign between the nodes.
// Chosen empirically: half of it lets panels pass that miss the tolerance, twice of it costs panels.
static const double FC_MEAN_OF_DEFECT = 0.1;

// Sets the errors of the end and the mean due to an unresolved part of the slope, which acts as that force [N] times it,
// and to the quadrature. z_first and z_last are the relaxations by the rates at the panel's ends. Relaxation damps a
// defect: at the end by the rate there, inside by the least rate of the panel.
FC_INLINE void fc_radau_set_errors(FcPanel* panel, double z_first, double z_last, double force,
                                   double unresolved, double quadrature) {
    const double whole = fc_most(0.0, panel->z);
    const double z_end = fc_most(0.0, fc_least(z_last, whole));
    const double z_least = fc_most(fc_least(z_end, z_first), fc_least(whole, sqrt(whole)));
    const double weight = FC_RADAU_9.weight[FC_RADAU_STAGES - 1];
    panel->end_error = force * unresolved / (1.0 + z_end);
    panel->mean_error = quadrature + FC_MEAN_OF_DEFECT * force * unresolved *
                                         fc_most(1.0 / (1.0 + z_least), weight / (1.0 + z_end));
}

#endif
