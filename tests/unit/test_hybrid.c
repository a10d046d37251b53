// What model exchange keeps of a contact: how fast the inputs are seen to move, and the heat of what is taken onto a bound.
#include "hybrid.h"

#include <string.h>

#include "check.h"
#include "solver/solver.h"
#include "table_1.h"

static const double SIGMA = 2.5e6; // N/m
static const double MU = 0.176;

// ElasticPlastic of constant stiffness, pressed by a load [N].
static FcFrictionContact pressed(double load) {
    FcFrictionContact contact;
    memset(&contact, 0, sizeof contact);
    FcVariables* v = &contact.state.variables;
    v->d = 14e-6;
    v->E = 58e9;
    v->load = load;
    v->F_C = 55.0;
    v->initialState = FC_STATE_GIVEN;
    v->friction = (FcFriction){
        .model = FC_ELASTIC_PLASTIC, .limit = FC_LIMIT_LOAD, .mu = MU, .staticRatio = 1.0, .V_S = 0.01};
    v->contact = table_1(FC_CONTACT_CONSTANT, FC_CONTACT_LOAD);
    v->vibration.f = 20e3;
    v->solver.method = FC_METHOD_COLLOCATION;
    v->solver.tolerance = 1e-6;
    FcMessage message;
    CHECK(fc_hybrid_allows(&contact, &message));
    CHECK(fc_friction_contact_initialize(&contact, 0.0, &message));
    fc_hybrid_start(&contact);
    return contact;
}

// What the host does at an event; whether a state has changed.
static bool update(FcFrictionContact* contact) {
    bool changed;
    bool nominals_changed;
    FcMessage message;
    CHECK(fc_hybrid_update(contact, &changed, &nominals_changed, &message));
    fc_hybrid_event_ends(contact);
    return changed;
}

static bool event(FcFrictionContact* contact) {
    fc_hybrid_event_begins(contact);
    return update(contact);
}

static void the_speed_of_inputs_is_that_between_two_steps(void) {
    FcFrictionContact contact = pressed(100.0);
    FcHybrid* hybrid = &contact.state.hybrid;
    update(&contact);
    fc_hybrid_set_time(&contact, 0.5);
    contact.state.variables.load = 90.0;
    CHECK(!fc_hybrid_step_completed(&contact));
    CHECK_NEAR(hybrid->speed[FC_INPUT_LOAD], -20.0, 1e-14);
    CHECK(hybrid->speed[FC_INPUT_V] == 0.0 && hybrid->speed[FC_INPUT_D] == 0.0);
    fc_hybrid_set_time(&contact, nextafter(0.5, 1.0)); // too short to tell a speed
    contact.state.variables.load = 90.0 + 1e-13;
    fc_hybrid_step_completed(&contact);
    CHECK_NEAR(hybrid->speed[FC_INPUT_LOAD], -20.0, 1e-14);
    contact.state.variables.load = 40.0; // a jump at an event is no motion
    fc_hybrid_event_ends(&contact);
    fc_hybrid_set_time(&contact, 1.5);
    fc_hybrid_step_completed(&contact);
    CHECK(hybrid->speed[FC_INPUT_LOAD] == 0.0);
}

// While the bristle slips the load falls on, and sigma stays: what the bristle stored is heat, once an event takes it along.
static void a_bristle_that_slips_gives_its_heat_at_the_next_event(void) {
    FcFrictionContact contact = pressed(100.0);
    FcVariables* v = &contact.state.variables;
    v->V = 1e-3;
    v->delta = MU * 100.0 / SIGMA;
    update(&contact);
    CHECK(contact.state.hybrid.regime == FC_SLIPS_FORWARD);
    const double start = v->delta;
    const double Q_f = v->Q_f; // of rounding
    for (int k = 1; k <= 4; k++) {
        fc_hybrid_set_time(&contact, 0.1 * k);
        v->load = 100.0 - 20.0 * k;
        CHECK(!fc_hybrid_step_completed(&contact));
        CHECK(v->Q_f == Q_f && v->delta == start);
    }
    CHECK(event(&contact));
    CHECK(contact.state.hybrid.regime == FC_SLIPS_FORWARD);
    const double end = MU * 20.0 / SIGMA;
    CHECK_NEAR(v->delta, end, 1e-14);
    CHECK_NEAR(v->Q_f, 0.5 * SIGMA * (start * start - end * end), 1e-12);
    CHECK(!event(&contact)); // nothing has moved since
    fc_friction_contact_free(&contact);
}

int main(void) {
    the_speed_of_inputs_is_that_between_two_steps();
    a_bristle_that_slips_gives_its_heat_at_the_next_event();
    return check_result();
}
