#include "trial.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "promise.h"
#include "relations.h"
#include "slopes.h"

const char* const GRADE_NAMES[GRADES] = {"F_t",         "F_t_mean", "W_f",    "Q_f",   "delta",   "F_t_start",
                                         "derivatives", "split",    "mirror", "shift", "restored"};

// The reference takes some ms for each period.
static const double MOST_PERIODS = 31.0;

// The step from where the FMU stood before it. A settled start is judged by its own force.
static void step_of_reference(const ReferenceScene* scene, double delta_start, int fineness,
                              ReferenceStep* truth) {
    ReferenceScene from = *scene;
    reference_step(scene, fineness, truth);
    if (scene->initial == START_SETTLED && scene->law != LAW_COULOMB) {
        const ReferenceStep settled = *truth;
        from.initial = START_GIVEN;
        from.delta_0 = delta_start;
        reference_step(&from, fineness, truth);
        truth->F_t_start = settled.F_t_start;
        truth->F_t_start_other = settled.F_t_start_other;
        truth->gap_start = settled.gap_start;
    }
}

static bool is_short(const ReferenceScene* scene) {
    return scene->h * scene->f <= MOST_PERIODS || (scene->V_1 == 0.0 && scene->a_d == 0.0);
}

// Whether the step agrees with its parts by half of what is granted. More than the usual is not granted here to a force
// beyond the limit, since the frame's limit is the least.
static bool agrees(TrialStep* taken, const ReferenceScene* scene, int method, double tolerance) {
    ReferenceScene short_one = *scene;
    ReferenceStep frame;
    short_one.h = is_short(scene) ? scene->h : 1.0 / scene->f;
    short_one.delta_0 = taken->step.delta_start;
    reference_frame(&short_one, &frame);
    frame.path *= scene->h / short_one.h;
    const double ratio = parts_ratio(scene, &taken->step, &frame, tolerance);
    frame.largest = 0.0;
    if (!(ratio < 0.5 * promise_factor(promise_class(scene, &frame, method), tolerance))) {
        return false;
    }
    taken->parts = ratio;
    taken->truth = frame;
    return true;
}

// The truth of the step, or where it is long and held what a period says of forces, path and rounding.
static void find_truth(TrialStep* taken, const ReferenceScene* scene) {
    ReferenceScene short_one = *scene;
    taken->graded = is_short(scene);
    if (!taken->graded) {
        short_one.h = 1.0 / scene->f;
    }
    step_of_reference(&short_one, taken->step.delta_start, 1, &taken->truth);
    taken->derivatives = slopes_ratio(&short_one, &taken->truth, &taken->step);
    if (!taken->graded) {
        taken->truth.path *= scene->h / short_one.h;
        taken->truth.gap = INFINITY;
    }
}

void trial_run(Trial* trial, const Sequence* sequence, int most_steps, double tolerance) {
    FmuRun* run = fmu_open(&sequence->step[0], sequence->method, tolerance);
    ReferenceScene scene = sequence->step[0];
    double delta = 0.0;
    const int steps = sequence->steps < most_steps ? sequence->steps : most_steps;
    for (trial->steps = 0; trial->steps < steps; trial->steps++) {
        TrialStep* taken = &trial->taken[trial->steps];
        scene = sequence_scene(sequence, trial->steps, &scene, delta);
        if (!fmu_step(run, &scene, &taken->step)) {
            break;
        }
        const bool known = !taken->screened && memcmp(&taken->scene, &scene, sizeof scene) == 0;
        taken->scene = scene;
        taken->screened = trial->screens && agrees(taken, &scene, sequence->method, tolerance);
        if (!taken->screened && (!known || scene.initial == START_SETTLED)) {
            find_truth(taken, &scene);
        }
        delta = taken->step.delta;
    }
    trial->refused = trial->steps < steps;
    snprintf(trial->message, sizeof trial->message, "%s", fmu_message(run));
    fmu_close(run);
}

Verdict trial_verdict(const Trial* trial, int k, int method, double tolerance) {
    const TrialStep* taken = &trial->taken[k];
    Verdict verdict = {.kind = promise_class(&taken->scene, &taken->truth, method), .step = k, .ratio = -1.0};
    verdict.granted = promise_factor(verdict.kind, tolerance);
    if (taken->screened) {
        verdict.ratio = taken->parts;
        verdict.of = BY_SPLIT;
        return verdict;
    }
    if (taken->graded) {
        const Errors errors = judge_errors(&taken->scene, &taken->truth, &taken->step, tolerance);
        verdict.ratio = judge_ratio(&errors, &taken->truth, tolerance, &verdict.of);
    }
    if (!(taken->derivatives <= fmax(1.0, verdict.ratio))) {
        verdict.ratio = taken->derivatives;
        verdict.of = BY_DERIVATIVES;
    }
    for (int relation = 0; relation < RELATIONS; relation++) {
        const double ratio = relation_ratio(relation, &taken->scene, &taken->truth, method, tolerance);
        if (ratio > verdict.ratio) {
            verdict.ratio = ratio;
            verdict.of = BY_SPLIT + relation;
        }
    }
    return verdict;
}

Verdict trial_worst(const Trial* trial, int method, double tolerance) {
    Verdict worst = {.ratio = -1.0, .granted = 1.0};
    for (int k = 0; k < trial->steps; k++) {
        const Verdict verdict = trial_verdict(trial, k, method, tolerance);
        if (!(verdict.ratio / verdict.granted <= worst.ratio / worst.granted)) {
            worst = verdict;
        }
    }
    return worst;
}

bool trial_is_unsure(const Trial* trial, int k, double tolerance) {
    const TrialStep* taken = &trial->taken[k];
    if (!taken->graded) {
        return false;
    }
    ReferenceStep finer;
    step_of_reference(&taken->scene, taken->step.delta_start, 2, &finer);
    const FmuStep as_step = {.delta = finer.delta,
                             .F_t = finer.F_t,
                             .F_t_mean = finer.F_t_mean,
                             .work = finer.work,
                             .heat = finer.heat,
                             .F_t_start = finer.F_t_start};
    const Errors errors = judge_errors(&taken->scene, &taken->truth, &as_step, tolerance);
    int which = 0;
    return !(judge_ratio(&errors, &taken->truth, tolerance, &which) < 0.1);
}
