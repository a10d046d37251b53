#include "solver/body/body_march.h"

#include <assert.h>
#include <float.h>
#include <math.h>

#include "model/motion.h"
#include "solver/body/body_stuck.h"
#include "solver/integrate/dense_output.h"
#include "solver/integrate/march.h"
#include "solver/integrate/tuning.h"
#include "solver/panel/panel_error.h"

enum { STAGES = FC_STAGES, POINTS = FC_POINTS, START = FC_STAGES, LAST = FC_STAGES - 1 };

// |delta|^2 less D^2 at a meeting of a stuck bristle, over D^2: two roundings.
static const double ROUNDING_OF_MEETING = 4e-16;

typedef struct {
    const FcPlane* plane;
    const FcInterval* interval;
    const FcBody* body; // at the start of the step
    double speed;       // m/s, the largest |w|
    bool is_bounded;
    FcPart part; // up to the end of the step or of a period, with the present variable
    double t;    // s
    FcBodyStart at;
    double h;          // s, proposed for the next panel; 0 for none
    FcBodyStuck stuck; // the motion from here on, if
    bool is_known;     // it has a closed form
    double x;          // m, the displacement
    FcStepResult sums; // impulse, work and heat are those of F_t
    double solves;
} March;

static const FcFriction* friction_of(const March* march) { return march->plane->scene->friction; }

static FcPlaneCoefficients coefficients(const March* march, FcPhase* phase) {
    *phase = fc_drive_phase(&march->plane->scene->drive, march->t);
    return fc_plane_coefficients(march->plane, march->t, *phase);
}

// The rates at the present time, whose coefficients are known.
static FcBodyRates rates_at(const March* march, const FcPlaneCoefficients* at, FcPhase phase) {
    return fc_body_rates(march->plane, march->body, &march->at, march->t, phase, at->sigma, at->static_limit);
}

static void use_variable(March* march, double center, double length) {
    assert(length > 0.0);
    march->part.in = (FcTimeMap){isfinite(length) ? center : 0.0, length};
}

// ---- events ----

typedef enum { NO_EVENT, REVERSAL, MEETING, END_OF_PUSH, JUMP, CURVE } Event;

// The radius of the bound that a free bristle meets.
static double radius(const FcNodes* nodes, int i) { return nodes->static_limit[i] / nodes->sigma[i]; }

// How close to 0 the function of an event counts as there.
typedef struct {
    double rounding;
    double allowed; // what it may be at the end of a panel that is cut there
} Close;

// The function whose rise above 0 is the event, at the points.
static Close event_function(const March* march, Event event, const FcNodes* nodes, const FcBodyPanel* panel,
                            double f[POINTS]) {
    assert(event != NO_EVENT);
    const FcFriction* friction = friction_of(march);
    const double tolerance = march->interval->tolerance;
    const double D = radius(nodes, LAST);
    const double rounding = FC_BODY_ROUNDING * march->speed;
    double allowed;
    double way; // m, of the bristle in the panel, at most its bound: heat is as accurate as the path is long
    switch (event) {
    case REVERSAL:
        for (int i = 0; i < POINTS; i++) {
            f[i] = -march->at.side * panel->w[i];
        }
        way = fc_min(D, fc_max(fabs(panel->w[START]), fabs(panel->w[LAST])) * nodes->duration);
        allowed = FC_BODY_SHARE_OF_LAYER * sqrt(2.0 * tolerance * way * fabs(panel->rate[LAST].w));
        return (Close){rounding, fc_max(rounding, allowed)};
    case MEETING: // of the squares, which are smooth where delta is 0
        for (int i = 0; i < POINTS; i++) {
            f[i] = (panel->delta[i] - radius(nodes, i)) * (panel->delta[i] + radius(nodes, i));
        }
        if (f[START] <= 2.0 * FC_ROUNDING_OF_BOUND * D * D) { // by rounding it may begin beyond
            f[START] = fc_min(f[START], 0.0);
        }
        allowed = fc_max(FC_BODY_ROUNDING,
                         (fc_has_static_friction(friction) ? FC_BODY_SHARE_OF_DROP : FC_BODY_SHARE_OF_EVENT) *
                             tolerance);
        // One that relaxes may come to it without an end.
        return (Close){(march->at.kind == FC_RELAXES ? allowed : ROUNDING_OF_MEETING) * D * D,
                       allowed * D * D};
    case END_OF_PUSH: // a velocity, over that of the ringing
        for (int i = 0; i < POINTS; i++) {
            f[i] = -panel->rate[i].push;
        }
        allowed = FC_BODY_SHARE_OF_EVENT * tolerance * march->interval->force /
                  sqrt(march->body->m * nodes->sigma[LAST]);
        return (Close){rounding, fc_max(rounding, allowed)};
    case JUMP: // along a bound that follows w: the damper takes all of the mass's inertia
        for (int i = 0; i < POINTS; i++) {
            f[i] = FC_MIN_INERTIA - panel->rate[i].inertia;
        }
        return (Close){0.0, 0.1 * FC_MIN_INERTIA};
    default:
        for (int i = 0; i < POINTS; i++) {
            f[i] = FC_END_OF_CURVE * friction->V_S - fabs(panel->w[i]);
        }
        allowed = 0.5 * (FC_BODY_MARGIN_OF_CURVE - 1.0) * FC_END_OF_CURVE * friction->V_S;
        return (Close){allowed, allowed};
    }
}

