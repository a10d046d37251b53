#include "solver/plane/plane_march.h"

#include <float.h>
#include <math.h>

#include "model/constants.h"
#include "model/regime.h"
#include "model/root.h"
#include "solver/budget.h"
#include "solver/interval.h"
#include "solver/panels/judge.h"
#include "solver/plane/plane_panel.h"
#include "solver/plane/rise.h"

enum { POINTS = FC_RADAU_POINTS, STAGES = FC_RADAU_STAGES };

// The motion of the bristle; Coulomb's law has no bristle.
typedef enum { FREE, SLIPS, NO_BRISTLE } Motion;

typedef struct {
    const FcPlane* plane;
    const FcInterval* interval;
    FcDrive across_drive; // fc_drive_across
    FcPart part;
    double u, end;     // reached in the part, and to be reached
    double path_after; // m, at least, from the end of the part to that of the interval
    double h;          // of the next panel, in u; 0 before the first of a part
    FcMap along, across;
    double transient; // N, the rest of the transient of the start
    double scale;     // m, of the starts that the maps are for, beside the one they have
    double heat;      // J, of break-away
    double drag;      // m2/s, of its drops
    bool is_bounded;
    int slips; // FcBristle
    Motion motion;
    int meetings;
    bool touches;         // a free bristle is at its bound
    FcVector by_start[2]; // as in FcStepResult
    double evaluations;
} March;

// The largest velocity [m/s] of the bristle and its bound together.
static double largest_push(const March* march) {
    const FcInterval* interval = march->interval;
    return interval->speed + interval->saturation * interval->pace.log_sigma;
}

static FcPlaneFrom from_of(const March* march) {
    return (FcPlaneFrom){.delta = {march->along.offset, march->across.offset},
                         .scale = (1.0 - march->along.relaxation) * march->scale,
                         .speed = march->interval->speed + DBL_MIN,
                         .push = largest_push(march) + DBL_MIN};
}

// The number of refused panels in a row, after which the next one is accepted: 0.3^12 of the first length, at
// which rounding limits it. Twice as many would cost time alone.
enum { MOST_TRIES = 12 };
// Derived: polynomials through 9 stages err by rho^-17 for a function with branch points at the distance
// pi / 2, with sinh(ln rho) = pi over the panel's length.
static const double ORDER = 17.0;
// The planned part of that length. Chosen empirically: most panels of the whole length are refused; panels of
// a third are refused as often as those of a half.
static const double PART_OF_ELLIPSE = 0.45;
// The relaxation in a panel, times the seventh root of its transient over the allowed error. Chosen empirically: half
// of it costs panels, twice of it tries.
static const double RELAXATION = 80.0;
// The largest displacement of a sticking bristle in a panel, in radii of its disc. Chosen empirically: up to
// this value the panel's points show the meeting with the bound. Twice of it makes panels that are cut.
static const double MOST_OF_DISC = 4.0;
// The longest panel, over the time in which the contact moves by 1. Chosen empirically: twice of it costs
// tries, not accuracy.
static const double SMOOTH = 5.0;

// The factor that shortens a panel whose points do not resolve the motion near its start. Chosen empirically:
// half or twice of it changes the number of tries, not the accuracy.
static const double SHORTENED_BY = 1.0 / 32.0;

static FcPlaneCoefficients coefficients_at(const March* march, double t) {
    return fc_plane_coefficients(march->plane, t, fc_drive_phase(&march->interval->scene->drive, t));
}

// The transient [N] at the start: the difference of the force from its limit. The limit is Coulomb's force,
// minus its change in the time 1 / r.
static double first_transient(const March* march) {
    const FcPlaneFrom from = from_of(march);
    const FcPlaneCoefficients at = coefficients_at(march, 0.0);
    const FcVector now = fc_plane_coulomb(&at);
    const double r = at.sigma * at.speed / at.limit;
    FcVector next = now;
    if (r * march->interval->duration > 1.0) {
        const FcPlaneCoefficients after = coefficients_at(march, 1.0 / r);
        next = fc_plane_coulomb(&after);
    }
    return hypot(at.sigma * from.delta.x - (2.0 * now.x - next.x),
                 at.sigma * from.delta.y - (2.0 * now.y - next.y)) +
           at.sigma * fabs(from.scale);
}

