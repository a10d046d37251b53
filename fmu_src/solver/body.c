#include "solver/body.h"

#include <assert.h>
#include <math.h>

#include "model/extremes.h"
#include "model/regime.h"
#include "solver/pieces.h"

double fc_body_inertia(const FcScene* scene, FcRegime regime, FcBristle bristle, const FcBody* body) {
    if (regime == FC_FREE || !fc_has_static_friction(scene->friction) || scene->friction->sigma_1 == 0.0) {
        return body->m;
    }
    const double change = 1.0 + fabs(scene->drive.V.rate); // F_t is linear in the rate of w
    FcScene faster = *scene;
    faster.drive.V.rate += change;
    const double F_t = fc_motion(scene, regime, bristle).force.x;
    return body->m + (fc_motion(&faster, regime, bristle).force.x - F_t) / change;
}

double fc_body_acceleration(const FcScene* scene, FcRegime regime, FcBristle bristle, const FcBody* body,
                            double F) {
    const double inertia = fc_body_inertia(scene, regime, bristle, body);
    return (F - fc_motion(scene, regime, bristle).force.x) / fc_most(inertia, FC_LEAST_INERTIA * body->m);
}

FcScene fc_body_scene(const FcScene* scene, const FcBody* body, FcBristle bristle) {
    FcScene seen = *scene;
    seen.drive.V.value += body->v;
    if (seen.friction->model != FC_COULOMB) {
        const bool slips = bristle.slips != 0;
        const FcRegime regime = slips ? (FcRegime)fc_side(bristle) : fc_regime(&seen, bristle);
        seen.drive.V.rate += fc_body_acceleration(&seen, regime, bristle, body, body->F.value);
    }
    return seen;
}

bool fc_body_step(const FcScene* scene, FcCvode* cvode, const FcSolverOptions* options, double h,
                  FcBristle from, FcBody* body, FcStepResult* result, FcMessage* message) {
    assert(h >= 0.0 && body->m > 0.0 && !fc_is_planar(scene, from));
    fc_result_start(result, from, 0.0);
    FcPieces pieces;
    fc_pieces_start(&pieces, scene, h);
    while (fc_next_piece(&pieces)) {
        const bool is_loose = fc_scene_is_loose(pieces.scene);
        if (is_loose) {
            fc_loose_step(result);
        }
        const bool is_rigid = is_loose || scene->friction->model == FC_COULOMB;
        if (is_rigid ? !fc_body_rigid_step(pieces.scene, options, pieces.h, body, result, message)
                     : !fc_body_cvode_step(cvode, pieces.scene, options, pieces.h, body, result, message)) {
            return false;
        }
    }
    return true;
}
