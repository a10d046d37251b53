#include "solver/stribeck_bell.h"

#include <math.h>

#include "solver/mesh.h"
#include "solver/panel.h"

// Of the tolerance: what the curve may leave beyond a bell, and what a bell may do that is left out.
static const double BEYOND = 0.01;
static const double LEFT_OUT = 0.01;
// Of the tolerance: what may be missed of a bell that is put back in closed form.
static const double SMALL = 0.1;
// Of such a bell: by how much V' and sigma may change in it, and |V| over V_S where it begins.
static const double MOST_CHANGE = 0.5;
static const double AT_REVERSAL = 1e-6;
// Of a width that was estimated too short.
enum { MOST_GROWTHS = 32 };

void fc_scene_beyond_bells(const FcScene* scene, FcSceneBeyondBells* beyond) {
    beyond->friction = *scene->friction;
    beyond->friction.staticRatio = 1.0;
    beyond->scene = *scene;
    beyond->scene.friction = &beyond->friction;
}

bool fc_is_beyond_bells(const FcFriction* friction, double speed, double force, double tolerance) {
    if (!fc_has_stribeck_curve(friction)) {
        return true;
    }
    const double excess = friction->staticRatio - 1.0;
    const double most = fc_most(1.0 + excess, force);
    const double ratio = speed / friction->V_S;
    return excess * most * most * exp(-ratio * ratio) <= BEYOND * tolerance;
}

FcBellInterval fc_bell_interval(const FcScene* scene, double duration, double tolerance) {
    const double excess = scene->friction->staticRatio - 1.0;
    const FcSmoothness smooth = fc_mesh_smoothness(scene, duration);
    const bool follows = smooth.follows_d_and_E || fc_limit_follows_load(scene->friction);
    return (FcBellInterval){
        .scene = scene,
        .duration = duration,
        .tolerance = tolerance,
        .excess = excess,
        .per_path = fc_scene_largest_stiffness(scene, duration) / fc_scene_smallest_limit(scene, duration),
        .saturation = fc_mesh_largest_saturation(scene, duration),
        .path = fc_drive_largest_speed(&scene->drive, duration) * duration,
        .shape = fc_bell_shape(scene->friction->staticRatio),
        .fastest = follows ? INFINITY : smooth.rate,
    };
}

FcBellEdge fc_bell_edge(const FcScene* scene, double t) {
    const FcVelocity at = fc_drive_velocity(&scene->drive, t);
    return (FcBellEdge){.t = t, .at = at, .tau = fc_velocity_time_of_change(&at, scene->friction->V_S)};
}

// Width [s] of the bell that goes on from the edge to the side (1 or -1): until |V| is the reach [m/s].
static double width(const FcDrive* drive, const FcBellEdge* edge, double side, double reach, double most) {
    const double V = fabs(edge->at.V);
    if (V >= reach) {
        return 0.0;
    }
    double x = fc_velocity_time_of_change(&edge->at, reach - V);
    for (int i = 0; x < most && i < MOST_GROWTHS; i++) {
        if (fabs(fc_drive_V(drive, edge->t + side * x)) >= reach) {
            return x;
        }
        x *= 1.5;
    }
    return most;
}

// What of a stretch matters to its bells.
typedef struct {
    double force;   // 1, that the bristle may have, over the limit
    double forgets; // 1, up to 1: by how much the bristle relaxes until the event after next, at the least
} Stretch;

// While V goes through a bell the bristle relaxes by dz at the most, and by that part of the excess the force then
// differs.
static double dz(const FcBellInterval* interval, const FcBellEdge* edge) {
    return fc_least(interval->per_path * interval->scene->friction->V_S * edge->tau, 1.0);
}

// The heat sigma r delta^2 goes with 1 / g: the part of it that is made in the bell.
static double of_heat(const FcBellInterval* interval, const FcBellEdge* edge) {
    return fc_least(interval->scene->friction->V_S * edge->tau / interval->path, 1.0);
}

// |V| over V_S beyond which the rest of the curve, e^(-(V / V_S)^2) of the bell, is not seen. What differs adds up until
// it is forgotten.
static double reach(const FcBellInterval* interval, const Stretch* stretch, const FcBellEdge* edge) {
    const double force = fc_most(1.0, stretch->force);
    const double seen = interval->excess * force *
                        fc_most(fc_least(dz(interval, edge) / stretch->forgets, 1.0),
                                stretch->force * of_heat(interval, edge));
    return sqrt(log(fc_most(1.0, seen / (BEYOND * interval->tolerance))));
}