// r, or |V| / D of a bristle that sticks [1/s].
static double rate_at(const March* march, double t) {
    const FcPlaneCoefficients at = coefficients_at(march, t);
    return at.sigma * at.speed / at.limit;
}

static bool is_stuck(const March* march) {
    return march->motion == FREE && march->plane->scene->friction->model == FC_ELASTIC_PLASTIC;
}

// The length in u of the next panel.
static double planned(const March* march) {
    const FcInterval* interval = march->interval;
    const FcStraight* in = &march->part.in;
    const double left = march->end - march->u;
    const double t = fc_part_time(&march->part, march->u);
    const double rate = rate_at(march, t);
    const bool relaxes = !is_stuck(march) && march->motion != NO_BRISTLE;
    const double resolves = pow(interval->tolerance, 1.0 / ORDER);     // 1 / rho
    double span = SMOOTH * resolves * fc_smooth_time(&interval->pace); // s
    double z = INFINITY;                                               // the largest relaxation
    if (relaxes) {
        // Behind a near-zero V has turned, and the force follows while the bristle relaxes.
        const bool has_turned = isfinite(in->length) && in->center > 0.0 && t >= in->center;
        const double turned = has_turned ? interval->force * exp(-0.5 * rate * (t - in->center)) : 0.0;
        const double behind = fmax(march->transient, turned) / (interval->tolerance * interval->force);
        z = behind > 1.0 ? RELAXATION * pow(behind, -1.0 / 7.0) : INFINITY;
    } else if (is_stuck(march) && march->is_bounded) {
        span = fmin(span, MOST_OF_DISC / rate);
    }
    double h = fmin(left, fc_straight_place(in, t + span) - march->u);
    if (march->h > 0.0) {
        h = fmin(h, march->h);
    }
    if (isfinite(in->length)) {
        h = fmin(h, FC_PI / sinh(-log(resolves)));
        // The branch points act in the panel's part of the interval, on the part of the force that relaxes.
        const double end = fc_part_time(&march->part, march->u + h);
        const double acts = relaxes ? fmin(1.0, 0.5 * (rate + rate_at(march, end)) * (end - t)) : 1.0;
        const double counts = acts * (end - t) / (interval->duration * interval->tolerance);
        h = fmin(h, PART_OF_ELLIPSE * FC_PI / sinh(log1p(counts) / ORDER));
        h = fmin(h, 0.5 * log1p(2.0 * z / (rate * fc_straight_pace(in, march->u)))); // |V| may grow as e^u
    } else {
        h = fmin(h, z / rate);
    }
    return h > 0.0 ? left / ceil(left / h * (1.0 - 1e-9)) : left;
}

// A distance [m] from start to end that is at most the path: straight to the near-zero, and from there.
static double least_path(const March* march, const FcPart* part, double start, double end) {
    const FcDrive* drive = &march->interval->scene->drive;
    const double turn = fmin(fmax(part->in.center, start), end);
    return hypot(fc_drive_displacement(drive, start, turn),
                 fc_drive_displacement(&march->across_drive, start, turn)) +
           hypot(fc_drive_displacement(drive, turn, end),
                 fc_drive_displacement(&march->across_drive, turn, end));
}

// The safety factors on estimated errors: of all panels, and of a slip through a Stribeck peak, in which
// force and push follow the curve at once. Chosen empirically: half of them lets a few panels in 100 000 pass
// that miss the tolerance, twice of them costs a twentieth more panels.
static const double SURE = 2.0;
static const double SURE_IN_PEAK = 10.0;

