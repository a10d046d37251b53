#include "solver/march.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stddef.h>

#include "model/extremes.h"
#include "model/regime.h"
#include "solver/crossing.h"
#include "solver/events.h"
#include "solver/still.h"

// Whether the bound may fall.
static bool may_fall(const FcScene* bound) {
    const FcDrive* drive = &bound->drive;
    const bool stands = fc_scene_stiffness_is_constant(bound) && fc_scene_limit_is_constant(bound);
    if (stands || (fc_scene_ratio_is_constant(bound) && drive->E.rate == 0.0)) {
        return false;
    }
    if (drive->vibration.a_d != 0.0 || drive->E.rate != 0.0) {
        return true;
    }
    const double apart = bound->floats ? -drive->load.rate : drive->d.rate; // the way that d goes
    const bool rises_with_d = bound->at_E.model != FC_CONTACT_CONSTANT;     // D = g / sigma
    return rises_with_d ? apart < 0.0 : apart > 0.0;
}

static bool may_meet(const FcScene* scene, const FcScene* bound) {
    return fc_is_bounded(scene->friction) &&
           (scene->friction->model == FC_ELASTIC_PLASTIC || may_fall(bound));
}

// The transient [N] at the start: the difference of the force from its limit. The limit is Coulomb's force,
// minus its change in the time 1 / r.
static double first_transient(const FcCrossing* crossing, double scale) {
    const FcVector delta = fc_crossing_delta(crossing);
    const FcPlaneCoefficients at = crossing->first;
    const FcVector now = fc_plane_coulomb(&at);
    const double r = at.sigma * at.speed / at.limit;
    FcVector next = now;
    if (r * crossing->interval->duration > 1.0) {
        const FcPlaneCoefficients after = fc_coefficients_at(crossing, 1.0 / r);
        next = fc_plane_coulomb(&after);
    }
    return hypot(at.sigma * delta.x - (2.0 * now.x - next.x), at.sigma * delta.y - (2.0 * now.y - next.y)) +
           at.sigma * scale;
}

static void start_control(FcCrossing* crossing, double scale) {
    const int model = crossing->interval->scene->friction->model;
    const bool has_transient =
        model == FC_DAHL || model == FC_LUGRE || (model == FC_ELASTIC_PLASTIC && !crossing->plane->on_line);
    fc_control_start(&crossing->control, crossing->plane, crossing->interval,
                     has_transient ? first_transient(crossing, scale) : 0.0);
}

// The least progress over the part, in u. Derived: more than 12 events within it are rounding.
static const double PROGRESS = 0x1p-40;

// Panels in a row that do not get on, at an event that rounding hides. After twice FC_MAX_REJECTIONS of them the march passes
// over 2^-50 of the part, and then over twice as much each time. Over more than 2^-20 it gives up, and the step is refused.
static void pass_over_rounding(FcCrossing* crossing, double before, int stalled) {
    const int doublings = stalled - 2 * FC_MAX_REJECTIONS;
    if (doublings > 30) {
        crossing->along.offset = NAN;
        return;
    }
    crossing->at.u = fc_min(crossing->end,
                              fc_max(crossing->at.u, before + ldexp(0x1p-50, doublings) *
                                                                   (fabs(before) + crossing->end - before)));
    crossing->at.t = fc_part_time(&crossing->part, crossing->at.u);
}

static void cross_part(FcCrossing* crossing, int number) {
    fc_begin_part(crossing, number);
    int stalled = 0;
    while (crossing->evaluations <= FC_MAX_EVALUATIONS && !isnan(crossing->along.offset)) {
        fc_choose_variable(crossing);
        if (fc_part_is_crossed(crossing)) {
            break;
        }
        const double before = crossing->at.u;
        if (!fc_take_still(crossing)) {
            if (crossing->is_slipping) {
                fc_slip_until_event(crossing);
            } else {
                fc_free_until_event(crossing);
            }
        }
        stalled = crossing->at.u - before > PROGRESS * crossing->whole ? 0 : stalled + 1;
        crossing->is_stalled = stalled > FC_MAX_REJECTIONS;
        if (stalled > 2 * FC_MAX_REJECTIONS) {
            pass_over_rounding(crossing, before, stalled);
        }
    }
}

// Derived: a layer in which a bristle of the length D relaxes lasts sqrt(2 D / path) of an interval, some 1e-8, and changes
// the mean by a sixth of that.
static const double RIGID = DBL_EPSILON;

