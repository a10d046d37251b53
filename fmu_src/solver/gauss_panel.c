#include "solver/gauss_panel.h"

#include <assert.h>
#include <math.h>

#include "solver/gauss_rule.h"

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
    switch (count) { // constants where panel_of is inlined
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

void fc_gauss_panel(const FcScene* scene, double t, double h, int count, const FcTrajectories* from,
                    FcPanel* panel) {
    panel_of_nodes(count, scene, t, h, from, true, panel);
}

void fc_gauss_panel_unjudged(const FcScene* scene, double t, double h, int count, const FcTrajectories* from,
                             FcPanel* panel) {
    panel_of_nodes(count, scene, t, h, from, false, panel);
}