// The least value of a share that is proportional to the relaxation in the panel, over the relaxation in the
// interval. Chosen empirically: below it rounding limits a panel.
static const double LEAST_SHARE = 1e-5;

// The factor by which the panel's errors are too large.
static double excess_of(const March* march, const FcPlaneNodes* nodes, const FcPanel* panel) {
    const FcInterval* interval = march->interval;
    const double end = nodes->t[STAGES - 1];
    const double length = march->part.in.length;
    const double forgets =
        panel->rate > 0.0 ? 3.0 / panel->rate + (isfinite(length) ? 2.0 * length : 0.0) : HUGE_VAL;
    const bool has_peak = fc_has_stribeck_curve(interval->scene->friction);
    const FcErrorLife life = {
        .lives = fmax(0.0, fmin(interval->duration - end, forgets)) / interval->duration,
        .lasts = fmin(1.0, nodes->duration / interval->duration), // the nodes' times are rounded
        .grows = fmax(1.0, interval->stiffness / panel->sigma),
        .in_peak = has_peak,
        .crosses_peak = has_peak || march->motion == NO_BRISTLE, // a force that turns by itself, as in a peak
    };
    FcPanel whole = *panel;
    if (interval->scene->friction->model != FC_LUGRE) { // a limit that moves with V needs the share by z
        whole.z = fmax(1.0, panel->z);
    }
    whole.z =
        fmax(LEAST_SHARE * fmin(1.0, interval->speed * interval->duration / interval->saturation), whole.z);
    const FcExcess over = fc_radau_panel_excess(&whole, &life, fc_allowed_force(interval));
    const double path = march->path_after + least_path(march, &march->part, end, march->part.end);
    const double left_at_end = exp(-path / interval->saturation);
    const double sure = has_peak && march->motion == SLIPS ? SURE_IN_PEAK : SURE;
    return sure * fmax(over.mean, over.end * left_at_end);
}

// Coulomb's law: the force is known.
static void coulomb_panel(const March* march, const FcPlaneNodes* nodes, FcPlanePanel* panel);

// Makes the panel of the length h at the present place; false if it is too long to be solved.
static bool make_panel(March* march, double h, FcPlaneNodes* nodes, FcPlanePanel* panel) {
    const FcPlaneFrom from = from_of(march);
    fc_plane_nodes(march->plane, &march->part, march->u, h, nodes);
    march->evaluations += STAGES;
    switch (march->motion) {
    case SLIPS:
        return fc_plane_slip_panel(march->plane, nodes, &from, panel);
    case FREE:
        fc_plane_free_panel(march->plane, nodes, &from, panel);
        return true;
    default:
        coulomb_panel(march, nodes, panel);
        return true;
    }
}

// Takes the panel of the length h at the present place, or a shorter one that is accurate; returns its
// length.
static double take_accurate(March* march, double h, FcPlaneNodes* nodes, FcPlanePanel* panel) {
    for (int tries = 0;; tries++) {
        const bool is_solved = make_panel(march, h, nodes, panel);
        const double excess = is_solved ? excess_of(march, nodes, &panel->along) : HUGE_VAL;
        if ((is_solved && excess <= 1.0) || tries >= MOST_TRIES) {
            if (!is_solved) {
                march->along.offset = NAN; // no number, which the step is refused for
            }
            const double grows = tries == 0 ? 4.0 : fmin(2.0, 0.9 * pow(excess, -1.0 / ORDER));
            march->h = tries > 0 || march->h > 0.0 ? h * grows : 0.0;
            return h;
        }
        h *= is_solved ? fmax(0.3, fmin(0.9, 0.85 * pow(excess, -1.0 / 12.0))) : 0.4;
    }
}

