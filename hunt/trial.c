#include "trial.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

#include "scenes.h"

const char* const GRADE_NAMES[GRADES] = {"F_t", "F_t_mean", "W_f",       "Q_f",  "F_t_start",
                                         "F_y", "F_y_mean", "F_y_start", "side", "settled"};

static const double ROUNDING = 1e-11;            // of S, beside the tolerance
static const double DIGITS = 32.0 * DBL_EPSILON; // of a deflection, as the state holds it
static const double LEAST_S = 1e-20;             // N, and J: S and the path are 0 if nothing acts

// The values that are graded, but F_t_settled.
typedef struct {
    double value[OF_SETTLED];
} Values;

static Values of_fmu(const FmuStep* s) {
    const double slips = s->slips != 0.0;
    return (Values){
        {s->F_t, s->F_t_mean, s->work, s->heat, s->F_t_start, s->F_y, s->F_y_mean, s->F_y_start, slips}};
}

static Values of_reference(const ReferenceStep* s) {
    return (Values){
        {s->F_t, s->F_t_mean, s->work, s->heat, s->F_t_start, s->F_y, s->F_y_mean, s->F_y_start, s->slips}};
}

static double over(double error, double tolerance, double scale, double rounding) {
    return isnan(error) ? INFINITY : fabs(error) / ((tolerance + ROUNDING) * scale + rounding);
}

// The worst error of a step between the least and the largest that the reference says.
static Verdict verdict_between(const TrialStep* taken, const Values* least, const Values* largest,
                               double tolerance) {
    const ReferenceStep* truth = &taken->truth;
    const FmuStep* step = &taken->step;
    const double S = fmax(truth->S, LEAST_S);
    const double path =
        truth->path + hypot(truth->delta - step->delta_start, truth->delta_y - step->delta_y_start);
    const double lengths = hypot(step->delta_start, step->delta_y_start) + hypot(step->delta, step->delta_y);
    const double stored = LEAST_S + DIGITS * S * lengths; // over at least 1 m
    const Values found = of_fmu(step);
    Verdict worst = {.ratio = -1.0};
    for (int k = 0; k < OF_SETTLED; k++) {
        const double x = found.value[k];
        const double off = x - fmin(fmax(x, least->value[k]), largest->value[k]);
        const bool energy = k == OF_WORK || k == OF_HEAT;
        const double ratio = k == OF_SIDE
                                 ? (off == 0.0 ? 0.0 : INFINITY)
                                 : over(off, tolerance, energy ? S * path : S, energy ? stored : 0.0);
        if (ratio > worst.ratio) {
            worst = (Verdict){ratio, k};
        }
    }
    return worst;
}

// The step from the FMU's state before it. A settled start is judged by its own force.
static void step_of_reference(const ReferenceScene* before, const ReferenceScene* scene, const FmuStep* step,
                              ReferenceStep* truth) {
    reference_step(before, scene, 1, truth);
    if (scene->initial == START_SETTLED && scene->law != LAW_COULOMB) {
        const ReferenceStep settled = *truth;
        ReferenceScene from = *scene;
        from.initial = START_GIVEN;
        from.delta_0 = step->delta_start;
        from.delta_y_0 = step->delta_y_start;
        from.slips = step->slips_start;
        reference_step(NULL, &from, 1, truth);
        truth->F_t_start = settled.F_t_start;
        truth->F_y_start = settled.F_y_start;
        truth->known = truth->known && settled.known;
    }
}

// Drops at break-away may hand on more than they get: the motion may be chaotic.
static bool may_be_chaotic(const ReferenceScene* scene) { return scene_gain(scene) > 2.0; }

// The same if the rounding of the step's own times, or of a deflection at its bound, may tell: with start and h moved by two
// units in their last place, and the deflection before by 2e-10 of itself. In a step that may be chaotic by the tolerance, and either way
// by all that it changes.
static Verdict verdict_by_rounding(const ReferenceScene* before, const TrialStep* taken, double tolerance) {
    Values least = of_reference(&taken->truth), largest = least;
    const bool grows = may_be_chaotic(&taken->scene);
    const double of_delta = grows ? fmax(tolerance, 2e-10) : 2e-10;
    const double ulp = 2.0 * DBL_EPSILON * (fabs(taken->scene.start) + taken->scene.h);
    for (int k = 0; k < 6; k++) {
        ReferenceScene moved = taken->scene, past = before ? *before : moved;
        ReferenceStep found;
        const double way = k % 2 ? 1.0 : -1.0;
        if (k < 4) {
            *(k < 2 ? &moved.start : &moved.h) += way * ulp;
        } else {
            moved.delta_0 *= 1.0 + way * of_delta;
            moved.delta_y_0 *= 1.0 + way * of_delta;
        }
        past.start = moved.start;
        if (!(moved.h > 0.0)) {
            continue;
        }
        step_of_reference(before ? &past : NULL, &moved, &taken->step, &found);
        const Values values = of_reference(&found);
        for (int i = 0; i < OF_SETTLED; i++) {
            least.value[i] = fmin(least.value[i], values.value[i]);
            largest.value[i] = fmax(largest.value[i], values.value[i]);
        }
    }
    for (int i = 0; i < OF_SETTLED && grows; i++) {
        const double range = largest.value[i] - least.value[i];
        least.value[i] -= range;
        largest.value[i] += range;
    }
    return verdict_between(taken, &least, &largest, tolerance);
}

