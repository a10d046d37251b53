// Roots in a bracket: found as closely as asked, in few evaluations, also where a guess leads out of the bracket.
#include "model/root.h"

#include "check.h"

// So near the end 1 that the secants lead beyond it.
static const double NEARLY_1 = 1.0 - 1e-6;

typedef double (*Value)(double t);

static double value_of(void* context, double t) { return (*(Value*)context)(t); }

static double sine_value(double t) { return sin(t); }
static double far_value(double t) { return sin(t - 1e6) - sin(1e-4); }
static double steep_value(double t) { return atan(1e8 * (t - 1.0 / 3.0)); }
static double flat_value(double t) { return pow(t - 0.7, 9.0); }
static double falling_value(double t) { return 2.0 - exp(t); }
static double step_value(double t) { return t < 0.123 ? -1.0 : 1e-30; }
static double late_value(double t) { return t < NEARLY_1 ? -1e-12 : 1.0; }

// On b's side of the root, with a value of at most close, or next to the root.
static void finds_between(Value f, double a, double b, double root, double most_evaluations) {
    static const double CLOSE[] = {1e-3, 1e-9, 0.0};
    for (int i = 0; i < 3; i++) {
        const double close = CLOSE[i];
        double evaluations = 0.0;
        const double t = fc_root_between(value_of, &f, a, f(a), b, f(b), close, &evaluations);
        CHECK(t >= a && t <= b && (f(t) == 0.0 || (f(t) > 0.0) == (f(b) > 0.0)));
        CHECK(fabs(f(t)) <= close || fabs(t - root) <= 1e-15 * b);
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
    CHECK(fc_root_between(value_of, &f, -1.0, f(-1.0), 0.0, 0.0, 0.0, &evaluations) == 0.0);
    CHECK(evaluations == 0.0);
}

int main(void) {
    roots_of_values();
    return check_result();
}
