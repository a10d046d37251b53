#include "solver/integrate/time_map.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

#include "model/extremes.h"
#include "model/root.h"
#include "solver/integrate/tuning.h"
#include "solver/panel/arithmetic.h"

double fc_time_map_t(const FcTimeMap* in, double u) {
    return in->center + (isinf(in->length) ? u : in->length * sinh(u));
}

double fc_time_map_dt_du(const FcTimeMap* in, double u) {
    assert(in->length > 0.0);
    return isinf(in->length) ? 1.0 : in->length * cosh(u);
}

double fc_part_time(const FcPart* part, double u) {
    assert(part->start <= part->end);
    return fc_min(fc_max(fc_time_map_t(&part->in, u), part->start), part->end);
}

double fc_time_map_u(const FcTimeMap* in, double t) {
    assert(in->length > 0.0);
    const double x = t - in->center;
    return isinf(in->length) ? x : asinh(x / in->length);
}

// ---- the minima of |V| in the plane ----

// Half of |V|^2 at a time, and its first three derivatives.
typedef struct {
    double t, rate, bend, twist; // s, m2/s3 and so on
} Sample;

static Sample sample_at(const FcDrive* drive, double t) {
    const FcPhase at_t = fc_drive_phase(drive, t);
    const FcVelocity x = fc_drive_velocity_at_phase(drive, t, at_t);
    const FcVelocity y = fc_drive_velocity_y_at_phase(drive, t, at_t);
    return (Sample){.t = t,
                    .rate = x.V * x.rate + y.V * y.rate,
                    .bend = (x.rate * x.rate + y.rate * y.rate) + (x.V * x.curvature + y.V * y.curvature),
                    .twist = 3.0 * (x.rate * x.curvature + y.rate * y.curvature) +
                             (x.V * x.third + y.V * y.third)};
}

static double rate_of_square(void* drive, double t) { return sample_at(drive, t).rate; }
static double bend_of_square(void* drive, double t) { return sample_at(drive, t).bend; }
static double twist_of_square(void* drive, double t) { return sample_at(drive, t).twist; }

// The number of samples in a period. Derived: the rate of |V|^2 has two harmonics, and its bend turns at most once
// between two samples that are cut where its twist changes sign.
enum { SAMPLES = 16, MAX_CENTERS = 8 };

// Whether |V| has a minimum where its square bends up, between two samples; its time [s] in *center. At a maximum the rate
// may be exactly 0, but the square bends down.
static bool has_least_where_up(FcDrive* drive, Sample a, Sample b, double* center) {
    double none = 0.0;
    if (!(a.rate < 0.0 && b.rate >= 0.0 && a.bend + b.bend >= 0.0)) {
        return false;
    }
    *center = fc_root_between(rate_of_square, drive, a.t, a.rate, b.t, b.rate, 0.0, &none);
    return true;
}

// The same between any two samples between which the bend changes its sign once at the most.
static bool has_least(FcDrive* drive, Sample a, Sample b, double* center) {
    if (!(a.bend * b.bend < 0.0)) {
        return has_least_where_up(drive, a, b, center);
    }
    double none = 0.0;
    const double turn = fc_root_between(bend_of_square, drive, a.t, a.bend, b.t, b.bend, 0.0, &none);
    Sample flat = sample_at(drive, turn);
    flat.bend = 0.0;
    return a.bend > 0.0 ? has_least_where_up(drive, a, flat, center)
                        : has_least_where_up(drive, flat, b, center);
}

