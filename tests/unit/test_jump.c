// Inputs and parameters that jump: closed forms of the heat, many small jumps against one, static friction on the ramp, contacts
// that open.
#include "solver/jump.h"

#include "check.h"
#include "random.h"
#include "table_1.h"

// What a scene is made of, given at once; a vibration stands still at its phase.
typedef struct {
    FcContactParameters contact;
    FcFriction friction;
    FcVibration vibration;
    double V, d, E, load, F_C;
} Case;

static Case case_of(int contact_model, int input, int law, int limit) {
    return (Case){.contact = table_1(contact_model, input),
                  .friction = {.model = law, .limit = limit, .mu = 0.2, .staticRatio = 1.0, .V_S = 0.01},
                  .vibration = {.f = 20e3},
                  .V = 0.005,
                  .d = 14e-6,
                  .E = 58e9,
                  .load = 300.0,
                  .F_C = 55.0};
}

static FcScene scene_of(const Case* c) {
    const FcDrive drive =
        fc_drive_make((FcLinearInput){c->V, 0.0}, (FcLinearInput){c->d, 0.0}, (FcLinearInput){c->E, 0.0},
                      (FcLinearInput){c->load, 0.0}, c->vibration, 1.3e-5, 0.0);
    const FcContactAtModulus at_E = fc_contact_at_modulus(&c->contact, c->E);
    return fc_scene_make(&c->contact, &at_E, &c->friction, c->F_C, &drive);
}

// From before to after; *heat is added to.
static FcBristle jump(const Case* before, const Case* after, FcBristle bristle, double* heat) {
    const FcScene scene = scene_of(before);
    const FcScene next = scene_of(after);
    const FcPast past = fc_past(&scene);
    double part;
    const FcBristle reached = fc_jump(&next, &past, bristle, &part);
    *heat += part;
    return reached;
}

// Of a bristle that slips.
static double bound(const Case* c) {
    const FcScene scene = scene_of(c);
    FcFriction friction;
    const FcScene of_bound = fc_scene_of_bound(&scene, 1, &friction);
    return fc_bound(&of_bound, 0.0);
}

static double stiffness(const Case* c) {
    const FcScene scene = scene_of(c);
    return fc_scene_stiffness(&scene, 0.0);
}

// Surfaces that come nearer: sigma rises, g stays.
static void with_a_constant_limit_the_heat_is_that_of_sliding(void) {
    const int models[] = {FC_CONTACT_ASPERITIES, FC_CONTACT_MINDLIN};
    for (int i = 0; i < 2; i++) {
        const Case before = case_of(models[i], FC_CONTACT_SEPARATION, FC_ELASTIC_PLASTIC, FC_LIMIT_CONSTANT);
        Case after = before;
        after.d = 9e-6;
        after.E = 40e9;
        for (int side = -1; side <= 1; side += 2) {
            const double delta = 0.7 * side * bound(&before);
            double heat = 0.0;
            const FcBristle reached = jump(&before, &after, (FcBristle){.delta = delta}, &heat);
            const double D = bound(&after);
            CHECK(D < fabs(delta));
            CHECK_NEAR(reached.delta, copysign(D, delta), 1e-15);
            CHECK_NEAR(heat, 55.0 * (fabs(delta) - D), 1e-12);
        }
    }
}

// A load that falls, and mu: what is stored less is heat.
static void with_a_constant_stiffness_the_heat_is_the_stored_energy(void) {
    for (int law = 0; law < 3; law++) {
        const int laws[] = {FC_ELASTIC_PLASTIC, FC_DAHL, FC_LUGRE};
        const Case before = case_of(FC_CONTACT_CONSTANT, FC_CONTACT_LOAD, laws[law], FC_LIMIT_LOAD);
        Case after = before;
        after.load = 20.0;
        after.friction.mu = 0.15;
        const double delta = -0.8 * bound(&before);
        double heat = 0.0;
        const FcBristle reached = jump(&before, &after, (FcBristle){.delta = delta}, &heat);
        CHECK_NEAR(reached.delta, -0.15 * 20.0 / 2.5e6, 1e-14);
        CHECK_NEAR(heat, 0.5 * 2.5e6 * (delta * delta - reached.delta * reached.delta), 1e-12);
        heat = 0.0;
        CHECK(jump(&before, &before, (FcBristle){.delta = delta}, &heat).delta == delta && heat == 0.0);
        after.load = 1e4; // a bound that rises moves no bristle
        CHECK(jump(&before, &after, (FcBristle){.delta = delta}, &heat).delta == delta && heat == 0.0);
    }
}

