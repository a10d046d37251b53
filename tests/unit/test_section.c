// Into how many panels a part of a stretch is cut: hardly one of them is refused, and none is taken where Radau panels are cheaper.
#include "solver/section.h"

#include <math.h>

#include "check.h"
#include "random.h"
#include "solver/gauss_panel.h"
#include "solver/judge.h"
#include "table_1.h"

static const double F_C = 55.0;
static const double OMEGA = 6.283185307179586 * 20e3;
static const double HALF_PERIOD = 25e-6;

static FcRelaxation evenly(double z) { return (FcRelaxation){z, 0.5 * z, z}; }

// A panel of z resolves e^z with more than 2 z nodes.
static void panels_resolve_what_relaxes(void) {
    for (int k = 0; k < 2000; k++) {
        const double whole = random_log(1e-3, 60.0);
        const double more = 0.5 + 0.5 * random_01();
        const FcRelaxation z = {whole, more * whole, whole * (1.0 + random_01())};
        const double decades = 2.0 + 10.0 * random_01();
        const FcGaussPlan plan = fc_gauss_plan(3.0 * random_01(), 3.0 * random_01(), &z, decades);
        if (plan.count == 0) {
            continue;
        }
        const double most = plan.count == 1 ? z.whole : plan.count == 2 ? z.half : z.fastest / plan.count;
        CHECK(plan.nodes > 2.0 * most);
    }
}

static void more_decades_take_more_nodes(void) {
    double before = 0.0;
    for (double decades = 2.0; decades <= 12.0; decades += 1.0) {
        const FcRelaxation z = evenly(2.0);
        const FcGaussPlan plan = fc_gauss_plan(1.57, 1.0, &z, decades);
        CHECK(plan.count > 0 && plan.count * plan.nodes >= before);
        before = plan.count * plan.nodes;
    }
    const FcRelaxation little = evenly(1e-4);
    CHECK(fc_gauss_plan(0.1, 0.0, &little, 3.0).count == 1);
    CHECK(fc_gauss_plan(0.1, 0.0, &little, 3.0).nodes == 4);
}

static void stiff_stretches_are_left_to_radau_panels(void) {
    const FcRelaxation much = evenly(90.0);
    const FcRelaxation unknown = evenly(NAN);
    CHECK(fc_gauss_plan(1.57, 1.3, &much, 6.0).count == 0);
    CHECK(fc_gauss_plan(1.57, 1.3, &unknown, 6.0).count == 0);
    CHECK(fc_gauss_plan(1.57, 1.3, &much, 2.0).count == 0);
}

// Between two reversals, V being a sine that starts at one, of a settled bristle: of the panels that were planned, how many
// miss by their own estimates, as stretches/crossing.c judges them.
static void hardly_a_panel_is_refused(void) {
    int taken = 0;
    int refused = 0;
    for (int k = 0; k < 2000; k++) {
        FcContactParameters contact = table_1(FC_CONTACT_ASPERITIES, FC_CONTACT_SEPARATION);
        const double z_about = random_log(0.3, 12.0);
        contact.stiffnessScale = z_about * F_C * OMEGA / 2.0 / 1.44 / 5.743065402e12;
        const FcFriction friction = {
            .model = FC_DAHL, .limit = FC_LIMIT_CONSTANT, .staticRatio = 1.0, .V_S = 1.0};
        const FcContactAtModulus at_E = fc_contact_at_modulus(&contact, 58e9);
        const FcVibration vibration = {
            .f = 20e3, .V_1 = 1.44, .a_d = 1.1e-6 * random_01(), .phase_d = 6.28 * random_01()};
        const FcDrive drive =
            fc_drive_make((FcLinearInput){0.0, 0.0}, (FcLinearInput){14e-6, 0.0}, (FcLinearInput){58e9, 0.0},
                          (FcLinearInput){0.0, 0.0}, vibration, 0.25 / 20e3, 0.0);
        const FcScene scene = fc_scene_make(&contact, &at_E, &friction, F_C, &drive);
        double z[4];
        for (int i = 0; i < 4; i++) {
            const FcCoefficients at = fc_scene_coefficients(&scene, (0.125 + 0.25 * i) * HALF_PERIOD);
            z[i] = fc_relaxation_rate(&at) * HALF_PERIOD;
        }
        const double halves[] = {0.25 * (z[0] + z[1]), 0.25 * (z[2] + z[3])};
        const FcRelaxation relaxes = {halves[0] + halves[1], fmax(halves[0], halves[1]),
                                      fmax(fmax(z[0], z[1]), fmax(z[2], z[3]))};
        const double decades = 2.0 + (k % 5);
        const double mu = at_E.decay * vibration.a_d * OMEGA * HALF_PERIOD;
        const FcGaussPlan plan = fc_gauss_plan(0.5 * OMEGA * HALF_PERIOD, mu, &relaxes, decades);
        const double tolerance = F_C * pow(10.0, -decades);
        double delta = F_C / fc_scene_stiffness(&scene, 0.0); // V goes the other way
        for (int i = 0; i < plan.count; i++) {
            const FcTrajectories from = {.delta_0 = delta, .speed = 1.44};
            const double h = HALF_PERIOD / plan.count;
            FcPanel panel;
            fc_gauss_panel(&scene, i * h, h, plan.nodes, &from, &panel);
            taken++;
            refused +=
                !fc_gauss_panel_is_accurate(&panel, plan.nodes, 1.0 / plan.count, false, 0.0, tolerance);
            delta = (1.0 - panel.map.relaxation) * delta + panel.map.offset;
        }
    }
    CHECK(taken > 2000);
    CHECK(refused < 0.15 * taken);
}

int main(void) {
    panels_resolve_what_relaxes();
    more_decades_take_more_nodes();
    stiff_stretches_are_left_to_radau_panels();
    hardly_a_panel_is_refused();
    return check_result();
}
