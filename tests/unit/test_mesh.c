// What is left at the interval's end of an error in the force: never told to be less than it is.
#include "solver/mesh.h"

#include <math.h>

#include "check.h"
#include "random.h"
#include "solver/section.h"
#include "table_1.h"

static const double OMEGA = 6.283185307179586 * 20e3;
static const double PERIOD = 5e-5; // s
static const double F_C = 55.0;    // N
static const double V_1 = 1.44;    // m/s

static double relaxes_between(const FcScene* scene, double start, double end) {
    enum { PARTS = 400 };
    double sum = 0.0;
    for (int i = 0; i < PARTS; i++) { // middles
        const FcCoefficients at = fc_scene_coefficients(scene, start + (i + 0.5) * (end - start) / PARTS);
        sum += fc_relaxation_rate(&at) * (end - start) / PARTS;
    }
    return sum;
}

// Stretches between two reversals, of which the second ends the interval; separations that let sigma swing up to 30 times.
static void fades_at_least_as_told(void) {
    int looked_at = 0;
    int sharper = 0;
    for (int k = 0; k < 4000; k++) {
        const bool mindlin = random_01() < 0.3;
        FcContactParameters contact =
            table_1(mindlin ? FC_CONTACT_MINDLIN : FC_CONTACT_ASPERITIES, FC_CONTACT_SEPARATION);
        contact.stiffnessScale = random_log(1.0, 100.0) * F_C * 0.5 * OMEGA / V_1 / 5.743065402e12;
        const FcFriction friction = {.model = FC_DAHL,
                                     .limit = random_01() < 0.7 ? FC_LIMIT_CONSTANT : FC_LIMIT_LOAD,
                                     .mu = 0.176,
                                     .staticRatio = 1.0,
                                     .V_S = 1e-3};
        const FcContactAtModulus at_E = fc_contact_at_modulus(&contact, 58e9);
        const FcVibration vibration = {
            .f = 1.0 / PERIOD, .V_1 = V_1, .a_d = random_log(0.02e-6, 1.4e-6), .phase_d = 6.28 * random_01()};
        const FcDrive drive =
            fc_drive_make((FcLinearInput){1.2 * V_1 * (random_01() - 0.5), 0.0}, (FcLinearInput){14e-6, 0.0},
                          (FcLinearInput){58e9, 0.0}, (FcLinearInput){0.0, 0.0}, vibration, 0.0, 0.0);
        const FcScene scene = fc_scene_make(&contact, &at_E, &friction, F_C, &drive);
        const double start = fc_drive_next_event(&drive, 0.0, 2.0 * PERIOD).time;
        const double end = fc_drive_next_event(&drive, start, 2.0 * PERIOD).time;
        const double displacement = fc_drive_displacement(&drive, start, end);
        const double tolerance = random_log(1e-12, 1e-2);
        const FcSolverOptions options = {.tolerance = tolerance, .force = fc_scene_mean_limit(&scene, 0.0)};
        const FcInterval interval = fc_interval_make(&scene, &scene, end, &options);
        const FcCoefficients here = fc_scene_coefficients(&scene, start);
        FcStretch stretch = {.interval = &interval,
                             .start = start,
                             .end = end,
                             .event = end,
                             .reversal = true,
                             .displacement = displacement,
                             .per_path = here.sigma / here.limit,
                             .peaks = fc_no_peaks(start, end)};
        FcSection sections[FC_MOST_SECTIONS];
        double evaluations = 0.0;
        CHECK(fc_sections(&stretch, sections, &evaluations) == 1);
        if (!sections[0].is_measured) {
            continue;
        }
        looked_at++;
        const double t = start + (end - start) * random_01();
        const double gone = relaxes_between(&scene, start, t);
        const double left = exp(-relaxes_between(&scene, t, end));
        const FcPlace at = {.t = t, .path = fabs(fc_drive_displacement(&drive, t, end)), .gone = gone};
        const double by_path = fc_left_at_end(&stretch, &at, t, gone);
        stretch.relaxes = sections[0].z.whole;
        const double told = fc_left_at_end(&stretch, &at, t, gone);
        CHECK(told >= left * (1.0 - 1e-6) || (told == 0.0 && left <= tolerance * tolerance));
        CHECK(told <= by_path);
        sharper += told < 0.5 * by_path;
    }
    CHECK(looked_at > 2000 && sharper > 100); // so the test is about something
}

int main(void) {
    fades_at_least_as_told();
    return check_result();
}
