// Roots of a function in a bracket.
#ifndef FC_MODEL_ROOT_H
#define FC_MODEL_ROOT_H

// The root of f between a and b, a < b, at which f has opposite signs: inverse quadratic interpolation, or
// bisection if that is slow (Chandrupatla). Ends on b's side of the root, next to it or where the value is at most
// `close`. Adds its evaluations to *evaluations.
double fc_root_between(double (*f)(void* context, double t), void* context, double a, double at_a, double b,
                       double at_b, double close, double* evaluations);

#endif
