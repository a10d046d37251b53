// The first rise of a polynomial that is known at the points of a panel: closed forms, and dense samples of random ones.
#include "solver/integrate/dense_output.h"

#include "check.h"
#include "random.h"

enum { DEGREE = FC_POINTS - 1 };
typedef struct {
    double root[DEGREE];
    int count;
    double sign, height; // sign prod (x - root) + height
} Polynomial;

static double value(const Polynomial* p, double x) {
    double product = p->sign;
    for (int i = 0; i < p->count; i++) {
        product *= x - p->root[i];
    }
    return product + p->height;
}

static double rise_of(const Polynomial* p, double over) {
    double f[FC_POINTS];
    for (int i = 0; i < FC_POINTS; i++) {
        f[i] = value(p, 0.5 + FC_RADAU.node[i]);
    }
    return fc_first_upcrossing(f, over);
}

static void straight_lines(void) {
    for (double root = 0.0; root < 1.0; root += 0.01) {
        const Polynomial rising = {{root}, 1, 1.0, 0.0};
        CHECK_WITHIN(rise_of(&rising, 0.0), root, 4e-15);
        CHECK_WITHIN(rise_of(&rising, 1e-13), root, 4e-15); // the place at which it passes 0, not `over`
        const Polynomial falling = {{root}, 1, -1.0, 0.0};
        CHECK(rise_of(&falling, 0.0) == 2.0); // it begins above
    }
    const Polynomial below = {{1.5}, 1, 1.0, 0.0};
    CHECK(rise_of(&below, 0.0) == 2.0);
}

// A parabola that goes above 0 around its top alone, between two points, or by less than counts. A top within half a cell
// of the panel's ends is left to the push (top_at_bound in solver/events.c).
static void hidden_and_grazing(void) {
    for (double top = 0.04; top < 0.98; top += 0.0137) {
        for (double beyond = 1e-12; beyond < 1e-3; beyond *= 10.0) {
            const Polynomial hidden = {{top, top}, 2, -1.0, beyond};
            CHECK_WITHIN(rise_of(&hidden, 0.1 * beyond), top - sqrt(beyond), 1e-15 / sqrt(beyond));
            CHECK(rise_of(&hidden, 1.1 * beyond) == 2.0);
            const Polynomial under = {{top, top}, 2, -1.0, -beyond};
            CHECK(rise_of(&under, 0.0) == 2.0);
        }
    }
}

// A function that begins above must fall first.
static void above_at_the_start(void) {
    const Polynomial dips = {{0.3, 0.7}, 2, 1.0, 0.0};
    CHECK_WITHIN(rise_of(&dips, 0.0), 0.7, 1e-14);
    const Polynomial stays = {{0.5, 0.5}, 2, 1.0, 1e-3};
    CHECK(rise_of(&stays, 0.0) == 2.0);
}

// Roots that are a twentieth apart, by samples.
static void random_polynomials(void) {
    int found = 0;
    for (int k = 0; k < 4000; k++) {
        Polynomial p = {.sign = random_01() < 0.5 ? -1.0 : 1.0};
        const int most = 1 + (int)(5.0 * random_01());
        for (double at = 0.02 + 0.3 * random_01(); p.count < most; at += 0.05 + 0.3 * random_01()) {
            p.root[p.count++] = at;
        }
        double expected = 2.0;
        for (int i = 0; i < p.count && expected == 2.0; i++) {
            const bool rises = value(&p, p.root[i] + 1e-6) > 0.0;
            expected = rises && p.root[i] < 1.0 ? p.root[i] : 2.0;
        }
        const double got = rise_of(&p, 0.0);
        CHECK_WITHIN(got, expected, 1e-10);
        found += got < 2.0;
    }
    CHECK(found > 1000 && found < 3900);
}

int main(void) {
    straight_lines();
    hidden_and_grazing();
    above_at_the_start();
    random_polynomials();
    return check_result();
}