static void append(March* march, FcPlanePanel* panel, double h) {
    const double next = march->u + h;
    const double end = march->end - next < 1e-12 * h ? march->end : next;
    if (is_stuck(march)) { // it moves with the surfaces: a drift over many periods is exact to rounding
        const double t_0 = fc_straight_time(&march->part.in, march->u);
        const double t_1 = fc_straight_time(&march->part.in, end);
        panel->along.map.offset = fc_drive_displacement(&march->interval->scene->drive, t_0, t_1);
        panel->across.offset = fc_drive_displacement(&march->across_drive, t_0, t_1);
    }
    fc_map_append(&march->along, &panel->along.map);
    fc_map_append(&march->across, &panel->across);
    const double kept = exp(-panel->along.z);
    march->transient *= fmin(1.0, kept);
    for (int k = 0; k < 2; k++) {
        march->by_start[k].x *= kept;
        march->by_start[k].y *= kept;
    }
    march->u = end;
}

// delta [m] at the time t of a bristle that has stuck since t_0.
static FcVector stuck_delta(const March* march, double t_0, double t) {
    const FcVector from = from_of(march).delta;
    return (FcVector){from.x + fc_drive_displacement(&march->interval->scene->drive, t_0, t),
                      from.y + fc_drive_displacement(&march->across_drive, t_0, t)};
}

// |delta|^2 - D^2 at the points of a free panel; that of a stuck bristle is exact.
static void find_to_bound(const March* march, const FcPlaneNodes* nodes, FcPlanePanel* panel) {
    for (int i = 0; i < POINTS; i++) {
        if (is_stuck(march)) {
            panel->delta[i] = stuck_delta(march, nodes->t[STAGES], nodes->t[i]);
        }
        const double D = fc_plane_radius(march->plane, &nodes->at[i], march->slips);
        panel->to_bound[i] = fc_product(panel->delta[i], panel->delta[i]) - D * D;
    }
}

static void set_delta(March* march, FcVector delta) {
    march->along.relaxation = march->across.relaxation = 1.0;
    march->along.offset = delta.x;
    march->across.offset = delta.y;
}

// The present place of the march.
typedef struct {
    double t;
    FcPhase phase;
    FcPlaneCoefficients at;
    FcPlaneBound bound; // of a bristle that slips
    double size;        // m, |delta|
    FcVector n;         // its direction
    double push;
} Place;

static Place place_of(const March* march) {
    Place place = {.t = fc_part_time(&march->part, march->u)};
    place.phase = fc_drive_phase(&march->interval->scene->drive, place.t);
    place.at = fc_plane_coefficients(march->plane, place.t, place.phase);
    place.bound = fc_plane_bound(march->plane, &place.at, 1, place.t, place.phase);
    const FcVector delta = from_of(march).delta;
    place.size = hypot(delta.x, delta.y);
    place.n =
        place.size > 0.0 ? (FcVector){delta.x / place.size, delta.y / place.size} : (FcVector){1.0, 0.0};
    place.push = fc_plane_push(march->plane, &place.at, &place.bound, place.n);
    return place;
}

// Parts of the largest push. A push below the first is rounding. Below the second a slipping bristle may be
// released, since the rest of a push acts with its square. Chosen empirically: half or twice of them
// moves the end of a slip by as little.
static const double ROUNDING_OF_PUSH = 1e-13;
static const double LITTLE_PUSH = 1e-9;

// A bristle that deviates meets its bound earlier by a time, drops there, and moves on for that time.
static void drop_derivatives(March* march, const Place* at, const FcPlaneBound* held, double push) {
    const FcVector n = at->n;
    const double V_n = fc_product(n, at->at.V);
    const double V_t = fc_across(n, at->at.V);
    for (int k = 0; k < 2; k++) {
        FcVector* by = &march->by_start[k];
        const double earlier = fc_product(n, *by) / push; // s
        const double along = fc_across(n, *by);
        const double turns = at->bound.D / held->D * (along - V_t * earlier) + V_t * earlier;
        const double rises = (V_n - at->bound.rate) * earlier;
        *by = (FcVector){rises * n.x - turns * n.y, rises * n.y + turns * n.x};
    }
}

