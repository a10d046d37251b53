#include "solver/input_jump.h"

#include <assert.h>
#include <float.h>
#include <math.h>

#include "model/extremes.h"
#include "model/plane.h"
#include "model/root.h"
#include "solver/panel/panel_tables.h"

FcPast fc_past(const FcScene* scene) {
    if (fc_scene_is_separated(scene)) {
        return (FcPast){.sigma = 0.0};
    }
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    return (FcPast){.d = fc_scene_depends_on_d(scene) ? fc_scene_d(scene, 0.0) : 0.0,
                    .V = at.V,
                    .V_y = fc_drive_V_y(&scene->drive, 0.0),
                    .E = scene->drive.E.value,
                    .limit = at.limit / fc_stribeck(scene->friction, at.V),
                    .ratio = fc_static_ratio(scene->friction),
                    .V_S = scene->friction->V_S,
                    .sigma = at.sigma};
}

// The ramp from the past to the scene. Its places run from 0 to 1.
typedef struct {
    const FcScene* scene;
    FcPast past, now;
    double d, V, V_y, E;                             // by which they change
    double log_limit, log_ratio, log_V_S, log_sigma; // by which parameters change them
    double along, along_change;                      // m2/s, V times delta, and by which it changes
    double start, delta, heat; // m, m and J: |delta| at the begin and now, and the heat so far
    double sought;             // m, the D that above_bound seeks
    bool pushed;               // after the ramp, if the bristle slips
    bool slips;                // the bristle, which chooses the bound
} Ramp;

typedef struct {
    double limit; // N, of the bound
    double sigma; // N/m
    double D;     // m
    double rate;  // m, of D along the ramp
} Place;

// Whether a bristle that breaks away drops: with static friction at the start or the end of the ramp.
static bool drops(const Ramp* ramp) {
    const FcFriction* friction = ramp->scene->friction;
    return fc_may_stick(friction) && (ramp->past.ratio > 1.0 || friction->staticRatio > 1.0);
}

// Static over Coulomb friction, or Stribeck's curve of a bristle that slips, and the rate of its logarithm.
static double curve_at(const Ramp* ramp, double s, double* log_rate) {
    const double ratio =
        fc_max(1.0, ramp->past.ratio * exp(s * ramp->log_ratio)); // 1 may be rounded below it
    *log_rate = ramp->log_ratio;
    if (!drops(ramp) || !ramp->slips) {
        return ratio;
    }
    FcFriction at = *ramp->scene->friction;
    at.staticRatio = ratio;
    at.V_S = ramp->past.V_S * exp(s * ramp->log_V_S);
    const FcVector V = {ramp->past.V + s * ramp->V, ramp->past.V_y + s * ramp->V_y};
    const double speed = hypot(V.x, V.y);
    const double speed_rate = fc_product(fc_direction_or_zero(V), (FcVector){ramp->V, ramp->V_y});
    const double by_ratio = exp(fc_stribeck_log_peak(&at, speed)) * ratio * ramp->log_ratio;
    const double by_speed = fc_stribeck_slope(&at, speed) * (speed_rate - speed * ramp->log_V_S);
    *log_rate = (by_ratio + by_speed) / fc_stribeck(&at, speed);
    return fc_stribeck(&at, speed);
}

static Place at_place(const Ramp* ramp, double s) {
    const FcScene* scene = ramp->scene;
    const FcFriction* friction = scene->friction;
    const double d = (1.0 - s) * ramp->past.d + s * ramp->now.d; // above 0 at any size of the other
    const double E = (1.0 - s) * ramp->past.E + s * ramp->now.E;
    const bool follows_load = fc_limit_follows_load(friction);
    Place at = {.limit = scene->F_C, .sigma = scene->at_E.stiffness_0};
    double rate = ramp->log_limit - ramp->log_sigma;
    if (fc_scene_depends_on_d(scene)) {
        const FcContactAtModulus at_E =
            ramp->E == 0.0 ? scene->at_E : fc_contact_at_modulus(scene->contact, E);
        const FcContactResponse response = fc_contact_response(&at_E, d);
        const FcContactLogSlope by_d = fc_contact_slope_by_d(&at_E, d);
        at.sigma = response.sigma;
        rate -= by_d.sigma * ramp->d;
        if (follows_load) {
            at.limit = friction->mu * response.F_n;
            rate += by_d.F_n * ramp->d;
        }
        if (ramp->E != 0.0) {
            const FcContactLogSlope by_E = fc_contact_slope_by_E(scene->contact, E);
            rate += ((follows_load ? by_E.F_n : 0.0) - by_E.sigma) * ramp->E;
        }
    }
    double curve_rate;
    at.sigma *= exp((s - 1.0) * ramp->log_sigma);
    at.limit *= exp((s - 1.0) * ramp->log_limit) * curve_at(ramp, s, &curve_rate);
    at.D = at.limit / at.sigma;
    at.rate = at.D * (rate + curve_rate);
    return at;
}

