// Coulomb friction has no state: F = g sgn V. Between two reversals of V impulse and work are integrals of g
// and of g V. They are closed forms if g is constant, and else quadratures of smooth functions, to the
// tolerance.
#include <assert.h>
#include <float.h>
#include <math.h>

#include "solver/budget.h"
#include "solver/interval.h"
#include "solver/march/points.h"
#include "solver/methods/methods.h"

// Adds side times the integrals over [t, end] of g and g V.
static void add_limit(const FcScene* scene, const FcSolverOptions* options, double duration, double t,
                      double end, FcStepResult* result) {
    assert(0.0 <= t && t <= end && end <= duration);
    const double side = fc_sign(fc_drive_V(&scene->drive, 0.5 * (t + end)));
    if (fc_scene_limit_is_constant(scene)) {
        const double force = side * fc_scene_coefficients(scene, t).limit;
        result->impulse += force * (end - t);
        result->work += force * fc_drive_displacement(&scene->drive, t, end);
        result->evaluations += 1.0;
        return;
    }
    const FcPlanner planner = fc_planner(options->tolerance);
    const FcPace pace = fc_pace(scene, duration);
    const double speed = fmax(fc_drive_largest_speed(&scene->drive, duration), DBL_MIN);
    const double allowed = FC_SHARE_OF_FORMULA * options->tolerance * options->force * duration;
    while (t < end && result->evaluations <= FC_MOST_EVALUATIONS) {
        int rule;
        double h = fc_plan_panel(&planner, end - t, fc_smooth_time(&pace), &rule);
        FcPoints at;
        for (int tries = 0;; tries++) {
            double f[FC_MOST_POINTS];
            fc_points(scene, t, h, rule, &at, &result->evaluations);
            for (int i = 0; i < at.count; i++) {
                f[i] = at.limit[i] * (1.0 + side * at.V[i] / speed);
            }
            if (fc_error_at_points(&at, f) * h <= allowed || !fc_refine_panel(&h, &rule, tries)) {
                break;
            }
        }
        for (int i = 1; i <= at.n; i++) {
            const double force = side * at.rule->weight[i - 1] * h * at.limit[i];
            result->impulse += force;
            result->work += force * at.V[i];
        }
        t = fc_panel_end(t, h, end);
    }
}

void fc_coulomb_step(const FcScene* scene, const FcSolverOptions* options, double duration,
                     FcStepResult* result) {
    const FcDrive* drive = &scene->drive;
    const double before = result->work;
    for (double t = 0.0; t < duration && result->evaluations <= FC_MOST_EVALUATIONS;) {
        const double end = fc_drive_next_event(drive, t, duration).time;
        add_limit(scene, options, duration, t, end, result);
        t = end;
    }
    result->heat += result->work - before;
}
