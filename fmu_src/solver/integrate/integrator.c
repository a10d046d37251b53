#include "solver/integrate/integrator.h"

#include <assert.h>
#include <float.h>
#include <math.h>

#include "model/extremes.h"

enum { START = FC_STAGES, LAST = FC_STAGES - 1 };

// What costs more than evaluations with a modulus that stands, in these: the minima of |V| in the plane, and the factors of a
// modulus that moves and of Newton's method for a slip in the plane. Chosen empirically: with them the time of an
// evaluation differs by a factor of 2 between scenes.
static const double OF_MINIMA = 10.0;
static const double OF_A_MODULUS = 4.0;
static const double OF_NEWTON = 2.0;

// What is left of a part after a panel, over the panel, that is rounding: 4500 eps, as of the parts (time_map.c).
static const double ROUNDING_OF_END = 1e-12;

FcKind fc_kind(const FcIntegrator* integrator) {
    const FcFriction* friction = integrator->interval->scene->friction;
    return !fc_has_bristle(friction) || integrator->bristle.is_rigid ? FC_NO_BRISTLE
           : integrator->bristle.state == FC_SLIPPING                ? FC_SLIPS
           : fc_may_stick(friction)                                  ? FC_STICKS
                                                                     : FC_RELAXES;
}

FcVector fc_integrator_delta(const FcIntegrator* integrator) {
    return (FcVector){integrator->along.offset, integrator->across_map.offset};
}

void fc_set_delta(FcIntegrator* integrator, FcVector delta) {
    integrator->along.relaxation = integrator->across_map.relaxation = 1.0;
    integrator->along.offset = delta.x;
    integrator->across_map.offset = delta.y;
}

FcPlaneCoefficients fc_coefficients_at(const FcIntegrator* integrator, double t) {
    return fc_plane_coefficients(integrator->plane, t,
                                 fc_drive_phase(&integrator->interval->scene->drive, t));
}

double fc_largest_push(const FcIntegrator* integrator) {
    const FcInterval* interval = integrator->interval;
    return interval->speed + interval->saturation * interval->pace.log_sigma;
}

// What all panels begin with.
static FcPanelStart first_from(const FcIntegrator* integrator) {
    const FcScene* scene = integrator->interval->scene;
    const bool limit_stands = fc_scene_limit_is_constant(scene);
    const bool has_constant_coefficients = limit_stands && fc_scene_stiffness_is_constant(scene);
    const bool has_curve = fc_has_stribeck_curve(scene->friction);
    return (FcPanelStart){.push = fc_largest_push(integrator) + DBL_MIN,
                          .has_constant_coefficients =
                              has_constant_coefficients && !has_curve && scene->friction->sigma_1 == 0.0,
                          .limit_stands =
                              limit_stands && (!has_curve || fc_drive_V_is_constant(&scene->drive))};
}

static void reach(FcIntegrator* integrator, double u, double t, const FcPlaneCoefficients* at) {
    const double per_path = at->sigma / at->limit;
    integrator->at = (FcPosition){.u = u, .t = t, .rate = per_path * fabs(at->speed), .per_path = per_path};
}

void fc_integrator_start(FcIntegrator* integrator, FcWorkspace* workspace, const FcPlane* plane,
                         const FcInterval* interval, bool in_one_part, double evaluations) {
    *integrator = (FcIntegrator){.plane = plane,
                                 .interval = interval,
                                 .parts = workspace->parts,
                                 .remaining_path = workspace->remaining_path,
                                 .bristle.is_bounded = fc_is_bounded(interval->scene->friction),
                                 .sums.by_start = {{1.0, 0.0}, {0.0, 1.0}},
                                 .evaluations = evaluations};
    if (!plane->is_one_dimensional) {
        integrator->evaluations += OF_MINIMA;
        integrator->across = fc_drive_across(&interval->scene->drive);
    }
    integrator->from = first_from(integrator);
    if (in_one_part) {
        workspace->parts[0] = (FcPart){.end = interval->duration, .in = {0.0, INFINITY}, .strip_ratio = 1.0};
    }
    integrator->count =
        in_one_part ? 1 : fc_parts(plane, interval->duration, interval->tolerance, workspace->parts);
    integrator->first = fc_coefficients_at(integrator, 0.0);
    reach(integrator, 0.0, 0.0, &integrator->first);
}

