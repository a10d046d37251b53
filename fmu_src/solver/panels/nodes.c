#include "solver/panels/nodes.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>

#include "solver/panels/arithmetic.h"

// sin(x) and cos(x) - 1 by Taylor series (arithmetic.h), terms in pairs as there.
static inline double series_sin(double x) {
    const double y = x * x;
    const double y_2 = y * y;
    const double low = -1.0 / 6 + y * (1.0 / 120);
    const double high = (-1.0 / 5040 + y * (1.0 / 362880)) - y_2 * (1.0 / 39916800);
    return x + x * y * (low + y_2 * high);
}

static inline double series_cos_less_1(double x) {
    const double y = x * x;
    const double y_2 = y * y;
    const double low = (-1.0 / 2 + y * (1.0 / 24)) + y_2 * (-1.0 / 720 + y * (1.0 / 40320));
    const double high = -1.0 / 3628800 + y * (1.0 / 479001600);
    return y * (low + y_2 * y_2 * high);
}

// The largest number of halvings of an argument for the series. Each doubling back loses digits: twice as
// many would lose too many, half as many would call the library more often.
enum { MOST_SERIES_HALVINGS = 4 };
typedef struct {
    int count;
    double factor; // 2^-count
} Halvings;

static inline Halvings halvings(double size) {
    Halvings halved = {0, 1.0};
    while (size * halved.factor > FC_SERIES_RANGE && halved.count <= MOST_SERIES_HALVINGS) {
        halved.factor *= 0.5;
        halved.count++;
    }
    return halved;
}

// d_middle + moved[] -> sigma and the limit without its factor by V.
static inline __attribute__((always_inline)) void of_separation(const FcScene* scene, double d_middle,
                                                                const double* moved, int count,
                                                                Halvings halved, FcNodeCoefficients* at) {
    const FcContactAtModulus* c = &scene->at_E;
    double e[FC_MOST_NODES];
    for (int i = 0; i < count; i++) {
        e[i] = fc_series_exp_less_1(-c->decay * halved.factor * moved[i]);
    }
    for (int k = 0; k < halved.count; k++) {
        for (int i = 0; i < count; i++) {
            e[i] *= 2.0 + e[i];
        }
    }
    const double e_middle = exp(-c->decay * d_middle);
    for (int i = 0; i < count; i++) {
        e[i] = e_middle + e_middle * e[i];
    }
    if (c->model == FC_CONTACT_ASPERITIES) {
        for (int i = 0; i < count; i++) {
            const double d = d_middle + moved[i];
            at->sigma[i] = c->stiffness_0 * (e[i] * e[i]) / (d * d * d);
        }
    } else if (c->model == FC_CONTACT_MINDLIN) {
        for (int i = 0; i < count; i++) {
            at->sigma[i] = c->stiffness_0 * e[i];
        }
    }
    if (fc_limit_follows_load(scene->friction)) {
        for (int i = 0; i < count; i++) {
            at->limit[i] = scene->friction->mu * (c->load_0 * e[i]);
        }
    }
}

