#include "fmu_step.h"

#include <stdlib.h>

#include "friction_contact.h"
#include "settled_force.h"

struct FmuRun {
    FcFrictionContact contact;
    FcMessage message;
    bool started;
    int steps; // taken
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
    v->V_y = s->V_y;
    v->F_C = s->F_C;
    v->friction.mu = s->mu;
    v->friction.staticRatio = s->staticRatio;
    v->friction.V_S = s->V_S;
    v->friction.sigma_1 = s->sigma_1;
    v->friction.sigma_2 = s->sigma_2;
    v->contact.sigma = s->contact_sigma;
    v->contact.stiffnessScale = s->stiffnessScale;
    v->vibration = (FcVibration){
        .f = s->f, .V_1 = s->V_1, .a_d = s->a_d, .phase_d = s->phase_d, .V_2 = s->V_2, .phase_2 = s->phase_2};
}

static void set_fixed(FcVariables* v, const ReferenceScene* s) {
    v->delta_0 = s->delta_0;
    v->delta_y_0 = s->delta_y_0;
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
    state->next_rate[FC_INPUT_V_Y] = s->V_y_rate;
    state->next_rate_set = 1;
}

bool fmu_step(FmuRun* run, const ReferenceScene* scene, FmuStep* step) {
    FcFrictionState* state = &run->contact.state;
    FcVariables* v = &state->variables;
    if (!run->started) {
        return false;
    }
    const FcFrictionState before = *state;
    const bool first = run->steps++ == 0;
    step->delta_start = v->delta;
    step->delta_y_start = v->delta_y;
    step->slips_start = state->slips;
    const ReferenceScene still = {0};
    set_tunable(v, scene);
    set_rates(state, &still);
    if (!fc_friction_contact_refresh(&run->contact, &run->message)) {
        return false;
    }
    step->F_t_start = v->F_t;
    step->F_y_start = v->F_y;
    set_rates(state, scene);
    if (!fc_friction_contact_advance(&run->contact, scene->start, scene->h, &run->message)) {
        return false;
    }
    step->delta = v->delta;
    step->delta_y = v->delta_y;
    step->slips = state->slips;
    step->F_t = v->F_t;
    step->F_y = v->F_y;
    step->F_t_mean = v->F_t_mean;
    step->F_y_mean = v->F_y_mean;
    step->work = v->W_f + state->W_f_rest;
    step->heat = v->Q_f + state->Q_f_rest;
    if (!first) {
        step->work = (v->W_f - before.variables.W_f) + (state->W_f_rest - before.W_f_rest);
        step->heat = (v->Q_f - before.variables.Q_f) + (state->Q_f_rest - before.Q_f_rest);
    }
    step->evaluations = v->solver.evaluations;
    return true;
}

bool fmu_settled_force(FmuRun* run, double force[2]) {
    FcVector both = {0.0, 0.0};
    const bool found = run->started && fc_settled_force(&run->contact, &both, &run->message);
    force[0] = both.x;
    force[1] = both.y;
    return found;
}

const char* fmu_message(const FmuRun* run) { return run->message.text; }
