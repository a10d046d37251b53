// Maps of intervals: composing them, their powers, and the closed form of a constant scene.
#include "solver/affine_map.h"

#include "check.h"

// One that relaxes by a third, with everything else away from 0.
static FcMap constant(double V, double sigma, double limit, double h) {
    const FcCoefficients at = {.V = V, .sigma = sigma, .limit = limit};
    return fc_map_of_constant_scene(&at, h);
}

static const FcMap OTHER = {.relaxation = 0.9,
                            .offset = -1e-9,
                            .impulse_slope = 0.1,
                            .impulse_offset = 2e-5,
                            .work_slope = -4.0,
                            .work_offset = 7e-6};

static FcStepResult from(double delta_0) { return (FcStepResult){.delta = delta_0}; }

static void check_same(const FcStepResult* got, const FcStepResult* expected, double relative) {
    CHECK_NEAR(got->delta, expected->delta, relative);
    CHECK_NEAR(got->impulse, expected->impulse, relative);
    CHECK_NEAR(got->work, expected->work, relative);
}

static void powers_repeat(void) {
    const double counts[] = {0.0, 1.0, 2.0, 3.0, 7.0, 12.0, 40.0};
    for (int i = 0; i < 7; i++) {
        const FcMap power = fc_map_power(&OTHER, counts[i]);
        FcStepResult at_once = from(4e-9);
        FcStepResult in_turn = from(4e-9);
        fc_map_apply(&power, &at_once);
        for (double k = 0.0; k < counts[i]; k += 1.0) {
            fc_map_apply(&OTHER, &in_turn);
        }
        check_same(&at_once, &in_turn, 1e-14);
    }
}

// n maps that relax by r: 1 - (1 - r)^n, with all digits of a small r, and n fixed points' worth of impulse at the end.
static void a_huge_power_keeps_its_digits(void) {
    const double r = 0x1p-60;
    const double n = 0x1p50;
    const FcMap one = {.relaxation = r, .offset = 1e-12 * r, .impulse_slope = 2.0, .impulse_offset = 3e-12};
    const FcMap power = fc_map_power(&one, n);
    const double relaxed = -expm1(-n * r); // r is so small that (1 - r)^n = e^(-n r) to the last digit
    CHECK_NEAR(power.relaxation, relaxed, 4e-15);
    CHECK_NEAR(power.offset, 1e-12 * relaxed, 4e-15);
    CHECK_NEAR(power.impulse_slope, 2.0 * relaxed / r, 4e-15);
    // from 0, delta_k = 1e-12 (1 - (1 - r)^k): sum of 2 delta_k + 3e-12 over k = 0 .. n - 1
    CHECK_NEAR(power.impulse_offset, n * 5e-12 - 2e-12 * relaxed / r, 4e-15);
}

// Constant V, sigma, F_C over h, with a = sigma |V| / F_C, computed with 50 digits (mpmath):
//     relaxation = 1 - e^(-a h)              offset = V relaxation / a
//     impulse_slope = sigma relaxation / a   impulse_offset = sigma V (h - relaxation / a) / a
static void a_constant_scene_is_solved(void) {
    const struct {
        double V, sigma, F_C, h, relaxation, offset, impulse_slope, impulse_offset;
    } cases[] = {
        {0.005, 5.743065402e12, 55.0, 1e-9, 0.40672476917042699, 3.8951084026630217e-12, 4473.9724608746968,
         1.2153807570706766e-8},
        {0.005, 5.743065402e12, 55.0, 1e-3, 1.0, 9.5767671356914142e-12, 11000.0, 0.054999894655561509},
        {-0.3, 2.5e6, 55.0, 1e-7, 0.0013627070340407895, -2.9979554748897368e-8, 0.24982962290747808,
         -3.7482960354820509e-9},
        {0.25, 2e3, 55.0, 1e-6, 9.0908677687202598e-6, 2.4999886363980714e-7, 0.0019999909091184571,
         2.4999924242596416e-10},
        {1e-4, 1e6, 1e4, 1e-5, 9.999999500000018e-8, 9.999999500000018e-10, 9.9999995000000175,
         4.9999998333333386e-9},
        {-2.0, 1e9, 1.0, 5e-10, 0.6321205588285577, -6.321205588285577e-10, 0.31606027941427885,
         -1.8393972058572118e-10},
        {0.5, 1e3, 500.0, 1.0, 0.63212055882855768, 0.31606027941427884, 632.12055882855768,
         183.93972058572116},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const FcMap map = constant(cases[i].V, cases[i].sigma, cases[i].F_C, cases[i].h);
        CHECK_NEAR(map.relaxation, cases[i].relaxation, 1e-15);
        CHECK_NEAR(map.offset, cases[i].offset, 1e-15);
        CHECK_NEAR(map.impulse_slope, cases[i].impulse_slope, 1e-15);
        CHECK_NEAR(map.impulse_offset, cases[i].impulse_offset, 2e-15);
        CHECK_NEAR(map.work_slope, cases[i].V * cases[i].impulse_slope, 1e-15);
        CHECK_NEAR(map.work_offset, cases[i].V * cases[i].impulse_offset, 2e-15);
    }
}

// Without motion, time or stiffness nothing relaxes and nothing is divided by zero.
static void a_scene_at_rest(void) {
    const FcMap at_rest = constant(0.0, 1e9, 55.0, 2.0);
    CHECK(at_rest.relaxation == 0.0 && at_rest.offset == 0.0);
    CHECK(at_rest.impulse_slope == 2e9 && at_rest.impulse_offset == 0.0);
    CHECK(at_rest.work_slope == 0.0 && at_rest.work_offset == 0.0);
    const FcMap no_time = constant(0.3, 1e9, 55.0, 0.0);
    CHECK(no_time.relaxation == 0.0 && no_time.offset == 0.0 && no_time.impulse_slope == 0.0);
    const FcMap slack = constant(0.3, 0.0, 55.0, 2.0);
    CHECK(slack.relaxation == 0.0 && slack.offset == 0.6 && slack.impulse_slope == 0.0);
    CHECK(slack.impulse_offset == 0.0 && slack.work_offset == 0.0);
}

int main(void) {
    powers_repeat();
    a_huge_power_keeps_its_digits();
    a_constant_scene_is_solved();
    a_scene_at_rest();
    return check_result();
}
