// One contact that advances: the model's own guards, which the boundary to FMI is before.
#include "friction_contact.h"

#include <string.h>

#include "check.h"
#include "solver/solver.h"
#include "table_1.h"

static FcFrictionContact contact_at_rest(void) {
    FcFrictionContact contact = {.cvode = NULL};
    FcVariables* v = &contact.state.variables;
    v->V = 0.005;
    v->d = 14e-6;
    v->E = 8e9;
    v->load = 300.0;
    v->F_C = 55.0;
    v->initialState = FC_STATE_GIVEN;
    v->friction = (FcFriction){
        .model = FC_DAHL, .limit = FC_LIMIT_CONSTANT, .mu = 0.2, .staticRatio = 1.0, .V_S = 0.01};
    v->contact = table_1(FC_CONTACT_ASPERITIES, FC_CONTACT_SEPARATION);
    v->vibration.f = 20e3;
    v->solver.method = FC_METHOD_COLLOCATION;
    v->solver.tolerance = 1e-6;
    v->solver.stepSize = 1e-6;
    return contact;
}

static void a_modulus_that_falls_to_zero_is_refused(void) {
    FcFrictionContact contact = contact_at_rest();
    FcMessage message = {{0}};
    CHECK(fc_friction_contact_initialize(&contact, 0.0, &message));
    contact.state.next_rate[FC_INPUT_E] = -6e9;
    contact.state.next_rate_set = 1;
    const FcFrictionContact before = contact;
    CHECK(!fc_friction_contact_advance(&contact, 0.0, 1.5, &message));
    CHECK(strcmp(message.text, "E moves from 8e+09 Pa to -1e+09 Pa in the step: it must stay above 0 Pa") ==
          0);
    CHECK(memcmp(&contact.state, &before.state, sizeof before.state) == 0);
}

int main(void) {
    a_modulus_that_falls_to_zero_is_refused();
    return check_result();
}
