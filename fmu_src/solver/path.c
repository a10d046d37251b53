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

// 1 - y/(4 5) + y^2/(4 5 6 7) - ... and 1 - y/(5 6) + y^2/(5 6 7 8) - ..., eight terms, in pairs.
static const double SINE[8] = {1.0,
                               -1.0 / 20,
                               1.0 / 840,
                               -1.0 / 60480,
                               1.0 / 6652800,
                               -1.0 / 1037836800,
                               1.0 / 217945728000.0,
                               -1.0 / 59281238016000.0};
static const double COSINE[8] = {1.0,
                                 -1.0 / 30,
                                 1.0 / 1680,
                                 -1.0 / 151200,
                                 1.0 / 19958400,
                                 -1.0 / 3632428800,
                                 1.0 / 871782912000.0,
                                 -1.0 / 266765571072000.0};

static double series(double y, const double c[8]) {
    const double y_2 = y * y;
    return c[0] + c[1] * y + y_2 * (c[2] + c[3] * y + y_2 * (c[4] + c[5] * y + y_2 * (c[6] + c[7] * y)));
}

static Remainders remainders(double z) {
    const double y = z * z;
    if (z > SERIES_RANGE) {
        const double cosine = 1.0 - cos(z);
        return (Remainders){.sine = z - sin(z), .cosine = cosine, .second_cosine = 0.5 * y - cosine};
    }
    // z^3/3! - z^5/5! + ... and z^4/4! - z^6/6! + ...
    const double second_cosine = y * y * (1.0 / 24) * series(y, COSINE);
    return (Remainders){.sine = z * y * (1.0 / 6) * series(y, SINE),
                        .cosine = 0.5 * y - second_cosine,
                        .second_cosine = second_cosine};
}

FcPath fc_path_from(const FcScene* scene, double start) {
    const FcDrive* drive = &scene->drive;
    FcPath path = {.start = start, .V = drive->V.value + drive->V.rate * start, .V_rate = drive->V.rate};
    if (drive->vibration.V_1 != 0.0) {
        const FcPhase phase = fc_drive_phase(drive, start);
        path.omega = drive->omega;
        path.V_1 = drive->vibration.V_1;
        path.cos_theta = phase.cosine;
        path.sin_theta = phase.sine;
        path.V = fc_drive_V_at_phase(drive, start, phase);
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
