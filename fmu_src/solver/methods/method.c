#include "solver/methods/method.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

#include "solver/methods/methods.h"
#include "solver/stick_slip/regime_integrals.h"
#include "solver/stick_slip/stick_slip.h"

// Coulomb friction has no state, F = g sgn(V): the deflection stays; impulse and work are exact where g is constant, and
// quadratures of a smooth function between the reversals elsewhere, to the tolerance.
static FcMap coulomb_interval(const FcScene* scene, const FcSolverOptions* options, double duration,
                              double delta_0, FcMapScope scope, double* evaluations) {
    (void)scope;
    (void)delta_0;
    const FcDrive* drive = &scene->drive;
    const FcIntegrator integrator =
        fc_integrator(scene, fc_bound_common_smooth_time(scene, duration), options->tolerance);
    FcMap map = fc_map_identity();
    FcDriveEvent event = fc_drive_next_event(drive, 0.0, duration);
    for (double t = 0.0; t < duration && *evaluations <= FC_MOST_EVALUATIONS;) {
        const double side = fc_sign(fc_drive_V(drive, 0.5 * (t + event.time)));
        const FcSlipIntegrals part = fc_limit_integrals(&integrator, t, event.time, evaluations);
        map.impulse_offset += side * part.limit;
        map.work_offset += side * part.limit_V;
        t = event.time;
        if (t < duration) {
            event = fc_drive_event_after(drive, &event, duration);
        }
    }
    map.heat_offset = map.work_offset;
    return map;
}

static bool may_touch_bound(const FcScene* scene) {
    return fc_is_bounded(scene->friction) && fc_stick_slip_may_touch(scene);
}

// How the default method integrates the law from between its bounds on.
static FcIntegration integration(const FcScene* scene) {
    if (scene->friction->model == FC_COULOMB) {
        return (FcIntegration){coulomb_interval, NULL};
    }
    return may_touch_bound(scene) ? (FcIntegration){fc_stick_slip_interval, fc_stick_slip_free_period}
                                  : (FcIntegration){fc_collocation_interval, NULL};
}

static bool step_from_within(const FcScene* scene, FcMethod method, FcCvode* cvode,
                             const FcSolverOptions* options, double h, double delta_0, FcStepResult* result,
                             FcMessage* message) {
    const bool is_affine = scene->friction->model == FC_DAHL || scene->friction->model == FC_LUGRE;
    if (is_affine && method == FC_METHOD_CVODE && !may_touch_bound(scene)) {
        return fc_cvode_step(cvode, scene, options, h, delta_0, result, message);
    }
    if (is_affine && method != FC_METHOD_COLLOCATION && method != FC_METHOD_CVODE) {
        return fc_fixed_step(scene, method, options, h, delta_0, result, message);
    }
    if (is_affine && fc_drive_is_constant(&scene->drive)) {
        fc_collocation_constant(scene, h, delta_0, result);
        return true;
    }
    return fc_periods_step(integration(scene), scene, options, h, delta_0, result, message);
}

bool fc_method_step(const FcScene* scene, FcMethod method, FcCvode* cvode, const FcSolverOptions* options,
                    double h, double delta_0, FcStepResult* result, FcMessage* message) {
    assert(h >= 0.0 && options->tolerance > 0.0 && options->step_size > 0.0);
    const bool is_bounded = fc_is_bounded(scene->friction);
    const bool relaxes = scene->friction->model != FC_ELASTIC_PLASTIC;
    double loss = 0.0;
    const double start = is_bounded && relaxes ? fc_stick_slip_reached(scene, delta_0, &loss) : delta_0;
    if (!step_from_within(scene, method, cvode, options, h, start, result, message)) {
        return false;
    }
    if (is_bounded) {
        result->delta = fc_stick_slip_end(scene, h, result->delta);
        result->heat += loss;
    }
    return true;
}

double fc_method_start(const FcScene* scene, double delta) {
    double loss;
    return fc_is_bounded(scene->friction) ? fc_stick_slip_reached(scene, delta, &loss) : delta;
}

double fc_method_settled(const FcScene* scene, const FcSolverOptions* options, double delta_0,
                         double* evaluations) {
    assert(!fc_drive_is_linear(&scene->drive) && scene->friction->model != FC_COULOMB);
    const double start = fc_method_start(scene, delta_0);
    if (fc_drive_vibrates(&scene->drive)) {
        const double settled = fc_periods_settled(integration(scene), scene, options, start, evaluations);
        return fc_method_start(
            scene, settled); // what rounding leaves beyond a bound would be heat of the first step
    }
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    const double bound = at.limit / at.sigma;
    return at.V != 0.0 && isfinite(bound) ? copysign(bound, at.V) : start;
}

double fc_method_settled_force(const FcScene* scene, const FcSolverOptions* options, double delta_0,
                               double* evaluations) {
    assert(!fc_drive_is_linear(&scene->drive));
    const double start = fc_method_start(scene, delta_0);
    if (fc_drive_vibrates(&scene->drive)) {
        return fc_periods_settled_force(integration(scene), scene, options, start, evaluations);
    }
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    if (scene->friction->model == FC_COULOMB) {
        return fc_sign(at.V) * at.limit;
    }
    return at.V != 0.0 && isfinite(at.limit / at.sigma) ? copysign(at.limit, at.V) : at.sigma * start;
}
