#include "solver/stretches/settled_panel.h"

#include <assert.h>
#include <math.h>

#include "model/constants.h"
#include "solver/budget.h"
#include "solver/stretches/settled_lag.h"

// The smallest transient: two roundings of the force. A transient of 0 would be a divisor.
static const double LEAST_TRANSIENT = 4e-16;
// The integral of x / (x + tau) over a duration is at least this part of the smaller of x and the duration.
// Derived: ln 2.
static const double LEAST_FADING = 0.69;
// The longest layer at the end, over the span, that the poles of the lag may resolve. Half or twice of it
// changes the number of tries, not the accuracy.
static const double LONGEST_LAYER = 0.02;

// The start and the end of the panel.
typedef struct {
    const FcInterval* interval;
    const FcStretch* stretch;
    const FcPlace* at;
    double end;          // s, of the stretch, or the edge of the peak at its end
    double sign;         // of V
    double sigma, limit; // N/m, N, at the start
    double drift;        // 1/s, |rho| at the most
    bool ends_at_event;
} Span;

// The integral of x / (x + tau) over a duration [s]; the duration if x is infinite.
static double fading(double x, double duration) {
    assert(!(x < 0.0) && duration >= 0.0);
    return isfinite(x) ? x * log1p(duration / x) : duration;
}

// |V| [m/s] at the start, and the time [s] since the event from which the panels grow.
static double speed_at_start(const Span* span) { return span->at->rate * span->limit / span->sigma; }
static double time_after(const Span* span, double t) {
    return t - span->stretch->start + span->stretch->back;
}

// Bound of the integral of 1 / |V| [s2/m] over the span, but for a factor of 2: |V| grows about linearly from
// the last event and falls likewise towards the reversal, whose layer is w_b wide.
static double slowness(const Span* span, const FcVelocity* end) {
    const FcStretch* stretch = span->stretch;
    const double duration = span->end - span->at->t;
    double slow = fading(time_after(span, span->at->t), duration) / speed_at_start(span);
    if (span->ends_at_event) {
        slow += (2.0 + log1p(duration / stretch->w_b)) / fabs(end->rate);
    } else if (isfinite(stretch->event)) {
        const double ahead = stretch->event - span->end + stretch->w_b;
        slow += fading(ahead, duration) / fabs(end->V);
    }
    return slow;
}

// Error of the force at the end, over the limit: of second order in the lag.
static double error_at_end(const Span* span, const FcVelocity* end) {
    const FcStretch* stretch = span->stretch;
    const double pace = span->interval->pace.phase + span->drift;
    if (span->ends_at_event) {
        // The formula of the lag there is for a linear V. A curved V changes it by about half of V'' w / V'.
        const double lag = span->drift * stretch->w_b;
        const double bent = fabs(end->curvature / end->rate);
        return lag * (lag + (pace + bent) * stretch->w_b);
    }
    const double relaxes = span->interval->saturation / fabs(end->V); // s
    const double after = time_after(span, span->end);
    const double ahead = isfinite(stretch->event) ? stretch->event - span->end : INFINITY;
    const double changes = pace + 1.0 / fmin(fmin(after, ahead), span->end - span->at->t);
    return span->drift * relaxes * relaxes * changes;
}

// The effect of the error at the end on the interval's end or mean, over the limit. At a reversal the error
// fades.
static double seen_at_end(const Span* span, const FcVelocity* end) {
    const FcInterval* interval = span->interval;
    const double part = span->ends_at_event ? exp(-span->stretch->path_after / interval->saturation) +
                                                  span->stretch->w_b / interval->duration
                                            : 1.0;
    return error_at_end(span, end) * part;
}

static bool is_possible(const Span* span) {
    const FcInterval* interval = span->interval;
    return span->at->rate > 0.0 && !fc_limit_follows_load(interval->scene->friction) &&
           isfinite(interval->saturation) && (!span->ends_at_event || span->stretch->reversal);
}

// Whether the lag is too large to be integrated: its second order at half of its largest value exceeds the
// share.
static bool is_lag_too_large(const Span* span, double too_long, double allowed) {
    const double pace = span->interval->pace.phase + span->drift;
    const double w_b = span->ends_at_event ? span->stretch->w_b : 0.0;
    const double rate = span->at->rate;
    const double length = span->end - span->at->t;
    return length > 0.5 * too_long || w_b > LONGEST_LAYER * length ||
           0.5 * span->drift * (0.5 / (rate * rate) + w_b * w_b * w_b * pace) >
               allowed * span->interval->duration;
}