static Ramp ramp_between(const FcScene* scene, const FcPast* past, const FcPast* now,
                         const FcBristle* bristle) {
    Ramp ramp = {.scene = scene, .past = *past, .now = *now};
    ramp.d = now->d - past->d;
    ramp.V = now->V - past->V;
    ramp.V_y = now->V_y - past->V_y;
    ramp.E = now->E - past->E;
    ramp.log_ratio = log(now->ratio / past->ratio);
    ramp.log_V_S = log(now->V_S / past->V_S);
    const Place start = at_place(&ramp, 0.0); // with the other parameters of now
    ramp.log_limit = log(start.limit / (past->ratio * past->limit));
    ramp.log_sigma = log(start.sigma / past->sigma);
    ramp.along = past->V * bristle->delta + past->V_y * bristle->delta_y;
    ramp.along_change = ramp.V * bristle->delta + ramp.V_y * bristle->delta_y;
    ramp.start = ramp.delta = fc_size(*bristle);
    ramp.slips = bristle->state != FC_FREE;
    return ramp;
}

static double above_bound(void* context, double s) {
    const Ramp* ramp = context;
    return ramp->sought - at_place(ramp, s).D;
}

static double bound_rate(void* ramp, double s) { return at_place(ramp, s).rate; }

// Between two places over which D falls, or rises. The bristle at |delta| follows D once D is lower, with the
// heat g |dD|.
static void follow(Ramp* ramp, double a, double b) {
    assert(a <= b && !(ramp->delta < 0.0));
    const Place end = at_place(ramp, b);
    if (!(end.D < ramp->delta)) {
        return;
    }
    double none = 0.0;
    ramp->sought = ramp->delta;
    const double at_a = above_bound(ramp, a);
    const double from =
        at_a < 0.0 ? fc_root_between(above_bound, ramp, a, at_a, b, ramp->delta - end.D, 0.0, &none) : a;
    for (int i = 0; i < FC_STAGES; i++) {
        const Place at = at_place(ramp, from + (0.5 + FC_RADAU.node[i]) * (b - from));
        // With its sign, so that a shallow rise that is not seen cancels its fall.
        ramp->heat -= FC_RADAU.weight[i] * (b - from) * at.limit * at.rate;
    }
    ramp->delta = end.D;
}

// The largest changes over a step of the ramp: of the logarithms of D, g and sigma together, and of V over
// V_S on Stribeck's curve. Half of them doubles the steps; twice of them leaves twice the change to the 9
// nodes of a step. Two turns of D in one step are not seen: they change the heat by the fourth power of the step.
static const double STEP_OF_LOG = 0.5;
static const double FACTOR_OF_STEP = 1.65; // its exponential
// The largest number of steps: more than there are from the smallest number to the largest.
static const double MAX_STEPS = 1e4;
static const double STEP_OF_CURVE = 1.0 / 16.0;
// The largest V over V_S with a curve: two V_S beyond the end of its peak, where e^-49 of it is left. Chosen: each V_S of it
// costs at most 27 steps.
static const double END_OF_CURVE = FC_END_OF_PEAK + 2.0;
// Two places of the ramp, which is 1 long, that count as one. Chosen: far above the rounding of a root, far below a step.
static const double SAME_PLACE = 1e-9;
// What makes the number of equal steps at least 1. Chosen: a small part of a step.
static const double ANY_STEP = 1e-3;

