// The task of every solver method: take the deflection over one communication step, within a limited amount
// of work.
//
// A step is divided into nested spans of time, from long to short:
//
//     step       of communication, by a method                                        method.h
//     block      of periods whose maps are interpolated (multirevolution)             periods/period_interpolation.h
//     cycle      of periods that repeats itself                                       periods/periods.h
//     period     of the vibration                                                     periods/periods.h
//     segment    between openings of the contact, or factors of the load              periods/segments.h
//     interval   a segment of one period, or of less than two: the domain of a map    interval.h
//     part       of an interval, with one change of variable                          integrate/time_map.h
//     panel      of a part: ten points, one Radau step                                panel/panel.h
#ifndef FC_SOLVER_SOLVER_H
#define FC_SOLVER_SOLVER_H

#include <stdbool.h>

#include "message.h"
#include "model/plane.h"

// The values of modelDescription.xml.
typedef enum {
    FC_METHOD_COLLOCATION = 1,
    FC_METHOD_CVODE = 2,
    FC_METHOD_BACKWARD_EULER = 3,
    FC_METHOD_TRAPEZOID = 4,
    FC_METHOD_RK4 = 5,
    FC_METHOD_EXPLICIT_EULER = 6
} FcMethod;

typedef struct {
    double tolerance;        // 1  bound of the error of F_t and of its mean, over the force
    double force;            // N  the scale of the tolerance for the bristle's force
    double largest;          // N  the largest force of the step
    double damping;          // N  sigma_1 times the largest |V|; 0 without a bristle
    double step_size;        // s  internal step of the fixed-step methods
    double stiffness_at_end; // N/m  largest sigma there, if that of an interval may be less; else 0
} FcSolverOptions;

// The scale [N] of the tolerance for the bristle's force, beside a damping, if no limit is smaller [N].
static inline double fc_force_beside_damping(double largest, double damping, double limit) {
    return largest / (1.0 + damping / limit);
}

typedef struct {
    double delta; // m     deflection at the end of the step
    FcBristleState
        state;    //    and that of the bristle; FC_SLIPPING if the step has ended in a slip along the bound
    int meetings; //       how often the bristle met its bound, slipping along it at the start included
    double slip_time;   // s     into the interval, a time at which the bristle slipped along a bound, and
    int slip_side;      //       the side of that bound; both without meaning if it has not slipped
    double lost;        // m     deflection lost by opening contacts, which is not motion
    double impulse;     // N s   integral of F dt, F being F_t without its parts from sigma_1 and sigma_2
    double work;        // J     integral of F V dt
    double heat;        // J     integral of F (V - delta') dt
    double drag;        // m2/s  integral of delta' V dt, the work of the damping over sigma_1
    double evaluations; // 1     the work, in evaluations of the coefficients of the equation of the bristle
    double delta_y;     // m     across, as delta, lost and impulse are along; work, heat and drag are of both
    double lost_y;      // m
    double impulse_y;   // N s
    FcVector by_start
        [2]; // in the plane, without static friction: derivatives of delta, delta_y by those at the start
} FcStepResult;

static inline FcBristle fc_bristle_of(const FcStepResult* result) {
    return (FcBristle){.delta = result->delta, .state = result->state, .delta_y = result->delta_y};
}

// The result with which a step begins, after so many evaluations.
static inline void fc_result_start(FcStepResult* result, FcBristle start, double evaluations) {
    *result = (FcStepResult){
        .delta = start.delta, .state = start.state, .evaluations = evaluations, .delta_y = start.delta_y};
}

// The work limit: the largest work of one communication step, one settled state or one derivative of a settled mean, in evaluations: 0.2 to
// 0.4 s of computing. A call that needs more is refused, so that no host seems to hang. Only inputs that move over many
// orders of magnitude or many periods reach it, and motions that never repeat.
#ifndef FC_MAX_EVALUATIONS
#define FC_MAX_EVALUATIONS 3e6
#endif

#endif
