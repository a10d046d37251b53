#include "model/special.h"

#include <assert.h>
#include <math.h>

static const double SQRT_PI = 1.77245385090551602730; // sqrt(pi), to all digits of a double

// x^a e^-x sum x^k / (a (a+1) ... (a+k)): all terms positive, so nothing cancels.
static double lower_gamma_series(double a, double x) {
    assert(!(x < 0.0));
    double term = 1.0 / a;
    double sum = term;
    for (double k = 1.0; term > 1e-17 * sum; k += 1.0) {
        term *= x / (a + k);
        sum += term;
    }
    return pow(x, a) * exp(-x) * sum;
}

double fc_upper_gamma_3_2(double x) { return sqrt(x) * exp(-x) + 0.5 * SQRT_PI * erfc(sqrt(x)); }

double fc_lower_gamma_3_2(double x) {
    return x < 2.0 ? lower_gamma_series(1.5, x) : 0.5 * SQRT_PI - fc_upper_gamma_3_2(x);
}

double fc_lower_gamma_5_2(double x) {
    return x < 2.0 ? lower_gamma_series(2.5, x) : 1.5 * fc_lower_gamma_3_2(x) - x * sqrt(x) * exp(-x);
}

double fc_log_bessel_I0(double x) {
    assert(!(x < 0.0));
    if (x < 20.0) {
        const double y = 0.25 * x * x;
        double term = 1.0;
        double sum = 0.0; // I_0 - 1
        for (double k = 1.0; term > 1e-17 * sum; k += 1.0) {
            term *= y / (k * k);
            sum += term;
        }
        return log1p(sum);
    }
    // e^x / sqrt(2 pi x) times the asymptotic series, whose least term is below e^(-2 x).
    double term = 1.0;
    double sum = 1.0;
    for (double k = 1.0; term > 1e-17; k += 1.0) {
        term *= (2.0 * k - 1.0) * (2.0 * k - 1.0) / (8.0 * k * x);
        sum += term;
    }
    return x + log(sum / (SQRT_PI * sqrt(2.0 * x)));
}

// Gauss's continued fraction x / (2 + x x / (4 + x x / (6 + ...))), from the k-th level on, whose effect is below
// e^(-k^2 / x).
double fc_bessel_ratio(double x) {
    assert(!(x < 0.0));
    if (x > 1e8) {
        return 1.0 - 0.5 / x;
    }
    double ratio = 0.0;
    for (double k = floor(20.0 + 8.0 * sqrt(x)); k >= 1.0; k -= 1.0) {
        ratio = x / (2.0 * k + x * ratio);
    }
    assert(!(ratio < 0.0 || ratio > 1.0));
    return ratio;
}
