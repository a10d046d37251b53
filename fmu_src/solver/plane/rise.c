#include "solver/plane/rise.h"

#include <math.h>

enum { POINTS = FC_RADAU_POINTS, STAGES = FC_RADAU_STAGES };

// The polynomial through the points of a panel, in barycentric form.
typedef struct {
    const double* f;
    double weight[POINTS];
} Through;

static double value_at(const Through* through, double x) {
    double above = 0.0;
    double below = 0.0;
    for (int i = 0; i < POINTS; i++) {
        const double away = x - (0.5 + FC_RADAU_9.node[i]);
        if (away == 0.0) {
            return through->f[i];
        }
        above += through->weight[i] / away * through->f[i];
        below += through->weight[i] / away;
    }
    return above / below;
}

double fc_first_rise(const double* f, double over) {
    enum { SAMPLES = 32, HALVINGS = 50 };
    double largest = f[0];
    double smallest = f[0];
    for (int i = 1; i < POINTS; i++) {
        largest = fmax(largest, f[i]);
        smallest = fmin(smallest, f[i]);
    }
    if (largest + 0.25 * (largest - smallest) < 0.0) {
        return 2.0;
    }
    Through through = {.f = f};
    for (int i = 0; i < POINTS; i++) {
        double product = 1.0;
        for (int j = 0; j < POINTS; j++) {
            product *= j == i ? 1.0 : 4.0 * (FC_RADAU_9.node[i] - FC_RADAU_9.node[j]);
        }
        through.weight[i] = 1.0 / product;
    }
    bool is_below = f[STAGES] <= over;
    double a = 0.0; // the last place at which it was below 0
    double before = f[STAGES];
    double last = f[STAGES];
    for (int k = 1; k <= SAMPLES; k++) {
        double x = (double)k / SAMPLES;
        const double sample = value_at(&through, x);
        double value = sample;
        const double bend = 2.0 * last - before - sample;
        if (last > before && last > sample && last <= over && last + 0.25 * bend > over) {
            // Between three samples it has a top, at that of a parabola.
            x += (0.5 * (sample - before) / bend - 1.0) / SAMPLES;
            value = value_at(&through, x);
            a = fmin(a, (k - 2.0) / SAMPLES);
        }
        before = last;
        last = sample;
        if (value <= over || !is_below) {
            is_below = is_below || value <= over;
            a = value <= 0.0 ? x : a;
            continue;
        }
        double b = x;
        for (int i = 0; i < HALVINGS; i++) {
            const double middle = 0.5 * (a + b);
            if (value_at(&through, middle) > 0.0) {
                b = middle;
            } else {
                a = middle;
            }
        }
        return b;
    }
    return 2.0;
}