// The present part in a variable.
static void take_variable(FcIntegrator* integrator, FcTimeMap in) {
    integrator->part.in = in;
    integrator->at.u = fc_time_map_u(&in, integrator->at.t);
    integrator->end = fc_time_map_u(&in, integrator->part.end);
    const double start = integrator->part.start;
    integrator->length_u =
        integrator->end - (integrator->at.t > start ? fc_time_map_u(&in, start) : integrator->at.u);
    integrator->h = 0.0;
}

void fc_begin_part(FcIntegrator* integrator, int number) {
    assert(0 <= number && number < integrator->count);
    integrator->number = number;
    integrator->part = integrator->parts[number];
    integrator->at.t = integrator->part.start;
    take_variable(integrator, integrator->part.in);
}

void fc_choose_variable(FcIntegrator* integrator) {
    const FcTimeMap graded = integrator->parts[integrator->number].in;
    const bool sticks = fc_kind(integrator) == FC_STICKS && integrator->bristle.state == FC_FREE;
    const FcTimeMap wanted = sticks ? (FcTimeMap){0.0, INFINITY} : graded;
    if (wanted.length != integrator->part.in.length) {
        take_variable(integrator, wanted);
    }
}

bool fc_part_is_crossed(const FcIntegrator* integrator) { return !(integrator->at.u < integrator->end); }

// A distance [m] from start to end in a part that is at most the path: straight to the center, and from there.
static double least_path(const FcIntegrator* integrator, const FcPart* part, double start, double end) {
    const FcDrive* drive = &integrator->interval->scene->drive;
    if (integrator->plane->is_one_dimensional) {
        return fabs(fc_drive_displacement(drive, start, end));
    }
    const double turn = fc_min(fc_max(part->in.center, start), end);
    return hypot(fc_drive_displacement(drive, start, turn),
                 fc_drive_displacement(&integrator->across, start, turn)) +
           hypot(fc_drive_displacement(drive, turn, end),
                 fc_drive_displacement(&integrator->across, turn, end));
}

// Finds the ways of the parts once, and the speed that goes with the whole way. In the plane a way may return.
static void find_ways(FcIntegrator* integrator) {
    if (integrator->from.speed != 0.0) {
        return;
    }
    double after = 0.0;
    for (int i = integrator->count - 1; i >= 0; i--) {
        const FcPart* part = &integrator->parts[i];
        integrator->remaining_path[i] = after;
        after += least_path(integrator, part, part->start, part->end);
    }
    const FcInterval* interval = integrator->interval;
    integrator->from.speed =
        (integrator->plane->is_one_dimensional ? after / interval->duration : interval->speed) + DBL_MIN;
}

bool fc_make_panel(FcIntegrator* integrator, double h, FcNodes* nodes, FcPanel* panel) {
    FcPanelStart* from = &integrator->from;
    find_ways(integrator);
    from->delta = fc_integrator_delta(integrator);
    from->scale = from->for_any ? fabs(1.0 - integrator->along.relaxation) * integrator->scale : 0.0;
    const FcPlane* plane = integrator->plane;
    FC_FASTEST(fc_nodes_make)(plane, &integrator->part, integrator->at.u, h, nodes);
    integrator->evaluations +=
        FC_STAGES * (plane->scene->drive.E.rate != 0.0 ? OF_A_MODULUS : 1.0) *
        (fc_kind(integrator) == FC_SLIPS && !plane->is_one_dimensional ? OF_NEWTON : 1.0);
    switch (fc_kind(integrator)) {
    case FC_SLIPS:
        return fc_slip_panel(plane, nodes, from, panel);
    case FC_NO_BRISTLE:
        fc_coulomb_panel(nodes, from->speed, panel);
        return true;
    default:
        FC_FASTEST(fc_relaxation_panel)(plane, nodes, from, panel);
        return true;
    }
}