// A free bristle at its bound slips if it is pushed; one with static friction breaks away. False if it is not
// pushed.
static bool begins_to_slip(March* march) {
    const Place place = place_of(march);
    const FcPlaneBound held = fc_plane_bound(march->plane, &place.at, march->slips, place.t, place.phase);
    const double push = fc_plane_push(march->plane, &place.at, &held, place.n);
    if (!(push > ROUNDING_OF_PUSH * largest_push(march))) {
        return false;
    }
    drop_derivatives(march, &place, &held, push);
    // The energy that it loses is heat, also that of its small excess over the bound.
    march->heat += 0.5 * place.at.sigma * (place.size - place.bound.D) * (place.size + place.bound.D);
    march->drag += (place.bound.D - place.size) * fc_product(place.n, place.at.V);
    set_delta(march, (FcVector){place.bound.D * place.n.x, place.bound.D * place.n.y});
    march->meetings++;
    march->touches = march->slips != 0 || !fc_has_static_friction(march->plane->scene->friction);
    march->slips = place.push > 0.0;
    march->motion = place.push > 0.0 ? SLIPS : FREE;
    march->transient = place.at.sigma * place.bound.D * fabs(fc_across(place.n, place.at.V)) / place.at.speed;
    return true;
}

// The distance of |delta|^2 from D^2 [m2] that counts as 0: rounding, or an error that heat and force allow if
// the bristle is not stuck.
static double close_to_bound(const March* march, double D) {
    const FcInterval* interval = march->interval;
    // An excess over the bound costs heat, whose tolerance goes with the path.
    const double share = is_stuck(march) ? 0.0 : FC_SHARE_OF_EVENT;
    const double allowed = share *
                           fmin(fc_allowed_force(interval) / interval->stiffness, interval->tolerance * D) *
                           fmin(1.0, interval->speed * interval->duration / D);
    const double of_time = fabs(march->u) * fc_straight_pace(&march->part.in, march->u) + interval->duration;
    const double rounding = 1e-14 * D + 4e-16 * largest_push(march) * of_time;
    return 2.0 * D * fmin(fmax(allowed, rounding), 1e-3 * D); // if D moves by decades, nothing is near it
}

static void take_again(March* march, double h, FcPlaneNodes* nodes, FcPlanePanel* panel) {
    if (!make_panel(march, h, nodes, panel)) {
        march->along.offset = NAN; // a part of a panel that was solved is, too
    }
}

// The place in a panel, over its length, after which that push is negative; 0 if it is nowhere positive, 2 if
// there is none.
static double end_of_push(const March* march, const double push[POINTS]) {
    const double rounding = ROUNDING_OF_PUSH * largest_push(march);
    double inwards[POINTS];
    bool is_pushed = false;
    for (int i = 0; i < POINTS; i++) {
        inwards[i] = -push[i];
        is_pushed = is_pushed || push[i] > rounding;
    }
    return inwards[STAGES] > rounding || !is_pushed ? 0.0 : fc_first_rise(inwards, rounding);
}

// The part of a panel by which it may begin or end beside a top. Derived: |delta| is less by its square, 1e-12
// of the panel's motion. Twice of it is less by four times as much.
static const double BESIDE_TOP = 1e-6;

