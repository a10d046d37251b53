#include "solver/stretches/crossing.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stddef.h>

#include "solver/budget.h"
#include "solver/panels/gauss_panel.h"
#include "solver/panels/gauss_rule.h"
#include "solver/panels/judge.h"
#include "solver/panels/radau_panel.h"
#include "solver/solver.h"
#include "solver/stretches/mesh.h"
#include "solver/stretches/section.h"
#include "solver/stretches/settled_panel.h"

// MOST_TRIES: refusals of a Radau panel in a row before it is taken as it is. They shorten it to 0.4^12 of
// its length, at which rounding limits it. Half as many would let panels pass that miss the tolerance; twice
// as many would cost time alone. MOST_CAUTION: the largest number of decades by which refused panels make the
// next plans finer. It decides tries, not accuracy.
enum { MOST_TRIES = 12, MOST_CAUTION = 6 };
// The next Gauss panel may be twice as long if this one relaxes by less than this for each node: it is still
// resolved (RESOLVED in section.c). Half or twice of it changes the number of tries, not the accuracy.
static const double EASY_Z_PER_NODE = 0.2;

// The largest bound of the error of a judged Gauss panel, over the tolerance. Chosen empirically: the estimate of such a
// panel may be small by chance: at a bound of 9e5 tolerances a force missed by 14. A tenth of it refuses 2 panels of 100.
static const double MOST_OF_BOUND = 1e4;

// The kinds of panel, in the order in which they are tried.
typedef enum { BOUNDED_GAUSS, JUDGED_GAUSS, SETTLED, RADAU } PanelKind;

// The part that is being crossed: a section by Gauss panels. If they are refused, Radau and settled panels
// cross the rest of it and all sections up to the next soft one.
typedef struct {
    FcCrossed* crossed;
    FcStretch* stretch;
    const FcSection* section;
    double t, end;       // s, reached, and the goal
    double end_of_radau; // s
    PanelKind first;     // that may still be tried
    FcPanel panel;       // the last one
    // Judged Gauss panels.
    FcGaussPlan plan; // of the section
    double h;         // s, of the next one
    int nodes;        // of the next one
    // Radau and settled panels.
    FcPlace at;
    double missed;   // m, of the path
    double too_long; // s, a span whose lag could not be integrated
    int caution;     // decades by which refused panels make the plans finer
} Crossing;

FcTrajectories fc_crossed_trajectories(const FcCrossed* crossed) {
    return (FcTrajectories){.delta_0 = crossed->map->offset,
                            .scale = (1.0 - crossed->map->relaxation) * crossed->scale,
                            .speed = crossed->interval->speed + DBL_MIN,
                            .held = crossed->held,
                            .keep = crossed->watch ? &crossed->watch->nodes : NULL};
}

bool fc_may_keep_panel(FcCrossed* crossed, const FcPanelAt* at, const FcTrajectories* from, FcPanel* panel,
                       double* h) {
    *h = at->h;
    return !crossed->watch || fc_watch_panel(crossed->watch, crossed->interval, at, from, panel, h,
                                             &crossed->evaluations) != FC_UNRESOLVED;
}

// The next kind that is not refused yet. Gauss panels serve soft sections alone. A bounded one serves the
// whole section, and none that was cut at a meeting.
static PanelKind kind_of_panel(const Crossing* crossing) {
    const FcSection* section = crossing->section;
    if (crossing->first <= BOUNDED_GAUSS && section->soft && !section->in_peak &&
        crossing->t == section->start) {
        return BOUNDED_GAUSS;
    }
    if (crossing->first <= JUDGED_GAUSS && section->soft) {
        return JUDGED_GAUSS;
    }
    return crossing->first <= SETTLED ? SETTLED : RADAU;
}

// The section in one panel whose error is bounded beforehand.
static bool take_bounded_gauss(Crossing* crossing) {
    FcCrossed* crossed = crossing->crossed;
    const FcSection* section = crossing->section;
    const double X = fc_stretch_displacement(crossing->stretch, section->start, section->end);
    const FcTrajectories from = fc_crossed_trajectories(crossing->crossed);
    if (!fc_bounded_panel(crossed->interval, section->scene, section->start, section->end - section->start, X,
                          section->z.whole, &from, &crossing->panel, &crossed->evaluations)) {
        return false;
    }
    const double length = section->end - section->start;
    const FcPanelAt at = {section->scene, section->start, length, crossing->panel.nodes, 0.0};
    double h;
    if (!fc_may_keep_panel(crossed, &at, &from, &crossing->panel, &h)) {
        return false;
    }
    fc_map_append(crossed->map, &crossing->panel.map);
    crossing->t = h < length ? section->start + h : section->end;
    return true;
}