static bool may_be_rigid(const FcInterval* interval) {
    return interval->scene->friction->model != FC_COULOMB &&
           interval->saturation <= RIGID * interval->speed * interval->duration; // at the most
}

// Whether the force is Coulomb's, but for what rounding cannot see. Then the motion ends on the bound.
static void choose_rigid(FcCrossing* crossing) {
    if (may_be_rigid(crossing->interval)) {
        fc_begin_part(crossing, 0);
        crossing->is_rigid = crossing->interval->saturation <= RIGID * fc_path_left(crossing, 0.0);
    }
}

// The path over its length that a bristle forgets. Derived: e^-64 of its start is left.
static const double FORGOTTEN = 64.0;
// The rest of an interval that rounding of the time hides: 256 eps of it.
static const double HIDDEN = 0x1p-44;

// Makes the interval [0, h] of a scene. If rounding sees a bristle in the rest of the path alone, that rest, which decides the
// bristle's end, is an interval of its own, of the scene *later. Returns their number.
static int make_intervals(const FcScene* scene, const FcSolverOptions* options, double h, FcScene* later,
                          FcInterval of[2]) {
    of[0] = fc_interval_make(scene, h, options);
    if (!may_be_rigid(&of[0])) {
        return 1;
    }
    const FcDrive across = fc_drive_across(&scene->drive);
    double rest = h;
    double way = INFINITY; // m, in the next rest
    while (rest > HIDDEN * h && way > FORGOTTEN * of[0].saturation) {
        rest *= 0x1p-4;
        const double next = h - 0x1p-4 * rest;
        way = hypot(fc_drive_displacement(&scene->drive, next, h), fc_drive_displacement(&across, next, h));
    }
    if (rest <= HIDDEN * h) {
        return 1;
    }
    const double t = h - rest;
    of[0] = fc_interval_make(scene, t, options);
    *later = fc_scene_from(scene, t);
    of[1] = fc_interval_make(later, h - t, options); // exact
    return 2;
}

static void end_on_bound(FcCrossing* crossing) {
    const FcPlaneCoefficients end = fc_coefficients_at(crossing, crossing->interval->duration);
    FcVector F = fc_plane_coulomb(&end);
    if (crossing->plane->on_line) { // V may end at 0, within rounding
        F.x = crossing->part.side * end.limit;
    }
    fc_set_delta(crossing, (FcVector){F.x / end.sigma, F.y / end.sigma});
    crossing->slips = crossing->is_slipping =
        crossing->interval->scene->friction->model == FC_ELASTIC_PLASTIC;
    crossing->meetings += crossing->is_bounded;
}

static void cross(FcCrossing* crossing) {
    for (int i = 0; i < crossing->count; i++) {
        cross_part(crossing, i);
    }
    if (crossing->is_rigid) {
        end_on_bound(crossing);
    }
}

// A bristle at its bound begins in a slip, which it leaves at once if it is not pushed. One with static friction that
// sticks there touches its bound.
static void begin_at_bound(FcCrossing* crossing, FcBristle bristle) {
    const bool remembers_stick =
        fc_has_static_friction(crossing->interval->scene->friction) && bristle.slips == 0;
    const double D = fc_plane_radius(crossing->plane, &crossing->first, bristle.slips);
    crossing->slips = bristle.slips;
    if (crossing->is_bounded && remembers_stick) {
        crossing->touches = fc_size(bristle) >= D * (1.0 - FC_ROUNDING_OF_BOUND);
    } else if (crossing->is_bounded) {
        crossing->is_slipping = fc_size(bristle) >= D * (1.0 - 1e-13);
    }
    crossing->meetings = crossing->is_slipping;
}

static void put_result(const FcCrossing* crossing, FcStepResult* result) {
    fc_map_apply(&crossing->along, result);
    if (!crossing->plane->on_line) {
        fc_map_apply_across(&crossing->across_map, result);
    }
    result->heat += crossing->heat;
    result->drag += crossing->drag;
    result->meetings += crossing->meetings;
    const bool slips = fc_has_static_friction(crossing->interval->scene->friction) && crossing->slips != 0;
    result->slips = !slips ? 0 : crossing->plane->on_line && result->delta < 0.0 ? -1 : 1;
    result->on_bound = crossing->is_slipping;
    if (crossing->slip_length > 0.0) {
        result->slip_time = crossing->slip_time;
        result->slip_side = crossing->slip_side;
    }
    result->by_start[0] = crossing->by_start[0];
    result->by_start[1] = crossing->by_start[1];
    result->evaluations = crossing->evaluations;
}

