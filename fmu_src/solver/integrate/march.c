#include "solver/integrate/march.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stddef.h>

#include "model/bound.h"
#include "model/extremes.h"
#include "solver/integrate/closed_form.h"
#include "solver/integrate/events.h"
#include "solver/integrate/integrator.h"

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
    return fc_is_bounded(scene->friction) && (fc_may_stick(scene->friction) || may_fall(bound));
}

// The transient [N] at the start: the difference of the force from its limit. The limit is Coulomb's force,
// minus its change in the time 1 / r.
static double first_transient(const FcIntegrator* integrator, double scale) {
    const FcVector delta = fc_integrator_delta(integrator);
    const FcPlaneCoefficients at = integrator->first;
    const FcVector now = fc_plane_coulomb(&at);
    const double r = at.sigma * at.speed / at.limit;
    FcVector next = now;
    if (r * integrator->interval->duration > 1.0) {
        const FcPlaneCoefficients after = fc_coefficients_at(integrator, 1.0 / r);
        next = fc_plane_coulomb(&after);
    }
    return hypot(at.sigma * delta.x - (2.0 * now.x - next.x), at.sigma * delta.y - (2.0 * now.y - next.y)) +
           at.sigma * scale;
}

static void start_control(FcIntegrator* integrator, double scale) {
    const FcFriction* friction = integrator->interval->scene->friction;
    const bool has_transient =
        fc_may_relax(friction) || (fc_may_stick(friction) && !integrator->plane->is_one_dimensional);
    fc_control_start(&integrator->control, integrator->plane, integrator->interval,
                     has_transient ? first_transient(integrator, scale) : 0.0);
}

// The least progress over the part, in u. Derived: more than 12 events within it are rounding.
static const double PROGRESS = 0x1p-40;

// Panels in a row that do not get on, at an event that rounding hides. After twice FC_MAX_REJECTIONS of them the march passes
// over 2^-50 of the part, and then over twice as much each time. Over more than 2^-20 it gives up, and the step is refused.
static void pass_over_rounding(FcIntegrator* integrator, double before, int stalled) {
    const int doublings = stalled - 2 * FC_MAX_REJECTIONS;
    if (doublings > 30) {
        integrator->along.offset = NAN;
        return;
    }
    integrator->at.u = fc_min(
        integrator->end, fc_max(integrator->at.u, before + ldexp(0x1p-50, doublings) *
                                                               (fabs(before) + integrator->end - before)));
    integrator->at.t = fc_part_time(&integrator->part, integrator->at.u);
}

static void integrate_part(FcIntegrator* integrator, int number) {
    fc_begin_part(integrator, number);
    int stalled = 0;
    while (integrator->evaluations <= FC_MAX_EVALUATIONS && !isnan(integrator->along.offset)) {
        fc_choose_variable(integrator);
        if (fc_part_is_crossed(integrator)) {
            break;
        }
        const double before = integrator->at.u;
        if (!fc_take_closed_form(integrator)) {
            if (integrator->bristle.state == FC_SLIPPING) {
                fc_slip_until_event(integrator);
            } else {
                fc_free_until_event(integrator);
            }
        }
        stalled = integrator->at.u - before > PROGRESS * integrator->length_u ? 0 : stalled + 1;
        integrator->bristle.is_stalled = stalled > FC_MAX_REJECTIONS;
        if (stalled > 2 * FC_MAX_REJECTIONS) {
            pass_over_rounding(integrator, before, stalled);
        }
    }
}

// Derived: a layer in which a bristle of the length D relaxes lasts sqrt(2 D / path) of an interval, some 1e-8, and changes
// the mean by a sixth of that.
static const double RIGID = DBL_EPSILON;

static bool may_be_rigid(const FcInterval* interval) {
    return fc_has_bristle(interval->scene->friction) &&
           interval->saturation <= RIGID * interval->speed * interval->duration; // at the most
}

