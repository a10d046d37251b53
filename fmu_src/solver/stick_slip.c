#include "solver/stick_slip.h"

#include <math.h>

#include "solver/bracketed_root.h"
#include "solver/solver.h"
#include "solver/turning_points.h"

// A bristle nearer to the bound than this, over D, is on it: what a step's end loses in rounding.
static const double ON_BOUND = 1e-14;

// A bristle farther from the bound than this, over D, does not meet it in rounding.
static const double CLEAR_OF_BOUND = 0.999;

// What the bristle does since a moment.
typedef struct {
    FcTurningPoints* points;
    FcIntegrator integrator;
    double side;         // +1, -1: slips along +D, -D; 0: sticks
    FcBoundMotion start; // while it slips
    double delta;        // m, at the start
    FcPath path;         // from there on, while it sticks
    FcTotals* totals;
    double* evaluations;
} Regime;

static void begin_stick(Regime* regime, double t, double delta) {
    regime->side = 0.0;
    regime->delta = delta;
    regime->path = fc_path_from(regime->points->scene, t);
}

static void begin_slip(Regime* regime, double side, const FcBoundMotion* at) {
    regime->side = side;
    regime->start = *at;
}

// Adds what the regime gave until now, where the deflection is delta.
static void end_regime(Regime* regime, const FcBoundMotion* now, double delta) {
    FcTotals part = {0};
    if (regime->side == 0.0 && now->t > regime->path.start) {
        part = fc_stick_totals(&regime->integrator, &regime->path, regime->delta, now->t, delta,
                               regime->evaluations);
    } else if (regime->side != 0.0 && now->t > regime->start.t) {
        part = fc_slip_totals(&regime->integrator, regime->side, &regime->start, now, regime->evaluations);
    }
    regime->totals->impulse += part.impulse;
    regime->totals->work += part.work;
    regime->totals->heat += part.heat;
    regime->totals->drag += part.drag;
}

// How far the stuck bristle is beyond side * D.
typedef struct {
    const Regime* regime;
    double side;
    FcBoundMotion last; // evaluated
} Beyond;

static FcRootFunction beyond(const FcBoundMotion* at, double side, double delta) {
    return (FcRootFunction){.value = side * delta - at->D,
                            .rate = side * at->V - at->D_rate,
                            .curvature = side * at->V_rate - at->D_curvature};
}

static FcRootFunction evaluate(void* context, double t) {
    Beyond* of = context;
    const Regime* regime = of->regime;
    of->last = fc_turning_points_motion(regime->points, t);
    return beyond(&of->last, of->side,
                  regime->delta + fc_path_at_phase(&regime->path, t, of->last.sin_theta));
}

// Whether the stuck bristle, deflected by delta_start and delta_end at the ends of the piece, meets side * D; *there, the
// bound's motion at the start, becomes that at the meeting.
static bool meets(const Regime* regime, const FcPiece* piece, double side, double delta_start,
                  double delta_end, FcBoundMotion* there) {
    if (side * delta_start >= piece->start->D * (1.0 - ON_BOUND)) {
        return piece->nears[side < 0.0];
    }
    if (!(side * delta_end > piece->end->D)) {
        return false;
    }
    Beyond of = {regime, side, *piece->start};
    const double t =
        fc_bracketed_root(evaluate, &of, piece->start->t, beyond(piece->start, side, delta_start),
                          piece->end->t, beyond(piece->end, side, delta_end), regime->points->last_step,
                          regime->points->longest_way, regime->evaluations);
    *there = fc_bound_nearby(&of.last, t);
    return true;
}

static double stuck_at(const Regime* regime, const FcPiece* piece) {
    const double t = piece->end->t;
    return regime->delta + (piece->turns ? fc_path_at(&regime->path, t)
                                         : fc_path_at_phase(&regime->path, t, piece->end->sin_theta));
}

// The bound that recedes from a stuck bristle that lies on it at the start of the piece, and beyond at the end; -1 if none.
static int comes_back_to(const FcPiece* piece, double delta_start, double delta_end) {
    for (int which = 0; which < 2; which++) {
        const double side = which == 0 ? 1.0 : -1.0;
        if (!piece->nears[which] && side * delta_end > piece->end->D &&
            side * delta_start >= piece->start->D * (1.0 - ON_BOUND)) {
            return which;
        }
    }
    return -1;
}

// Takes the bristle, deflected by delta at the start of the piece, to its end: the deflection there.
static double cross(Regime* regime, FcPiece* piece, double delta) {
    if (regime->side != 0.0 && !piece->nears[regime->side < 0.0]) {
        end_regime(regime, piece->start, delta);
        begin_stick(regime, piece->start->t, delta);
    }
    if (regime->side == 0.0) {
        double end = stuck_at(regime, piece);
        const int which = comes_back_to(piece, delta, end);
        if (which >= 0) {
            fc_turning_points_shorten(regime->points, piece, which);
            end = stuck_at(regime, piece);
        }
        FcBoundMotion upper = *piece->start;
        FcBoundMotion lower = *piece->start;
        const bool meets_upper = meets(regime, piece, 1.0, delta, end, &upper);
        const bool meets_lower = meets(regime, piece, -1.0, delta, end, &lower);
        if (!meets_upper && !meets_lower) {
            return end;
        }
        const double side = meets_upper && !(meets_lower && lower.t < upper.t) ? 1.0 : -1.0;
        const FcBoundMotion* first = side > 0.0 ? &upper : &lower;
        end_regime(regime, first, side * first->D);
        begin_slip(regime, side, first);
    }
    return regime->side * piece->end->D;
}

// Whether a bristle deflected by delta where the bound is D comes near no bound in [0, h].
static bool sticks(const FcScene* scene, double h, double D, double delta) {
    const FcDrive* drive = &scene->drive;
    double reach = fmax(fabs(drive->V.value), fabs(drive->V.value + drive->V.rate * h)) * h;
    if (drive->vibration.V_1 != 0.0) {
        reach += drive->vibration.V_1 * fmin(h, 2.0 / drive->omega);
    }
    const double farthest = fabs(delta) + reach;
    return farthest < D && farthest < CLEAR_OF_BOUND * fc_scene_smallest_saturation(scene, h);
}

FcStickSlip fc_stick_slip(const FcScene* scene, double tolerance, double h, double delta_0,
                          double* evaluations) {
    FcTurningPoints points;
    fc_turning_points_start(&points, scene, tolerance, h);
    FcStickSlip result = {.delta = fc_bound_reached(points.at, delta_0),
                          .totals.heat = fc_bound_loss(points.at, delta_0)};
    Regime regime = {.points = &points,
                     .integrator = fc_integrator(scene, points.smooth_time, tolerance),
                     .totals = &result.totals,
                     .evaluations = evaluations};
    begin_stick(&regime, 0.0, result.delta);
    if (sticks(scene, h, points.at->D, result.delta)) {
        result.delta += fc_path_at(&regime.path, h);
    } else {
        fc_turning_points_foresee(&points, result.delta, result.delta);
        while (points.at->t < h && *evaluations + points.evaluations <= FC_MOST_EVALUATIONS) {
            FcPiece piece;
            fc_turning_points_next(&points, result.delta, result.delta, &piece);
            result.delta = cross(&regime, &piece, result.delta);
        }
    }
    const FcBoundMotion end = {.t = h};
    end_regime(&regime, regime.side == 0.0 ? &end : points.at, result.delta);
    *evaluations += points.evaluations;
    return result;
}
