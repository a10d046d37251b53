#include "fmu_step.h"

#include <stdlib.h>

#include "friction_contact.h"
#include "model/derivatives.h"
#include "settled_force.h"

struct FmuRun {
    FcFrictionContact contact;
    FcMessage message;
    bool started;
};

struct FmuState {
    FcFrictionState state;
};

static void* memory(size_t size) {
    void* found = calloc(1, size);
    if (found == NULL) {
        abort();
    }
    return found;
}

// The inputs, and the parameters that are tunable.
static void set_tunable(FcVariables* v, const ReferenceScene* s) {
    v->V = s->V;
    v->d = s->d;
    v->E = s->E;
    v->load = s->load;
    v->F_C = s->F_C;
    v->friction.mu = s->mu;
    v->friction.staticRatio = s->staticRatio;
    v->friction.V_S = s->V_S;
    v->friction.sigma_1 = s->sigma_1;
    v->friction.sigma_2 = s->sigma_2;
    v->contact.sigma = s->contact_sigma;
    v->contact.stiffnessScale = s->stiffnessScale;
    v->vibration = (FcVibration){.f = s->f, .V_1 = s->V_1, .a_d = s->a_d, .phase_d = s->phase_d};
}

static void set_fixed(FcVariables* v, const ReferenceScene* s) {
    v->delta_0 = s->delta_0;
    v->initialState = s->initial;
    v->friction.model = s->law;
    v->friction.limit = s->limit;
    v->contact.model = s->contact;
    v->contact.input = s->input;
    v->contact.R_q = s->R_q;
    v->contact.R = s->R;
    v->contact.eta = s->eta;
    v->contact.A_n = s->A_n;
    v->contact.nu = s->nu;
    v->contact.Y = s->Y;
    v->contact.c = s->c;
    v->contact.lambda = s->lambda;
}

FmuRun* fmu_open(const ReferenceScene* scene, int method, double tolerance) {
    FmuRun* run = memory(sizeof *run);
    FcVariables* v = &run->contact.state.variables;
    set_fixed(v, scene);
    set_tunable(v, scene);
    v->solver.method = method;
    v->solver.tolerance = tolerance;
    v->solver.stepSize = scene->h / 300.0;
    run->started = fc_friction_contact_initialize(&run->contact, scene->start, &run->message);
    return run;
}

void fmu_close(FmuRun* run) {
    fc_friction_contact_free(&run->contact);
    free(run);
}

static void set_rates(FcFrictionState* state, const ReferenceScene* s) {
    state->next_rate[FC_INPUT_V] = s->V_rate;
    state->next_rate[FC_INPUT_D] = s->d_rate;
    state->next_rate[FC_INPUT_E] = s->E_rate;
    state->next_rate[FC_INPUT_LOAD] = s->load_rate;
    state->next_rate_set = 1;
}

// What fmi2GetRealOutputDerivatives and fmi2GetDirectionalDerivative return of F_t.
static double rate_now(FmuRun* run) {
    const FcScene scene = fc_friction_contact_scene(&run->contact);
    return fc_force_rate(&scene, run->contact.state.variables.delta);
}

static void slopes_now(FmuRun* run, double slopes[4]) {
    const FcScene scene = fc_friction_contact_scene(&run->contact);
    const FcGradient gradient = fc_gradient(&scene, run->contact.state.variables.delta);
    slopes[0] = gradient.by_V.F_t;
    slopes[1] = gradient.by_d.F_t;
    slopes[2] = gradient.by_E.F_t;
    slopes[3] = gradient.by_load.F_t;
}

bool fmu_step(FmuRun* run, const ReferenceScene* scene, FmuStep* step) {
    FcFrictionState* state = &run->contact.state;
    FcVariables* v = &state->variables;
    if (!run->started) {
        return false;
    }
    const ReferenceScene still = {0};
    set_tunable(v, scene);
    set_rates(state, &still);
    if (!fc_friction_contact_refresh(&run->contact, &run->message)) {
        return false;
    }
    step->delta_start = v->delta;
    step->F_t_start = v->F_t;
    slopes_now(run, step->slopes);
    set_rates(state, scene);
    step->rate = rate_now(run);
    const FcFrictionState before = *state;
    if (!fc_friction_contact_advance(&run->contact, scene->start, scene->h, &run->message)) {
        return false;
    }
    step->delta = v->delta;
    step->F_t = v->F_t;
    step->F_t_mean = v->F_t_mean;
    step->work = (v->W_f - before.variables.W_f) + (state->W_f_rest - before.W_f_rest);
    step->heat = (v->Q_f - before.variables.Q_f) + (state->Q_f_rest - before.Q_f_rest);
    step->evaluations = v->solver.evaluations;
    return true;
}

bool fmu_settled_force(FmuRun* run, double* force) {
    return run->started && fc_settled_force(&run->contact, force, &run->message);
}

const char* fmu_message(const FmuRun* run) { return run->message.text; }

FmuState* fmu_save(const FmuRun* run) {
    FmuState* saved = memory(sizeof *saved);
    saved->state = run->contact.state;
    return saved;
}

void fmu_restore(FmuRun* run, const FmuState* saved) { run->contact.state = saved->state; }

void fmu_forget(FmuState* saved) { free(saved); }
