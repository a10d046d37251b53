// The tables of the panels against their definition: every entry is the nearest double.
//
// With P_n the Legendre polynomials, x = 2 c - 1, the nodes c_j on [0, 1] and l_j the polynomial of degree n - 1 that is 1
// at c_j and 0 at the other nodes:
//     nodes           Gauss: P_n(x) = 0       Radau: P_n(x) = P_(n-1)(x)     (the tables hold c - 1/2)
//     weights         Gauss: w_j = 1 / ((1 - x_j^2) P_n'(x_j)^2)       Radau: w_j = c_j / (n P_(n-1)(x_j))^2
//     start           l_j(0)
//     inverse of A    (A^-1)_ij = m_j'(c_i), m_j of degree n, 0 at 0 too     (collocation: u' at the nodes from u there)
//     integral        sum over the degrees k of T_kj times the integral of P_k up to c_i,
//                     which is (P_(k+1)(x_i) - P_(k-1)(x_i)) / (2 (2 k + 1))
//     Legendre tail   T_kj = (2 k + 1) w_j P_k(x_j)                          (the quadrature is exact to degree 2 n - 2)
// and, which is how a Runge-Kutta method is defined by collocation,
//     sum_j (A^-1)_ij c_j^(k+1) / (k+1) = c_i^k     k = 0 .. n - 1
//     sum_j w_j c_j^k = 1 / (k+1)                   k = 0 .. 2 n - 2 (Radau), 2 n - 1 (Gauss)
//
// In long double; where that is no longer than double there is nothing to compare with, and the test is skipped.
#include <float.h>

#include "check.h"
#include "solver/panels/panel_tables.h"

enum { MOST = 12 };

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

// To the digits of long double, of the rule under test.
static int n;
static bool is_radau;
static long double node[MOST];
static long double weight[MOST];

static long double zero_at_nodes(long double c) {
    const long double x = 2.0L * c - 1.0L;
    return is_radau ? legendre(n - 1, x) - legendre(n, x) : legendre(n, x);
}

// Secants from the table's node and a neighbour 1e-9 away.
static long double root_near(long double c) {
    long double before = c * (1.0L - 1e-9L);
    for (int i = 0; i < 6 && zero_at_nodes(c) != zero_at_nodes(before); i++) {
        const long double next =
            c - zero_at_nodes(c) * (c - before) / (zero_at_nodes(c) - zero_at_nodes(before));
        before = c;
        c = next;
    }
    return c;
}

// Nearest to right, which the formula gives to size times its rounding.
static void check_nearest_to(double entry, long double right, long double size) {
    CHECK_WITHIN((double)((long double)entry - right), 0.0,
                 (double)(fabsl(right) * ROUNDING + size * OF_FORMULAS));
}

static void check_nearest(double entry, long double right) { check_nearest_to(entry, right, fabsl(right)); }

static void check_nodes(const double* centred) {
    for (int j = 0; j < n; j++) {
        const bool is_end = is_radau && j == n - 1;
        node[j] = is_end ? 1.0L : root_near(0.5L + (long double)centred[j]);
        check_nearest_to(centred[j], node[j] - 0.5L, 1.0L);
        CHECK(j == 0 ? node[0] > 0.0L : node[j] > node[j - 1] + 0.01L);
    }
}

static void check_weights(const double* entry) {
    for (int j = 0; j < n; j++) {
        const long double x = 2.0L * node[j] - 1.0L;
        if (is_radau) {
            weight[j] = node[j] / power((long double)n * legendre(n - 1, x), 2);
        } else { // (1 - x^2) P_n' = n P_(n-1) at the nodes
            weight[j] = (1.0L - x * x) / power((long double)n * legendre(n - 1, x), 2);
        }
        check_nearest(entry[j], weight[j]);
    }
}

// l_j(0).
static void check_start(const double* entry) {
    for (int j = 0; j < n; j++) {
        long double value = 1.0L;
        for (int k = 0; k < n; k++) {
            value *= k != j ? node[k] / (node[k] - node[j]) : 1.0L;
        }
        check_nearest(entry[j], value);
    }
}

// m_j'(c_i), of the nodes 0, c_0 .. c_(n-1).
static long double lagrange_slope(int j, int i) {
    long double slope = 0.0L;
    if (i == j) {
        slope = 1.0L / node[i];
        for (int k = 0; k < n; k++) {
            slope += k != i ? 1.0L / (node[i] - node[k]) : 0.0L;
        }
        return slope;
    }
    slope = node[i] / node[j] / (node[j] - node[i]);
    for (int k = 0; k < n; k++) {
        slope *= k != i && k != j ? (node[i] - node[k]) / (node[j] - node[k]) : 1.0L;
    }
    return slope;
}