// The next place to stop at after s.
static double next_place(const Ramp* ramp, double s, double step) {
    const double V_S = ramp->past.V_S * exp(s * ramp->log_V_S);
    const double V = hypot(ramp->past.V + s * ramp->V, ramp->past.V_y + s * ramp->V_y);
    const double change = hypot(ramp->V, ramp->V_y);
    double next = s + step;
    if (ramp->slips && drops(ramp) && change != 0.0) {
        next = fc_min(
            next, s + fc_max(STEP_OF_CURVE * V_S / FACTOR_OF_STEP, V - END_OF_CURVE * FACTOR_OF_STEP * V_S) /
                          change);
        const double reversal = ramp->along_change != 0.0 ? -ramp->along / ramp->along_change : -1.0;
        next = reversal > s && reversal < next ? reversal : next;
    }
    const double place = next < 1.0 - SAME_PLACE ? fc_max(next, s + SAME_PLACE) : 1.0;
    assert(place > s && place <= 1.0);
    return place;
}

// The length of equal steps over the ramp from the place s on.
static double step_from(const Ramp* ramp, double s) {
    const Place first = at_place(ramp, s);
    const Place last = at_place(ramp, 1.0);
    const double moves = fabs(log(last.D / first.D)) + fabs(log(last.limit / first.limit)) +
                         fabs(log(last.sigma / first.sigma)) + fabs(ramp->d) * ramp->scene->at_E.decay +
                         fabs(ramp->log_V_S);
    return (1.0 - s) / ceil(fc_min(moves / STEP_OF_LOG, MAX_STEPS) + ANY_STEP);
}

// The next place to stop at after s, or the one before it at which D turns.
static double next_stop(Ramp* ramp, double s, double step) {
    const double next = next_place(ramp, s, step);
    const double rate = bound_rate(ramp, s);
    const double rate_next = bound_rate(ramp, next);
    if (!(rate * rate_next < 0.0)) {
        return next;
    }
    double none = 0.0;
    const double turn = fc_root_between(bound_rate, ramp, s, rate, next, rate_next, 0.0, &none);
    return turn > s + SAME_PLACE ? turn : next;
}

// Whether a bristle that has broken away sticks between two stops: neither V nor the motion after the ramp
// pushes it outward, and it lies inside its bound, or its bound rises, or V has reversed before it slipped. A
// bristle that is pushed does not stick, so that held steps come to the ramp that they sample.
static bool sticks_between(const Ramp* ramp, double s, double next) {
    if (!drops(ramp) || ramp->pushed || ramp->along + 0.5 * (s + next) * ramp->along_change > 0.0) {
        return false;
    }
    const double D = at_place(ramp, s).D;
    const double delta = ramp->delta;
    const bool has_slipped = delta < (1.0 - FC_ROUNDING_OF_BOUND) * ramp->start;
    return (ramp->along > 0.0 && !has_slipped) || delta < (1.0 - FC_INSIDE_BOUND) * D ||
           at_place(ramp, next).D > (1.0 + FC_INSIDE_BOUND) * D;
}

// Whether the ramp raises the bound of a slipping bristle that has not reached it since an earlier jump. The
// steps then sample a bound that rises faster than the bristle moves, so that it sticks.
static bool lags_behind(const Ramp* ramp) {
    const double D = at_place(ramp, 0.0).D;
    return ramp->start < (1.0 - FC_INSIDE_BOUND) * D && at_place(ramp, 1.0).D > (1.0 + FC_INSIDE_BOUND) * D;
}

// Takes a bristle that slips to the end of the ramp or to the place at which it sticks, which is returned.
static double slip_from(Ramp* ramp, double s) {
    const double step = step_from(ramp, s);
    while (s < 1.0) {
        const double next = next_stop(ramp, s, step);
        if (sticks_between(ramp, s, next)) {
            ramp->slips = false;
            return s;
        }
        follow(ramp, s, next);
        s = next;
    }
    return s;
}

