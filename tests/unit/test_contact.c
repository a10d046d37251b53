// The contact against numbers computed apart from this code, and its gradients against differences.
#include "model/contact.h"

#include "check.h"
#include "random.h"
#include "table_1.h"

static const double E = 58.556936170e9; // Pa, of the materials of Table 1

typedef double (*Quantity)(const FcContactParameters* p, double d, double modulus);

static double stiffness(const FcContactParameters* p, double d, double modulus) {
    const FcContactAtModulus at_E = fc_contact_at_modulus(p, modulus);
    return fc_contact_stiffness(&at_E, d);
}

static double area(const FcContactParameters* p, double d, double modulus) {
    const FcContactAtModulus at_E = fc_contact_at_modulus(p, modulus);
    return fc_contact_response(&at_E, d).A_r;
}

static double normal_force(const FcContactParameters* p, double d, double modulus) {
    const FcContactAtModulus at_E = fc_contact_at_modulus(p, modulus);
    return fc_contact_response(&at_E, d).F_n;
}

// Five-point differences of the logarithm with a step k of the variable: off by (k n)^4 / 30 for a power n, which is 30
// at most, and by rounding, 1e-16 / k, of the variable's inverse.
static void check_slope(Quantity q, double by_d, double by_E, const FcContactParameters* p, double d,
                        double modulus) {
    const double k = 3e-4;
    const double of_d = (8.0 * log(q(p, d * (1 + k), modulus) / q(p, d * (1 - k), modulus)) -
                         log(q(p, d * (1 + 2 * k), modulus) / q(p, d * (1 - 2 * k), modulus))) /
                        (12.0 * k * d);
    const double of_E = (8.0 * log(q(p, d, modulus * (1 + k)) / q(p, d, modulus * (1 - k))) -
                         log(q(p, d, modulus * (1 + 2 * k)) / q(p, d, modulus * (1 - 2 * k)))) /
                        (12.0 * k * modulus);
    CHECK_NEAR(by_d, of_d, 1e-9);
    CHECK_WITHIN(by_E, of_E, 1e-9 * fabs(of_E) + 1e-11 / modulus);
}

// At a metre e^(-decay d) is at its floor, far below the load at which a contact opens; e^-x underflows at a soft modulus.
static void far_apart_nothing_touches(void) {
    const FcContactParameters p = table_1(FC_CONTACT_ASPERITIES, FC_CONTACT_SEPARATION);
    const FcContactAtModulus at_E = fc_contact_at_modulus(&p, E);
    const FcContactResponse far = fc_contact_response(&at_E, 1.0);
    CHECK(far.sigma > 0.0 && far.sigma < 1e-100 && far.A_r < 1e-100 && far.F_n > 0.0 && far.F_n < 1e-100);
    const FcContactLogSlope by_d = fc_contact_slope_by_d(&at_E, 1.0);
    CHECK(isfinite(by_d.sigma) && isfinite(by_d.A_r) && isfinite(by_d.F_n));
    const FcContactLogSlope soft = fc_contact_slope_by_E(&p, 1e3); // e^-x = 0
    CHECK(soft.A_r == 0.0 && isfinite(soft.F_n) && isfinite(soft.sigma));
}

// Sums over the asperities by quadrature: one that is higher than the separation by w = u R_q / lambda, of which there are
// eta A_n c / lambda e^(-lambda d / R_q) e^-u du, is elastic up to w_c and then plastic (Eq. 9-22).
typedef struct {
    long double area, force, radius;
} Asperity;

static Asperity asperity(const FcContactParameters* p, double modulus, long double w) {
    const long double pi = 3.14159265358979323846L;
    const long double p_m = (1.234L + 1.256L * p->nu) * (1.0L - (long double)p->nu * p->nu) * p->Y;
    const long double strain = pi * p_m / (2.0L * modulus);
    const long double w_c = strain * strain * p->R;
    const long double R = p->R;
    if (w < w_c) {
        return (Asperity){pi * R * w, 4.0L / 3.0L * modulus * sqrtl(R * w) * w, sqrtl(R * w)};
    }
    const long double flattened = R * (2.0L * w - w_c);
    return (Asperity){pi * flattened, pi * flattened * p_m, sqrtl(flattened)};
}