// The place at which an event comes in the panel, over its length; 2 if it does not.
static double place_of(const March* march, Event event, const FcNodes* nodes, const FcBodyPanel* panel) {
    double f[POINTS];
    const Close close = event_function(march, event, nodes, panel, f);
    return FC_FASTEST(fc_first_upcrossing)(f, close.rounding);
}

// The slope of the polynomial through the points at the panel's end, over the panel.
static double slope_at_end(const double f[POINTS]) {
    double slope = 0.0;
    for (int i = 0; i < POINTS; i++) {
        if (i != LAST) {
            slope += FC_RADAU.barycentric[i] / FC_RADAU.barycentric[LAST] * (f[i] - f[LAST]) /
                     (FC_RADAU.node[LAST] - FC_RADAU.node[i]);
        }
    }
    return slope;
}

// The same of a meeting, also at a top between the last two points, which no sample shows: of the parabola with the slope at the
// end. A top that is farther below the bound than above the end is none.
static double place_of_meeting(const March* march, const FcNodes* nodes, const FcBodyPanel* panel) {
    double f[POINTS];
    const Close close = event_function(march, MEETING, nodes, panel, f);
    const double place = FC_FASTEST(fc_first_upcrossing)(f, close.rounding);
    if (place <= 1.0 || f[LAST] <= f[LAST - 1]) {
        return place;
    }
    const double slope = slope_at_end(f);
    if (slope < 0.0) {
        const double x = FC_RADAU.node[LAST] - FC_RADAU.node[LAST - 1];
        const double bend = (f[LAST] - f[LAST - 1] - slope * x) / (x * x);
        const double above = 0.25 * slope * slope / bend;
        return f[LAST] + 2.0 * above > 0.0 ? 1.0 + 0.5 * slope / bend : place;
    }
    return place;
}

// The same of a reversal. A w that begins beyond 0, as far as an event may miss it, may come back between two samples: the
// points are close at the start.
static double place_of_reversal(const March* march, const FcNodes* nodes, const FcBodyPanel* panel) {
    double place = place_of(march, REVERSAL, nodes, panel);
    const int side = march->at.side;
    for (int i = 1; i < STAGES && place > 1.0; i++) {
        if (side * panel->w[i - 1] >= 0.0 && side * panel->w[i] < 0.0) {
            place = FC_RADAU.node[i] + 0.5;
        }
    }
    return place;
}

// The first event in the panel and its place. A panel that comes into a Stribeck curve is cut there before it is asked for
// others, since its points do not show the curve.
static Event first_event(const March* march, const FcNodes* nodes, const FcBodyPanel* panel, double* place) {
    const FcFriction* friction = friction_of(march);
    const FcKind kind = march->at.kind;
    if (fc_has_stribeck_curve(friction) && kind != FC_STICKS &&
        fabs(panel->w[START]) > FC_BODY_MARGIN_OF_CURVE * FC_END_OF_CURVE * friction->V_S) {
        *place = place_of(march, CURVE, nodes, panel);
        if (*place <= 1.0) {
            return CURVE;
        }
    }
    Event first = NO_EVENT;
    *place = 2.0;
    if (kind == FC_RELAXES) {
        first = REVERSAL;
        *place = place_of_reversal(march, nodes, panel);
    }
    if (kind == FC_SLIPS || march->is_bounded) {
        const Event at_bound = kind == FC_SLIPS ? END_OF_PUSH : MEETING;
        const double bound = kind == FC_SLIPS ? place_of(march, at_bound, nodes, panel)
                                              : place_of_meeting(march, nodes, panel);
        first = bound < *place ? at_bound : first;
        *place = fc_min(*place, bound);
    }
    if (kind == FC_SLIPS && friction->sigma_1 != 0.0 && fc_has_static_friction(friction)) {
        const double jump = place_of(march, JUMP, nodes, panel);
        first = jump < *place ? JUMP : first;
        *place = fc_min(*place, jump);
    }
    assert(*place >= 0.0);
    return *place <= 1.0 ? first : NO_EVENT;
}

