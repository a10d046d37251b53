// Real contact area and tangential stiffness of two rough surfaces pressed to a separation d.
//
// Asperity heights s (over R_q) have the density c exp(-lambda s); each asperity is elastic up to the
// critical interference omega_c and plastic beyond it (Eq. 3, 12-14, 20-22 of the paper, with the misprints of
// Eq. 17 and 20 corrected):
//
//     C_v     = 1.234 + 1.256 nu
//     omega_c = (pi C_v (1 - nu^2) Y / (2 E))^2 R              x = lambda omega_c / R_q
//     A_r     = (c pi eta R R_q A_n / lambda^2) (1 + e^-x) e^(-lambda d / R_q)
//     sigma   = stiffnessScale E A_r^2 / d^3
//
// Everything here is a pure function of its arguments and never fails for valid ones.
#ifndef FC_MODEL_CONTACT_H
#define FC_MODEL_CONTACT_H

#include <stdbool.h>

typedef enum { FC_CONTACT_ASPERITIES = 1, FC_CONTACT_CONSTANT = 2 } FcContactModel;

typedef struct {
    int model;             // FcContactModel
    double sigma;          // N/m   stiffness when model is FC_CONTACT_CONSTANT
    double stiffnessScale; // 1     factor on the asperity stiffness
    double R_q;            // m     standard deviation of the asperity heights
    double R;              // m     mean radius of the asperity summits
    double eta;            // 1/m2  asperities per area
    double A_n;            // m2    nominal contact area
    double nu;             // 1     Poisson's ratio of the softer body
    double Y;              // Pa    yield strength of the softer body
    double c;              // 1     height density c exp(-lambda s)
    double lambda;         // 1
} FcContactParameters;

// The contact at one combined modulus E: what remains to be computed depends on d alone.
//     A_r = area_0 e^(-decay d)        sigma = stiffness_0 (e^(-decay d))^2 / d^3     (or stiffness_0 if constant)
typedef struct {
    double area_0;      // m2
    double stiffness_0; // N m2 with asperities, N/m when constant
    double decay;       // 1/m
    bool constant;      // stiffness does not depend on d
} FcContactAtModulus;

typedef struct {
    double sigma; // N/m
    double A_r;   // m2
} FcContactResponse;

// Partial derivatives of one quantity q with respect to the separation and the modulus.
typedef struct {
    double by_d; // [q]/m
    double by_E; // [q]/Pa
} FcContactGradient;

// E [Pa] > 0.
FcContactAtModulus fc_contact_at_modulus(const FcContactParameters* p, double E);

// At separation d [m] > 0: both, or the stiffness sigma [N/m] alone.
FcContactResponse fc_contact_response(const FcContactAtModulus* c, double d);
double fc_contact_stiffness(const FcContactAtModulus* c, double d);

// Exact derivatives of sigma and A_r at d [m] > 0 and E [Pa] > 0.
FcContactGradient fc_contact_stiffness_gradient(const FcContactParameters* p, double d, double E);
FcContactGradient fc_contact_area_gradient(const FcContactParameters* p, double d, double E);

#endif
