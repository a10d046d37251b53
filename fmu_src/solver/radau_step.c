#include "solver/radau_step.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "solver/nodes.h"
#include "solver/radau_tables.h"

_Static_assert((int)FC_RADAU_STAGES == (int)FC_NODE_COUNT,
               "the coefficients are computed at the stages' nodes");

static void evaluate(const FcScene* scene, double t, double h, double sign, FcRadauStep* step) {
    step->z_mean = 0.0;
    FcNodeCoefficients at;
    fc_node_coefficients(scene, t, h, FC_RADAU_NODES, &at);
    step->saturation = at.limit[FC_RADAU_STAGES - 1] / at.sigma[FC_RADAU_STAGES - 1];
    for (int i = 0; i < FC_RADAU_STAGES; i++) {
        step->sigma[i] = at.sigma[i];
        step->shift[i] = h * at.V[i];
        // sign V and not |V|: V may be a rounding error past its reversal, and g must stay smooth there.
        step->z[i] = step->shift[i] * at.sigma[i] * (sign / at.limit[i]);
        step->z_mean += FC_RADAU_WEIGHTS[i] * step->z[i];
    }
}

// The lengths of these loops are known only once the outer one is unrolled; then they run twice as fast.
#ifdef __clang__
#define UNROLL _Pragma("unroll")
#else
#define UNROLL _Pragma("GCC unroll 16")
#endif

// The linear system of the stages with its two right-hand sides, which come first in each row.
enum { RELAXED = 0, DRIVEN = 1, MATRIX = 2, WIDTH = MATRIX + FC_RADAU_STAGES };
typedef double StageSystem[FC_RADAU_STAGES][WIDTH];

// Gaussian elimination without pivoting: the matrix is A^-1 plus a diagonal that is not negative.
static void solve(StageSystem row) {
    UNROLL
    for (int k = 0; k < FC_RADAU_STAGES; k++) {
        const double pivot = 1.0 / row[k][MATRIX + k];
        row[k][MATRIX + k] = pivot;
        UNROLL
        for (int i = k + 1; i < FC_RADAU_STAGES; i++) {
            const double factor = row[i][MATRIX + k] * pivot;
            row[i][RELAXED] -= factor * row[k][RELAXED];
            row[i][DRIVEN] -= factor * row[k][DRIVEN];
            UNROLL
            for (int j = MATRIX + k + 1; j < WIDTH; j++) {
                row[i][j] -= factor * row[k][j];
            }
        }
    }
    UNROLL
    for (int k = FC_RADAU_STAGES - 1; k >= 0; k--) {
        row[k][RELAXED] *= row[k][MATRIX + k];
        row[k][DRIVEN] *= row[k][MATRIX + k];
        UNROLL
        for (int i = 0; i < k; i++) {
            row[i][RELAXED] -= row[i][MATRIX + k] * row[k][RELAXED];
            row[i][DRIVEN] -= row[i][MATRIX + k] * row[k][DRIVEN];
        }
    }
}

void fc_radau_step(const FcScene* scene, double t, double h, double sign, FcRadauStep* step) {
    assert(h > 0.0);
    evaluate(scene, t, h, sign, step);
    StageSystem row;
    for (int i = 0; i < FC_RADAU_STAGES; i++) {
        memcpy(&row[i][MATRIX], FC_RADAU_INVERSE[i], sizeof FC_RADAU_INVERSE[i]);
        row[i][MATRIX + i] += step->z[i];
        row[i][RELAXED] = -step->z[i];
        row[i][DRIVEN] = step->shift[i];
    }
    solve(row);
    for (int i = 0; i < FC_RADAU_STAGES; i++) {
        step->relaxed[i] = row[i][RELAXED];
        step->driven[i] = row[i][DRIVEN];
    }
}

