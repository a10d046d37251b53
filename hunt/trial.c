#include "trial.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "contact/settled_force.h"
#include "scenes.h"

const char* const GRADE_NAMES[GRADES] = {"F_t",       "F_y",   "F_t_mean", "F_y_mean", "F_t_start",
                                         "F_y_start", "W_f",   "Q_f",      "body.v",   "body.x",
                                         "side",      "delta", "delta_y",  "settled"};

static const double ROUNDING = 1e-11; // of S, beside the tolerance
static const double DIGITS = 1e-13;   // of a deflection: so near to its bound a bristle is on it
static const double SHARP = 0.1; // of the allowed error: by this the reference may differ from its finer self
static const double MIN_S = 1e-20; // N, and J: S and the path are 0 if nothing acts

// ---- The FMU ----

typedef struct {
    FcFrictionContact contact;
    FcMessage message;     // why the core refused
    bool started;          // the core did not refuse to
    FcFrictionState after; // the last step, whose work and heat were counted
} FmuRun;

// Starts a contact at the start of the scene, to be freed.
static void open_run(FmuRun* run, const ReferenceScene* scene, const Sequence* sequence) {
    *run = (FmuRun){0};
    FcVariables* v = &run->contact.state.variables;
    put_scene(scene, v);
    v->solver.method = sequence->method;
    v->solver.tolerance = sequence->tolerance;
    v->solver.stepSize = scene->h / 300.0;
    run->started = fc_friction_contact_initialize(&run->contact, scene->start, &run->message);
}

// One step with the scene's inputs and tunable parameters, from the end of the last one. Returns false if the core refuses it,
// or refused to start.
static bool take_step(FmuRun* run, const ReferenceScene* scene, FmuStep* step) {
    FcFrictionState *state = &run->contact.state, *before = &run->after;
    FcVariables* v = &state->variables;
    step->delta_start = v->delta;
    step->delta_y_start = v->delta_y;
    step->slips_start = fc_has_broken_away(&v->friction, (FcBristleState)state->bristle.state)
                            ? fc_side((FcBristle){.delta = v->delta})
                            : 0;
    step->v_start = v->body.v;
    step->x_start = v->body.x;
    step->force_before = v->sigma * hypot(v->delta, v->delta_y);
    put_scene(scene, v);
    state->rates.next_is_set = 1; // all 0
    if (!run->started || !fc_friction_contact_refresh(&run->contact, &run->message)) {
        return false;
    }
    const FcVector start = {v->F_t, v->F_y};
    const double rates[] = {[FC_INPUT_V] = scene->V_rate,     [FC_INPUT_D] = scene->d_rate,
                            [FC_INPUT_E] = scene->E_rate,     [FC_INPUT_LOAD] = scene->load_rate,
                            [FC_INPUT_V_Y] = scene->V_y_rate, [FC_INPUT_F] = scene->F_rate};
    memcpy(state->rates.next, rates, sizeof rates);
    if (!fc_friction_contact_advance(&run->contact, scene->start, scene->h, &run->message)) {
        return false;
    }
    const double work = (v->W_f - before->variables.W_f) + (state->rest.W_f - before->rest.W_f);
    const double heat = (v->Q_f - before->variables.Q_f) + (state->rest.Q_f - before->rest.Q_f);
    const double results[RESULTS] = {v->F_t,
                                     v->F_y,
                                     v->F_t_mean,
                                     v->F_y_mean,
                                     start.x,
                                     start.y,
                                     work,
                                     heat,
                                     v->body.v,
                                     v->body.x,
                                     fc_has_broken_away(&v->friction, (FcBristleState)state->bristle.state),
                                     v->delta,
                                     v->delta_y};
    memcpy(step->result, results, sizeof results);
    *before = *state;
    return true;
}

// ---- Grades ----

static double over(double error, double allowed) { return isnan(error) ? INFINITY : fabs(error) / allowed; }

