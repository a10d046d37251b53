// A sequence of steps taken by the FMU, each held against the reference, and the same step taken in other ways.
#ifndef HUNT_TRIAL_H
#define HUNT_TRIAL_H

#include "judge.h"
#include "sequence.h"

typedef struct {
    ReferenceScene scene;
    FmuStep step;
    ReferenceStep
        truth;   // of one period, where the step is too long for brute force; reference_frame where screened
    bool graded; // whether truth is that of the step
    bool screened;      // whether the step agrees with its parts, and no reference was asked
    double parts;       // parts_ratio, where screened
    double derivatives; // slopes_ratio
} TrialStep;

typedef struct {
    bool screens;      // whether the reference is asked only of steps that do not agree with their parts
    int steps;         // that were taken
    bool refused;      // whether the one after them was refused, or took too many evaluations to be judged
    char message[320]; // why; empty where it took too many
    TrialStep taken[MOST_STEPS];
} Trial;

// Takes at most so many steps. What the trial has known of the reference before is used again where the scene is the same,
// so that one trial may be run with several tolerances.
void trial_run(Trial* trial, const Sequence* sequence, int most_steps, double tolerance);

// What a step is graded by: the errors of judge.h; the derivatives of F_t; F_t_settled at its start; the same step taken
// as two, mirrored, some periods later, and again from a saved state.
enum { BY_DERIVATIVES = JUDGED, BY_SETTLED, BY_SPLIT, BY_MIRROR, BY_SHIFT, BY_RESTORED, GRADES };
extern const char* const GRADE_NAMES[GRADES];

typedef struct {
    double ratio;   // the largest error over the tolerance
    double granted; // what it may be
    int of;         // the grade that is the worst
    int kind;       // class of the promise
    int step;
} Verdict;

Verdict trial_verdict(const Trial* trial, int k, int method, double tolerance);

// The worst of all steps, over what is granted.
Verdict trial_worst(const Trial* trial, int method, double tolerance);

// Whether the reference is unsure of a miss: with more panels and stages it says something else by a tenth of the
// tolerance, or a start and a V that are moved by rounding explain a fifth of the error.
bool trial_is_unsure(const Trial* trial, const Verdict* miss, double tolerance);

#endif
