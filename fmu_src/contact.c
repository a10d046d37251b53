#include "contact.h"

#include <math.h>

#include "constants.h"

// omega_c [m], Eq. 13 with Eq. 12 and 14.
static double critical_interference(const ContactParameters* p, double E) {
    const double C_v = 1.234 + 1.256 * p->nu;
    const double strain = FC_PI * C_v * (1.0 - p->nu * p->nu) * p->Y / (2.0 * E);
    return strain * strain * p->R;
}

ContactAtModulus contact_at_modulus(const ContactParameters* p, double E) {
    const double x = p->lambda * critical_interference(p, E) / p->R_q;
    const double beta = p->eta * p->R * p->R_q;
    ContactAtModulus at;
    at.area_0 = p->c * FC_PI * beta * p->A_n / (p->lambda * p->lambda) * (1.0 + exp(-x));
    at.decay = p->lambda / p->R_q;
    at.constant = p->model == CONTACT_CONSTANT;
    at.stiffness_0 = at.constant ? p->sigma : p->stiffnessScale * E * at.area_0 * at.area_0;
    return at;
}

double contact_area(const ContactAtModulus* c, double d) { return c->area_0 * exp(-c->decay * d); }

double contact_stiffness(const ContactAtModulus* c, double d) {
    if (c->constant) {
        return c->stiffness_0;
    }
    return c->stiffness_0 * exp(-2.0 * c->decay * d) / (d * d * d);
}

ContactGradient contact_area_gradient(const ContactParameters* p, double d, double E) {
    const ContactAtModulus at = contact_at_modulus(p, E);
    const double A_r = contact_area(&at, d);
    // x ~ E^-2, so d(1 + e^-x)/dE = 2 x e^-x / E.
    const double x = p->lambda * critical_interference(p, E) / p->R_q;
    const double e = exp(-x);
    const double log_slope = e > 0.0 ? 2.0 * x * e / ((1.0 + e) * E) : 0.0;
    return (ContactGradient){.by_d = -at.decay * A_r, .by_E = A_r * log_slope};
}

ContactGradient contact_stiffness_gradient(const ContactParameters* p, double d, double E) {
    if (p->model == CONTACT_CONSTANT) {
        return (ContactGradient){0.0, 0.0};
    }
    const ContactAtModulus at = contact_at_modulus(p, E);
    const double sigma = contact_stiffness(&at, d);
    const double A_r = contact_area(&at, d);
    const double area_by_E = contact_area_gradient(p, d, E).by_E;
    const double log_area_slope = A_r > 0.0 ? area_by_E / A_r : 0.0;
    return (ContactGradient){.by_d = -sigma * (2.0 * at.decay + 3.0 / d),
                             .by_E = sigma * (1.0 / E + 2.0 * log_area_slope)};
}
