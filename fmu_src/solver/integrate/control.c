#include "solver/integrate/control.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "model/extremes.h"
#include "model/pi.h"
#include "solver/integrate/tuning.h"

// Derived: polynomials through 9 stages err by rho^-17 for a function that is analytic in a strip of the half width pi / 2,
// with sinh(ln rho) = pi over the panel's length.
static const double ORDER = 17.0;
// Derived: a Legendre tail of 1e-13 of the force is its rounding, so a transient above e^30 tolerances needs no shorter panels.
static const double MAX_BEHIND = 30.0;
// Rounding of a panel's force, over the limit: 900 eps. A smaller error would only shorten panels.
static const double ROUNDING_OF_PANEL = 2e-13;
// The part of a number of panels by which it may exceed a whole one. Chosen: far above rounding, and no panel is longer by more.
static const double SAME_COUNT = 1e-9;

// ln(x) to 0.03 and e^x to 3 %, by the bits of x: enough for a plan, and five times as fast.
static inline double rough_log(double x) {
    int64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return 0.6931471805599453 / 4503599627370496.0 * (double)bits - (1023.0 - 0.043) * 0.6931471805599453;
}

static inline double rough_exp(double x) {
    const double power = fc_max(-700.0, fc_min(700.0, x)) * 1.4426950408889634;
    const int64_t bits = (int64_t)((power + (1023.0 - 0.043)) * 4503599627370496.0);
    double y;
    memcpy(&y, &bits, sizeof y);
    return y;
}

static inline double sinh_of_small(double x) {
    const double y = x * x;
    return x * (1.0 + y * (1.0 / 6 + y * (1.0 / 120 + y * (1.0 / 5040))));
}

// The longest panel in u for a function entire in t, to that part of its size: the strip of sinh(u) is pi / 2.
static double longest_for(double part) {
    assert(part > 0.0);
    return FC_PI / sinh_of_small(fc_max(0.01, -rough_log(part)) / ORDER);
}

void fc_control_start(FcControl* control, const FcPlane* plane, const FcInterval* interval,
                      double transient) {
    assert(interval->duration > 0.0 && interval->tolerance > 0.0);
    const double allowed = fc_allowed_force(interval);
    *control = (FcControl){.plane = plane, .interval = interval};
    control->log_transient = transient > 0.0 ? rough_log(transient / allowed) : -HUGE_VAL;
    control->log_force = interval->force > 0.0 ? rough_log(interval->force / allowed) : 0.0;
    control->span =
        FC_MAX_PHASE * rough_exp(rough_log(interval->tolerance) / ORDER) * fc_smooth_time(&interval->pace);
    control->longest = longest_for(interval->tolerance);
    control->settles = plane->is_one_dimensional && fc_scene_limit_is_constant(interval->scene) &&
                       !fc_has_stribeck_curve(interval->scene->friction);
}

// The panel whose length h in u, times dt/du where that is largest, is the time `span` [s]. Towards the center dt/du is largest
// at the start, which gives y. Away from it dt/du grows as e^h at most: y = h e^h, whose root is l (1 - ln(1 + l) / (2 + l)) with
// l = ln(1 + y) to 2 %. 0.03 is the error of rough_log.
static double length_of_span(const FcTimeMap* in, double x, double span) {
    assert(!(span < 0.0));
    const double y = span / sqrt(in->length * in->length + x * x);
    if (x < 0.0 || y < 1e-3) {
        return y;
    }
    const double l = rough_log(1.0 + y) + 0.03; // y = h e^h
    return l * (1.0 - rough_log(1.0 + l) / (2.0 + l));
}

// In the plane a slip turns as a free bristle relaxes.
static bool is_relaxing(const FcControl* control, FcKind kind) {
    return kind == FC_RELAXES || (kind == FC_SLIPS && !control->plane->is_one_dimensional);
}

