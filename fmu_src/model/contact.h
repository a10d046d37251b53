// Two rough surfaces pressed to a separation d: real contact area, normal force, tangential stiffness.
//
// Asperity heights s (over R_q) have the density c exp(-lambda s). Each asperity is elastic up to the
// critical interference omega_c and plastic beyond it (Eq. 3-22 of the paper, with the misprints of Eq. 9, 17
// and 20 corrected):
//
//     C_v     = 1.234 + 1.256 nu                  p_m = C_v (1 - nu^2) Y
//     omega_c = (pi p_m / (2 E))^2 R              x = lambda omega_c / R_q          N = eta A_n c
//     A_r     = (pi R R_q N / lambda^2) (1 + e^-x) e^(-lambda d / R_q)                                (Eq. 20-22)
//     F_n     = N [4/3 E R^1/2 R_q^3/2 gamma(5/2, x) / lambda^5/2
//                  + pi R R_q p_m (2 + x) e^-x / lambda^2] e^(-lambda d / R_q)                        (Eq. 9, 16 summed)
//
// The stiffness is one of
//
//     Asperities    stiffnessScale E A_r^2 / d^3                                                      (Eq. 3)
//     Mindlin       stiffnessScale N 2 E [2 (1 - nu) / (2 - nu)] (R R_q)^1/2 [gamma(3/2, x) / lambda^3/2
//                   + 1/2 (2 / lambda)^3/2 e^(-x/2) Gamma(3/2, x/2)] e^(-lambda d / R_q)
//     Constant      contact.sigma
//
// Mindlin's is the sum over the asperities of a tangential stiffness 2 E [2 (1 - nu) / (2 - nu)] times the
// contact's radius: (R omega)^1/2 while it is elastic, (R (2 omega - omega_c))^1/2 beyond.
//
// Everything here is a pure function of its arguments and never fails for valid ones.
#ifndef FC_MODEL_CONTACT_H
#define FC_MODEL_CONTACT_H

// The values of modelDescription.xml.
typedef enum { FC_CONTACT_ASPERITIES = 1, FC_CONTACT_CONSTANT = 2, FC_CONTACT_MINDLIN = 3 } FcContactModel;
typedef enum { FC_CONTACT_SEPARATION = 1, FC_CONTACT_LOAD = 2 } FcContactInput;

typedef struct {
    int model;             // FcContactModel
    int input;             // FcContactInput: the separation is given, or the load
    double sigma;          // N/m   stiffness when model is FC_CONTACT_CONSTANT
    double stiffnessScale; // 1     factor on the other stiffnesses
    double R_q;            // m     standard deviation of the asperity heights
    double R;              // m     mean radius of the asperity summits
    double eta;            // 1/m2  asperities per area
    double A_n;            // m2    nominal contact area
    double nu;             // 1     Poisson's ratio of the softer body
    double Y;              // Pa    yield strength of the softer body
    double c;              // 1     height density c exp(-lambda s)
    double lambda;         // 1
} FcContactParameters;

// The contact at one combined modulus E. The rest depends on d alone, with e = e^(-decay d).
//     A_r = area_0 e        F_n = load_0 e        sigma = stiffness_0 e^2 / d^3, stiffness_0 e or stiffness_0
typedef struct {
    int model;          // FcContactModel
    double decay;       // 1/m
    double area_0;      // m2
    double load_0;      // N
    double stiffness_0; // N m2 with asperities, else N/m
} FcContactAtModulus;

typedef struct {
    double sigma; // N/m
    double A_r;   // m2
    double F_n;   // N
} FcContactResponse;

// Partial derivatives of ln(sigma), ln(A_r) and ln(F_n) with respect to the separation or the modulus.
typedef struct {
    double sigma; // 1/m or 1/Pa
    double A_r;
    double F_n;
} FcContactLogSlope;

// E [Pa] > 0.
FcContactAtModulus fc_contact_at_modulus(const FcContactParameters* p, double E);

// e^(-decay d), the factor of F_n and A_r; at least 1e-140, at which a contact is open.
double fc_contact_decayed(const FcContactAtModulus* c, double d);

// At the separation d [m] > 0: all values, or the stiffness sigma [N/m] alone. An open contact of constant
// stiffness may have d = 0. Then only its stiffness is valid.
FcContactResponse fc_contact_response(const FcContactAtModulus* c, double d);
double fc_contact_stiffness(const FcContactAtModulus* c, double d);

// Exact, at d [m] > 0 and E [Pa] > 0.
FcContactLogSlope fc_contact_slope_by_d(const FcContactAtModulus* c, double d);
FcContactLogSlope fc_contact_slope_by_E(const FcContactParameters* p, double E);

// ln of the factor by which a vibration of the separation by a_d [m] >= 0 raises the mean of F_n: ln
// I_0(decay a_d).
double fc_contact_log_swell(const FcContactAtModulus* c, double a_d);

#endif
