// A stretch of an interval: the time between two events, on which V keeps its sign. An event is a reversal of
// V, which is a kink of |V|, or a dip of |V|. Panels shrink towards the events on both sides. The event ahead
// may lie beyond the end of the interval.
//
//        reversal                                        reversal
//     |V|   |.  '   '      '         '         '      '   '  .|
//           |-|--|----|--------|-----------|--------|----|--|-|      Radau panels
//            w_a                                            w_b      layers
//           |peak|               between                |peak|       sections, with a Stribeck curve
#ifndef FC_SOLVER_STRETCH_H
#define FC_SOLVER_STRETCH_H

#include <math.h>
#include <stdbool.h>

#include "solver/stretches/stribeck_peak.h"

typedef struct {
    const FcInterval* interval;
    double start, end;                           // s
    double event;                                // s, at or beyond the end; infinite if there is none
    bool reversal, starts_at_reversal;           // the event is one, and no dip
    FcPhase start_phase, end_phase, event_phase; // of the vibration
    double displacement;                         // m
    double path_after; // m, path from the end to the next event or the interval's end
    double per_path;   // 1/m, sigma / g at the interval's start: the relaxation on a path, about
    FcPeaks peaks;     // of the Stribeck curve
    // fc_stretch_add_layers sets the rest.
    double w_a, w_b; // s, layers at the start and at the event, in which the bristle relaxes by 1
    double back;     // s, from the start back to the event from which the panels grow
    FcCoefficients at_start, at_end; // at_end if there is an event
    double relaxes;                  // 1, the relaxation in the stretch, about; 0 if it is not known
} FcStretch;

// Goes through an interval stretch by stretch.
typedef struct {
    const FcInterval* interval;
    FcCoefficients start; // of the interval
    FcDriveEvent event;   // that ends the next stretch
    FcPhase end_phase, last_phase;
    double displacement;
    FcPeakEdge edge; // with a Stribeck curve
} FcStretches;

// Begins at the interval's start. *stretch becomes the stretch before the first one.
void fc_stretches_start(FcStretches* stretches, const FcInterval* interval, FcCoefficients start,
                        FcPhase start_phase, FcStretch* stretch);
// Replaces *stretch by the next stretch. No deflection is larger than `deflection` [m]. False at the
// interval's end.
bool fc_stretches_next(FcStretches* stretches, double deflection, FcStretch* stretch);

void fc_stretch_add_layers(FcStretch* stretch);

// The phase of the vibration at t [s] in the stretch.
FcPhase fc_stretch_phase(const FcStretch* stretch, double t);

// Displacement [m] of V between two times [s] in the stretch.
double fc_stretch_displacement(const FcStretch* stretch, double t, double end);

// Width [s] of the layer around a reversal, or a dip, at t, with sigma and g as they are near it: beyond the
// interval the inputs are not known.
double fc_event_layer(const FcScene* scene, bool reversal, double t, FcPhase at_t,
                      const FcCoefficients* near);

// Time [s] in which a bristle with the relaxation per_path [1/m], sigma / g, relaxes by 1 from that velocity
// on: about the least root of r x + r' x^2 / 2 = 1, r'' x^3 / 6 = 1 and r''' x^4 / 24 = 1. The last two count if V
// only touches zero, or crosses it in a saddle.
double fc_layer(const FcVelocity* at, double per_path);

// Distance [s] of the last event, a reversal or a dip.
double fc_distance_back(const FcVelocity* at);

#endif
