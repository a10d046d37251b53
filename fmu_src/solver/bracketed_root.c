#include "solver/bracketed_root.h"

#include <math.h>
#include <stdbool.h>

enum { MOST_STEPS = 200 };
// After a step this small against the way from the bracket's start the error is its square, or less.
static const double LAST_STEP = 1e-7;

// To the nearer root of the parabola; Newton's step where it has none.
static double step_to_root(FcRootFunction at) {
    const double discriminant = at.rate * at.rate - 2.0 * at.value * at.curvature;
    const double slope = discriminant > 0.0 ? copysign(sqrt(discriminant), at.rate) : at.rate;
    return -2.0 * at.value / (at.rate + slope);
}

double fc_bracketed_root(FcRootEvaluation f, const void* context, double a, FcRootFunction at_a, double b,
                         double* evaluations) {
    const double start = a;
    const bool starts_negative = at_a.value < 0.0;
    FcRootFunction at = at_a;
    double t = a;
    double step = fabs(step_to_root(at));
    for (int i = 0; i < MOST_STEPS && at.value != 0.0; i++) {
        double next = t + step;
        double longest = 0.5 * fabs(step);
        if (!(next >= a && next <= b)) {
            next = a + 0.5 * (b - a);
            longest = b - a;
        }
        step = next - t;
        t = next;
        if (fabs(step) <= LAST_STEP * (t - start) || t == a || t == b) {
            return t;
        }
        at = f(context, t);
        *evaluations += 1.0;
        if ((at.value < 0.0) == starts_negative) {
            a = t;
        } else {
            b = t;
        }
        step = step_to_root(at);
        if (!(fabs(step) <= longest)) {
            step = INFINITY; // bisect
        }
    }
    return t;
}