static void check_inverse(const double inverse[9][10]) {
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            check_nearest(inverse[i][j], lagrange_slope(j, i));
        }
        // The sums are off by the rounding of their terms' two factors, and by nothing more.
        for (int k = 0; k < n; k++) {
            long double sum = 0.0L, size = 0.0L;
            for (int j = 0; j < n; j++) {
                const long double term = (long double)inverse[i][j] * power(node[j], k + 1) / (k + 1);
                sum += term;
                size += fabsl(term);
            }
            CHECK_WITHIN((double)(sum - power(node[i], k)), 0.0, (double)(size * (ROUNDING + OF_FORMULAS)));
        }
    }
}

static long double tail(int degree, int j) {
    return (long double)(2 * degree + 1) * weight[j] * legendre(degree, 2.0L * node[j] - 1.0L);
}

static void check_tail(const double entry[][4]) {
    for (int k = 0; k < 4; k++) {
        const int degree = n - 1 - k > 0 ? n - 1 - k : 0;
        for (int j = 0; j < n; j++) {
            check_nearest(entry[j][k], tail(degree, j));
        }
    }
}

static long double legendre_integral(int k, long double c) {
    const long double x = 2.0L * c - 1.0L;
    return k == 0 ? c : (legendre(k + 1, x) - legendre(k - 1, x)) / (long double)(2 * (2 * k + 1));
}

// d P_k(2 c - 1) / dc = 2 P_k', with (x^2 - 1) P_k' = k (x P_k - P_(k-1))
static long double legendre_slope(int k, long double c) {
    const long double x = 2.0L * c - 1.0L;
    return k == 0 ? 0.0L : 2.0L * k * (x * legendre(k, x) - legendre(k - 1, x)) / (x * x - 1.0L);
}

// Of the polynomial through the values at the nodes, what this makes of P_k(2 c - 1) at each of them.
static void check_matrix(const double matrix[12][12], long double (*of_legendre)(int k, long double c)) {
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++) {
            long double sum = 0.0L, size = 0.0L;
            for (int k = 0; k < n; k++) {
                sum += tail(k, j) * of_legendre(k, node[i]);
                size += fabsl(tail(k, j) * of_legendre(k, node[i]));
            }
            check_nearest_to(matrix[j][i], sum, size);
        }
    }
}

static void weights_integrate_polynomials(const double* entry) {
    for (int k = 0; k <= (is_radau ? 2 * n - 2 : 2 * n - 1); k++) {
        long double sum = 0.0L;
        for (int j = 0; j < n; j++) {
            sum += (long double)entry[j] * power(node[j], k);
        }
        CHECK_WITHIN((double)(sum * (k + 1) - 1.0L), 0.0, (double)(ROUNDING + OF_FORMULAS));
    }
}

static void check_radau(const FcRadauRule* rule, int stages) {
    n = stages;
    is_radau = true;
    check_nodes(rule->node);
    CHECK(rule->node[n] == -0.5);
    check_weights(rule->weight);
    check_start(rule->start);
    check_inverse(rule->inverse);
    check_tail(rule->tail);
    // The panel's start is no stage.
    CHECK(rule->weight[n] == 0.0 && rule->start[n] == -1.0);
    for (int k = 0; k < 4; k++) {
        CHECK(rule->tail[n][k] == 0.0);
    }
    weights_integrate_polynomials(rule->weight);
}

static void check_gauss(const FcGaussRule* rule, int nodes) {
    n = nodes;
    is_radau = false;
    check_nodes(rule->node);
    check_weights(rule->weight);
    check_matrix(rule->integral, legendre_integral);
    check_tail(rule->tail);
    for (int j = 0; j < n; j++) {
        CHECK(rule->node[j] == -rule->node[n - 1 - j]);
    }
    weights_integrate_polynomials(rule->weight);
}

int main(void) {
    if (LDBL_EPSILON > 1e-3 * DBL_EPSILON) {
        return 77;
    }
    check_radau(&FC_RADAU_9, 9);
    check_gauss(&FC_GAUSS_4, 4);
    check_gauss(&FC_GAUSS_6, 6);
    check_gauss(&FC_GAUSS_8, 8);
    check_gauss(&FC_GAUSS_12, 12);
    check_matrix(FC_GAUSS_12_SLOPE, legendre_slope);
    return check_result();
}
