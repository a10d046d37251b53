#include "solver/constant_step.h"

#include <assert.h>
#include <math.h>

#include "solver/affine_map.h"

// Along V as on a line, transverse to V by relaxation alone.
void fc_constant_step(const FcScene* scene, const FcContactResponse* contact, double h, FcBristle from,
                      FcStepResult* result) {
    assert(h >= 0.0 && fc_drive_is_constant(&scene->drive));
    assert(!fc_scene_is_separated(scene));
    FcCoefficients at = fc_scene_coefficients_of(scene, contact);
    if (!fc_is_planar(scene, from)) {
        const FcMap map = fc_map_of_constant_scene(&at, h);
        fc_result_start(result, (FcBristle){.delta = from.delta}, 1.0);
        fc_map_apply(&map, result);
        return;
    }
    const FcVector V = {at.V, fc_drive_V_y(&scene->drive, 0.0)};
    const double speed = hypot(V.x, V.y);
    const FcVector n = fc_direction(V, (FcVector){1.0, 0.0});
    at.limit *= fc_stribeck(scene->friction, speed) / fc_stribeck(scene->friction, at.V);
    at.V = speed;
    const FcMap along = fc_map_of_constant_scene(&at, h);
    const FcMap across = {.relaxation = along.relaxation,
                          .impulse_slope = along.impulse_slope,
                          .heat_square = along.heat_square};
    FcStepResult turned = {.delta = n.x * from.delta + n.y * from.delta_y,
                           .delta_y = n.x * from.delta_y - n.y * from.delta,
                           .evaluations = 1.0};
    fc_map_apply(&along, &turned);
    fc_map_apply_across(&across, &turned);
    *result = turned;
    result->delta = n.x * turned.delta - n.y * turned.delta_y;
    result->delta_y = n.y * turned.delta + n.x * turned.delta_y;
    result->impulse = n.x * turned.impulse - n.y * turned.impulse_y;
    result->impulse_y = n.y * turned.impulse + n.x * turned.impulse_y;
}

FcBristle fc_steady_sliding(const FcScene* scene, FcBristle from, FcVector* force) {
    assert(fc_drive_is_constant(&scene->drive) && !fc_scene_is_separated(scene));
    FcPlane plane;
    fc_plane_make(&plane, scene);
    const FcPlaneCoefficients at = fc_plane_coefficients(&plane, 0.0, fc_drive_phase(&scene->drive, 0.0));
    const bool has_bristle = fc_has_bristle(scene->friction);
    if (at.speed == 0.0 || !isfinite(at.limit / at.sigma)) {
        *force =
            has_bristle ? (FcVector){at.sigma * from.delta, at.sigma * from.delta_y} : fc_plane_coulomb(&at);
        return from;
    }
    *force = fc_plane_coulomb(&at);
    if (!has_bristle) {
        return from;
    }
    const FcBristle end = {.delta = force->x / at.sigma, .delta_y = force->y / at.sigma};
    const bool slips = fc_has_static_friction(scene->friction);
    return (FcBristle){.delta = end.delta, .state = slips ? FC_SLIPPING : FC_FREE, .delta_y = end.delta_y};
}
