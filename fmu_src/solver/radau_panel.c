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

// A row of the linear system: the matrix, the two right-hand sides, a pad to an even length.
enum { WIDEST = FC_RADAU_MOST_STAGES + 3 };
typedef double StageSystem[FC_RADAU_MOST_STAGES][WIDEST] __attribute__((aligned(16)));

// Gaussian elimination without pivoting: the matrix is A^-1 plus a diagonal that is not negative. Columns left of the
// pivot are touched where that keeps pairs aligned; they are not read again.
FC_INLINE void solve(int n, StageSystem row) {
    UNROLL
    for (int k = 0; k < n; k++) {
        const double pivot = 1.0 / row[k][k];
        UNROLL
        for (int i = k + 1; i < n; i++) {
            const double factor = row[i][k] * pivot;
            UNROLL
            for (int j = (k + 1) & ~1; j < n + 3; j += 2) {
                row[i][j] -= factor * row[k][j];
                row[i][j + 1] -= factor * row[k][j + 1];
            }
        }
        row[k][k] = pivot;
    }
    UNROLL
    for (int k = n - 1; k >= 0; k--) {
        row[k][n] *= row[k][k];
        row[k][n + 1] *= row[k][k];
        UNROLL
        for (int i = 0; i < k; i++) {
            row[i][n] -= row[i][k] * row[k][n];
            row[i][n + 1] -= row[i][k] * row[k][n + 1];
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
FC_INLINE double unresolved(const FcRadauRule* rule, int n, const double* slope, double at_start, double z) {
    const FcTail tail = fc_tail_of(n, &rule->tail[0][0], FC_RADAU_MOST_STAGES, slope);
    const double acts = fc_least(1.0, z / (z + 2.0 * n) + tail.fall);
    return fc_most(fabs(at_start), tail.top * tail.fall) * acting_part(n, acts);
}

FC_INLINE double quadrature_error(const FcRadauRule* rule, int n, const double* f) {
    const FcTail tail = fc_tail_of(n, &rule->tail[0][0], FC_RADAU_MOST_STAGES, f);
    return fc_beyond_rounding(fc_largest(n, f), tail.top) * tail.fall * acting_part(n, tail.fall);
}

// What the mean over a panel sees of a defect at the most: it changes sign between the nodes.
static const double OF_THE_MEAN = 0.1;

// even: the number of nodes evaluated. The one after the stages is the panel's start.
FC_INLINE void panel_of(const FcRadauRule* rule, int n, int even, const FcScene* scene, double t, double h,
                        double sign, const FcTrajectories* from, FcPanel* panel) {
    FcNodeCoefficients at;
    fc_node_coefficients(scene, t, h, rule->node, even, &at);
    double z[FC_RADAU_MOST_STAGES + 1];
    StageSystem row;
    for (int i = 0; i <= n; i++) {
        // sign V and not |V|: V may be a rounding error past its reversal, and r must stay smooth there.
        z[i] = h * at.V[i] * at.sigma[i] * (sign / at.limit[i]);
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            row[i][j] = rule->inverse[i][j];
        }
        row[i][i] += z[i];
        row[i][n] = -z[i];
        row[i][n + 1] = h * at.V[i];
        row[i][n + 2] = 0.0;
    }
    solve(n, row);

    double P[FC_RADAU_MOST_STAGES];
    double Q[FC_RADAU_MOST_STAGES];
    double u[FC_RADAU_MOST_STAGES];
    double slope[FC_RADAU_MOST_STAGES];
    double f[FC_RADAU_MOST_STAGES];
    const int last = n - 1;
    for (int i = 0; i < n; i++) {
        P[i] = 1.0 + row[i][n];
        Q[i] = row[i][n + 1];
        u[i] = from->delta_0 + (row[i][n] * from->delta_0 + Q[i]);
        slope[i] = h * at.V[i] - z[i] * u[i];
    }
    panel->map = (FcMap){.relaxation = -row[last][n], .offset = Q[last]};
    fc_panel_integrals(n, rule->weight, P, Q, z, at.V, at.sigma, h, &panel->map);
    panel->z = fc_dot(n, rule->weight, z);
    panel->displacement = h * fc_dot(n, rule->weight, at.V);
    panel->rate = z[last] / h;
    panel->sigma = at.sigma[last];
    panel->limit = at.limit[last];

    const double slope_at_start = h * at.V[n] - z[n] * from->delta_0;
    double error = unresolved(rule, n, slope, fc_dot(n, rule->start, slope) - slope_at_start, panel->z);
    const double side = sign < 0.0 ? -1.0 : 1.0;
    fc_panel_force(n, &at, side, from->speed, from->held, u, f);
    double mean_error = quadrature_error(rule, n, f);
    if (from->scale != 0.0) {
        for (int i = 0; i < n; i++) {
            slope[i] = -z[i] * P[i];
            u[i] = from->scale * P[i];
        }
        error += from->scale * unresolved(rule, n, slope, fc_dot(n, rule->start, slope) + z[n], panel->z);
        fc_panel_force(n, &at, side, from->speed, 0.0, u, f);
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
        panel_of(&FC_RADAU_5, 5, 6, scene, t, h, sign, from, panel);
    } else {
        panel_of(&FC_RADAU_9, 9, 10, scene, t, h, sign, from, panel);
    }
}