typedef enum {
    NOT_SETTLED,
    LAG_UNSEEN, // by the mean, or its integral is known
    LAG_SEEN,   // by the mean
} Settled;

// The motion over a span that may be settled.
typedef struct {
    double displacement;         // m
    FcVelocity at_start, at_end; // V
    FcPhase end_phase;
} Course;

// Cheap tests first: they fail on most spans.
static Settled settled(const Span* span, double too_long, Course* course) {
    if (!is_possible(span)) {
        return NOT_SETTLED;
    }
    const FcInterval* interval = span->interval;
    const FcStretch* stretch = span->stretch;
    const FcPlace* at = span->at;
    const FcDrive* drive = &interval->scene->drive;
    const double pace = interval->pace.phase + span->drift;
    const double allowed = FC_SHARE_OF_SETTLED_PANEL * interval->tolerance;
    const double allowed_time = allowed * interval->duration; // s
    const double after = time_after(span, at->t);
    const double coulomb = interval->saturation / fc_stribeck(interval->scene->friction, 0.0); // m
    const double lag_lasts = 2.0 * span->drift * coulomb;
    // With a constant V the integral of the lag is known, and only its second order is missed.
    const bool known = fc_drive_V_is_constant(drive);
    const bool seen = !known && lag_lasts * LEAST_FADING * fc_least(after, span->end - at->t) >
                                    allowed_time * speed_at_start(span);
    if (seen && is_lag_too_large(span, too_long, allowed)) {
        return NOT_SETTLED;
    }
    // The rest of the Stribeck curve counts as a transient.
    const double lag = at->lag + fabs(span->limit / interval->scene->F_C - 1.0);
    const double of_heat = fc_most(1.0, lag); // which goes with the square of the force
    const double allowed_changes =
        allowed_time * at->rate * at->rate / (lag * of_heat + LEAST_TRANSIENT); // 1/s
    if (pace + 1.0 / after > allowed_changes) {
        return NOT_SETTLED;
    }
    const FcPhase start_phase = fc_stretch_phase(stretch, at->t);
    course->at_start = fc_drive_velocity_at_phase(drive, at->t, start_phase);
    if (pace + 1.0 / fc_distance_back(&course->at_start) > allowed_changes) {
        return NOT_SETTLED;
    }
    course->end_phase = fc_stretch_phase(stretch, span->end);
    course->displacement =
        fc_drive_displacement_between(drive, at->t, start_phase, span->end, course->end_phase);
    if (!(lag * exp(-fabs(course->displacement) / interval->saturation) <= allowed * allowed)) {
        return NOT_SETTLED;
    }
    course->at_end = fc_drive_velocity_at_phase(drive, span->end, course->end_phase);
    if (!(seen_at_end(span, &course->at_end) <= allowed)) {
        return NOT_SETTLED;
    }
    if (known || (!seen && lag_lasts * slowness(span, &course->at_end) <= allowed_time)) {
        return LAG_UNSEEN;
    }
    return is_lag_too_large(span, too_long, allowed) ? NOT_SETTLED : LAG_SEEN;
}

// The lag of the force behind the limit at the end, over the limit. The layer is that of the static limit.
static double lag_at_end(const Span* span, const FcCoefficients* end, double rho) {
    return span->ends_at_event ? rho * span->stretch->w_b * 0.5 *
                                     sqrt(FC_PI / fc_stribeck(span->interval->scene->friction, 0.0))
                               : rho / fc_relaxation_rate(end);
}

static FcCoefficients coefficients_at_end(const Span* span, FcPhase end_phase) {
    const FcScene* beyond_peaks = span->interval->beyond_peaks;
    if (span->end < span->stretch->end || !isfinite(span->stretch->event)) {
        return fc_scene_coefficients_at_phase(beyond_peaks, span->end, end_phase);
    }
    FcCoefficients end = span->stretch->at_end;
    end.limit = beyond_peaks->F_C;
    return end;
}

