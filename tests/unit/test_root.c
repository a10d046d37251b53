// Roots in a bracket: found as closely as asked, in few evaluations, also where a guess leads out of the bracket.
#include "model/root.h"

#include "check.h"

typedef FcRootFunction (*Function)(double t);

static FcRootFunction evaluate(void* context, double t) { return (*(Function*)context)(t); }

static FcRootFunction sine(double t) { return (FcRootFunction){sin(t), cos(t), -sin(t)}; }
static FcRootFunction sine_without_curvature(double t) { return (FcRootFunction){sin(t), cos(t), 0.0}; }
static FcRootFunction falling(double t) { return (FcRootFunction){2.0 - exp(t), -exp(t), -exp(t)}; }
// Flat at the start of the bracket [0, 1], with the root sqrt(1/2).
static FcRootFunction from_rest(double t) { return (FcRootFunction){t * t - 0.5, 2.0 * t, 2.0}; }
// So steep at the root 1/3 that Newton's method would be thrown about.
static FcRootFunction steep(double t) {
    const double x = 1e4 * (t - 1.0 / 3.0);
    return (FcRootFunction){atan(x), 1e4 / (1.0 + x * x), 0.0};
}
// Goes down first: -1, least at 1/2, up to 2 at 2. Its root is 1 / 2 + sqrt(5) / 2.
static FcRootFunction down_first(double t) { return (FcRootFunction){t * t - t - 1.0, 2.0 * t - 1.0, 2.0}; }
// Goes down first, and has its root so near the end 1 that the tangents lead beyond it.
static const double NEARLY_1 = 1.0 - 1e-6;
static FcRootFunction late(double t) {
    const double x = t - 0.45;
    return (FcRootFunction){x * x - (NEARLY_1 - 0.45) * (NEARLY_1 - 0.45), 2.0 * x, 0.0};
}

// order: of the last step, that the error has.
static void finds(Function f, double a, double b, double root, double order, double most_evaluations) {
    for (double last_step = 1e-1; last_step > 1e-6; last_step *= 0.1) {
        double evaluations = 0.0;
        const double t = fc_root(evaluate, &f, a, f(a), b, f(b), last_step, INFINITY, &evaluations);
        CHECK_WITHIN(t, root, 2.0 * pow(last_step, order) * (b - a) + 1e-15);
        CHECK(evaluations <= most_evaluations);
    }
}

int main(void) {
    const double pi = acos(-1.0);
    finds(sine, 3.0, 3.5, pi, 3.0, 2.0);
    finds(sine_without_curvature, 2.5, 3.3, pi, 2.0, 3.0);
    finds(falling, 0.0, 1.5, log(2.0), 3.0, 3.0);
    finds(from_rest, 0.0, 1.0, sqrt(0.5), 3.0, 1.0);
    finds(down_first, 0.0, 2.0, 0.5 + 0.5 * sqrt(5.0), 3.0, 3.0);
    finds(steep, 0.0, 1.0, 1.0 / 3.0, 1.0, 15.0);
    finds(late, 0.0, 1.0, NEARLY_1, 2.0, 15.0);
    double evaluations = 0.0;
    Function f = sine;
    CHECK(fc_root(evaluate, &f, 0.0, f(0.0), 1.0, f(1.0), 1e-3, INFINITY, &evaluations) == 0.0);
    return check_result();
}
