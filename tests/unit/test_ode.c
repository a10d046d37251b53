// What model exchange keeps of a contact: how fast the inputs are seen to move.
#include "contact/ode.h"

#include <string.h>

#include "check.h"
#include "solver/solver.h"
#include "table_1.h"

static void the_speed_of_inputs_is_that_between_two_steps(void) {
    FcFrictionContact contact;
    FcMessage message;
    bool changed, nominals_changed;
    memset(&contact, 0, sizeof contact);
    FcVariables* v = &contact.state.variables;
    FcOdeState* ode = &contact.state.ode;
    v->d = 14e-6, v->E = 58e9, v->load = 100.0, v->F_C = 55.0, v->vibration.f = 20e3;
    v->initialState = FC_STATE_GIVEN;
    v->friction = (FcFriction){
        .model = FC_ELASTIC_PLASTIC, .limit = FC_LIMIT_LOAD, .mu = 0.176, .staticRatio = 1.0, .V_S = 0.01};
    v->contact = table_1(FC_CONTACT_CONSTANT, FC_CONTACT_LOAD);
    v->solver.method = FC_METHOD_COLLOCATION, v->solver.tolerance = 1e-6;
    CHECK(fc_ode_allows(&contact, &message));
    CHECK(fc_friction_contact_initialize(&contact, 0.0, &message));
    fc_ode_start(&contact);
    CHECK(fc_ode_update(&contact, &changed, &nominals_changed, &message));
    fc_ode_event_ends(&contact);
    fc_ode_set_time(&contact, 0.5);
    v->load = 90.0;
    CHECK(!fc_ode_step_completed(&contact));
    CHECK_NEAR(ode->speed[FC_INPUT_LOAD], -20.0, 1e-14);
    CHECK(ode->speed[FC_INPUT_V] == 0.0 && ode->speed[FC_INPUT_D] == 0.0);
    fc_ode_set_time(&contact, nextafter(0.5, 1.0)); // too short to tell a speed
    v->load = 90.0 + 1e-13;
    fc_ode_step_completed(&contact);
    CHECK_NEAR(ode->speed[FC_INPUT_LOAD], -20.0, 1e-14);
    v->load = 40.0; // a jump at an event is no motion
    fc_ode_event_ends(&contact);
    fc_ode_set_time(&contact, 1.5);
    fc_ode_step_completed(&contact);
    CHECK(ode->speed[FC_INPUT_LOAD] == 0.0);
}

int main(void) {
    the_speed_of_inputs_is_that_between_two_steps();
    return check_result();
}
