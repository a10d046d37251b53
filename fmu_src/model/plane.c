#include "model/plane.h"

#include <assert.h>
#include <math.h>

void fc_plane_make(FcPlane* plane, const FcScene* scene) {
    plane->scene = scene;
    plane->is_one_dimensional = !fc_drive_is_planar(&scene->drive);
    plane->static_friction = *scene->friction;
    if (fc_has_bristle(scene->friction)) { // whose contact may be open
        plane->static_friction.model = FC_ELASTIC_PLASTIC;
    }
    const double ratio = fc_static_ratio(scene->friction);
    assert(!(ratio < 1.0));
    plane->static_friction.mu *= ratio;
    plane->static_friction.staticRatio = 1.0;
    plane->of_static_limit = *scene;
    plane->of_static_limit.F_C *= ratio;
    plane->of_static_limit.friction = &plane->static_friction;
}

FcPlaneCoefficients fc_plane_coefficients(const FcPlane* plane, double t, FcPhase at_t) {
    const FcFriction* friction = plane->scene->friction;
    const FcCoefficients at = fc_scene_coefficients_at_phase(&plane->of_static_limit, t, at_t);
    const FcVector V = {at.V, fc_drive_V_y_at_phase(&plane->scene->drive, t, at_t)};
    const double speed = plane->is_one_dimensional ? fabs(V.x) : hypot(V.x, V.y);
    return (FcPlaneCoefficients){.V = V,
                                 .speed = speed,
                                 .sigma = at.sigma,
                                 .limit = at.limit / fc_static_over_limit(friction, speed),
                                 .static_limit = at.limit};
}

// Rate of ln s(|V|), Stribeck's curve: s' / s times the rate of |V|.
static double log_curve_rate(const FcPlane* plane, const FcPlaneCoefficients* at, double t, FcPhase at_t) {
    const FcFriction* friction = plane->scene->friction;
    const FcDrive* drive = &plane->scene->drive;
    if (at->speed == 0.0) {
        return 0.0;
    }
    const FcVector V_rate = {fc_drive_velocity_at_phase(drive, t, at_t).rate,
                             fc_drive_velocity_y_at_phase(drive, t, at_t).rate};
    const double speed_rate = fc_product(at->V, V_rate) / at->speed;
    return fc_stribeck_slope(friction, at->speed) / fc_stribeck(friction, at->speed) * speed_rate;
}

static double limit_of_bound(const FcPlane* plane, const FcPlaneCoefficients* at, FcBristleState state) {
    return fc_has_broken_away(plane->scene->friction, state) ? at->limit : at->static_limit;
}

double fc_plane_radius(const FcPlane* plane, const FcPlaneCoefficients* at, FcBristleState state) {
    return limit_of_bound(plane, at, state) / at->sigma;
}

FcPlaneBound fc_plane_bound(const FcPlane* plane, const FcPlaneCoefficients* at, FcBristleState state,
                            double t, FcPhase at_t) {
    const FcLogRates rates = fc_scene_log_rates(&plane->of_static_limit, t, at_t);
    const double by_curve =
        fc_has_broken_away(plane->scene->friction, state) ? log_curve_rate(plane, at, t, at_t) : 0.0;
    const double limit = limit_of_bound(plane, at, state);
    const double D = limit / at->sigma;
    assert(!(D < 0.0));
    return (FcPlaneBound){limit, D, D * (rates.ratio + by_curve), rates.sigma};
}

double fc_plane_push(const FcPlane* plane, const FcPlaneCoefficients* at, const FcPlaneBound* bound,
                     FcVector n) {
    return fc_product(n, at->V) - fc_plane_relaxation(plane, at) * bound->D - bound->rate;
}

FcPlaneBound fc_bound(const FcPlane* plane, FcBristleState state, double t) {
    const FcPhase phase = fc_drive_phase(&plane->scene->drive, t);
    const FcPlaneCoefficients at = fc_plane_coefficients(plane, t, phase);
    return fc_plane_bound(plane, &at, state, t, phase);
}

double fc_push_at(void* context, double t) {
    const FcPushed* of = context;
    const FcPhase phase = fc_drive_phase(&of->plane->scene->drive, t);
    const FcPlaneCoefficients at = fc_plane_coefficients(of->plane, t, phase);
    const FcPlaneBound bound = fc_plane_bound(of->plane, &at, of->state, t, phase);
    return fc_plane_push(of->plane, &at, &bound, of->n);
}
