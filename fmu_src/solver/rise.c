#include "solver/rise.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>

#include "model/root.h"

enum { POINTS = FC_POINTS, START = FC_STAGES };

// The polynomial through the points of a panel, in barycentric form.
static double value_at(void* points, double x) {
    const double* f = points;
    double above = 0.0;
    double below = 0.0;
    for (int i = 0; i < POINTS; i++) {
        const double away = x - (0.5 + FC_RADAU.node[i]);
        if (away == 0.0) {
            return f[i];
        }
        const double part = FC_RADAU.barycentric[i] / away;
        above += part * f[i];
        below += part;
    }
    return above / below;
}

// The root between a place at which f is not positive, unless by rounding, and one at which it is.
static double root_between(double* f, double a, double b, double at_b) {
    const double at_a = a == 0.0 ? f[START] : value_at(f, a);
    double none = 0.0;
    return at_a < 0.0 ? fc_root_between(value_at, f, a, at_a, b, at_b, 0.0, 0.0, &none)
                      : a + 0x1p-50 * (b - a);
}

double fc_first_rise(const double at_points[FC_POINTS], double over) {
    assert(over >= 0.0);
    double FC_PAIRED f[POINTS];
    double largest = at_points[0];
    double smallest = at_points[0];
    for (int i = 0; i < POINTS; i++) {
        f[i] = at_points[i];
        largest = fc_most(largest, f[i]);
        smallest = fc_least(smallest, f[i]);
    }
    if (largest + 0.25 * (largest - smallest) < 0.0) { // nor between the points
        return 2.0;
    }
    bool is_below = f[START] <= over;
    double a = 0.0; // the last place at which it was below 0
    double before = f[START];
    double last = f[START];
    for (int k = 1; k <= FC_SAMPLES; k++) {
        double x = (double)k / FC_SAMPLES;
        const double sample = fc_dot(POINTS, FC_RADAU.sample[k], f);
        double value = sample;
        // Between three samples it may have a top, at that of a parabola.
        const double bend = 2.0 * last - before - sample;
        if (last > before && last > sample && last <= over && last + 0.25 * bend > over) {
            x += (0.5 * (sample - before) / bend - 1.0) / FC_SAMPLES;
            value = value_at(f, x);
            a = fc_least(a, (k - 2.0) / FC_SAMPLES);
        }
        before = last;
        last = sample;
        if (value > over && is_below) {
            return root_between(f, a, x, value);
        }
        is_below = is_below || value <= over;
        a = value <= 0.0 ? x : a;
    }
    return 2.0;
}
