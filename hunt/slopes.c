#include "slopes.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

static const double PI = 3.141592653589793;
static const double ACCURACY = 1e-6;
static const double SHARE = 0x1p-12; // of its scale that an input is changed by
static const double SHARE_OF_TIME = 0x1p-16;
static const double KINK = 0.02;    // by which two differences next to each other differ at a kink
static const double INSTANT = 1e-9; // of a period: what the held inputs are looked at for
// Of a time: within which a bristle that slips has met its bound. It is then nearer than 1e-10 to it, where the FMU takes it
// to slip.
static const double AT_ONCE = 1e-6;
// Of the top speed: |V| below which V's sign, or a share of V, may be rounding.
static const double AT_ZERO = 0x1p-38;

// Forces at 0, x and 2 x; the derivative at 0, of second order. Returns false at a kink.
static bool one_sided(const double force[3], double x, double scale, double* slope) {
    const double first = (force[1] - force[0]) / x, second = (force[2] - force[1]) / x;
    *slope = 1.5 * first - 0.5 * second;
    return fabs(second - first) <= KINK * (fabs(*slope) + scale);
}

static double force_with(const ReferenceScene* scene, size_t input, double change) {
    ReferenceScene moved = *scene;
    ReferenceStep step;
    *(double*)(void*)((char*)&moved + input) += change;
    reference_step(&moved, 1, &step);
    return step.F_t_start;
}

static double start_velocity(const ReferenceScene* s) {
    return s->V + s->V_1 * cos(2.0 * PI * fmod(s->f * s->start, 1.0));
}

// How far [m] d moves before load and stiffness are other ones. Surfaces under a load are as far apart as it lets them.
static double length_of_contact(const ReferenceScene* s) {
    const double decay = s->R_q / s->lambda;
    return s->input == INPUT_LOAD ? decay : fmin(decay, s->d - s->a_d);
}

// How far [its unit] an input moves before F_t is another one. At a reversal the differences by V lie on both sides,
// elsewhere they do not cross V = 0.
static double scale_of(const ReferenceScene* s, int input) {
    const double V = start_velocity(s);
    const bool at_reversal = fabs(V) <= AT_ZERO * (fabs(s->V) + s->V_1);
    const double speed = at_reversal ? fmax(s->V_1, 1e-6) : fabs(V);
    const double length = length_of_contact(s);
    const double scales[] = {s->staticRatio == 1.0 ? speed : fmin(speed, s->V_S), length, s->E, s->load};
    return exp2(floor(log2(scales[input])));
}

// The error of a slope over what is allowed.
static double slope_error(const ReferenceScene* scene, int input, double at_rest, double largest,
                          double slope) {
    static const size_t INPUTS[] = {offsetof(ReferenceScene, V), offsetof(ReferenceScene, d),
                                    offsetof(ReferenceScene, E), offsetof(ReferenceScene, load)};
    const double unit = scale_of(scene, input);
    double sides[2];
    for (int k = 0; k < 2; k++) {
        const double x = (k == 0 ? SHARE : -SHARE) * unit;
        const double force[3] = {at_rest, force_with(scene, INPUTS[input], x),
                                 force_with(scene, INPUTS[input], 2.0 * x)};
        if (!one_sided(force, x, largest / unit, &sides[k])) {
            return -1.0;
        }
    }
    const double low = fmin(sides[0], sides[1]), high = fmax(sides[0], sides[1]);
    const double error = fmax(0.0, fmax(low - slope, slope - high));
    return isnan(slope) ? INFINITY : error / (ACCURACY * (fmax(fabs(low), fabs(high)) + largest / unit));
}

static double rate_error(const ReferenceScene* s, const ReferenceStep* now, double largest, double rate) {
    const double top = fabs(s->V) + s->V_1 + 1e-30, omega = 2.0 * PI * s->f;
    const double bend = fabs(s->V_rate) + omega * s->V_1;
    double pace = omega + now->sigma * top / now->limit + sqrt(now->sigma * bend / now->limit);
    pace += (fabs(s->d_rate) + omega * s->a_d) * 2.0 / length_of_contact(s);
    pace += fabs(s->E_rate) / s->E + fabs(s->load_rate) / s->load + bend / fmin(top, s->V_S);
    const double x = SHARE_OF_TIME / pace;
    double force[4], first, later;
    if (fabs(start_velocity(s)) < 1e-9 * top + 8.0 * x * bend) { // V reverses soon, or just did
        return -1.0;
    }
    for (int k = 0; k < 4; k++) {
        ReferenceScene until = *s;
        ReferenceStep step;
        until.h = (k + 1) * x;
        reference_step(&until, 1, &step);
        if (step.changed > AT_ONCE * x) { // it meets or leaves its bound
            return -1.0;
        }
        force[k] = step.F_t;
    }
    largest = fmax(largest, fabs(force[0])); // the bound's own motion may move the bristle faster than V
    if (!one_sided(force, x, largest * pace, &first) || !one_sided(force + 1, x, largest * pace, &later)) {
        return -1.0;
    }
    const double at_start = 2.0 * first - later;
    return isnan(rate) ? INFINITY : fabs(rate - at_start) / (ACCURACY * (fabs(at_start) + largest * pace));
}

double slopes_ratio(const ReferenceScene* scene, const ReferenceStep* truth, const FmuStep* step) {
    ReferenceScene from = *scene;
    from.initial = START_GIVEN;
    from.delta_0 = step->delta_start;
    const double largest = fabs(step->F_t_start) + truth->scale +
                           (scene->sigma_1 + scene->sigma_2) * (fabs(scene->V) + scene->V_1);
    ReferenceScene held = from;
    held.V_rate = held.d_rate = held.E_rate = held.load_rate = 0.0;
    held.h = INSTANT / scene->f;
    ReferenceStep now;
    reference_step(&held, 1, &now);
    if (now.gap_start > 0.0 && now.gap_start < 1e-9 * truth->scale) {
        return -1.0; // within rounding of a bound
    }
    if (scene->law == LAW_COULOMB && scene->limit == LIMIT_LOAD && now.gap_start == 0.0) {
        return -1.0; // within rounding of a reversal, at which the slopes by d, E and load jump
    }
    double worst = rate_error(&from, &now, largest, step->rate);
    for (int input = 0; input < 4; input++) {
        worst = fmax(worst, slope_error(&held, input, now.F_t_start, largest, step->slopes[input]));
    }
    return worst;
}