// The place in a panel, over its length, at which a free bristle is nearest to its bound; 2 if |delta| is below 0.7
// D at all points. The polynomial of |delta|^2 is too coarse to say whether it touches the bound there: with static
// friction it decides a break-away, and in a settled state the slips are as small as the drift in a period.
static double top_at_bound(const March* march, const FcPlaneNodes* nodes, const FcPlanePanel* panel) {
    double recedes[POINTS];
    bool is_near = false;
    for (int i = 0; i < POINTS; i++) {
        const FcPlaneBound held =
            fc_plane_bound(march->plane, &nodes->at[i], march->slips, nodes->t[i], nodes->phase[i]);
        const FcVector n = {panel->delta[i].x / held.D, panel->delta[i].y / held.D};
        recedes[i] = -fc_plane_push(march->plane, &nodes->at[i], &held, n);
        is_near = is_near || panel->to_bound[i] > -0.5 * held.D * held.D;
    }
    const double top = is_near ? fc_first_rise(recedes, ROUNDING_OF_PUSH * largest_push(march)) : 2.0;
    return top > BESIDE_TOP && top < 1.0 - BESIDE_TOP ? top : 2.0;
}

// Whether the push of a slipping bristle that lies inside its bound, after an input has jumped, ends in the
// panel. The panel then ends there, and the bristle sticks unless it has met its bound before.
static bool catches_up(March* march, FcPlaneNodes* nodes, FcPlanePanel* panel, double* h) {
    for (int cuts = 0;; cuts++) {
        double push[POINTS];
        for (int i = 0; i < POINTS; i++) {
            const FcVector delta = panel->delta[i];
            const double size = fmax(hypot(delta.x, delta.y), DBL_MIN);
            const FcPlaneBound bound =
                fc_plane_bound(march->plane, &nodes->at[i], 1, nodes->t[i], nodes->phase[i]);
            push[i] = fc_plane_push(march->plane, &nodes->at[i], &bound,
                                    (FcVector){delta.x / size, delta.y / size});
        }
        const double ends = end_of_push(march, push);
        if (ends > 1.0 || cuts >= 4) {
            return cuts > 0;
        }
        *h *= fmax(ends, 1e-9);
        take_again(march, *h, nodes, panel);
    }
}

// |delta|^2 - D^2 of a stuck bristle at a place of the part.
static double stuck_to_bound(void* context, double u) {
    const March* march = context;
    const double t = fc_part_time(&march->part, u);
    const FcVector delta = stuck_delta(march, fc_part_time(&march->part, march->u), t);
    const FcPlaneCoefficients at = coefficients_at(march, t);
    const double D = fc_plane_radius(march->plane, &at, march->slips);
    return fc_product(delta, delta) - D * D;
}

// The place in a panel of the length h, over it, at which it is cut: where it meets its bound. That of a stuck
// bristle is exact, if a point of the panel lies beyond the bound.
static double place_of_meeting(March* march, const FcPlanePanel* panel, double h, double meets, double over) {
    const double* f = panel->to_bound;
    double a = 0.0;
    double at_a = f[STAGES];
    for (int i = 0; i < STAGES && is_stuck(march) && at_a < 0.0; i++) {
        const double b = 0.5 + FC_RADAU_9.node[i];
        if (b >= meets && f[i] > over) {
            const double root = fc_root_between(stuck_to_bound, march, march->u + a * h, at_a,
                                                march->u + b * h, f[i], over, 0.0, &march->evaluations);
            return (root - march->u) / h;
        }
        a = b;
        at_a = f[i];
    }
    return fmax(meets, SHORTENED_BY);
}

