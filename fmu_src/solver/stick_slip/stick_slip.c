#include "solver/stick_slip/stick_slip.h"

#include <assert.h>
#include <float.h>
#include <math.h>

#include "model/root.h"
#include "solver/methods/methods.h"
#include "solver/stick_slip/regime_integrals.h"
#include "solver/stick_slip/turning_points.h"

// A bristle nearer to the bound than this, over D, is on it. Rounding: the end of a step loses up to 45 eps.
static const double ON_BOUND = 1e-14;

// The rounding of a bound that follows an input, over the bound and over how many times the input has fallen; and the most
// that passes for rounding. By hand: less takes one that slips for one that sticks, more the other way round.
static const double ROUNDING_OF_INPUT = 32.0 * DBL_EPSILON;
static const double MOST_ROUNDING = 1e-3;

// A bristle whose deflection stays below this part of D does not meet the bound. By hand: far more than rounding; costs turning
// points that are not needed.
static const double CLEAR_OF_BOUND = 0.999;

// The errors at the ends of the intervals between a bristle's turning points add up, until it meets a bound: each may be
// this share of the tolerance. By hand: less costs panels, more breaks the tolerance.
static const double SHARE_OF_PIECE = 0.3;

// The largest tolerance of a free motion, where the force's scale has fallen by decades since the start. By hand: ten times
// the largest that a user may set.
static const double LARGEST_TOLERANCE = 0.1;

// The motion of a bristle that touches no bound, from a time on.
typedef struct {
    const FcScene* law;
    FcSolverOptions options;
    double force; // N, the scale that the tolerance is relative to
    FcIntegrator integrator;
    double start, end; // s, of the map
    FcMap map;         // of a bristle that relaxes
} FreeMotion;

static bool relaxes(const FreeMotion* free) { return free->law->friction->model != FC_ELASTIC_PLASTIC; }

// Of a bristle that relaxes, deflected by delta at the start.
static FcMap map_of_relaxing(const FreeMotion* free, double start, double end, double delta, FcMapScope scope,
                             double* evaluations) {
    if (start == 0.0) {
        return fc_collocation_interval(free->law, &free->options, end, delta, scope, evaluations);
    }
    const FcScene from = fc_scene_from(free->law, start);
    FcSolverOptions options = free->options;
    options.tolerance =
        fmin(LARGEST_TOLERANCE, options.tolerance * (free->force / fc_scene_force_scale(&from)));
    return fc_collocation_interval(&from, &options, end - start, delta, scope, evaluations);
}

static const FcMap* relaxed(FreeMotion* free, double start, double end, FcStepResult* result) {
    if (free->start != start || free->end != end) {
        free->map = map_of_relaxing(free, start, end, result->delta, FC_MAP_THIS_START, &result->evaluations);
        free->start = start;
        free->end = end;
    }
    return &free->map;
}

// What the bristle does since a moment, at which its deflection is result->delta.
typedef struct {
    FcTurningPoints* points;
    FreeMotion free;
    double side;         // +1, -1: slips along +D, -D; 0: touches no bound
    FcBoundMotion start; // t and the phase alone count while it touches none
    FcStepResult* result;
} Regime;

static void begin_regime(Regime* regime, double side, const FcBoundMotion* now) {
    regime->side = side;
    regime->start = *now;
}

// What the bristle has left to the bound where the root was found counts as slipped there and then, so that the heat's error
// is one of second order of that of the root.
static void begin_slip(Regime* regime, double side, const FcBoundMotion* now) {
    FcStepResult* result = regime->result;
    const double left = side * now->D - result->delta;
    result->heat -= 0.5 * now->sigma * left * (side * now->D + result->delta);
    result->drag += regime->free.law->friction->sigma_1 != 0.0 ? now->V * left : 0.0;
    begin_regime(regime, side, now);
}

// The displacement [m] since the regime began.
static double displacement(const Regime* regime, const FcBoundMotion* now) {
    const FcBoundMotion* start = &regime->start;
    return fc_drive_displacement_between(&regime->free.law->drive, start->t, start->phase, now->t,
                                         now->phase);
}

// Takes the result to now.
static void end_regime(Regime* regime, const FcBoundMotion* now) {
    FcStepResult* result = regime->result;
    const double start = regime->start.t;
    if (regime->side != 0.0) {
        fc_add_slip(&regime->free.integrator, regime->side, &regime->start, now, result);
    } else if (now->t > start && relaxes(&regime->free)) {
        fc_map_apply(relaxed(&regime->free, start, now->t, result), result);
        regime->free.end = -1.0; // it held for that deflection
    } else if (now->t > start) {
        const double x = displacement(regime, now);
        const FcMap map = fc_stick_map(&regime->free.integrator, start, now->t, x, &result->evaluations);
        fc_map_apply(&map, result);
    }
}