static inline __attribute__((always_inline)) void with_series(const FcScene* scene, double t, double h,
                                                              const double* node, int count, bool symmetric,
                                                              Halvings halved_angle, Halvings halved_exponent,
                                                              FcNodeCoefficients* at) {
    const FcDrive* drive = &scene->drive;
    const double middle = t + 0.5 * h;
    const FcPhase at_middle = fc_drive_phase(drive, middle);
    const double V_middle = fc_drive_V_at_phase(drive, middle, at_middle);
    const double c = at_middle.cosine;
    const double s = at_middle.sine;
    double sin_later[FC_MOST_NODES];
    double cos_later_less_1[FC_MOST_NODES];
    const double angle_per_node = drive->omega * h * halved_angle.factor;
    const int first = symmetric ? count / 2 : 0;
    for (int i = first; i < count; i++) {
        sin_later[i] = series_sin(angle_per_node * node[i]);
        cos_later_less_1[i] = series_cos_less_1(angle_per_node * node[i]);
    }
    for (int k = 0; k < halved_angle.count; k++) {
        for (int i = first; i < count; i++) {
            sin_later[i] *= 2.0 * (1.0 + cos_later_less_1[i]);
            cos_later_less_1[i] *= 2.0 * (2.0 + cos_later_less_1[i]);
        }
    }
    for (int i = 0; i < first; i++) {
        sin_later[i] = -sin_later[count - 1 - i];
        cos_later_less_1[i] = cos_later_less_1[count - 1 - i];
    }
    const double V_c = drive->vibration.V_1 * c;
    const double V_s = drive->vibration.V_1 * s;
    const double V_rate = drive->V.rate * h;
    for (int i = 0; i < count; i++) {
        at->V[i] = V_middle + V_rate * node[i] + (V_c * cos_later_less_1[i] - V_s * sin_later[i]);
        at->sigma[i] = scene->at_E.stiffness_0;
        at->limit[i] = scene->F_C;
    }
    if (fc_scene_depends_on_d(scene)) {
        // cos and sin of the separation's angle
        const double d_c = drive->vibration.a_d * (c * drive->cos_phase_d - s * drive->sin_phase_d);
        const double d_s = drive->vibration.a_d * (s * drive->cos_phase_d + c * drive->sin_phase_d);
        const double d_rate = drive->d.rate * h;
        double moved[FC_MOST_NODES];
        for (int i = 0; i < count; i++) {
            moved[i] = d_rate * node[i] + (d_c * cos_later_less_1[i] - d_s * sin_later[i]);
        }
        of_separation(scene, drive->d.value + drive->d.rate * middle + d_c, moved, count, halved_exponent,
                      at);
    }
    if (fc_has_stribeck_curve(scene->friction)) {
        for (int i = 0; i < count; i++) {
            at->limit[i] *= fc_stribeck(scene->friction, at->V[i]);
        }
    }
}

static void with_library(const FcScene* scene, double t, double h, const double* node, int count,
                         FcNodeCoefficients* at) {
    for (int i = 0; i < count; i++) {
        const FcCoefficients now = fc_scene_coefficients(scene, t + (0.5 + node[i]) * h);
        at->V[i] = now.V;
        at->sigma[i] = now.sigma;
        at->limit[i] = now.limit;
    }
}

FC_WITH_AVX void fc_node_coefficients(const FcScene* scene, double t, double h, const double* node, int count,
                                      FcNodeCoefficients* at) {
    assert(count % 2 == 0 && count <= FC_MOST_NODES);
    const FcDrive* drive = &scene->drive;
    const double half_angle = 0.5 * h * drive->omega;
    const double moves = 0.5 * h * fabs(drive->d.rate) + drive->vibration.a_d * fmin(half_angle, 2.0);
    const Halvings angle = halvings(half_angle);
    const Halvings exponent = halvings(fc_scene_depends_on_d(scene) ? scene->at_E.decay * moves : 0.0);
    if (scene->floats || drive->E.rate != 0.0 || angle.count > MOST_SERIES_HALVINGS ||
        exponent.count > MOST_SERIES_HALVINGS) {
        with_library(scene, t, h, node, count, at);
        return;
    }
    assert(count == 10 || node[0] == -node[count - 1]); // symmetric, as a Gauss rule is
// The constant count unrolls the loops of with_series.
#define WITH_SERIES(n, symmetric)                                                                            \
    case n:                                                                                                  \
        with_series(scene, t, h, node, n, symmetric, angle, exponent, at);                                   \
        break
    switch (count) {
        WITH_SERIES(4, true);
        WITH_SERIES(6, true);
        WITH_SERIES(8, true);
        WITH_SERIES(10, false);
        WITH_SERIES(12, true);
    default:
        assert(false); // no rule has this number of nodes
    }
}
