// Counts of a hunt, as tables.
#ifndef HUNT_TALLY_H
#define HUNT_TALLY_H

#include "trial.h"

enum { MOST_TOLERANCES = 12, LAWS = 4, KAPPAS = 7 };
extern const char* const LAW_NAMES[LAWS + 1]; // the first is "any"

typedef struct {
    long steps, misses;
    double worst; // error over the tolerance
} Cell;

typedef struct {
    Cell by_law[LAWS][MOST_TOLERANCES];
    Cell by_kappa[KAPPAS][MOST_TOLERANCES];
    long drawn, refused, unknown;
    int minimized[LAWS][GRADES];
} Tally;

void tally_count(Tally* tally, const TrialStep* taken, int column);

void tally_add(Tally* sum, const Tally* part);

// Tables with a column for each tolerance, "misses, worst error over the tolerance"; returns the misses.
long tally_print(const Tally* tally, const double* tolerance, int tolerances);

#endif