// The deflection [m] now of a bristle that has met no bound until then.
static double deflection(Regime* regime, const FcBoundMotion* now) {
    const double delta = regime->result->delta;
    if (!(now->t > regime->start.t)) {
        return delta;
    }
    if (relaxes(&regime->free)) {
        const FcMap* map = relaxed(&regime->free, regime->start.t, now->t, regime->result);
        return delta - map->relaxation * delta + map->offset;
    }
    return delta + displacement(regime, now);
}

// How far the bristle that touches no bound is beyond side * D.
typedef struct {
    Regime* regime;
    double side;
    FcBoundMotion last; // evaluated
} Beyond;

// A bristle that relaxes by far more than it comes nearer tends to p = approach / r like e^(-r t): the logarithm has a root
// at p = 0 too, and is straight.
static FcRootFunction beyond(const FcBoundMotion* at, double side, double delta) {
    const double r = fabs(at->V) * at->k / at->D;
    const double p = side * delta - at->D;
    const double approach = side * at->V - fabs(at->V) * at->k - at->D_rate;
    if (approach > 0.0 && -r * p > approach) {
        return (FcRootFunction){.value = -log1p(-r * p / approach), .rate = r};
    }
    return (FcRootFunction){.value = p,
                            .rate = approach - r * p,
                            .curvature = r == 0.0 ? side * at->V_rate - at->D_curvature : 0.0};
}

static FcRootFunction evaluate(void* context, double t) {
    Beyond* of = context;
    Regime* regime = of->regime;
    of->last = fc_turning_points_motion(regime->points, t);
    const FcRootFunction at = beyond(&of->last, of->side, deflection(regime, &of->last));
    if (relaxes(&regime->free) && at.value < 0.0) { // the root lies later: the next way is shorter from here
        end_regime(regime, &of->last);
        begin_regime(regime, 0.0, &of->last);
    }
    return at;
}

// The meeting with side * D between a and b, the deflections there given.
static FcBoundMotion meeting(Regime* regime, double side, const FcBoundMotion* a, double delta_a,
                             const FcBoundMotion* b, double delta_b) {
    Beyond of = {regime, side, *a};
    FcRootFunction at_b = beyond(b, side, delta_b);
    if (relaxes(&regime->free)) {
        at_b.rate = 0.0; // a straight line from a leads farther than a cubic through both
    }
    const double t = fc_root(evaluate, &of, a->t, beyond(a, side, delta_a), b->t, at_b,
                             regime->points->last_step, INFINITY, &regime->result->evaluations);
    if (relaxes(&regime->free)) { // what it has left to the bound is heat, to first order
        regime->result->evaluations += 1.0;
        return fc_turning_points_motion(regime->points, t);
    }
    return fc_bound_nearby(regime->points->scene, &of.last, t);
}

static bool is_on_bound(double side, double D, double delta) { return side * delta >= D * (1.0 - ON_BOUND); }

// Whether the bristle that sticks, deflected by delta_start and delta_end at the ends of the piece if it touches no bound,
// meets side * D; *there becomes the bound's motion at the meeting.
static bool meets(Regime* regime, const FcPiece* piece, double side, double delta_start, double delta_end,
                  FcBoundMotion* there) {
    if (is_on_bound(side, piece->start->D, delta_start)) {
        *there = *piece->start;
        return piece->nears[side < 0.0];
    }
    if (!(side * delta_end > piece->end->D)) {
        return false;
    }
    *there = meeting(regime, side, piece->start, delta_start, piece->end, delta_end);
    return true;
}

// Takes a bristle that sticks, deflected by *delta at the start of the piece, to where it meets a bound: which one, or to
// the end of the piece: 0, *delta becoming the deflection there.
static double stick(Regime* regime, const FcPiece* piece, double* delta, FcBoundMotion* there) {
    const double end = deflection(regime, piece->end);
    FcBoundMotion upper = *piece->start;
    FcBoundMotion lower = *piece->start;
    const bool meets_upper = meets(regime, piece, 1.0, *delta, end, &upper);
    const bool meets_lower = meets(regime, piece, -1.0, *delta, end, &lower);
    if (!meets_upper && !meets_lower) {
        *delta = end;
        return 0.0;
    }
    const bool upper_first = meets_upper && !(meets_lower && lower.t < upper.t);
    *there = upper_first ? upper : lower;
    return upper_first ? 1.0 : -1.0;
}

