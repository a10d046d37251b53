// What a bell of the Stribeck curve does to a bristle that relaxes little in it, in closed form.
//
// With u = |V| / V_S the curve w = e^-u^2 takes from what the bristle relaxes, on one side of a reversal,
//
//     J = integral of sigma |V| (1 / g_C - 1 / g) dt = V_S^2 / g_C * integral of (sigma / |V'|) u f(u) du,
//     f = excess w / (1 + excess w)
//
// and u f integrates to ln(staticRatio) / 2. What sigma / |V'| does meanwhile is told by two points of equal weight that have
// the mean and the variance of u under u f. So a bell is left out of the stretch, and where it was the deflection grows by J.
#ifndef FC_SOLVER_SMALL_BELL_H
#define FC_SOLVER_SMALL_BELL_H

#include <stdbool.h>

#include "model/scene.h"
#include "solver/affine_map.h"

// What the static over the Coulomb friction makes of u under u f.
typedef struct {
    double log_ratio; // 1
    double mean;      // 1
    double deviation; // 1
    bool is_known;
} FcBellShape;
FcBellShape fc_bell_shape(double staticRatio);

// At a reversal, where V = 0, on its side after (1) or before (-1).
typedef struct {
    double tau;     // s, in which V moves by V_S
    double bend;    // 1, by how much V' changes in tau away from the reversal
    double turn;    // 1, the same of that change
    double changes; // 1, by how much V' and ln(sigma) do in tau, at the most
} FcSmallBellPlace;
// fastest [1/s] is what the phase and ln(sigma) move by at the most.
FcSmallBellPlace fc_small_bell_place(const FcScene* scene, const FcVelocity* at, double side, double fastest);

// What its closed form misses, at the most, of a force of up to `force` limits; sigma |delta| is one up to it.
typedef struct {
    double lasts;   // 1, of the force, over the limit
    double impulse; // s, over the limit
    double work;    // m, and heat, over the limit
} FcSmallBellError;
// per_path [1/m] is the largest sigma / g, damping sigma_1 V_S over the limit.
FcSmallBellError fc_small_bell_error(const FcSmallBellPlace* place, const FcBellShape* shape, double V_S,
                                     double per_path, double force, double damping);

// What the bell does at the reversal at t [s]. sign is that of V on this side.
FcMap fc_small_bell(const FcScene* scene, const FcBellShape* shape, const FcSmallBellPlace* place, double t,
                    double side, double sign);

#endif
