#include "solver/panels/gauss_panel.h"

#include <assert.h>
#include <math.h>

#include "solver/budget.h"
#include "solver/panels/gauss_rule.h"

FC_INLINE void panel_of(const FcGaussRule* rule, int n, const FcScene* scene, double t, double h,
                        const FcTrajectories* from, bool judged, FcPanel* panel) {
    FcNodeCoefficients at;
    fc_node_coefficients(scene, t, h, rule->node, n, &at);
    double side_per_limit[FC_GAUSS_MOST_NODES] FC_PAIRED;
    double z[FC_GAUSS_MOST_NODES] FC_PAIRED;
    double G[FC_GAUSS_MOST_NODES] FC_PAIRED;
    double grown[FC_GAUSS_MOST_NODES] FC_PAIRED; // e^G
    double source[FC_GAUSS_MOST_NODES] FC_PAIRED;
    double P[FC_GAUSS_MOST_NODES] FC_PAIRED;
    double Q[FC_GAUSS_MOST_NODES] FC_PAIRED;
    double u[FC_GAUSS_MOST_NODES] FC_PAIRED;
    double f[FC_GAUSS_MOST_NODES] FC_PAIRED;
    const double side = copysign(1.0, at.V[n / 2]);
    for (int i = 0; i < n; i++) {
        side_per_limit[i] = side / at.limit[i];
        z[i] = h * at.V[i] * at.sigma[i] * side_per_limit[i];
    }
    fc_gauss_integrate(rule, n, z, G);
    const double whole = fc_dot(n, rule->weight, z);
    fc_exponentials_less_1(n, G, whole, grown);
    for (int i = 0; i < n; i++) {
        grown[i] += 1.0;
        source[i] = h * at.V[i] * grown[i];
    }
    fc_gauss_integrate(rule, n, source, Q);
    for (int i = 0; i < n; i++) {
        P[i] = 1.0 / grown[i];
        Q[i] *= P[i];
        u[i] = P[i] * from->delta_0 + Q[i];
    }
    fc_keep_nodes(from->keep, n, &at, P, Q);
    const double relaxation = -expm1(-whole);
    panel->map =
        (FcMap){.relaxation = relaxation, .offset = (1.0 - relaxation) * fc_dot(n, rule->weight, source)};
    fc_panel_integrals(n, rule->weight, P, Q, z, at.V, at.sigma, h, &panel->map);
    panel->z = whole;
    panel->displacement = h * fc_dot(n, rule->weight, at.V);
    if (!judged) {
        return;
    }

    const double sigma = fc_most(at.sigma[0], fc_most(at.sigma[n / 2], at.sigma[n - 1]));
    panel->end_error =
        sigma * (1.0 - relaxation) *
        (fc_gauss_error(rule, n, source) + (fabs(from->delta_0) + from->scale) * fc_gauss_error(rule, n, z));
    fc_panel_force(n, &at, side_per_limit, side, from->speed, 0.0, u, f);
    panel->mean_error = fc_gauss_error(rule, n, f);
    if (from->scale != 0.0) {
        for (int i = 0; i < n; i++) {
            u[i] = from->scale * P[i];
        }
        fc_panel_force(n, &at, side_per_limit, side, from->speed, 0.0, u, f);
        panel->mean_error += fc_gauss_error(rule, n, f);
    }
}

FC_INLINE void panel_of_nodes(int count, const FcScene* scene, double t, double h, const FcTrajectories* from,
                              bool judged, FcPanel* panel) {
    assert(h > 0.0);
    switch (count) { // panel_of is inlined with a constant count
    case 4:
        panel_of(&FC_GAUSS_4, 4, scene, t, h, from, judged, panel);
        break;
    case 6:
        panel_of(&FC_GAUSS_6, 6, scene, t, h, from, judged, panel);
        break;
    case 8:
        panel_of(&FC_GAUSS_8, 8, scene, t, h, from, judged, panel);
        break;
    default:
        panel_of(&FC_GAUSS_12, 12, scene, t, h, from, judged, panel);
        break;
    }
}

