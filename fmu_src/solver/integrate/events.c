#include "solver/integrate/events.h"

#include <assert.h>
#include <math.h>

#include "model/bound.h"
#include "model/extremes.h"
#include "model/root.h"
#include "solver/integrate/dense_output.h"
#include "solver/integrate/tuning.h"

enum { STAGES = FC_STAGES, POINTS = FC_POINTS, START = FC_STAGES, LAST = FC_STAGES - 1 };

// Parts of the largest push. A push below the first is rounding. Below the second a slipping bristle may be
// released, or a place of a panel taken for its end: derived, since the rest of a push acts with its square.
static const double ROUNDING_OF_PUSH = 1e-13;
static const double LITTLE_PUSH = 1e-9;
// The time after t at which a push that is 0 at t shows its sign, over the time in which it changes. Chosen: the change is
// then far above rounding, and far below the whole.
static const double SHORTLY_AFTER = 1e-6;
// The rounding of a way, over the largest push times the time: two roundings of the time.
static const double ROUNDING_OF_TIME = 4e-16;
// The largest distance from the bound that counts as 0, over the bound. Chosen: if D moves by decades, nothing is near it.
static const double MAX_DISTANCE = 1e-3;

// The number of times in which a panel is cut at the same event. Derived: each cut leaves less than a tenth of the way
// to it, or half of it.
enum { MAX_CUTS = 40 };

// ---- the push of a bristle that slips ----

static FcVector direction(FcVector delta) { return fc_direction(delta, (FcVector){1.0, 0.0}); }

// The rounding of a push that is known at the points; the curve may move the bound faster than the limit does.
static double rounding_of_push(const FcIntegrator* integrator, const double push[POINTS]) {
    double largest = fc_largest_push(integrator);
    for (int i = 0; i < POINTS; i++) {
        largest = fc_max(largest, fabs(push[i]));
    }
    return (integrator->bristle.is_stalled ? LITTLE_PUSH : ROUNDING_OF_PUSH) * largest;
}

bool fc_is_unloading(const FcIntegrator* integrator, FcVector n) {
    const FcInterval* interval = integrator->interval;
    const double t = integrator->at.t;
    FcPushed pushed = {integrator->plane, FC_SLIPPING, n};
    const double push = fc_push_at(&pushed, t);
    if (fabs(push) > ROUNDING_OF_PUSH * fc_largest_push(integrator)) {
        return push < 0.0;
    }
    const FcVelocity now = fc_drive_velocity(&interval->scene->drive, t);
    const double time = fc_min(fc_smooth_time(&interval->pace),
                               fc_velocity_time_of_change(&now, interval->scene->friction->V_S));
    return fc_push_at(&pushed, t + SHORTLY_AFTER * fc_min(time, interval->duration - t)) < 0.0;
}

// ---- the begin and the end of a slip ----

bool fc_begin_slip(FcIntegrator* integrator, bool surely) {
    const FcPlane* plane = integrator->plane;
    const double t = integrator->at.t;
    const FcPhase phase = fc_drive_phase(&plane->scene->drive, t);
    const FcPlaneCoefficients at = fc_plane_coefficients(plane, t, phase);
    const FcPlaneBound held = fc_plane_bound(plane, &at, integrator->bristle.state, t, phase);
    const FcVector delta = fc_integrator_delta(integrator);
    const FcVector n = direction(delta);
    const double push = fc_plane_push(plane, &at, &held, n);
    if (!surely && !(push > ROUNDING_OF_PUSH * fc_largest_push(integrator))) {
        return false;
    }
    // The energy that it loses is heat, also that of its small excess over the bound.
    const double size = hypot(delta.x, delta.y);
    const double D = fc_plane_radius(plane, &at, FC_SLIPPING);
    integrator->sums.heat += fc_drop_heat(at.sigma, size, D);
    integrator->sums.drag += (D - size) * fc_product(n, at.V);
    fc_set_delta(integrator, (FcVector){D * n.x, D * n.y});
    integrator->sums.meetings++;
    integrator->bristle.touches =
        integrator->bristle.state != FC_FREE || !fc_has_static_friction(plane->scene->friction);
    integrator->bristle.state = surely || !fc_is_unloading(integrator, n) ? FC_SLIPPING : FC_FREE;
    integrator->h = 0.0;
    // In the plane its direction relaxes.
    const double turning = at.sigma * D * fabs(fc_across(n, at.V));
    if (turning > 0.0) {
        integrator->control.log_transient =
            log(turning / (at.speed * fc_allowed_force(integrator->interval)));
    }
    return true;
}