// ---- panels ----

// The panel of a motion that is known.
static void take_stuck(const March* march, FcNodes* nodes, FcBodyPanel* panel) {
    assert(march->is_known && march->at.kind == FC_STICKS);
    for (int i = 0; i < POINTS; i++) {
        const double x = nodes->t[i] - nodes->t[START];
        double integral;
        panel->delta[i] = fc_body_stuck_delta(&march->stuck, x, &panel->w[i], &integral);
        panel->v[i] = panel->w[i] - nodes->V[i];
    }
    panel->delta[START] = march->at.delta;
    panel->v[START] = march->at.v;
    fc_body_panel_rates(march->plane, march->body, &march->at, nodes, panel);
}

static bool make(March* march, double u, double h, FcNodes* nodes, FcBodyPanel* panel) {
    FC_FASTEST(fc_nodes_make)(march->plane, &march->part, u, h, nodes);
    if (march->is_known) {
        take_stuck(march, nodes, panel);
        march->solves += 1.0;
        return true;
    }
    return FC_FASTEST(fc_body_panel)(march->plane, march->body, &march->at, fc_allowed_force(march->interval),
                                     nodes, panel, &march->solves);
}

// The factor by which the errors of a panel are too large.
// - The slopes of delta and v that the collocation does not resolve act at the end as a force, by the spring and the dampers,
//   which lives until the bristle forgets it, and on the momentum.
// - The quadratures act on work and heat: those of the spring and of the dampers.
static double error_ratio_of(const March* march, const FcNodes* nodes, const FcBodyPanel* panel) {
    const FcInterval* interval = march->interval;
    const FcKind kind = march->at.kind;
    const double m = march->body->m;
    const double H = interval->duration;
    const double omega = sqrt(nodes->sigma[LAST] / m);
    double FC_PAIRED of_delta[POINTS];
    double FC_PAIRED of_v[POINTS];
    double F[POINTS];
    double FC_PAIRED damped[POINTS]; // N
    const FcFriction* friction = friction_of(march);
    double z = kind == FC_SLIPS ? 0.0 : omega * nodes->duration;
    for (int i = 0; i < POINTS; i++) {
        F[i] = nodes->sigma[i] * panel->delta[i];
        damped[i] = (friction->sigma_1 * panel->rate[i].delta + friction->sigma_2 * panel->w[i]) *
                    (1.0 + panel->w[i] / march->speed) * nodes->tau[i] / nodes->duration;
        of_delta[i] = nodes->tau[i] * panel->rate[i].delta;
        of_v[i] = nodes->tau[i] * panel->rate[i].v;
        z += FC_RADAU.weight[i] * nodes->tau[i] * panel->rate[i].relaxation;
    }
    // The parts of a slope that cancel are rounded: delta' of w and the relaxation, v' of the forces.
    const double w = fc_max(fabs(panel->w[START]), fabs(panel->w[LAST]));
    const double forces = fabs(fc_input_after(march->body->F, nodes->t[LAST])) + fabs(F[LAST]) +
                          (2.0 * friction->sigma_1 + friction->sigma_2) * w;
    const double rounded = FC_ROUNDING_OF_TAIL * fc_max(nodes->tau[START], nodes->tau[LAST]); // s
    const double e_v = fc_max(0.0, m * fc_radau_unresolved(of_v, z) - rounded * forces);      // N s
    double of_end = (friction->sigma_1 + friction->sigma_2) / m * e_v;                        // N
    double life = H;
    if (kind != FC_SLIPS) {
        const double r = panel->rate[LAST].relaxation;
        const double e_delta = fc_max(0.0, fc_radau_unresolved(of_delta, z) - rounded * 2.0 * w); // m
        of_end += interval->stiffness * e_delta / (1.0 + nodes->tau[LAST] * r) + omega * e_v;
        life = fc_min(H, 3.0 / (r + 1.0 / H));
    }
    assert(!(of_end < 0.0 || e_v < 0.0 || life < 0.0));
    const double share = fc_min(1.0, fc_max(1e-3, nodes->duration / life));
    const double share_of_mean = fc_min(1.0, fc_max(1e-3, nodes->duration / H));
    const double motion = fc_max(of_end / share, e_v / (H * share_of_mean));
    const double energy =
        share_of_mean * (fc_error_of_force(nodes, march->speed, 0.0, kind != FC_STICKS, F, panel->w) +
                         fc_radau_quadrature_error(damped));
    return fc_max(FC_BODY_SAFETY * motion, FC_SAFETY / FC_SHARE_OF_MEAN * energy) /
           fc_allowed_force(interval);
}

