// The bound of a bristle and the state machine of its slip:
//
//     from          to            when
//     free          slipping      it meets its static bound and is pushed; it drops to the kinetic one (fc_drop_heat)
//     slipping      free          its push ends: it unloads
//     slipping      catching up   an input jumps and raises the bound of a bristle with static friction
//     catching up   slipping      it meets its kinetic bound
//     catching up   free          its push ends
//
// The bound D is g / sigma: in ElasticPlastic with the static limit while the bristle is free and the kinetic one once it has
// broken away, in LuGre with the static limit. The push is the velocity at which the bristle would leave its bound outwards
// (consistency: the bristle slips while the push is above 0).
#ifndef FC_MODEL_BOUND_H
#define FC_MODEL_BOUND_H

#include "model/plane.h"
#include "model/scene.h"

// A bristle beside its bound at the start of a scene.
typedef struct {
    FcPlane plane;
    FcPlaneCoefficients at;
    FcPlaneBound bound;
    FcVector n; // the direction of the deflection, or that in which it slips along a line
} FcAtBound;
// The result points into itself.
void fc_at_bound(FcAtBound* of, const FcScene* scene, FcBristle bristle);

// The part of its static bound by which a stuck bristle may exceed it without breaking away. Chosen
// empirically: a few times the rounding of a bound and of the length of a deflection. A larger value delays
// break-away.
#define FC_ROUNDING_OF_BOUND 1e-12

// The part of its bound by which a slipping bristle may lie inside it. Chosen empirically: rounding of the
// phase may take the bristle off its bound at the end of a step. A larger value would move a bristle that
// catches up onto its bound.
#define FC_INSIDE_BOUND 1e-10

// The return mapping at the start of the scene: a bristle beyond its bound is moved onto it, a bristle without contact
// becomes 0, and a slipping bristle that is not pushed sticks.
FcBristle fc_project_onto_bound(const FcScene* scene, FcBristle bristle);

// A slipping bristle, moved onto its bound at the start of the scene. If the load falls by decades in a step,
// the bound at its end is known to fewer digits from its start.
FcBristle fc_scale_onto_bound(const FcScene* scene, FcBristle bristle);

// The heat of break-away [J], of a drop from |delta| = size [m] to the bound D [m], at the stiffness sigma [N/m]: the elastic
// energy that goes.
static inline double fc_drop_heat(double sigma, double size, double D) {
    return 0.5 * sigma * (size - D) * (size + D);
}

// The state of a bristle that is within its bound: it slips if it lies on the bound and is pushed. With static friction it has
// broken away before.
FcBristleState fc_bristle_state(const FcScene* scene, FcBristle bristle);

// The same at an event, at which a push of 0 has ended a slip.
FcBristleState fc_bristle_state_at_event(const FcScene* scene, FcBristle bristle);

// The indicators of the events that end a state at the start of a scene, above 0 before the event: z[0] a bristle meets its
// bound, z[1] a bristle that slips or catches up is no longer pushed. 1 if there is no such event.
void fc_bound_indicators(const FcScene* scene, FcBristle bristle, double z[2]);

// The push at the start, at any distance from the bound: in the direction of the deflection, or along a line in
// that in which the bristle slips.
double fc_push(const FcScene* scene, FcBristle bristle);

#endif
