// Panels: coefficients at their points against the scene's own, maps against the closed form, and what they say of their
// errors against those errors.
#include "check.h"
#include "solver/panel.h"
#include "solver/tuning.h"
#include "table_1.h"

static const FcFriction DAHL = {
    .model = FC_DAHL, .limit = FC_LIMIT_CONSTANT, .mu = 0.18, .staticRatio = 1.5, .V_S = 0.05};
static const FcVibration ULTRASOUND = {.f = 20e3, .V_1 = 1.44, .a_d = 1.1e-6, .phase_d = 0.7};
static const double OMEGA = 6.283185307179586 * 20e3;
static const double START = 2e-6; // s

static FcContactParameters soft_contact(void) {
    FcContactParameters contact = table_1(FC_CONTACT_ASPERITIES, FC_CONTACT_SEPARATION);
    contact.sigma = 1e6;
    contact.stiffnessScale = 1e-6;
    return contact;
}

static FcScene scene_of(const FcContactParameters* contact, const FcFriction* friction, FcVibration vibration,
                        FcLinearInput V, FcLinearInput d, FcLinearInput E) {
    const FcDrive drive = fc_drive_make(V, d, E, (FcLinearInput){200.0, 0.0}, vibration, 1.3e-5, 0.0);
    const FcContactAtModulus at_E = fc_contact_at_modulus(contact, E.value);
    return fc_scene_make(contact, &at_E, friction, 55.0, &drive);
}

// An interval in the variable t = center + length sinh(u), or t = center + u.
static FcPart part_of(double start, double end, FcStraight in, int side) {
    return (FcPart){.start = start, .end = end, .in = in, .side = side, .narrow = 1.0};
}

static FcNodes nodes_over(const FcPlane* plane, const FcPart* part) {
    FcNodes nodes;
    const double u = fc_straight_place(&part->in, part->start);
    fc_nodes_make(plane, part, u, fc_straight_place(&part->in, part->end) - u, &nodes);
    return nodes;
}

static void nodes_are_of_scene(const FcScene* scene, double h, FcStraight in, bool on_line) {
    FcPlane plane;
    fc_plane_make(&plane, scene);
    plane.on_line = on_line;
    const FcPart part = part_of(START, START + h, in, on_line ? 1 : 0);
    const FcNodes nodes = nodes_over(&plane, &part);
    for (int i = 0; i < FC_POINTS; i++) {
        const double u =
            fc_straight_place(&in, START) +
            (0.5 + FC_RADAU.node[i]) * (fc_straight_place(&in, START + h) - fc_straight_place(&in, START));
        CHECK_WITHIN(nodes.t[i], fc_straight_time(&in, u), 1e-14 * (START + h));
        const FcCoefficients exact = fc_scene_coefficients(scene, nodes.t[i]);
        const double moved = fc_drive_displacement(&scene->drive, START, nodes.t[i]);
        CHECK_WITHIN(nodes.V[i], exact.V, 1e-14 * 2.0);
        CHECK_NEAR(nodes.sigma[i], exact.sigma, 2e-13);
        CHECK_WITHIN(nodes.moved[i], moved, 1e-13 * 2.0 * h + 1e-20);
        CHECK(nodes.speed[i] == (on_line ? nodes.V[i] : hypot(nodes.V[i], nodes.V_y[i])));
        if (on_line) {
            CHECK_NEAR(nodes.limit[i], exact.limit, 2e-13);
        } else {
            const FcPlaneCoefficients at =
                fc_plane_coefficients(&plane, nodes.t[i], fc_drive_phase(&scene->drive, nodes.t[i]));
            CHECK_WITHIN(nodes.V_y[i], at.V.y, 1e-14 * 2.0);
            CHECK_NEAR(nodes.limit[i], at.limit, 2e-13);
        }
    }
    CHECK_NEAR(nodes.duration, h, 1e-12);
}

// Every model of the contact, limit and law, over short and long panels, along a line and in the plane, within what the
// series and doublings lose.
static void nodes_are_the_scene(void) {
    const double lengths[] = {1e-4, 0.4, 1.7, 3.1, 7.9, 12.0}; // rad
    const FcContactModel models[] = {FC_CONTACT_ASPERITIES, FC_CONTACT_CONSTANT, FC_CONTACT_MINDLIN};
    for (int k = 0; k < 3 * 2 * 2 * 2 * 6; k++) {
        FcContactParameters contact = soft_contact();
        contact.model = models[k % 3];
        contact.input = k / 3 % 2 ? FC_CONTACT_LOAD : FC_CONTACT_SEPARATION;
        FcFriction friction = DAHL;
        friction.limit = k / 6 % 2 ? FC_LIMIT_LOAD : FC_LIMIT_CONSTANT;
        friction.model = k / 12 % 2 ? FC_LUGRE : FC_DAHL;
        const double h = lengths[k / 24] / OMEGA;
        FcScene scene =
            scene_of(&contact, &friction, ULTRASOUND, (FcLinearInput){0.3, 1e3}, (FcLinearInput){14e-6, 1e-3},
                     (FcLinearInput){58e9, k % 7 == 0 ? 1e13 : 0.0});
        nodes_are_of_scene(&scene, h, (FcStraight){0.0, INFINITY}, true);
        nodes_are_of_scene(&scene, h, (FcStraight){START, 1e-2 * h}, true);
        nodes_are_of_scene(&scene, h, (FcStraight){START + 1.2 * h, 0.1 * h}, true);
        scene.drive.V_y = (FcLinearInput){0.2, 300.0};
        nodes_are_of_scene(&scene, h, (FcStraight){0.0, INFINITY}, false);
        nodes_are_of_scene(&scene, h, (FcStraight){START - 0.3 * h, 0.03 * h}, false);
    }
}

