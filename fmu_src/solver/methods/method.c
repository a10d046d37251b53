#include "solver/methods/method.h"

#include <assert.h>
#include <math.h>

#include "model/regime.h"
#include "solver/budget.h"
#include "solver/march/march.h"
#include "solver/methods/methods.h"
#include "solver/pieces.h"
#include "solver/plane/plane_march.h"
#include "solver/plane/plane_still.h"

static FcMap coulomb_map(const FcScene* scene, const FcSolverOptions* options, double duration,
                         double delta_0, FcMap* across, double* evaluations) {
    (void)across;
    FcStepResult part = {.delta = delta_0, .evaluations = *evaluations};
    fc_coulomb_step(scene, options, duration, &part);
    *evaluations = part.evaluations;
    return (FcMap){.impulse_offset = part.impulse, .work_offset = part.work, .heat_offset = part.heat};
}

static void free_step(const FcScene* scene, const FcSolverOptions* options, double duration,
                      FcStepResult* result) {
    const FcMap map = fc_collocation_interval(scene, options, duration, result->delta, FC_MAP_THIS_START,
                                              &result->evaluations);
    fc_map_apply(&map, result);
}

static FcMap free_map(const FcScene* scene, const FcSolverOptions* options, double duration, double delta_0,
                      FcMap* across, double* evaluations) {
    (void)across;
    return scene->friction->model == FC_ELASTIC_PLASTIC
               ? fc_march_stuck(scene, options, duration, evaluations)
               : fc_collocation_interval(scene, options, duration, delta_0, FC_MAP_ANY_START, evaluations);
}

static bool may_touch_bound(const FcScene* scene) {
    return fc_is_bounded(scene->friction) && fc_march_may_touch(scene);
}

// The integration of the law by the default method.
static FcIntegration integration(const FcScene* scene, bool is_planar) {
    if (is_planar) {
        return (FcIntegration){fc_plane_step, fc_plane_map, may_touch_bound(scene), true};
    }
    if (scene->friction->model == FC_COULOMB) {
        return (FcIntegration){fc_coulomb_step, coulomb_map, false, false};
    }
    const bool bounded = may_touch_bound(scene);
    return (FcIntegration){bounded ? fc_march_step : free_step, free_map, bounded, false};
}

// By cvode or a fixed step, piece by piece.
static bool other_step(const FcScene* scene, FcMethod method, FcCvode* cvode, const FcSolverOptions* options,
                       double h, FcStepResult* result, FcMessage* message) {
    FcPieces pieces;
    fc_pieces_start(&pieces, scene, h);
    while (fc_next_piece(&pieces)) {
        if (fc_scene_is_loose(pieces.scene)) {
            fc_loose_step(result);
        } else if (method == FC_METHOD_CVODE
                       ? !fc_cvode_step(cvode, pieces.scene, options, pieces.h, result, message)
                       : !fc_fixed_step(pieces.scene, method, options, pieces.h, result, message)) {
            return false;
        }
    }
    return true;
}

static bool is_affine(const FcScene* scene) {
    return scene->friction->model == FC_DAHL || scene->friction->model == FC_LUGRE;
}

// Whether the method leaves the scene to the default.
static bool takes_default(const FcScene* scene, FcMethod method) {
    return !is_affine(scene) || method == FC_METHOD_COLLOCATION ||
           (method == FC_METHOD_CVODE && may_touch_bound(scene));
}

bool fc_method_formula(const FcScene* scene, const FcContactResponse* contact, FcMethod method, double h,
                       FcBristle from, FcStepResult* result) {
    assert(fc_drive_is_constant(&scene->drive));
    if (!is_affine(scene) || fc_scene_is_loose(scene) || !takes_default(scene, method)) {
        return false;
    }
    *result = fc_result_from(from, 0.0);
    if (fc_is_planar(scene, from)) {
        fc_plane_constant(scene, h, result);
    } else {
        fc_collocation_constant(scene, contact, h, from.delta, result);
    }
    return true;
}

bool fc_method_step(const FcScene* scene, FcMethod method, FcCvode* cvode, const FcSolverOptions* options,
                    double h, FcBristle from, FcStepResult* result, FcMessage* message) {
    assert(h >= 0.0 && options->tolerance > 0.0 && options->step_size > 0.0);
    *result = fc_result_from(from, 0.0);
    const bool is_planar = fc_is_planar(scene, from);
    if (!takes_default(scene, method)) {
        if (is_planar) {
            static const char* const NAME[] = {
                [FC_METHOD_CVODE] = "cvode",
                [FC_METHOD_BACKWARD_EULER] = "backwardEuler",
                [FC_METHOD_TRAPEZOID] = "trapezoid",
                [FC_METHOD_RK4] = "rk4",
                [FC_METHOD_EXPLICIT_EULER] = "explicitEuler",
            };
            return fc_message_set(
                message,
                "solver.method = %s knows no motion across V, and V_y = %.9g m/s, "
                "vibration.V_2 = %.9g m/s, delta_y = %.9g m: set solver.method = collocation",
                NAME[method], scene->drive.V_y.value, scene->drive.vibration.V_2, from.delta_y);
        }
        return other_step(scene, method, cvode, options, h, result, message);
    }
    return fc_periods_step(integration(scene, is_planar), scene, options, h, result, message);
}

FcBristle fc_method_settled(const FcScene* scene, const FcSolverOptions* options, FcBristle from,
                            FcVector* force, double* evaluations) {
    *force = (FcVector){0.0, 0.0};
    assert(!fc_drive_is_linear(&scene->drive));
    if (fc_scene_is_loose(scene)) {
        return (FcBristle){0};
    }
    const bool is_planar = fc_is_planar(scene, from);
    if (fc_drive_vibrates(&scene->drive)) {
        FcStepResult end = fc_result_from(from, *evaluations);
        FcSolverOptions own = *options;
        if (is_planar) {
            own.tolerance = fmin(own.tolerance, FC_MOST_TOLERANCE_OF_SETTLED_PLANE);
        }
        *force = fc_periods_settled(integration(scene, is_planar), scene, &own, &end);
        *evaluations = end.evaluations;
        // An excess over a bound by rounding would become heat of the first step.
        const FcBristle bristle = fc_bristle_of(&end);
        return fc_reach(scene, bristle);
    }
    if (is_planar) {
        return fc_plane_slides_for_ever(scene, from, force);
    }
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    const double bound = at.limit / at.sigma;
    const int side = at.V < 0.0 ? -1 : 1;
    if (scene->friction->model == FC_COULOMB) {
        force->x = fc_sign(at.V) * at.limit;
        return from;
    }
    if (at.V == 0.0 || !isfinite(bound)) {
        force->x = at.sigma * from.delta;
        return from;
    }
    force->x = side * at.limit;
    return (FcBristle){.delta = side * bound, .slips = fc_has_static_friction(scene->friction) ? side : 0};
}
