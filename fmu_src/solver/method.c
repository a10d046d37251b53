#include "solver/method.h"

#include <assert.h>

#include "model/bound.h"
#include "solver/constant_step.h"
#include "solver/fixed_step.h"
#include "solver/periods/periods.h"

// By cvode or a fixed step, segment by segment.
static bool other_step(const FcScene* scene, FcMethod method, FcCvode* cvode, const FcSolverOptions* options,
                       double h, FcStepResult* result, FcMessage* message) {
    assert(method != FC_METHOD_COLLOCATION && (method != FC_METHOD_CVODE || cvode));
    if (method != FC_METHOD_CVODE && !fc_check_fixed_steps(scene, options->step_size, h, message)) {
        return false;
    }
    FcSegments segments;
    fc_segments_start(&segments, scene, h);
    while (fc_next_segment(&segments)) {
        if (fc_scene_is_separated(segments.scene)) {
            fc_open_contact_step(result);
        } else if (method == FC_METHOD_CVODE
                       ? !fc_cvode_step(cvode, segments.scene, options, segments.h, result, message)
                       : !fc_fixed_step(segments.scene, method, options, segments.h, result, message)) {
            return false;
        }
    }
    return true;
}

// Whether the method leaves the scene to the default.
static bool takes_default(const FcScene* scene, FcMethod method) {
    const FcFriction* friction = scene->friction;
    return method == FC_METHOD_COLLOCATION || !fc_has_bristle(friction) ||
           (method != FC_METHOD_CVODE && fc_may_stick(friction));
}

bool fc_method_formula(const FcScene* scene, const FcContactResponse* contact, FcMethod method, double h,
                       FcBristle from, FcStepResult* result) {
    assert(h >= 0.0 && fc_drive_is_constant(&scene->drive));
    if (!fc_may_relax(scene->friction) || fc_scene_is_separated(scene) || !takes_default(scene, method)) {
        return false;
    }
    fc_constant_step(scene, contact, h, from, result);
    return true;
}

bool fc_method_step(const FcScene* scene, FcMethod method, FcCvode* cvode, const FcSolverOptions* options,
                    double h, FcBristle from, FcStepResult* result, FcMessage* message) {
    assert(h >= 0.0 && options->tolerance > 0.0 && options->step_size > 0.0);
    fc_result_start(result, from, 0.0);
    const bool is_planar = fc_is_planar(scene, from);
    if (!takes_default(scene, method)) {
        if (is_planar && method != FC_METHOD_CVODE) {
            static const char* const NAME[] = {
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
    return fc_periods_step(scene, options, h, result, message);
}

FcBristle fc_method_settled(const FcScene* scene, const FcSolverOptions* options, FcBristle from,
                            FcVector* force, double* evaluations, bool* scatters) {
    *force = (FcVector){0.0, 0.0};
    *scatters = false;
    assert(!fc_drive_is_linear(&scene->drive) && options->tolerance > 0.0);
    if (fc_scene_is_separated(scene)) {
        return (FcBristle){0};
    }
    if (!fc_drive_vibrates(&scene->drive)) {
        return fc_steady_sliding(scene, from, force);
    }
    FcStepResult end;
    fc_result_start(&end, from, *evaluations);
    *force = fc_periods_settled(scene, options, &end, scatters);
    *evaluations = end.evaluations;
    // An excess over a bound by rounding would become heat of the first step.
    return fc_project_onto_bound(scene, fc_bristle_of(&end));
}
