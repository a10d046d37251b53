// Where in a stretch the Stribeck curve matters: near its ends, where |V| is small.
//
//     g / g_C
//     static |\            /|
//            | \          / |
//          1 |  '--------'  |
//            start          end of the stretch
//              after  before
//
// Beyond the bells the limit is Coulomb's but for what the tolerance does not see, and a bell that is too narrow to be
// seen in it is left out.
#ifndef FC_SOLVER_STRIBECK_BELL_H
#define FC_SOLVER_STRIBECK_BELL_H

#include <stdbool.h>

#include "model/scene.h"

// The scene without its Stribeck curve.
typedef struct {
    FcFriction friction;
    FcScene scene; // its friction is the one above
} FcSceneBeyondBells;
void fc_scene_beyond_bells(const FcScene* scene, FcSceneBeyondBells* beyond);

// What is known of a stretch before it is crossed.
typedef struct {
    double start, end; // s
    double interval;   // s, that the mean is taken over
    double tolerance;  // 1
    double deflection; // m, at the start, at the most
    double path_after; // m, from its end to the next event or the end of the interval
} FcBellStretch;

// Bells at the start and at the end: [start, after] and [before, end]. Without any, after = start and before = end; where
// |V| stays within one, after = end.
typedef struct {
    double after, before; // s
} FcBells;
// The scene has a Stribeck curve.
FcBells fc_bells(const FcScene* scene, const FcBellStretch* stretch);

static inline bool fc_in_bell(const FcBells* bells, double t) {
    return t < bells->after || t >= bells->before;
}

#endif
