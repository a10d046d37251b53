#include "solver/method.h"

#include <assert.h>
#include <math.h>

#include "solver/collocation.h"
#include "solver/coulomb.h"
#include "solver/elastic_plastic.h"
#include "solver/fixed_step.h"

bool fc_method_step(const FcScene* scene, FcMethod method, FcCvode* cvode, const FcSolverOptions* options,
                    double h, double delta_0, FcStepResult* result, FcMessage* message) {
    assert(h >= 0.0 && options->tolerance > 0.0 && options->step_size > 0.0);
    if (scene->friction->model == FC_COULOMB) {
        return fc_periods_step(fc_coulomb_interval, scene, options, h, delta_0, result, message);
    }
    if (scene->friction->model == FC_ELASTIC_PLASTIC) {
        return fc_elastic_plastic_step(scene, options->tolerance, h, delta_0, result, message);
    }
    switch (method) {
    case FC_METHOD_COLLOCATION:
        if (fc_drive_is_constant(&scene->drive)) {
            fc_collocation_constant(scene, h, delta_0, result);
            return true;
        }
        return fc_periods_step(fc_collocation_interval, scene, options, h, delta_0, result, message);
    case FC_METHOD_CVODE:
        return fc_cvode_step(cvode, scene, options, h, delta_0, result, message);
    default:
        return fc_fixed_step(scene, method, options, h, delta_0, result, message);
    }
}

double fc_method_start(const FcScene* scene, double delta) {
    return scene->friction->model == FC_ELASTIC_PLASTIC ? fc_elastic_plastic_reached(scene, delta) : delta;
}

// Dahl, LuGre: the fixed point of the affine map of a period.
static double fixed_point(const FcScene* scene, const FcSolverOptions* options, double delta_0,
                          double* evaluations) {
    const double period = 1.0 / scene->drive.vibration.f;
    const FcMap map = fc_collocation_interval(scene, options, period, delta_0, FC_MAP_ANY_START, evaluations);
    const double settled = map.offset / map.relaxation;
    return map.relaxation > 0.0 && isfinite(settled) ? settled : delta_0;
}

double fc_method_settled(const FcScene* scene, const FcSolverOptions* options, double delta_0,
                         double* evaluations) {
    assert(!fc_drive_is_linear(&scene->drive));
    const FcCoefficients start = fc_scene_coefficients(scene, 0.0);
    if (scene->friction->model == FC_COULOMB) {
        return 0.0;
    }
    if (scene->friction->model == FC_ELASTIC_PLASTIC) {
        return fc_elastic_plastic_settled(scene, options->tolerance, delta_0, evaluations);
    }
    if (fc_drive_vibrates(&scene->drive)) {
        return fixed_point(scene, options, delta_0, evaluations);
    }
    const double bound = start.limit / start.sigma;
    return start.V != 0.0 && isfinite(bound) ? copysign(bound, start.V) : delta_0;
}
