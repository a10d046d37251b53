#include "fmu_step.h"

#include <stdlib.h>

#include "friction_contact.h"
#include "settled_force.h"

struct FmuRun {
    FcFrictionContact contact;
    FcMessage message;
    bool started, stepped;
};

static void set_variables(FcVariables* v, const ReferenceScene* s) {
    v->V = s->V;
    v->d = s->d;
    v->E = s->E;
    v->load = s->load;
    v->V_y = s->V_y;
    v->F_C = s->F_C;
    v->delta_0 = s->delta_0;
    v->delta_y_0 = s->delta_y_0;
    v->initialState = s->initial;
    v->friction = (FcFriction){.model = s->law,
                               .limit = s->limit,
                               .mu = s->mu,
                               .staticRatio = s->staticRatio,
                               .V_S = s->V_S,
                               .sigma_1 = s->sigma_1,
                               .sigma_2 = s->sigma_2};
    v->contact = (FcContactParameters){.model = s->contact,
                                       .input = s->input,
                                       .sigma = s->contact_sigma,
                                       .stiffnessScale = s->stiffnessScale,
                                       .R_q = s->R_q,
                                       .R = s->R,
                                       .eta = s->eta,
                                       .A_n = s->A_n,
                                       .nu = s->nu,
                                       .Y = s->Y,
                                       .c = s->c,
                                       .lambda = s->lambda};
    v->vibration = (FcVibration){
        .f = s->f, .V_1 = s->V_1, .a_d = s->a_d, .phase_d = s->phase_d, .V_2 = s->V_2, .phase_2 = s->phase_2};
}

FmuRun* fmu_open(const ReferenceScene* scene, int method, double tolerance) {
    FmuRun* run = calloc(1, sizeof *run);
    if (run == NULL) {
        abort();
    }
    FcVariables* v = &run->contact.state.variables;
    set_variables(v, scene);
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
    step->delta_start = v->delta;
    step->delta_y_start = v->delta_y;
    step->slips_start = state->slips;
    const ReferenceScene still = {0};
    set_variables(v, scene);
    set_rates(state, &still);
    if (!fc_friction_contact_refresh(&run->contact, &run->message)) {
        return false;
    }
    step->result[F_T_START] = v->F_t;
    step->result[F_Y_START] = v->F_y;
    set_rates(state, scene);
    if (!fc_friction_contact_advance(&run->contact, scene->start, scene->h, &run->message)) {
        return false;
    }
    step->delta = v->delta;
    step->delta_y = v->delta_y;
    step->result[F_T] = v->F_t;
    step->result[F_Y] = v->F_y;
    step->result[F_T_MEAN] = v->F_t_mean;
    step->result[F_Y_MEAN] = v->F_y_mean;
    step->result[SLIPS_AT_END] = state->slips != 0;
    const FcFrictionState none = {0}, *from = run->stepped ? &before : &none; // the start may leave heat
    step->result[W_F] = (v->W_f - from->variables.W_f) + (state->W_f_rest - from->W_f_rest);
    step->result[Q_F] = (v->Q_f - from->variables.Q_f) + (state->Q_f_rest - from->Q_f_rest);
    run->stepped = true;
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
