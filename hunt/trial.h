// A sequence of steps taken by the FMU. The reference grades each step from the FMU's state before it.
// The rule is that of docs/numerics.md: the forces at the end, their means, and those after a jump or a settled start are within
// tolerance S; the W_f and Q_f of the step within tolerance S path; a bristle with static friction slips at the end if and
// only if the reference's does; body.v within tolerance S h / m, body.x within tolerance S h^2 / m,
// and the path of energies is S h / m min(h, sqrt(m / sigma)) longer; F_t_settled, at the first step, is within tolerance S if the reference finds periods that
// repeat. The path is integral of |V| dt + |delta_end - delta_start|. The allowances are for rounding alone:
// - 1e-11 S, or S path.
// - 1e-13 |delta| of both ends, times S, or the elastic force before a jump of inputs, for W_f and Q_f and times sigma_1 over
//   the step for F_t_mean, since a bristle so near to its bound lies on it; and 20 eps more in each period: of two
//   meetings, each with the rounding of D, whose exponent may be 10.
// - The change of the reference if the step's own start and length move by two units in their last place, or the deflection
//   before it by 2e-10 of itself: at its static bound a bristle may have broken away or not. If the motion may be chaotic
//   (scene_gain above 2), the deflection moves by the tolerance.
// - A bristle within 1e-10 of its kinetic bound, or within 1e-11 of its static bound, lies on it. S is at least 1e-20 N,
//   and the allowed error of an energy at least 1e-20 J.
// - 2 eps of velocities and places of a mass at both ends; 2 eps of its velocity and that of the contact at the start.
// A settled start is judged by F_t_start. A step is counted and not judged if it takes more panels or cycles than the
// reference goes through; and if it misses while its motion may be chaotic and it has more than 10 periods, its kappa is below
// 1e-3 as over a lifted tool, the reference differs by more than a tenth of the allowed error in smaller panels, it starts beyond 100 limits, or the sequence starts from a settled state that is not promised.
#ifndef HUNT_TRIAL_H
#define HUNT_TRIAL_H

#include "contact/friction_contact.h"
#include "reference.h"
#include "sequence.h"

enum { SETTLED = RESULTS, GRADES }; // the results of a step, and F_t_settled with F_y_settled
extern const char* const GRADE_NAMES[GRADES];

// A step of the FMU.
typedef struct {
    double result[RESULTS]; // as of the reference; the heat of the first step includes that of the start
    double delta_start, delta_y_start; // m, before the step and its inputs
    double v_start, x_start;           // m/s, m, of the mass
    int slips_start;
    double force_before; // N, sigma |delta| before its inputs
} FmuStep;

typedef struct {
    double ratio; // the largest error over the allowed error
    int of;       // the grade of that error
} Verdict;

typedef struct {
    ReferenceScene scene; // from the FMU's state
    FmuStep step;
    ReferenceStep truth;
    FcVector settled; // N, F_t_settled and F_y_settled of the FMU, at the first step
    double settled_truth[2];
    Verdict verdict;
} TrialStep;

typedef struct {
    int steps, unknown; // the number of steps taken, and of steps that are not judged
    double worst;       // of the ratios
    double evaluations; // of the FMU, over all steps
    bool refused;       // whether the step after them was refused
    FcMessage message;  // why
    TrialStep taken[MAX_STEPS];
} Trial;

// settled: F_t_settled of the first step is judged, too.
void trial_run(Trial* trial, const Sequence* sequence, bool settled);

#endif
