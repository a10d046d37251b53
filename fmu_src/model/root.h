// The root of a function in a bracket.
//
// The first step is that of the inverse cubic through both ends and their slopes, if the function goes one
// way at both. Each further step solves f + f' x + f'' x^2 / 2 = 0 for the nearer root. That is Newton's
// method if f'' is given as 0. With f'' it is faster, and good from an end at which f' vanishes. A bisection
// replaces a step that would leave the bracket or does not shrink as it should.
#ifndef FC_MODEL_ROOT_H
#define FC_MODEL_ROOT_H

typedef struct {
    double value;
    double rate;      // per second
    double curvature; // per second squared, or 0
} FcRootFunction;

typedef FcRootFunction (*FcRootEvaluation)(void* context, double t);

// f changes its sign from a to b [s], a < b, and is at_a and at_b there. The last step is at most last_step
// times the distance from a. The error is then of the order of that step's square or, if f'' is given, cube.
// The last step times f is at most least_area, which bounds the error of an integral of f up to the root. f
// was last evaluated one step before the root. Adds its evaluations to *evaluations.
double fc_root(FcRootEvaluation f, void* context, double a, FcRootFunction at_a, double b,
               FcRootFunction at_b, double last_step, double least_area, double* evaluations);

// The root of f between a and b, a < b, at which f has opposite signs: inverse quadratic interpolation, or
// bisection if that is slow (Chandrupatla). Ends on b's side of the root. The value there is at most `close`,
// or of at most least_area over the remaining bracket, or rounding. Adds its evaluations to *evaluations.
double fc_root_between(double (*f)(void* context, double t), void* context, double a, double at_a, double b,
                       double at_b, double close, double least_area, double* evaluations);

#endif