// The part of the piece in which a bristle that relaxes, deflected by delta at its start, should have met the bound that
// comes nearer, twice over: in the middle of the piece it tends to p = approach / r, and relaxes by the path over D.
static double part_to_meeting(Regime* regime, const FcPiece* piece, double delta) {
    const double duration = piece->end->t - piece->start->t;
    const FcBoundMotion at = fc_turning_points_motion(regime->points, piece->start->t + 0.5 * duration);
    const double side = piece->nears[0] ? 1.0 : -1.0;
    const double r = fabs(at.V) * at.k / at.D;
    const double approach = side * at.V - fabs(at.V) * at.k - at.D_rate;
    const double way = log1p((piece->start->D - side * delta) * r / fmax(approach, DBL_MIN));
    return sqrt(fmin(1.0, (1.0 + 2.0 * way) / (r * duration)));
}

// The same as stick for a bristle that relaxes. It may have met a bound that comes nearer and be back at it by the end of
// the piece, but for rounding: so it is looked for earlier too, where it should have met it, and in the middle. While no
// bound comes nearer it is not looked for at all.
static double relax(Regime* regime, const FcPiece* piece, FcBoundMotion* there) {
    if (!piece->nears[0] && !piece->nears[1]) {
        return 0.0;
    }
    FcBoundMotion before = *piece->start;
    end_regime(regime, &before);
    begin_regime(regime, 0.0, &before);
    for (int which = 0; which < 2; which++) {
        const double side = which == 0 ? 1.0 : -1.0;
        if (piece->nears[which] && is_on_bound(side, before.D, regime->result->delta)) {
            *there = before;
            return side;
        }
    }
    const double duration = piece->end->t - before.t;
    const double early = part_to_meeting(regime, piece, regime->result->delta);
    const double part[3] = {early, fmax(0.5, early), 1.0};
    for (int i = early < 0.5 ? 0 : early < 1.0 ? 1 : 2; i < 3; i++) {
        const FcBoundMotion now =
            i == 2 ? *piece->end
                   : fc_turning_points_motion(regime->points, piece->start->t + part[i] * duration);
        const double delta = regime->result->delta;
        const double reached = deflection(regime, &now);
        const double side = reached < 0.0 ? -1.0 : 1.0;
        if (fabs(reached) > now.D && piece->nears[side < 0.0]) {
            *there = meeting(regime, side, &before, delta, &now, reached);
            return side;
        }
        end_regime(regime, &now);
        begin_regime(regime, 0.0, &now);
        before = now;
    }
    return 0.0;
}

