#include "solver/nodes.h"

#include <math.h>

// Largest argument of the series below: their remainders are then under 1e-17.
static const double SERIES_RANGE = 0.25;

// sin(x), cos(x) - 1 and e^x - 1 by Taylor series, Horner's scheme.
static inline double series_sin(double x) {
    const double y = x * x;
    return x *
           (1.0 + y * (-1.0 / 6 + y * (1.0 / 120 + y * (-1.0 / 5040 + y * (1.0 / 362880 - y / 39916800)))));
}

static inline double series_cos_less_1(double x) {
    const double y = x * x;
    return y * (-1.0 / 2 +
                y * (1.0 / 24 + y * (-1.0 / 720 + y * (1.0 / 40320 + y * (-1.0 / 3628800 + y / 479001600)))));
}

static inline double series_exp_less_1(double x) {
    double sum = 1.0 / 479001600; // 1 / 12!
    sum = 1.0 / 39916800 + x * sum;
    sum = 1.0 / 3628800 + x * sum;
    sum = 1.0 / 362880 + x * sum;
    sum = 1.0 / 40320 + x * sum;
    sum = 1.0 / 5040 + x * sum;
    sum = 1.0 / 720 + x * sum;
    sum = 1.0 / 120 + x * sum;
    sum = 1.0 / 24 + x * sum;
    sum = 1.0 / 6 + x * sum;
    sum = 1.0 / 2 + x * sum;
    return x * (1.0 + x * sum);
}

// Whether the phase and ln(sigma) stay within the range of the series over a step of h [s].
static bool is_short(const FcScene* scene, double h) {
    const FcDrive* drive = &scene->drive;
    if (scene->floats || scene->at_E.model == FC_CONTACT_MINDLIN || scene->friction->limit == FC_LIMIT_LOAD ||
        (scene->friction->model == FC_LUGRE && scene->friction->staticRatio != 1.0)) {
        return false;
    }
    const double d_rate = fabs(drive->d.rate) + drive->vibration.a_d * drive->omega;
    return drive->E.rate == 0.0 && 0.5 * h * drive->omega <= SERIES_RANGE &&
           0.5 * h * 2.0 * scene->at_E.decay * d_rate <= SERIES_RANGE;
}

void fc_node_coefficients(const FcScene* scene, double t, double h, const double node[FC_NODE_COUNT],
                          FcNodeCoefficients* at) {
    if (!is_short(scene, h)) {
        for (int i = 0; i < FC_NODE_COUNT; i++) {
            const FcCoefficients now = fc_scene_coefficients(scene, t + node[i] * h);
            at->V[i] = now.V;
            at->sigma[i] = now.sigma;
            at->limit[i] = now.limit;
        }
        return;
    }
    const FcDrive* drive = &scene->drive;
    const double middle = t + 0.5 * h;
    const double angle = drive->theta_0 + drive->omega * middle;
    const double c = cos(angle);
    const double s = sin(angle);
    const double V_middle = drive->V.value + drive->V.rate * middle + drive->vibration.V_1 * c;
    // cos and sin of the separation's angle
    const double c_d = c * drive->cos_phase_d - s * drive->sin_phase_d;
    const double s_d = s * drive->cos_phase_d + c * drive->sin_phase_d;
    const double d_middle = drive->d.value + drive->d.rate * middle + drive->vibration.a_d * c_d;
    const double two_decay = 2.0 * scene->at_E.decay;
    const double stiffness = scene->at_E.stiffness_0 * exp(-two_decay * d_middle);
    for (int i = 0; i < FC_NODE_COUNT; i++) {
        const double later = (node[i] - 0.5) * h;
        const double sin_later = series_sin(drive->omega * later);
        const double cos_later_less_1 = series_cos_less_1(drive->omega * later);
        at->V[i] =
            V_middle + drive->V.rate * later + drive->vibration.V_1 * (c * cos_later_less_1 - s * sin_later);
        const double d_moved =
            drive->d.rate * later + drive->vibration.a_d * (c_d * cos_later_less_1 - s_d * sin_later);
        const double d = d_middle + d_moved;
        at->limit[i] = scene->F_C;
        at->sigma[i] = stiffness * (1.0 + series_exp_less_1(-two_decay * d_moved)) / (d * d * d);
    }
    if (scene->at_E.model == FC_CONTACT_CONSTANT) {
        for (int i = 0; i < FC_NODE_COUNT; i++) {
            at->sigma[i] = scene->at_E.stiffness_0;
        }
    }
}
