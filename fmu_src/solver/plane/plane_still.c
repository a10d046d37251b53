#include "solver/plane/plane_still.h"

#include <math.h>

#include "solver/affine_map.h"

static FcPlaneCoefficients at_start(const FcScene* scene) {
    FcPlane plane;
    fc_plane_make(&plane, scene);
    return fc_plane_coefficients(&plane, 0.0, fc_drive_phase(&scene->drive, 0.0));
}

// Along V as on a line, transverse to V by relaxation alone.
void fc_plane_constant(const FcScene* scene, double h, FcStepResult* result) {
    const FcPlaneCoefficients at = at_start(scene);
    const FcVector n =
        at.speed > 0.0 ? (FcVector){at.V.x / at.speed, at.V.y / at.speed} : (FcVector){1.0, 0.0};
    const FcMap along = fc_map_of_constant_scene(&(FcCoefficients){at.speed, at.sigma, at.limit}, h);
    const FcMap across = {.relaxation = along.relaxation,
                          .impulse_slope = along.impulse_slope,
                          .heat_square = along.heat_square};
    FcStepResult turned = {.delta = n.x * result->delta + n.y * result->delta_y,
                           .delta_y = n.x * result->delta_y - n.y * result->delta,
                           .evaluations = 1.0};
    fc_map_apply(&along, &turned);
    fc_map_apply_across(&across, &turned);
    *result = turned;
    result->delta = n.x * turned.delta - n.y * turned.delta_y;
    result->delta_y = n.y * turned.delta + n.x * turned.delta_y;
    result->impulse = n.x * turned.impulse - n.y * turned.impulse_y;
    result->impulse_y = n.y * turned.impulse + n.x * turned.impulse_y;
}

FcBristle fc_plane_slides_for_ever(const FcScene* scene, FcBristle from, FcVector* force) {
    const FcPlaneCoefficients at = at_start(scene);
    const bool has_bristle = scene->friction->model != FC_COULOMB;
    if (at.speed == 0.0) {
        *force = (FcVector){at.sigma * from.delta, at.sigma * from.delta_y};
        return from;
    }
    *force = fc_plane_coulomb(&at);
    return has_bristle ? (FcBristle){.delta = force->x / at.sigma,
                                     .slips = fc_has_static_friction(scene->friction),
                                     .delta_y = force->y / at.sigma}
                       : from;
}