static void free_panel(March* march, double h) {
    if (march->touches && begins_to_slip(march)) {
        return;
    }
    FcPlaneNodes nodes;
    FcPlanePanel panel;
    h = take_accurate(march, h, &nodes, &panel);
    if (!march->is_bounded) {
        append(march, &panel, h);
        return;
    }
    const bool gives_up = march->slips != 0 && catches_up(march, &nodes, &panel, &h);
    // The panel is repeated up to its meeting with the bound, which its own points show more accurately. A
    // panel that dips inside the bound between its points is shortened.
    enum { MOST_CUTS = 40 };
    bool is_cut = false;
    double over = 0.0;
    for (int cuts = 0; cuts < MOST_CUTS; cuts++) {
        find_to_bound(march, &nodes, &panel);
        over = close_to_bound(march, fc_plane_radius(march->plane, &nodes.at[STAGES - 1], march->slips));
        const double meets = fc_first_rise(panel.to_bound, over);
        const double top = meets > 1.0 ? top_at_bound(march, &nodes, &panel) : 2.0;
        if (meets > 1.0 && top > 1.0) {
            break;
        }
        is_cut = is_cut || meets <= 1.0;
        h *= meets > 1.0 ? top : place_of_meeting(march, &panel, h, meets, over);
        take_again(march, h, &nodes, &panel);
    }
    append(march, &panel, h);
    march->touches = panel.to_bound[STAGES - 1] >= -over;
    if (gives_up && !is_cut) {
        march->slips = 0;
        march->touches = false;
    }
    if (is_cut && !march->touches) {
        march->h = 4.0 * h; // the panel was too long for its points
    }
}

// A slip from start to end keeps of a deviation the part along the circle. By D a' = V_y cos a - V sin a it
// changes as D does, and by the panel's z.
static void turn_derivatives(March* march, FcVector start, FcVector end) {
    for (int k = 0; k < 2; k++) {
        FcVector* by = &march->by_start[k];
        const double turned = fc_across(start, *by) / fc_product(start, start);
        *by = (FcVector){-turned * end.y, turned * end.x};
    }
}

static void slip_panel(March* march, double h) {
    FcPlaneNodes nodes;
    FcPlanePanel panel;
    h = take_accurate(march, h, &nodes, &panel);
    if (isnan(march->along.offset)) {
        return;
    }
    double ends = end_of_push(march, panel.to_bound);
    const bool is_cut = ends < 1.0;
    bool is_over = is_cut;
    for (int cuts = 0; cuts < MOST_TRIES && ends > 0.0 && ends < 1.0; cuts++) {
        h *= ends;
        take_again(march, h, &nodes, &panel);
        ends = end_of_push(march, panel.to_bound);
    }
    if (ends > 0.0) {
        turn_derivatives(march, panel.delta[STAGES], panel.delta[STAGES - 1]);
        append(march, &panel, h);
        const double rest = panel.to_bound[STAGES - 1] / largest_push(march);
        is_over = rest < (is_cut ? LITTLE_PUSH : ROUNDING_OF_PUSH); // also if V is just 0 at the end
    }
    if (is_over) {
        march->motion = FREE;
        march->slips = 0;
        march->touches = !is_cut && !fc_has_static_friction(march->plane->scene->friction);
    }
}

static void coulomb_panel(const March* march, const FcPlaneNodes* nodes, FcPlanePanel* panel) {
    double F_x[POINTS];
    double F_y[POINTS];
    double V_x[POINTS];
    double V_y[POINTS];
    FcMap* map = &panel->along.map;
    *panel = (FcPlanePanel){.along = {.z = 1.0, .sigma = march->interval->stiffness}};
    for (int i = 0; i < POINTS; i++) {
        const FcPlaneCoefficients* at = &nodes->at[i];
        const FcVector F = fc_plane_coulomb(at);
        const double weight = FC_RADAU_9.weight[i] * nodes->tau[i];
        V_x[i] = at->V.x;
        V_y[i] = at->V.y;
        F_x[i] = F.x;
        F_y[i] = F.y;
        map->impulse_offset += weight * F_x[i];
        panel->across.impulse_offset += weight * F_y[i];
        map->work_offset += weight * at->limit * at->speed;
    }
    map->heat_offset = map->work_offset;
    panel->along.limit = nodes->at[STAGES - 1].limit;
    fc_plane_force_errors(nodes, march->interval->speed, F_x, F_y, V_x, V_y, &panel->along);
}

