// The contact against numbers computed apart from this code, and its gradients against differences.
#include "model/contact.h"

#include "check.h"

static const double E = 58.556936170e9; // Pa, of the materials of Table 1

static FcContactParameters table_1(void) {
    return (FcContactParameters){.model = FC_CONTACT_ASPERITIES,
                                 .sigma = 2.5e6,
                                 .stiffnessScale = 1.0,
                                 .R_q = 6e-6,
                                 .R = 1.7e-6,
                                 .eta = 47e9,
                                 .A_n = 1e-4,
                                 .nu = 0.33,
                                 .Y = 410e6,
                                 .c = 17.0,
                                 .lambda = 3.0};
}

static const double TEN_DIGITS = 6e-10; // what is left of a number printed with ten digits

// Eq. 20 and Eq. 3 at the parameters of Table 1.
static void values_of_table_1(void) {
    const struct {
        double d, A_r;
    } areas[] = {
        {12.9e-6, 8.991595e-7}, {14e-6, 5.187698908e-7}, {15.1e-6, 2.993042e-7}, {17e-6, 1.157532088e-7}};
    const FcContactParameters p = table_1();
    const FcContactAtModulus at_E = fc_contact_at_modulus(&p, E);
    for (size_t i = 0; i < sizeof areas / sizeof *areas; i++) {
        const double digits = i % 2 ? TEN_DIGITS : 6e-8; // printed with ten digits, or seven
        CHECK_NEAR(fc_contact_response(&at_E, areas[i].d).A_r, areas[i].A_r, digits);
    }
    CHECK_NEAR(fc_contact_stiffness(&at_E, 14e-6), 5.743065402e12, TEN_DIGITS);
    CHECK_NEAR(fc_contact_stiffness(&at_E, 17e-6), 1.596973315e11, TEN_DIGITS);
    CHECK_NEAR(at_E.decay, 0.5e6, 1e-15);
}

static void stiffness_scales(void) {
    FcContactParameters p = table_1();
    p.stiffnessScale = 4.41686e-7;
    const FcContactAtModulus at_E = fc_contact_at_modulus(&p, E);
    CHECK_NEAR(fc_contact_stiffness(&at_E, 14e-6), 4.41686e-7 * 5.743065402e12, TEN_DIGITS);
    CHECK_NEAR(fc_contact_response(&at_E, 14e-6).A_r, 5.187698908e-7, TEN_DIGITS);
    CHECK(fc_contact_response(&at_E, 14e-6).sigma == fc_contact_stiffness(&at_E, 14e-6));
}

static void constant_stiffness_ignores_the_surfaces(void) {
    FcContactParameters p = table_1();
    p.model = FC_CONTACT_CONSTANT;
    const FcContactAtModulus at_E = fc_contact_at_modulus(&p, E);
    CHECK(fc_contact_stiffness(&at_E, 3e-6) == 2.5e6 && fc_contact_response(&at_E, 3e-6).sigma == 2.5e6);
    CHECK_NEAR(fc_contact_response(&at_E, 14e-6).A_r, 5.187698908e-7, TEN_DIGITS);
    const FcContactGradient slope = fc_contact_stiffness_gradient(&p, 14e-6, E);
    CHECK(slope.by_d == 0.0 && slope.by_E == 0.0);
}

typedef double (*Quantity)(const FcContactParameters* p, double d, double modulus);

static double stiffness(const FcContactParameters* p, double d, double modulus) {
    const FcContactAtModulus at_E = fc_contact_at_modulus(p, modulus);
    return fc_contact_stiffness(&at_E, d);
}

static double area(const FcContactParameters* p, double d, double modulus) {
    const FcContactAtModulus at_E = fc_contact_at_modulus(p, modulus);
    return fc_contact_response(&at_E, d).A_r;
}

// Five-point differences with a step k of the variable: off by (k n)^4 / 30 for a power n, which is 30 at most, and by
// rounding, 1e-16 / k.
static void check_gradient(Quantity q, FcContactGradient slope, const FcContactParameters* p, double d,
                           double modulus) {
    const double k = 3e-4;
    const double by_d = (8.0 * (q(p, d * (1 + k), modulus) - q(p, d * (1 - k), modulus)) -
                         (q(p, d * (1 + 2 * k), modulus) - q(p, d * (1 - 2 * k), modulus))) /
                        (12.0 * k * d);
    const double by_E = (8.0 * (q(p, d, modulus * (1 + k)) - q(p, d, modulus * (1 - k))) -
                         (q(p, d, modulus * (1 + 2 * k)) - q(p, d, modulus * (1 - 2 * k)))) /
                        (12.0 * k * modulus);
    CHECK_NEAR(slope.by_d, by_d, 1e-9);
    CHECK_WITHIN(slope.by_E, by_E, 1e-9 * fabs(by_E) + 1e-11 * q(p, d, modulus) / modulus);
}

// Eq. 13 makes the area depend on E where asperities stay elastic: E of some GPa.
static void gradients_are_derivatives(void) {
    FcContactParameters p = table_1();
    for (double d = 1e-6; d < 30e-6; d *= 1.7) {
        for (double modulus = 3e8; modulus < 3e11; modulus *= 7.0) {
            check_gradient(stiffness, fc_contact_stiffness_gradient(&p, d, modulus), &p, d, modulus);
            check_gradient(area, fc_contact_area_gradient(&p, d, modulus), &p, d, modulus);
        }
    }
    // d ln sigma / dd = -(2 lambda / R_q + 3 / d) at 14 um
    const FcContactGradient at_14 = fc_contact_stiffness_gradient(&p, 14e-6, E);
    CHECK_NEAR(at_14.by_d / stiffness(&p, 14e-6, E), -1.2142857142857142e6, 1e-14);
}

// Numbers too small to be told from 0 give slopes of 0, not NaN.
static void far_apart_nothing_touches(void) {
    const FcContactParameters p = table_1();
    const FcContactGradient stiffness_slope = fc_contact_stiffness_gradient(&p, 1.0, E);
    const FcContactGradient area_slope = fc_contact_area_gradient(&p, 1.0, E);
    CHECK(stiffness_slope.by_d == 0.0 && stiffness_slope.by_E == 0.0);
    CHECK(area_slope.by_d == 0.0 && area_slope.by_E == 0.0);
    const FcContactGradient soft = fc_contact_area_gradient(&p, 14e-6, 1e3); // e^-x = 0
    CHECK(soft.by_E == 0.0 && soft.by_d < 0.0);
}

int main(void) {
    values_of_table_1();
    stiffness_scales();
    constant_stiffness_ignores_the_surfaces();
    gradients_are_derivatives();
    far_apart_nothing_touches();
    return check_result();
}
