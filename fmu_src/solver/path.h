// How far the surfaces have slid since a moment a: the way of a stuck bristle.
//
//     x(t) = integral of V from a to t = V(a) s + V' s^2/2 + (V_1/omega) [cos(theta_a) (sin z - z) - sin(theta_a) (1 - cos z)]
//     s = t - a,  z = omega s
//
// V(a) stands in it as a whole and what is left are functions that vanish like z^3 and z^2, so x keeps its digits
// however short the way is, also from a reversal on, where V(a) is zero while V and V_1 are not.
#ifndef FC_SOLVER_PATH_H
#define FC_SOLVER_PATH_H

#include "model/scene.h"

typedef struct {
    double start;                // s, a
    double V;                    // m/s, V(a), vibration included
    double V_rate;               // m/s2, V', of the input alone
    double omega;                // rad/s
    double V_1;                  // m/s
    double cos_theta, sin_theta; // of the vibration at a
} FcPath;

FcPath fc_path_from(const FcScene* scene, double start);

double fc_path_at(const FcPath* path, double t); // m, x(t)
double fc_path_at_phase(const FcPath* path, double t,
                        double sin_theta);             // the same, the sine of theta(t) given
double fc_path_integral(const FcPath* path, double t); // m s, integral of x from a to t

#endif