// Whether a bell is too narrow to be seen. What differs lasts until it is forgotten, which the path after tells.
static bool is_left_out(const FcBellInterval* interval, const Stretch* stretch, const FcBellEdge* edge,
                        double path_after) {
    const double allowed = LEFT_OUT * interval->tolerance;
    const double lasts = interval->excess * stretch->force * dz(interval, edge);
    const double heat = interval->excess * stretch->force * stretch->force * of_heat(interval, edge);
    if (lasts + heat <= allowed) {
        return true;
    }
    const bool seen_at_end = path_after < (6.0 - log(interval->tolerance)) * interval->saturation;
    if (heat > allowed || (lasts > allowed && seen_at_end)) {
        return false;
    }
    const double layer = fc_mesh_layer(&edge->at, 1.0 / interval->saturation);
    const double memory = fmin(interval->duration, edge->tau + layer);
    return lasts * memory / interval->duration + heat <= allowed;
}

// Whether a bell on the side (1 or -1) of an edge may be put back in closed form, all of it, in a stretch of that length [s].
static bool is_small(const FcBellInterval* interval, const Stretch* stretch, const FcBellEdge* edge,
                     double side, double sign, double length, double reach) {
    const FcFriction* friction = interval->scene->friction;
    const double V_S = friction->V_S;
    if (!interval->shape.is_known || !(side * sign * edge->at.rate > 0.0) ||
        fabs(edge->at.V) > AT_REVERSAL * V_S) {
        return false;
    }
    const FcSmallBellPlace place = fc_small_bell_place(interval->scene, &edge->at, side, interval->fastest);
    if (!(place.changes * reach <= MOST_CHANGE) || 3.0 * reach * place.tau > length) {
        return false;
    }
    const double damping = friction->sigma_1 * V_S / interval->scene->F_C;
    const FcSmallBellError error =
        fc_small_bell_error(&place, &interval->shape, V_S, interval->per_path, stretch->force, damping);
    const double allowed = SMALL * interval->tolerance;
    return error.lasts <= allowed * stretch->forgets &&
           error.impulse / interval->duration + error.work / interval->path <= allowed;
}

// Whether |V| may fall below the speed between the edges. Minima that are no events lie above half of |V| and V_1.
static bool may_dip_inside(const FcDrive* drive, double start, double end, double speed) {
    const double V_1 = drive->vibration.V_1;
    const double V_start = drive->V.value + drive->V.rate * start;
    const double V_end = drive->V.value + drive->V.rate * end;
    return fabs(drive->V.rate) < V_1 * drive->omega && speed > 0.5 * (fmin(fabs(V_start), fabs(V_end)) + V_1);
}

FcBells fc_bells(const FcBellInterval* interval, const FcBellEdge* start, const FcBellEdge* end,
                 double deflection, double displacement, double path_after) {
    const FcDrive* drive = &interval->scene->drive;
    const double V_S = interval->scene->friction->V_S;
    const double path = fabs(displacement);
    const double sign = fc_sign(displacement);
    const double per_path = interval->per_path;
    const Stretch stretch = {
        .force =
            fc_most(per_path * deflection, fc_least(1.0 + interval->excess, per_path * (deflection + path))),
        .forgets = fc_least((path + path_after) / interval->saturation, 1.0),
    };
    const double after = reach(interval, &stretch, start);
    const double before = reach(interval, &stretch, end);
    const double length = end->t - start->t;
    const double widest = fc_most(after, before);
    FcBells bells = {.after = start->t,
                     .before = end->t,
                     .at_start = start->at,
                     .at_end = end->at,
                     .reach = widest,
                     .digits = log10(10.0 * BEYOND) + 0.4343 * widest * widest};
    FcBells all = bells;
    all.after = end->t;
    if (may_dip_inside(drive, start->t, end->t, bells.reach * V_S)) {
        return all;
    }
    if (after > 0.0 && !is_left_out(interval, &stretch, start, path)) {
        bells.small_at_start = is_small(interval, &stretch, start, 1.0, sign, length, after);
        if (!bells.small_at_start) {
            bells.after += width(drive, start, 1.0, after * V_S, length);
        }
    }
    if (before > 0.0 && !is_left_out(interval, &stretch, end, path_after)) {
        bells.small_at_end = is_small(interval, &stretch, end, -1.0, sign, length, before);
        if (!bells.small_at_end) {
            bells.before -= width(drive, end, -1.0, before * V_S, length);
        }
    }
    return bells.after < bells.before ? bells : all;
}
