#include "model/contact.h"

#include <assert.h>
#include <math.h>

#include "model/constants.h"

// omega_c [m], Eq. 13 with Eq. 12 and 14.
static double critical_interference(const FcContactParameters* p, double E) {
    const double C_v = 1.234 + 1.256 * p->nu;
    const double strain = FC_PI * C_v * (1.0 - p->nu * p->nu) * p->Y / (2.0 * E);
    return strain * strain * p->R;
}

FcContactAtModulus fc_contact_at_modulus(const FcContactParameters* p, double E) {
    assert(E > 0.0);
    const double x = p->lambda * critical_interference(p, E) / p->R_q;
    const double beta = p->eta * p->R * p->R_q;
    FcContactAtModulus at;
    at.area_0 = p->c * FC_PI * beta * p->A_n / (p->lambda * p->lambda) * (1.0 + exp(-x));
    at.decay = p->lambda / p->R_q;
    at.constant = p->model == FC_CONTACT_CONSTANT;
    at.stiffness_0 = at.constant ? p->sigma : p->stiffnessScale * E * at.area_0 * at.area_0;
    return at;
}

FcContactResponse fc_contact_response(const FcContactAtModulus* c, double d) {
    assert(d > 0.0);
    const double e = exp(-c->decay * d);
    return (FcContactResponse){.sigma = c->constant ? c->stiffness_0 : c->stiffness_0 * (e * e) / (d * d * d),
                               .A_r = c->area_0 * e};
}

double fc_contact_stiffness(const FcContactAtModulus* c, double d) {
    return c->constant ? c->stiffness_0 : fc_contact_response(c, d).sigma;
}

FcContactGradient fc_contact_area_gradient(const FcContactParameters* p, double d, double E) {
    const FcContactAtModulus at = fc_contact_at_modulus(p, E);
    const double A_r = fc_contact_response(&at, d).A_r;
    // x ~ E^-2, so d(1 + e^-x)/dE = 2 x e^-x / E.
    const double x = p->lambda * critical_interference(p, E) / p->R_q;
    const double e = exp(-x);
    const double log_slope = e > 0.0 ? 2.0 * x * e / ((1.0 + e) * E) : 0.0;
    return (FcContactGradient){.by_d = -at.decay * A_r, .by_E = A_r * log_slope};
}

FcContactGradient fc_contact_stiffness_gradient(const FcContactParameters* p, double d, double E) {
    if (p->model == FC_CONTACT_CONSTANT) {
        return (FcContactGradient){0.0, 0.0};
    }
    const FcContactAtModulus at = fc_contact_at_modulus(p, E);
    const FcContactResponse now = fc_contact_response(&at, d);
    const double area_by_E = fc_contact_area_gradient(p, d, E).by_E;
    const double log_area_slope = now.A_r > 0.0 ? area_by_E / now.A_r : 0.0;
    return (FcContactGradient){.by_d = -now.sigma * (2.0 * at.decay + 3.0 / d),
                               .by_E = now.sigma * (1.0 / E + 2.0 * log_area_slope)};
}