// g D' is a cubic polynomial of d: Simpson's rule is exact. (mu^2 / c) ln(L_1 / L_0) but for d^3, which sigma = c L^2 holds.
static void asperities_under_a_load_that_jumps(void) {
    const Case before = case_of(FC_CONTACT_ASPERITIES, FC_CONTACT_LOAD, FC_DAHL, FC_LIMIT_LOAD);
    Case after = before;
    after.load = 1200.0; // nearer: D = mu L / (c L^2) falls
    const FcScene start = scene_of(&before);
    const FcScene end = scene_of(&after);
    const double delta = bound(&before);
    double heat = 0.0;
    const FcBristle reached = jump(&before, &after, (FcBristle){.delta = delta}, &heat);
    CHECK_NEAR(reached.delta, bound(&after), 1e-15);
    const double decay = start.at_E.decay;
    const double a = start.drive.d.value;
    const double b = end.drive.d.value;
    double simpson = 0.0; // of g D' = mu^2 load_0^2 / stiffness_0 (decay d^3 + 3 d^2)
    for (int i = 0; i < 3; i++) {
        const double d = a + 0.5 * i * (b - a);
        simpson += (i == 1 ? 4.0 : 1.0) / 6.0 * (a - b) * (decay * d * d * d + 3.0 * d * d);
    }
    const double scale = 0.2 * start.at_E.load_0;
    CHECK_NEAR(heat, scale * scale / start.at_E.stiffness_0 * simpson, 1e-12);
}

// The path does not matter as long as one thing jumps, nor how finely. (With E surfaces that float on a load move, too.)
static void many_small_jumps_are_one(void) {
    const int contacts[] = {FC_CONTACT_ASPERITIES, FC_CONTACT_MINDLIN, FC_CONTACT_CONSTANT};
    int moved = 0;
    for (int k = 0; k < 300; k++) {
        const int laws[] = {FC_ELASTIC_PLASTIC, FC_DAHL, FC_LUGRE};
        const int law = laws[k % 3];
        const int limit = law == FC_ELASTIC_PLASTIC && random_01() < 0.5 ? FC_LIMIT_CONSTANT : FC_LIMIT_LOAD;
        const int input = random_01() < 0.5 ? FC_CONTACT_LOAD : FC_CONTACT_SEPARATION;
        Case start = case_of(contacts[(int)(3.0 * random_01())], input, law, limit);
        start.friction.staticRatio = law == FC_LUGRE ? 1.5 : 1.0;
        start.vibration.a_d = 1e-6 * random_01();
        Case end = start;
        int what = (int)(5.0 * random_01());
        what = what == 1 && input == FC_CONTACT_LOAD ? 2 : what;
        double* to[] = {&end.d, &end.E, &end.load, &end.friction.mu, &end.contact.stiffnessScale};
        const double factor = random_log(0.5, 2.0);
        *to[what] *= factor;
        const double old = *to[what] / factor;
        const double scale = bound(&start);
        const FcBristle from = {.delta = scale * (0.6 + 0.4 * random_01())};
        double at_once = 0.0;
        const FcBristle reached = jump(&start, &end, from, &at_once);
        double in_parts = 0.0;
        FcBristle bristle = from;
        Case before = start;
        const int parts = 7;
        for (int i = 1; i <= parts; i++) {
            Case after = end;
            double* now[] = {&after.d, &after.E, &after.load, &after.friction.mu,
                             &after.contact.stiffnessScale};
            *now[what] = i < parts ? old * pow(factor, (double)i / parts) : old * factor;
            bristle = jump(&before, &after, bristle, &in_parts);
            before = after;
        }
        CHECK_NEAR(bristle.delta, reached.delta, 1e-13);
        CHECK_WITHIN(in_parts, at_once, 1e-9 * stiffness(&start) * scale * scale);
        moved += reached.delta != from.delta;
    }
    CHECK(moved > 60);
}

// delta_0 beyond the bound: the same stiffness held it.
static void without_a_past_the_stiffness_was_the_same(void) {
    for (double ratio = 1.0; ratio < 2.0; ratio += 0.5) {
        Case c = case_of(FC_CONTACT_ASPERITIES, FC_CONTACT_SEPARATION, FC_ELASTIC_PLASTIC, FC_LIMIT_LOAD);
        c.friction.staticRatio = ratio;
        const FcScene scene = scene_of(&c);
        const FcPast none = {.sigma = 0.0};
        const double delta = -3.0 * bound(&c);
        double heat;
        const FcBristle reached = fc_jump(&scene, &none, (FcBristle){.delta = delta}, &heat);
        const double D = bound(&c); // the kinetic one
        CHECK_NEAR(reached.delta, -D, 1e-15);
        CHECK_NEAR(heat, 0.5 * stiffness(&c) * (delta * delta - D * D), 1e-13);
    }
}