// The longest duration [s] of the next panel, before it is judged.
static double planned(const March* march) {
    const FcDrive* drive = &march->plane->scene->drive;
    const FcKind kind = march->at.kind;
    assert(march->t <= march->part.end && kind != FC_NO_BRISTLE);
    const double ringing = sqrt(march->interval->stiffness / march->body->m);
    double h = fc_min(march->part.end - march->t, FC_BODY_MAX_PHASE * fc_smooth_time(&march->interval->pace));
    if (march->h > 0.0) {
        h = fc_min(h, march->h);
    }
    const FcFriction* friction = friction_of(march);
    const bool sees_curve =
        kind != FC_STICKS && fc_has_stribeck_curve(friction) && isinf(march->part.in.length);
    const bool is_proposed = kind == FC_SLIPS || (kind == FC_RELAXES && march->h > 0.0);
    if (is_proposed && !sees_curve) {
        return h;
    }
    FcPhase phase;
    const FcPlaneCoefficients at = coefficients(march, &phase);
    const double w = march->at.v + at.V.x;
    const double jerk = drive->omega * drive->omega * fabs(drive->vibration.V_1); // m/s3, at most
    if (sees_curve && fabs(w) < FC_BODY_MARGIN_OF_CURVE * FC_END_OF_CURVE * friction->V_S) {
        // What begins inside, or turns there, may leave the curve before the first point.
        const double w_rate = rates_at(march, &at, phase).w;
        h = fc_min(h, fc_time_to_move(fabs(w_rate), jerk, fc_max(friction->V_S, 0.5 * fabs(w))));
    }
    if (is_proposed) {
        return h;
    }
    if (kind == FC_RELAXES) {
        return fc_min(h, fc_min(1.5 / ringing, 3.0 / (at.sigma * fabs(w) / at.limit + DBL_MIN)));
    }
    // A stuck bristle goes some radii of its bound: so far the points show a meeting.
    const double way = FC_MAX_RADII * at.static_limit / at.sigma;
    h = fc_min(h, fc_time_to_move(fabs(w), fabs(rates_at(march, &at, phase).w), way));
    h = jerk > 0.0 ? fc_min(h, cbrt(6.0 * way / jerk)) : h;
    return march->is_known  ? fc_min(h, FC_BODY_MAX_PHASE / ringing)
           : march->h > 0.0 ? h
                            : fc_min(h, 1.0 / ringing);
}

// Makes the next panel, as long as it is accurate; *h becomes its length in u. False if none is.
static bool take_accurate(March* march, double u, double* h, FcNodes* nodes, FcBodyPanel* panel) {
    const FcTimeMap* in = &march->part.in;
    *h = fc_time_map_u(in, fc_min(march->part.end, march->t + planned(march))) - u;
    *h = *h > 0.0 ? *h
                  : fc_time_map_u(in, march->part.end) - u; // what is planned is less than t is rounded by
    if (isfinite(in->length)) {
        *h = fc_min(*h, FC_BODY_MAX_LENGTH_U);
    }
    assert(*h > 0.0);
    for (int tries = 0;; tries++) {
        const bool is_solved = make(march, u, *h, nodes, panel);
        const double error_ratio = march->is_known ? 0.0
                                   : is_solved     ? error_ratio_of(march, nodes, panel)
                                                   : HUGE_VAL;
        if (error_ratio <= 1.0 || tries >= FC_BODY_MAX_REJECTIONS) {
            const double grows =
                tries > 0 ? 1.0 : fc_min(4.0, 0.9 * pow(fc_max(error_ratio, 1e-30), -1.0 / 16.0));
            march->h = march->is_known ? 0.0 : nodes->duration * grows;
            return error_ratio <= 1.0;
        }
        *h *= isfinite(error_ratio) ? fc_min(0.9, fc_max(0.2, 0.9 * pow(error_ratio, -1.0 / 14.0))) : 0.4;
    }
}