void fc_end_slip(FcIntegrator* integrator) {
    integrator->bristle.touches = false;
    integrator->bristle.state = FC_FREE;
}

// ---- a free bristle ----

// |delta|^2 - D^2 at the points of a free panel.
static void find_to_bound(const FcIntegrator* integrator, const FcNodes* nodes, FcPanel* panel) {
    for (int i = 0; i < POINTS; i++) {
        const FcPlaneCoefficients at = fc_nodes_at(nodes, i);
        const double D = fc_plane_radius(integrator->plane, &at, integrator->bristle.state);
        panel->to_bound[i] = fc_product(panel->delta[i], panel->delta[i]) - D * D;
    }
}

// The distance of |delta|^2 from D^2 [m2] that counts as 0: the rounding of a stuck bristle's way, or else an error that
// heat and force allow.
static double close_to_bound(const FcIntegrator* integrator, double D) {
    const FcInterval* interval = integrator->interval;
    double distance = FC_ROUNDING_OF_DEFLECTION * D;
    if (fc_kind(integrator) == FC_STICKS) {
        const double of_time =
            fabs(integrator->at.u) * fc_time_map_dt_du(&integrator->part.in, integrator->at.u) +
            interval->duration;
        distance += ROUNDING_OF_TIME * fc_largest_push(integrator) * of_time;
    } else { // an excess over the bound costs heat, whose tolerance goes with the path
        const double allowed =
            fc_min(fc_allowed_force(interval) / interval->stiffness, interval->tolerance * D) *
            fc_min(1.0, interval->speed * interval->duration / D);
        distance = fc_max(distance, FC_SHARE_OF_EVENT * allowed);
    }
    return 2.0 * D * fc_min(distance, MAX_DISTANCE * D);
}

// The part of a panel by which it may begin or end beside a top. Derived: |delta| is less by its square, 1e-12
// of the panel's motion.
static const double BESIDE_TOP = 1e-6;

// The place in a panel, over its length, at which a free bristle is nearest to its bound; 2 if |delta| is below 0.7
// D at all points. The polynomial of |delta|^2 is too coarse to say whether it touches the bound there: with static
// friction it decides a break-away, and in a settled state the slips are as small as the drift in a period.
static double top_at_bound(const FcIntegrator* integrator, const FcNodes* nodes, const FcPanel* panel) {
    bool is_near = false;
    bool falls = false; // a top is not before a point that is higher than all before it
    for (int i = 0; i < POINTS; i++) {
        const FcPlaneCoefficients at = fc_nodes_at(nodes, i);
        const double D = fc_plane_radius(integrator->plane, &at, integrator->bristle.state);
        is_near = is_near || panel->to_bound[i] > -0.5 * D * D;
        falls = falls || (i < STAGES && panel->to_bound[i] < panel->to_bound[i > 0 ? i - 1 : START]);
    }
    if (!is_near || !falls) {
        return 2.0;
    }
    double recedes[POINTS];
    for (int i = 0; i < POINTS; i++) {
        const FcPlaneCoefficients at = fc_nodes_at(nodes, i);
        const FcPlaneBound held =
            fc_plane_bound(integrator->plane, &at, integrator->bristle.state, nodes->t[i], nodes->phase[i]);
        const FcVector n = {panel->delta[i].x / held.D, panel->delta[i].y / held.D};
        recedes[i] = -fc_plane_push(integrator->plane, &at, &held, n);
    }
    const double top =
        FC_FASTEST(fc_first_upcrossing)(recedes, ROUNDING_OF_PUSH * fc_largest_push(integrator));
    return top > BESIDE_TOP && top < 1.0 - BESIDE_TOP ? top : 2.0;
}

// |delta|^2 - D^2 of a stuck bristle at a place of the part.
static double stuck_to_bound(void* context, double u) {
    const FcIntegrator* integrator = context;
    const double t = fc_part_time(&integrator->part, u);
    FcVector delta = fc_integrator_delta(integrator);
    delta.x += fc_drive_displacement(&integrator->interval->scene->drive, integrator->at.t, t);
    if (!integrator->plane->is_one_dimensional) {
        delta.y += fc_drive_displacement(&integrator->across, integrator->at.t, t);
    }
    const FcPlaneCoefficients at = fc_coefficients_at(integrator, t);
    const double D = fc_plane_radius(integrator->plane, &at, integrator->bristle.state);
    return fc_product(delta, delta) - D * D;
}

