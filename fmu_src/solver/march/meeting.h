// The meeting of a bristle with its bound in a panel, by the panel's own points.
//
//     p = side delta - D      p' = side delta' - D'
//
// The panel's points lie so near to each other that p is nearly a cubic between two of them. p crosses 0 if
// its sign changes from one point to the next. p may also cross 0 in between, if p rises at the first point
// and falls at the second. p' is evaluated only if p is near enough to 0.
#ifndef FC_SOLVER_MEETING_H
#define FC_SOLVER_MEETING_H

#include <stdbool.h>

#include "solver/march/points.h"

// The largest distance from its bound that counts as rounding, over the bound: 450 eps. Twice of it would move a
// bristle by as much more.
static const double FC_ROUNDING_OF_MEETING = 1e-13;

// A bristle and its bound at the points of a panel.
typedef struct {
    const FcScene* scene; // the law's
    const FcScene* bound; // model/regime.h
    int count;
    double t[FC_MOST_POINTS];     // s
    double V[FC_MOST_POINTS];     // m/s
    double delta[FC_MOST_POINTS]; // m
    double r[FC_MOST_POINTS];     // 1/s, sigma |V| / g; 0 in ElasticPlastic
    double D[FC_MOST_POINTS];     // m
    double from;                  // s: delta[0] + the displacement since then is the motion, if it is exact
    bool exact;                   // delta' = V
    bool still;                   // the bound does not move
    int left; // the side of a bound that the bristle has just left, since its push ended; else 0
} FcCourse;

typedef struct {
    int side; // 1 or -1; 0 for no meeting
    double t; // s; by the cubic, and only a possible meeting, if the course is not exact
} FcMeeting;

// The first meeting of the course with its bound, beyond which it goes by more than `over` [m]; found to
// within `close` [m] of the bound. A meeting at the start counts if the bristle is within `over` of the bound
// and pushed, and has not just left it. Adds its evaluations to *evaluations.
FcMeeting fc_first_meeting(const FcCourse* course, double over, double close, double* evaluations);

// p' [m/s] at point i.
double fc_approach(const FcCourse* course, int side, int i);

#endif
