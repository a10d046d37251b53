#include "relations.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "judge.h"
#include "sequence.h"

static const double PI = 3.141592653589793;
static const double FIRST_PART = 0.37; // of a step that is split
static const double LATER = 1024.0;    // periods

static bool is_whole(double x) { return x == rint(x); }

// Whether the phase is exact at the start, half a period and some periods later.
static bool is_on_grid(const ReferenceScene* s) {
    return (s->V_1 == 0.0 && s->a_d == 0.0) ||
           (is_whole(log2(s->f)) && fabs(s->start * s->f) <= LATER && is_whole(ldexp(s->start * s->f, 30)));
}

static bool take(const ReferenceScene* scene, int method, double tolerance, FmuStep* step) {
    FmuRun* run = fmu_open(scene, method, tolerance);
    const bool done = fmu_step(run, scene, step);
    fmu_close(run);
    return done;
}

static bool split(const ReferenceScene* scene, int method, double tolerance, FmuStep* whole) {
    ReferenceScene first = *scene;
    first.h = scene->start + FIRST_PART * scene->h - scene->start;
    if (!(first.h > 0.0 && first.h < scene->h)) {
        return false;
    }
    FmuStep parts[2];
    FmuRun* run = fmu_open(scene, method, tolerance);
    bool done = fmu_step(run, &first, &parts[0]);
    if (done) {
        ReferenceScene second = scene_after(&first, parts[0].delta);
        second.h = scene->h - first.h;
        second.V_rate = scene->V_rate;
        second.d_rate = scene->d_rate;
        second.E_rate = scene->E_rate;
        second.load_rate = scene->load_rate;
        done = fmu_step(run, &second, &parts[1]);
        *whole = parts[1];
        whole->F_t_mean = (parts[0].F_t_mean * first.h + parts[1].F_t_mean * second.h) / scene->h;
        whole->work += parts[0].work;
        whole->heat += parts[0].heat;
        whole->F_t_start = parts[0].F_t_start;
    }
    fmu_close(run);
    return done;
}

static bool mirrored(const ReferenceScene* scene, int method, double tolerance, FmuStep* step) {
    ReferenceScene other = *scene;
    other.V = -scene->V;
    other.V_rate = -scene->V_rate;
    other.delta_0 = -scene->delta_0;
    other.start += 0.5 / scene->f;
    other.phase_d += scene->phase_d > 0.0 ? -PI : PI;
    if (!is_on_grid(scene) || !take(&other, method, tolerance, step)) {
        return false;
    }
    step->delta = -step->delta;
    step->F_t = -step->F_t;
    step->F_t_mean = -step->F_t_mean;
    step->F_t_start = -step->F_t_start;
    return true;
}

static bool shifted(const ReferenceScene* scene, int method, double tolerance, FmuStep* step) {
    ReferenceScene later = *scene;
    later.start += LATER / scene->f;
    return is_on_grid(scene) && take(&later, method, tolerance, step);
}

// The step after a detour over another modulus.
static bool restored(const ReferenceScene* scene, int method, double tolerance, FmuStep* step) {
    ReferenceScene detour = *scene;
    detour.E *= 1.25;
    FmuRun* run = fmu_open(scene, method, tolerance);
    FmuState* saved = fmu_save(run);
    fmu_step(run, &detour, step);
    fmu_restore(run, saved);
    const bool done = fmu_step(run, scene, step);
    fmu_forget(saved);
    fmu_close(run);
    return done;
}

typedef bool Way(const ReferenceScene* scene, int method, double tolerance, FmuStep* step);

// What judge_ratio says of a step, were the other one exact.
static double difference(const ReferenceScene* scene, const ReferenceStep* frame, const FmuStep* exact,
                         const FmuStep* step, double tolerance) {
    ReferenceStep as_truth = *frame;
    as_truth.delta = exact->delta;
    if (frame->gap > tolerance * frame->scale) { // near a jump the two ways may take different sides
        as_truth.F_t = exact->F_t;
    }
    as_truth.F_t_mean = exact->F_t_mean;
    as_truth.work = exact->work;
    as_truth.heat = exact->heat;
    if (frame->gap_start > tolerance * frame->scale) {
        as_truth.F_t_start = exact->F_t_start;
    }
    const Errors errors = judge_errors(scene, &as_truth, step, tolerance);
    int which = 0;
    return judge_ratio(scene, &errors, &as_truth, tolerance, &which);
}

double relation_ratio(int relation, const ReferenceScene* scene, const ReferenceStep* truth, int method,
                      double tolerance) {
    static Way* const WAYS[RELATIONS] = {split, mirrored, shifted, restored};
    FmuStep direct, other;
    if (!take(scene, method, tolerance, &direct) || !WAYS[relation](scene, method, tolerance, &other)) {
        return -1.0;
    }
    if (relation == RELATION_RESTORED) {
        return memcmp(&direct, &other, sizeof direct) == 0 ? 0.0 : INFINITY;
    }
    return difference(scene, truth, &direct, &other, tolerance);
}

static const double FINER = 1e-2, FINEST = 1e-11;

double parts_ratio(const ReferenceScene* scene, const FmuStep* step, const ReferenceStep* frame,
                   double tolerance) {
    const double finer = fmax(FINEST, FINER * tolerance);
    ReferenceScene from = *scene;
    FmuStep parts;
    FmuStep settled;
    ReferenceStep around = *frame;
    from.initial = START_GIVEN;
    from.delta_0 = step->delta_start;
    if (!split(&from, FMU_COLLOCATION, finer, &parts)) {
        return INFINITY;
    }
    if (scene->initial == START_SETTLED) {
        if (!take(scene, FMU_COLLOCATION, finer, &settled)) {
            return INFINITY;
        }
        parts.F_t_start = settled.F_t_start;
    }
    around.delta_start = step->delta_start;
    around.largest = fmax(frame->largest, frame->sigma * fabs(parts.delta));
    return difference(scene, &around, &parts, step, tolerance);
}
