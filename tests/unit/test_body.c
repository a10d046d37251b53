// A mass without a bristle against closed forms, and the acceleration of one whose kinetic bound moves with it.
#include "solver/body/body_step.h"

#include "check.h"
#include "table_1.h"

static const double M = 2.0;    // kg
static const double F_C = 55.0; // N

// The scene points into what the caller keeps.
static FcScene scene_of(const FcContactParameters* contact, const FcFriction* friction, FcLinearInput V,
                        double V_1, double load) {
    FcScene scene = {.drive = {.V = V,
                               .d = {14e-6, 0.0},
                               .E = {5e10, 0.0},
                               .load = {load, 0.0},
                               .vibration = {.f = 20e3, .V_1 = V_1}}};
    fc_drive_start(&scene.drive, 0.3e-5, 0.0);
    const FcContactAtModulus at_E = fc_contact_at_modulus(contact, 5e10);
    fc_scene_make(&scene, contact, &at_E, friction, F_C);
    return scene;
}

static FcStepResult step(const FcScene* scene, double h, FcBody* body) {
    const FcSolverOptions options = {.tolerance = 1e-8, .force = F_C, .largest = F_C, .step_size = 1e-8};
    FcStepResult result;
    FcMessage message = {""};
    CHECK(fc_body_step(scene, FC_METHOD_COLLOCATION, NULL, &options, h, (FcBristle){0}, body, &result,
                       &message));
    return result;
}

// v' = (F - sigma_2 w) / m: exponential, or the plain double integral.
static void an_open_contact_leaves_the_mass_free(void) {
    const FcContactParameters contact = table_1(FC_CONTACT_ASPERITIES, FC_CONTACT_LOAD);
    const double h = 7e-3;
    for (int viscous = 0; viscous <= 1; viscous++) {
        const double sigma_2 = viscous ? 700.0 : 0.0;
        const FcFriction friction = {
            .model = FC_DAHL, .limit = FC_LIMIT_CONSTANT, .sigma_1 = 40.0, .sigma_2 = sigma_2};
        const FcScene scene =
            scene_of(&contact, &friction, (FcLinearInput){0.2, 0.0}, viscous ? 0.0 : 0.7, -3.0);
        FcBody body = {.m = M, .F = {40.0, -9e3}, .v = 0.1, .x = 0.5};
        const FcStepResult result = step(&scene, h, &body);
        const double B = viscous ? -9e3 / sigma_2 : 0.0;
        const double A = viscous ? (40.0 - M * B) / sigma_2 - 0.2 : 0.0;
        const double fades = exp(-sigma_2 / M * h);
        const double v = viscous ? A + B * h + (0.1 - A) * fades : 0.1 + (40.0 - 4.5e3 * h) * h / M;
        const double moved = viscous ? A * h + 0.5 * B * h * h + (0.1 - A) * (1.0 - fades) * M / sigma_2
                                     : 0.1 * h + (20.0 - 1.5e3 * h) * h * h / M;
        CHECK_WITHIN(body.v, v, 1e-14);
        CHECK_WITHIN(body.x, 0.5 + moved, 2e-16);
        CHECK_WITHIN(result.impulse, sigma_2 * (moved + 0.2 * h), 1e-13);
        CHECK_WITHIN(body.F.value, 40.0 - 9e3 * h, 1e-13);
    }
}

// Without any force no error is allowed either.
static void a_mass_on_which_no_force_acts_drifts(void) {
    const FcContactParameters contact = table_1(FC_CONTACT_ASPERITIES, FC_CONTACT_LOAD);
    const FcFriction friction = {.model = FC_DAHL, .limit = FC_LIMIT_LOAD};
    const FcScene scene = scene_of(&contact, &friction, (FcLinearInput){0.2, 0.0}, 0.7, 0.0);
    const FcSolverOptions options = {.tolerance = 1e-8, .step_size = 1e-8};
    FcBody body = {.m = M, .v = 0.1};
    FcStepResult result;
    FcMessage message = {""};
    CHECK(fc_body_step(&scene, FC_METHOD_COLLOCATION, NULL, &options, 7e-3, (FcBristle){0}, &body, &result,
                       &message));
    CHECK(body.v == 0.1);
    CHECK_WITHIN(body.x, 0.1 * 7e-3, 7e-17); // by the rounding of 470 panels
}

static const FcFriction COULOMB = {.model = FC_COULOMB, .limit = FC_LIMIT_CONSTANT};

