// The scene of one communication step: a contact, what drives it, and the bristle whose force resists (Eq. 1, 2).
//
//     F_t = sigma(t) delta,      delta' = a(t) delta + V(t),      a = -sigma(t) |V(t)| / F_C
//
// delta [m] is the state; F_t [N] is positive when it resists positive V.
#ifndef FC_MODEL_SCENE_H
#define FC_MODEL_SCENE_H

#include <math.h>

#include "model/contact.h"
#include "model/drive.h"

typedef struct {
    const FcContactParameters* contact;
    FcContactAtModulus at_E; // contact at the modulus of the start of the step
    FcDrive drive;
    double F_C; // N
} FcScene;

// What Eq. 2 needs at one moment.
typedef struct {
    double V;     // m/s
    double sigma; // N/m
    double limit; // N, F_C
} FcCoefficients;

// a of the head of this file [1/s].
static inline double fc_coefficients_rate(const FcCoefficients* at) {
    return -at->sigma * fabs(at->V) / at->limit;
}

// Keeps the pointer to the parameters of the contact.
FcScene fc_scene_make(const FcContactParameters* contact, const FcDrive* drive, double F_C);

// sigma and A_r at the local time t [s]; sigma [N/m] alone; an upper bound of sigma [N/m] over [0, h].
FcContactResponse fc_scene_contact(const FcScene* scene, double t);
double fc_scene_stiffness(const FcScene* scene, double t);
FcCoefficients fc_scene_coefficients(const FcScene* scene, double t);
double fc_scene_log_stiffness_rate(const FcScene* scene, double t); // d ln(sigma) / dt [1/s]
double fc_scene_largest_stiffness(const FcScene* scene, double h);

#endif