FC_WITH_AVX void fc_gauss_panel(const FcScene* scene, double t, double h, int count,
                                const FcTrajectories* from, FcPanel* panel) {
    panel_of_nodes(count, scene, t, h, from, true, panel);
}

// n nodes, and the bound of K: its constant, and the factors of phi, mu, z and sqrt(z). Fitted by
// workshop.constants.panel_bound as the upper envelope of the errors that it measured. Its phi mu is mu here.
enum { BOUNDED_RULES = 4 };
static const struct {
    int n;
    double one, phi, mu, z, sqrt_z;
} BOUND[BOUNDED_RULES] = {
    {4, 3.30, 1.23, 1.34, 1.35, 1.03},
    {6, 3.49, 2.01, 1.80, 1.31, 2.15},
    {8, 4.55, 2.50, 1.99, 1.02, 3.41},
    {12, 10.44, 2.15, 2.48, 2.57, 0.17},
};

// x^2n
static double to_the_2n(double x, int n) {
    const double x_4 = x * x * (x * x);
    const double x_8 = x_4 * x_4;
    return n == 4 ? x_8 : n == 6 ? x_8 * x_4 : n == 8 ? x_8 * x_8 : x_8 * x_8 * x_8;
}

static double bound(const FcPace* pace, int rule, double h, double z) {
    assert(rule >= 0 && rule < BOUNDED_RULES && h > 0.0 && !(z < 0.0));
    const double phi = 0.5 * pace->phase * h;
    const double mu = 0.5 * pace->log_sigma * h;
    const double K = BOUND[rule].one + BOUND[rule].phi * phi + BOUND[rule].mu * mu + BOUND[rule].z * z +
                     BOUND[rule].sqrt_z * sqrt(z);
    return to_the_2n(K / (2.94 * BOUND[rule].n), BOUND[rule].n);
}

double fc_gauss_bound(const FcPace* pace, int nodes, double h, double z) {
    int rule = 0;
    while (BOUND[rule].n != nodes) {
        rule++;
    }
    return bound(pace, rule, h, z);
}

// The largest bound that is accepted. `force` is that of the largest deflection in the panel, of a bristle
// that settles at |X| / z. The heat goes with the square of a force beyond the limit.
static double allowed_bound(const FcInterval* interval, double X, double z, const FcTrajectories* from) {
    const double deflection = fabs(from->delta_0) + from->scale + fabs(X) / fc_most(1.0, z);
    const double force = interval->stiffness * deflection;
    const double damping = interval->scene->friction->sigma_1 * interval->speed;
    return FC_SHARE_OF_BOUNDED_PANEL * fc_allowed_force(interval) /
           (force * fc_most(1.0, force / interval->limit) + damping);
}

FC_WITH_AVX bool fc_bounded_panel(const FcInterval* interval, const FcScene* scene, double t, double h,
                                  double X, double z, const FcTrajectories* from, FcPanel* panel,
                                  double* evaluations) {
    if (z > FC_MOST_BOUNDED) {
        return false;
    }
    const double allowed = allowed_bound(interval, X, z, from);
    int rule = 0;
    while (!(bound(&interval->pace, rule, h, z) <= allowed)) {
        if (++rule == BOUNDED_RULES) {
            return false;
        }
    }
    panel_of_nodes(BOUND[rule].n, scene, t, h, from, false, panel);
    panel->nodes = BOUND[rule].n;
    *evaluations += BOUND[rule].n;
    // The displacement is known. A bristle that forgets little would sum up the errors of its quadrature.
    panel->map.offset += (1.0 - panel->map.relaxation) * (X - panel->displacement);
    return panel->z <= z || (panel->z <= FC_MOST_BOUNDED && bound(&interval->pace, rule, h, panel->z) <=
                                                                allowed_bound(interval, X, z, from));
}
