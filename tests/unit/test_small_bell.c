// What a bell of the Stribeck curve does to a bristle that relaxes little in it, against brute force: a hundred thousand short
// steps of constant coefficients, each solved exactly, with the curve and without.
#include "solver/small_bell.h"

#include "check.h"
#include "model/constants.h"
#include "random.h"
#include "solver/mesh.h"
#include "solver/stribeck_bell.h"
#include "table_1.h"

static const double F_C = 55.0;  // N
static const double F = 20e3;    // Hz
static const double REACH = 6.2; // where the curve has fallen to 2e-17
enum { SCENES = 60, STEPS = 100000 };

static FcContactParameters contact;
static FcFriction friction;

// One that relaxes in a bell by about that much.
static FcScene random_scene(double relaxes) {
    contact = table_1(FC_CONTACT_ASPERITIES, FC_CONTACT_SEPARATION);
    const double V_1 = random_log(0.1, 5.0);
    friction = (FcFriction){.model = FC_LUGRE,
                            .limit = FC_LIMIT_CONSTANT,
                            .staticRatio = 1.0 + random_log(0.001, 4.9),
                            .V_S = V_1 * random_log(1e-4, 0.01)};
    const double E = 58.556936170e9;
    const double sigma = relaxes * F_C * 2.0 * 3.14 * F * V_1 / (friction.V_S * friction.V_S);
    contact.stiffnessScale = sigma / 5.743065402e12;
    const FcContactAtModulus at_E = fc_contact_at_modulus(&contact, E);
    const FcVibration vibration = {
        .f = F, .V_1 = V_1, .a_d = random_log(1e-8, 1.5e-6), .phase_d = 6.28 * random_01()};
    const FcDrive drive = fc_drive_make((FcLinearInput){(2.0 * random_01() - 1.0) * 0.8 * V_1, 0.0},
                                        (FcLinearInput){14e-6, 0.0}, (FcLinearInput){E, 0.0},
                                        (FcLinearInput){0.0, 0.0}, vibration, random_01() / F, 0.0);
    return fc_scene_make(&contact, &at_E, &friction, F_C, &drive);
}

static FcMap brute_force(const FcScene* scene, double start, double end) {
    FcMap sum = fc_map_identity();
    const double step = (end - start) / STEPS;
    for (int i = 0; i < STEPS; i++) {
        const FcCoefficients at = fc_scene_coefficients(scene, start + (i + 0.5) * step);
        const FcMap map = fc_map_of_constant_scene(&at, step);
        fc_map_append(&sum, &map);
    }
    return sum;
}

// Largest sigma / g [1/m] in a bell.
static double largest_per_path(const FcSceneBeyondBells* beyond, double start, double end) {
    double largest = 0.0;
    for (int i = 0; i <= 20; i++) {
        largest = fmax(largest, fc_scene_stiffness(&beyond->scene, start + 0.05 * i * (end - start)) / F_C);
    }
    return largest;
}

// What the bell does is told by its map next to the reversal and the scene without the curve.
static void check_bell(const FcScene* scene, double reversal, double side) {
    FcSceneBeyondBells beyond;
    fc_scene_beyond_bells(scene, &beyond);
    const FcVelocity at = fc_drive_velocity(&scene->drive, reversal);
    const double sign = side * fc_sign(at.rate);
    const double fastest = fc_mesh_smoothness(scene, 1.0 / F).rate;
    const FcSmallBellPlace place = fc_small_bell_place(scene, &at, side, fastest);
    const double far = reversal + side * 1.4 * REACH * place.tau;
    const double start = side > 0.0 ? reversal : far;
    const double end = side > 0.0 ? far : reversal;
    const FcMap with = brute_force(scene, start, end);
    const FcMap without = brute_force(&beyond.scene, start, end);
    const FcBellShape shape = fc_bell_shape(friction.staticRatio);
    const FcMap bell = fc_small_bell(scene, &shape, &place, reversal, side, sign);
    FcMap got = side > 0.0 ? bell : without;
    fc_map_append(&got, side > 0.0 ? &without : &bell);

    const double per_path = largest_per_path(&beyond, start, end);
    const double J = -bell.relaxation;
    CHECK(J > 0.0 && J < 1.1 * log(friction.staticRatio) * 0.5 * per_path * friction.V_S * place.tau);
    const double FORCES[] = {0.0, 0.3, 3.0}; // over the limit
    for (int i = 0; i < 3; i++) {
        const double force = FORCES[i];
        const FcSmallBellError error =
            fc_small_bell_error(&place, &shape, friction.V_S, per_path, force, 0.0);
        const double damped = fc_small_bell_error(&place, &shape, friction.V_S, per_path, force, 1.0).work;
        const double rounding = 1e-13 * (force + per_path * fabs(without.offset));
        for (double s = -1.0; s < 2.0; s += 2.0) {
            // the deflection in the bell, at the reversal
            const double delta = s * force / per_path;
            const double delta_0 = side > 0.0 ? delta : (delta - without.offset) / (1.0 - without.relaxation);
            FcStepResult a = {.delta = delta_0};
            FcStepResult b = {.delta = delta_0};
            fc_map_apply(&with, &a);
            fc_map_apply(&got, &b);
            CHECK(per_path * fabs(a.delta - b.delta) <= error.lasts + rounding);
            CHECK(fabs(a.impulse - b.impulse) <= F_C * (error.impulse + rounding * place.tau));
            const double path = friction.V_S * place.tau; // m
            CHECK(fabs(a.work - b.work) <= F_C * (error.work + rounding * path));
            CHECK(fabs(a.heat - b.heat) <= F_C * (error.work + rounding * path));
            CHECK(fabs(a.drag - b.drag) * F_C / friction.V_S <= F_C * (damped + rounding * path));
        }
    }
}

// A shape beyond the fits, and what u under u f has where the curve is low: of e^-u^2.
static void shapes(void) {
    CHECK(fc_bell_shape(5.9).is_known && !fc_bell_shape(6.1).is_known);
    const FcBellShape low = fc_bell_shape(1.0 + 1e-9);
    CHECK_NEAR(low.log_ratio, 1e-9, 1e-6);
    CHECK_NEAR(low.mean, 0.5 * sqrt(FC_PI), 1e-5);
    CHECK_NEAR(low.deviation, sqrt(1.0 - 0.25 * FC_PI), 1e-4);
}

int main(void) {
    shapes();
    for (int i = 0; i < SCENES; i++) {
        const FcScene scene = random_scene(random_log(1e-7, 1e-2));
        const double reversal = fc_drive_next_event(&scene.drive, 0.0, 1.0).time;
        check_bell(&scene, reversal, 1.0);
        check_bell(&scene, reversal, -1.0);
    }
    return check_result();
}