// The times [s] of the minima of |V| in and beside [0, h].
static int minima(const FcDrive* of, double h, double times[MAX_CENTERS]) {
    assert(h > 0.0);
    FcDrive drive = *of;
    int count = 0;
    if (drive.vibration.V_1 == 0.0 && drive.vibration.V_2 == 0.0) {
        const Sample at = sample_at(&drive, 0.0);
        if (at.bend > 0.0 && FC_MIN_DIVISOR * fabs(at.rate) < at.bend) {
            times[count++] = -at.rate / at.bend;
        }
        return count;
    }
    const double period = 1.0 / drive.vibration.f;
    Sample a = sample_at(&drive, -0.5 * period);
    while (a.t < h + 0.5 * period && count < MAX_CENTERS - 1) { // two may follow
        const Sample b = sample_at(&drive, a.t + period / SAMPLES);
        // Between two minima it bends down, most where the twist changes sign.
        if (a.twist < 0.0 && b.twist > 0.0) {
            double none = 0.0;
            const Sample between = sample_at(
                &drive, fc_root_between(twist_of_square, &drive, a.t, a.twist, b.t, b.twist, 0.0, &none));
            if (between.bend < 0.0) {
                count += has_least(&drive, a, between, &times[count]);
                a = between;
            }
        }
        count += has_least(&drive, a, b, &times[count]);
        a = b;
    }
    assert(count <= MAX_CENTERS);
    return count;
}

// ---- centers ----

// A center, with its variable and that beyond a Stribeck curve.
typedef struct {
    double time;           // s
    double length, beyond; // s
    double edge;           // s, the distance at which the curve has ended; infinite if no part is cut
    double strip_ratio, strip_ratio_beyond;
    FcSpeedBound speed_bound;
} Center;

static const Center NONE = {
    .length = INFINITY, .beyond = INFINITY, .edge = INFINITY, .strip_ratio = 1.0, .strip_ratio_beyond = 1.0};

static FcSpeedBound speed_bound_at(const FcPlane* plane, double t) {
    const FcDrive* drive = &plane->scene->drive;
    const FcPhase phase = fc_drive_phase(drive, t);
    const FcVelocity x = fc_drive_velocity_at_phase(drive, t, phase);
    const FcVelocity y =
        plane->is_one_dimensional ? (FcVelocity){0} : fc_drive_velocity_y_at_phase(drive, t, phase);
    return (FcSpeedBound){{hypot(x.V, y.V), hypot(x.rate, y.rate), hypot(x.curvature, y.curvature) / 2.0,
                           hypot(x.third, y.third) / 6.0}};
}

// The root of a x^n = change; infinite if a is 0.
static double time_of_power(double a, int n, double change) {
    assert(n >= 1 && n <= 4 && !(change < 0.0));
    if (!(a > 0.0)) {
        return INFINITY;
    }
    const double x = change / a;
    return n == 1 ? x : n == 2 ? sqrt(x) : n == 3 ? cbrt(x) : sqrt(sqrt(x));
}

// The time [s] in which V moves by change [m/s].
static double time_of_change(const FcSpeedBound* bound, double change) {
    double least = INFINITY;
    for (int n = 1; n <= 3; n++) {
        least = fc_min(least, time_of_power(bound->of[n], n, change));
    }
    return least;
}

// The order with which V passes a center, seen over x [s].
static int order_at(const FcSpeedBound* bound, double x) {
    assert(!(x < 0.0));
    const double by[] = {bound->of[1], bound->of[2] * x, bound->of[3] * x * x};
    return by[0] >= by[1] && by[0] >= by[2] ? 1 : by[1] >= by[2] ? 2 : 3;
}

// L without a curve: the larger of eps and the layer, for the order for which it is least.
static double length_of_layer(const FcPlane* plane, const FcSpeedBound* bound, double path, double of_layer,
                              double h, double* eps) {
    const bool relaxes = fc_has_bristle(plane->scene->friction) &&
                         (!plane->is_one_dimensional || !fc_may_stick(plane->scene->friction));
    *eps = time_of_change(bound, bound->of[0]);
    if (!relaxes) {
        return plane->is_one_dimensional ? INFINITY : *eps;
    }
    double layer = INFINITY;
    for (int n = 1; n <= 3; n++) {
        layer = fc_min(layer, time_of_power(bound->of[n], n + 1, (n + 1) * path));
    }
    return fc_max(*eps, of_layer * fc_min(layer, h));
}

