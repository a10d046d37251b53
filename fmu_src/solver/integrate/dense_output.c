#include "solver/integrate/dense_output.h"

#include <assert.h>
#include <stdbool.h>
#include <string.h>

#include "model/root.h"

enum { POINTS = FC_POINTS, START = FC_STAGES };

// The polynomial through the points of a panel, in barycentric form.
static double value_at(void* points, double x) {
    const double* f = points;
    FcPair above = {0.0, 0.0};
    FcPair below = {0.0, 0.0};
    for (int i = 0; i < POINTS; i += 2) {
        const FcPair away = x - (0.5 + fc_pair(FC_RADAU.node + i));
        if (away[0] == 0.0 || away[1] == 0.0) {
            return f[away[0] == 0.0 ? i : i + 1];
        }
        const FcPair part = fc_pair(FC_RADAU.barycentric + i) / away;
        above += part * fc_pair(f + i);
        below += part;
    }
    return fc_pair_sum(above) / fc_pair_sum(below);
}

// The root between a place at which f is not positive, unless by rounding, and one at which it is.
static double root_between(double* f, double a, double b, double at_b) {
    assert(a >= 0.0 && a < b && b <= 1.0 && at_b > 0.0);
    const double at_a = a == 0.0 ? f[START] : value_at(f, a);
    double none = 0.0;
    return at_a < 0.0 ? fc_root_between(value_at, f, a, at_a, b, at_b, 0.0, &none) : a + 0x1p-50 * (b - a);
}

// The values at the start and after each of the equal steps.
static void find_samples(const double f[POINTS], double value[FC_SAMPLES + 1]) {
    double after[FC_SAMPLES] = {0.0};
    for (int j = 0; j < POINTS; j++) {
        for (int k = 0; k < FC_SAMPLES; k++) {
            after[k] += f[j] * FC_RADAU.sample[j][k];
        }
    }
    value[0] = f[START];
    memcpy(value + 1, after, sizeof after);
}

double fc_first_upcrossing(const double at_points[FC_POINTS], double over) {
    assert(over >= 0.0);
    double FC_PAIRED f[POINTS];
    double largest = at_points[0];
    double smallest = at_points[0];
    for (int i = 0; i < POINTS; i++) {
        f[i] = at_points[i];
        largest = fc_max(largest, f[i]);
        smallest = fc_min(smallest, f[i]);
    }
    if (largest + 0.25 * (largest - smallest) < 0.0) { // nor between the points
        return 2.0;
    }
    double value[FC_SAMPLES + 1];
    find_samples(f, value);
    bool is_below = value[0] <= over;
    int below = 0; // the last sample at which it was below 0
    for (int k = 1; k <= FC_SAMPLES; k++) {
        // Between three samples it may have a top, at that of a parabola.
        const double before = value[k > 1 ? k - 2 : 0];
        const double last = value[k - 1];
        const bool passes = value[k] > over;
        bool has_top = last > before && last > value[k] && last <= over;
        if (is_below && (passes || has_top)) {
            const double bend = 2.0 * last - before - value[k];
            has_top = has_top && last + 0.25 * bend > over;
            const double x = (k + (has_top ? 0.5 * (value[k] - before) / bend - 1.0 : 0.0)) / FC_SAMPLES;
            const double at_x = has_top ? value_at(f, x) : value[k];
            const int from = has_top && below > k - 2 ? (k > 1 ? k - 2 : 0) : below;
            if (at_x > over) {
                return root_between(f, (double)from / FC_SAMPLES, x, at_x);
            }
        }
        is_below = is_below || value[k] <= over;
        below = value[k] <= 0.0 ? k : below;
    }
    return 2.0;
}