// The lag of the force behind sigma and g, over the force, if the bristle relaxes at that rate: their rate, times the time
// of relaxation or of the layer.
static double lag_for(const FcControl* control, const FcTimeMap* in, double rate) {
    assert(!(rate < 0.0) && in->length > 0.0);
    const double pace = control->interval->pace.log_sigma;
    const double relaxation = rate > 1.0 / DBL_MAX ? 1.0 / rate : INFINITY; // s
    return pace > 0.0 ? pace * fc_min(relaxation, in->length) : 0.0;
}

// ln of the transient over the allowed error: the rest of the start's, and behind a reversal that of the force, which
// follows V while the bristle relaxes.
static double transient_at(const FcControl* control, const FcPart* part, const FcPosition* at) {
    const double x = at->t - part->in.center;
    double behind = control->log_transient;
    if (isfinite(part->in.length) && part->in.center >= 0.0 && x >= 0.0) {
        behind = fc_max(behind, control->log_force - 0.5 * at->rate * x);
    }
    return fc_min(behind, MAX_BEHIND);
}

// The part of the force that is not smooth in t, over the force: a transient, the lag behind sigma and g, and the Stribeck
// curve; in the plane all of it, since it turns.
static double part_not_smooth(const FcControl* control, const FcPosition* at, FcKind kind, double behind,
                              double lag, double V_end) {
    const FcFriction* friction = control->interval->scene->friction;
    if (!control->plane->is_one_dimensional || kind == FC_NO_BRISTLE) {
        return control->plane->is_one_dimensional ? 0.0 : 1.0;
    }
    double part = 0.0;
    if (kind == FC_RELAXES) {
        part = behind > 0.0 ? fc_max(lag, rough_exp(fc_min(0.0, behind - control->log_force))) : lag;
    }
    if (fc_has_stribeck_curve(friction) && kind != FC_STICKS) {
        const double V = fc_min(at->rate / at->per_path, V_end);
        part = fc_max(part, (friction->staticRatio - 1.0) * rough_exp(fc_stribeck_log_peak(friction, V)));
    }
    return fc_min(1.0, part);
}

// The length in u up to which a graded panel is smooth, and resolves what is not smooth in t.
static double graded_length(const FcControl* control, const FcPart* part, const FcPosition* at, FcKind kind,
                            double behind, double span, double longest, double h) {
    const FcInterval* interval = control->interval;
    const FcTimeMap* in = &part->in;
    const double x = at->t - in->center;
    assert(h > 0.0 && isfinite(in->length));
    h = fc_min(h, length_of_span(in, x, span));
    h = fc_min(h, fc_min(FC_MAX_LENGTH_U, longest));
    // The end of the panel, and |V| there at the most.
    const double grown = 0.5 * in->length * rough_exp(at->u + h);
    const double x_end = grown - 0.25 * in->length * in->length / grown;
    const double V_end = fc_part_speed(part, x_end);
    const double rate_end = at->per_path * V_end;
    const double acts =
        is_relaxing(control, kind) ? fc_min(1.0, 0.5 * (at->rate + rate_end) * (x_end - x)) : 1.0;
    const double lag = lag_for(control, in, fc_min(at->rate, rate_end));
    const double counts = FC_SAFETY * acts * part_not_smooth(control, at, kind, behind, lag, V_end) *
                          (x_end - x) / (interval->duration * interval->tolerance);
    const double strip = part->strip_ratio * FC_PART_OF_STRIP * FC_PI;
    return counts > 0.0 ? fc_min(h, strip / sinh_of_small(rough_log(1.0 + counts) / ORDER)) : h;
}