// The center at a time, which may be beside [0, h]. A reversal, or what is taken for one ahead of the start, has |V| = 0.
static Center center_at(const FcPlane* plane, double time, double seen_from, bool is_reversal, double h,
                        double tolerance) {
    const FcScene* scene = plane->scene;
    Center of = NONE;
    of.time = time;
    of.speed_bound = speed_bound_at(plane, seen_from);
    if (is_reversal) {
        of.speed_bound.of[0] = 0.0;
    }
    const double inside = fc_min(fc_max(time, 0.0), h);
    const FcPlaneCoefficients near =
        fc_plane_coefficients(plane, inside, fc_drive_phase(&scene->drive, inside));
    double eps;
    of.length = length_of_layer(plane, &of.speed_bound, near.static_limit / near.sigma,
                                plane->is_one_dimensional ? 1.0 : sqrt(tolerance), h, &eps);
    of.beyond = of.length;
    // A Stribeck curve, if V comes into it.
    const double V_S = scene->friction->V_S;
    const bool has_curve =
        fc_has_stribeck_curve(scene->friction) && of.speed_bound.of[0] < FC_END_OF_CURVE * V_S;
    if (has_curve) {
        const double of_curve =
            fc_max(time_of_change(&of.speed_bound, V_S), plane->is_one_dimensional ? 0.0 : eps);
        if (of_curve < 0.5 * of.length && fc_may_relax(scene->friction)) {
            of.edge = time_of_change(&of.speed_bound, FC_END_OF_CURVE * V_S);
        }
        of.length = fc_min(of.length, of_curve);
    }
    if (isfinite(of.length)) { // a transient goes as e^(-x^(n + 1)), the curve as e^(-x^2n)
        const int n = order_at(&of.speed_bound, of.length);
        of.strip_ratio_beyond = 2.0 / (n + 1.0);
        of.strip_ratio = has_curve ? 1.0 / n : of.strip_ratio_beyond;
        const double least = 0x1p-40 * fc_max(h, fabs(time)); // rounding of the times
        of.length = fc_max(of.length, least);
        of.beyond = fc_max(of.beyond, least);
    }
    assert(of.length > 0.0 && of.length <= of.beyond && of.strip_ratio > 0.0 && of.strip_ratio <= 1.0);
    return of;
}

// The part of a velocity that rounding of the phase hides at a reversal: 450 eps, as in model/drive.c.
static const double ROUNDING_OF_V = 1e-13;

// The centers along a line, in and beside [0, h], in their order.
static int line_centers(const FcPlane* plane, double h, double tolerance, Center centers[MAX_CENTERS]) {
    const FcDrive* drive = &plane->scene->drive;
    int count = 0;
    // Behind the start, if |V| grows there.
    const FcVelocity now = fc_drive_velocity(drive, 0.0);
    const double behind = -fc_min(time_of_power(fabs(now.rate), 1, fabs(now.V)),
                                  time_of_power(0.5 * fabs(now.curvature), 2, fabs(now.V)));
    const bool is_reversal = fabs(now.V) <= ROUNDING_OF_V * (fabs(drive->V.value) + drive->vibration.V_1);
    const bool grows = now.V * now.rate > 0.0 || (now.rate == 0.0 && now.V * now.curvature > 0.0);
    if (is_reversal || (grows && behind > -h)) {
        centers[count++] = center_at(plane, is_reversal ? 0.0 : behind, 0.0, true, h, tolerance);
    }
    for (double t = 0.0; t < h && count < MAX_CENTERS;) {
        const double horizon = h + (h - t);
        const FcDriveEvent event = fc_drive_next_event(drive, t, horizon);
        if (!(event.time < horizon)) {
            break;
        }
        assert(count == 0 || centers[count - 1].time <= event.time);
        centers[count++] = center_at(plane, event.time, event.time, event.reversal, h, tolerance);
        t = event.time;
    }
    return count;
}

static int plane_centers(const FcPlane* plane, double h, double tolerance, Center centers[MAX_CENTERS]) {
    double times[MAX_CENTERS];
    const int found = minima(&plane->scene->drive, h, times);
    int count = 0;
    for (int i = 0; i < found; i++) {
        if (times[i] > -h && times[i] < 2.0 * h) {
            assert(count == 0 || centers[count - 1].time <= times[i]);
            centers[count++] = center_at(plane, times[i], times[i], false, h, tolerance);
        }
    }
    return count;
}

// ---- parts ----

// The part of the interval that is not worth a panel. Rounding of the middles and the minima: 4500 eps; of a reversal, which
// is a root: 64 eps.
static const double ROUNDING = 1e-12;
static const double SAME_TIME = 0x1p-46;