// g falls by mu under a constant stiffness. It breaks away where the static bound comes to delta, and follows the kinetic one; the
// heat is all that is stored less, however it comes about.
static void static_friction_breaks_away_on_the_ramp(void) {
    Case before = case_of(FC_CONTACT_CONSTANT, FC_CONTACT_LOAD, FC_ELASTIC_PLASTIC, FC_LIMIT_LOAD);
    before.friction.staticRatio = 1.6;
    before.V = 0.02; // s(V) = 1 + 0.6 e^-4
    const double kinetic = 1.0 + 0.6 * exp(-4.0);
    Case after = before;
    after.friction.mu = 0.1;
    const double D = 0.1 * 300.0 / 2.5e6;
    for (int side = -1; side <= 1; side += 2) {
        double heat = 0.0;
        const FcBristle holds = jump(&before, &after, (FcBristle){.delta = side * 1.59 * D}, &heat);
        CHECK(holds.delta == side * 1.59 * D && holds.slips == 0 && heat == 0.0);
        const double delta = 1.61 * D;
        const FcBristle slides = jump(&before, &after, (FcBristle){.delta = side * delta}, &heat);
        CHECK_NEAR(slides.delta, side * kinetic * D, 1e-14);
        CHECK(slides.slips == (side > 0 ? 1 : 0)); // V pushes forward alone
        CHECK_NEAR(heat, 0.5 * 2.5e6 * (delta * delta - slides.delta * slides.delta), 1e-12);
        // One that slips follows the kinetic bound down, and stays where it is as that rises.
        heat = 0.0;
        const double D_before = kinetic * 0.2 * 300.0 / 2.5e6;
        const FcBristle slipping = {.delta = D_before, .slips = 1};
        const FcBristle followed = jump(&before, &after, slipping, &heat);
        CHECK_NEAR(followed.delta, kinetic * D, 1e-14);
        CHECK(followed.slips == 1);
        CHECK_NEAR(heat, 0.5 * 2.5e6 * (D_before * D_before - followed.delta * followed.delta), 1e-12);
        heat = 0.0;
        const FcBristle inside = jump(&after, &before, followed, &heat);
        CHECK(inside.delta == followed.delta && inside.slips == 1 && heat == 0.0);
        const FcBristle still = inside;
        Case stopped = before;
        stopped.V = 0.0; // nothing pushes
        CHECK(jump(&before, &stopped, still, &heat).slips == 0 && heat == 0.0);
    }
}

// With a constant limit, drop and slip are told apart: the drop is at the stiffness at which the static bound comes to delta.
static void the_drop_is_at_the_stiffness_of_the_ramp(void) {
    Case before = case_of(FC_CONTACT_MINDLIN, FC_CONTACT_SEPARATION, FC_ELASTIC_PLASTIC, FC_LIMIT_CONSTANT);
    before.friction.staticRatio = 1.5;
    before.V = 1.0; // far beyond Stribeck's curve
    Case after = before;
    after.d = 11e-6;
    const double delta = 0.9 * bound(&before);
    const double sigma = 1.5 * 55.0 / delta; // there
    double heat = 0.0;
    const FcBristle reached = jump(&before, &after, (FcBristle){.delta = delta}, &heat);
    CHECK_NEAR(reached.delta, bound(&after), 1e-14);
    const double dropped = 55.0 / sigma;
    const double drop = 0.5 * sigma * (delta * delta - dropped * dropped);
    CHECK_NEAR(heat, drop + 55.0 * (dropped - reached.delta), 1e-12);
}

// A contact that opens loses the bristle: what a constant stiffness stored is heat, else it goes with the stiffness.
static void contacts_that_open(void) {
    const int contacts[] = {FC_CONTACT_CONSTANT, FC_CONTACT_ASPERITIES, FC_CONTACT_MINDLIN};
    for (int i = 0; i < 3; i++) {
        const Case closed = case_of(contacts[i], FC_CONTACT_LOAD, FC_ELASTIC_PLASTIC, FC_LIMIT_LOAD);
        Case open = closed;
        open.load = 0.0;
        const double delta = 0.7 * bound(&closed);
        double heat = 0.0;
        const FcBristle lost = jump(&closed, &open, (FcBristle){.delta = delta}, &heat);
        CHECK(lost.delta == 0.0 && lost.slips == 0);
        CHECK_WITHIN(heat, i == 0 ? 0.5 * 2.5e6 * delta * delta : 0.0, 1e-25);
        heat = 0.0;
        CHECK(jump(&open, &closed, lost, &heat).delta == 0.0 && heat == 0.0);
    }
}

int main(void) {
    with_a_constant_limit_the_heat_is_that_of_sliding();
    with_a_constant_stiffness_the_heat_is_the_stored_energy();
    asperities_under_a_load_that_jumps();
    many_small_jumps_are_one();
    without_a_past_the_stiffness_was_the_same();
    static_friction_breaks_away_on_the_ramp();
    the_drop_is_at_the_stiffness_of_the_ramp();
    contacts_that_open();
    return check_result();
}