static void coulomb_stops_the_mass_and_holds_it(void) {
    const FcContactParameters contact = table_1(FC_CONTACT_CONSTANT, FC_CONTACT_SEPARATION);
    const FcScene scene = scene_of(&contact, &COULOMB, (FcLinearInput){0.0, 0.0}, 0.0, 0.0);
    FcBody body = {.m = M, .F = {30.0, 0.0}, .v = 0.1};
    const FcStepResult result = step(&scene, 1e-2, &body);
    const double stops = M * 0.1 / (F_C - 30.0); // 8 ms
    CHECK_WITHIN(body.v, 0.0, 1e-17);
    CHECK(body.sticks);
    CHECK_NEAR(body.x, 0.05 * stops, 1e-14);
    CHECK_NEAR(result.impulse, 30.0 * 1e-2 + M * 0.1, 1e-15);
    CHECK_NEAR(result.heat, F_C * 0.05 * stops, 1e-14);
}

static void coulomb_breaks_away_where_the_force_exceeds_the_limit(void) {
    const FcContactParameters contact = table_1(FC_CONTACT_CONSTANT, FC_CONTACT_SEPARATION);
    const FcScene scene = scene_of(&contact, &COULOMB, (FcLinearInput){0.3, -1.0}, 0.0, 0.0);
    FcBody body = {.m = M, .F = {10.0, 1e4}, .v = -0.3};
    step(&scene, 1e-2, &body);
    const double slips = 1e-2 - (F_C - (10.0 - M)) / 1e4; // F + m V' reaches the limit 5.3 ms before the end
    CHECK_WITHIN(body.v + 0.3 - 1e-2, 1e4 * slips * slips / (2.0 * M), 1e-14);
    CHECK(!body.sticks);
}

// Below the limit the mass moves with the other surface; above it slips in each half of a period.
static void a_mass_that_sticks_follows_the_vibration(void) {
    const FcContactParameters contact = table_1(FC_CONTACT_CONSTANT, FC_CONTACT_SEPARATION);
    for (int exceeds = 0; exceeds <= 1; exceeds++) {
        const double V_1 = exceeds ? 2e-4 : 1e-4; // m V_1 2 pi f = 50 or 25 N
        const FcScene scene = scene_of(&contact, &COULOMB, (FcLinearInput){0.0, 0.0}, V_1, 0.0);
        FcBody body = {.m = M, .F = {10.0, 0.0}, .v = -fc_drive_V(&scene.drive, 0.0)};
        const double h = 3.3 / 20e3;
        const FcStepResult result = step(&scene, h, &body);
        CHECK((result.heat != 0.0) == exceeds);
        if (!exceeds) {
            CHECK_WITHIN(body.v, -fc_drive_V(&scene.drive, h), 1e-18);
            CHECK_WITHIN(body.x, -fc_drive_displacement(&scene.drive, 0.0, h), 1e-22);
        }
    }
}

// F_t with the acceleration that it causes, in a slip along a bound that follows w.
static void the_acceleration_is_that_of_its_force(void) {
    const FcContactParameters contact = table_1(FC_CONTACT_CONSTANT, FC_CONTACT_SEPARATION);
    const FcFriction friction = {.model = FC_ELASTIC_PLASTIC,
                                 .limit = FC_LIMIT_CONSTANT,
                                 .staticRatio = 1.5,
                                 .V_S = 0.05,
                                 .sigma_1 = 300.0,
                                 .sigma_2 = 3.0};
    const FcScene scene = scene_of(&contact, &friction, (FcLinearInput){0.01, 2.0}, 0.0, 0.0);
    const FcBody body = {.m = M, .F = {80.0, 0.0}, .v = 0.03};
    FcScene seen = scene;
    seen.drive.V.value += body.v;
    const FcBristle bristle = fc_scale_onto_bound(&seen, (FcBristle){.delta = 2e-5, .state = FC_SLIPPING});
    const FcScene moving = fc_body_scene(&scene, &body, bristle);
    const double a = moving.drive.V.rate - scene.drive.V.rate;
    const double F_t = fc_motion(&moving, bristle).force.x;
    CHECK_WITHIN(M * a, body.F.value - F_t, 1e-11);
    CHECK(fabs(F_t - fc_motion(&seen, bristle).force.x) > 1e-3);
    CHECK(fc_body_inertia(&seen, bristle, &body) < M);
}

int main(void) {
    an_open_contact_leaves_the_mass_free();
    a_mass_on_which_no_force_acts_drifts();
    coulomb_stops_the_mass_and_holds_it();
    coulomb_breaks_away_where_the_force_exceeds_the_limit();
    a_mass_that_sticks_follows_the_vibration();
    the_acceleration_is_that_of_its_force();
    return check_result();
}