// Takes a bristle that sticks to the end of the ramp or to the place at which its static bound falls below |delta|
// and it breaks away, which is returned.
static double stick_from(Ramp* ramp, double s) {
    double none = 0.0;
    ramp->sought = (1.0 - FC_ROUNDING_OF_BOUND) * ramp->delta;
    double at_s = above_bound(ramp, s);
    const double step = step_from(ramp, s);
    while (s < 1.0 && at_s <= 0.0) {
        const double next = next_stop(ramp, s, step);
        const double at_next = above_bound(ramp, next);
        if (at_next > 0.0) {
            s = at_s < 0.0 ? fc_root_between(above_bound, ramp, s, at_s, next, at_next, 0.0, &none) : s;
            break;
        }
        s = next;
        at_s = at_next;
    }
    if (s < 1.0) {
        ramp->slips = true;
        const Place at = at_place(ramp, s);
        ramp->heat += fc_drop_heat(at.sigma, ramp->delta, at.D);
        ramp->delta = at.D;
    }
    return s;
}

// The rounding of a phase over 1 + omega t: 16 eps. Half of it takes ramps of rounding, twice of it ignores jumps
// of as much.
static const double ROUNDING_OF_PHASE = 16.0 * DBL_EPSILON;

// Whether nothing jumps at the time t, apart from the rounding of the vibration's phase.
static bool is_same(const FcScene* scene, double t, const FcPast* now, const FcPast* past) {
    const FcVibration* v = &scene->drive.vibration;
    const double angle = ROUNDING_OF_PHASE * (1.0 + scene->drive.omega * fabs(t));
    const double of_V = angle * (now->V_S + v->V_1 + v->V_2);
    const double of_d =
        angle * (4.0 + 2.0 * scene->at_E.decay * v->a_d); // ln sigma by d: 2 decay + 3 / d; a_d < d
    return now->E == past->E && now->ratio == past->ratio && now->V_S == past->V_S &&
           fabs(now->V - past->V) <= of_V && fabs(now->V_y - past->V_y) <= of_V &&
           fabs(now->sigma - past->sigma) <= of_d * now->sigma &&
           fabs(now->limit - past->limit) <= of_d * now->limit;
}

// Three outcomes: a bristle without a bound stays; one whose inputs do not jump, or without a contact on one side of the jump,
// is projected onto its bound; all others follow a ramp between the inputs, on which they stick and slip in turn.
FcBristle fc_input_jump(const FcScene* scene, double t, const FcPast* past, const FcBristle* from,
                        double* heat) {
    FcBristle bristle = *from;
    const double delta = fc_size(bristle);
    *heat = 0.0;
    if (!fc_is_bounded(scene->friction) && !fc_scene_is_separated(scene)) {
        return bristle;
    }
    const FcPast now = fc_past(scene);
    const bool same = is_same(scene, t, &now, past);
    if (past->sigma == 0.0 || now.sigma == 0.0 || same) {
        const FcBristle reached = fc_project_onto_bound(scene, bristle);
        const double end = fc_size(reached);
        // If nothing jumps, an excess is the last step's error, within its tolerance. An open contact has no stiffness, or a
        // constant one.
        if (end < delta && !same) {
            *heat = fc_drop_heat(fc_scene_contact(scene, 0.0).sigma, delta, end);
        }
        return reached;
    }
    const int side = bristle.delta < 0.0 ? -1 : 1;
    Ramp ramp = ramp_between(scene, past, &now, &bristle);
    if (drops(&ramp)) {
        bristle.state = FC_SLIPPING;
        ramp.pushed = fc_push(scene, bristle) > 0.0;
        if (past->ratio == 1.0) { // then no state tells whether it slips
            ramp.slips = ramp.along > 0.0 && delta >= (1.0 - FC_INSIDE_BOUND) * at_place(&ramp, 0.0).D;
        }
        ramp.slips = ramp.slips && !lags_behind(&ramp);
    }
    for (double s = 0.0; s < 1.0;) {
        s = drops(&ramp) && !ramp.slips ? stick_from(&ramp, s) : slip_from(&ramp, s);
    }
    *heat = ramp.heat;
    bristle.state = ramp.slips && fc_has_static_friction(scene->friction) ? FC_SLIPPING : FC_FREE;
    if (bristle.delta_y == 0.0) {
        bristle.delta = side * ramp.delta;
    } else {
        bristle.delta *= ramp.delta / delta;
        bristle.delta_y *= ramp.delta / delta;
    }
    return fc_project_onto_bound(scene, bristle);
}