// The shortest part to which a panel is cut whose points do not resolve the motion near its start.
static const double SHORTENED_BY = 1.0 / 32.0;

// The place in a panel of the length h, over it, at which it is cut: where it meets its bound. That of a stuck
// bristle is exact, if a point of the panel lies beyond the bound.
static double place_of_meeting(FcIntegrator* integrator, const FcPanel* panel, double h, double meets,
                               double over, bool* is_exact) {
    const double* f = panel->to_bound;
    const double u = integrator->at.u;
    double a = u;
    double at_a = f[START];
    *is_exact = false;
    for (int i = 0; i < STAGES && fc_kind(integrator) == FC_STICKS && at_a < 0.0; i++) {
        const double b = u + (0.5 + FC_RADAU.node[i]) * h;
        if (b >= u + meets * h && f[i] > over) {
            *is_exact = true;
            const double root =
                fc_root_between(stuck_to_bound, integrator, a, at_a, b, f[i], over, &integrator->evaluations);
            return (root - u) / h;
        }
        a = b;
        at_a = f[i];
    }
    return fc_max(meets, SHORTENED_BY);
}

// The place in a panel, over its length, after which that push is negative; 0 if it is nowhere positive, 2 if
// there is none.
static double end_of_push(const FcIntegrator* integrator, const double push[POINTS]) {
    const double rounding = rounding_of_push(integrator, push);
    double inwards[POINTS];
    bool is_pushed = integrator->bristle.is_stalled;
    for (int i = 0; i < POINTS; i++) {
        inwards[i] = -push[i];
        is_pushed = is_pushed || push[i] > rounding;
    }
    return inwards[START] > rounding || !is_pushed ? 0.0 : FC_FASTEST(fc_first_upcrossing)(inwards, rounding);
}

// Whether the push of a slipping bristle that lies inside its bound, after an input has jumped, ends in the
// panel. The panel then ends there, and the bristle sticks unless it has met its bound before.
static bool catches_up(FcIntegrator* integrator, FcNodes* nodes, FcPanel* panel, double* h) {
    for (int cuts = 0;; cuts++) {
        double push[POINTS];
        for (int i = 0; i < POINTS; i++) {
            const FcPlaneCoefficients at = fc_nodes_at(nodes, i);
            const FcPlaneBound bound =
                fc_plane_bound(integrator->plane, &at, FC_SLIPPING, nodes->t[i], nodes->phase[i]);
            push[i] = fc_plane_push(integrator->plane, &at, &bound, direction(panel->delta[i]));
        }
        const double ends = end_of_push(integrator, push);
        if (ends > 1.0 - LITTLE_PUSH ||
            cuts >= 4) { // a push of 0 at the end is decided by the motion after it
            return cuts > 0;
        }
        *h *= fc_max(ends, LITTLE_PUSH);
        fc_resolve_shorter(integrator, *h, nodes, panel);
    }
}

// Cuts a free panel where the bristle meets its bound, or at a top beside it; true if it meets it. What counts as 0 in
// to_bound at the panel's end is in *over.
// - The panel is made again up to the event, which its own points then show more accurately.
// - A panel that dips inside the bound between its points is shortened.
// - An exact meeting is the first one, unless there is a top before it.
static bool cut_at_meeting(FcIntegrator* integrator, FcNodes* nodes, FcPanel* panel, double* h,
                           double* over) {
    bool is_cut = false;
    bool is_exact = false;
    for (int cuts = 0; cuts < MAX_CUTS; cuts++) {
        find_to_bound(integrator, nodes, panel);
        const FcPlaneCoefficients begin = fc_nodes_at(nodes, START);
        const double D_begin = fc_plane_radius(integrator->plane, &begin, integrator->bristle.state);
        if (integrator->bristle.touches &&
            panel->to_bound[START] <= 4.0 * FC_ROUNDING_OF_BOUND * D_begin * D_begin) {
            panel->to_bound[START] = fc_min(panel->to_bound[START], 0.0); // by rounding it may begin beyond
        }
        const FcPlaneCoefficients end = fc_nodes_at(nodes, LAST);
        *over =
            close_to_bound(integrator, fc_plane_radius(integrator->plane, &end, integrator->bristle.state));
        const double meets = is_exact ? 2.0 : FC_FASTEST(fc_first_upcrossing)(panel->to_bound, *over);
        const double top = meets > 1.0 ? top_at_bound(integrator, nodes, panel) : 2.0;
        if (meets > 1.0 && top > 1.0) {
            break;
        }
        is_cut = meets <= 1.0 || (is_cut && !is_exact);
        is_exact = false;
        *h *= meets > 1.0 ? top : place_of_meeting(integrator, panel, *h, meets, *over, &is_exact);
        fc_resolve_shorter(integrator, *h, nodes, panel);
    }
    return is_cut;
}

