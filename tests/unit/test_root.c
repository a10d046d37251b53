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
        const double t = fc_root(evaluate, &f, a, f(a), b, last_step, &evaluations);
        CHECK_WITHIN(t, root, 2.0 * pow(last_step, order) * (b - a) + 1e-15);
        CHECK(evaluations <= most_evaluations);
    }
}

// ---- fc_root_between: values alone ----

typedef double (*Value)(double t);

static double value_of(void* context, double t) { return (*(Value*)context)(t); }

static double sine_value(double t) { return sin(t); }
static double far_value(double t) { return sin(t - 1e6) - sin(1e-4); }
static double steep_value(double t) { return atan(1e8 * (t - 1.0 / 3.0)); }
static double flat_value(double t) { return pow(t - 0.7, 9.0); }
static double falling_value(double t) { return 2.0 - exp(t); }
static double step_value(double t) { return t < 0.123 ? -1.0 : 1e-30; }
static double late_value(double t) { return t < NEARLY_1 ? -1e-12 : 1.0; }

// On b's side of the root, with a value of at most close, or of at most area over the way to the root, or next to the root.
static void finds_between(Value f, double a, double b, double root, double most_evaluations) {
    static const double CLOSE[] = {1e-3, 1e-9, 0.0, 0.0, 0.0};
    static const double AREA[] = {0.0, 0.0, 0.0, 1e-3, 1e-12};
    for (int i = 0; i < 5; i++) {
        const double close = CLOSE[i];
        double evaluations = 0.0;
        const double t = fc_root_between(value_of, &f, a, f(a), b, f(b), close, AREA[i], &evaluations);
        CHECK(t >= a && t <= b && (f(t) == 0.0 || (f(t) > 0.0) == (f(b) > 0.0)));
        CHECK(fabs(f(t)) <= close || fabs(t - root) * fabs(f(t)) <= AREA[i] || fabs(t - root) <= 1e-15 * b);
        CHECK(evaluations <= most_evaluations);
    }
}

static void roots_of_values(void) {
    finds_between(sine_value, 3.0, 3.5, acos(-1.0), 8.0);
    finds_between(far_value, 1e6, 1e6 + 1e-3, 1e6 + 1e-4, 30.0);
    finds_between(falling_value, 0.0, 1.5, log(2.0), 10.0);
    finds_between(steep_value, 0.0, 1.0, 1.0 / 3.0, 60.0);
    finds_between(flat_value, 0.0, 1.0, 0.7, 120.0);
    finds_between(step_value, 0.0, 1.0, 0.123, 60.0);
    finds_between(late_value, 0.0, 1.0, NEARLY_1, 100.0);
    double evaluations = 0.0; // a root at an end is found there
    Value f = sine_value;
    CHECK(fc_root_between(value_of, &f, -1.0, f(-1.0), 0.0, 0.0, 0.0, 0.0, &evaluations) == 0.0);
    CHECK(evaluations == 0.0);
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
    roots_of_values();
    double evaluations = 0.0;
    Function f = sine;
    CHECK(fc_root(evaluate, &f, 0.0, f(0.0), 1.0, 1e-3, &evaluations) == 0.0);
    return check_result();
}
