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

double fc_part_time(const FcPart* part, double u) {
    return fmin(fmax(fc_straight_time(&part->in, u), part->start), part->end);
}

double fc_straight_place(const FcStraight* in, double t) {
    const double x = t - in->center;
    return isinf(in->length) ? x : asinh(x / in->length);
}

// Half of |V|^2 at a time, its rate, the rate of that, and so on.
typedef struct {
    double t, half, rate, bend, twist; // s, m2/s2 and so on
    double curvature, third;           // m/s3, m/s4: |V''| and |V'''|
} Sample;

static Sample sample_at(const FcDrive* drive, double t) {
    const FcPhase at_t = fc_drive_phase(drive, t);
    const FcVelocity x = fc_drive_velocity_at_phase(drive, t, at_t);
    const FcVelocity y = fc_drive_velocity_y_at_phase(drive, t, at_t);
    return (Sample){.t = t,
                    .half = 0.5 * (x.V * x.V + y.V * y.V),
                    .rate = x.V * x.rate + y.V * y.rate,
                    .bend = (x.rate * x.rate + y.rate * y.rate) + (x.V * x.curvature + y.V * y.curvature),
                    .twist = 3.0 * (x.rate * x.curvature + y.rate * y.curvature) -
                             drive->omega * drive->omega *
                                 (x.V * (x.rate - drive->V.rate) + y.V * (y.rate - drive->V_y.rate)),
                    .curvature = hypot(x.curvature, y.curvature),
                    .third = hypot(x.third, y.third)};
}

static double rate_of_square(void* drive, double t) { return sample_at(drive, t).rate; }

static double bend_of_square(void* drive, double t) { return sample_at(drive, t).bend; }

static double twist_of_square(void* drive, double t) { return sample_at(drive, t).twist; }

// The number of samples in a period. Chosen empirically: the rate of |V|^2 has two harmonics, and at most two
// extrema are assumed between two samples. Half as many might miss a near-zero, twice as many cost time alone.
enum { SAMPLES = 16, MOST_CENTERS = FC_MOST_PARTS / 2 };

// Whether |V| has a minimum between two samples; its time [s] in *center.
static bool has_least(FcDrive* drive, Sample a, Sample b, double* center) {
    double none = 0.0;
    if (a.rate * b.rate > 0.0 && a.bend * b.bend < 0.0 && a.rate * a.bend < 0.0) {
        // The rate comes nearest to 0 inside the cell, and may pass it.
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

// The times [s] of the minima of |V| in and beside [0, h].
static int find_centers(const FcDrive* of, double h, double centers[MOST_CENTERS]) {
    FcDrive drive = *of;
    double none = 0.0;
    int count = 0;
    if (drive.vibration.V_1 == 0.0 && drive.vibration.V_2 == 0.0) {
        const Sample at = sample_at(&drive, 0.0);
        const double center = -at.rate / at.bend;
        if (center > -h && center < 2.0 * h) { // not if nothing moves
            centers[count++] = center;
        }
        return count;
    }
    const double period = 1.0 / drive.vibration.f;
    Sample a = sample_at(&drive, -0.5 * period);
    while (a.t < h + 0.5 * period && count < MOST_CENTERS - 1) { // two may follow
        const Sample b = sample_at(&drive, a.t + period / SAMPLES);
        if (a.twist < 0.0 && b.twist > 0.0) { // between two minima it bends down
            const double t =
                fc_root_between(twist_of_square, &drive, a.t, a.twist, b.t, b.twist, 0.0, 0.0, &none);
            const Sample between = sample_at(&drive, t);
            if (between.bend < 0.0) {
                count += has_least(&drive, a, between, &centers[count]);
                a = between;
            }
        }
        count += has_least(&drive, a, b, &centers[count]);
        a = b;
    }
    return count;
}

// A minimum of |V| near 0. With a = |d^n V/dt^n| / n!, |V|^2 = a^2 (x^2n + eps^2n): V passes 0 nearly (n = 1), touches it
// or passes it in a saddle.
typedef struct {
    double eps;  // s, the distance of the branch points
    int order;   // n
    double rate; // m/s^(n + 1), a
} Dip;

// `bend` is a^2 for n = 1, and rounding for a larger n.
static Dip dip_of(const FcDrive* drive, Sample least) {
    const double speed = sqrt(2.0 * least.half);
    const double rate = sqrt(fmax(0.0, least.bend));
    Dip dip = {speed / rate, 1, rate};
    const double higher[] = {least.curvature / 2.0, least.third / 6.0};
    for (int n = 2; n <= 3; n++) {
        const double eps = pow(speed / higher[n - 2], 1.0 / n);
        if (!(eps >= dip.eps) && eps * drive->omega < 1.0) {
            dip = (Dip){eps, n, higher[n - 2]};
        }
    }
    return dip;
}

// L of a dip; infinite if it is too flat to matter.
static double length_of(const FcPlane* plane, Sample least, Dip dip, double h, double tolerance) {
    const FcDrive* drive = &plane->scene->drive;
    if (!(dip.eps * drive->omega <= 3.0)) {
        return INFINITY;
    }
    double least_length = 0.0;
    if (plane->scene->friction->model != FC_COULOMB) { // the time in which a bristle relaxes by 1
        const double t = fmin(fmax(least.t, 0.0), h);
        const FcPlaneCoefficients near = fc_plane_coefficients(plane, t, fc_drive_phase(drive, t));
        const double path = near.limit / near.sigma;
        const double layer = pow((dip.order + 1) * path / dip.rate, 1.0 / (dip.order + 1));
        least_length = sqrt(tolerance) * fmin(layer, h);
    }
    return fmax(fmax(dip.eps, least_length), 0x1p-40 * fmax(h, fabs(least.t)));
}

// The part of the interval that is not worth a panel. Rounding of the middles: 4500 eps.
static const double ROUNDING = 1e-12;

int fc_parts(const FcPlane* plane, double h, double tolerance, FcPart parts[FC_MOST_PARTS]) {
    double centers[MOST_CENTERS];
    const int found = find_centers(&plane->scene->drive, h, centers);
    int count = 0;
    double start = 0.0;
    for (int i = 0; i < found; i++) {
        const double middle = i + 1 < found ? 0.5 * (centers[i] + centers[i + 1]) : h;
        const double end = h - middle < ROUNDING * h ? h : middle;
        if (!(end - start > ROUNDING * h)) {
            continue;
        }
        const double center = centers[i];
        const Sample least = sample_at(&plane->scene->drive, center);
        const Dip dip = dip_of(&plane->scene->drive, least);
        // If the near-zero is farther away than the part lasts, |V| is smooth in t, and u would round the
        // times.
        const bool is_far = fmax(start - center, center - end) > end - start;
        const FcStraight in = is_far ? (FcStraight){0.0, INFINITY}
                                     : (FcStraight){center, length_of(plane, least, dip, h, tolerance)};
        if (isfinite(in.length) && in.length > dip.eps && center > start && center < end) { // a kink
            parts[count++] = (FcPart){start, center, in};
            start = center;
        }
        parts[count++] = (FcPart){start, end, in};
        start = end;
    }
    if (count == 0) {
        parts[count++] = (FcPart){0.0, h, {0.0, INFINITY}};
    }
    assert(count <= FC_MOST_PARTS);
    return count;
}
