#include "solver/stick_slip.h"

#include <math.h>

#include "solver/bound.h"
#include "solver/bracketed_root.h"
#include "solver/solver.h"
#include "solver/turning_points.h"

// A bristle nearer to the bound than this, over D, is on it: what a step's end loses in rounding.
static const double ON_BOUND = 1e-14;

// What the bristle does since a moment.
typedef struct {
    const FcScene* scene;
    double side;           // +1, -1: slips along +D, -D; 0: sticks
    double start;          // s
    double delta;          // m, there
    FcPath path;           // from there on, while it sticks
    double constant_bound; // m, D where it does not move, else negative
    FcTotals totals;
    double* evaluations;
} Regime;

// How far the stuck bristle is beyond side * D.
typedef struct {
    const Regime* regime;
    double side;
} Beyond;

static FcRootFunction beyond_bound(const void* context, double t) {
    const Beyond* of = context;
    const Regime* regime = of->regime;
    const FcScene* scene = regime->scene;
    if (regime->constant_bound >= 0.0) {
        const double delta = regime->delta + fc_path_at(&regime->path, t);
        return (FcRootFunction){.value = of->side * delta - regime->constant_bound,
                                .rate = of->side * fc_drive_V(&scene->drive, t),
                                .curvature = of->side * fc_drive_V_rate(&scene->drive, t)};
    }
    const FcBoundMotion at = fc_bound_motion(scene, t);
    const double delta = regime->delta + fc_path_at_phase(&regime->path, t, at.sin_theta);
    return (FcRootFunction){.value = of->side * delta - at.D,
                            .rate = of->side * at.V - at.D_rate,
                            .curvature = of->side * at.V_rate - at.D_curvature};
}

static void begin_stick(Regime* regime, double t, double delta) {
    regime->side = 0.0;
    regime->start = t;
    regime->delta = delta;
    regime->path = fc_path_from(regime->scene, t);
}

static void begin_slip(Regime* regime, double t, double side, double delta) {
    regime->side = side;
    regime->start = t;
    regime->delta = delta;
}

// Adds what the regime gave until t, where the deflection is delta.
static void end_regime(Regime* regime, double t, double delta) {
    if (!(t > regime->start)) {
        return;
    }
    FcTotals* totals = &regime->totals;
    if (regime->side == 0.0) {
        const FcStickIntegrals stick =
            fc_stick_integrals(regime->scene, &regime->path, t, delta - regime->delta, regime->evaluations);
        totals->impulse += stick.impulse_slope * regime->delta + stick.impulse_offset;
        totals->work += stick.work_slope * regime->delta + stick.work_offset;
        totals->drag += stick.drag;
    } else {
        const FcTotals slip = fc_slip_totals(regime->scene, regime->side, regime->start, t,
                                             fabs(regime->delta), fabs(delta), regime->evaluations);
        totals->impulse += slip.impulse;
        totals->work += slip.work;
        totals->heat += slip.heat;
        totals->drag += slip.drag;
    }
}

// The moment in the piece at which the stuck bristle meets side * D; infinite if it does not.
static double meeting_time(const Regime* regime, const FcPiece* piece, double side) {
    const double start = side * (regime->delta + fc_path_at(&regime->path, piece->start));
    if (start >= piece->start_bound * (1.0 - ON_BOUND)) {
        return piece->start;
    }
    const double end = side * (regime->delta + fc_path_at(&regime->path, piece->end));
    if (!(end > piece->end_bound)) {
        return INFINITY;
    }
    const Beyond of = {regime, side};
    const FcRootFunction at_start = beyond_bound(&of, piece->start);
    *regime->evaluations += 1.0;
    return fc_bracketed_root(beyond_bound, &of, piece->start, at_start, piece->end, regime->evaluations);
}

static void cross(Regime* regime, const FcPiece* piece) {
    const bool leaves =
        (regime->side > 0.0 && !piece->nears_upper) || (regime->side < 0.0 && !piece->nears_lower);
    if (leaves) {
        const double delta = regime->side * piece->start_bound;
        end_regime(regime, piece->start, delta);
        begin_stick(regime, piece->start, delta);
    }
    if (regime->side != 0.0) {
        return;
    }
    const double upper = piece->nears_upper ? meeting_time(regime, piece, 1.0) : INFINITY;
    const double lower = piece->nears_lower ? meeting_time(regime, piece, -1.0) : INFINITY;
    const double t = fmin(upper, lower);
    if (t <= piece->end) {
        const double side = upper <= lower ? 1.0 : -1.0;
        const double D = regime->constant_bound >= 0.0 ? regime->constant_bound : fc_bound(regime->scene, t);
        end_regime(regime, t, side * D);
        begin_slip(regime, t, side, side * D);
    }
}

// Where the bristle is when the points have come to points->t.
static double deflection(const Regime* regime, const FcTurningPoints* points) {
    return regime->side != 0.0 ? regime->side * points->D
                               : regime->delta + fc_path_at(&regime->path, points->t);
}

FcStickSlip fc_stick_slip(const FcScene* scene, double h, double delta_0, double* evaluations) {
    FcTurningPoints points = fc_turning_points(scene, h);
    Regime regime = {.scene = scene,
                     .constant_bound = points.constant_bound ? points.D : -1.0,
                     .evaluations = evaluations};
    begin_stick(&regime, 0.0, fmax(-points.D, fmin(points.D, delta_0)));
    while (points.t < h && *evaluations + points.evaluations <= FC_MOST_EVALUATIONS) {
        const double delta = deflection(&regime, &points);
        const FcPiece piece = fc_turning_points_next(&points, delta, delta);
        cross(&regime, &piece);
    }
    const double delta = deflection(&regime, &points);
    end_regime(&regime, h, delta);
    *evaluations += points.evaluations;
    return (FcStickSlip){.delta = delta, .totals = regime.totals};
}
