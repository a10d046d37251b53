// The parts of a stretch in which the Stribeck curve matters: peaks near its ends, with a small |V|.
//
//     g / g_C
//     static |\            /|
//            | \          / |
//          1 |  '--------'  |
//            start          end of the stretch
//              after  before
//
// Beyond the peaks the limit is Coulomb's, within the tolerance. No panel steps into a peak.
#ifndef FC_SOLVER_STRIBECK_PEAK_H
#define FC_SOLVER_STRIBECK_PEAK_H

#include <stdbool.h>

#include "solver/interval.h"

// Whether a force of up to `force` limits does not see the curve while |V| is at least the speed [m/s].
bool fc_is_beyond_peaks(const FcFriction* friction, double speed, double force, double tolerance);

// One end of a stretch.
typedef struct {
    double t; // s
    FcVelocity at;
    double tau; // s, in which V moves by V_S
} FcPeakEdge;
FcPeakEdge fc_peak_edge(const FcScene* scene, double t);

// Peaks at the start and at the end of a stretch: [start, after] and [before, end]. Without any, after =
// start and before = end. If |V| stays within one, after = end.
typedef struct {
    double after, before; // s
    double tau;           // s, of the edge at the start
    double reach;         // 1, |V| at their inner edges, over the Stribeck velocity
    double digits;        // 1, decades by which a peak stands above a tenth of the tolerance
} FcPeaks;

static inline FcPeaks fc_no_peaks(double start, double end) {
    return (FcPeaks){.after = start, .before = end};
}

// deflection [m] is the largest at the start, displacement [m] that of the stretch, and path_after [m] the
// path from its end to the next event or the interval's end. The scene must have a Stribeck curve.
FcPeaks fc_peaks(const FcInterval* interval, const FcPeakEdge* start, const FcPeakEdge* end,
                 double deflection, double displacement, double path_after);

static inline bool fc_in_peak(const FcPeaks* peaks, double t) {
    return t < peaks->after || t >= peaks->before;
}

#endif
