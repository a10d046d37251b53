// The tables of Gauss-Legendre quadrature: n nodes integrate every power up to 2n - 1 exactly.
#include "solver/gauss_legendre.h"

#include "check.h"

static void integrates_powers(const FcQuadrature* rule) {
    for (int power = 0; power < 4 * rule->half_count; power += 2) { // odd ones vanish by symmetry
        double sum = 0.0;
        for (int i = 0; i < rule->half_count; i++) {
            sum += 2.0 * rule->weight[i] * pow(rule->node[i], power);
        }
        CHECK_NEAR(sum, 2.0 / (power + 1), 2e-15);
    }
}

int main(void) {
    integrates_powers(&FC_GAUSS_16);
    return check_result();
}
