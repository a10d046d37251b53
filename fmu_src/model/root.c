#include "model/root.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>

// Evaluations of one root. By hand: halving alone takes some 60 to rounding; a root that takes more is returned as it is.
enum { MOST_ROOT_STEPS = 200 };

// To the nearer root of the parabola; Newton's step where it has none.
static double step_to_root(FcRootFunction at) {
    const double discriminant = at.rate * at.rate - 2.0 * at.value * at.curvature;
    const double slope = discriminant > 0.0 ? copysign(sqrt(discriminant), at.rate) : at.rate;
    return -2.0 * at.value / (at.rate + slope);
}

// The parabola at a is good up to this part of the bracket. By hand: costs evaluations, not accuracy.
static const double PARABOLA_REACH = 0.25;

// From a to the root of the parabola there, if it is near, else to that of the cubic t(f) through both ends, if the slopes
// agree with the change.
static double first_step(double duration, FcRootFunction at_a, FcRootFunction at_b) {
    const double change = at_b.value - at_a.value;
    const double nearer = fabs(step_to_root(at_a));
    if (nearer < PARABOLA_REACH * duration || !(at_a.rate * change > 0.0 && at_b.rate * change > 0.0)) {
        return nearer;
    }
    const double s = -at_a.value / change;
    const double part = s * (1.0 - s);
    return duration * s * s * (3.0 - 2.0 * s) + change * part * ((1.0 - s) / at_a.rate - s / at_b.rate);
}

double fc_root(FcRootEvaluation f, void* context, double a, FcRootFunction at_a, double b,
               FcRootFunction at_b, double last_step, double least_area, double* evaluations) {
    const double start = a;
    const bool starts_negative = at_a.value < 0.0;
    FcRootFunction at = at_a;
    double t = a;
    double step = first_step(b - a, at_a, at_b);
    for (int i = 0; i < MOST_ROOT_STEPS && at.value != 0.0; i++) {
        double next = t + step;
        double longest = 0.5 * fabs(step);
        const bool bisects = !(next >= a && next <= b);
        if (bisects) {
            next = a + 0.5 * (b - a);
            longest = b - a;
        }
        step = next - t;
        t = next;
        // A small step to the parabola's root is a smaller one from f's, a small bracket's middle may be as far from it.
        const bool is_near =
            i > 0 && !bisects && fabs(step) <= last_step * (t - start) && fabs(step * at.value) <= least_area;
        if (is_near) {
            return t;
        }
        at = f(context, t);
        *evaluations += 1.0;
        if (t == a || t == b) {
            return t;
        }
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

double fc_root_between(double (*f)(void* context, double t), void* context, double a, double at_a, double b,
                       double at_b, double* evaluations) {
    const double rounding = DBL_EPSILON * (b - a);
    int kept = 0; // end that was kept the last time
    for (int i = 0; i < MOST_ROOT_STEPS && at_b != 0.0 && b - a > rounding; i++) {
        double t = a + (b - a) * (at_a / (at_a - at_b));
        if (i % 8 == 7 || !(t > a && t < b)) {
            t = 0.5 * (a + b);
        }
        if (!(t > a && t < b)) {
            break;
        }
        const double at_t = f(context, t);
        *evaluations += 1.0;
        if ((at_t < 0.0) == (at_a < 0.0)) {
            a = t;
            at_a = at_t;
            at_b *= kept == 1 ? 0.5 : 1.0;
            kept = 1;
        } else {
            b = t;
            at_b = at_t;
            at_a *= kept == -1 ? 0.5 : 1.0;
            kept = -1;
        }
    }
    return b;
}
