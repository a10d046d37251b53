// The motion of a bristle in a known regime: closed forms where the contact is constant, differences of the bound where the
// surfaces vibrate.
#include "model/regime.h"

#include "check.h"
#include "table_1.h"

static const double SIGMA = 2.5e6; // N/m
static const double F_C = 50.0;    // N
static const double D = 20e-6;     // m, F_C / SIGMA

typedef struct {
    FcContactParameters contact;
    FcFriction friction;
    FcScene scene; // points to them
} Case;

static FcScene scene_at(const Case* one, double V, double a_d, double start) {
    const FcVibration vibration = {.f = 20e3, .a_d = a_d, .phase_d = 0.7};
    const FcDrive drive =
        fc_drive_make((FcLinearInput){V, 0.0}, (FcLinearInput){14e-6, 0.0}, (FcLinearInput){58e9, 0.0},
                      (FcLinearInput){312.0, 0.0}, vibration, start, 0.0);
    const FcContactAtModulus at_E = fc_contact_at_modulus(&one->contact, 58e9);
    return fc_scene_make(&one->contact, &at_E, &one->friction, F_C, &drive);
}

static void make(Case* one, int law, double V) {
    one->contact = table_1(FC_CONTACT_CONSTANT, FC_CONTACT_SEPARATION);
    one->friction = (FcFriction){.model = law,
                                 .limit = FC_LIMIT_CONSTANT,
                                 .mu = 0.176,
                                 .staticRatio = 1.0,
                                 .V_S = 0.01,
                                 .sigma_1 = 3.0,
                                 .sigma_2 = 7.0};
    one->scene = scene_at(one, V, 0.0, 0.0);
}

static void check_motion(const FcMotion* of, double force, double delta_rate, double V) {
    const double F_t = force + 3.0 * delta_rate + 7.0 * V;
    CHECK_NEAR(of->force.x, F_t, 1e-14);
    CHECK_WITHIN(of->rates.delta, delta_rate, 1e-15 * fabs(V));
    CHECK_NEAR(of->rates.W_f, F_t * V, 1e-14);
    CHECK_WITHIN(of->rates.Q_f, F_t * V - force * delta_rate, 1e-13 * fabs(F_t * V));
}

static void closed_forms(void) {
    const double V = -0.3;
    const double delta = 0.4 * D;
    Case one;
    make(&one, FC_ELASTIC_PLASTIC, V);
    FcMotion at = fc_motion(&one.scene, FC_FREE, (FcBristle){.delta = delta});
    check_motion(&at, SIGMA * delta, V, V);
    at = fc_motion(&one.scene, FC_SLIPS_BACK,
                   (FcBristle){.delta = -1.1 * D}); // the force is that of the bound, whatever delta is
    check_motion(&at, -F_C, 0.0, V);
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(&one.scene, 0, &friction);
    CHECK_NEAR(fc_bound(&bound, 0.0), D, 1e-15);
    CHECK_NEAR(fc_push(&one.scene, &bound, 0.0, -1), -V, 1e-15);
    CHECK_NEAR(fc_push(&one.scene, &bound, 0.0, 1), V, 1e-15);
    make(&one, FC_DAHL, V);
    at = fc_motion(&one.scene, FC_FREE, (FcBristle){.delta = delta});
    check_motion(&at, SIGMA * delta, V * (1.0 + delta / D), V);
    make(&one, FC_COULOMB, V);
    at = fc_motion(&one.scene, FC_FREE, (FcBristle){0});
    CHECK_NEAR(at.force.x, -F_C + 7.0 * V, 1e-15);
    CHECK(at.rates.delta == 0.0);
}

static double bound_of(const FcScene* scene) {
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(scene, 0, &friction);
    return fc_bound(&bound, 0.0);
}

// Along a bound that vibrates with the normal force: its rate is the difference of the bound in time.
static void a_bound_that_moves(void) {
    Case one;
    make(&one, FC_DAHL, 0.3);
    one.friction.limit = FC_LIMIT_LOAD;
    const double tau = 1e-10; // s
    for (int k = 0; k < 20; k++) {
        const double t = 2.5e-6 * k;
        const FcScene now = scene_at(&one, 0.3, 1e-6, t);
        const FcScene after = scene_at(&one, 0.3, 1e-6, t + tau);
        const FcScene before = scene_at(&one, 0.3, 1e-6, t - tau);
        const double rate = (bound_of(&after) - bound_of(&before)) / (2.0 * tau);
        const double pace = bound_of(&now) * now.drive.omega;
        CHECK_WITHIN(fc_motion(&now, FC_SLIPS_FORWARD, (FcBristle){0}).rates.delta, rate, 1e-6 * pace);
        CHECK_WITHIN(fc_motion(&now, FC_SLIPS_BACK, (FcBristle){0}).rates.delta, -rate, 1e-6 * pace);
        FcFriction friction;
        const FcScene bound = fc_scene_of_bound(&now, 0, &friction);
        CHECK_WITHIN(fc_push(&now, &bound, 0.0, 1), -rate, 1e-6 * pace); // on its bound it would relax to it
    }
}

// By V and delta, in closed form.
static void derivatives(void) {
    const double V = 0.3;
    const double delta = 0.4 * D;
    Case one;
    make(&one, FC_DAHL, V);
    const FcDirection by_delta = {.delta = 1.0};
    FcMotion slope = fc_motion_along(&one.scene, FC_FREE, (FcBristle){.delta = delta}, &by_delta);
    CHECK_NEAR(slope.rates.delta, -V / D, 1e-14);
    CHECK_NEAR(slope.force.x, SIGMA - 3.0 * V / D, 1e-14);
    const FcDirection by_V = {.V = 1.0};
    slope = fc_motion_along(&one.scene, FC_FREE, (FcBristle){.delta = delta}, &by_V);
    CHECK_NEAR(slope.rates.delta, 1.0 - delta / D, 1e-14);
    CHECK_NEAR(slope.force.x, 3.0 * (1.0 - delta / D) + 7.0, 1e-14);
    make(&one, FC_ELASTIC_PLASTIC, V);
    slope = fc_motion_along(&one.scene, FC_SLIPS_FORWARD, (FcBristle){.delta = delta}, &by_delta);
    CHECK(slope.force.x == 0.0 && slope.rates.delta == 0.0 && slope.rates.W_f == 0.0 &&
          slope.rates.Q_f == 0.0);
}

int main(void) {
    closed_forms();
    a_bound_that_moves();
    derivatives();
    return check_result();
}
