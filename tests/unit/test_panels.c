// Panels: coefficients at their nodes against the scene's own, maps against the closed form, and what they say of their
// errors against those errors.
#include "check.h"
#include "solver/gauss_panel.h"
#include "solver/nodes.h"
#include "solver/radau_panel.h"
#include "table_1.h"

static const FcFriction DAHL = {
    .model = FC_DAHL, .limit = FC_LIMIT_CONSTANT, .mu = 0.18, .staticRatio = 1.5, .V_S = 0.05};
static const FcVibration ULTRASOUND = {.f = 20e3, .V_1 = 1.44, .a_d = 1.1e-6, .phase_d = 0.7};
static const double OMEGA = 6.283185307179586 * 20e3;

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

static const double SYMMETRIC[12] = {-0.5, -0.44, -0.36, -0.28, -0.15, -0.03,
                                     0.03, 0.15,  0.28,  0.36,  0.44,  0.5};
static const double OTHERS[10] = {-0.41, -0.33, -0.21, -0.1, 0.07, 0.15, 0.28, 0.36, 0.5, -0.5};

static void nodes_are_of_scene(const FcScene* scene, double h, const double* node, int count) {
    FcNodeCoefficients at;
    fc_node_coefficients(scene, 2e-6, h, node, count, &at);
    for (int i = 0; i < count; i++) {
        const FcCoefficients exact = fc_scene_coefficients(scene, 2e-6 + (0.5 + node[i]) * h);
        CHECK_WITHIN(at.V[i], exact.V, 3e-15 * 1.74);
        CHECK_NEAR(at.sigma[i], exact.sigma, 2e-14);
        CHECK_NEAR(at.limit[i], exact.limit, 2e-14);
    }
}

// Every model of the contact, limit and law, over short and long panels, within what the series and doublings lose.
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
        const FcScene scene =
            scene_of(&contact, &friction, ULTRASOUND, (FcLinearInput){0.3, 1e3}, (FcLinearInput){14e-6, 1e-3},
                     (FcLinearInput){58e9, k % 7 == 0 ? 1e13 : 0.0});
        nodes_are_of_scene(&scene, h, SYMMETRIC, 12);
        nodes_are_of_scene(&scene, h, SYMMETRIC + 2, 8);
        nodes_are_of_scene(&scene, h, SYMMETRIC + 3, 6);
        nodes_are_of_scene(&scene, h, SYMMETRIC + 4, 4);
        nodes_are_of_scene(&scene, h, OTHERS, 10);
    }
}

typedef void (*PanelOf)(const FcScene* scene, int count, double h, const FcTrajectories* from,
                        FcPanel* panel);

static void gauss(const FcScene* scene, int count, double h, const FcTrajectories* from, FcPanel* panel) {
    fc_gauss_panel(scene, 0.0, h, count, from, panel);
}

static void radau(const FcScene* scene, int count, double h, const FcTrajectories* from, FcPanel* panel) {
    CHECK(count == FC_RADAU_STAGES);
    fc_radau_panel(scene, 0.0, h, fc_sign(scene->drive.V.value), from, panel);
}

// Constant coefficients: every coefficient of the map is that of the closed form, within the error of the rule.
static void check_constant(PanelOf panel_of, int count, double z, double V, double within) {
    const FcVibration none = {.f = 20e3};
    FcContactParameters contact = soft_contact();
    contact.model = FC_CONTACT_CONSTANT;
    const FcScene scene = scene_of(&contact, &DAHL, none, (FcLinearInput){V, 0.0},
                                   (FcLinearInput){14e-6, 0.0}, (FcLinearInput){58e9, 0.0});
    const double h = z * 55.0 / (1e6 * fabs(V));
    const FcTrajectories from = {.delta_0 = 1e-5, .speed = fabs(V)};
    FcPanel panel;
    panel_of(&scene, count, h, &from, &panel);
    const FcCoefficients at = fc_scene_coefficients(&scene, 0.0);
    const FcMap exact = fc_map_of_constant_scene(&at, h);
    CHECK_NEAR(panel.z, z, 1e-14);
    CHECK_NEAR(panel.map.relaxation, exact.relaxation, within);
    CHECK_NEAR(panel.map.offset, exact.offset, within);
    CHECK_NEAR(panel.map.impulse_slope, exact.impulse_slope, within);
    CHECK_NEAR(panel.map.impulse_offset, exact.impulse_offset, within);
    CHECK_NEAR(panel.map.work_slope, exact.work_slope, within);
    CHECK_NEAR(panel.map.work_offset, exact.work_offset, within);
    CHECK_NEAR(panel.map.drag_slope, exact.drag_slope, within);
    CHECK_NEAR(panel.map.drag_offset, exact.drag_offset, within);
    CHECK_NEAR(panel.map.heat_square, exact.heat_square, within);
    CHECK_NEAR(panel.map.heat_slope, exact.heat_slope, within);
    CHECK_NEAR(panel.map.heat_offset, exact.heat_offset, within);
}