// Whether the force is Coulomb's, but for what rounding cannot see. Then the motion ends on the bound.
static void choose_rigid(FcIntegrator* integrator) {
    if (may_be_rigid(integrator->interval)) {
        fc_begin_part(integrator, 0);
        integrator->bristle.is_rigid =
            integrator->interval->saturation <= RIGID * fc_path_left(integrator, 0.0);
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

static void end_on_bound(FcIntegrator* integrator) {
    const FcPlaneCoefficients end = fc_coefficients_at(integrator, integrator->interval->duration);
    FcVector F = fc_plane_coulomb(&end);
    if (integrator->plane->is_one_dimensional) { // V may end at 0, within rounding
        F.x = integrator->part.side * end.limit;
    }
    fc_set_delta(integrator, (FcVector){F.x / end.sigma, F.y / end.sigma});
    integrator->bristle.state = fc_may_stick(integrator->interval->scene->friction) ? FC_SLIPPING : FC_FREE;
    integrator->sums.meetings += integrator->bristle.is_bounded;
}

static void integrate(FcIntegrator* integrator) {
    for (int i = 0; i < integrator->count; i++) {
        integrate_part(integrator, i);
    }
    if (integrator->bristle.is_rigid) {
        end_on_bound(integrator);
    }
}

// A bristle at its bound begins in a slip, which it leaves at once if it is not pushed. One with static friction that
// sticks there touches its bound.
static void begin_at_bound(FcIntegrator* integrator, FcBristle bristle) {
    const FcFriction* friction = integrator->interval->scene->friction;
    const bool has_broken_away = fc_has_broken_away(friction, bristle.state);
    const double size = fc_size(bristle);
    const double D = fc_plane_radius(integrator->plane, &integrator->first, bristle.state);
    integrator->bristle.state = has_broken_away ? FC_CATCHING_UP : FC_FREE;
    if (integrator->bristle.is_bounded && fc_has_static_friction(friction) && !has_broken_away) {
        integrator->bristle.touches = size >= D * (1.0 - FC_ROUNDING_OF_BOUND);
    } else if (integrator->bristle.is_bounded && size >= D * (1.0 - FC_ROUNDING_OF_DEFLECTION)) {
        integrator->bristle.state = FC_SLIPPING;
        integrator->sums.meetings = 1;
    }
}

static void put_result(const FcIntegrator* integrator, FcStepResult* result) {
    fc_map_apply(&integrator->along, result);
    if (!integrator->plane->is_one_dimensional) {
        fc_map_apply_across(&integrator->across_map, result);
    }
    result->heat += integrator->sums.heat;
    result->drag += integrator->sums.drag;
    result->meetings += integrator->sums.meetings;
    result->state = integrator->bristle.state;
    if (integrator->sums.slip_length > 0.0) {
        result->slip_time = integrator->sums.slip_time;
        result->slip_side = integrator->sums.slip_side;
    }
    result->by_start[0] = integrator->sums.by_start[0];
    result->by_start[1] = integrator->sums.by_start[1];
    result->evaluations = integrator->evaluations;
}

// The displacement in an interval of the length h [s] from its start to any time, at the most [m].
static double longest_way(const FcDrive* drive, double h) {
    const double V = fabs(drive->V.value) + fabs(drive->V_y.value);
    const double rate = fabs(drive->V.rate) + fabs(drive->V_y.rate);
    const double swing = drive->omega * h > 2.0 ? 2.0 / drive->omega : h;
    return (V + 0.5 * rate * h) * h + (fabs(drive->vibration.V_1) + fabs(drive->vibration.V_2)) * swing;
}

// The part of its bound by which a bristle is surely inside. Chosen: far above the rounding of the way and of the bound.
static const double SURELY_INSIDE = 1e-9;

// Whether a bristle sticks to the interval's end, since no bound is near enough. Its motion has no events then.
static bool stays_stuck(const FcInterval* interval, FcBristle bristle) {
    const FcScene* scene = interval->scene;
    const double h = interval->duration;
    const double farthest = fc_size(bristle) + longest_way(&scene->drive, h);
    const double D = fc_static_ratio(scene->friction) * fc_scene_smallest_saturation(scene, h);
    return fc_may_stick(scene->friction) && !fc_has_broken_away(scene->friction, bristle.state) &&
           farthest < (1.0 - SURELY_INSIDE) * D;
}

static void march(const FcInterval* interval, FcStepResult* result) {
    const FcScene* scene = interval->scene;
    const FcBristle bristle = fc_bristle_of(result);
    FcPlane plane;
    fc_plane_make(&plane, scene);
    plane.is_one_dimensional = !fc_is_planar(scene, bristle);
    FcWorkspace workspace;
    FcIntegrator integrator;
    const bool sticks = stays_stuck(interval, bristle);
    fc_integrator_start(&integrator, &workspace, &plane, interval, sticks, result->evaluations);
    integrator.bristle.is_bounded = !sticks && may_meet(scene, &plane.of_static_limit);
    fc_set_delta(&integrator, (FcVector){bristle.delta, bristle.delta_y});
    choose_rigid(&integrator);
    if (fc_kind(&integrator) == FC_NO_BRISTLE) { // the deflection stands meanwhile
        integrator.along.relaxation = integrator.across_map.relaxation = 0.0;
        integrator.along.offset = integrator.across_map.offset = 0.0;
    } else {
        begin_at_bound(&integrator, bristle);
    }
    start_control(&integrator, 0.0);
    integrate(&integrator);
    put_result(&integrator, result);
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
        plane.is_one_dimensional = across == NULL;
        FcWorkspace workspace;
        FcIntegrator integrator;
        fc_integrator_start(&integrator, &workspace, &plane, &of[i], false, *evaluations);
        choose_rigid(&integrator);
        integrator.from.for_any = true;
        integrator.bristle.is_bounded = false;
        integrator.scale = fc_max(start, integrator.first.limit / integrator.first.sigma);
        start_control(&integrator, integrator.scale);
        integrate(&integrator);
        *evaluations = integrator.evaluations;
        fc_map_append(&along, &integrator.along);
        fc_map_append(&over, &integrator.across_map);
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
