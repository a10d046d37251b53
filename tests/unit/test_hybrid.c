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

// The bound falls below a bristle at rest, which then slips along it until the load stands still.
static void a_bound_that_falls_takes_the_bristle_along(void) {
    FcFrictionContact contact = pressed(100.0);
    FcVariables* v = &contact.state.variables;
    update(&contact);
    v->delta = MU * 95.0 / SIGMA;
    fc_hybrid_set_time(&contact, 0.1);
    v->load = 90.0;
    CHECK(fc_hybrid_step_completed(&contact));
    CHECK(event(&contact));
    const double D = MU * 90.0 / SIGMA;
    CHECK(contact.state.hybrid.regime == FC_SLIPS_FORWARD);
    CHECK_NEAR(v->delta, D, 1e-13);
    CHECK_NEAR(v->Q_f, 0.5 * SIGMA * (MU * 95.0 / SIGMA * (MU * 95.0 / SIGMA) - D * D), 1e-12);
    fc_hybrid_set_time(&contact, 0.2);
    CHECK(fc_hybrid_step_completed(&contact)); // the load stands still: nothing pushes any more
    event(&contact);
    CHECK(contact.state.hybrid.regime == FC_FREE);
    fc_friction_contact_free(&contact);
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

// Static friction: while it slips V falls, the kinetic bound rises ahead of it and takes the push: it sticks before V is 0.
static void it_sticks_where_the_kinetic_bound_outruns_it(void) {
    FcFrictionContact contact = pressed(100.0);
    FcVariables* v = &contact.state.variables;
    v->friction.staticRatio = 1.5;
    v->friction.V_S = 0.1;
    v->V = 0.2;
    v->delta = 1.5 * MU * 100.0 / SIGMA * (1.0 + 1e-9);
    contact.state.past = (FcPast){.sigma = 0.0}; // as at a start beyond the bound
    update(&contact);
    CHECK(contact.state.slips == 1 && contact.state.hybrid.regime == FC_SLIPS_FORWARD);
    // The push V + D s'(V) |V'| / s, with D = mu load s / sigma: it is V (1 - |V'| 2 (R - 1) mu load e^-(V / V_S)^2 / (sigma V_S^2)).
    const double rate = 2e3; // m/s2
    const double outrun = 2.0 * 0.5 * MU * 100.0 / SIGMA / (0.1 * 0.1) * rate;
    const double sticks_at = 0.1 * sqrt(log(outrun));
    for (int k = 0; v->V > 0.0; k++) {
        fc_hybrid_set_time(&contact, 1e-6 * k);
        v->V = 0.2 - rate * 1e-6 * k;
        if (fc_hybrid_step_completed(&contact)) {
            break;
        }
    }
    CHECK_WITHIN(v->V, sticks_at, rate * 1e-6);
    event(&contact);
    CHECK(contact.state.slips == 0 && contact.state.hybrid.regime == FC_FREE);
    const double kinetic = 1.0 + 0.5 * exp(-v->V * v->V / 0.01);
    CHECK_NEAR(v->delta, MU * 100.0 / SIGMA * kinetic, 1e-12);
}

int main(void) {
    the_speed_of_inputs_is_that_between_two_steps();
    a_bound_that_falls_takes_the_bristle_along();
    a_bristle_that_slips_gives_its_heat_at_the_next_event();
    it_sticks_where_the_kinetic_bound_outruns_it();
    return check_result();
}