static void cross_part(March* march) {
    march->u = fc_straight_place(&march->part.in, march->part.start);
    march->end = fc_straight_place(&march->part.in, march->part.end);
    march->h = 0.0;
    int stalled = 0; // panels in a row that did not get on
    while (march->u < march->end && march->evaluations <= FC_MOST_EVALUATIONS &&
           !isnan(march->along.offset)) {
        const double before = march->u;
        const double h = planned(march);
        if (march->motion == SLIPS) {
            slip_panel(march, h);
        } else {
            free_panel(march, h);
        }
        stalled = march->u > before ? 0 : stalled + 1;
        if (stalled > MOST_TRIES) {
            march->u = fmin(march->end, before + 0x1p-50 * (fabs(before) + march->end - before));
        }
    }
}

static void cross(March* march) {
    const FcInterval* interval = march->interval;
    march->transient = first_transient(march);
    FcPart parts[FC_MOST_PARTS];
    const int count = fc_parts(march->plane, interval->duration, interval->tolerance, parts);
    march->across_drive = fc_drive_across(&interval->scene->drive);
    double way[FC_MOST_PARTS];
    double after = 0.0;
    for (int i = count - 1; i >= 0; i--) {
        way[i] = after;
        after += least_path(march, &parts[i], parts[i].start, parts[i].end);
    }
    for (int i = 0; i < count; i++) {
        march->part = parts[i];
        march->path_after = way[i];
        cross_part(march);
    }
}

static void start_march(March* march, const FcPlane* plane, const FcInterval* interval, double evaluations) {
    *march = (March){.plane = plane,
                     .interval = interval,
                     .motion = plane->scene->friction->model == FC_COULOMB ? NO_BRISTLE : FREE,
                     .by_start = {{1.0, 0.0}, {0.0, 1.0}},
                     .evaluations = evaluations};
}

void fc_plane_step(const FcScene* scene, const FcSolverOptions* options, double duration,
                   FcStepResult* result) {
    if (!(duration > 0.0)) {
        return;
    }
    FcPlane plane;
    fc_plane_make(&plane, scene);
    const FcInterval interval = fc_interval_make(scene, scene, duration, options);
    March march;
    start_march(&march, &plane, &interval, result->evaluations);
    march.is_bounded = fc_is_bounded(scene->friction);
    march.slips = result->slips;
    set_delta(&march, (FcVector){result->delta, result->delta_y});
    march.motion = fc_regime(scene, fc_bristle_of(result)) != FC_FREE ? SLIPS : march.motion;
    march.meetings = march.motion == SLIPS;
    cross(&march);
    fc_map_apply(&march.along, result);
    fc_map_apply_across(&march.across, result);
    result->heat += march.heat;
    result->drag += march.drag;
    result->meetings += march.meetings;
    result->slips = fc_has_static_friction(scene->friction) ? march.slips : 0;
    result->on_bound = march.motion == SLIPS;
    result->by_start[0] = march.by_start[0];
    result->by_start[1] = march.by_start[1];
    result->evaluations = march.evaluations;
}

static void find_maps(const FcPlane* plane, const FcSolverOptions* options, double duration, double start,
                      FcMap* along, FcMap* across, double* evaluations) {
    const FcScene* scene = plane->scene;
    const FcInterval interval = fc_interval_make(scene, scene, duration, options);
    March march;
    start_march(&march, plane, &interval, *evaluations);
    const FcPlaneCoefficients at = coefficients_at(&march, 0.0);
    march.scale = fmax(start, at.limit / at.sigma);
    cross(&march);
    *evaluations = march.evaluations;
    *along = march.along;
    *across = march.across;
}

FcMap fc_plane_map(const FcScene* scene, const FcSolverOptions* options, double duration, double start,
                   FcMap* across, double* evaluations) {
    FcPlane plane;
    fc_plane_make(&plane, scene);
    FcMap along;
    find_maps(&plane, options, duration, start, &along, across, evaluations);
    return along; // NOLINT(clang-analyzer-core.StackAddressEscape): numbers alone
}
