#include "solver/periods/segments.h"

#include <assert.h>
#include <stddef.h>

#include "model/bound.h"
#include "model/extremes.h"
#include "solver/integrate/march.h"

void fc_segments_start(FcSegments* segments, const FcScene* scene, double whole) {
    assert(whole >= 0.0);
    segments->of = scene;
    segments->whole = whole;
    segments->t = 0.0;
    segments->scene = NULL;
}

bool fc_next_segment(FcSegments* segments) {
    const bool first = segments->scene == NULL;
    if (!first && !(segments->t < segments->whole)) {
        return false;
    }
    segments->scene = segments->of;
    segments->h = segments->whole;
    if (first && !fc_scene_has_segments(segments->of)) {
        segments->t = segments->whole;
        return true;
    }
    segments->own = first ? *segments->of : fc_scene_from(segments->of, segments->t);
    segments->scene = &segments->own;
    const double rest = segments->whole - segments->t;
    segments->h = fc_scene_segment(&segments->own, rest, segments->whole);
    const double next = segments->t + segments->h;
    const bool is_last = !(segments->h < rest && next > segments->t);
    segments->h = is_last ? rest : segments->h;
    segments->t = is_last ? segments->whole : next;
    assert(segments->h >= 0.0 && segments->t <= segments->whole);
    return true;
}

void fc_open_contact_step(FcStepResult* result) {
    result->lost += result->delta;
    result->lost_y += result->delta_y;
    result->delta = result->delta_y = 0.0;
    result->state = FC_FREE;
}

void fc_project_result(const FcScene* scene, FcStepResult* result) {
    const FcBristle bristle = fc_bristle_of(result);
    const FcBristle reached = fc_project_onto_bound(scene, bristle);
    const double size = fc_size(bristle);
    const double D = fc_size(reached);
    if (D < size) {
        const FcDrive* drive = &scene->drive;
        result->heat += fc_drop_heat(fc_scene_contact(scene, 0.0).sigma, size, D);
        result->drag += (reached.delta - bristle.delta) * fc_drive_V(drive, 0.0) +
                        (reached.delta_y - bristle.delta_y) * fc_drive_V_y(drive, 0.0);
    }
    result->delta = reached.delta;
    result->delta_y = reached.delta_y;
    result->state = reached.state;
}

// A limit that falls by decades is too small at the step's end for the scale of the whole step: a segment has
// its own.
static FcSolverOptions options_of_segment(const FcSolverOptions* options, const FcSegments* segments) {
    FcSolverOptions own = *options;
    assert(segments->h <= segments->whole);
    const double limit = segments->h < segments->whole && options->damping > 0.0
                             ? fc_scene_smallest_limit(segments->scene, segments->h)
                             : 0.0;
    if (limit > 0.0) {
        own.force = fc_min(own.force, fc_force_beside_damping(options->largest, options->damping, limit));
    }
    return own;
}

void fc_march_segments(const FcScene* scene, const FcSolverOptions* options, double duration,
                       FcStepResult* total) {
    assert(duration >= 0.0 && options->tolerance > 0.0);
    FcSegments segments;
    fc_segments_start(&segments, scene, duration);
    while (total->evaluations <= FC_MAX_EVALUATIONS && fc_next_segment(&segments)) {
        if (fc_scene_is_separated(segments.scene)) {
            fc_open_contact_step(total);
        } else {
            const FcSolverOptions own = options_of_segment(options, &segments);
            fc_march_step(segments.scene, &own, segments.h, total);
        }
    }
}