// What is left of a start after a panel of constant coefficients over z.
static double left_after(double z) {
    const double sigma = 1e6;
    FcContactParameters contact = soft_contact();
    contact.model = FC_CONTACT_CONSTANT;
    contact.sigma = sigma;
    const FcScene scene = scene_of(&contact, &DAHL, (FcVibration){.f = 20e3}, (FcLinearInput){0.2, 0.0},
                                   (FcLinearInput){14e-6, 0.0}, (FcLinearInput){58e9, 0.0});
    FcPlane plane;
    fc_plane_make(&plane, &scene);
    plane.on_line = true;
    const FcPart part = part_of(0.0, z * 55.0 / (sigma * 0.2), (FcStraight){0.0, INFINITY}, 1);
    const FcNodes nodes = nodes_over(&plane, &part);
    const FcFrom from = {.delta = {1e-5, 0.0}, .speed = 0.2, .push = 0.2, .for_any = true};
    FcPanel panel;
    fc_free_panel(&plane, &nodes, &from, &panel);
    return 1.0 - panel.along.relaxation;
}

// Radau IIA of s stages is the approximation of Pade (s - 1, s) of e^-z, with P / Q,
//
//     P = sum over j < s of binomial(s - 1, j) (2 s - 1 - j)! / (2 s - 1)! (-z)^j,      Q with s in place of s - 1, and +z
//
// It is off by s! (s - 1)! / ((2 s - 1)! (2 s)!) z^2s, order 2 s - 1 = 17, and goes to 0 as s / z.
static double pade(double z) {
    const int s = FC_STAGES;
    double above = 0.0;
    double below = 0.0;
    for (int j = 0; j <= s; j++) {
        const double falls = exp(lgamma(2.0 * s - j) - lgamma(2.0 * s));
        const double term = falls * pow(z, j) * exp(lgamma(s + 1.0) - lgamma(j + 1.0) - lgamma(s - j + 1.0));
        below += term;
        above += term * (s - j) / s * (j % 2 ? -1.0 : 1.0);
    }
    return above / below;
}

static void panels_are_of_order_17(void) {
    for (double z = 0.1; z < 1e4; z *= 1.3) {
        CHECK_WITHIN(left_after(z), pade(z), 1e-13);
    }
    // So that the difference of this approximation from e^-z is seen, too.
    CHECK_NEAR(left_after(5.0) - exp(-5.0), pade(5.0) - exp(-5.0), 1e-4);
    CHECK_NEAR(fabs(left_after(1e6)), FC_STAGES / 1e6, 1e-3);
}

// A panel after a reversal, in the variable of its layer, against itself in 16 pieces. The controller accepts the
// estimates up to the allowed error times these shares.
static void check_errors(double length, double stiffness) {
    const FcVibration none = {.f = 20e3};
    FcContactParameters contact = soft_contact();
    contact.model = FC_CONTACT_CONSTANT;
    contact.sigma = stiffness;
    const double V_rate = 1.8e5;
    const FcScene scene = scene_of(&contact, &DAHL, none, (FcLinearInput){0.0, V_rate},
                                   (FcLinearInput){14e-6, 0.0}, (FcLinearInput){58e9, 0.0});
    FcPlane plane;
    fc_plane_make(&plane, &scene);
    plane.on_line = true;
    const double layer = sqrt(2.0 * 55.0 / (stiffness * V_rate));
    const double h = length * layer;
    const FcStraight in = {0.0, layer};
    FcFrom from = {.delta = {-55.0 / stiffness, 0.0}, .speed = V_rate * h, .push = V_rate * h};
    const FcPart part = part_of(0.0, h, in, 1);
    const FcNodes nodes = nodes_over(&plane, &part);
    FcPanel panel;
    fc_free_panel(&plane, &nodes, &from, &panel);
    FcStepResult exact = {.delta = from.delta.x};
    for (int i = 0; i < 16; i++) {
        const FcPart piece = part_of(h * i / 16.0, h * (i + 1) / 16.0, in, 1);
        const FcNodes there = nodes_over(&plane, &piece);
        const FcFrom now = {
            .delta = {exact.delta, 0.0}, .speed = from.speed, .push = from.push, .for_any = true};
        FcPanel fine;
        fc_free_panel(&plane, &there, &now, &fine);
        fc_map_apply(&fine.along, &exact);
    }
    const double error = fabs(panel.along.offset - exact.delta) * stiffness;
    const double of_mean = fabs(panel.along.impulse_offset - exact.impulse) / h;
    const double rounding = 1e-13 * 55.0;
    CHECK(error <= FC_SAFETY / FC_SHARE_OF_END * panel.end_error + rounding);
    CHECK(of_mean <= FC_SAFETY / FC_SHARE_OF_MEAN * panel.mean_error + rounding);
    CHECK(fabs(panel.along.work_offset - exact.work) / (h * from.speed) <=
          FC_SAFETY / FC_SHARE_OF_MEAN * panel.mean_error + rounding);
    CHECK(fabs(panel.along.heat_offset - exact.heat) / (h * from.speed) <=
          FC_SAFETY / FC_SHARE_OF_MEAN * panel.mean_error + rounding);
}

static void estimates_bound_the_errors(void) {
    for (double length = 0.1; length < 12.0; length *= 1.25) { // layers
        for (double stiffness = 1e5; stiffness < 1e13; stiffness *= 100.0) {
            check_errors(length, stiffness);
        }
    }
}

int main(void) {
    nodes_are_the_scene();
    panels_are_of_order_17();
    estimates_bound_the_errors();
    return check_result();
}
