// The default method. Inputs held and no vibration: the closed form. A contact that stands still and relaxes little between
// two reversals: the closed form of the path (solver/constant_contact.h). Otherwise the interval is split at the reversals
// of V, where |V| has a kink, into stretches, and each stretch into panels (solver/panel.h):
//
//     little relaxes in the stretch     one Gauss panel whose error is bounded beforehand (solver/bounded_panel.h), or a
//                                       few that are judged; without a linear system
//     else, or where those miss         Radau panels of 5 or 9 stages on the mesh of solver/mesh.h
//     once it follows its limit         the rest of the stretch in closed form (solver/settling.h)
//
// LuGre's limit depends on V in bells around the reversals and on nothing but the load beyond (solver/stribeck_bell.h).
// Every panel's error is bounded or estimated and held against what an error may be there, so that F_t at the interval's
// end and its mean stay within the tolerance.
#include "solver/collocation.h"

#include <assert.h>
#include <float.h>
#include <math.h>

#include "solver/bounded_panel.h"
#include "solver/constant_contact.h"
#include "solver/gauss_panel.h"
#include "solver/gauss_rule.h"
#include "solver/judge.h"
#include "solver/mesh.h"
#include "solver/radau_panel.h"
#include "solver/section.h"
#include "solver/settling.h"
#include "solver/small_bell.h"
#include "solver/stribeck_bell.h"

// Panels that are refused in a row before one is taken as it is: rounding rules by then.
enum { MOST_TRIES = 12, MOST_CAUTION = 6 };

// Where the two trajectories of the interval's map are: P started from 1 and Q started from 0. For one start alone
// P is 0 from the beginning and Q starts from there.
typedef struct {
    const FcScene* scene;
    const FcScene* beyond_bells; // the same where it has no Stribeck curve
    FcMap* map;                  // of what is crossed
    double end;                  // s
    double tolerance;            // N, of the force
    FcCoefficients start;
    double per_deflection; // 1/m, about sigma / g
    double scale;          // m, size of the deflection at the start
    double speed;          // m/s
    double decades;        // of accuracy
    double held;           // N, s g in a stretch with a constant limit, else 0
    double evaluations;    // in the communication step so far
    FcMotion motion;
} Progress;

static FcTrajectories trajectories(const Progress* progress) {
    return (FcTrajectories){.delta_0 = progress->map->offset,
                            .scale = (1.0 - progress->map->relaxation) * progress->scale,
                            .speed = progress->speed,
                            .held = progress->held};
}

// Goes through a section with Gauss panels as far as they are accurate. Returns the time they reach.
static double cross_softly(Progress* progress, const FcSection* section, const FcBells* bells) {
    const FcGaussPieces pieces = fc_section_pieces(section, bells, progress->decades);
    if (pieces.count == 0) {
        return section->start;
    }
    const double planned = (section->end - section->start) / pieces.count;
    int nodes = pieces.nodes;
    double h = planned;
    double t = section->start;
    while (t < section->end && progress->evaluations <= FC_MOST_EVALUATIONS) {
        const double left = section->end - t;
        h = h < 0.9 * left && t + h > t ? h : left;
        const FcTrajectories from = trajectories(progress);
        FcPanel panel;
        fc_gauss_panel(section->scene, t, h, nodes, &from, &panel);
        progress->evaluations += nodes;
        const double of_section = section->in_bell ? 1.0 : h / (section->end - section->start);
        if (fc_gauss_panel_is_accurate(&panel, nodes, of_section * section->share, section->in_bell,
                                       section->forgets, progress->tolerance)) {
            fc_map_append(progress->map, &panel.map);
            t = h < left ? t + h : section->end;
            if (panel.z < 0.2 * nodes) { // twice as much would still be resolved
                h = fc_least(planned, 2.0 * h);
            }
        } else if (nodes < FC_GAUSS_MOST_NODES) {
            nodes = fc_gauss_count(nodes + 1.0);
        } else if (h > 0.2 * planned && t + 0.5 * h > t) {
            h *= 0.5;
        } else {
            return t;
        }
    }
    return section->end;
}

