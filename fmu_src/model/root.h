// Roots of a function in a bracket.
#ifndef FC_MODEL_ROOT_H
#define FC_MODEL_ROOT_H

// The root of f between a and b, a < b, at which f has opposite signs: inverse quadratic interpolation, or
// bisection if that is slow (Chandrupatla). Ends on b's side of the root. The value there is at most `close`,
// or of at most least_area over the remaining bracket, or rounding. Adds its evaluations to *evaluations.
double fc_root_between(double (*f)(void* context, double t), void* context, double a, double at_a, double b,
                       double at_b, double close, double least_area, double* evaluations);

#endif