// The integral of the lag and its effect on the drag; false if the lag cannot be integrated.
static bool find_lag(const Span* span, Settled as, const Course* course, const FcCoefficients* end,
                     double rho, double* too_long, FcLag* lag, double* evaluations) {
    *lag = (FcLag){0.0, 0.0};
    if (as == LAG_SEEN) {
        const FcLagSpan lag_span = {.stretch = span->stretch,
                                    .t = span->at->t,
                                    .end = span->end,
                                    .rate = span->at->rate,
                                    .V_at_t = course->at_start,
                                    .V_at_end = course->at_end,
                                    .at_end = *end,
                                    .rho = rho,
                                    .allowed = FC_SHARE_OF_SETTLED_PANEL * span->interval->tolerance *
                                               span->interval->duration};
        return fc_settled_lag(&lag_span, lag, too_long, evaluations);
    }
    if (fc_drive_V_is_constant(&span->interval->scene->drive)) {
        const double V = span->sign * speed_at_start(span);
        const double moves = 1.0 / span->sigma - 1.0 / end->sigma; // m/N
        *lag = (FcLag){span->sign * span->interval->scene->F_C * moves / V, -V * moves};
    }
    return true;
}

static bool follow(const Span* span, double* too_long, FcPanel* panel, double* evaluations) {
    Course course;
    const Settled as = settled(span, *too_long, &course);
    if (as == NOT_SETTLED) {
        return false;
    }
    const FcScene* scene = span->interval->beyond_peaks;
    const FcCoefficients end = coefficients_at_end(span, course.end_phase);
    const double rho = fc_scene_log_rates_at_phase(scene, span->end, course.end_phase).sigma;
    *evaluations += 1.0;
    FcLag lag;
    if (!find_lag(span, as, &course, &end, rho, too_long, &lag, evaluations)) {
        return false;
    }
    const double X = course.displacement;
    const double force = span->sign * scene->F_C;
    const double D = force / span->sigma;
    const double V = span->sign * speed_at_start(span);
    const double relaxes = 1.0 / span->at->rate; // s
    const double lags = D - force / end.sigma;   // m, the decrease of D: the integral of V times the lag
    *panel = (FcPanel){
        .z = fabs(X) / span->interval->saturation,
        .rate = fc_relaxation_rate(&end),
        .sigma = end.sigma,
        .limit = end.limit,
        .displacement = X,
    };
    // The transient is (delta_0 - D) e^-rt, and sigma r D = sigma V.
    panel->map = (FcMap){
        .relaxation = 1.0,
        .offset = force * (1.0 + lag_at_end(span, &end, rho)) / end.sigma,
        .impulse_slope = span->sigma * relaxes,
        .impulse_offset = force * (span->end - span->at->t - relaxes + lag.time),
        .work_slope = force,
        .work_offset = force * (X - D + lags),
        .drag_slope = -V,
        .drag_offset = V * D + force * lag.drag,
        .heat_square = 0.5 * span->sigma,
        .heat_slope = force,
        .heat_offset = force * (X - 1.5 * D + 2.0 * lags),
    };
    return true;
}

// Whether the mean sees the rest of the curve in the peak after a reversal, at this limit [N].
static bool is_curve_seen(const FcStretch* stretch, const FcPlace* at, double limit) {
    const FcInterval* interval = stretch->interval;
    const double lasts = stretch->peaks.tau + (at->t - stretch->start) + stretch->back + 1.0 / at->rate; // s
    return (limit / interval->scene->F_C - 1.0) * lasts >
           FC_SHARE_OF_CURVE_LEFT * interval->tolerance * interval->duration;
}

bool fc_settled_panel(const FcStretch* stretch, const FcPlace* at, double* end, double* too_long,
                      FcPanel* panel, double* evaluations) {
    const FcPeaks* peaks = &stretch->peaks;
    if (*end <= peaks->after || at->t >= peaks->before ||
        (at->t < peaks->after && is_curve_seen(stretch, at, panel->limit))) {
        return false;
    }
    const Span span = {
        .interval = stretch->interval,
        .stretch = stretch,
        .at = at,
        .end = peaks->before,
        .sign = fc_sign(stretch->displacement),
        .sigma = panel->sigma,
        .limit = panel->limit,
        .drift = stretch->interval->pace.log_sigma,
        .ends_at_event = stretch->event <= peaks->before,
    };
    assert(at->t < span.end && span.end <= stretch->end);
    if (!follow(&span, too_long, panel, evaluations)) {
        return false;
    }
    *end = span.end;
    return true;
}
