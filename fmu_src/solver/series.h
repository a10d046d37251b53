// e^x - 1 near 0, in loops that become vector instructions.
#ifndef FC_SOLVER_SERIES_H
#define FC_SOLVER_SERIES_H

// Largest argument of this series and of those of nodes.c: their remainders are then under 1e-17.
static const double FC_SERIES_RANGE = 0.25;

// By Taylor series, Horner's scheme.
static inline double fc_series_exp_less_1(double x) {
    double sum = 1.0 / 479001600; // 1 / 12!
    sum = 1.0 / 39916800 + x * sum;
    sum = 1.0 / 3628800 + x * sum;
    sum = 1.0 / 362880 + x * sum;
    sum = 1.0 / 40320 + x * sum;
    sum = 1.0 / 5040 + x * sum;
    sum = 1.0 / 720 + x * sum;
    sum = 1.0 / 120 + x * sum;
    sum = 1.0 / 24 + x * sum;
    sum = 1.0 / 6 + x * sum;
    sum = 1.0 / 2 + x * sum;
    return x * (1.0 + x * sum);
}

#endif
