#include "solver/crossing.h"

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

FcKind fc_kind(const FcCrossing* crossing) {
    const int model = crossing->interval->scene->friction->model;
    return model == FC_COULOMB || crossing->is_rigid ? FC_NO_BRISTLE
           : crossing->is_slipping                   ? FC_SLIPS
           : model == FC_ELASTIC_PLASTIC             ? FC_STICKS
                                                     : FC_RELAXES;
}

FcVector fc_crossing_delta(const FcCrossing* crossing) {
    return (FcVector){crossing->along.offset, crossing->across_map.offset};
}

void fc_set_delta(FcCrossing* crossing, FcVector delta) {
    crossing->along.relaxation = crossing->across_map.relaxation = 1.0;
    crossing->along.offset = delta.x;
    crossing->across_map.offset = delta.y;
}

FcPlaneCoefficients fc_coefficients_at(const FcCrossing* crossing, double t) {
    return fc_plane_coefficients(crossing->plane, t, fc_drive_phase(&crossing->interval->scene->drive, t));
}

double fc_largest_push(const FcCrossing* crossing) {
    const FcInterval* interval = crossing->interval;
    return interval->speed + interval->saturation * interval->pace.log_sigma;
}

// What all panels begin with.
static FcFrom first_from(const FcCrossing* crossing) {
    const FcScene* scene = crossing->interval->scene;
    const bool limit_stands = fc_scene_limit_is_constant(scene);
    const bool is_still = limit_stands && fc_scene_stiffness_is_constant(scene);
    const bool has_curve = fc_has_stribeck_curve(scene->friction);
    return (FcFrom){.push = fc_largest_push(crossing) + DBL_MIN,
                    .is_still = is_still && !has_curve && scene->friction->sigma_1 == 0.0,
                    .limit_stands = limit_stands && (!has_curve || fc_drive_V_is_constant(&scene->drive))};
}

static void reach(FcCrossing* crossing, double u, double t, const FcPlaneCoefficients* at) {
    const double per_path = at->sigma / at->limit;
    crossing->at = (FcReached){.u = u, .t = t, .rate = per_path * fabs(at->speed), .per_path = per_path};
}

void fc_crossing_start(FcCrossing* crossing, FcRoom* room, const FcPlane* plane, const FcInterval* interval,
                       bool in_one_part, double evaluations) {
    *crossing = (FcCrossing){.plane = plane,
                             .interval = interval,
                             .parts = room->parts,
                             .way = room->way,
                             .is_bounded = fc_is_bounded(interval->scene->friction),
                             .by_start = {{1.0, 0.0}, {0.0, 1.0}},
                             .evaluations = evaluations};
    if (!plane->on_line) {
        crossing->evaluations += OF_MINIMA;
        crossing->across = fc_drive_across(&interval->scene->drive);
    }
    crossing->from = first_from(crossing);
    if (in_one_part) {
        room->parts[0] = (FcPart){.end = interval->duration, .in = {0.0, INFINITY}, .strip_ratio = 1.0};
    }
    crossing->count = in_one_part ? 1 : fc_parts(plane, interval->duration, interval->tolerance, room->parts);
    crossing->first = fc_coefficients_at(crossing, 0.0);
    reach(crossing, 0.0, 0.0, &crossing->first);
}

// The present part in a variable.
static void take_variable(FcCrossing* crossing, FcTimeMap in) {
    crossing->part.in = in;
    crossing->at.u = fc_time_map_u(&in, crossing->at.t);
    crossing->end = fc_time_map_u(&in, crossing->part.end);
    const double start = crossing->part.start;
    crossing->whole =
        crossing->end - (crossing->at.t > start ? fc_time_map_u(&in, start) : crossing->at.u);
    crossing->h = 0.0;
}

void fc_begin_part(FcCrossing* crossing, int number) {
    assert(0 <= number && number < crossing->count);
    crossing->number = number;
    crossing->part = crossing->parts[number];
    crossing->at.t = crossing->part.start;
    take_variable(crossing, crossing->part.in);
}

void fc_choose_variable(FcCrossing* crossing) {
    const FcTimeMap graded = crossing->parts[crossing->number].in;
    const bool sticks = fc_kind(crossing) == FC_STICKS && crossing->slips == 0;
    const FcTimeMap wanted = sticks ? (FcTimeMap){0.0, INFINITY} : graded;
    if (wanted.length != crossing->part.in.length) {
        take_variable(crossing, wanted);
    }
}

bool fc_part_is_crossed(const FcCrossing* crossing) { return !(crossing->at.u < crossing->end); }

// A distance [m] from start to end in a part that is at most the path: straight to the center, and from there.
static double least_path(const FcCrossing* crossing, const FcPart* part, double start, double end) {
    const FcDrive* drive = &crossing->interval->scene->drive;
    if (crossing->plane->on_line) {
        return fabs(fc_drive_displacement(drive, start, end));
    }
    const double turn = fc_min(fc_max(part->in.center, start), end);
    return hypot(fc_drive_displacement(drive, start, turn),
                 fc_drive_displacement(&crossing->across, start, turn)) +
           hypot(fc_drive_displacement(drive, turn, end),
                 fc_drive_displacement(&crossing->across, turn, end));
}

