#include "settled.h"

#include <math.h>
#include <stdbool.h>

#include "fmu_step.h"
#include "judge.h"
#include "promise.h"

// The period of the vibration that F_t_settled is the mean of: from the phase of time 0.
static ReferenceScene settled_period(const ReferenceScene* scene) {
    ReferenceScene period = *scene;
    period.V_rate = period.d_rate = period.E_rate = period.load_rate = 0.0;
    period.initial = START_SETTLED;
    period.start = 0.0;
    period.h = 1.0 / scene->f;
    return period;
}

static bool settled_force(const ReferenceScene* scene, double tolerance, double* force) {
    FmuRun* run = fmu_open(scene, FMU_COLLOCATION, tolerance);
    const bool known = fmu_settled_force(run, force);
    fmu_close(run);
    return known;
}

SettledGrade settled_grade(const ReferenceScene* scene, double tolerance) {
    const ReferenceScene period = settled_period(scene);
    ReferenceStep truth;
    double force;
    if ((scene->V_1 == 0.0 && scene->a_d == 0.0) || !settled_force(&period, tolerance, &force)) {
        return (SettledGrade){.ratio = -1.0, .granted = 1.0};
    }
    reference_step(&period, 1, &truth);
    const FmuStep step = {.delta = truth.delta,
                          .F_t = truth.F_t,
                          .F_t_mean = force,
                          .work = truth.work,
                          .heat = truth.heat,
                          .F_t_start = truth.F_t_start};
    const Errors errors = judge_errors(&period, &truth, &step, tolerance);
    int which = 0;
    SettledGrade grade = {.kind = promise_class(&period, &truth, FMU_COLLOCATION)};
    grade.granted = promise_factor(grade.kind, tolerance);
    grade.ratio = judge_ratio(&period, &errors, &truth, tolerance, &which);
    return grade;
}
