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

static Remainders remainders(double z) {
    const double y = z * z;
    Remainders left;
    if (z > SERIES_RANGE) {
        left.sine = z - sin(z);
        left.cosine = 1.0 - cos(z);
        left.second_cosine = 0.5 * y - left.cosine;
        return left;
    }
    // z^3/3! - z^5/5! + ... and z^4/4! - z^6/6! + ... by Horner's scheme
    double sine = 1.0 - y / (18 * 19);
    sine = 1.0 - y / (16 * 17) * sine;
    sine = 1.0 - y / (14 * 15) * sine;
    sine = 1.0 - y / (12 * 13) * sine;
    sine = 1.0 - y / (10 * 11) * sine;
    sine = 1.0 - y / (8 * 9) * sine;
    sine = 1.0 - y / (6 * 7) * sine;
    sine = 1.0 - y / (4 * 5) * sine;
    double cosine = 1.0 - y / (17 * 18);
    cosine = 1.0 - y / (15 * 16) * cosine;
    cosine = 1.0 - y / (13 * 14) * cosine;
    cosine = 1.0 - y / (11 * 12) * cosine;
    cosine = 1.0 - y / (9 * 10) * cosine;
    cosine = 1.0 - y / (7 * 8) * cosine;
    cosine = 1.0 - y / (5 * 6) * cosine;
    left.sine = z * y / 6.0 * sine;
    left.second_cosine = y * y / 24.0 * cosine;
    left.cosine = 0.5 * y - left.second_cosine;
    return left;
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
