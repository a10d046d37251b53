#include "model/contact.h"

#include <assert.h>
#include <math.h>

#include "model/pi.h"
#include "model/special.h"

// p_m [Pa], Eq. 12 with Eq. 14.
static double yield_pressure(const FcContactParameters* p) {
    const double C_v = 1.234 + 1.256 * p->nu;
    return C_v * (1.0 - p->nu * p->nu) * p->Y;
}

// x = lambda omega_c / R_q, Eq. 13.
static double relative_critical_interference(const FcContactParameters* p, double E) {
    const double strain = FC_PI * yield_pressure(p) / (2.0 * E);
    return p->lambda * (strain * strain * p->R) / p->R_q;
}

static double asperities(const FcContactParameters* p) { return p->eta * p->A_n * p->c; }

// The elastic and the plastic term of F_n, or of Mindlin's stiffness, at d = 0.
typedef struct {
    double elastic;
    double plastic;
} Parts;

static Parts load_parts(const FcContactParameters* p, double E, double x) {
    const double lambda_2 = p->lambda * p->lambda;
    return (Parts){
        .elastic = asperities(p) * 4.0 / 3.0 * E * sqrt(p->R) * p->R_q * sqrt(p->R_q) /
                   (lambda_2 * sqrt(p->lambda)) * fc_lower_gamma_5_2(x),
        .plastic = asperities(p) * FC_PI * p->R * p->R_q * yield_pressure(p) / lambda_2 * (2.0 + x) * exp(-x),
    };
}

// Stiffness of the sum of all asperity contacts over the sum of their radii [Pa].
static double mindlin_factor(const FcContactParameters* p, double E) {
    return asperities(p) * 2.0 * E * (2.0 * (1.0 - p->nu) / (2.0 - p->nu));
}

static Parts radius_parts(const FcContactParameters* p, double x) {
    const double size = sqrt(p->R * p->R_q);
    const double half = 2.0 / p->lambda;
    return (Parts){
        .elastic = size * fc_lower_gamma_3_2(x) / (p->lambda * sqrt(p->lambda)),
        .plastic = size * 0.5 * half * sqrt(half) * exp(-0.5 * x) * fc_upper_gamma_3_2(0.5 * x),
    };
}

FcContactAtModulus fc_contact_at_modulus(const FcContactParameters* p, double E) {
    assert(!(E <= 0.0)); // NaN passes
    const double x = relative_critical_interference(p, E);
    const double beta = p->eta * p->R * p->R_q;
    const Parts load = load_parts(p, E, x);
    FcContactAtModulus at = {.model = p->model};
    at.decay = p->lambda / p->R_q;
    at.area_0 = p->c * FC_PI * beta * p->A_n / (p->lambda * p->lambda) * (1.0 + exp(-x));
    at.load_0 = load.elastic + load.plastic;
    if (p->model == FC_CONTACT_CONSTANT) {
        at.stiffness_0 = p->sigma;
    } else if (p->model == FC_CONTACT_MINDLIN) {
        const Parts radius = radius_parts(p, x);
        at.stiffness_0 = p->stiffnessScale * mindlin_factor(p, E) * (radius.elastic + radius.plastic);
    } else {
        at.stiffness_0 = p->stiffnessScale * E * at.area_0 * at.area_0; // Eq. 3
    }
    assert(!(at.decay <= 0.0 || at.area_0 < 0.0 || at.load_0 < 0.0 || at.stiffness_0 < 0.0));
    return at;
}

// A vibration may pull the surfaces apart without end. The floor keeps sigma, its ratio to F_n and their squares numbers; it
// is far below the 1e-100 N at which a contact opens (scene.c).
static const double FARTHEST = 0x1p-465; // 1e-140

double fc_contact_decayed(const FcContactAtModulus* c, double d) {
    const double e = exp(-c->decay * d);
    return e < FARTHEST ? FARTHEST : e; // NaN passes
}

static double stiffness(const FcContactAtModulus* c, double d, double e) {
    assert(!(e <= 0.0));
    switch (c->model) {
    case FC_CONTACT_CONSTANT:
        return c->stiffness_0;
    case FC_CONTACT_MINDLIN:
        return c->stiffness_0 * e;
    default:
        return c->stiffness_0 * (e * e) / (d * d * d);
    }
}

FcContactResponse fc_contact_response(const FcContactAtModulus* c, double d) {
    assert(!(d <= 0.0) || (d == 0.0 && c->model == FC_CONTACT_CONSTANT)); // NaN passes
    const double e = fc_contact_decayed(c, d);
    return (FcContactResponse){.sigma = stiffness(c, d, e), .A_r = c->area_0 * e, .F_n = c->load_0 * e};
}

double fc_contact_stiffness(const FcContactAtModulus* c, double d) {
    return c->model == FC_CONTACT_CONSTANT ? c->stiffness_0 : stiffness(c, d, fc_contact_decayed(c, d));
}

FcContactLogSlope fc_contact_slope_by_d(const FcContactAtModulus* c, double d) {
    assert(!(d <= 0.0));
    const double sigma = c->model == FC_CONTACT_CONSTANT  ? 0.0
                         : c->model == FC_CONTACT_MINDLIN ? -c->decay
                                                          : -(2.0 * c->decay + 3.0 / d);
    assert(!(sigma > 0.0)); // it falls with the separation
    return (FcContactLogSlope){.sigma = sigma, .A_r = -c->decay, .F_n = -c->decay};
}

// x ~ E^-2, so dx/dE = -2 x / E.
FcContactLogSlope fc_contact_slope_by_E(const FcContactParameters* p, double E) {
    assert(!(E <= 0.0));
    const double x = relative_critical_interference(p, E);
    const double e = exp(-x);
    FcContactLogSlope slope = {.A_r = 2.0 * x * e / ((1.0 + e) * E)};

    const Parts load = load_parts(p, E, x);
    // d(E gamma(5/2, x))/dE = gamma - 2 x^(5/2) e^-x; d((2 + x) e^-x)/dE = 2 x (1 + x) e^-x / E
    const double gamma = fc_lower_gamma_5_2(x);
    const double elastic = gamma > 0.0 ? load.elastic * (1.0 - 2.0 * x * x * sqrt(x) * e / gamma) : 0.0;
    const double plastic = load.plastic * 2.0 * x * (1.0 + x) / (2.0 + x);
    const double sum = load.elastic + load.plastic;
    slope.F_n = sum > 0.0 ? (elastic + plastic) / (sum * E) : 0.0;

    if (p->model == FC_CONTACT_ASPERITIES) {
        slope.sigma = 1.0 / E + 2.0 * slope.A_r;
    } else if (p->model == FC_CONTACT_MINDLIN) {
        // d(elastic)/dx = boundary; d(plastic)/dx = -(plastic + boundary) / 2
        const Parts radius = radius_parts(p, x);
        const double boundary = sqrt(p->R * p->R_q * x) * e / (p->lambda * sqrt(p->lambda));
        const double total = radius.elastic + radius.plastic;
        slope.sigma = (1.0 + (total > 0.0 ? x * (radius.plastic - boundary) / total : 0.0)) / E;
    }
    assert(!(slope.A_r < 0.0 || fabs(slope.F_n) * E > 2.0 ||
             fabs(slope.sigma) * E > 2.2)); // as interval.c takes them
    return slope;
}

double fc_contact_log_swell(const FcContactAtModulus* c, double a_d) {
    assert(!(a_d < 0.0));
    return fc_log_bessel_I0(c->decay * a_d);
}