// Cuts the panel of the length *h in u at its first event, which its own points show better from cut to cut. False if a part
// of it cannot be solved, or if the event does not come nearer. After each cut the panel
// - is not solved: a length between it and the last one that shows the event is next
// - ends at the event: done
// - shows an event before its end: that one is next
// - shows none: its end moves by Newton's method, or a longer panel is next, or the event is none
static bool cut_at_event(March* march, double u, double* h, FcNodes* nodes, FcBodyPanel* panel,
                         Event* event) {
    double place;
    double seen = *h; // the length of the last panel that shows the event
    bool is_solved = true;
    *event = first_event(march, nodes, panel, &place);
    for (int cuts = 0; *event != NO_EVENT && cuts < FC_BODY_MAX_CUTS; cuts++) {
        assert(place > 0.0 && place <= fc_max(1.5, seen / *h));
        *h *= place;
        is_solved = make(march, u, *h, nodes, panel);
        if (!is_solved) { // beyond the end of a push a long panel may have a solution, and a shorter one none
            seen = *h;
            place = FC_BODY_BETWEEN;
            continue;
        }
        double f[POINTS];
        const double close = event_function(march, *event, nodes, panel, f).allowed;
        const bool is_there = fabs(f[LAST]) <= close;
        const Event now = first_event(march, nodes, panel, &place);
        // A short panel that begins as close to the event as it ends does not show that it comes.
        const bool begins_there = fabs(f[START]) <= close && *h < FC_BODY_BETWEEN * seen;
        if (is_there && (now == *event || (now == NO_EVENT && !begins_there))) {
            return true;
        }
        if (now != NO_EVENT) {
            *event = now;
            seen = *h;
            continue;
        }
        const double slope = slope_at_end(f);
        const double step = slope > 0.0 ? -f[LAST] / slope : 0.0;
        if ((begins_there || !(step > 0.0 && step < 0.5)) && *h < FC_BODY_BETWEEN * seen) {
            place = FC_BODY_BETWEEN * seen /
                    *h; // a push that leaves 0 with its square: the long panel is rough there
            continue;
        }
        if (!(step > 0.0 && step < 0.5)) {
            *event = NO_EVENT; // a touch that is none as it is seen now
            return true;
        }
        place = 1.0 + step;
    }
    return is_solved && *event == NO_EVENT;
}

// ---- the march ----

// Goes to the time t [s], by the impulse of F_t so far.
static void reach(March* march, double t, double delta) {
    march->t = t;
    march->at.delta = delta;
    march->at.v = march->body->v + (fc_body_pushed(march->body, t) - march->sums.impulse) / march->body->m;
}

static void append(March* march, const FcNodes* nodes, const FcBodyPanel* panel) {
    const FcFriction* friction = friction_of(march);
    const FcScene* scene = march->plane->scene;
    const bool slips = march->at.kind == FC_SLIPS;
    const bool moves = slips && !fc_scene_stiffness_is_constant(scene);
    FcStepResult* sums = &march->sums;
    assert(nodes->duration >= 0.0);
    assert(fabs(nodes->t[START] - march->t) <=
           10.0 * FC_BODY_ROUNDING * march->interval->duration); // the variable rounds, too
    for (int i = 0; i < STAGES; i++) {
        const double weight = FC_RADAU.weight[i] * nodes->tau[i];
        const double F = nodes->sigma[i] * panel->delta[i];
        const double w = panel->w[i];
        const double damping = friction->sigma_1 * panel->rate[i].delta + friction->sigma_2 * w;
        // What F does not put into the bristle is heat. Along the bound the spring's own energy is that of its ends.
        double lost = 0.0;
        if (slips) {
            lost = w;
            lost +=
                moves ? 0.5 * panel->delta[i] * fc_scene_log_rates(scene, nodes->t[i], nodes->phase[i]).sigma
                      : 0.0;
        } else if (march->at.kind == FC_RELAXES) {
            lost = w - panel->rate[i].delta;
        }
        sums->impulse += weight * (F + friction->sigma_2 * w);
        sums->work += weight * (F + damping) * w;
        sums->heat += weight * (F * lost + damping * w);
        march->x += weight * panel->v[i];
    }
    const double start = panel->delta[START];
    const double end = panel->delta[LAST];
    sums->impulse += friction->sigma_1 * (end - start);
    if (slips) {
        sums->heat -= 0.5 * (nodes->sigma[LAST] * end * end - nodes->sigma[START] * start * start);
    }
    const double t = nodes->t[LAST];
    const double rounded =
        FC_BODY_ROUNDING * march->interval->duration; // of t in any variable: no layer is longer
    reach(march, march->part.end - t <= rounded ? march->part.end : t, end);
}

