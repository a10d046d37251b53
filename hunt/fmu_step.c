#include "fmu_step.h"

#include "settled_force.h"

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

void fmu_open(FmuRun* run, const ReferenceScene* scene, int method, double tolerance) {
    *run = (FmuRun){0};
    FcVariables* v = &run->contact.state.variables;
    set_variables(v, scene);
    v->solver.method = method;
    v->solver.tolerance = tolerance;
    v->solver.stepSize = scene->h / 300.0;
    run->started = fc_friction_contact_initialize(&run->contact, scene->start, &run->message);
}

void fmu_close(FmuRun* run) { fc_friction_contact_free(&run->contact); }

bool fmu_step(FmuRun* run, const ReferenceScene* scene, FmuStep* step) {
    FcFrictionState *state = &run->contact.state, *before = &run->after;
    FcVariables* v = &state->variables;
    step->delta_start = v->delta;
    step->delta_y_start = v->delta_y;
    step->slips_start = state->slips;
    set_variables(v, scene);
    state->next_rate_set = 1; // all 0
    if (!run->started || !fc_friction_contact_refresh(&run->contact, &run->message)) {
        return false;
    }
    step->result[F_T_START] = v->F_t;
    step->result[F_Y_START] = v->F_y;
    state->next_rate[FC_INPUT_V] = scene->V_rate;
    state->next_rate[FC_INPUT_D] = scene->d_rate;
    state->next_rate[FC_INPUT_E] = scene->E_rate;
    state->next_rate[FC_INPUT_LOAD] = scene->load_rate;
    state->next_rate[FC_INPUT_V_Y] = scene->V_y_rate;
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
    step->result[W_F] = (v->W_f - before->variables.W_f) + (state->W_f_rest - before->W_f_rest);
    step->result[Q_F] = (v->Q_f - before->variables.Q_f) + (state->Q_f_rest - before->Q_f_rest);
    *before = *state;
    return true;
}

bool fmu_settled_force(FmuRun* run, double force[2]) {
    FcVector both = {0.0, 0.0};
    const bool found = run->started && fc_settled_force(&run->contact, &both, &run->message);
    force[0] = both.x;
    force[1] = both.y;
    return found;
}