// Finds the ways of the parts once, and the speed that goes with the whole way. In the plane a way may return.
static void find_ways(FcCrossing* crossing) {
    if (crossing->from.speed != 0.0) {
        return;
    }
    double after = 0.0;
    for (int i = crossing->count - 1; i >= 0; i--) {
        const FcPart* part = &crossing->parts[i];
        crossing->way[i] = after;
        after += least_path(crossing, part, part->start, part->end);
    }
    const FcInterval* interval = crossing->interval;
    crossing->from.speed =
        (crossing->plane->on_line ? after / interval->duration : interval->speed) + DBL_MIN;
}

bool fc_make_panel(FcCrossing* crossing, double h, FcNodes* nodes, FcPanel* panel) {
    FcFrom* from = &crossing->from;
    find_ways(crossing);
    from->delta = fc_crossing_delta(crossing);
    from->scale = from->for_any ? (1.0 - crossing->along.relaxation) * crossing->scale : 0.0;
    const FcPlane* plane = crossing->plane;
    FC_FASTEST(fc_nodes_make)(plane, &crossing->part, crossing->at.u, h, nodes);
    crossing->evaluations += FC_STAGES * (plane->scene->drive.E.rate != 0.0 ? OF_A_MODULUS : 1.0) *
                             (fc_kind(crossing) == FC_SLIPS && !plane->on_line ? OF_NEWTON : 1.0);
    switch (fc_kind(crossing)) {
    case FC_SLIPS:
        return fc_slip_panel(plane, nodes, from, panel);
    case FC_NO_BRISTLE:
        fc_coulomb_panel(nodes, from->speed, panel);
        return true;
    default:
        FC_FASTEST(fc_free_panel)(plane, nodes, from, panel);
        return true;
    }
}

void fc_make_again(FcCrossing* crossing, double h, FcNodes* nodes, FcPanel* panel) {
    if (!fc_make_panel(crossing, h, nodes, panel)) {
        crossing->along.offset = NAN; // a part of a panel that was solved is, too
    }
}

double fc_path_left(FcCrossing* crossing, double t) {
    find_ways(crossing);
    return crossing->way[crossing->number] + least_path(crossing, &crossing->part, t, crossing->part.end);
}

// The factor by which the errors of a panel that was solved are too large.
static double excess_of(FcCrossing* crossing, const FcNodes* nodes, const FcPanel* panel) {
    double of_end;
    const double of_mean = fc_control_excess(&crossing->control, &crossing->part, nodes, panel, &of_end);
    if (of_end > 1.0 && of_end > of_mean) { // the path is found only if it decides
        of_end *= exp(-fc_path_left(crossing, nodes->t[LAST]) / crossing->interval->saturation);
    }
    return fc_max(of_mean, of_end);
}

double fc_take_accurate(FcCrossing* crossing, FcNodes* nodes, FcPanel* panel) {
    const FcKind kind = fc_kind(crossing);
    double h = fc_control_length(&crossing->control, &crossing->part, &crossing->at, kind, crossing->end,
                                 crossing->h);
    for (int tries = 0;; tries++) {
        const bool is_solved = fc_make_panel(crossing, h, nodes, panel);
        const double excess = is_solved ? excess_of(crossing, nodes, panel) : HUGE_VAL;
        if ((is_solved && excess <= 1.0) || tries >= FC_MAX_REJECTIONS) {
            if (!is_solved) {
                crossing->along.offset = NAN;
            }
            const double grows = tries == 0 ? 4.0 : fc_control_grows(excess);
            crossing->h = tries > 0 || crossing->h > 0.0 ? h * grows : 0.0;
            return h;
        }
        h *= fc_control_shortens(excess);
    }
}

void fc_append_panel(FcCrossing* crossing, const FcNodes* nodes, FcPanel* panel, double h) {
    if (fc_kind(crossing) ==
        FC_STICKS) { // it moves with the surfaces: a drift over many periods is exact to rounding
        const FcVector from = crossing->from.for_any ? (FcVector){0.0, 0.0} : fc_crossing_delta(crossing);
        panel->along.offset = from.x + nodes->moved[LAST];
        panel->across.offset = from.y + nodes->moved_y[LAST];
    }
    fc_map_append(&crossing->along, &panel->along);
    fc_map_append(&crossing->across_map, &panel->across);
    crossing->control.log_transient -= fc_max(0.0, panel->z);
    const double kept = crossing->plane->on_line ? 1.0 : exp(-panel->z); // of a deviation
    for (int k = 0; k < 2; k++) {
        crossing->by_start[k].x *= kept;
        crossing->by_start[k].y *= kept;
    }
    // The rest of rounding is the part's.
    const double next = crossing->at.u + h;
    const bool is_end = crossing->end - next < 1e-12 * h;
    const FcPlaneCoefficients at = fc_nodes_at(nodes, LAST);
    reach(crossing, is_end ? crossing->end : next, is_end ? crossing->part.end : nodes->t[LAST], &at);
}

void fc_append_known(FcCrossing* crossing, const FcMap* map, double t) {
    assert(t >= crossing->at.t && t <= crossing->part.end);
    fc_map_append(&crossing->along, map);
    crossing->evaluations += 1.0;
    const FcPlaneCoefficients at = fc_coefficients_at(crossing, t);
    const bool is_end = t == crossing->part.end;
    reach(crossing, is_end ? crossing->end : fc_time_map_u(&crossing->part.in, t), t, &at);
}

void fc_note_slip(FcCrossing* crossing, double start, double end, int side) {
    if (end - start > crossing->slip_length) {
        crossing->slip_length = end - start;
        crossing->slip_time = 0.5 * (start + end);
        crossing->slip_side = side;
    }
}
