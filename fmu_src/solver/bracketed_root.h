// The root of a function in a bracket, to the last bits.
//
// Each step solves f + f' x + f'' x^2 / 2 = 0 for the nearer root: Newton's method where f'' is given as 0, faster
// otherwise, and good from an end where f' vanishes. A step that would leave the bracket, or that does not shrink as it
// should, is replaced by a bisection.
#ifndef FC_SOLVER_BRACKETED_ROOT_H
#define FC_SOLVER_BRACKETED_ROOT_H

typedef struct {
    double value;
    double rate;      // per second
    double curvature; // per second squared, or 0
} FcRootFunction;

typedef FcRootFunction (*FcRootEvaluation)(const void* context, double t);

// f changes its sign from a to b [s], a < b, and is at_a at a. Adds what it evaluates to *evaluations.
double fc_bracketed_root(FcRootEvaluation f, const void* context, double a, FcRootFunction at_a, double b,
                         double* evaluations);

#endif
