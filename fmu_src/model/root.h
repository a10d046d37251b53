// The root of a function in a bracket.
//
// It starts from the inverse cubic through both ends and their slopes, where the function goes one way at both. Each
// step solves f + f' x + f'' x^2 / 2 = 0 for the nearer root: Newton's method where f'' is given as 0, faster otherwise,
// and good from an end where f' vanishes. A step that would leave the bracket, or that does not shrink as it should, is
// replaced by a bisection.
#ifndef FC_MODEL_ROOT_H
#define FC_MODEL_ROOT_H

typedef struct {
    double value;
    double rate;      // per second
    double curvature; // per second squared, or 0
} FcRootFunction;

typedef FcRootFunction (*FcRootEvaluation)(void* context, double t);

// f changes its sign from a to b [s], a < b, and is at_a and at_b there. Ends with such a step of at most last_step times the
// way from a: the error is then of the order of that step's square or, where f'' is given, cube. The step times f is at
// most least_area then, which bounds what an integral of f up to the root misses. f was evaluated last that step from the root. Adds what it evaluates to *evaluations.
double fc_root(FcRootEvaluation f, void* context, double a, FcRootFunction at_a, double b,
               FcRootFunction at_b, double last_step, double least_area, double* evaluations);

// The root of f between a and b, a < b, of values of opposite signs there: by inverse quadratic interpolation, halved if that is
// slow (Chandrupatla). Ends on b's side of the root with a value of at most `close`, of at most least_area over the bracket that
// is left, or of rounding. Adds what it evaluates to *evaluations.
double fc_root_between(double (*f)(void* context, double t), void* context, double a, double at_a, double b,
                       double at_b, double close, double least_area, double* evaluations);

#endif