static FcPart part_of(double start, double end, const Center* center, bool is_beyond, int side) {
    assert(start < end && side >= -1 && side <= 1);
    const double length = is_beyond ? center->beyond : center->length;
    return (FcPart){.start = start,
                    .end = end,
                    .in = {isfinite(length) ? center->time : 0.0, length},
                    .side = side,
                    .strip_ratio = is_beyond ? center->strip_ratio_beyond : center->strip_ratio,
                    .speed_bound = center->speed_bound};
}

// The least share of a part that is a part of its own. Chosen: a shorter one costs a panel and resolves nothing.
static const double MIN_SHARE = 1e-3;

// A part on one side of its center, in two if a Stribeck curve ends in it.
static int add_part(FcPart parts[FC_MAX_PARTS], int count, double start, double end, const Center* center,
                    int side) {
    const bool is_ahead = center->time >= end;
    const double edge = is_ahead ? center->time - center->edge : center->time + center->edge;
    const double least = MIN_SHARE * (end - start);
    if (isfinite(center->length) && edge - start > least && end - edge > least) {
        parts[count++] = part_of(start, edge, center, is_ahead, side);
        parts[count++] = part_of(edge, end, center, !is_ahead, side);
    } else {
        parts[count++] = part_of(start, end, center, false, side);
    }
    return count;
}

// Without a variable of its own if the center is farther away than the gap lasts, or its layer is as long: the motion is
// smooth in t there, and u would round the times.
static Center seen_from_gap(const Center* center, double start, double end) {
    Center of = center ? *center : NONE;
    const double gap = end - start;
    if (!(of.length < gap) || fc_max(start - of.time, of.time - end) > gap) {
        of.length = of.beyond = of.edge = INFINITY;
    }
    of.beyond = of.beyond < gap ? of.beyond : INFINITY;
    return of;
}

// The parts between two centers, either of which may be missing: from each to the middle between both.
static int add_gap(const FcPlane* plane, FcPart parts[FC_MAX_PARTS], int count, double start, double end,
                   double h, const Center* before, const Center* after) {
    const Center left = seen_from_gap(before, start, end);
    const Center right = seen_from_gap(after, start, end);
    const double V = fc_drive_V(&plane->scene->drive, 0.5 * (start + end));
    const int side = plane->is_one_dimensional ? (V > 0.0) - (V < 0.0) : 0;
    double middle = isinf(right.length)  ? end
                    : isinf(left.length) ? start
                                         : fc_min(fc_max(0.5 * (left.time + right.time), start), end);
    middle = middle - start < ROUNDING * h ? start : end - middle < ROUNDING * h ? end : middle;
    assert(start <= middle && middle <= end);
    if (middle > start) {
        count = add_part(parts, count, start, middle, &left, side);
    }
    if (end > middle) {
        count = add_part(parts, count, middle, end, &right, side);
    }
    return count;
}

int fc_parts(const FcPlane* plane, double h, double tolerance, FcPart parts[FC_MAX_PARTS]) {
    assert(h > 0.0 && tolerance > 0.0);
    Center centers[MAX_CENTERS];
    const int found = plane->is_one_dimensional ? line_centers(plane, h, tolerance, centers)
                                                : plane_centers(plane, h, tolerance, centers);
    int count = 0;
    double start = 0.0;
    for (int i = 0; i <= found && start < h && count + 4 <= FC_MAX_PARTS; i++) {
        const bool has_after = i < found;
        const double end = has_after ? fc_min(fc_max(centers[i].time, start), h) : h;
        if (end - start > (plane->is_one_dimensional ? SAME_TIME : ROUNDING) * h) {
            assert(count == 0 || parts[count - 1].end == start); // parts tile the interval
            count = add_gap(plane, parts, count, start, end, h, i > 0 ? &centers[i - 1] : NULL,
                            has_after ? &centers[i] : NULL);
            start = end;
        }
    }
    if (count > 0) {
        parts[count - 1].end = h; // of rounding, and of more centers than there is room for
    }
    assert(count > 0 && count <= FC_MAX_PARTS && parts[0].start == 0.0);
    return count;
}