// A free bristle begins, in the direction of w or, if that is 0, of its rate.
static void begin_free(March* march, double w, double w_rate) {
    const bool relaxes = !fc_may_stick(friction_of(march));
    march->h = 0.0;
    march->at.kind = relaxes ? FC_RELAXES : FC_STICKS;
    march->at.side = !relaxes ? 0 : w > 0.0 || (w == 0.0 && w_rate >= 0.0) ? 1 : -1;
    use_variable(march, 0.0, INFINITY);
}

// A slip begins where the bristle meets its bound, or jumps along it. What the spring loses is heat, and what the damper takes
// of the drop moves the mass. A bound that moves faster leaves the bristle free.
static void begin_slip(March* march) {
    const FcFriction* friction = friction_of(march);
    assert(march->is_bounded);
    FcPhase phase;
    const FcPlaneCoefficients at = coefficients(march, &phase);
    const double w = march->at.v + at.V.x;
    const double before = march->at.delta;
    const int side = before < 0.0 ? -1 : 1;
    march->sums.delta = before;
    if (fc_has_static_friction(friction) && friction->sigma_1 != 0.0) {
        FcScene scene = fc_scene_from(march->plane->scene, march->t);
        scene.drive.V.value += march->at.v;
        fc_body_drop(&scene, march->body->m, friction->sigma_1, &march->sums);
    } else {
        const double over = fc_may_stick(friction) ? fc_static_over_limit(friction, w) : 1.0;
        const double D = at.static_limit / over / at.sigma;
        march->sums.delta = side * D;
        march->sums.heat += fc_drop_heat(at.sigma, fabs(before), D);
    }
    march->sums.impulse += friction->sigma_1 * (march->sums.delta - before);
    march->sums.meetings++;
    march->at.kind = FC_SLIPS;
    march->at.side = side;
    march->h = 0.0;
    use_variable(march, 0.0, INFINITY);
    reach(march, march->t, march->sums.delta);
    const FcBodyRates rate = rates_at(march, &at, phase);
    if (!(rate.push > 0.0)) {
        begin_free(march, march->at.v + at.V.x, rate.w);
    }
}

// Behind a reversal, also one before the step, a bristle relaxes over the layer L = sqrt(2 D / |w'|), and a Stribeck curve lasts
// V_S / |w'|: t = t_c + L sinh(u).
static void use_layer(March* march, double w, double w_rate, double D) {
    const FcFriction* friction = friction_of(march);
    assert(march->at.kind == FC_RELAXES && D >= 0.0);
    const double H = march->interval->duration;
    const double rate = fabs(w_rate);
    const double V_S = fc_has_stribeck_curve(friction) ? friction->V_S : INFINITY;
    double away = 0.0; // s, from the reversal
    double length = INFINITY;
    if (2.0 * D < H * H * rate || V_S < H * rate) { // either is shorter than the step
        away = w / w_rate;
        length = fc_min(sqrt(2.0 * D / rate), V_S / rate);
    }
    const bool is_layer = length >= DBL_MIN && length < H && fabs(away) <= length;
    use_variable(march, march->t - fc_max(0.0, away), is_layer ? length : INFINITY);
    march->h = is_layer ? H : 0.0;
}

static void pass_reversal(March* march, const FcNodes* nodes, const FcBodyPanel* panel) {
    const double w_rate = panel->rate[LAST].w;
    march->at.side = w_rate > 0.0 ? 1 : w_rate < 0.0 ? -1 : -march->at.side;
    use_layer(march, panel->w[LAST], w_rate, nodes->limit[LAST] / nodes->sigma[LAST]);
}

static void pass(March* march, Event event, const FcNodes* nodes, const FcBodyPanel* panel) {
    switch (event) {
    case REVERSAL:
        pass_reversal(march, nodes, panel);
        break;
    case MEETING:
    case JUMP:
        begin_slip(march);
        break;
    case END_OF_PUSH:
        begin_free(march, panel->w[LAST], panel->rate[LAST].w);
        break;
    case CURVE:
        march->h = 0.0;
        break;
    case NO_EVENT:
        break;
    }
}

