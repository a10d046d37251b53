// Counts of a hunt, as tables.
#ifndef HUNT_TALLY_H
#define HUNT_TALLY_H

#include <stdbool.h>

#include "promise.h"
#include "trial.h"

enum { MOST_TOLERANCES = 12, LAWS = 4, KAPPAS = 7, METHODS = 3 };
extern const char* const LAW_NAMES[LAWS + 1]; // the first is "any"

typedef struct {
    long steps, misses;
    double worst; // error over the tolerance
} Cell;

typedef struct {
    Cell by_law[METHODS * LAWS][MOST_TOLERANCES]; // the default, cvode, fixed steps
    Cell by_kappa[KAPPAS][MOST_TOLERANCES];       // of the default
    Cell by_class[CLASSES][MOST_TOLERANCES];
    Cell by_grade[GRADES][MOST_TOLERANCES]; // where it is the worst of its step
    long drawn, refused, unsure;
    int minimized[LAWS][CLASSES];
} Tally;

void tally_count(Tally* tally, const TrialStep* taken, int method, int column, const Verdict* verdict);

void tally_add(Tally* sum, const Tally* part);

// Tables with a column for each tolerance, "misses, worst error over the tolerance"; returns the misses.
long tally_print(const Tally* tally, const double* tolerance, int tolerances);

#endif
