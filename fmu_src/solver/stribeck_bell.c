#include "solver/stribeck_bell.h"

#include <math.h>

#include "solver/mesh.h"

// Of the tolerance: what the curve may leave beyond a bell, and what a bell may do that is left out.
static const double BEYOND = 0.01;
static const double LEFT_OUT = 0.01;
// Of a width that was estimated too short.
enum { MOST_GROWTHS = 32 };

void fc_scene_beyond_bells(const FcScene* scene, FcSceneBeyondBells* beyond) {
    beyond->friction = *scene->friction;
    beyond->friction.staticRatio = 1.0;
    beyond->scene = *scene;
    beyond->scene.friction = &beyond->friction;
}

// Width [s] of the bell at t, at most `most`, that goes on to the side (1 or -1): until |V| is the reach [m/s].
static double width(const FcDrive* drive, double t, double side, double reach, double most) {
    const double V = fabs(fc_drive_V(drive, t));
    if (V >= reach) {
        return 0.0;
    }
    double x = fc_drive_time_of_change(drive, t, reach - V);
    for (int i = 0; x < most && i < MOST_GROWTHS; i++) {
        if (fabs(fc_drive_V(drive, t + side * x)) >= reach) {
            return x;
        }
        x *= 1.5;
    }
    return most;
}

// Whether a bell at t is too narrow to be seen, in a stretch of that path [m], with sigma / g per_path [1/m] at the most.
// While V goes through it the bristle relaxes by at most dz; by dz of itself the force then differs, until it is
// forgotten, which the path after tells; and the heat sigma r delta^2 goes with 1 / g in it.
static bool is_left_out(const FcScene* scene, const FcBellStretch* stretch, double path, double per_path,
                        double t, double path_after) {
    const FcDrive* drive = &scene->drive;
    const double V_S = scene->friction->V_S;
    const double excess = scene->friction->staticRatio - 1.0;
    const double tau = fc_drive_time_of_change(drive, t, V_S);
    const double force =
        fmax(per_path * stretch->deflection, fmin(1.0 + excess, per_path * (stretch->deflection + path)));
    const double dz = fmin(1.0, per_path * V_S * tau);
    const double lasts = excess * force * dz;
    const double memory = fmin(stretch->interval, tau + fc_mesh_relaxation_layer(scene, t, t));
    const double speed = fc_drive_largest_speed(drive, stretch->interval);
    const double of_heat = excess * force * force * V_S * tau / (speed * stretch->interval);
    const double allowed = LEFT_OUT * stretch->tolerance;
    const bool seen_at_end =
        path_after < (6.0 - log(stretch->tolerance)) * fc_mesh_largest_saturation(scene, stretch->interval);
    return lasts * memory / stretch->interval + of_heat <= allowed && (lasts <= allowed || !seen_at_end);
}

// Whether |V| may fall below the reach between the stretch's ends. Minima that are no events lie above half of |V| and V_1.
static bool may_dip_inside(const FcDrive* drive, const FcBellStretch* stretch, double reach) {
    const double V_1 = drive->vibration.V_1;
    const double V_start = drive->V.value + drive->V.rate * stretch->start;
    const double V_end = drive->V.value + drive->V.rate * stretch->end;
    return fabs(drive->V.rate) < V_1 * drive->omega && reach > 0.5 * (fmin(fabs(V_start), fabs(V_end)) + V_1);
}

FcBells fc_bells(const FcScene* scene, const FcBellStretch* stretch) {
    FcBells bells = {stretch->start, stretch->end};
    const double excess = scene->friction->staticRatio - 1.0;
    const double per_path = fc_scene_largest_stiffness(scene, stretch->interval) /
                            fc_scene_smallest_limit(scene, stretch->interval); // 1/m
    // The curve's rest moves the force by that part of it, and the force may be far beyond the limit.
    const double beyond = BEYOND * stretch->tolerance / fmax(1.0, per_path * stretch->deflection);
    if (excess <= beyond) {
        return bells;
    }
    const double reach = scene->friction->V_S * sqrt(log(excess / beyond));
    const double length = stretch->end - stretch->start;
    if (may_dip_inside(&scene->drive, stretch, reach)) {
        return (FcBells){stretch->end, stretch->end};
    }
    const double after = width(&scene->drive, stretch->start, 1.0, reach, length);
    const double before = width(&scene->drive, stretch->end, -1.0, reach, length);
    const double path = fabs(fc_drive_displacement(&scene->drive, stretch->start, stretch->end));
    if (after > 0.0 && !is_left_out(scene, stretch, path, per_path, stretch->start, path)) {
        bells.after = stretch->start + after;
    }
    if (before > 0.0 && !is_left_out(scene, stretch, path, per_path, stretch->end, stretch->path_after)) {
        bells.before = stretch->end - before;
    }
    if (!(bells.after < bells.before)) {
        bells = (FcBells){stretch->end, stretch->end};
    }
    return bells;
}