// Goes on in one step for as long as a stuck bristle whose motion is known surely does not meet its bound; false if that is
// shorter than a panel.
static bool take_free_time(March* march) {
    const FcBodyStuck* stuck = &march->stuck;
    assert(march->is_known && march->t <= march->part.end);
    FcPhase phase;
    const FcPlaneCoefficients at = coefficients(march, &phase);
    const double rest = march->part.end - march->t;
    const double x = fc_body_stuck_free_time(stuck, at.static_limit / at.sigma, rest);
    if (!(x >= rest || x * stuck->ringing > FC_BODY_MAX_PHASE)) {
        return false;
    }
    const double end = x >= rest ? march->part.end : march->t + x;
    double w;
    double integral;
    const double delta = fc_body_stuck_delta(stuck, x, &w, &integral);
    const double moved = delta - march->at.delta;
    march->sums.impulse += at.sigma * integral;
    march->sums.work += 0.5 * at.sigma * moved * (delta + march->at.delta);
    march->x += moved - fc_drive_displacement(&march->plane->scene->drive, march->t, end);
    march->solves += 1.0;
    reach(march, end, delta);
    return true;
}

// Whether w lies on the other side of 0 in all of the panel.
static bool lies_across(int side, const double w[POINTS]) {
    double most = -HUGE_VAL;
    for (int i = 0; i < POINTS; i++) {
        most = fc_max(most, side * w[i]);
    }
    return most < 0.0;
}

// The next panel, up to its first event.
static bool take_panel(March* march) {
    const double ringing = sqrt(march->interval->stiffness / march->body->m);
    march->is_known = (march->part.end - march->t) * ringing > FC_BODY_MAX_PHASE &&
                      fc_body_stuck_start(march->plane, march->body, &march->at, march->t, &march->stuck);
    if (march->is_known && take_free_time(march)) {
        return true;
    }
    if (march->t - march->part.in.center > FC_BODY_END_OF_LAYER * march->part.in.length) {
        use_variable(march, 0.0, INFINITY);
    }
    FcNodes nodes;
    FcBodyPanel panel;
    const double u = fc_time_map_u(&march->part.in, march->t);
    if (!(fc_time_map_u(&march->part.in, march->part.end) > u)) { // the rest is less than u is rounded by
        reach(march, march->part.end, march->at.delta);
        return true;
    }
    double h;
    Event event;
    if (!take_accurate(march, u, &h, &nodes, &panel)) {
        return false;
    }
    // What is 0 at the start is decided just after: the push of a slip, and the side of w, which may only have touched 0.
    if (march->at.kind == FC_SLIPS && panel.rate[START].push <= FC_BODY_ROUNDING * march->speed &&
        panel.rate[0].push < 0.0) {
        begin_free(march, panel.w[START], panel.rate[START].w);
        return true;
    }
    if (march->at.kind == FC_RELAXES && lies_across(march->at.side, panel.w)) {
        begin_free(march, panel.w[LAST], panel.rate[LAST].w);
        return true;
    }
    if (!cut_at_event(march, u, &h, &nodes, &panel, &event)) {
        return false;
    }
    append(march, &nodes, &panel);
    pass(march, event, &nodes, &panel);
    return true;
}

// Marches to the end of the part; false if a panel is not accurate, or if rounding or the work ends it before.
static bool march_part(March* march, double end) {
    assert(march->t <= end);
    march->part.end = end;
    int stalled = 0;
    while (march->t < end) {
        const double before = march->t;
        if (!take_panel(march) || march->solves * STAGES > FC_MAX_EVALUATIONS) {
            return false;
        }
        stalled = march->t - before > FC_BODY_ROUNDING * end ? 0 : stalled + 1;
        if (stalled > FC_BODY_MAX_STALLED) {
            return false;
        }
    }
    return true;
}

// Adds `times` the sums since before, of a whole number of periods of that length [s].
static void repeat(March* march, const FcStepResult* before, double x_before, double times, double length) {
    assert(times >= 0.0 && length > 0.0);
    FcStepResult* sums = &march->sums;
    sums->impulse += times * (sums->impulse - before->impulse);
    sums->work += times * (sums->work - before->work);
    sums->heat += times * (sums->heat - before->heat);
    march->x += times * (march->x - x_before);
    reach(march, march->t + times * length, march->at.delta);
}