// The error of F_t_settled over the tolerance, -1 if the reference does not say.
static double settled_ratio(TrialStep* taken, int method, double tolerance) {
    ReferenceScene still = taken->scene;
    double *found = taken->settled[0], *truth = taken->settled[1], S, ratio = -1.0;
    found[0] = found[1] = truth[0] = truth[1] = NAN;
    still.initial = START_GIVEN;
    FmuRun* run = fmu_open(&still, method, tolerance);
    if (fmu_settled_force(run, found) && reference_settled_force(&still, truth, &S)) {
        const double off = fmax(fabs(found[0] - truth[0]), fabs(found[1] - truth[1]));
        ratio = isnan(found[0] + found[1]) ? INFINITY : over(off, tolerance, fmax(S, LEAST_S), 0.0);
    }
    fmu_close(run);
    return ratio;
}

// Over so many periods of a motion that may be chaotic the state before tells nothing.
static bool may_forget(const ReferenceScene* s) {
    return vibrates(s) && may_be_chaotic(s) && s->h * s->f > 10.0;
}

// Whether the scene has a settled state that is promised.
static bool settles(const ReferenceScene* s) {
    return s->law == LAW_COULOMB || !vibrates(s) || (scene_kappa(s) >= LEAST_KAPPA && !may_be_chaotic(s));
}

// Leaves a step unjudged.
static void skip(Trial* trial, TrialStep* taken) {
    trial->unknown++;
    taken->verdict = (Verdict){.ratio = -1.0};
}

static void grade(Trial* trial, TrialStep* taken, const ReferenceScene* before, int method,
                  double tolerance) {
    const ReferenceScene* scene = &taken->scene;
    step_of_reference(before, scene, &taken->step, &taken->truth);
    if (!taken->truth.known) {
        skip(trial, taken);
        return;
    }
    const Values truth = of_reference(&taken->truth);
    taken->verdict = verdict_between(taken, &truth, &truth, tolerance);
    if (!(taken->verdict.ratio <= 1.0)) {
        taken->verdict = verdict_by_rounding(before, taken, tolerance);
    }
    if (!(taken->verdict.ratio <= 1.0) &&
        (may_forget(scene) || (scene->initial == START_SETTLED && !settles(scene)))) {
        skip(trial, taken);
        return;
    }
    const double settled = before == NULL ? settled_ratio(taken, method, tolerance) : -1.0;
    if (settled > taken->verdict.ratio && (settled <= 1.0 || settles(scene))) {
        taken->verdict = (Verdict){settled, OF_SETTLED};
    }
}

static void look_at(TrialStep* taken, const ReferenceScene* before) {
    ReferenceScene now = taken->scene;
    const ReferenceScene end = scene_after(&now);
    const bool ends_open = reference_is_open(&end), was_open = reference_is_open(before ? before : &now);
    const bool moves = now.V_rate != 0.0 || now.V_y_rate != 0.0 || now.d_rate != 0.0 || now.E_rate != 0.0 ||
                       now.load_rate != 0.0;
    taken->is[IS_STATIC] = now.staticRatio > 1.0 && (now.law == LAW_ELASTIC_PLASTIC || now.law == LAW_LUGRE);
    taken->is[OPENS] = ends_open && !was_open;
    taken->is[CLOSES] = was_open && !ends_open;
    taken->is[LEAPS] = moves && vibrates(&now) && now.h * now.f >= 10.0 && now.law != LAW_COULOMB;
    now.h = now.V_rate = now.V_y_rate = now.d_rate = now.E_rate = now.load_rate = 0.0;
    for (int k = 0; before && k < REFERENCE_DOUBLES; k++) {
        ReferenceScene past = *before;
        past.h = 0.0;
        past.delta_0 = now.delta_0;
        past.delta_y_0 = now.delta_y_0;
        taken->is[JUMPS] = taken->is[JUMPS] || scene_get(&past, k) != scene_get(&now, k);
    }
}

void trial_run(Trial* trial, const Sequence* sequence, double tolerance) {
    *trial = (Trial){0};
    FmuRun* run = fmu_open(&sequence->step[0], sequence->method, tolerance);
    ReferenceScene before = sequence->step[0];
    for (int k = 0; k < sequence->steps; k++) {
        TrialStep* taken = &trial->taken[k];
        taken->scene = sequence_scene(sequence, k, &before);
        if (!fmu_step(run, &taken->scene, &taken->step)) {
            trial->refused = true;
            break;
        }
        if (k > 0) {
            before = scene_after(&before);
            taken->scene.delta_0 = taken->step.delta_start;
            taken->scene.delta_y_0 = taken->step.delta_y_start;
            taken->scene.slips = taken->step.slips_start;
        }
        grade(trial, taken, k == 0 ? NULL : &before, sequence->method, tolerance);
        look_at(taken, k == 0 ? NULL : &before);
        trial->steps++;
        before = taken->scene;
    }
    snprintf(trial->message, sizeof trial->message, "%s", fmu_message(run));
    fmu_close(run);
}
