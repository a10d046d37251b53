#include "judge.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>

static const double FLOOR = 1e-10;          // of the tolerance
static const double CLOCK = 1e-15;          // rad, of the phase of the vibration at a time
static const double FLOOR_OF_FORCE = 1e-11; // over the largest force

// Beyond what is allowed, over the scale; infinite where the step is no number.
static double over(double difference, double allowed, double scale) {
    const double error = fmax(0.0, fabs(difference) - allowed);
    return isnan(difference) ? INFINITY : error == 0.0 ? 0.0 : error / scale;
}

// How long [s] the sign of V is not known around a reversal, since the phase is rounded: the longer the less steep V is there.
static double unknown_sign(const ReferenceScene* s) {
    if (s->V_1 == 0.0) {
        return 0.0;
    }
    const double steep = sqrt(2.0 * fabs(fabs(s->V) - s->V_1) / s->V_1 + 2.0 * CLOCK);
    return 2.0 * CLOCK / (6.283185307179586 * s->f * fmin(1.0, steep));
}

// Where the bristle's force is within the tolerance of a jump of F_t, any force between both sides of it will do.
static double off_force(double F_t, double truth, double other, bool near_jump) {
    const double low = near_jump ? fmin(truth, other) : truth;
    const double high = near_jump ? fmax(truth, other) : truth;
    return F_t - fmin(fmax(F_t, low), high);
}

// How many times as large E or the load is at the start as at the end, if one of them falls.
static double fall(const ReferenceScene* s) {
    const double of_E = s->E / (s->E + s->E_rate * s->h);
    return fmax(1.0, fmax(of_E, s->load / (s->load + s->load_rate * s->h)));
}

Errors judge_errors(const ReferenceScene* s, const ReferenceStep* truth, const FmuStep* step,
                    double tolerance) {
    // the double that holds a soft bristle far longer than its way rounds coarser than the way's share, and so does its bound
    const double rounding = 32.0 * DBL_EPSILON * fall(s) * fmax(fabs(truth->delta), fabs(truth->delta_start));
    const double limit = truth->scale;
    const double swap = 2.0 * limit * fmin(1.0, unknown_sign(s) / s->h);
    const double slipped = fabs(truth->delta - truth->delta_start);
    const double projected = s->initial == START_GIVEN ? fabs(truth->delta_start - s->delta_0) : 0.0;
    const double energy = limit * (truth->path + slipped + projected);
    // so many digits do the sums have, and a start far beyond the bound gives much
    const double digits = 256.0 * DBL_EPSILON * fmax(fabs(truth->work), fabs(truth->heat));
    // as much as V is moved by; a force beyond the limit slips faster than V by so many times
    const double beyond = fmax(1.0, truth->largest / limit);
    const double shift = digits + CLOCK * limit * beyond * beyond * s->V_1 * s->h;
    Errors errors;
    const double near = fmax(tolerance, FLOOR) * limit;
    errors.error[OF_FORCE] =
        over(off_force(step->F_t, truth->F_t, truth->F_t_other, truth->gap <= near), 0.0, limit);
    errors.error[OF_START] =
        over(off_force(step->F_t_start, truth->F_t_start, truth->F_t_start_other, truth->gap_start <= near),
             0.0, limit);
    errors.error[OF_MEAN] =
        over(step->F_t_mean - truth->F_t_mean, rounding * s->sigma_1 / s->h + swap, limit);
    errors.error[OF_WORK] =
        over(step->work - truth->work, rounding * fmax(limit, truth->largest) + shift, energy);
    // a deflection known to the floor of the tolerance leaves so much of the heat unknown
    const double stored =
        FLOOR * fmax(limit, truth->largest) * fmax(fabs(truth->delta), fabs(truth->delta_start));
    errors.error[OF_HEAT] =
        over(step->heat - truth->heat, stored + rounding * fmax(limit, truth->largest) + shift, energy);
    errors.error[OF_DEFLECTION] =
        s->law == LAW_COULOMB ? 0.0 : over((step->delta - truth->delta) * truth->sigma, 0.0, limit);
    return errors;
}

double judge_ratio(const ReferenceScene* s, const Errors* errors, const ReferenceStep* truth,
                   double tolerance, int* which) {
    const double force =
        fmax(fmax(truth->largest, fabs(truth->F_t_start)), fmax(fabs(truth->F_t), fabs(truth->F_t_mean)));
    const double digits = fmax(FLOOR_OF_FORCE, 4.0 * DBL_EPSILON * fall(s));
    // sigma_1 delta' is the difference of two such where the bristle slides
    const double top = fmax(fabs(s->V), fabs(s->V + s->V_rate * s->h)) + s->V_1;
    const double rounding = fmax(digits * force, 64.0 * DBL_EPSILON * s->sigma_1 * top);
    const double granted = fmax(fmax(tolerance, FLOOR), rounding / truth->scale);
    double worst = -1.0;
    for (int k = 0; k < JUDGED; k++) {
        if (errors->error[k] / granted > worst) {
            worst = errors->error[k] / granted;
            *which = k;
        }
    }
    return worst;
}