// Adds the integral over u in [a, b] with the weight e^-u: Simpson's rule in sqrt(u - a), which the roots are smooth in.
static void add_heights(const FcContactParameters* p, double modulus, long double a, long double b,
                        Asperity* sum) {
    enum { PARTS = 2000 };
    const long double end = sqrtl(b - a);
    for (int i = 0; i <= PARTS; i++) {
        const long double y = end * i / PARTS;
        const long double weight = (i == 0 || i == PARTS ? 1.0L : i % 2 ? 4.0L : 2.0L) * end / PARTS / 3.0L;
        const long double u = a + y * y;
        // between two neighbours where the law changes the kind is that of the interval's inside
        const long double inside = fminl(fmaxl(u, a + 1e-15L * (b - a)), b - 1e-15L * (b - a));
        const Asperity one = asperity(p, modulus, inside * p->R_q / p->lambda);
        const long double part = weight * 2.0L * y * expl(-u);
        sum->area += part * one.area;
        sum->force += part * one.force;
        sum->radius += part * one.radius;
    }
}

static void sums_over_the_asperities(void) {
    for (int k = 0; k < 60; k++) {
        FcContactParameters p = table_1(k % 2 ? FC_CONTACT_MINDLIN : FC_CONTACT_ASPERITIES, 1);
        p.stiffnessScale = random_log(1e-6, 10.0);
        p.R_q *= random_log(0.5, 2.0);
        p.R *= random_log(0.5, 2.0);
        p.eta *= random_log(0.5, 2.0);
        p.A_n *= random_log(1e-9, 2.0);
        p.nu = 0.45 * random_01();
        p.Y *= random_log(0.5, 2.0);
        p.c *= random_log(0.5, 2.0);
        p.lambda *= random_log(0.7, 1.4);
        const double d = random_log(1e-6, 30e-6);
        const double modulus = random_log(1e8, 1e12);
        const long double p_m = (1.234L + 1.256L * p.nu) * (1.0L - (long double)p.nu * p.nu) * p.Y;
        const long double strain = 3.14159265358979323846L * p_m / (2.0L * modulus);
        const long double x = p.lambda * strain * strain * p.R / p.R_q; // where the law changes
        Asperity sum = {0};
        if (x < 60.0L) {
            add_heights(&p, modulus, 0.0L, x, &sum);
            add_heights(&p, modulus, x, x + 60.0L, &sum);
        } else {
            add_heights(&p, modulus, 0.0L, 60.0L, &sum);
        }
        const long double count = (long double)p.eta * p.A_n * p.c / p.lambda * expl(-p.lambda * d / p.R_q);
        const double A_r = (double)(count * sum.area);
        const double mindlin = (double)(count * sum.radius * 4.0L * modulus * (1.0L - p.nu) / (2.0L - p.nu));
        const double sigma = k % 2 ? mindlin : modulus * A_r * A_r / (d * d * d);
        const FcContactAtModulus at = fc_contact_at_modulus(&p, modulus);
        const FcContactResponse got = fc_contact_response(&at, d);
        CHECK_NEAR(got.A_r, A_r, 1e-9);
        CHECK_NEAR(got.F_n, (double)(count * sum.force), 1e-9);
        CHECK_NEAR(got.sigma, p.stiffnessScale * sigma, 1e-8);
        CHECK_NEAR(fc_contact_stiffness(&at, d), got.sigma, 1e-15);
        const FcContactLogSlope by_d = fc_contact_slope_by_d(&at, d);
        const FcContactLogSlope by_E = fc_contact_slope_by_E(&p, modulus);
        check_slope(stiffness, by_d.sigma, by_E.sigma, &p, d, modulus);
        check_slope(area, by_d.A_r, by_E.A_r, &p, d, modulus);
        check_slope(normal_force, by_d.F_n, by_E.F_n, &p, d, modulus);
    }
}

// Where nothing is elastic, or there is nothing at all, the slopes are numbers still.
static void slopes_at_the_ends(void) {
    FcContactParameters p = table_1(FC_CONTACT_MINDLIN, FC_CONTACT_SEPARATION);
    const FcContactLogSlope rigid =
        fc_contact_slope_by_E(&p, 1e200); // w_c is 0: E counts in Mindlin's factor alone
    CHECK(rigid.F_n == 0.0 && rigid.A_r == 0.0);
    CHECK_NEAR(rigid.sigma, 1e-200, 1e-14);
    p.A_n = 0.0;
    CHECK(fc_contact_slope_by_E(&p, E).F_n == 0.0);
    p.R = 0.0;
    CHECK_NEAR(fc_contact_slope_by_E(&p, E).sigma, 1.0 / E, 1e-15);
}

int main(void) {
    sums_over_the_asperities();
    slopes_at_the_ends();
    far_apart_nothing_touches();
    return check_result();
}
