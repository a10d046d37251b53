#include "solver/stretches/watch.h"

#include <assert.h>
#include <math.h>

#include "model/regime.h"
#include "solver/budget.h"
#include "solver/panels/gauss_panel.h"
#include "solver/panels/gauss_rule.h"
#include "solver/panels/radau_panel.h"

// The largest number of cuts of one panel. Newton's method takes three; half as many would leave no room for
// bisections.
enum { MOST_CUTS = 12 };

// A bristle that comes this near to its bound, in estimated errors, may touch it. Half of it trusts estimates
// that may be too small by as much; twice of it refuses more panels.
static const double NEAR_BOUND = 3.0;

static double deflection(const FcMap* map, double delta_0) {
    return delta_0 - map->relaxation * delta_0 + map->offset;
}

// The bound's limit over that of a scene, which may be without its Stribeck curve, at V.
static double bound_over_limit(const FcWatch* watch, const FcScene* scene, double V) {
    return watch->bound->friction->mu / (scene->friction->mu * fc_stribeck(scene->friction, V));
}

// The point number i of the course from the panel's node k.
static void set_node(const FcWatch* watch, const FcScene* scene, double delta_0, int k, int i, double t,
                     FcCourse* course) {
    const FcPanelNodes* nodes = &watch->nodes;
    const double V = nodes->V[k];
    course->t[i] = t;
    course->V[i] = V;
    course->delta[i] = nodes->P[k] * delta_0 + nodes->Q[k];
    course->r[i] = nodes->sigma[k] * fabs(V) / nodes->limit[k];
    course->D[i] = nodes->limit[k] * bound_over_limit(watch, scene, V) / nodes->sigma[k];
}

static void set_end(const FcWatch* watch, const FcScene* scene, double t, double delta, int i,
                    FcCourse* course) {
    const FcCoefficients at = fc_scene_coefficients(scene, t);
    course->t[i] = t;
    course->V[i] = at.V;
    course->delta[i] = delta;
    course->r[i] = fc_relaxation_rate(&at);
    course->D[i] = at.limit * bound_over_limit(watch, scene, at.V) / at.sigma;
}

static const FcGaussRule* rule_of(int nodes) {
    return nodes == 4 ? &FC_GAUSS_4 : nodes == 6 ? &FC_GAUSS_6 : nodes == 8 ? &FC_GAUSS_8 : &FC_GAUSS_12;
}

static FcCourse course_of(const FcWatch* watch, const FcPanelAt* at, double delta_0, const FcPanel* panel,
                          double* evaluations) {
    const int n = at->nodes;
    assert(n == 0 || n == 4 || n == 6 || n == 8 || n == 12);
    FcCourse course = {.scene = at->scene, .bound = watch->bound, .left = at->t == 0.0 ? watch->left : 0};
    if (n == 0) {
        course.count = FC_RADAU_STAGES + 1;
        set_node(watch, at->scene, delta_0, FC_RADAU_STAGES, 0, at->t, &course);
        for (int i = 0; i < FC_RADAU_STAGES; i++) {
            const double t =
                i + 1 < FC_RADAU_STAGES ? at->t + (0.5 + FC_RADAU_9.node[i]) * at->h : at->t + at->h;
            set_node(watch, at->scene, delta_0, i, i + 1, t, &course);
        }
        return course;
    }
    course.count = n + 2;
    set_end(watch, at->scene, at->t, delta_0, 0, &course);
    for (int i = 0; i < n; i++) {
        set_node(watch, at->scene, delta_0, i, i + 1, at->t + (0.5 + rule_of(n)->node[i]) * at->h, &course);
    }
    set_end(watch, at->scene, at->t + at->h, deflection(&panel->map, delta_0), n + 1, &course);
    *evaluations += 2.0;
    return course;
}

