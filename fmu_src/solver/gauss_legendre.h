// Gauss-Legendre quadrature: n nodes integrate polynomials of degree 2n - 1 exactly.
#ifndef FC_SOLVER_GAUSS_LEGENDRE_H
#define FC_SOLVER_GAUSS_LEGENDRE_H

typedef struct {
    int half_count;       // nodes lie at the middle +- half_length * node
    const double* node;   // in (0, 1)
    const double* weight; // over [-1, 1]
} FcQuadrature;

extern const FcQuadrature FC_GAUSS_16;

#endif
