// Where in a stretch the Stribeck curve matters: near its ends, where |V| is small.
//
//     g / g_C
//     static |\            /|
//            | \          / |
//          1 |  '--------'  |
//            start          end of the stretch
//              after  before
//
// Beyond the bells the limit is Coulomb's but for what the tolerance does not see. A bell that is too narrow to be seen in it
// is left out, and one that is hardly seen is put back as what it does in closed form (solver/small_bell.h).
#ifndef FC_SOLVER_STRIBECK_BELL_H
#define FC_SOLVER_STRIBECK_BELL_H

#include <stdbool.h>

#include "model/scene.h"
#include "solver/small_bell.h"

// The scene without its Stribeck curve.
typedef struct {
    FcFriction friction;
    FcScene scene; // its friction is the one above
} FcSceneBeyondBells;
void fc_scene_beyond_bells(const FcScene* scene, FcSceneBeyondBells* beyond);

// Whether the curve is not seen by a force of up to `force` limits where |V| is at least the speed [m/s].
bool fc_is_beyond_bells(const FcFriction* friction, double speed, double force, double tolerance);

// What of an interval matters to its bells.
typedef struct {
    const FcScene* scene; // with a Stribeck curve
    double duration;      // s, that the mean is taken over
    double tolerance;     // 1
    double excess;        // 1, of static over Coulomb friction
    double per_path;      // 1/m, largest sigma / g
    double saturation;    // m, largest g / sigma: over this path errors fade by e at least
    double path;          // m, at the most
    FcBellShape shape;
    double fastest; // 1/s, that the phase and ln(sigma) move by; infinite if more than these and V moves
} FcBellInterval;
FcBellInterval fc_bell_interval(const FcScene* scene, double duration, double tolerance);

// One end of a stretch.
typedef struct {
    double t; // s
    FcVelocity at;
    double tau; // s, in which V moves by V_S
} FcBellEdge;
FcBellEdge fc_bell_edge(const FcScene* scene, double t);

// Bells at the start and at the end of a stretch: [start, after] and [before, end]. Without any, after = start and
// before = end; where |V| stays within one, after = end.
typedef struct {
    double after, before;              // s
    FcVelocity at_start, at_end;       // of the stretch
    double reach;                      // 1, |V| at their edges, over the Stribeck velocity
    double digits;                     // 1, decades by which a bell stands above a tenth of the tolerance
    bool small_at_start, small_at_end; // left out, but to be put back as what it does
} FcBells;
// For a deflection [m] at the start of at most that, the displacement [m] of the stretch, and the path [m] from its end to
// the next event or the interval's end.
FcBells fc_bells(const FcBellInterval* interval, const FcBellEdge* start, const FcBellEdge* end,
                 double deflection, double displacement, double path_after);

static inline bool fc_in_bell(const FcBells* bells, double t) {
    return t < bells->after || t >= bells->before;
}

#endif