// The next panel of the section's plan; shorter, or with more nodes, if it is not accurate.
static bool take_judged_gauss(Crossing* crossing) {
    FcCrossed* crossed = crossing->crossed;
    const FcSection* section = crossing->section;
    const double length = section->end - section->start;
    if (crossing->t == section->start) {
        crossing->plan = fc_section_plan(crossing->stretch, section);
        crossing->nodes = crossing->plan.nodes;
        crossing->h = length / fmax(1.0, crossing->plan.count);
    }
    assert(crossing->plan.count >= 0 && crossing->t < section->end);
    if (crossing->plan.count == 0) {
        return false;
    }
    const double planned = length / crossing->plan.count;
    const double t = crossing->t;
    const double left = section->end - t;
    const FcTrajectories from = fc_crossed_trajectories(crossing->crossed);
    for (;;) {
        const double h = crossing->h < 0.9 * left && t + crossing->h > t ? crossing->h : left;
        const double share = (section->in_peak ? 1.0 : h / length) * section->share;
        FcPanel* panel = &crossing->panel;
        fc_gauss_panel(section->scene, t, h, crossing->nodes, &from, panel);
        crossed->evaluations += crossing->nodes;
        const FcPanelAt at = {section->scene, t, h, crossing->nodes, 0.0};
        double taken;
        if (fc_gauss_panel_is_accurate(panel, crossing->nodes, share, section->in_peak, section->forgets,
                                       fc_allowed_force(crossed->interval)) &&
            fc_gauss_bound(&crossed->interval->pace, crossing->nodes, h, panel->z) <=
                MOST_OF_BOUND * crossed->interval->tolerance &&
            fc_may_keep_panel(crossed, &at, &from, panel, &taken)) {
            fc_map_append(crossed->map, &panel->map);
            crossing->t = taken < left ? t + taken : section->end;
            crossing->h = panel->z < EASY_Z_PER_NODE * crossing->nodes ? fc_least(planned, 2.0 * h) : h;
            return true;
        }
        if (crossing->nodes < FC_GAUSS_MOST_NODES) {
            crossing->nodes = fc_gauss_count(crossing->nodes + 1.0);
        } else if (h > 0.2 * planned && t + 0.5 * h > t) {
            crossing->h = 0.5 * h;
        } else {
            return false;
        }
    }
}

// Sets the start of Radau and settled panels.
static void begin_radau(Crossing* crossing) {
    FcStretch* stretch = crossing->stretch;
    if (!(stretch->back > 0.0)) {
        fc_stretch_add_layers(stretch);
    }
    crossing->end = crossing->end_of_radau;
    const FcInterval* interval = stretch->interval;
    const double t = crossing->t;
    const bool from_start = t == stretch->start;
    const FcPhase phase = fc_stretch_phase(stretch, t);
    const FcCoefficients start =
        from_start ? stretch->at_start : fc_scene_coefficients_at_phase(interval->scene, t, phase);
    crossing->panel =
        (FcPanel){.rate = fc_relaxation_rate(&start), .sigma = start.sigma, .limit = start.limit};
    crossing->at = (FcPlace){
        .rate = crossing->panel.rate,
        .path = fabs(fc_stretch_displacement(stretch, t, stretch->end)),
        .layer = from_start && stretch->starts_at_reversal
                     ? stretch->w_a // the layer of a dip is not a time to relax in
                     : fc_event_layer(interval->scene, true, t, phase, &start),
    };
    stretch->relaxes = crossing->section->is_measured && from_start ? crossing->section->z.whole : 0.0;
    crossing->missed = fc_stretch_displacement(stretch, t, crossing->end);
    crossing->caution = 0;
    crossing->too_long = INFINITY;
    crossing->crossed->held = interval->moving_limit ? 0.0 : fc_sign(stretch->displacement) * start.limit;
}

static void place(Crossing* crossing) {
    const FcPanel* panel = &crossing->panel;
    const FcTrajectories from = fc_crossed_trajectories(crossing->crossed);
    FcPlace* at = &crossing->at;
    at->t = crossing->t;
    at->lag = (fabs(fc_sign(crossing->stretch->displacement) * panel->limit - panel->sigma * from.delta_0) +
               panel->sigma * fabs(from.scale)) /
              crossing->crossed->interval->force;
    if (at->gone == 0.0) {
        at->transient = at->lag;
    }
}

// Appends the last Radau or settled panel, which ends at the time `end` [s].
static void append(Crossing* crossing, double end) {
    assert(end >= crossing->t && end <= crossing->end);
    const FcPanel* panel = &crossing->panel;
    fc_map_append(crossing->crossed->map, &panel->map);
    crossing->at.gone += panel->z;
    crossing->at.rate = panel->rate;
    crossing->at.path -= fabs(panel->displacement);
    crossing->missed -= panel->displacement;
    crossing->t = end;
}

static bool take_settled(Crossing* crossing) {
    double end = crossing->end;
    place(crossing);
    if (!fc_settled_panel(crossing->stretch, &crossing->at, &end, &crossing->too_long, &crossing->panel,
                          &crossing->crossed->evaluations)) {
        return false;
    }
    append(crossing, end);
    return true;
}