// The largest error of the polynomial through the nodes, between them, over the bound.
static double missed_between(const FcPanelAt* at, const FcCourse* course) {
    double FC_PAIRED part[FC_MOST_NODES];
    if (at->nodes == 0) {
        for (int i = 0; i < FC_RADAU_STAGES; i++) {
            part[i] = course->delta[i + 1] / course->D[i + 1];
        }
        part[FC_RADAU_STAGES] = course->delta[0] / course->D[0];
        const FcTail tail = fc_tail_of(FC_RADAU_STAGES + 1, FC_RADAU_9.tail, part);
        return fc_beyond_rounding(1.0, tail.top) * tail.fall;
    }
    for (int i = 0; i < at->nodes; i++) {
        part[i] = course->delta[i + 1] / course->D[i + 1];
    }
    const FcTail tail = fc_tail_of(at->nodes, rule_of(at->nodes)->tail, part);
    return fc_beyond_rounding(1.0, tail.top) * tail.fall * tail.fall * tail.fall;
}

static double nearest(const FcCourse* course) {
    double most = 0.0;
    for (int i = 0; i < course->count; i++) {
        most = fmax(most, fabs(course->delta[i]) / course->D[i]);
    }
    return most;
}

static void take(const FcPanelAt* at, double h, const FcTrajectories* from, FcPanel* panel,
                 double* evaluations) {
    if (at->nodes == 0) {
        fc_radau_panel(at->scene, at->t, h, at->sign, from, panel);
        *evaluations += FC_RADAU_STAGES;
        return;
    }
    fc_gauss_panel(at->scene, at->t, h, at->nodes, from, panel);
    const double X = fc_drive_displacement(&at->scene->drive, at->t, at->t + h);
    panel->map.offset += (1.0 - panel->map.relaxation) * (X - panel->displacement);
    *evaluations += at->nodes;
}

FcWatched fc_watch_panel(FcWatch* watch, const FcInterval* interval, const FcPanelAt* at,
                         const FcTrajectories* from, FcPanel* panel, double* h, double* evaluations) {
    *h = at->h;
    FcCourse course = course_of(watch, at, from->delta_0, panel, evaluations);
    const int last = course.count - 1;
    assert(at->h > 0.0 && course.count <= FC_MOST_POINTS);
    const double sigma = interval->stiffness;
    // In a light piece of a step whose load rises, the tolerance of the bound's own force counts.
    const double may = fc_least(fc_allowed_force(interval) / sigma, interval->tolerance * course.D[last]) *
                       fc_least(1.0, watch->reach / course.D[last]); // m
    const double missed = missed_between(at, &course) * course.D[last];
    if (nearest(&course) * course.D[last] > course.D[last] - NEAR_BOUND * missed &&
        missed > fc_most(FC_ROUNDING_OF_MEETING * course.D[last], FC_SHARE_OF_GRAZE * may)) {
        return FC_UNRESOLVED;
    }
    const double over = fc_most(FC_ROUNDING_OF_MEETING * course.D[last], FC_SHARE_OF_EVENT * may);
    const FcMeeting met = fc_first_meeting(&course, over, 0.0, evaluations);
    if (met.side == 0) {
        return FC_MEETS_NONE;
    }
    double low = 0.0;
    double high = at->h;
    double cut = fmin(at->h, met.t - at->t);
    for (int tries = 0; cut > 0.0; tries++) {
        take(at, cut, from, panel, evaluations);
        set_end(watch, at->scene, at->t + cut, deflection(&panel->map, from->delta_0), last, &course);
        *evaluations += 1.0;
        const double beyond = met.side * course.delta[last] - course.D[last];
        if (fabs(beyond) <= fc_most(FC_ROUNDING_OF_MEETING * course.D[last], FC_SHARE_OF_CUT * may) ||
            (tries >= MOST_CUTS && beyond > 0.0)) {
            break;
        }
        const double rate = fc_approach(&course, met.side, last);
        *evaluations += 1.0;
        if (beyond < 0.0 && (!(rate > 0.0) || tries >= MOST_CUTS)) { // it has turned back: freely so far
            *h = cut;
            return FC_MEETS_NONE;
        }
        if (beyond < 0.0) {
            low = cut;
        } else {
            high = cut;
        }
        const double next = cut - beyond / rate;
        cut = next > low && next < high ? next : high > low && high < at->h ? 0.5 * (low + high) : at->h;
        if (low >= at->h) { // not before the panel's end
            return FC_MEETS_NONE;
        }
    }
    assert(cut <= at->h);
    *h = cut;
    if (!(cut > 0.0)) {
        panel->map = fc_map_identity();
    }
    watch->met = (FcMeeting){met.side, at->t + cut};
    return FC_MEETS;
}