// The largest error of a step outside the range between the least and the largest results that the reference allows.
static Verdict verdict_outside(const TrialStep* taken, const ReferenceStep range[2], double tolerance) {
    const ReferenceStep* truth = &taken->truth;
    const FmuStep* step = &taken->step;
    const double S = fmax(truth->S, MIN_S);
    const double path = truth->path + hypot(truth->result[DELTA] - step->delta_start,
                                            truth->result[DELTA_Y] - step->delta_y_start);
    const double lengths =
        hypot(step->delta_start, step->delta_y_start) + hypot(step->result[DELTA], step->result[DELTA_Y]);
    const ReferenceScene* scene = &taken->scene;
    // A mass is a little away from its place, while it is stuck at most by its ringing.
    const double ringing = scene->m > 0.0 ? sqrt(scene->m / reference_rest(scene).sigma) : 0.0;
    const double astray = scene->m > 0.0 ? S * scene->h / scene->m * fmin(scene->h, ringing) : 0.0;
    const double digits = DIGITS + (vibrates(scene) ? 20.0 * DBL_EPSILON * scene->h * scene->f : 0.0);
    const double force = (tolerance + ROUNDING) * S,
                 energy = force * (path + astray) + MIN_S + digits * fmax(S, step->force_before) * lengths;
    const double mean = force + digits * scene->sigma_1 * lengths / scene->h;
    // Of a mass, whose velocity and place are rounded at both ends of the step.
    const double speed = fabs(scene->v_0) + fabs(truth->result[BODY_V]),
                 way = fabs(scene->x_0) + fabs(truth->result[BODY_X]);
    const double of_v = mean * scene->h / scene->m + 2.0 * DBL_EPSILON * speed;
    const double of_x = of_v * scene->h + 2.0 * DBL_EPSILON * way;
    Verdict worst = {.ratio = -1.0};
    for (int k = 0; k <= SLIPS_AT_END; k++) {
        const double found = step->result[k];
        const double off = found - fmin(fmax(found, range[0].result[k]), range[1].result[k]);
        if (scene->m == 0.0 && (k == BODY_V || k == BODY_X)) {
            continue;
        }
        const double allowed = k == SLIPS_AT_END                ? 0.0
                               : k == BODY_V                    ? of_v
                               : k == BODY_X                    ? of_x
                               : k == W_F || k == Q_F           ? energy
                               : k == F_T_MEAN || k == F_Y_MEAN ? mean
                                                                : force;
        const double ratio = off == 0.0 ? 0.0 : over(off, allowed);
        worst = ratio > worst.ratio ? (Verdict){ratio, k} : worst;
    }
    return worst;
}

// The step from the FMU's state before it. A settled start is judged by its own force.
static void step_of_reference(const ReferenceScene* before, const ReferenceScene* scene, const FmuStep* step,
                              int fineness, ReferenceStep* truth) {
    reference_step(before, scene, fineness, truth);
    if (scene->initial == START_SETTLED && scene->law != LAW_COULOMB) {
        const ReferenceStep settled = *truth;
        ReferenceScene from = *scene;
        from.initial = START_GIVEN;
        from.delta_0 = step->delta_start;
        from.delta_y_0 = step->delta_y_start;
        from.slips = step->slips_start;
        reference_step(NULL, &from, fineness, truth);
        truth->result[F_T_START] = settled.result[F_T_START];
        truth->result[F_Y_START] = settled.result[F_Y_START];
        truth->known = truth->known && settled.known;
    }
}

// A drop at break-away may pass on more of an error of the deflection than it gets: the motion may be chaotic.
static bool may_be_chaotic(const ReferenceScene* scene) { return scene_gain(scene) > 2.0; }

// The verdict if the reference may also begin, and last, two units in the last place more or less, or begin at a
// deflection that differs by 2e-10 of itself. If the motion may be chaotic, the deflection differs by the tolerance, and
// the range of the results grows by itself to both sides.
static Verdict verdict_by_rounding(const ReferenceScene* before, const TrialStep* taken, double tolerance) {
    ReferenceStep range[2] = {taken->truth, taken->truth};
    const bool grows = may_be_chaotic(&taken->scene);
    const double of_delta = grows ? fmax(tolerance, 2e-10) : 2e-10;
    const double ulp = 2.0 * DBL_EPSILON * (fabs(taken->scene.start) + taken->scene.h);
    for (int k = 0; k < (taken->scene.m > 0.0 ? 8 : 6); k++) {
        ReferenceScene moved = taken->scene, past = before ? *before : moved;
        const double way = k % 2 ? 1.0 : -1.0, grown = k < 4 || k > 5 ? 1.0 : 1.0 + way * of_delta;
        moved.start += k < 2 ? way * ulp : 0.0;
        moved.h += k == 2 || k == 3 ? way * ulp : 0.0;
        moved.delta_0 *= grown;
        moved.delta_y_0 *= grown;
        past.start = moved.start;
        moved.v_0 += k > 5 ? way * 2.0 * DBL_EPSILON * (fabs(moved.v_0) + fabs(moved.V) + moved.V_1) : 0.0;
        ReferenceStep found = taken->truth;
        if (moved.h > 0.0) {
            step_of_reference(before ? &past : NULL, &moved, &taken->step, 1, &found);
        }
        for (int j = 0; j < RESULTS; j++) {
            range[0].result[j] = fmin(range[0].result[j], found.result[j]);
            range[1].result[j] = fmax(range[1].result[j], found.result[j]);
        }
    }
    for (int k = 0; k < RESULTS && grows; k++) {
        const double width = range[1].result[k] - range[0].result[k];
        range[0].result[k] -= width;
        range[1].result[k] += width;
    }
    return verdict_outside(taken, range, tolerance);
}

