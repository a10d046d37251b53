#include "solver/plane/course.h"

#include <assert.h>
#include <float.h>
#include <math.h>

#include "model/root.h"

double fc_straight_time(const FcStraight* in, double u) {
    return in->center + (isinf(in->length) ? u : in->length * sinh(u));
}

double fc_straight_pace(const FcStraight* in, double u) {
    return isinf(in->length) ? 1.0 : in->length * cosh(u);
}

double fc_straight_place(const FcStraight* in, double t) {
    const double x = t - in->center;
    return isinf(in->length) ? x : asinh(x / in->length);
}

typedef struct {
    FcVector V, rate, curvature; // m/s, m/s2, m/s3
} Motion;

static Motion motion_at(const FcDrive* drive, double t) {
    const FcPhase at_t = fc_drive_phase(drive, t);
    const FcVibration* v = &drive->vibration;
    const double omega = drive->omega;
    const double cosine = at_t.cosine * drive->cos_phase_2 - at_t.sine * drive->sin_phase_2;
    const double sine = at_t.sine * drive->cos_phase_2 + at_t.cosine * drive->sin_phase_2;
    return (Motion){
        .V = {fc_drive_V_at_phase(drive, t, at_t), fc_drive_V_y_at_phase(drive, t, at_t)},
        .rate = {drive->V.rate - v->V_1 * omega * at_t.sine, drive->V_y.rate - v->V_2 * omega * sine},
        .curvature = {-v->V_1 * omega * omega * at_t.cosine, -v->V_2 * omega * omega * cosine},
    };
}

// Half the rate of |V|^2, and the rate of that.
static double rate_of_square(void* drive, double t) {
    const Motion at = motion_at(drive, t);
    return fc_product(at.V, at.rate);
}

static double bend_of_square(void* drive, double t) {
    const Motion at = motion_at(drive, t);
    return fc_product(at.rate, at.rate) + fc_product(at.V, at.curvature);
}

// Samples in a period. By hand: the rate of |V|^2, of two harmonics, has at most one extremum between two of them.
enum { SAMPLES = 16, MOST_CENTERS = FC_MOST_HALVES / 2 };

typedef struct {
    double t, rate, bend; // of half of |V|^2
} Sample;

static Sample sample_at(FcDrive* drive, double t) {
    const Motion at = motion_at(drive, t);
    return (Sample){t, fc_product(at.V, at.rate),
                    fc_product(at.rate, at.rate) + fc_product(at.V, at.curvature)};
}

// Whether |V| has a least between two samples; its time [s] in *center.
static bool has_least(FcDrive* drive, Sample a, Sample b, double* center) {
    double none = 0.0;
    if (a.rate * b.rate > 0.0 && a.bend * b.bend < 0.0 && a.rate * a.bend < 0.0) {
        // The rate comes nearest to 0 inside, and may pass it.
        const double t = fc_root_between(bend_of_square, drive, a.t, a.bend, b.t, b.bend, 0.0, 0.0, &none);
        const Sample nearest = sample_at(drive, t);
        if (nearest.rate < 0.0) {
            a = nearest;
        } else {
            b = nearest;
        }
    }
    if (!(a.rate < 0.0 && b.rate >= 0.0)) {
        return false;
    }
    *center = fc_root_between(rate_of_square, drive, a.t, a.rate, b.t, b.rate, 0.0, 0.0, &none);
    return true;
}

// The times [s] of the least |V| in and beside [0, h].
static int find_centers(const FcDrive* of, double h, double centers[MOST_CENTERS]) {
    FcDrive drive = *of;
    int count = 0;
    if (drive.vibration.V_1 == 0.0 && drive.vibration.V_2 == 0.0) {
        const Motion at = motion_at(&drive, 0.0);
        const double square = fc_product(at.rate, at.rate);
        const double center = -fc_product(at.V, at.rate) / square;
        if (center > -h && center < 2.0 * h) { // not if nothing moves
            centers[count++] = center;
        }
        return count;
    }
    const double period = 1.0 / drive.vibration.f;
    Sample a = sample_at(&drive, -0.5 * period);
    while (a.t < h + 0.5 * period && count < MOST_CENTERS) {
        const Sample b = sample_at(&drive, a.t + period / SAMPLES);
        count += has_least(&drive, a, b, &centers[count]);
        a = b;
    }
    return count;
}

// L of the center; infinite for a dip that is too flat.
static double length_of(const FcPlane* plane, double center, double h, double tolerance) {
    const FcDrive* drive = &plane->scene->drive;
    const Motion at = motion_at(drive, center);
    const double square = fc_product(at.V, at.V);
    const double bend = fc_product(at.rate, at.rate) + fc_product(at.V, at.curvature); // c^2
    const double eps = sqrt(square / bend);
    if (!(bend > 0.0) || eps * drive->omega > 3.0) {
        return INFINITY;
    }
    const double t = fmin(fmax(center, 0.0), h);
    const FcPlaneCoefficients near = fc_plane_coefficients(plane, t, fc_drive_phase(drive, t));
    const double layer = sqrt(2.0 * near.limit / (near.sigma * sqrt(bend)));
    const bool has_layer = plane->scene->friction->model != FC_COULOMB;
    const double least = has_layer ? sqrt(tolerance) * layer : 0.0;
    return fmax(fmax(eps, least), 0x1p-40 * fmax(h, fabs(center)));
}

int fc_halves(const FcPlane* plane, double h, double tolerance, FcHalf halves[FC_MOST_HALVES]) {
    double centers[MOST_CENTERS];
    const int found = find_centers(&plane->scene->drive, h, centers);
    int count = 0;
    double start = 0.0;
    for (int i = 0; i < found; i++) {
        const double end = i + 1 < found ? fmin(h, 0.5 * (centers[i] + centers[i + 1])) : h;
        if (!(end > start)) {
            continue;
        }
        const FcStraight in = {centers[i], length_of(plane, centers[i], h, tolerance)};
        const double middle = centers[i];
        if (middle > start && middle < end) {
            halves[count++] = (FcHalf){start, middle, in};
            start = middle;
        }
        halves[count++] = (FcHalf){start, end, in};
        start = end;
    }
    if (count == 0) {
        halves[count++] = (FcHalf){0.0, h, {0.0, INFINITY}};
    }
    assert(count <= FC_MOST_HALVES);
    return count;
}
