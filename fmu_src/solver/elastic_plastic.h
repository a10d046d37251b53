// The elastic-plastic law (Prandtl, Jenkins): delta' = V while sigma |delta| < g, else the bristle slips along
// sigma |delta| = g until V turns back faster than the bound D = g / sigma moves. Exact, event by event.
//
// Over any interval delta becomes clamp(delta + x, lo, hi), x being the way: such maps compose. With held inputs a
// period is one of them, and its impulse, work and heat are known polynomials of delta as long as it touches no bound:
//
//     delta  hi  - - - - - - - - - - - .--.--.      a small mean velocity V makes the bristle creep by s = V / f a
//                              .  ' '               period, for a number of periods that is known at once; the
//                     .  ' '                        period that touches ends on hi, and so do all that follow
//         delta_0 ' '
//
// so a step over any number of periods costs what a few cost.
#ifndef FC_SOLVER_ELASTIC_PLASTIC_H
#define FC_SOLVER_ELASTIC_PLASTIC_H

#include "solver/solver.h"

// The step [0, h], h [s] >= 0, from delta_0 [m]; the error of force, mean and work is within the tolerance, times
// fc_scene_force_scale, and but rounding where nothing moves but V. Where it lies beyond the bound it is taken onto it at once, and what
// the bristle loses, sigma (delta_0^2 - D^2) / 2, is heat. Returns false, with *message filled and *result as it was,
// where the periods or the evaluations are too many.
bool fc_elastic_plastic_step(const FcScene* scene, double tolerance, double h, double delta_0,
                             FcStepResult* result, FcMessage* message);

// delta [m], taken onto the bound at the start of the scene where it lies beyond.
double fc_elastic_plastic_reached(const FcScene* scene, double delta);

// What delta_0 [m] tends to after infinitely many periods, without vibration after sliding for ever, with the inputs
// held where they are at the start of the scene. Where there is no bound, delta_0. Adds what it evaluates to
// *evaluations.
double fc_elastic_plastic_settled(const FcScene* scene, double tolerance, double delta_0,
                                  double* evaluations);

#endif
