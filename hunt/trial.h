// A sequence of steps taken by the FMU, each of them graded by the reference from where the FMU stood before it.
#ifndef HUNT_TRIAL_H
#define HUNT_TRIAL_H

#include "fmu_step.h"
#include "sequence.h"

// What is graded: within the tolerance of S, of work and heat of S times the path; F_t_start is that of a jump or of a
// settled start. The side of the slip is graded as it is.
enum { OF_FORCE, OF_MEAN, OF_WORK, OF_HEAT, OF_START, OF_SIDE, OF_SETTLED, GRADES };
extern const char* const GRADE_NAMES[GRADES];

typedef struct {
    double ratio; // the largest error over the tolerance, rounding granted
    int of;       // the grade that is the worst
} Verdict;

typedef struct {
    ReferenceScene scene; // from where the FMU stood
    FmuStep step;
    ReferenceStep truth;
    double settled[2]; // N, F_t_settled of the FMU and of the reference, at the first step
    Verdict verdict;
} TrialStep;

typedef struct {
    int steps, unknown; // that were taken; of which the reference knows nothing
    bool refused;       // whether the one after them was refused
    char message[320];  // why
    TrialStep taken[MOST_STEPS];
} Trial;

void trial_run(Trial* trial, const Sequence* sequence, double tolerance);

// The number of the worst step from 0 on, -1 where there is none.
int trial_worst(const Trial* trial);

#endif
