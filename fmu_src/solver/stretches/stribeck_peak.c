#include "solver/stretches/stribeck_peak.h"

#include <assert.h>
#include <math.h>

#include "solver/budget.h"
#include "solver/panels/panel.h"

// The largest number of times that a width estimated too short grows, by half each time: to 4e5 times in all.
// Then the peak takes the whole stretch. Half as many would stop at 7e2 times.
enum { MOST_GROWTHS = 32 };

bool fc_is_beyond_peaks(const FcFriction* friction, double speed, double force, double tolerance) {
    assert(!(speed < 0.0 || force < 0.0));
    if (!fc_has_stribeck_curve(friction)) {
        return true;
    }
    const double excess = friction->staticRatio - 1.0;
    const double most = fc_most(1.0 + excess, force);
    const double ratio = speed / friction->V_S;
    return excess * most * most * exp(-ratio * ratio) <= FC_SHARE_BEYOND_PEAK * tolerance;
}

FcPeakEdge fc_peak_edge(const FcScene* scene, double t) {
    const FcVelocity at = fc_drive_velocity(&scene->drive, t);
    return (FcPeakEdge){.t = t, .at = at, .tau = fc_velocity_time_of_change(&at, scene->friction->V_S)};
}

// Width [s] of the peak from the edge to the side (1 or -1). The peak ends when |V| is the reach [m/s].
static double width(const FcDrive* drive, const FcPeakEdge* edge, double side, double reach, double most) {
    const double V = fabs(edge->at.V);
    if (V >= reach) {
        return 0.0;
    }
    double x = fc_velocity_time_of_change(&edge->at, reach - V);
    for (int i = 0; x < most && i < MOST_GROWTHS; i++) {
        if (fabs(fc_drive_V(drive, edge->t + side * x)) >= reach) {
            return x;
        }
        x *= 1.5;
    }
    return most;
}

// |V| over V_S beyond which a bristle does not see the rest of the curve, excess e^(-(V / V_S)^2). Its force
// is up to `force` limits, and it relaxes by `forgets`, up to 1, until the event after next. While V passes
// the peak the bristle relaxes by dz at most. The force then differs by that part of the excess, and the
// differences add up until they are forgotten. The heat sigma r delta^2 goes with 1 / g: the part of it in
// the peak counts at once.
static double reach(const FcInterval* interval, double force, double forgets, const FcPeakEdge* edge) {
    const FcFriction* friction = interval->scene->friction;
    const double through = friction->V_S * edge->tau; // m
    const double dz = fc_least(interval->stiffness / interval->limit * through, 1.0);
    const double heat = fc_least(through / (interval->speed * interval->duration), 1.0);
    const double part = fc_most(fc_least(dz / forgets, 1.0), force * heat);
    const double seen = (friction->staticRatio - 1.0) * fc_most(1.0, force) * part;
    return sqrt(log(fc_most(1.0, seen / (FC_SHARE_BEYOND_PEAK * interval->tolerance))));
}

// Whether |V| may fall below the speed between the edges. Minima that are not events lie above half of |V| +
// V_1.
static bool may_dip_inside(const FcDrive* drive, double start, double end, double speed) {
    const double V_1 = drive->vibration.V_1;
    const double V_start = drive->V.value + drive->V.rate * start;
    const double V_end = drive->V.value + drive->V.rate * end;
    return fabs(drive->V.rate) < V_1 * drive->omega && speed > 0.5 * (fmin(fabs(V_start), fabs(V_end)) + V_1);
}

FcPeaks fc_peaks(const FcInterval* interval, const FcPeakEdge* start, const FcPeakEdge* end,
                 double deflection, double displacement, double path_after) {
    const FcDrive* drive = &interval->scene->drive;
    const FcFriction* friction = interval->scene->friction;
    assert(fc_has_stribeck_curve(friction) && start->t <= end->t);
    const double path = fabs(displacement);
    const double per_path = interval->stiffness / interval->limit;
    const double force =
        fc_most(per_path * deflection, fc_least(friction->staticRatio, per_path * (deflection + path)));
    const double forgets = fc_least((path + path_after) / interval->saturation, 1.0);
    const double after = reach(interval, force, forgets, start);
    const double before = reach(interval, force, forgets, end);
    const double widest = fc_most(after, before);
    FcPeaks peaks = {.after = end->t,
                     .before = end->t,
                     .tau = start->tau,
                     .reach = widest,
                     .digits = log10(10.0 * FC_SHARE_BEYOND_PEAK) + 0.4343 * widest * widest};
    if (may_dip_inside(drive, start->t, end->t, widest * friction->V_S)) {
        return peaks;
    }
    const double length = end->t - start->t;
    const double inner_start = start->t + width(drive, start, 1.0, after * friction->V_S, length);
    const double inner_end = end->t - width(drive, end, -1.0, before * friction->V_S, length);
    if (inner_start < inner_end) {
        peaks.after = inner_start;
        peaks.before = inner_end;
    }
    assert(start->t <= peaks.after && peaks.after <= peaks.before && peaks.before <= end->t);
    return peaks;
}