// Goes through a section in one panel whose error is bounded beforehand, if it can.
static bool cross_in_one(Progress* progress, const FcSection* section, const FcStretch* stretch) {
    if (section->in_bell) {
        return false;
    }
    const FcTrajectories from = trajectories(progress);
    const double X = fc_stretch_displacement(stretch, &progress->scene->drive, section->start, section->end);
    FcPanel panel;
    if (!fc_bounded_panel(section->scene, &progress->motion, section->start, section->end - section->start, X,
                          section->z.whole, &from, &panel, &progress->evaluations)) {
        return false;
    }
    fc_map_append(progress->map, &panel.map);
    return true;
}

// Puts back what a bell at t, that was left out of the stretch on its side after (1) or before (-1), does.
static void put_back(Progress* progress, const FcBellInterval* bells, const FcStretch* stretch, double t,
                     const FcVelocity* at, double side) {
    const FcSmallBellPlace place = fc_small_bell_place(progress->scene, at, side, bells->fastest);
    const FcMap map =
        fc_small_bell(progress->scene, &bells->shape, &place, t, side, fc_sign(stretch->displacement));
    fc_map_append(progress->map, &map);
    progress->evaluations += 2.0;
}

// Whether a panel's error is small enough; *excess is how many times it is too large.
static bool is_accurate(const Progress* progress, const FcMesh* mesh, const FcStretch* stretch,
                        const FcPlan* plan, const FcPlace* at, const FcPanel* panel, double* excess) {
    const FcErrorLife life = {
        .lives = fc_least(plan->lives, progress->end - at->t) / progress->end,
        .lasts = plan->h / progress->end,
        .grows = fc_least(progress->motion.stiffness / panel->sigma, 1.0 + 2.0 * plan->lives / plan->grows),
        .in_bell = plan->in_bell,
        .crosses_bell = plan->crosses_bell,
    };
    const FcExcess over = fc_radau_panel_excess(panel, &life, progress->tolerance);
    *excess = over.mean;
    if (over.end > *excess) {
        *excess = fc_most(
            *excess, fc_mesh_left_at_end(mesh, stretch, at, at->t + plan->h, at->gone + panel->z) * over.end);
    }
    return *excess <= 1.0;
}

static void take(Progress* progress, FcPlace* at, const FcPanel* panel) {
    fc_map_append(progress->map, &panel->map);
    at->gone += panel->z;
    at->rate = panel->rate;
    at->path -= fabs(panel->displacement);
}

// Width [s] of the layer around a reversal, or a dip, at t, with sigma and g as they are at a time near it: beyond the interval
// the inputs are not known.
static double layer_at(const FcScene* scene, bool reversal, double t, FcPhase at_t,
                       const FcCoefficients* near) {
    const FcVelocity at = fc_drive_velocity_at_phase(&scene->drive, t, at_t);
    const double per_path = near->sigma / near->limit;
    return reversal ? fc_mesh_layer(&at, per_path) : fc_mesh_dip_layer(&at, per_path);
}

