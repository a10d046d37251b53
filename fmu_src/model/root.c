#include "model/root.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stdbool.h>

#include "model/extremes.h"

// The largest number of evaluations of one root, after which the last value is returned. Bisection alone
// takes about 60 to reach rounding; half of this would suffice, twice would cost nothing.
enum { MAX_ROOT_STEPS = 200 };

// Each iteration in three steps: the end, if the value or the bracket is small enough; the function at `part` of the bracket,
// which replaces the end of its sign; the next part, by interpolation through three values or else by bisection.
double fc_root_between(double (*f)(void* context, double t), void* context, double a, double at_a, double b,
                       double at_b, double close, double* evaluations) {
    assert(a <= b && close >= 0.0);
    assert(!(at_a * at_b > 0.0)); // of no number passes
    const double rounding = DBL_EPSILON * fc_max(fabs(a), fabs(b));
    // The root lies between near and far; before is the end that was replaced last.
    double near = b;
    double far = a;
    double before = a;
    double at_near = at_b;
    double at_far = at_a;
    double at_before = at_a;
    const bool ends_negative = at_b < 0.0;
    double part = at_b / (at_b - at_a);
    for (int i = 0; i < MAX_ROOT_STEPS; i++) {
        const bool on_side = (at_near < 0.0) == ends_negative;
        const double width = fabs(near - far);
        const bool is_close = fabs(at_near) <= close;
        if (at_near == 0.0 || (on_side && is_close) || width <= rounding) {
            break;
        }
        const double least = fc_min(0.5, fc_max(1e-9, rounding / width)); // so that t is another number
        const double t = near + fc_max(least, fc_min(1.0 - least, part)) * (far - near);
        const double at_t = f(context, t);
        *evaluations += 1.0;
        before = near;
        at_before = at_near;
        if ((at_t < 0.0) != (at_near < 0.0)) {
            before = far;
            at_before = at_far;
            far = near;
            at_far = at_near;
        }
        near = t;
        at_near = at_t;
        // Inverse quadratic interpolation through the three, if they rise or fall together enough.
        const double x = (near - far) / (before - far);
        const double y = (at_near - at_far) / (at_before - at_far);
        part = 0.5;
        if (y * y < x && (1.0 - y) * (1.0 - y) < 1.0 - x) {
            part = at_near / (at_far - at_near) * (at_before / (at_far - at_before)) +
                   (before - near) / (far - near) * (at_near / (at_before - at_near)) *
                       (at_far / (at_before - at_far));
        }
    }
    const double root = (at_near < 0.0) == ends_negative || at_near == 0.0 ? near : far;
    assert(root >= a && root <= b);
    return root;
}