// Whether the reference takes the step the same in smaller panels, to a tenth of the allowed error.
static bool is_sharp(const ReferenceScene* before, const TrialStep* taken, double tolerance) {
    TrialStep finer = *taken;
    ReferenceStep found;
    step_of_reference(before, &taken->scene, &taken->step, 2, &found);
    memcpy(finer.step.result, found.result, sizeof found.result);
    const ReferenceStep truth[2] = {taken->truth, taken->truth};
    return found.known && verdict_outside(&finer, truth, tolerance).ratio <= SHARP;
}

// The error of F_t_settled over the allowed error, -1 if the reference does not know it.
static double settled_ratio(TrialStep* taken, const Sequence* sequence) {
    ReferenceScene still = taken->scene;
    FcVector* found = &taken->settled;
    double *truth = taken->settled_truth, S, ratio = -1.0;
    still.initial = START_GIVEN;
    FmuRun run;
    open_run(&run, &still, sequence);
    if (run.started && fc_settled_force(&run.contact, found, &run.message) &&
        reference_settled_force(&still, truth, &S)) {
        const double allowed = (sequence->tolerance + ROUNDING) * fmax(S, MIN_S);
        ratio = fmax(over(found->x - truth[0], allowed), over(found->y - truth[1], allowed));
    }
    fc_friction_contact_free(&run.contact);
    return ratio;
}

// Whether the scene has a settled state that is promised.
static bool settles(const ReferenceScene* s) {
    return s->law == LAW_COULOMB || !vibrates(s) || (scene_kappa(s) >= MIN_KAPPA && !may_be_chaotic(s));
}

// Whether the step is outside the domain of the promise. Over more than ten periods of a motion that may be chaotic the
// result does not depend on the state before.
static bool is_outside(const ReferenceScene* s, const ReferenceScene* first) {
    const bool swings = s->law != LAW_COULOMB && (s->V_1 != 0.0 || s->V_2 != 0.0);
    const bool forgets = vibrates(s) && may_be_chaotic(s) && s->h * s->f > 10.0;
    return forgets || (swings && scene_kappa(s) < MIN_KAPPA) || scene_start_over_limit(s) > LARGEST_START ||
           (first->initial == START_SETTLED && !settles(first));
}

// Returns false if the step is not judged.
static bool grade(TrialStep* taken, const ReferenceScene* before, const Sequence* sequence, bool settled) {
    const ReferenceScene* scene = &taken->scene;
    taken->verdict = (Verdict){.ratio = -1.0};
    step_of_reference(before, scene, &taken->step, 1, &taken->truth);
    if (!taken->truth.known) {
        return false;
    }
    const ReferenceStep truth[2] = {taken->truth, taken->truth};
    Verdict verdict = verdict_outside(taken, truth, sequence->tolerance);
    if (!(verdict.ratio <= 1.0)) {
        verdict = verdict_by_rounding(before, taken, sequence->tolerance);
    }
    if (!(verdict.ratio <= 1.0) &&
        (is_outside(scene, &sequence->step[0]) || !is_sharp(before, taken, sequence->tolerance))) {
        return false;
    }
    const double of_settled = settled ? settled_ratio(taken, sequence) : -1.0;
    const bool counts = of_settled > verdict.ratio && (of_settled <= 1.0 || settles(scene));
    taken->verdict = counts ? (Verdict){of_settled, SETTLED} : verdict;
    return true;
}

void trial_run(Trial* trial, const Sequence* sequence, bool settled) {
    *trial = (Trial){0};
    FmuRun run;
    open_run(&run, &sequence->step[0], sequence);
    for (int k = 0; k < sequence->steps; k++) {
        TrialStep* taken = &trial->taken[k];
        ReferenceScene before;
        taken->scene = sequence->step[k];
        if (!take_step(&run, &taken->scene, &taken->step)) {
            trial->refused = true;
            break;
        }
        if (k > 0) {
            before = scene_after(&trial->taken[k - 1].scene);
            taken->scene.delta_0 = taken->step.delta_start;
            taken->scene.delta_y_0 = taken->step.delta_y_start;
            taken->scene.slips = taken->step.slips_start;
            taken->scene.v_0 = before.v_0 = taken->step.v_start;
            taken->scene.x_0 = taken->step.x_start;
        }
        trial->unknown += !grade(taken, k == 0 ? NULL : &before, sequence, settled && k == 0);
        trial->worst = fmax(trial->worst, taken->verdict.ratio);
        trial->steps++;
    }
    trial->message = run.message;
    trial->evaluations = run.contact.state.variables.solver.evaluations;
    fc_friction_contact_free(&run.contact);
}