// Quadratures over the stages; with u = P u_0 + Q there,
//     F = sigma u,   F V,   u' V = (V - r u) V,   F (V - u') = sigma r u^2.
FcMap fc_radau_map(const FcRadauStep* step, double h) {
    FcMap map = {.relaxation = -step->relaxed[FC_RADAU_STAGES - 1],
                 .offset = step->driven[FC_RADAU_STAGES - 1]};
    for (int i = 0; i < FC_RADAU_STAGES; i++) {
        const double P = 1.0 + step->relaxed[i];
        const double Q = step->driven[i];
        const double z = step->z[i];
        const double V = step->shift[i] / h;
        const double F = FC_RADAU_WEIGHTS[i] * step->sigma[i];
        map.impulse_slope += F * P;
        map.impulse_offset += F * Q;
        map.work_slope += F * P * step->shift[i];
        map.work_offset += F * Q * step->shift[i];
        map.drag_slope -= FC_RADAU_WEIGHTS[i] * z * P * V;
        map.drag_offset += FC_RADAU_WEIGHTS[i] * (step->shift[i] - z * Q) * V;
        map.heat_square += F * z * P * P;
        map.heat_slope += 2.0 * F * z * P * Q;
        map.heat_offset += F * z * Q * Q;
    }
    map.impulse_slope *= h;
    map.impulse_offset *= h;
    return map;
}

static FcRadauTail tail_of(const double slope[FC_RADAU_STAGES]) {
    FcRadauTail tail;
    for (int k = 0; k < FC_RADAU_TAIL; k++) {
        double sum = 0.0;
        for (int i = 0; i < FC_RADAU_STAGES; i++) {
            sum += FC_RADAU_LEGENDRE_TAIL[k][i] * slope[i];
        }
        tail.coefficient[k] = fabs(sum);
    }
    return tail;
}

FcRadauTail fc_radau_tail_homogeneous(const FcRadauStep* step, double u_0) {
    double slope[FC_RADAU_STAGES];
    for (int i = 0; i < FC_RADAU_STAGES; i++) {
        slope[i] = -step->z[i] * (1.0 + step->relaxed[i]) * u_0;
    }
    return tail_of(slope);
}

FcRadauTail fc_radau_tail_full(const FcRadauStep* step, double u_0) {
    double slope[FC_RADAU_STAGES];
    for (int i = 0; i < FC_RADAU_STAGES; i++) {
        slope[i] = step->shift[i] - step->z[i] * ((1.0 + step->relaxed[i]) * u_0 + step->driven[i]);
    }
    return tail_of(slope);
}

// Legendre coefficient of degree 8, over 17, of e^(-z (1 - x)) on [0, 1]: e^(-z/2) i_8(z/2), i_n the modified
// spherical Bessel function; the larger of its expansions at small and at large z, right within a factor of 2.
static double weight_of_the_defect(double z) {
    enum { N = FC_RADAU_STAGES - 1 };
    const double double_factorial = 34459425.0; // 17!!
    const double x = 0.5 * z;
    if (x <= 0.0) {
        return 0.0;
    }
    const double x_2 = x * x;
    const double x_4 = x_2 * x_2;
    const double small = x < 20.0 ? x_4 * x_4 * exp(-x) / double_factorial * (1.0 + x_2 / (4 * N + 6)) : 0.0;
    const double large = x > 2.0 ? exp(-N * (N + 1) / (2.0 * x)) / (2.0 * x) : 0.0;
    return fmax(small, large);
}

// The collocation polynomial's defect is about (next Legendre coefficient) (P_9 - P_8), which is orthogonal to
// polynomials of degree 7. The error at the end is the defect weighted with e^-G, G the remaining relaxation: only
// the parts of e^-G and of the defect's own variation beyond degree 7 count.
double fc_radau_error(const FcRadauTail* tail, double z_mean) {
    const double none = 1e-300;
    const double* c = tail->coefficient;
    double decay = c[0] / (c[1] + none); // the slowest fall over one, two and three degrees
    const double two_degrees = fmax(c[0] / (c[2] + none), c[1] / (c[3] + none));
    if (two_degrees > decay * decay) {
        decay = sqrt(two_degrees);
    }
    const double three_degrees = c[0] / (c[3] + none);
    if (three_degrees > decay * decay * decay) {
        decay = cbrt(three_degrees);
    }
    decay = fmin(decay, 1.0);
    const double defect = decay * fmax(c[0], decay * fmax(c[1], decay * c[2]));
    const double decay_2 = decay * decay;
    const double decay_4 = decay_2 * decay_2;
    return defect * (weight_of_the_defect(z_mean) + decay_4 * decay_4 / (1.0 + z_mean));
}
