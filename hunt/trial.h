// A sequence of steps taken by the FMU. The reference grades each of them from the FMU's state before it.
//
// The rule: with S, the largest force of the step (reference.h), and path, the way of the surfaces and of the bristle
// (integral of |V| dt + |delta_end - delta_start|),
// - F_t and F_t_mean are within tolerance S; F_t_start, the force after a jump or a settled start, too; F_y likewise;
// - the W_f and Q_f of the step are within tolerance S path;
// - a bristle with static friction slips at the end, or not, as it does there;
// - F_t_settled, at the first step, is within tolerance S if the reference finds periods that repeat.
// The allowances are of rounding alone:
// - 1e-11 S, or S path;
// - 32 eps S |delta| of both ends for W_f and Q_f, since the state has no more digits of delta;
// - the change of the reference if the step's own start and length move by two units in their last place;
// - the same if the deflection before the step moves by 2e-10 of itself: at its static bound a bristle may have
//   broken away or not; by the tolerance in a step whose motion may be chaotic (scene_gain above 2);
//   one over more than 10 periods, or settled, that misses is counted and not judged;
// - a bristle within 1e-10 of its kinetic bound, or 1e-11 of its static one, lies on it. S is at least 1e-20 N, and the allowed
//   error of an energy 1e-20 J. A step is judged from the FMU's own state before it, a settled start by
//   F_t_start. A step with more panels or cycles than the reference takes is counted and not judged.
#ifndef HUNT_TRIAL_H
#define HUNT_TRIAL_H

#include "fmu_step.h"
#include "sequence.h"

enum {
    OF_FORCE,
    OF_MEAN,
    OF_WORK,
    OF_HEAT,
    OF_START,
    OF_FORCE_Y,
    OF_MEAN_Y,
    OF_START_Y,
    OF_SIDE,
    OF_SETTLED,
    GRADES
};
extern const char* const GRADE_NAMES[GRADES];

typedef struct {
    double ratio; // the largest error over the tolerance, rounding granted
    int of;       // the grade that is the worst
} Verdict;

// Properties of a step: it has static friction; its contact opens or closes in it or just before it; an input
// or parameter jumps before it; inputs move through ten periods of a vibration.
enum { IS_STATIC, OPENS, CLOSES, JUMPS, LEAPS, KINDS };

typedef struct {
    ReferenceScene scene; // from the FMU's state
    FmuStep step;
    ReferenceStep truth;
    double settled[2][2]; // N, F_t_settled and F_y_settled of the FMU and of the reference, at the first step
    Verdict verdict;
    bool is[KINDS];
} TrialStep;

typedef struct {
    int steps, unknown; // that were taken; that the reference does not take
    bool refused;       // whether the one after them was refused
    char message[320];  // why
    TrialStep taken[MOST_STEPS];
} Trial;

void trial_run(Trial* trial, const Sequence* sequence, double tolerance);

#endif