// The factor by which a panel's error is too large.
static double excess_of(const Crossing* crossing, const FcPlan* plan) {
    const FcInterval* interval = crossing->crossed->interval;
    const FcPanel* panel = &crossing->panel;
    const FcPlace* at = &crossing->at;
    assert(at->t < interval->duration && plan->h <= interval->duration);
    const FcErrorLife life = {
        .lives = fc_least(plan->lives, interval->duration - at->t) / interval->duration,
        .lasts = plan->h / interval->duration,
        .grows = fc_least(interval->stiffness / panel->sigma, 1.0 + 2.0 * plan->lives / plan->grows),
        .in_peak = plan->in_peak,
        .crosses_peak = plan->crosses_peak,
    };
    const FcExcess over = fc_radau_panel_excess(panel, &life, fc_allowed_force(interval));
    if (!(over.end > over.mean)) {
        return over.mean;
    }
    return fc_most(over.mean,
                   over.end * fc_left_at_end(crossing->stretch, at, at->t + plan->h, at->gone + panel->z));
}

// Always true: a panel that was refused too often is taken as it is.
static bool take_radau(Crossing* crossing) {
    FcCrossed* crossed = crossing->crossed;
    const FcStretch* stretch = crossing->stretch;
    const FcInterval* interval = crossed->interval;
    const double t = crossing->t;
    const double left = crossing->end - t;
    const FcScene* scene = fc_in_peak(&stretch->peaks, t) ? interval->scene : interval->beyond_peaks;
    const FcTrajectories from = fc_crossed_trajectories(crossing->crossed);
    FcPlan plan = fc_mesh_plan(stretch, &crossing->at, crossing->caution);
    plan.h = fc_least(plan.h, left);
    if (!(t + plan.h > t)) {
        plan.h = fc_least(left, fmax(4e-16 * stretch->end, DBL_MIN));
    }
    double excess;
    double taken;
    for (int tries = 0;; tries++) {
        const double sign = fc_sign(stretch->displacement);
        fc_radau_panel(scene, t, plan.h, sign, &from, &crossing->panel);
        crossed->evaluations += FC_RADAU_STAGES;
        excess = excess_of(crossing, &plan);
        const FcPanelAt at = {scene, t, plan.h, 0, sign};
        const bool accurate = excess <= 1.0 || tries >= MOST_TRIES;
        taken = plan.h;
        if ((accurate && fc_may_keep_panel(crossed, &at, &from, &crossing->panel, &taken)) ||
            tries >= 3 * MOST_TRIES) {
            crossing->caution -= tries == 0 && crossing->caution > 0;
            break;
        }
        plan.h *=
            accurate ? 0.5 : fmax(0.4, 0.85 * pow(excess, -1.0 / 12.0)); // 0.4 if the error is not a number
        crossing->caution += !accurate && crossing->caution < MOST_CAUTION;
    }
    append(crossing, taken < left ? t + taken : crossing->end);
    if (!isfinite(excess)) {
        crossed->map->offset = NAN; // beyond the largest number: the step will be refused
    }
    return true;
}

// The bristle is settled nearly everywhere, and its force is the limit. So the error of the quadratures of
// work and heat is that force times their error of the displacement.
static void end_radau(Crossing* crossing) {
    FcCrossed* crossed = crossing->crossed;
    crossed->map->work_offset += crossed->held * crossing->missed;
    crossed->map->heat_offset += crossed->held * crossing->missed;
    crossed->held = 0.0;
}

// The functions that take a panel of each kind; false if it is not accurate.
static bool (*const TAKE[])(Crossing*) = {take_bounded_gauss, take_judged_gauss, take_settled, take_radau};

static void cross_part(Crossing* crossing) {
    const FcCrossed* crossed = crossing->crossed;
    bool has_begun = false; // with Radau or settled panels
    while (crossing->t < crossing->end && crossed->evaluations <= FC_MOST_EVALUATIONS &&
           !isnan(crossed->map->offset) && !fc_has_met(crossed)) {
        const PanelKind kind = kind_of_panel(crossing);
        if (kind >= SETTLED && !has_begun) {
            begin_radau(crossing);
            has_begun = true;
        }
        if (!TAKE[kind](crossing)) {
            crossing->first = kind < SETTLED ? kind + 1 : RADAU;
        } else if (has_begun) {
            crossing->first = SETTLED;
        }
    }
    if (has_begun) {
        end_radau(crossing);
    }
}

void fc_cross(FcCrossed* crossed, FcStretch* stretch) {
    FcSection sections[FC_MOST_SECTIONS];
    const int count = fc_sections(stretch, sections, &crossed->evaluations);
    assert(count > 0 && count <= FC_MOST_SECTIONS);
    double t = stretch->start;
    for (int i = 0; i < count && !fc_has_met(crossed); i++) {
        if (!(t < sections[i].end)) {
            continue; // Radau panels have crossed it
        }
        int last = i;
        while (last + 1 < count && !sections[last + 1].soft) {
            last++;
        }
        Crossing crossing = {
            .crossed = crossed,
            .stretch = stretch,
            .section = &sections[i],
            .t = t,
            .end = sections[i].end,
            .end_of_radau = sections[last].end,
            .first = BOUNDED_GAUSS,
        };
        cross_part(&crossing);
        assert(crossing.t >= t);
        t = crossing.t;
    }
}
