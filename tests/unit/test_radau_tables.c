// The tables of the 9-stage Radau IIA method against their definition: every entry is the nearest double.
//
// With P_n the Legendre polynomials, x = 2 c - 1 and l_j the polynomial of degree 9 that is 1 at c_j and 0 at the
// other nodes and at 0:
//     nodes           P_8(x) = P_9(x)
//     weights         w_j = c_j / (9 P_8(x_j))^2                          (Gauss-Radau)
//     inverse of A    (A^-1)_ij = l_j'(c_i)                               (collocation: u' at the nodes from u there)
//     Legendre tail   T_kj = (2 m + 1) w_j P_m(x_j),  m = 8 - k           (the quadrature is exact to degree 16)
// and, which is how a Runge-Kutta method is defined by collocation,
//     sum_j (A^-1)_ij c_j^(k+1) / (k+1) = c_i^k    k = 0 .. 8             (sum_j A_ij c_j^k = c_i^(k+1) / (k+1))
//     sum_j w_j c_j^k = 1 / (k+1)                  k = 0 .. 16            (order 17)
//
// In long double; where that is no longer than double there is nothing to compare with, and the test is skipped.
#include "solver/radau_tables.h"

#include <float.h>

#include "check.h"

enum { N = 9 };

// Half a unit in the last place of a double, and what the formulas lose in long double.
static const long double ROUNDING = 0x1p-53L;
static const long double OF_FORMULAS = 300.0L * LDBL_EPSILON;

static long double power(long double x, int k) {
    long double result = 1.0L;
    for (; k > 0; k--) {
        result *= x;
    }
    return result;
}

static long double legendre(int n, long double x) {
    long double p = 1.0L, next = x;
    for (int m = 1; m <= n; m++) {
        const long double after =
            ((long double)(2 * m + 1) * x * next - (long double)m * p) / (long double)(m + 1);
        p = next;
        next = after;
    }
    return p;
}

static long double node[N];   // to the digits of long double
static long double weight[N]; // the same

static long double difference(long double c) {
    return legendre(N - 1, 2.0L * c - 1.0L) - legendre(N, 2.0L * c - 1.0L);
}

// Secants from the table's node and a neighbour 1e-9 away.
static long double root_near(long double c) {
    long double before = c * (1.0L - 1e-9L);
    for (int i = 0; i < 6 && difference(c) != difference(before); i++) {
        const long double next = c - difference(c) * (c - before) / (difference(c) - difference(before));
        before = c;
        c = next;
    }
    return c;
}

static void check_nearest(double entry, long double right) {
    CHECK_WITHIN((double)((long double)entry - right), 0.0,
                 (double)(fabsl(right) * (ROUNDING + OF_FORMULAS)));
}

static void nodes_are_roots(void) {
    for (int j = 0; j < N; j++) {
        node[j] = j == N - 1 ? 1.0L : root_near((long double)FC_RADAU_NODES[j]);
        check_nearest(FC_RADAU_NODES[j], node[j]);
        CHECK(j == 0 ? FC_RADAU_NODES[0] > 0.0 : FC_RADAU_NODES[j] > FC_RADAU_NODES[j - 1] + 0.01);
    }
}

static void weights_are_those_of_radau(void) {
    for (int j = 0; j < N; j++) {
        weight[j] = node[j] / power(N * legendre(N - 1, 2.0L * node[j] - 1.0L), 2);
        check_nearest(FC_RADAU_WEIGHTS[j], weight[j]);
    }
}

// l_j'(c_i), of nodes 0, c_0 .. c_8.
static long double lagrange_slope(int j, int i) {
    long double slope = 0.0L;
    if (i == j) {
        slope = 1.0L / node[i];
        for (int k = 0; k < N; k++) {
            slope += k != i ? 1.0L / (node[i] - node[k]) : 0.0L;
        }
        return slope;
    }
    slope = node[i] / node[j] / (node[j] - node[i]);
    for (int k = 0; k < N; k++) {
        slope *= k != i && k != j ? (node[i] - node[k]) / (node[j] - node[k]) : 1.0L;
    }
    return slope;
}

static void inverse_differentiates(void) {
    for (int i = 0; i < N; i++) {
        for (int j = 0; j < N; j++) {
            check_nearest(FC_RADAU_INVERSE[i][j], lagrange_slope(j, i));
        }
    }
}

static void tail_gives_legendre_coefficients(void) {
    for (int k = 0; k < 4; k++) {
        const int m = N - 1 - k;
        for (int j = 0; j < N; j++) {
            check_nearest(FC_RADAU_LEGENDRE_TAIL[k][j],
                          (long double)(2 * m + 1) * weight[j] * legendre(m, 2.0L * node[j] - 1.0L));
        }
    }
}

// The sums are off by the rounding of their terms' two factors, and by nothing more.
static void collocation_conditions(void) {
    for (int i = 0; i < N; i++) {
        for (int k = 0; k < N; k++) {
            long double sum = 0.0L, size = 0.0L;
            for (int j = 0; j < N; j++) {
                const long double term =
                    (long double)FC_RADAU_INVERSE[i][j] * power(node[j], k + 1) / (k + 1);
                sum += term;
                size += fabsl(term);
            }
            CHECK_WITHIN((double)(sum - power(node[i], k)), 0.0, (double)(size * (ROUNDING + OF_FORMULAS)));
        }
    }
}

static void weights_integrate_polynomials(void) {
    for (int k = 0; k <= 2 * N - 2; k++) {
        long double sum = 0.0L;
        for (int j = 0; j < N; j++) {
            sum += (long double)FC_RADAU_WEIGHTS[j] * power(node[j], k);
        }
        CHECK_WITHIN((double)(sum * (k + 1) - 1.0L), 0.0, (double)(ROUNDING + OF_FORMULAS));
    }
}

int main(void) {
    if (LDBL_EPSILON > 1e-3 * DBL_EPSILON) {
        return 77;
    }
    nodes_are_roots();
    weights_are_those_of_radau();
    inverse_differentiates();
    tail_gives_legendre_coefficients();
    collocation_conditions();
    weights_integrate_polynomials();
    return check_result();
}
