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
    settling->scene = scene;
    settling->beyond_bells = beyond_bells;
    settling->mesh = mesh;
    settling->stretch = stretch;
    settling->sign = fc_sign(stretch->displacement);
    settling->end = end;
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
        settling->last = fc_settled_bell(scene, &bells->at_end, -1.0, settling->sign, bells->reach,
                                         fc_scene_stiffness(scene, end), mesh->smooth.rate);
        settling->follows_in_last = settling->last.error <= allowed;
    }
}

// Whether the mean sees what is left of the curve in the bell after a reversal, where the limit is that [N].
static bool is_curve_seen(const FcSettling* settling, const FcPlace* at, double limit) {
    const FcStretch* stretch = settling->stretch;
    const FcMesh* mesh = settling->mesh;
    const double tau = fc_velocity_time_of_change(&stretch->bells.at_start, settling->scene->friction->V_S);
    const double lasts = tau + (at->t - stretch->start) + stretch->back + 1.0 / at->rate; // s
    return (limit / settling->scene->F_C - 1.0) * lasts > OF_THE_CURVE * mesh->allowed * mesh->end;
}

bool fc_settle(const FcSettling* settling, const FcPlace* at, FcPanel* panel, double* end) {
    const FcBells* bells = &settling->stretch->bells;
    const bool in_first = at->t < bells->after && is_curve_seen(settling, at, panel->limit);
    if ((in_first && !settling->follows_in_first) || settling->end <= bells->after ||
        at->t >= bells->before) {
        return false;
    }
    FcSettledStart from = {.scene = settling->beyond_bells,
                           .mesh = settling->mesh,
                           .stretch = settling->stretch,
                           .at = at,
                           .sign = settling->sign,
                           .sigma = panel->sigma,
                           .limit = panel->limit};
    FcSettledBell first;
    if (in_first) {
        const FcVelocity here = fc_drive_velocity(&settling->scene->drive, at->t);
        first = fc_settled_bell(settling->scene, &here, 1.0, settling->sign, bells->reach, panel->sigma,
                                settling->mesh->smooth.rate);
        from.first = &first;
    }
    if (settling->follows_in_last) {
        from.last = &settling->last;
        from.end = *end = settling->end;
        if (fc_settled_panel(&from, panel)) {
            return true;
        }
        from.last = NULL;
    }
    from.end = *end = bells->before;
    return fc_settled_panel(&from, panel);
}
