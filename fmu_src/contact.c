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

ContactState contact_state(const ContactAtModulus* c, double d) {
    const double e = exp(-c->decay * d);
    return (ContactState){.sigma = c->constant ? c->stiffness_0 : c->stiffness_0 * (e * e) / (d * d * d),
                          .A_r = c->area_0 * e};
}

double contact_stiffness(const ContactAtModulus* c, double d) {
    return c->constant ? c->stiffness_0 : contact_state(c, d).sigma;
}

ContactGradient contact_area_gradient(const ContactParameters* p, double d, double E) {
    const ContactAtModulus at = contact_at_modulus(p, E);
    const double A_r = contact_state(&at, d).A_r;
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
    const ContactState now = contact_state(&at, d);
    const double area_by_E = contact_area_gradient(p, d, E).by_E;
    const double log_area_slope = now.A_r > 0.0 ? area_by_E / now.A_r : 0.0;
    return (ContactGradient){.by_d = -now.sigma * (2.0 * at.decay + 3.0 / d),
                             .by_E = now.sigma * (1.0 / E + 2.0 * log_area_slope)};
}