void fc_free_until_event(FcIntegrator* integrator) {
    assert(integrator->bristle.state != FC_SLIPPING);
    if (integrator->bristle.state == FC_CATCHING_UP &&
        fc_is_unloading(integrator, direction(fc_integrator_delta(integrator)))) {
        fc_end_slip(integrator);
        return;
    }
    if (integrator->bristle.touches && fc_begin_slip(integrator, integrator->bristle.is_stalled)) {
        return;
    }
    FcNodes nodes;
    FcPanel panel;
    double h = fc_step_adaptive(integrator, &nodes, &panel);
    if (!integrator->bristle.is_bounded) {
        fc_accept_panel(integrator, &nodes, &panel, h);
        return;
    }
    const bool gives_up =
        integrator->bristle.state == FC_CATCHING_UP && catches_up(integrator, &nodes, &panel, &h);
    double over = 0.0;
    const bool is_cut = cut_at_meeting(integrator, &nodes, &panel, &h, &over);
    fc_accept_panel(integrator, &nodes, &panel, h);
    integrator->bristle.touches = panel.to_bound[LAST] >= -over;
    if (gives_up && !is_cut) {
        fc_end_slip(integrator);
    }
    if (is_cut && !integrator->bristle.touches) {
        integrator->h = 4.0 * h; // the panel was too long for its points
    }
}

// ---- a slipping bristle ----

// A slip from start to end keeps of a deviation the part along the circle. By D a' = V_y cos a - V sin a it
// changes as D does, and by the panel's z.
static void turn_derivatives(FcIntegrator* integrator, FcVector start, FcVector end) {
    for (int k = 0; k < 2; k++) {
        FcVector* by = &integrator->sums.by_start[k];
        const double turned = fc_across(start, *by) / fc_product(start, start);
        *by = (FcVector){-turned * end.y, turned * end.x};
    }
}

// Cuts a panel that slips where its push ends, which its own points show better from cut to cut; false if it does not end.
static bool cut_at_end_of_push(FcIntegrator* integrator, FcNodes* nodes, FcPanel* panel, double* h,
                               double* ends) {
    const bool is_cut = *ends < 1.0;
    for (int cuts = 0; cuts < MAX_CUTS && *ends > 0.0 && *ends < 1.0; cuts++) {
        *h *= *ends;
        fc_resolve_shorter(integrator, *h, nodes, panel);
        *ends = end_of_push(integrator, panel->to_bound);
    }
    return is_cut;
}

void fc_slip_until_event(FcIntegrator* integrator) {
    assert(integrator->bristle.state == FC_SLIPPING);
    const bool is_one_dimensional = integrator->plane->is_one_dimensional;
    FcNodes nodes;
    FcPanel panel;
    double h = fc_step_adaptive(integrator, &nodes, &panel);
    if (isnan(integrator->along.offset)) {
        return;
    }
    // A push of 0 at the start decides just after.
    double ends = end_of_push(integrator, panel.to_bound);
    if (ends > 0.0 && !integrator->bristle.is_stalled &&
        panel.to_bound[START] <= rounding_of_push(integrator, panel.to_bound) &&
        fc_is_unloading(integrator, direction(fc_integrator_delta(integrator)))) {
        ends = 0.0;
    }
    const bool is_cut = cut_at_end_of_push(integrator, &nodes, &panel, &h, &ends);
    bool is_over = is_cut;
    if (ends > 0.0) {
        if (is_one_dimensional) {
            fc_note_slip(integrator, nodes.t[START], nodes.t[LAST], panel.delta[0].x < 0.0 ? -1 : 1);
        } else {
            turn_derivatives(integrator, panel.delta[START], panel.delta[LAST]);
        }
        // If V is just 0 at the end, the motion after it decides.
        is_over = is_cut && panel.to_bound[LAST] < LITTLE_PUSH * fc_largest_push(integrator);
        fc_accept_panel(integrator, &nodes, &panel, h);
    }
    if (is_over) {
        fc_end_slip(integrator);
    } else if (is_cut) {
        integrator->h = 4.0 * h; // the panel was too long for its points
    }
}