void fc_resolve_shorter(FcIntegrator* integrator, double h, FcNodes* nodes, FcPanel* panel) {
    if (!fc_make_panel(integrator, h, nodes, panel)) {
        integrator->along.offset = NAN; // a part of a panel that was solved is, too
    }
}

double fc_path_left(FcIntegrator* integrator, double t) {
    find_ways(integrator);
    return integrator->remaining_path[integrator->number] +
           least_path(integrator, &integrator->part, t, integrator->part.end);
}

// The factor by which the errors of a panel that was solved are too large.
static double error_ratio_of(FcIntegrator* integrator, const FcNodes* nodes, const FcPanel* panel) {
    double of_end;
    const double of_mean =
        fc_control_error_ratio(&integrator->control, &integrator->part, nodes, panel, &of_end);
    if (of_end > 1.0 && of_end > of_mean) { // the path is found only if it decides
        of_end *= exp(-fc_path_left(integrator, nodes->t[LAST]) / integrator->interval->saturation);
    }
    return fc_max(of_mean, of_end);
}

double fc_step_adaptive(FcIntegrator* integrator, FcNodes* nodes, FcPanel* panel) {
    const FcKind kind = fc_kind(integrator);
    double h = fc_control_length(&integrator->control, &integrator->part, &integrator->at, kind,
                                 integrator->end, integrator->h);
    for (int tries = 0;; tries++) {
        const bool is_solved = fc_make_panel(integrator, h, nodes, panel);
        const double error_ratio = integrator->error_ratio =
            is_solved ? error_ratio_of(integrator, nodes, panel) : HUGE_VAL;
        if ((is_solved && error_ratio <= 1.0) || tries >= FC_MAX_REJECTIONS) {
            if (!is_solved) {
                integrator->along.offset = NAN;
            }
            const double grows = tries == 0 ? 4.0 : fc_control_growth(error_ratio);
            integrator->h = tries > 0 || integrator->h > 0.0 ? h * grows : 0.0;
            return h;
        }
        h *= fc_control_reduction(error_ratio);
    }
}

void fc_accept_panel(FcIntegrator* integrator, const FcNodes* nodes, FcPanel* panel, double h) {
    if (fc_kind(integrator) ==
        FC_STICKS) { // it moves with the surfaces: a drift over many periods is exact to rounding
        const FcVector from =
            integrator->from.for_any ? (FcVector){0.0, 0.0} : fc_integrator_delta(integrator);
        panel->along.offset = from.x + nodes->moved[LAST];
        panel->across.offset = from.y + nodes->moved_y[LAST];
    }
    fc_map_append(&integrator->along, &panel->along);
    fc_map_append(&integrator->across_map, &panel->across);
    integrator->control.log_transient -= fc_max(0.0, panel->z);
    const double kept = integrator->plane->is_one_dimensional ? 1.0 : exp(-panel->z); // of a deviation
    for (int k = 0; k < 2; k++) {
        integrator->sums.by_start[k].x *= kept;
        integrator->sums.by_start[k].y *= kept;
    }
    // The rest of rounding is the part's.
    const double next = integrator->at.u + h;
    const bool is_end = integrator->end - next < ROUNDING_OF_END * h;
    const FcPlaneCoefficients at = fc_nodes_at(nodes, LAST);
    reach(integrator, is_end ? integrator->end : next, is_end ? integrator->part.end : nodes->t[LAST], &at);
}

void fc_accept_closed_form(FcIntegrator* integrator, const FcMap* map, double t) {
    assert(t >= integrator->at.t && t <= integrator->part.end);
    fc_map_append(&integrator->along, map);
    integrator->evaluations += 1.0;
    const FcPlaneCoefficients at = fc_coefficients_at(integrator, t);
    const bool is_end = t == integrator->part.end;
    reach(integrator, is_end ? integrator->end : fc_time_map_u(&integrator->part.in, t), t, &at);
}

void fc_note_slip(FcIntegrator* integrator, double start, double end, int side) {
    if (end - start > integrator->sums.slip_length) {
        integrator->sums.slip_length = end - start;
        integrator->sums.slip_time = 0.5 * (start + end);
        integrator->sums.slip_side = side;
    }
}
