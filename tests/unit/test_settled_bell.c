// What a bell of the Stribeck curve adds to a bristle that follows its limit through it, against brute force: a million short
// steps of constant coefficients, each solved exactly, with the curve and without.
#include "check.h"
#include "solver/affine_map.h"
#include "solver/settled_bell.h"
#include "solver/stribeck_bell.h"
#include "table_1.h"

static const double F_C = 55.0; // N
static const double REACH = 5.5;
enum { STEPS = 1000000 };

typedef struct {
    FcContactParameters contact;
    FcFriction friction;
    FcScene scene;
    FcSceneBeyondBells beyond;
    double reversal; // s
    double sign;     // of V after it
    double follows;  // 1, static limit over sigma, over the path in which the curve falls e-fold
} Case;

typedef struct {
    double V, V_1, V_rate; // m/s, m/s, m/s2
    double a_d;            // m
    double V_S;            // m/s
    double staticRatio;
    double follows; // 1, about
} Kind;

static void make(Case* c, const Kind* kind) {
    c->contact = table_1(FC_CONTACT_ASPERITIES, FC_CONTACT_SEPARATION);
    c->friction = (FcFriction){
        .model = FC_LUGRE, .limit = FC_LIMIT_CONSTANT, .staticRatio = kind->staticRatio, .V_S = kind->V_S};
    const double E = 58.556936170e9;
    const FcVibration vibration = {.f = 20e3, .V_1 = kind->V_1, .a_d = kind->a_d, .phase_d = 0.7};
    const FcDrive drive =
        fc_drive_make((FcLinearInput){kind->V, kind->V_rate}, (FcLinearInput){14e-6, 0.0},
                      (FcLinearInput){E, 0.0}, (FcLinearInput){0.0, 0.0}, vibration, 1.7e-5, 0.0);
    c->reversal = fc_drive_next_event(&drive, 0.0, 1.0).time;
    const double rate = fc_drive_V_rate(&drive, c->reversal);
    c->sign = fc_sign(rate);
    const double sigma = 2.0 * kind->staticRatio * F_C * fabs(rate) / (kind->follows * kind->V_S * kind->V_S);
    c->contact.stiffnessScale = sigma / 5.743065402e12;
    const FcContactAtModulus at_E = fc_contact_at_modulus(&c->contact, E);
    c->scene = fc_scene_make(&c->contact, &at_E, &c->friction, F_C, &drive);
    fc_scene_beyond_bells(&c->scene, &c->beyond);
    c->follows = kind->follows * sigma / fc_scene_stiffness(&c->scene, c->reversal);
}

static FcStepResult brute_force(const FcScene* scene, double start, double end, double delta_0) {
    FcStepResult sum = {.delta = delta_0};
    const double step = (end - start) / STEPS;
    for (int i = 0; i < STEPS; i++) {
        const FcCoefficients at = fc_scene_coefficients(scene, start + (i + 0.5) * step);
        const FcMap map = fc_map_of_constant_scene(&at, step);
        fc_map_apply(&map, &sum);
    }
    return sum;
}

// Rate [1/s] of the logarithm of the stiffness around the reversal, at the most.
static double drift(const Case* c, double tau) {
    return 1.2 * fmax(fabs(fc_scene_log_rates(&c->beyond.scene, c->reversal).sigma),
                      fabs(fc_scene_log_rates(&c->beyond.scene, c->reversal + REACH * tau).sigma));
}

// The bell on one side of the reversal, from an edge that lies `from` Stribeck velocities off it on.
static void check_bell(const Case* c, double side, double from) {
    const FcDrive* drive = &c->scene.drive;
    const double tau = c->friction.V_S / fabs(fc_drive_V_rate(drive, c->reversal));
    const double edge = c->reversal + side * from * tau;
    const double far = c->reversal + side * REACH * tau;
    const double sign = c->sign * side;
    const FcVelocity at = fc_drive_velocity(drive, edge);
    const FcCoefficients here = fc_scene_coefficients(&c->scene, edge);
    const FcSettledBell bell = fc_settled_bell(&c->scene, &at, side, sign, REACH, here.sigma, drift(c, tau));

    const double start = side > 0.0 ? edge : far;
    const double end = side > 0.0 ? far : edge;
    const FcCoefficients first = fc_scene_coefficients(&c->beyond.scene, start);
    const double D = sign * F_C / first.sigma;
    const double followed = side > 0.0 ? D * (1.0 + bell.curve) * (1.0 + bell.lag) : D;
    const FcStepResult with = brute_force(&c->scene, start, end, followed);
    const FcStepResult without = brute_force(&c->beyond.scene, start, end, D);

    CHECK(bell.error > 0.0 && bell.error < 0.2 * (c->friction.staticRatio - 1.0) * tau);
    const double allowed = F_C * bell.error; // N s
    const double V = REACH * c->friction.V_S;
    CHECK_WITHIN(sign * (with.impulse - without.impulse), bell.impulse, allowed);
    CHECK_WITHIN(with.work - without.work, bell.work, 0.5 * V * allowed);
    CHECK_WITHIN(with.heat - without.heat, bell.heat, 0.5 * V * allowed);
    // of the drag no more than its size is asked for
    CHECK_WITHIN(with.drag - without.drag, bell.drag, 3.0 * c->follows * fabs(bell.drag));
    CHECK_WITHIN(bell.curve, here.limit / F_C - 1.0, 1e-12);
    if (side < 0.0) {
        const double lag = with.delta / without.delta / (1.0 + bell.curve) - 1.0;
        CHECK_WITHIN(lag, bell.lag, bell.at_edge + 1e-9);
        CHECK(fabs(bell.lag) > 2.0 * bell.at_edge || from > 0.0);
    }
}