// The displacement in an interval of the length h [s] from its start to any time, at the most [m].
static double longest_way(const FcDrive* drive, double h) {
    const double V = fabs(drive->V.value) + fabs(drive->V_y.value);
    const double rate = fabs(drive->V.rate) + fabs(drive->V_y.rate);
    const double swing = drive->omega * h > 2.0 ? 2.0 / drive->omega : h;
    return (V + 0.5 * rate * h) * h + (fabs(drive->vibration.V_1) + fabs(drive->vibration.V_2)) * swing;
}

// Whether a bristle sticks to the interval's end, since no bound is near enough. Its motion has no events then.
static bool stays_stuck(const FcInterval* interval, FcBristle bristle) {
    const FcScene* scene = interval->scene;
    const double h = interval->duration;
    const double farthest = fc_size(bristle) + longest_way(&scene->drive, h);
    const double D = fc_static_ratio(scene->friction) * fc_scene_smallest_saturation(scene, h);
    return scene->friction->model == FC_ELASTIC_PLASTIC && bristle.slips == 0 && farthest < (1.0 - 1e-9) * D;
}

static void march(const FcInterval* interval, FcStepResult* result) {
    const FcScene* scene = interval->scene;
    const FcBristle bristle = fc_bristle_of(result);
    FcPlane plane;
    fc_plane_make(&plane, scene);
    plane.on_line = !fc_is_planar(scene, bristle);
    FcRoom room;
    FcCrossing crossing;
    const bool sticks = stays_stuck(interval, bristle);
    fc_crossing_start(&crossing, &room, &plane, interval, sticks, result->evaluations);
    crossing.is_bounded = !sticks && may_meet(scene, &plane.of_static_limit);
    fc_set_delta(&crossing, (FcVector){bristle.delta, bristle.delta_y});
    choose_rigid(&crossing);
    if (fc_kind(&crossing) == FC_NO_BRISTLE) { // the deflection stands meanwhile
        crossing.along.relaxation = crossing.across_map.relaxation = 0.0;
        crossing.along.offset = crossing.across_map.offset = 0.0;
    } else {
        begin_at_bound(&crossing, bristle);
    }
    start_control(&crossing, 0.0);
    cross(&crossing);
    put_result(&crossing, result);
}

void fc_march_step(const FcScene* scene, const FcSolverOptions* options, double duration,
                   FcStepResult* result) {
    if (!(duration > 0.0) || isnan(result->delta)) { // no number of an earlier interval
        return;
    }
    FcScene later;
    FcInterval of[2];
    const int count = make_intervals(scene, options, duration, &later, of);
    for (int i = 0; i < count; i++) {
        march(&of[i], result);
    }
}

FcMap fc_march_map(const FcScene* scene, const FcSolverOptions* options, double duration, double start,
                   FcMap* across, double* evaluations) {
    if (isnan(start)) { // no number of an earlier interval
        return (FcMap){.offset = NAN};
    }
    assert(duration > 0.0 && start >= 0.0);
    FcMap along = {0};
    FcMap over = {0};
    FcScene later;
    FcInterval of[2];
    const int count = make_intervals(scene, options, duration, &later, of);
    for (int i = 0; i < count; i++) {
        FcPlane plane;
        fc_plane_make(&plane, of[i].scene);
        plane.on_line = across == NULL;
        FcRoom room;
        FcCrossing crossing;
        fc_crossing_start(&crossing, &room, &plane, &of[i], false, *evaluations);
        choose_rigid(&crossing);
        crossing.from.for_any = true;
        crossing.is_bounded = false;
        crossing.scale = fc_max(start, crossing.first.limit / crossing.first.sigma);
        start_control(&crossing, crossing.scale);
        cross(&crossing);
        *evaluations = crossing.evaluations;
        fc_map_append(&along, &crossing.along);
        fc_map_append(&over, &crossing.across_map);
    }
    if (across) {
        *across = over;
    }
    return along;
}

bool fc_march_may_meet(const FcScene* scene) {
    FcPlane plane;
    fc_plane_make(&plane, scene);
    return may_meet(scene, &plane.of_static_limit);
}