double fc_control_length(const FcControl* control, const FcPart* part, const FcPosition* at, FcKind kind,
                         double end, double proposed) {
    const FcTimeMap* in = &part->in;
    const double left = end - at->u;
    const double x = at->t - in->center;
    const bool relaxes = is_relaxing(control, kind);
    assert(left > 0.0);
    const double behind = relaxes ? transient_at(control, part, at) : 0.0;
    const double z = behind > 0.0 ? FC_RELAXATION * rough_exp(behind * (-1.0 / 7.0)) : INFINITY;
    double span = control->span;
    double longest = control->longest;
    if (kind == FC_STICKS && at->per_path > 0.0) {
        span = fc_min(span, fc_time_to_move(at->rate / at->per_path, part->speed_bound.of[1],
                                            FC_MAX_RADII / at->per_path));
    } else if (kind == FC_RELAXES && control->settles && !(behind > 0.0)) {
        // A settled force is constant but for its lag, and the integrals of the constant are exact: the tolerance is that of the lag.
        const double lag = lag_for(control, in, x < 0.0 ? 0.0 : at->rate);
        const double part_of_lag = fc_max(control->interval->tolerance, fc_min(1.0, lag));
        span *= rough_exp(-rough_log(part_of_lag) / ORDER);
        longest = longest_for(control->interval->tolerance / part_of_lag);
    }
    double h = proposed > 0.0 ? fc_min(left, proposed) : left;
    h = isinf(in->length) ? fc_min(h, span)
                          : graded_length(control, part, at, kind, behind, span, longest, h);
    if (z < INFINITY && at->rate > 0.0) { // |V| may grow as e^u
        const double straight = z / at->rate;
        const double grows = isinf(in->length) ? 0.0 : 2.0 * straight / sqrt(in->length * in->length + x * x);
        h = fc_min(h, isinf(in->length) ? straight
                      : grows < 1.0     ? 0.5 * grows / (1.0 + 0.5 * grows)
                                        : 0.5 * rough_log(1.0 + grows));
    }
    const double length = h > 0.0 ? left / ceil(left / h * (1.0 - SAME_COUNT)) : left;
    assert(length >= 0.0 && length <= left);
    return length;
}

double fc_control_error_ratio(const FcControl* control, const FcPart* part, const FcNodes* nodes,
                              const FcPanel* panel, double* of_end) {
    const FcInterval* interval = control->interval;
    const double end = nodes->t[FC_STAGES - 1];
    const double allowed = fc_allowed_force(interval);
    assert(!(panel->end_error < 0.0 || panel->mean_error < 0.0 || nodes->duration < 0.0));
    // An error of the end lives while the bristle does not forget it, and grows with sigma.
    const double length = part->in.length;
    const double forgets =
        panel->rate > 0.0 ? 3.0 / panel->rate + (isfinite(length) ? 2.0 * length : 0.0) : HUGE_VAL;
    const double lives = fc_max(0.0, fc_min(interval->duration - end, forgets)) / interval->duration;
    const double lasts = fc_min(1.0, nodes->duration / interval->duration); // the nodes' times are rounded
    const double end_error = panel->end_error * fc_max(1.0, interval->stiffness / panel->sigma);
    const double mean_error = end_error * lives + panel->mean_error * lasts;
    const double rounding = ROUNDING_OF_PANEL * panel->limit;
    // Heat is the force times the way and the change of the deflection: in a curve, whose coefficients fall late, a short panel
    // of a relaxing bristle may err by a part of its change alone.
    const FcFriction* friction = interval->scene->friction;
    const double V = fc_min(fabs(nodes->speed[FC_STAGES]), fabs(nodes->speed[FC_STAGES - 1]));
    const bool in_curve = fc_may_relax(friction) && fc_stribeck(friction, V) - 1.0 > interval->tolerance;
    const double path = interval->speed * interval->duration / interval->saturation;
    const double whole = allowed * (in_curve ? fc_min(1.0, fc_max(panel->z, path)) : 1.0);
    *of_end = FC_SAFETY * end_error / fc_max(FC_SHARE_OF_END * whole, rounding);
    return FC_SAFETY * mean_error / fc_max(FC_SHARE_OF_MEAN * whole, rounding);
}

double fc_control_reduction(double error_ratio) {
    assert(!(error_ratio < 0.0));
    return isfinite(error_ratio) ? fc_max(0.3, fc_min(0.9, 0.9 * pow(error_ratio, -1.0 / ORDER))) : 0.4;
}

double fc_control_growth(double error_ratio) {
    assert(!(error_ratio < 0.0));
    return error_ratio > 0.0 ? fc_min(2.0, 0.9 * pow(error_ratio, -1.0 / ORDER)) : 2.0;
}
