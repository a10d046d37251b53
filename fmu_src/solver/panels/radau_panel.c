#include "solver/panels/radau_panel.h"

#include <assert.h>
#include <math.h>

#include "solver/panels/nodes.h"
#include "solver/panels/panel_tables.h"
#include "solver/panels/radau_error.h"

// The lengths of the loops below are known only once the outer one is unrolled; then they become vector
// instructions.
#ifdef FC_NO_UNROLLING
#define UNROLL
#elif defined __clang__
#define UNROLL _Pragma("unroll")
#else
#define UNROLL _Pragma("GCC unroll 16")
#endif

// A row of the linear system: the matrix, a pad, the two right-hand sides. COUNT: the stages, and the start
// after them.
enum { STAGES = FC_RADAU_STAGES, COUNT = FC_RADAU_POINTS, WIDEST = STAGES + 3 };
typedef double StageSystem[STAGES][WIDEST] FC_PAIRED;

// Gaussian elimination without pivoting: the matrix is A^-1 plus a diagonal that is not negative. By pairs of
// columns; those left of the pivot may be touched, they are not read again.
FC_INLINE void solve(StageSystem row) {
    enum { n = STAGES };
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

FC_WITH_AVX void fc_radau_panel(const FcScene* scene, double t, double h, double sign,
                                const FcTrajectories* from, FcPanel* panel) {
    assert(h > 0.0);
    enum { n = STAGES, count = COUNT };
    const FcRadauRule* rule = &FC_RADAU_9;
    FcNodeCoefficients at;
    fc_node_coefficients(scene, t, h, rule->node, count, &at);
    const double side = sign < 0.0 ? -1.0 : 1.0;
    double side_per_limit[COUNT] FC_PAIRED;
    double z[COUNT] FC_PAIRED;
    double P[COUNT] FC_PAIRED;
    double Q[COUNT] FC_PAIRED;
    double u[COUNT] FC_PAIRED;
    double slope[COUNT] FC_PAIRED;
    double f[COUNT] FC_PAIRED;
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
    solve(row);

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
    fc_keep_nodes(from->keep, count, &at, P, Q);
    panel->map = (FcMap){.relaxation = -row[last][n + 1], .offset = Q[last]};
    fc_panel_integrals(count, rule->weight, P, Q, z, at.V, at.sigma, h, &panel->map);
    panel->z = fc_dot(count, rule->weight, z);
    panel->displacement = h * fc_dot(count, rule->weight, at.V);
    panel->rate = z[last] / h;
    panel->sigma = at.sigma[last];
    panel->limit = at.limit[last];

    double error = fc_radau_unresolved(slope, panel->z);
    fc_panel_force(count, &at, side_per_limit, side, from->speed, from->held, u, f);
    double mean_error = fc_radau_quadrature_error(f);
    if (from->scale != 0.0) {
        for (int i = 0; i < count; i++) {
            slope[i] = -z[i] * P[i];
            u[i] = from->scale * P[i];
        }
        error += from->scale * fc_radau_unresolved(slope, panel->z);
        fc_panel_force(count, &at, side_per_limit, side, from->speed, 0.0, u, f);
        mean_error += fc_radau_quadrature_error(f);
    }
    fc_radau_set_errors(panel, z[n], z[last], panel->sigma, error, mean_error);
}
