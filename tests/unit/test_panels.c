// Panels along a line of constant stiffness: their order, and what they say of their errors against those errors.
#include <float.h>

#include "check.h"
#include "solver/integrate/dense_output.h"
#include "solver/integrate/tuning.h"
#include "solver/panel/panel.h"
#include "table_1.h"

static const double F_C = 55.0; // N
static const FcFriction DAHL = {.model = FC_DAHL, .limit = FC_LIMIT_CONSTANT, .staticRatio = 1.0, .V_S = 1.0};

typedef struct {
    FcContactParameters contact;
    FcScene scene;
    FcPlane plane;
} Line;

static void make(Line* line, double stiffness, FcLinearInput V) {
    const FcLinearInput d = {14e-6, 0.0}, E = {58e9, 0.0}, load = {200.0, 0.0};
    line->contact = table_1(FC_CONTACT_CONSTANT, FC_CONTACT_SEPARATION);
    line->contact.sigma = stiffness;
    line->scene.drive = (FcDrive){.V = V, .d = d, .E = E, .load = load, .vibration = {.f = 20e3}};
    const FcContactAtModulus at_E = fc_contact_at_modulus(&line->contact, E.value);
    fc_scene_make(&line->scene, &line->contact, &at_E, &DAHL, F_C);
    fc_plane_make(&line->plane, &line->scene);
    line->plane.is_one_dimensional = true;
}

// From a time to another one, in the variable t = length sinh(u), or t = u.
static FcPanel panel_over(const Line* line, double start, double end, double length,
                          const FcPanelStart* from) {
    const FcTimeMap in = {0.0, length};
    const FcPart part = {.start = start, .end = end, .in = in, .side = 1, .strip_ratio = 1.0};
    const double u = fc_time_map_u(&in, start);
    FcNodes nodes;
    FcPanel panel;
    fc_nodes_make(&line->plane, &part, u, fc_time_map_u(&in, end) - u, &nodes);
    fc_relaxation_panel(&line->plane, &nodes, from, &panel);
    return panel;
}

// What is left of a start after a panel of constant coefficients over z.
static double left_after(double z) {
    const double V = 0.2, sigma = 1e6;
    const FcPanelStart from = {.delta = {1e-5, 0.0}, .speed = V, .push = V, .for_any = true};
    Line line;
    make(&line, sigma, (FcLinearInput){V, 0.0});
    return 1.0 - panel_over(&line, 0.0, z * F_C / (sigma * V), INFINITY, &from).along.relaxation;
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
    const double V_rate = 1.8e5, layer = sqrt(2.0 * F_C / (stiffness * V_rate)), h = length * layer;
    Line line;
    make(&line, stiffness, (FcLinearInput){0.0, V_rate});
    FcPanelStart from = {.delta = {-F_C / stiffness, 0.0}, .speed = V_rate * h, .push = V_rate * h};
    const FcPanel panel = panel_over(&line, 0.0, h, layer, &from);
    FcStepResult exact = {.delta = from.delta.x};
    from.for_any = true;
    for (int i = 0; i < 16; i++) {
        from.delta.x = exact.delta;
        const FcPanel fine = panel_over(&line, h * i / 16.0, h * (i + 1) / 16.0, layer, &from);
        fc_map_apply(&fine.along, &exact);
    }
    const double rounding = 1e-13 * F_C, way = h * from.speed;
    const double of_mean = FC_SAFETY / FC_SHARE_OF_MEAN * panel.mean_error + rounding;
    CHECK_WITHIN(panel.along.offset * stiffness, exact.delta * stiffness,
                 FC_SAFETY / FC_SHARE_OF_END * panel.end_error + rounding);
    CHECK_WITHIN(panel.along.impulse_offset / h, exact.impulse / h, of_mean);
    CHECK_WITHIN(panel.along.work_offset / way, exact.work / way, of_mean);
    CHECK_WITHIN(panel.along.heat_offset / way, exact.heat / way, of_mean);
}

static void estimates_bound_the_errors(void) {
    for (double length = 0.1; length < 12.0; length *= 1.25) { // layers
        for (double stiffness = 1e5; stiffness < 1e13; stiffness *= 100.0) {
            check_errors(length, stiffness);
        }
    }
}

// Against the C library, which rounds by less than one digit of two.
static void exponentials_have_their_digits(void) {
    for (double x = -1e-12; x > -700.0; x *= 1.01) {
        CHECK_NEAR(fc_exp_less(x, 0.0), exp(x), 4.0 * DBL_EPSILON);
        CHECK_NEAR(fc_exp_less(x, 1.0), expm1(x), 4.0 * DBL_EPSILON);
    }
    CHECK(fc_exp_less(0.0, 0.0) == 1.0 && fc_exp_less(0.0, 1.0) == 0.0 && isnan(fc_exp_less(NAN, 0.0)));
}

// The same bits with AVX and without, for a bristle that relaxes in layers, behind a reversal and in a Stribeck curve.
static void processors_compute_the_same_numbers(void) {
    static FcNodes nodes[2];
    static FcPanel panels[2];
    static const FcFriction LUGRE = {
        .model = FC_LUGRE, .limit = FC_LIMIT_CONSTANT, .staticRatio = 1.3, .V_S = 0.01};
    Line line;
    make(&line, 1e8, (FcLinearInput){0.0, 2e3});
    line.scene.friction = &LUGRE;
    fc_plane_make(&line.plane, &line.scene);
    line.plane.is_one_dimensional = true;
    const FcPart part = {.end = 1e-5, .in = {0.0, 1e-6}, .side = 1, .strip_ratio = 1.0};
    const FcPanelStart from = {
        .delta = {1e-9, 0.0}, .speed = 0.02, .push = 0.02, .for_any = true, .scale = 1e-8};
    fc_nodes_make(&line.plane, &part, 0.1, 1.3, &nodes[0]);
    fc_relaxation_panel(&line.plane, &nodes[0], &from, &panels[0]);
    FC_FASTEST(fc_nodes_make)(&line.plane, &part, 0.1, 1.3, &nodes[1]);
    FC_FASTEST(fc_relaxation_panel)(&line.plane, &nodes[1], &from, &panels[1]);
    CHECK(memcmp(&nodes[0], &nodes[1], sizeof nodes[0]) == 0);
    CHECK(memcmp(&panels[0], &panels[1], sizeof panels[0]) == 0);
    const double* f = nodes[0].moved;
    CHECK(fc_first_upcrossing(f, f[4]) == FC_FASTEST(fc_first_upcrossing)(f, f[4]));
}

int main(void) {
    processors_compute_the_same_numbers();
    exponentials_have_their_digits();
    panels_are_of_order_17();
    estimates_bound_the_errors();
    return check_result();
}
