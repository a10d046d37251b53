// The default method. Held inputs without vibration have a closed form. Otherwise the interval is split into
// stretches (stretches/stretch.h) at the reversals of V, the kinks of |V|. Each stretch is crossed panel by
// panel (stretches/crossing.h). Every panel's error is bounded or estimated and compared with the budget
// (budget.h), so that F_t at the interval's end and its mean stay within the tolerance.
#include "solver/methods/methods.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

#include "solver/panels/gauss_panel.h"
#include "solver/stretches/crossing.h"

// Without stiffness there is no force: the bristle follows V.
static FcMap slack_map(const FcScene* scene, double h) {
    FcMap map = fc_map_identity();
    map.offset = fc_drive_displacement(&scene->drive, 0.0, h);
    map.drag_offset = fc_drive_square(&scene->drive, 0.0, h);
    return map;
}

// Crosses an interval in one bounded panel if it is so short that V cannot reach 0 or a Stribeck peak: the
// common case of an input with many samples a period.
static bool cross_in_one(FcCrossed* crossed, FcPhase phase, double delta_0, FcMapScope scope) {
    const FcInterval* interval = crossed->interval;
    const FcScene* scene = interval->scene;
    const FcDrive* drive = &scene->drive;
    const double h = interval->duration;
    const double moves = h * (fabs(drive->V.rate) + drive->vibration.V_1 * drive->omega);
    const double slowest = fabs(fc_drive_V_at_phase(drive, 0.0, phase)) - moves;
    const double saturation = interval->limit / interval->stiffness;
    if (!(h > 0.0 && slowest > 0.0 && slowest * h <= FC_MOST_BOUNDED * saturation) ||
        !fc_is_beyond_peaks(scene->friction, slowest, fabs(delta_0) / saturation, interval->tolerance)) {
        return false;
    }
    const double X = fc_drive_displacement(drive, 0.0, h);
    const FcTrajectories from = {
        .delta_0 = delta_0,
        .scale = scope == FC_MAP_ANY_START ? fmax(fabs(delta_0), saturation) : 0.0,
        .speed = interval->speed,
        .keep = crossed->watch ? &crossed->watch->nodes : NULL,
    };
    FcPanel panel;
    if (!fc_bounded_panel(interval, scene, 0.0, h, X, fabs(X) / saturation, &from, &panel,
                          &crossed->evaluations)) {
        return false;
    }
    const FcPanelAt at = {scene, 0.0, h, panel.nodes, 0.0};
    double taken;
    if (!fc_may_keep_panel(crossed, &at, &from, &panel, &taken) || (taken < h && !fc_has_met(crossed))) {
        return false;
    }
    *crossed->map = panel.map;
    return true;
}

// The trajectories of the map are P from the start 1 and Q from the start 0. For one start alone P is 0 from
// the beginning, and Q starts at delta_0.
static void cross_stretches(FcCrossed* crossed, FcPhase start_phase, double delta_0, FcMapScope scope) {
    const FcInterval* interval = crossed->interval;
    const FcCoefficients start = fc_scene_coefficients_at_phase(interval->scene, 0.0, start_phase);
    if (scope == FC_MAP_THIS_START) {
        crossed->map->relaxation = 1.0;
        crossed->map->offset = delta_0;
    } else {
        crossed->scale = fmax(fabs(delta_0), start.limit / start.sigma);
    }
    FcStretches stretches;
    FcStretch stretch = {0};
    fc_stretches_start(&stretches, interval, start, start_phase, &stretch);
    while (crossed->evaluations <= FC_MOST_EVALUATIONS && !fc_has_met(crossed)) {
        const FcTrajectories from = fc_crossed_trajectories(crossed);
        if (!fc_stretches_next(&stretches, fmax(fabs(from.delta_0), fabs(from.scale)), &stretch)) {
            break;
        }
        fc_cross(crossed, &stretch);
    }
}

// With a constant sigma the work is the heat plus the energy that the bristle stores, sigma (delta_1^2 -
// delta_0^2) / 2. So it keeps its digits deep in presliding, although nearly all of it comes back. start [m]:
// the map's only start, or 0 if it holds for any.
static void take_work_from_heat(FcMap* map, double sigma, double start) {
    map->work_slope = map->heat_slope + sigma * (1.0 - map->relaxation) * map->offset;
    map->work_offset = map->heat_offset + 0.5 * sigma * (map->offset - start) * (map->offset + start);
}

static FcMap cross_interval(const FcScene* scene, const FcSolverOptions* options, double duration,
                            double delta_0, FcMapScope scope, FcWatch* watch, double* evaluations) {
    const bool has_peaks = fc_has_stribeck_curve(scene->friction);
    FcFriction coulomb_limit = *scene->friction;
    coulomb_limit.staticRatio = 1.0;
    FcScene beyond_peaks;
    if (has_peaks) {
        beyond_peaks = *scene;
        beyond_peaks.friction = &coulomb_limit;
    }
    const FcInterval interval = fc_interval_make(scene, has_peaks ? &beyond_peaks : scene, duration, options);
    if (!isfinite(interval.force / interval.stiffness)) {
        return slack_map(scene, duration);
    }
    FcMap map = fc_map_identity();
    FcCrossed crossed = {.interval = &interval, .map = &map, .evaluations = *evaluations, .watch = watch};
    const FcPhase start_phase = fc_drive_phase(&scene->drive, 0.0);
    const bool in_one = cross_in_one(&crossed, start_phase, delta_0, scope);
    if (!in_one) {
        cross_stretches(&crossed, start_phase, delta_0, scope);
    }
    if (interval.constant_sigma) {
        take_work_from_heat(&map, interval.stiffness, scope == FC_MAP_THIS_START && !in_one ? delta_0 : 0.0);
    }
    *evaluations = crossed.evaluations;
    return map;
}

FcMap fc_collocation_interval(const FcScene* scene, const FcSolverOptions* options, double duration,
                              double delta_0, FcMapScope scope, double* evaluations) {
    return cross_interval(scene, options, duration, delta_0, scope, NULL, evaluations);
}

FcMap fc_collocation_watched(const FcScene* scene, const FcSolverOptions* options, double duration,
                             double delta_0, FcWatch* watch, double* evaluations) {
    return cross_interval(scene, options, duration, delta_0, FC_MAP_THIS_START, watch, evaluations);
}

void fc_collocation_constant(const FcScene* scene, const FcContactResponse* contact, double h, double delta_0,
                             FcStepResult* result) {
    const FcCoefficients at = fc_scene_coefficients_of(scene, contact);
    const FcMap map = fc_map_of_constant_scene(&at, h);
    *result = (FcStepResult){.delta = delta_0, .evaluations = 1.0};
    fc_map_apply(&map, result);
}