// Goes through a stretch from t to the end of a section with Radau panels.
static void cross(Progress* progress, const FcMesh* mesh, const FcStretch* stretch, double t, double end) {
    const FcScene* scene = progress->scene;
    const double sign = fc_sign(stretch->displacement);
    const bool from_start = t == stretch->start;
    const FcPhase phase = fc_stretch_phase(stretch, &scene->drive, t);
    const FcCoefficients start =
        from_start ? stretch->at_start : fc_scene_coefficients_at_phase(scene, t, phase);
    FcPanel panel = {.rate = -fc_coefficients_rate(&start), .sigma = start.sigma, .limit = start.limit};
    FcPlace at = {
        .t = t,
        .rate = panel.rate,
        .path = fabs(fc_stretch_displacement(stretch, &scene->drive, t, stretch->end)),
        .layer = from_start ? stretch->w_a : layer_at(scene, true, t, phase, &start),
    };
    FcSettling settling;
    fc_settling_init(&settling, scene, progress->beyond_bells, mesh, stretch, end);
    int caution = 0;
    double displacement = 0.0;
    progress->held = mesh->moving_limit ? 0.0 : sign * start.limit;
    while (at.t < end && progress->evaluations <= FC_MOST_EVALUATIONS && !isnan(progress->map->offset)) {
        const FcTrajectories from = trajectories(progress);
        at.lag = (fabs(sign * panel.limit - panel.sigma * from.delta_0) + panel.sigma * fabs(from.scale)) /
                 mesh->force;
        if (at.gone == 0.0) {
            at.transient = fc_least(at.lag, stretch->transient);
        }
        const bool in_bell = fc_in_bell(&stretch->bells, at.t);
        const FcScene* here = in_bell ? scene : progress->beyond_bells;
        double settled_to;
        if (fc_settle(&settling, &at, &panel, &settled_to, &progress->evaluations)) {
            take(progress, &at, &panel);
            at.t = settled_to;
            displacement += panel.displacement;
            continue;
        }
        FcPlan plan = fc_mesh_plan(mesh, stretch, &at, caution);
        const double left = end - at.t;
        plan.h = fc_least(plan.h, left);
        if (!(at.t + plan.h > at.t)) {
            plan.h = fc_least(left, fmax(4e-16 * stretch->end, DBL_MIN));
        }
        double excess;
        for (int tries = 0;; tries++) {
            fc_radau_panel(here, plan.stages, at.t, plan.h, sign, &from, &panel);
            progress->evaluations += plan.stages;
            if (is_accurate(progress, mesh, stretch, &plan, &at, &panel, &excess) || tries == MOST_TRIES) {
                caution -= tries == 0 && caution > 0;
                break;
            }
            if (plan.stages < FC_RADAU_MOST_STAGES) {
                plan.stages = FC_RADAU_MOST_STAGES;
            } else {
                plan.h *= fmax(0.4, 0.85 * pow(excess, -1.0 / 12.0)); // 0.4 where the error is no number
            }
            caution += caution < MOST_CAUTION;
        }
        take(progress, &at, &panel);
        if (!isfinite(excess)) {
            progress->map->offset = NAN; // beyond the largest number, which the step is refused for
        }
        displacement += panel.displacement;
        at.t = plan.h < left ? at.t + plan.h : end;
    }
    // The bristle is settled nearly everywhere: its force is the limit, and what the quadratures of work and heat miss is
    // that force times what they miss of the displacement.
    const double missed = fc_stretch_displacement(stretch, &scene->drive, t, end) - displacement;
    progress->map->work_offset += progress->held * missed;
    progress->map->heat_offset += progress->held * missed;
}

// Without stiffness there is no force: the bristle goes with V.
static FcMap slack_map(const FcScene* scene, double h) {
    FcMap map = fc_map_identity();
    map.offset = fc_drive_displacement(&scene->drive, 0.0, h);
    map.drag_offset = fc_drive_square(&scene->drive, 0.0, h);
    return map;
}

// |force - what it settles to| at the interval's start, over the mesh's force: the limit, but for the lag to first order in
// the time it takes to relax.
static double transient_at_start(const Progress* progress, const FcMesh* mesh, FcPhase phase) {
    const FcCoefficients* now = &progress->start;
    const FcLogRates rates = fc_scene_log_rates_at_phase(progress->scene, 0.0, phase);
    const double lag = (rates.sigma - rates.limit) / -fc_coefficients_rate(now);
    const FcTrajectories from = trajectories(progress);
    return (fabs(now->sigma * from.delta_0 - copysign(now->limit, now->V) * (1.0 + lag)) +
            now->sigma * fabs(from.scale)) /
           mesh->force;
}

// Layers at both ends of a stretch that begins at the interval's start, or at the event of the stretch before.
static void add_layers(const Progress* progress, const FcMesh* mesh, const FcStretch* before,
                       FcStretch* stretch) {
    const FcScene* scene = progress->scene;
    stretch->transient = INFINITY;
    if (stretch->start == 0.0) {
        const FcVelocity now = fc_drive_velocity_at_phase(&scene->drive, 0.0, stretch->start_phase);
        stretch->at_start = progress->start;
        stretch->w_a = fc_mesh_layer(&now, progress->start.sigma / progress->start.limit);
        stretch->back = fmax(stretch->w_a, fc_mesh_settled_back(&now));
        stretch->transient = transient_at_start(progress, mesh, stretch->start_phase);
    } else if (before->w_b > 0.0) {
        stretch->at_start = before->at_end;
        stretch->w_a = stretch->back = before->w_b;
    } else {
        stretch->at_start = fc_scene_coefficients_at_phase(scene, stretch->start, stretch->start_phase);
        stretch->w_a = stretch->back =
            layer_at(scene, before->reversal, stretch->start, stretch->start_phase, &stretch->at_start);
    }
    if (isfinite(stretch->event)) {
        stretch->at_end = fc_scene_coefficients_at_phase(scene, stretch->end, stretch->end_phase);
        stretch->w_b =
            layer_at(scene, stretch->reversal, stretch->event, stretch->event_phase, &stretch->at_end);
    }
}

