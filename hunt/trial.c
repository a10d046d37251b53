#include "trial.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "promise.h"
#include "relations.h"
#include "settled.h"
#include "slopes.h"

const char* const GRADE_NAMES[GRADES] = {"F_t",   "F_t_mean",  "W_f",         "Q_f",
                                         "delta", "F_t_start", "derivatives", "F_t_settled",
                                         "split", "mirror",    "shift",       "restored"};

// A step that takes more evaluations is not judged: its parts and the reference would take minutes.
static const double MOST_EVALUATIONS = 1e6;
// The reference takes some ms for each period.
static const double MOST_PERIODS = 31.0;
static const double FROM_ONE_REVERSAL =
    1e-3;                          // of a period: Coulomb's step that has one reversal at the most, about
static const double CLOCK = 2e-16; // of a period, by which a time is rounded

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

// Its stiffness [N/m] at the end of a step, however long.
static double sigma_at_end(const ReferenceScene* scene) {
    ReferenceScene end = scene_after(scene, 0.0);
    ReferenceStep frame;
    end.h = 0.0;
    reference_frame(&end, &frame);
    return frame.sigma;
}

static bool is_short(const ReferenceScene* scene) {
    return scene->h * scene->f <= MOST_PERIODS || (scene->V_1 == 0.0 && scene->a_d == 0.0);
}

// Whether the step agrees with its parts by half of the tolerance, or nothing is promised. A reversal that is missed just
// after the start shows in no part.
static bool agrees(TrialStep* taken, const ReferenceScene* scene, int method, double tolerance) {
    ReferenceScene short_one = *scene;
    ReferenceStep frame;
    if (scene->law == LAW_COULOMB && scene->h * scene->f < FROM_ONE_REVERSAL) {
        return false;
    }
    short_one.h = is_short(scene) ? scene->h : 1.0 / scene->f;
    short_one.delta_0 = taken->step.delta_start;
    reference_frame(&short_one, &frame);
    frame.path *= scene->h / short_one.h;
    frame.sigma = sigma_at_end(scene);
    const double ratio = parts_ratio(scene, &taken->step, &frame, tolerance);
    if (!(ratio < 0.5) && !isinf(promise_factor(promise_class(scene, &frame, method), tolerance))) {
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
        taken->truth.sigma = sigma_at_end(scene);
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
        if (!fmu_step(run, &scene, &taken->step) || taken->step.evaluations > MOST_EVALUATIONS) {
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
        verdict.ratio = judge_ratio(&taken->scene, &errors, &taken->truth, tolerance, &verdict.of);
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
    const SettledGrade settled = settled_grade(&taken->scene, tolerance);
    if (settled.ratio / settled.granted > verdict.ratio / verdict.granted) {
        verdict = (Verdict){settled.ratio, settled.granted, BY_SETTLED, settled.kind, k};
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

// What judge_ratio says of the reference of another scene, were the truth of the step exact.
static double ratio_of_reference(const TrialStep* taken, const ReferenceScene* other, int fineness,
                                 double tolerance) {
    ReferenceStep found;
    step_of_reference(other, taken->step.delta_start, fineness, &found);
    const FmuStep as_step = {.delta = found.delta,
                             .F_t = found.F_t,
                             .F_t_mean = found.F_t_mean,
                             .work = found.work,
                             .heat = found.heat,
                             .F_t_start = found.F_t_start};
    const Errors errors = judge_errors(&taken->scene, &taken->truth, &as_step, tolerance);
    int which = 0;
    return judge_ratio(&taken->scene, &errors, &taken->truth, tolerance, &which);
}

// Whether a start and a V that are moved by rounding explain a fifth of the error.
static bool is_by_clock(const TrialStep* taken, const Verdict* miss, double tolerance) {
    for (int sign = -1; sign <= 1; sign += 2) {
        ReferenceScene moved = taken->scene;
        moved.start += sign * fmax(CLOCK / moved.f, 2.0 * DBL_EPSILON * (fabs(moved.start) + moved.h));
        moved.V += sign * 2.0 * DBL_EPSILON * fabs(moved.V); // by which a moving V reverses earlier or later
        if (miss->of == BY_DERIVATIVES) {
            const double ratio = slopes_ratio(&moved, &taken->truth, &taken->step);
            if (fabs(ratio - miss->ratio) > 0.2 * miss->ratio) {
                return true;
            }
        } else if (ratio_of_reference(taken, &moved, 1, tolerance) > 0.2 * miss->ratio) {
            return true;
        }
    }
    return false;
}

bool trial_is_unsure(const Trial* trial, const Verdict* miss, double tolerance) {
    const TrialStep* taken = &trial->taken[miss->step];
    if (!taken->graded || miss->of == BY_SETTLED) {
        return false;
    }
    return !(ratio_of_reference(taken, &taken->scene, 2, tolerance) < 0.1) ||
           is_by_clock(taken, miss, tolerance);
}
