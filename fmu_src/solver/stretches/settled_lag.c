#include "solver/stretches/settled_lag.h"

#include <assert.h>
#include <math.h>

#include "model/constants.h"
#include "solver/panels/gauss_rule.h"

// A pole of L, and its integral over the span.
typedef struct {
    double c;        // 1
    double distance; // s, of the span's end next to it
    double integral; // s
} Pole;

static Pole pole_before(const FcLagSpan* span, double lag) {
    const double distance = span->V_at_t.V / span->V_at_t.rate;
    if (!(distance > 0.0)) {
        return (Pole){.distance = INFINITY};
    }
    const double c = lag * distance;
    return (Pole){c, distance, c * log1p((span->end - span->t) / distance)};
}

static Pole pole_ahead(const FcLagSpan* span, double w) {
    const double T = span->end - span->t;
    if (span->stretch->event <= span->end) {
        const double c = 0.5 * span->rho * w * w;
        return (Pole){c, 0.0, c * (log(2.0 * T / w) + 0.5 * FC_EULER_GAMMA)};
    }
    const double distance = -span->V_at_end.V / span->V_at_end.rate;
    if (!(distance > 0.0)) {
        return (Pole){.distance = INFINITY};
    }
    const double c = span->rho / fc_relaxation_rate(&span->at_end) * distance;
    return (Pole){c, distance, c * log1p(T / distance)};
}

// The part of a feature of that width that the rule misses in a span T. A feature wider than a tenth of T is
// resolved.
static double unresolved(double width, double T) {
    const double x = T / (T + 10.0 * width);
    assert(!(x < 0.0 || x > 1.0));
    return x * x * (x * x);
}

// The rest of L beside an end of the span, without the pole, if V leaves a zero or dip with a V'' as well.
static double error_at_end(const FcVelocity* at, double L, double T) {
    const double width = fc_distance_back(at);
    const double bend = fc_least(1.0, fabs(at->V * at->curvature) / (at->rate * at->rate));
    return isfinite(width) ? fabs(L) * width * bend * unresolved(width, T) : 0.0;
}

// The same ahead of a reversal with the pole c, as wide as V' / V''.
static double error_at_reversal(const FcVelocity* at, double c, double T) {
    const double bend = fabs(at->curvature / at->rate); // 1/s
    return fabs(c) * log1p(bend * T) * unresolved(1.0 / bend, T);
}

// Relative error of 12 nodes; change is half the change of the phase and of ln(sigma). The upper envelope
// that workshop.constants.lag_rule found over stretches of up to 5.4 rad whose ln(sigma) swings by up to 3.
static double error_of_rule(double change) {
    const double x = (17.5 + 0.33 * change * change) / 35.3;
    const double x_3 = x * x * x;
    return x_3 * x_3 * (x_3 * x_3);
}

bool fc_settled_lag(const FcLagSpan* span, FcLag* lag, double* too_long, double* evaluations) {
    enum { N = FC_LAG_NODES };
    assert(span->t < span->end && span->rate > 0.0 && span->allowed >= 0.0);
    const FcStretch* stretch = span->stretch;
    const FcInterval* interval = stretch->interval;
    const FcGaussRule* rule = &FC_GAUSS_12;
    const double T = span->end - span->t;
    const double R = interval->pace.phase + interval->pace.log_sigma;
    const double relaxes = 1.0 / span->rate;                                              // s
    const double at_start = fc_scene_log_rates(interval->scene, span->t).sigma * relaxes; // L
    const FcVelocity* here = &span->V_at_t;
    const FcVelocity* there = &span->V_at_end;
    const Pole before = pole_before(span, at_start);
    // The layer at a reversal at the end.
    const double w = sqrt(2.0 * span->at_end.limit / (span->at_end.sigma * fabs(there->rate)));
    const Pole ahead = pole_ahead(span, w);
    const double of_rule = error_of_rule(0.5 * T * R);
    const double poles = fabs(before.integral) + fabs(ahead.integral);
    // Errors of second order in the time to relax: after the span's start, and in the layer at its end.
    const double after = span->t - stretch->start + stretch->back;
    double error = fabs(at_start) * relaxes * (0.5 + 3.0 * R * after) + error_at_end(here, at_start, T);
    *too_long = T;
    if (stretch->event <= span->end) {
        const double of_layer = 2.0 * fabs(ahead.c) * w * (R + fabs(there->curvature / there->rate));
        error += of_layer + error_at_reversal(there, ahead.c, T);
        if (of_layer > span->allowed) {
            *too_long = 0.0;
        }
    } else {
        error += error_at_end(there, span->rho / fc_relaxation_rate(&span->at_end), T);
    }
    if (!(error + of_rule * poles <= span->allowed)) {
        return false;
    }
    FcNodeCoefficients at;
    fc_node_coefficients(interval->scene, span->t, T, rule->node, N, &at);
    *evaluations += N;
    double slope[N] = {0.0}; // of 1 / sigma over the span
    for (int j = 0; j < N; j++) {
        const double inverse = 1.0 / at.sigma[j];
        for (int i = 0; i < N; i++) {
            slope[i] += FC_GAUSS_12_SLOPE[j][i] * inverse;
        }
    }
    double sum = 0.0;
    double size = 0.0;
    double second = 0.0; // s, mean of |L| / r
    double drag = 0.0;
    for (int i = 0; i < N; i++) {
        const double later = (rule->node[i] + 0.5) * T;
        const double L = -slope[i] * span->at_end.limit / (T * fabs(at.V[i]));
        const double smooth =
            L - before.c / (before.distance + later) - ahead.c / (ahead.distance + (T - later));
        sum += rule->weight[i] * smooth;
        drag += rule->weight[i] * slope[i] * at.V[i];
        size += rule->weight[i] * (fabs(L) + fabs(smooth));
        second += rule->weight[i] * fabs(L) * span->at_end.limit / (at.sigma[i] * fabs(at.V[i]));
    }
    *lag = (FcLag){.time = T * sum + before.integral + ahead.integral - at_start * relaxes, .drag = drag};
    return error + of_rule * (T * size + poles) + 3.0 * R * T * second <= span->allowed;
}