static const Kind KINDS[] = {
    {.V_rate = -2e4, .V = 0.5, .V_S = 0.0144, .staticRatio = 1.3, .follows = 0.02},
    {.V_rate = 2e4, .V = -0.5, .V_S = 0.0144, .staticRatio = 1.3, .follows = 0.1},
    {.V = 0.4, .V_1 = 1.44, .V_S = 0.0144, .staticRatio = 2.5, .follows = 0.05},
    {.V = 1.1, .V_1 = 1.44, .V_S = 0.03, .staticRatio = 1.1, .follows = 0.01},
    {.V = -0.7, .V_1 = 1.44, .V_rate = 3e4, .V_S = 0.03, .staticRatio = 1.3, .follows = 0.02},
    {.V = 5e-3, .V_1 = 1.44, .a_d = 1.1e-6, .V_S = 0.0144, .staticRatio = 1.3, .follows = 0.02},
};
enum { KINDS_COUNT = sizeof KINDS / sizeof *KINDS };

static void bells_from_their_edges(void) {
    for (int k = 0; k < KINDS_COUNT; k++) {
        Case c;
        make(&c, &KINDS[k]);
        check_bell(&c, -1.0, 0.0);
        check_bell(&c, -1.0, 0.8);
        check_bell(&c, 1.0, 0.7);
        check_bell(&c, 1.0, 1.6);
    }
}

static FcSettledBell bell_of(const Case* c, double side, double sign) {
    const FcVelocity at = fc_drive_velocity(&c->scene.drive, c->reversal);
    return fc_settled_bell(&c->scene, &at, side, sign, REACH, fc_scene_stiffness(&c->scene, c->reversal),
                           0.0);
}

// Where |V| falls, where the lag is no small one, and where V only touches zero.
static void bells_that_are_none(void) {
    Case c;
    make(&c, &KINDS[0]);
    CHECK(isfinite(bell_of(&c, 1.0, c.sign).error));
    CHECK(isinf(bell_of(&c, 1.0, -c.sign).error));
    CHECK(isinf(bell_of(&c, -1.0, c.sign).error));
    Kind stiff = KINDS[0];
    stiff.follows = 0.5;
    make(&c, &stiff);
    CHECK(isinf(bell_of(&c, 1.0, c.sign).error));
    const Kind grazing = {.V = 1.4399, .V_1 = 1.44, .V_S = 0.03, .staticRatio = 1.1, .follows = 1e-3};
    make(&c, &grazing);
    CHECK(isinf(bell_of(&c, 1.0, c.sign).error));
}

// What the layer's width tells of a bell beforehand is what the bell says itself.
static void layers_tell_what_may_be_followed(void) {
    for (int k = 0; k < KINDS_COUNT; k++) {
        Case c;
        make(&c, &KINDS[k]);
        const FcVelocity at = fc_drive_velocity(&c.scene.drive, c.reversal);
        const double layer = sqrt(2.0 * c.friction.staticRatio * F_C /
                                  (fc_scene_stiffness(&c.scene, c.reversal) * fabs(at.rate)));
        const double excess = c.friction.staticRatio - 1.0;
        const double of_lag = 3.0 * excess * c.follows * c.follows * c.friction.V_S / fabs(at.rate); // s
        CHECK(of_lag <= bell_of(&c, 1.0, c.sign).error);
        CHECK(fc_may_follow_in_bell(&c.friction, &at, layer, 1.01 * of_lag));
        CHECK(!fc_may_follow_in_bell(&c.friction, &at, layer, 0.99 * of_lag));
        CHECK(!fc_may_follow_in_bell(&c.friction, &at, layer * sqrt(0.5 / c.follows), INFINITY));
    }
}

int main(void) {
    bells_from_their_edges();
    bells_that_are_none();
    layers_tell_what_may_be_followed();
    return check_result();
}
