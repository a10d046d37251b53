// The Dahl bristle (Eq. 1, 2): state delta [m], force F_t = sigma delta [N], positive when it resists positive V.
//
//     d(delta)/dt = a(t) delta + b(t),     a = -sigma(t) |V(t)| / F_C,     b = V(t)
//
// The equation is affine in delta, so any interval is an affine map of the deflection at its start, and so are the
// impulse of the force and its work over the interval. Maps compose; n equal intervals are the n-th power of one.
#ifndef FC_DAHL_H
#define FC_DAHL_H

#include "contact.h"
#include "drive.h"

typedef struct {
    const ContactParameters* contact;
    ContactAtModulus at_E; // contact at the modulus of the start of the step
    Drive drive;
    double F_C; // N
} DahlProblem;

// Keeps the pointer to the parameters of the contact.
DahlProblem dahl_problem(const ContactParameters* contact, const Drive* drive, double F_C);

// sigma and A_r at the local time t [s]; sigma [N/m] alone; an upper bound of sigma [N/m] over [0, h].
ContactState dahl_contact_state(const DahlProblem* problem, double t);
double dahl_stiffness(const DahlProblem* problem, double t);
typedef struct {
    double V;     // m/s
    double sigma; // N/m
} DahlCoefficients;
DahlCoefficients dahl_coefficients(const DahlProblem* problem, double t);
double dahl_log_stiffness_rate(const DahlProblem* problem, double t); // d ln(sigma) / dt [1/s]
double dahl_largest_stiffness(const DahlProblem* problem, double h);

typedef struct {
    double relaxation;     // 1      delta_1 = (1 - relaxation) delta_0 + offset
    double offset;         // m
    double impulse_slope;  // N s/m  integral F dt   = impulse_slope delta_0 + impulse_offset
    double impulse_offset; // N s
    double work_slope;     // N      integral F V dt = work_slope delta_0 + work_offset
    double work_offset;    // J
} DahlMap;

DahlMap dahl_identity(void);
DahlMap dahl_compose(const DahlMap* first, const DahlMap* second);
DahlMap dahl_power(const DahlMap* one, double n); // n a non-negative whole number

// One interval without reversal of constant V, d, E: exact for any duration h [s] >= 0.
DahlMap dahl_constant_map(double V, double sigma, double F_C, double h);

#endif