// Takes the bristle to the end of the piece, at the start of which one that sticks is deflected by delta: the deflection
// there, but of a bristle that relaxes.
static double cross(Regime* regime, const FcPiece* piece, double delta) {
    if (regime->side != 0.0 && !piece->nears[regime->side < 0.0]) {
        end_regime(regime, piece->start);
        begin_regime(regime, 0.0, piece->start);
    }
    if (regime->side == 0.0) {
        FcBoundMotion there = *piece->start;
        const double side =
            relaxes(&regime->free) ? relax(regime, piece, &there) : stick(regime, piece, &delta, &there);
        if (side == 0.0) {
            return delta;
        }
        end_regime(regime, &there);
        begin_slip(regime, side, &there);
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

static FreeMotion free_motion(const FcScene* law, const FcTurningPoints* points,
                              const FcSolverOptions* options) {
    return (FreeMotion){
        .law = law,
        .options = *options,
        .force = points->relaxes ? fc_scene_force_scale(law) : 0.0,
        .integrator = fc_integrator(points->scene, points->smooth_time, options->tolerance),
        .end = -1.0,
    };
}

FcMap fc_stick_slip_interval(const FcScene* scene, const FcSolverOptions* options, double duration,
                             double delta_0, FcMapScope scope, double* evaluations) {
    assert(scope == FC_MAP_THIS_START && duration >= 0.0);
    (void)scope;
    FcTurningPoints points;
    fc_turning_points_start(&points, scene, options->tolerance, duration);
    FcStepResult result = {.delta = fc_bound_reached(points.at, delta_0),
                           .heat = fc_bound_loss(points.at, delta_0),
                           .evaluations = *evaluations};
    Regime regime = {.points = &points, .free = free_motion(scene, &points, options), .result = &result};
    begin_regime(&regime, 0.0, points.at);
    if (sticks(points.scene, duration, points.at->D, result.delta)) {
        const FcBoundMotion end = {.t = duration, .phase = fc_drive_phase(&scene->drive, duration)};
        end_regime(&regime, &end);
    } else {
        double delta = result.delta;
        regime.free.options.tolerance *= SHARE_OF_PIECE;
        while (points.at->t < duration && result.evaluations + points.evaluations <= FC_MOST_EVALUATIONS) {
            FcPiece piece;
            fc_turning_points_next(&points, delta, delta, &piece);
            delta = cross(&regime, &piece, delta);
        }
        end_regime(&regime, points.at);
    }
    *evaluations = result.evaluations + points.evaluations;
    return fc_map_of_one_start(&result);
}

// The starts from which a map leads to between the bounds.
static void keep_free(const FcMap* map, double D, FcFreePeriod* free) {
    const double kept = 1.0 - map->relaxation;
    if (kept > 0.0) {
        free->lowest = fmax(free->lowest, (-D - map->offset) / kept);
        free->highest = fmin(free->highest, (D - map->offset) / kept);
    } else if (!(fabs(map->offset) <= D)) {
        free->lowest = INFINITY;
        free->highest = -INFINITY;
    }
}

// Takes the map of a bristle that relaxes to the end of the piece, by way of its middle where a bound comes nearer: at the
// end the bristle may be back at it, but for rounding.
static void relax_freely(const FreeMotion* motion, const FcTurningPoints* points, const FcPiece* piece,
                         double delta_0, FcFreePeriod* free, double* evaluations) {
    FcBoundMotion at = *piece->start;
    for (int halves = piece->nears[0] || piece->nears[1] ? 1 : 2; halves <= 2; halves++) {
        const double t = at.t;
        at = halves == 2 ? *piece->end : fc_turning_points_motion(points, 0.5 * (t + piece->end->t));
        const FcMap map = map_of_relaxing(motion, t, at.t, delta_0, FC_MAP_ANY_START, evaluations);
        fc_map_append(&free->map, &map);
        keep_free(&free->map, at.D, free);
    }
}

// A start is free if the deflection is within the bounds at every turning point and at the end. Without one there is no map.
FcFreePeriod fc_stick_slip_free_period(const FcScene* scene, const FcSolverOptions* options, double delta_0,
                                       double* evaluations) {
    const double period = 1.0 / scene->drive.vibration.f;
    FcTurningPoints points;
    fc_turning_points_start(&points, scene, options->tolerance, period);
    FreeMotion motion = free_motion(scene, &points, options);
    motion.options.tolerance *= SHARE_OF_PIECE;
    FcFreePeriod free = {.map = fc_map_identity(), .lowest = -points.at->D, .highest = points.at->D};
    while (points.at->t < period && free.lowest <= free.highest &&
           *evaluations + points.evaluations <= FC_MOST_EVALUATIONS) {
        FcPiece piece;
        fc_turning_points_next(&points, -FC_NO_BOUND, FC_NO_BOUND, &piece);
        if (relaxes(&motion)) {
            relax_freely(&motion, &points, &piece, delta_0, &free, evaluations);
        } else {
            free.map.offset = fc_drive_displacement(&scene->drive, 0.0, piece.end->t);
            keep_free(&free.map, piece.end->D, &free);
        }
    }
    *evaluations += points.evaluations;
    if (!relaxes(&motion) && free.lowest <= free.highest) {
        const double x =
            scene->drive.V.value * period; // the vibration leads back, without what rounding leaves
        free.map = fc_stick_map(&motion.integrator, 0.0, period, x, evaluations);
    }
    if (free.highest > 0.5 * FC_NO_BOUND) {
        free.lowest = -INFINITY;
        free.highest = INFINITY;
    }
    return free;
}

double fc_stick_slip_reached(const FcScene* scene, double delta, double* loss) {
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(scene, &friction);
    const FcBoundMotion at = fc_bound_motion(&bound, 0.0);
    *loss = fc_bound_loss(&at, delta);
    return fc_bound_reached(&at, delta);
}

double fc_stick_slip_end(const FcScene* scene, double h, double delta) {
    const FcDrive* drive = &scene->drive;
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(scene, &friction);
    if ((drive->E.rate == 0.0 && drive->load.rate == 0.0) || fc_bound_is_constant(&bound)) {
        return delta;
    }
    const double D = fc_bound_motion(&bound, h).D;
    const double fall =
        fmax(drive->E.value / fc_drive_E(drive, h), drive->load.value / fc_drive_load(drive, h));
    const double rounding = fmin(MOST_ROUNDING, ROUNDING_OF_INPUT * fall);
    return fabs(fabs(delta) - D) <= rounding * D ? copysign(D, delta) : delta;
}

bool fc_stick_slip_may_touch(const FcScene* scene) {
    if (scene->friction->model == FC_ELASTIC_PLASTIC) {
        return true;
    }
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(scene, &friction);
    return fc_bound_may_fall(&bound);
}
