#include "minimize.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "names.h"

// What is made plainer, and what it has to show.
typedef struct {
    Sequence plain;
    StillShows* shows;
    const void* context;
} Minimizer;

static bool keep(Minimizer* m, const Sequence* plainer) {
    if (!m->shows(plainer, m->context)) {
        return false;
    }
    m->plain = *plainer;
    return true;
}

static bool try_number(Minimizer* m, int step, int index, double value) {
    Sequence plainer = m->plain;
    *scene_value(&plainer.step[step], index) = value;
    return keep(m, &plainer);
}

static double rounded(double value, int digits) {
    char text[40];
    snprintf(text, sizeof text, "%.*g", digits, value);
    return strtod(text, NULL);
}

// Returns whether the number became plainer.
static bool simplify_number(Minimizer* m, int step, int index) {
    static const int DIGITS[] = {1, 2, 3, 5, 8, 12};
    ReferenceScene base = step == 0 ? reference_scene() : no_change();
    const double value = *scene_value(&m->plain.step[step], index), usual = *scene_value(&base, index);
    if (value == usual || isnan(value)) {
        return false;
    }
    if (try_number(m, step, index, usual)) {
        return true;
    }
    for (int k = 0; k < (int)(sizeof DIGITS / sizeof *DIGITS); k++) {
        const double plainer = rounded(value, DIGITS[k]);
        if (plainer == value) { // it has so few digits already
            return false;
        }
        if (try_number(m, step, index, plainer)) {
            return true;
        }
    }
    return false;
}

static bool simplify_choice(Minimizer* m, int index) {
    ReferenceScene usual = reference_scene();
    Sequence plainer = m->plain;
    int* choice = scene_choice(&plainer.step[0], index);
    if (*choice == *scene_choice(&usual, index)) {
        return false;
    }
    *choice = *scene_choice(&usual, index);
    return keep(m, &plainer);
}

static bool simplify_steps(Minimizer* m) {
    Sequence fewer = m->plain;
    fewer.steps--;
    return fewer.steps > 0 && keep(m, &fewer);
}

Sequence minimized(const Sequence* sequence, StillShows* shows, const void* context) {
    Minimizer m = {*sequence, shows, context};
    for (bool changed = true; changed;) {
        changed = simplify_steps(&m);
        for (int k = 1; k < SCENE_CHOICES; k++) { // the law stays
            changed = simplify_choice(&m, k) || changed;
        }
        for (int step = 0; step < m.plain.steps; step++) {
            for (int k = 0; k < REFERENCE_DOUBLES; k++) {
                changed = simplify_number(&m, step, k) || changed;
            }
        }
    }
    return m.plain;
}