// An event farther beyond the interval's end than the end is from t does not shape the panels that begin there.
static double horizon(double t, double duration) { return duration + (duration - t); }

// An interval so short that V, which moves by no more than it is, has no event and meets no bell, in one panel, if it can.
static bool interval_in_one(const FcScene* scene, const FcMotion* motion, FcPhase phase, double tolerance,
                            double duration, double delta_0, FcMapScope scope, FcMap* map,
                            double* evaluations) {
    const FcDrive* drive = &scene->drive;
    const double moves = duration * (fabs(drive->V.rate) + drive->vibration.V_1 * drive->omega);
    const double speed = fabs(fc_drive_V_at_phase(drive, 0.0, phase));
    const double saturation = motion->limit / motion->stiffness;
    if (!(duration > 0.0 && speed > moves && (speed - moves) * duration <= FC_MOST_BOUNDED * saturation) ||
        !fc_is_beyond_bells(scene->friction, speed - moves, fabs(delta_0) / saturation, tolerance)) {
        return false;
    }
    const double X = fc_drive_displacement(drive, 0.0, duration);
    const FcTrajectories from = {
        .delta_0 = delta_0,
        .scale = scope == FC_MAP_ANY_START ? fmax(fabs(delta_0), saturation) : 0.0,
        .speed = fc_drive_largest_speed(drive, duration),
    };
    FcPanel panel;
    if (!fc_bounded_panel(scene, motion, 0.0, duration, X, fabs(X) / saturation, &from, &panel,
                          evaluations)) {
        return false;
    }
    *map = panel.map;
    return true;
}

