#include "solver/settling.h"

#include <math.h>
#include <stddef.h>

// What may be left of the curve where a settled panel begins, over the tolerance of the mean.
static const double OF_THE_CURVE = 0.05;

// Whether bells that lie apart may be followed at all.
static bool has_bells_apart(const FcMesh* mesh, const FcBells* bells, double start, double end) {
    return bells->after < bells->before && (bells->after > start || bells->before < end) &&
           !mesh->smooth.follows_d_and_E && isfinite(mesh->saturation);
}

void fc_settling_init(FcSettling* settling, const FcScene* scene, const FcScene* beyond_bells,
                      const FcMesh* mesh, const FcStretch* stretch, double end) {
    const FcBells* bells = &stretch->bells;
    const double sign = fc_sign(stretch->displacement);
    settling->scene = scene;
    settling->start = (FcSettledStart){.scene = beyond_bells, .mesh = mesh, .stretch = stretch, .sign = sign};
    settling->end = end;
    settling->too_long = INFINITY;
    settling->start.too_long = &settling->too_long;
    settling->follows_in_first = settling->follows_in_last = false;
    if (!has_bells_apart(mesh, bells, stretch->start, end)) {
        return;
    }
    const double allowed = mesh->allowed * mesh->end; // s
    settling->follows_in_first =
        bells->after > stretch->start &&
        fc_may_follow_in_bell(scene->friction, &bells->at_start, stretch->w_a, allowed);
    if (bells->before < end &&
        fc_may_follow_in_bell(scene->friction, &bells->at_end, stretch->w_b, allowed)) {
        settling->last = fc_settled_bell(scene, &bells->at_end, -1.0, sign, bells->reach,
                                         fc_scene_stiffness(scene, end), mesh->smooth.rate);
        settling->follows_in_last = settling->last.error <= allowed;
    }
}

// Whether the mean sees what is left of the curve in the bell after a reversal, where the limit is that [N].
static bool is_curve_seen(const FcSettling* settling, const FcPlace* at, double limit) {
    const FcStretch* stretch = settling->start.stretch;
    const FcMesh* mesh = settling->start.mesh;
    const double tau = fc_velocity_time_of_change(&stretch->bells.at_start, settling->scene->friction->V_S);
    const double lasts = tau + (at->t - stretch->start) + stretch->back + 1.0 / at->rate; // s
    return (limit / settling->scene->F_C - 1.0) * lasts > OF_THE_CURVE * mesh->allowed * mesh->end;
}

bool fc_settle(FcSettling* settling, const FcPlace* at, FcPanel* panel, double* end, double* evaluations) {
    FcSettledStart* start = &settling->start;
    const FcBells* bells = &start->stretch->bells;
    const bool in_first = at->t < bells->after && is_curve_seen(settling, at, panel->limit);
    if ((in_first && !settling->follows_in_first) || settling->end <= bells->after ||
        at->t >= bells->before) {
        return false;
    }
    start->at = at;
    start->sigma = panel->sigma;
    start->limit = panel->limit;
    start->first = NULL;
    if (in_first) {
        const FcVelocity here = fc_drive_velocity(&settling->scene->drive, at->t);
        settling->first = fc_settled_bell(settling->scene, &here, 1.0, start->sign, bells->reach,
                                          panel->sigma, start->mesh->smooth.rate);
        start->first = &settling->first;
    }
    if (settling->follows_in_last) {
        start->last = &settling->last;
        start->end = *end = settling->end;
        if (fc_settled_panel(start, panel, evaluations)) {
            return true;
        }
        start->last = NULL;
    }
    start->end = *end = bells->before;
    return fc_settled_panel(start, panel, evaluations);
}
