#include "solver/stretches/stretch.h"

#include <assert.h>

#include "solver/panels/panel.h"

double fc_layer(const FcVelocity* at, double per_path) {
    const double r = per_path * fabs(at->V);
    const double r_rate = per_path * fabs(at->rate);
    const double r_curvature = per_path * fabs(at->curvature);
    assert(!(per_path < 0.0));
    const double root = fc_time_to_move(r, r_rate, 1.0);
    const double w = r_curvature * root * root * root <= 6.0 ? root : cbrt(6.0 / r_curvature);
    const double r_third = per_path * fabs(at->third);
    return r_third * w * w * w * w <= 24.0 ? w : sqrt(sqrt(24.0 / r_third));
}

// The width of a dip of |V| that does not reach zero: that of the parabola, or the time to relax by 1 in it.
static double dip_layer(const FcVelocity* at, double per_path) {
    const double curvature = fabs(at->curvature);
    return fmax(sqrt(2.0 * fabs(at->V) / curvature), cbrt(6.0 / (per_path * curvature)));
}

double fc_distance_back(const FcVelocity* at) {
    return fmin(fabs(at->V / at->rate), sqrt(2.0 * fabs(at->V / at->curvature)));
}

double fc_event_layer(const FcScene* scene, bool reversal, double t, FcPhase at_t,
                      const FcCoefficients* near) {
    const FcVelocity at = fc_drive_velocity_at_phase(&scene->drive, t, at_t);
    const double per_path = near->sigma / near->limit;
    return reversal ? fc_layer(&at, per_path) : dip_layer(&at, per_path);
}

FcPhase fc_stretch_phase(const FcStretch* stretch, double t) {
    return t == stretch->start ? stretch->start_phase
           : t == stretch->end ? stretch->end_phase
                               : fc_drive_phase(&stretch->interval->scene->drive, t);
}

double fc_stretch_displacement(const FcStretch* stretch, double t, double end) {
    return t == stretch->start && end == stretch->end
               ? stretch->displacement
               : fc_drive_displacement(&stretch->interval->scene->drive, t, end);
}

// An event farther beyond the interval's end than the end is from t does not shape the panels that begin
// there.
static double horizon(const FcInterval* interval, double t) {
    return interval->duration + (interval->duration - t);
}

// The event ahead ends the next stretch, which begins at t.
static void look_ahead(FcStretches* stretches, double t, FcPhase phase) {
    const FcInterval* interval = stretches->interval;
    const double end = fc_least(stretches->event.time, interval->duration);
    stretches->end_phase =
        stretches->event.time < interval->duration ? stretches->event.phase : stretches->last_phase;
    stretches->displacement =
        fc_drive_displacement_between(&interval->scene->drive, t, phase, end, stretches->end_phase);
}

void fc_stretches_start(FcStretches* stretches, const FcInterval* interval, FcCoefficients start,
                        FcPhase start_phase, FcStretch* stretch) {
    const FcScene* scene = interval->scene;
    stretches->interval = interval;
    stretches->start = start;
    stretches->event = fc_drive_next_event(&scene->drive, 0.0, horizon(interval, 0.0));
    stretches->last_phase = fc_drive_phase(&scene->drive, interval->duration);
    look_ahead(stretches, 0.0, start_phase);
    if (interval->has_peaks) {
        stretches->edge = fc_peak_edge(scene, 0.0);
    }
    *stretch = (FcStretch){.end = 0.0, .end_phase = start_phase, .at_end = start, .reversal = true};
}

bool fc_stretches_next(FcStretches* stretches, double deflection, FcStretch* stretch) {
    const FcInterval* interval = stretches->interval;
    const FcScene* scene = interval->scene;
    const FcStretch before = *stretch;
    const FcDriveEvent event = stretches->event;
    if (!(before.end < interval->duration)) {
        return false;
    }
    stretch->interval = interval;
    stretch->start = before.end;
    stretch->end = fc_least(event.time, interval->duration);
    stretch->event = event.time < horizon(interval, before.end) ? event.time : INFINITY;
    stretch->reversal = event.reversal;
    stretch->starts_at_reversal = before.reversal;
    stretch->start_phase = before.end_phase;
    stretch->end_phase = stretches->end_phase;
    stretch->event_phase = event.phase;
    stretch->displacement = stretches->displacement;
    stretch->path_after = 0.0;
    stretch->per_path = stretches->start.sigma / stretches->start.limit;
    stretch->w_a = before.w_b;
    stretch->w_b = 0.0;
    stretch->back = 0.0;
    stretch->at_start = before.at_end;
    stretch->relaxes = 0.0;
    if (stretch->end < interval->duration) {
        stretches->event = fc_drive_next_event(&scene->drive, event.time, horizon(interval, stretch->end));
        look_ahead(stretches, stretch->end, stretch->end_phase);
        stretch->path_after = fabs(stretches->displacement);
    }
    stretch->peaks = fc_no_peaks(stretch->start, stretch->end);
    if (interval->has_peaks) {
        const FcPeakEdge first = stretches->edge;
        stretches->edge = fc_peak_edge(scene, stretch->end);
        stretch->peaks = fc_peaks(interval, &first, &stretches->edge, deflection, stretch->displacement,
                                  stretch->path_after);
    }
    assert(stretch->start < stretch->end && stretch->end <= interval->duration);
    assert(stretch->end <= stretch->event);
    return true;
}

void fc_stretch_add_layers(FcStretch* stretch) {
    const FcScene* scene = stretch->interval->scene;
    if (stretch->start == 0.0) { // at_start is there
        const FcVelocity now = fc_drive_velocity_at_phase(&scene->drive, 0.0, stretch->start_phase);
        stretch->w_a = fc_layer(&now, stretch->per_path);
        stretch->back = fmax(stretch->w_a, fc_distance_back(&now));
    } else {
        if (!(stretch->w_a > 0.0)) { // not there from the stretch before
            stretch->at_start = fc_scene_coefficients_at_phase(scene, stretch->start, stretch->start_phase);
            stretch->w_a = fc_event_layer(scene, stretch->starts_at_reversal, stretch->start,
                                          stretch->start_phase, &stretch->at_start);
        }
        stretch->back = stretch->w_a;
    }
    if (isfinite(stretch->event)) {
        stretch->at_end = fc_scene_coefficients_at_phase(scene, stretch->end, stretch->end_phase);
        stretch->w_b =
            fc_event_layer(scene, stretch->reversal, stretch->event, stretch->event_phase, &stretch->at_end);
    }
}