static FcMap map_of(const FcScene* scene, const FcScene* beyond_bells, const FcSolverOptions* options,
                    double duration, double delta_0, FcMapScope scope, double* evaluations) {
    const FcDrive* drive = &scene->drive;
    const double force = fc_scene_force_scale(scene);
    const double largest_stiffness = fc_scene_largest_stiffness(scene, duration);
    if (!isfinite(force / largest_stiffness)) {
        return slack_map(scene, duration);
    }
    const bool for_one_start = scope == FC_MAP_THIS_START;
    const FcMotion motion = fc_motion(scene, duration, largest_stiffness, options->tolerance * force);
    const FcPhase start_phase = fc_drive_phase(drive, 0.0);
    FcMap whole;
    if (interval_in_one(scene, &motion, start_phase, options->tolerance, duration, delta_0, scope, &whole,
                        evaluations)) {
        return whole;
    }
    const FcCoefficients start = fc_scene_coefficients_at_phase(scene, 0.0, start_phase);
    FcMap map = fc_map_identity();
    Progress progress = {
        .scene = scene,
        .beyond_bells = beyond_bells,
        .map = &map,
        .end = duration,
        .tolerance = options->tolerance * force,
        .start = start,
        .per_deflection = start.sigma / start.limit,
        .speed = fc_drive_largest_speed(drive, duration) + 1e-300,
        .decades = fc_digits(options->tolerance),
        .evaluations = *evaluations,
        .motion = motion,
    };
    if (for_one_start) {
        map.relaxation = 1.0;
        map.offset = delta_0;
    } else {
        progress.scale = fmax(fabs(delta_0), start.limit / start.sigma);
    }
    const bool has_bells = fc_has_stribeck_curve(scene->friction);
    FcBellInterval bells;
    FcBellEdge edge;
    if (has_bells) {
        bells = fc_bell_interval(scene, duration, options->tolerance);
        edge = fc_bell_edge(scene, 0.0);
    }
    FcMesh mesh;
    bool has_mesh = false;
    FcStretch before = {.reversal = true, .end_phase = start_phase};
    FcDriveEvent event = fc_drive_next_event(drive, 0.0, horizon(0.0, duration));
    const FcPhase last_phase = fc_drive_phase(drive, duration);
    FcPhase end_phase = event.time < duration ? event.phase : last_phase;
    double displacement =
        fc_drive_displacement_between(drive, 0.0, start_phase, fc_least(event.time, duration), end_phase);
    while (before.end < duration && progress.evaluations <= FC_MOST_EVALUATIONS) {
        FcStretch stretch = {
            .start = before.end,
            .end = fc_least(event.time, duration),
            .event = event.time < duration + (duration - before.end) ? event.time : INFINITY,
            .reversal = event.reversal,
            .start_phase = before.end_phase,
            .end_phase = end_phase,
            .event_phase = event.phase,
            .displacement = displacement,
        };
        if (stretch.end < duration) {
            event = fc_drive_event_after(drive, &event, horizon(stretch.end, duration));
            end_phase = event.time < duration ? event.phase : last_phase;
            displacement = fc_drive_displacement_between(drive, stretch.end, stretch.end_phase,
                                                         fc_least(event.time, duration), end_phase);
            stretch.path_after = fabs(displacement);
        }
        stretch.bells = (FcBells){.after = stretch.start, .before = stretch.end};
        if (has_bells) {
            const FcBellEdge first = edge;
            edge = fc_bell_edge(scene, stretch.end);
            const FcTrajectories from = trajectories(&progress);
            const double deflection = fc_most(fabs(from.delta_0), fabs(from.scale));
            stretch.bells =
                fc_bells(&bells, &first, &edge, deflection, stretch.displacement, stretch.path_after);
        }
        FcSection sections[FC_MOST_SECTIONS];
        const int count = fc_sections(scene, beyond_bells, &stretch, progress.per_deflection,
                                      motion.stiffness / motion.limit, sections, &progress.evaluations);
        bool has_layers = false;
        double t = stretch.start;
        if (stretch.bells.small_at_start) {
            put_back(&progress, &bells, &stretch, t, &stretch.bells.at_start, 1.0);
        }
        for (int i = 0; i < count; i++) {
            const FcSection* section = &sections[i];
            if (section->soft && t == section->start) {
                t = cross_in_one(&progress, section, &stretch)
                        ? section->end
                        : cross_softly(&progress, section, &stretch.bells);
            }
            if (t < section->end && (i + 1 == count || sections[i + 1].soft)) {
                if (!has_mesh) {
                    mesh = fc_mesh_make(scene, duration, options->tolerance);
                    has_mesh = true;
                }
                if (!has_layers) {
                    add_layers(&progress, &mesh, &before, &stretch);
                    has_layers = true;
                }
                stretch.relaxes = section->is_measured && t == stretch.start ? section->z.whole : 0.0;
                cross(&progress, &mesh, &stretch, t, section->end);
                t = section->end;
            }
        }
        if (stretch.bells.small_at_end) {
            put_back(&progress, &bells, &stretch, stretch.end, &stretch.bells.at_end, -1.0);
        }
        before = stretch;
    }
    *evaluations = progress.evaluations;
    return map;
}

FcMap fc_collocation_interval(const FcScene* scene, const FcSolverOptions* options, double duration,
                              double delta_0, FcMapScope scope, double* evaluations) {
    assert(duration >= 0.0 && options->tolerance > 0.0);
    FcMap map;
    if (fc_is_constant_contact(scene) && fc_constant_contact_interval(scene, options->tolerance, duration,
                                                                      delta_0, scope, &map, evaluations)) {
        return map;
    }
    if (!fc_has_stribeck_curve(scene->friction)) {
        return map_of(scene, scene, options, duration, delta_0, scope, evaluations);
    }
    FcSceneBeyondBells beyond;
    fc_scene_beyond_bells(scene, &beyond);
    return map_of(scene, &beyond.scene, options, duration, delta_0, scope, evaluations);
}

void fc_collocation_constant(const FcScene* scene, double h, double delta_0, FcStepResult* result) {
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    const FcMap map = fc_map_of_constant_scene(&at, h);
    *result = (FcStepResult){.delta = delta_0, .evaluations = 1.0};
    fc_map_apply(&map, result);
}
