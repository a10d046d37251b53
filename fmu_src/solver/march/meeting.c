#include "solver/march/meeting.h"

#include <math.h>

#include "model/regime.h"
#include "model/root.h"
#include "solver/panels/panel.h"

// The largest rise of p between two points, over its change from point to point nearby. Chosen empirically:
// for a sine whose points are a radian apart an eighth suffices. Half of it may miss a meeting, twice of it
// costs evaluations.
static const double HIDDEN = 0.5;

// The largest error of the cubic's maximum between two points, over the change of p nearby. Chosen
// empirically: 1/384 for a sine whose points are a radian apart. Half of it may miss a meeting, twice of it
// cuts more panels.
static const double MISSED_BY_CUBIC = 0.01;

static double beyond_at(const FcCourse* course, int side, int i) {
    return side * course->delta[i] - course->D[i];
}

double fc_approach(const FcCourse* course, int side, int i) {
    const double rate = course->still ? 0.0 : fc_bound_rate(course->bound, course->t[i]);
    return side * (course->V[i] - course->r[i] * course->delta[i]) - rate;
}

typedef struct {
    const FcCourse* course;
    int side;
} Of;

// p and p' of an exact course.
static double beyond(void* context, double t) {
    const Of* of = context;
    const FcCourse* course = of->course;
    const double x = fc_drive_displacement(&course->scene->drive, course->from, t);
    return of->side * (course->delta[0] + x) - (course->still ? course->D[0] : fc_bound(course->bound, t));
}

static double approach(void* context, double t) {
    const Of* of = context;
    const double rate = of->course->still ? 0.0 : fc_bound_rate(of->course->bound, t);
    return of->side * fc_drive_V(&of->course->scene->drive, t) - rate;
}

// The cubic on a cell, over it: values and slopes at both ends.
typedef struct {
    double p_a, p_b, slope_a, slope_b;
} Cubic;

static double of_cubic(void* context, double x) {
    const Cubic* c = context;
    const double bend = c->slope_a + c->slope_b - 2.0 * (c->p_b - c->p_a);
    const double rest = 3.0 * (c->p_b - c->p_a) - 2.0 * c->slope_a - c->slope_b;
    return c->p_a + x * (c->slope_a + x * (rest + x * bend));
}

static double slope_of_cubic(void* context, double x) {
    const Cubic* c = context;
    const double bend = c->slope_a + c->slope_b - 2.0 * (c->p_b - c->p_a);
    const double rest = 3.0 * (c->p_b - c->p_a) - 2.0 * c->slope_a - c->slope_b;
    return c->slope_a + x * (2.0 * rest + 3.0 * x * bend);
}

static Cubic cubic_of(const FcCourse* course, int side, int i) {
    const double length = course->t[i + 1] - course->t[i];
    return (Cubic){beyond_at(course, side, i), beyond_at(course, side, i + 1),
                   length * fc_approach(course, side, i), length * fc_approach(course, side, i + 1)};
}

// The crossing in the cell after point i, if p is above 0 at its end.
static double crossing(const FcCourse* course, int side, int i, double over, double close,
                       double* evaluations) {
    const double a = course->t[i];
    const double b = course->t[i + 1];
    const double p_a = fmin(beyond_at(course, side, i), -over); // below, also if it has just left the bound
    if (course->exact) {
        Of of = {course, side};
        return fc_root_between(beyond, &of, a, p_a, b, beyond_at(course, side, i + 1), close, 0.0,
                               evaluations);
    }
    Cubic cubic = cubic_of(course, side, i);
    *evaluations += 2.0;
    double none = 0.0;
    return a + (b - a) * fc_root_between(of_cubic, &cubic, 0.0, p_a, 1.0, cubic.p_b, 0.0, 0.0, &none);
}

// The largest change of p from point to point near the cell.
static double moves(const FcCourse* course, int side, int i) {
    double most = 0.0;
    for (int k = i > 0 ? i - 1 : 0; k <= i + 1 && k + 1 < course->count; k++) {
        most = fc_most(most, fabs(beyond_at(course, side, k + 1) - beyond_at(course, side, k)));
    }
    return most;
}

// Whether p rises, or may rise, above `over` inside the cell while it is below at both ends. *t is the time
// at which p crosses 0, or that of its maximum.
static bool crosses_unseen(const FcCourse* course, int side, int i, double over, double close, double* t,
                           double* evaluations) {
    const double p_a = beyond_at(course, side, i);
    const double p_b = beyond_at(course, side, i + 1);
    if (!(fmax(p_a, p_b) + HIDDEN * moves(course, side, i) > over)) {
        return false;
    }
    Cubic cubic = cubic_of(course, side, i);
    *evaluations += 2.0;
    if (!(cubic.slope_a > 0.0 && cubic.slope_b < 0.0)) {
        return false;
    }
    const double a = course->t[i];
    const double b = course->t[i + 1];
    if (course->exact) {
        Of of = {course, side};
        const double top =
            fc_root_between(approach, &of, a, cubic.slope_a, b, cubic.slope_b, 0.0, 0.0, evaluations);
        const double p = beyond(&of, top);
        *evaluations += 1.0;
        if (!(p > over)) {
            return false;
        }
        *t = p_a < 0.0 ? fc_root_between(beyond, &of, a, p_a, top, p, close, 0.0, evaluations) : a;
        return true;
    }
    double none = 0.0;
    const double top =
        fc_root_between(slope_of_cubic, &cubic, 0.0, cubic.slope_a, 1.0, cubic.slope_b, 0.0, 0.0, &none);
    const double p = of_cubic(&cubic, top);
    const double at_middle =
        16.0 * top * top * (1.0 - top) * (1.0 - top); // the error of a cubic, over that in the middle
    double part = top;                                // a panel that is cut at the top decides
    if (p > over) {
        part = p_a < 0.0 ? fc_root_between(of_cubic, &cubic, 0.0, p_a, top, p, 0.0, 0.0, &none) : 0.0;
    } else if (!(p + MISSED_BY_CUBIC * at_middle * moves(course, side, i) > over)) {
        return false;
    }
    *t = a + (b - a) * part;
    return true;
}

static double first_of_side(const FcCourse* course, int side, double over, double close,
                            double* evaluations) {
    if (course->left != side && beyond_at(course, side, 0) >= -over) {
        *evaluations += 1.0;
        if (fc_approach(course, side, 0) > 0.0) {
            return course->t[0];
        }
    }
    for (int i = 0; i + 1 < course->count; i++) {
        double t;
        if (beyond_at(course, side, i + 1) > over) {
            return beyond_at(course, side, i) < 0.0 || course->left == side
                       ? crossing(course, side, i, over, close, evaluations)
                       : course->t[i];
        }
        if (crosses_unseen(course, side, i, over, close, &t, evaluations)) {
            return t;
        }
    }
    return INFINITY;
}

FcMeeting fc_first_meeting(const FcCourse* course, double over, double close, double* evaluations) {
    const double forward = first_of_side(course, 1, over, close, evaluations);
    const double back = first_of_side(course, -1, over, close, evaluations);
    if (!isfinite(forward) && !isfinite(back)) {
        return (FcMeeting){0, 0.0};
    }
    return forward <= back ? (FcMeeting){1, forward} : (FcMeeting){-1, back};
}