// Marches a step with held inputs period by period. Once a period changes delta and v by so little that all of the rest would
// keep within a share of the tolerance, those are counted. False as march_part.
static bool march_periods(March* march, double h) {
    const FcDrive* drive = &march->plane->scene->drive;
    const bool repeats = fc_drive_vibrates(drive) && !fc_drive_is_linear(drive) && march->body->F.rate == 0.0;
    const double period = 1.0 / drive->vibration.f;
    const double allowed = FC_BODY_SHARE_OF_PERIODS * fc_allowed_force(march->interval);
    const double damping = friction_of(march)->sigma_1 + friction_of(march)->sigma_2;
    while (repeats && h - march->t > 2.0 * period) {
        const FcBodyStart at = march->at;
        const FcStepResult sums = march->sums;
        const double x = march->x;
        const double start = march->t;
        if (!march_part(march, start + period)) {
            return false;
        }
        const double left = floor((h - march->t) / period);
        const double force = march->interval->stiffness * fabs(march->at.delta - at.delta);
        const double dv = fabs(march->at.v - at.v);
        const double change = force + fc_max(damping, march->body->m / h) * dv;
        if (march->at.kind == at.kind && march->at.side == at.side && left * change <= allowed) {
            repeat(march, &sums, x, left, period);
            break;
        }
    }
    return march_part(march, h);
}

// The largest |w| of the step, at the most [m/s].
static double largest_speed(const FcInterval* interval, const FcBody* body) {
    const double H = interval->duration;
    assert(H > 0.0 && body->m > 0.0);
    const double F = fabs(body->F.value) + fabs(body->F.rate) * H;
    return fabs(body->v) + interval->speed + (F + interval->force) * H / body->m + DBL_MIN;
}

static void begin(March* march, FcBristle bristle) {
    FcPhase phase;
    const FcPlaneCoefficients at = coefficients(march, &phase);
    march->at = (FcBodyStart){.kind = FC_STICKS, .delta = bristle.delta, .v = march->body->v};
    const double w = march->at.v + at.V.x;
    const double w_rate = rates_at(march, &at, phase).w;
    begin_free(march, w, w_rate);
    const int side = fc_side(bristle);
    const bool touches = march->is_bounded && !fc_has_static_friction(friction_of(march)) &&
                         fabs(bristle.delta) * at.sigma >= at.static_limit * (1.0 - FC_ROUNDING_OF_BOUND);
    if (fc_has_broken_away(friction_of(march), bristle.state) || touches) {
        march->at.kind = FC_SLIPS;
        march->at.side = side;
        const FcBodyRates rate = rates_at(march, &at, phase);
        if (rate.push < 0.0 || (rate.push == 0.0 && side * rate.w < 0.0)) {
            begin_free(march, w, w_rate);
        }
    }
    if (march->at.kind == FC_RELAXES) {
        use_layer(march, w, w_rate, at.limit / at.sigma);
    }
}

bool fc_body_march_step(const FcScene* scene, const FcSolverOptions* options, double h, FcBody* body,
                        FcStepResult* result, bool* is_doubtful, FcMessage* message) {
    assert(h >= 0.0 && body->m > 0.0 && fc_has_bristle(scene->friction) && !fc_scene_is_separated(scene));
    if (h == 0.0) {
        return true;
    }
    FcPlane plane;
    fc_plane_make(&plane, scene);
    const FcInterval interval = fc_interval_make(scene, h, options);
    March march = {.plane = &plane,
                   .interval = &interval,
                   .body = body,
                   .speed = largest_speed(&interval, body),
                   .part = {.in = {0.0, INFINITY}, .end = h, .strip_ratio = 1.0},
                   .is_bounded = fc_march_may_meet(scene)};
    begin(&march, fc_bristle_of(result));
    if (!march_periods(&march, h)) {
        *is_doubtful = march.solves * STAGES <= FC_MAX_EVALUATIONS;
        return fc_body_refuse(scene, body, h,
                              *is_doubtful ? "its errors cannot be kept; use smaller steps"
                                           : "it needs too many evaluations; use smaller steps",
                              message);
    }
    assert(march.t == h);
    result->delta = march.at.delta;
    result->state = march.at.kind == FC_SLIPS ? FC_SLIPPING : FC_FREE;
    result->meetings += march.sums.meetings;
    result->impulse += march.sums.impulse;
    result->work += march.sums.work;
    result->heat += march.sums.heat;
    result->evaluations += march.solves * STAGES;
    body->x += march.x;
    fc_body_move(body, h, march.sums.impulse);
    return true;
}
