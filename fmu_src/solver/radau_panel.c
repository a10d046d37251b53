#include "solver/radau_panel.h"

#include <assert.h>
#include <math.h>

#include "solver/nodes.h"
#include "solver/radau_tables.h"

// The lengths of the loops below are known only once the outer one is unrolled; then they become vector instructions.
#ifdef __clang__
#define UNROLL _Pragma("unroll")
#else
#define UNROLL _Pragma("GCC unroll 16")
#endif

// A row of the linear system for an odd number of stages n: the matrix, a pad, the two right-hand sides.
enum { WIDEST = FC_RADAU_MOST_STAGES + 3 };
typedef double StageSystem[FC_RADAU_MOST_STAGES][WIDEST] FC_PAIRED;

// Gaussian elimination without pivoting: the matrix is A^-1 plus a diagonal that is not negative. By pairs of columns; those
// left of the pivot may be touched, they are not read again.
FC_INLINE void solve(int n, StageSystem row) {
    UNROLL
    for (int k = 0; k < n; k++) {
        const double pivot = 1.0 / row[k][k];
        UNROLL
        for (int i = k + 1; i < n; i++) {
            const double factor = row[i][k] * pivot;
            UNROLL
            for (int j = (k + 1) & ~1; j < n + 3; j += 2) {
                fc_pair_put(&row[i][j], fc_pair(&row[i][j]) - factor * fc_pair(&row[k][j]));
            }
        }
        row[k][k] = pivot;
    }
    UNROLL
    for (int k = n - 1; k >= 0; k--) {
        const FcPair solved = row[k][k] * fc_pair(&row[k][n + 1]);
        fc_pair_put(&row[k][n + 1], solved);
        UNROLL
        for (int i = 0; i < k; i++) {
            fc_pair_put(&row[i][n + 1], fc_pair(&row[i][n + 1]) - row[i][k] * solved);
        }
    }
}

// x^(3 (n - 1) / 4): what is left of an error that is orthogonal to the polynomials of degree n - 2 when it is weighted
// with a function whose Legendre coefficients fall by x. Three quarters of that degree, since x is an estimate.
FC_INLINE double acting_part(int n, double x) {
    const double x_3 = x * x * x;
    return n == 5 ? x_3 : x_3 * x_3;
}

// The part of the slope that the collocation leaves unresolved and that acts on the end. at_start is its defect at the
// panel's start, where it is largest; the tail's own continuation counts where that happens to vanish.
FC_INLINE double unresolved(const FcRadauRule* rule, int n, const double* slope, double z) {
    const double at_start = fc_dot(n + 1, rule->start, slope);
    const FcTail tail = fc_tail_of(n + 1, rule->tail, slope);
    const double acts = fc_least(1.0, z / (z + 2.0 * n) + tail.fall);
    return fc_most(fabs(at_start), tail.top * tail.fall) * acting_part(n, acts);
}

FC_INLINE double quadrature_error(const FcRadauRule* rule, int n, const double* f) {
    const FcTail tail = fc_tail_of(n + 1, rule->tail, f);
    return fc_beyond_rounding(fc_largest(n, f), tail.top) * tail.fall * acting_part(n, tail.fall);
}

// What the mean over a panel sees of a defect at the most: it changes sign between the nodes.
static const double OF_THE_MEAN = 0.1;

FC_INLINE void panel_of(const FcRadauRule* rule, int n, const FcScene* scene, double t, double h, double sign,
                        const FcTrajectories* from, FcPanel* panel) {
    // Of the stages, and of the start after them.
    const int count = n + 1;
    FcNodeCoefficients at;
    fc_node_coefficients(scene, t, h, rule->node, count, &at);
    const double side = sign < 0.0 ? -1.0 : 1.0;
    double side_per_limit[FC_RADAU_MOST_STAGES + 1] FC_PAIRED;
    double z[FC_RADAU_MOST_STAGES + 1] FC_PAIRED;
    double P[FC_RADAU_MOST_STAGES + 1] FC_PAIRED;
    double Q[FC_RADAU_MOST_STAGES + 1] FC_PAIRED;
    double u[FC_RADAU_MOST_STAGES + 1] FC_PAIRED;
    double slope[FC_RADAU_MOST_STAGES + 1] FC_PAIRED;
    double f[FC_RADAU_MOST_STAGES + 1] FC_PAIRED;
    StageSystem row;
    for (int i = 0; i < count; i++) {
        // sign V and not |V|: V may be a rounding error past its reversal, and r must stay smooth there.
        side_per_limit[i] = side / at.limit[i];
        z[i] = h * at.V[i] * at.sigma[i] * side_per_limit[i];
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            row[i][j] = rule->inverse[i][j];
        }
        row[i][i] += z[i];
        row[i][n] = 0.0;
        row[i][n + 1] = -z[i];
        row[i][n + 2] = h * at.V[i];
    }
    solve(n, row);

    const int last = n - 1;
    for (int i = 0; i < n; i++) {
        P[i] = 1.0 + row[i][n + 1];
        Q[i] = row[i][n + 2];
        u[i] = from->delta_0 + (row[i][n + 1] * from->delta_0 + Q[i]);
    }
    P[n] = 1.0;
    Q[n] = 0.0;
    u[n] = from->delta_0;
    for (int i = 0; i < count; i++) {
        slope[i] = h * at.V[i] - z[i] * u[i];
    }
    panel->map = (FcMap){.relaxation = -row[last][n + 1], .offset = Q[last]};
    fc_panel_integrals(count, rule->weight, P, Q, z, at.V, at.sigma, h, &panel->map);
    panel->z = fc_dot(count, rule->weight, z);
    panel->displacement = h * fc_dot(count, rule->weight, at.V);
    panel->rate = z[last] / h;
    panel->sigma = at.sigma[last];
    panel->limit = at.limit[last];

    double error = unresolved(rule, n, slope, panel->z);
    fc_panel_force(count, &at, side_per_limit, side, from->speed, from->held, u, f);
    double mean_error = quadrature_error(rule, n, f);
    if (from->scale != 0.0) {
        for (int i = 0; i < count; i++) {
            slope[i] = -z[i] * P[i];
            u[i] = from->scale * P[i];
        }
        error += from->scale * unresolved(rule, n, slope, panel->z);
        fc_panel_force(count, &at, side_per_limit, side, from->speed, 0.0, u, f);
        mean_error += quadrature_error(rule, n, f);
    }
    // A defect is damped at the end by what relaxes there, inside by the least that does anywhere.
    const double whole = panel->z;
    const double z_last = fc_most(0.0, fc_least(z[last], whole));
    const double z_least = fc_most(fc_least(z_last, z[n]), fc_least(whole, sqrt(whole)));
    panel->end_error = panel->sigma * error / (1.0 + z_last);
    panel->mean_error = mean_error + OF_THE_MEAN * panel->sigma * error *
                                         fc_most(1.0 / (1.0 + z_least), rule->weight[last] / (1.0 + z_last));
}

void fc_radau_panel(const FcScene* scene, int stages, double t, double h, double sign,
                    const FcTrajectories* from, FcPanel* panel) {
    assert(h > 0.0);
    if (stages == 5) { // constants where panel_of is inlined
        panel_of(&FC_RADAU_5, 5, scene, t, h, sign, from, panel);
    } else {
        panel_of(&FC_RADAU_9, 9, scene, t, h, sign, from, panel);
    }
}
