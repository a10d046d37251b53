#include "solver/path.h"

#include <math.h>

// Below this angle the differences are taken from their series, whose remainders are then under 1e-17.
static const double SERIES_RANGE = 1.0;

// What is left of the sine and the cosine of z beyond the first terms of their series.
typedef struct {
    double sine;          // z - sin z
    double cosine;        // 1 - cos z
    double second_cosine; // z^2/2 - (1 - cos z)
} Remainders;

// 1 - y/(4 5) (1 - y/(6 7) (1 - ...)) for first = 4, by Horner's scheme from the factor last (last + 1) on.
static double series(double y, int first, int last) {
    double sum = 1.0;
    for (int k = last; k >= first; k -= 2) {
        sum = 1.0 - y / (k * (k + 1)) * sum;
    }
    return sum;
}

static Remainders remainders(double z) {
    const double y = z * z;
    if (z > SERIES_RANGE) {
        const double cosine = 1.0 - cos(z);
        return (Remainders){.sine = z - sin(z), .cosine = cosine, .second_cosine = 0.5 * y - cosine};
    }
    // z^3/3! - z^5/5! + ... and z^4/4! - z^6/6! + ...
    const double second_cosine = y * y / 24.0 * series(y, 5, 17);
    return (Remainders){.sine = z * y / 6.0 * series(y, 4, 18),
                        .cosine = 0.5 * y - second_cosine,
                        .second_cosine = second_cosine};
}

FcPath fc_path_from(const FcScene* scene, double start) {
    const FcDrive* drive = &scene->drive;
    FcPath path = {.start = start, .V = drive->V.value + drive->V.rate * start, .V_rate = drive->V.rate};
    if (drive->vibration.V_1 != 0.0) {
        const double theta = drive->theta_0 + drive->omega * start;
        path.omega = drive->omega;
        path.V_1 = drive->vibration.V_1;
        path.cos_theta = cos(theta);
        path.sin_theta = sin(theta);
        path.V += path.V_1 * path.cos_theta;
    }
    return path;
}

double fc_path_at(const FcPath* path, double t) {
    const double s = t - path->start;
    const double linear = s * (path->V + 0.5 * path->V_rate * s);
    if (path->V_1 == 0.0) {
        return linear;
    }
    const Remainders left = remainders(path->omega * s);
    return linear - path->V_1 / path->omega * (path->cos_theta * left.sine + path->sin_theta * left.cosine);
}

double fc_path_at_phase(const FcPath* path, double t, double sin_theta) {
    const double s = t - path->start;
    if (path->omega * s <= SERIES_RANGE) {
        return fc_path_at(path, t);
    }
    const double linear = s * (path->V - path->V_1 * path->cos_theta + 0.5 * path->V_rate * s);
    return linear + path->V_1 / path->omega * (sin_theta - path->sin_theta);
}

double fc_path_integral(const FcPath* path, double t) {
    const double s = t - path->start;
    const double linear = s * s * (path->V / 2.0 + path->V_rate * s / 6.0);
    if (path->V_1 == 0.0) {
        return linear;
    }
    const Remainders left = remainders(path->omega * s);
    const double amplitude = path->V_1 / (path->omega * path->omega);
    return linear - amplitude * (path->cos_theta * left.second_cosine + path->sin_theta * left.sine);
}
