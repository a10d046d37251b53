// Roots of a function in a bracket.
#ifndef FC_MODEL_ROOT_H
#define FC_MODEL_ROOT_H

typedef struct {
    double value;
    double rate;      // per second
    double curvature; // per second squared, or 0
} FcRootFunction;

typedef FcRootFunction (*FcRootEvaluation)(void* context, double t);

// The root of f between a and b, a < b, at which f has opposite signs: steps to the nearer root of the parabola of
// f, f' and f'', or bisections if they leave the bracket or do not shrink. Good from an end at which f' vanishes. The last step is at most last_step times
// the distance from a. The error is then of the order of its cube. Adds its evaluations to *evaluations.
double fc_root(FcRootEvaluation f, void* context, double a, FcRootFunction at_a, double b, double last_step,
               double* evaluations);

// The root of f between a and b, a < b, at which f has opposite signs: inverse quadratic interpolation, or
// bisection if that is slow (Chandrupatla). Ends on b's side of the root. The value there is at most `close`,
// or of at most least_area over the remaining bracket, or rounding. Adds its evaluations to *evaluations.
double fc_root_between(double (*f)(void* context, double t), void* context, double a, double at_a, double b,
                       double at_b, double close, double least_area, double* evaluations);

#endif