static void maps_are_the_closed_form(void) {
    for (double V = -0.2; V < 0.3; V += 0.4) {
        check_constant(gauss, 4, 0.01, V, 1e-13);
        check_constant(gauss, 6, 0.3, V, 1e-13);
        check_constant(gauss, 8, 1.0, V, 1e-13);
        check_constant(gauss, 12, 3.0, V, 1e-13);
        check_constant(radau, 9, 1.0, V, 1e-13);
    }
}

// A panel over z of relaxation after a reversal, against itself in 16 pieces. The estimates are there to be
// held against a tenth of what an error may be, so they may be 10 times too small.
static void check_errors(PanelOf panel_of, int count, double length, double stiffness) {
    const FcVibration none = {.f = 20e3};
    FcContactParameters contact = soft_contact();
    contact.model = FC_CONTACT_CONSTANT;
    contact.sigma = stiffness;
    const FcScene scene = scene_of(&contact, &DAHL, none, (FcLinearInput){1e-9, 1.8e5},
                                   (FcLinearInput){14e-6, 0.0}, (FcLinearInput){58e9, 0.0});
    const double h = length * sqrt(2.0 * 55.0 / (stiffness * 1.8e5));
    FcTrajectories from = {.delta_0 = -55.0 / stiffness, .speed = 1.8e5 * h};
    FcPanel panel;
    panel_of(&scene, count, h, &from, &panel);
    FcMap exact = fc_map_identity();
    FcTrajectories there = from;
    for (int i = 0; i < 16; i++) {
        FcPanel piece;
        fc_radau_panel(&scene, h * i / 16.0, h / 16.0, 1.0, &there, &piece);
        fc_map_append(&exact, &piece.map);
        there.delta_0 = (1.0 - exact.relaxation) * from.delta_0 + exact.offset;
    }
    const double error =
        fabs((1.0 - panel.map.relaxation) * from.delta_0 + panel.map.offset - there.delta_0) * stiffness;
    const double impulse_error = fabs((panel.map.impulse_slope - exact.impulse_slope) * from.delta_0 +
                                      panel.map.impulse_offset - exact.impulse_offset) /
                                 h;
    const double rounding = 1e-13 * 55.0;
    CHECK(error <= 10.0 * panel.end_error + rounding);
    CHECK(impulse_error <= 10.0 * panel.mean_error + rounding);

    // Of a map for any start, what a start a thousand times as far away would be off by, in the mean force and in the
    // heat over the path.
    const double far = 1e3 * 55.0 / stiffness;
    const FcTrajectories any = {.delta_0 = from.delta_0, .scale = far, .speed = from.speed};
    panel_of(&scene, count, h, &any, &panel);
    const double mean_error = far * fabs(panel.map.impulse_slope - exact.impulse_slope) / h;
    const double heat_error = far * far * fabs(panel.map.heat_square - exact.heat_square) / (h * from.speed);
    CHECK(mean_error <= 10.0 * panel.mean_error + 1e3 * rounding);
    const bool is_refused = panel.mean_error > 0.01 * far * stiffness; // far too long at any tolerance
    CHECK(is_refused || heat_error <= 10.0 * panel.mean_error + 1e6 * rounding);
}

static void estimates_bound_the_errors(void) {
    for (double length = 0.1; length < 12.0; length *= 1.25) { // layers
        for (double stiffness = 1e5; stiffness < 1e13; stiffness *= 100.0) {
            check_errors(radau, 9, length, stiffness);
            if (length < 2.5) {
                check_errors(gauss, 4, length, stiffness);
                check_errors(gauss, 6, length, stiffness);
                check_errors(gauss, 8, length, stiffness);
                check_errors(gauss, 12, length, stiffness);
            }
        }
    }
}

int main(void) {
    nodes_are_the_scene();
    maps_are_the_closed_form();
    estimates_bound_the_errors();
    return check_result();
}
