#include "solver/mesh.h"

#include <math.h>

// The error that a panel is planned for, over what the mean and the end of the interval are allowed.
static const double SHARE_OF_MEAN = 0.003;
static const double SHARE_AT_END = 0.001;
// Of the lag behind a limit that stands still panels miss less than DISTANCES says, by about this, for errors no smaller than
// that.
static const double OF_THE_LAG = 5.0;
static const double COARSE = 1e-4;

// What panels may miss of a stretch's path, which decides in the stiffest contacts.
static const double MISSED_OF_PATH = 0.1;

// Of what is told to relax in a stretch, and of what would be left of it, these parts are counted on.
static const double SURE_OF_WHOLE = 0.9;
static const double SURE_OF_REST = 0.5;

// Five stages estimate more than nine would miss in a panel that ends at an event, if as much as this of an error there is
// left at the interval's end.
static const double SEEN = 0.1;

enum { FIVE_STAGES, NINE_STAGES, KINDS };
enum { FINEST = 15 };
static const int STAGES[KINDS] = {5, 9};

// Lengths of a panel for a relative error of 10^-k, k = 0 .. FINEST. LAYERS: of a decaying transient, in layers.
// DISTANCES: of the lag, in distances from its event. SMOOTH: in the time over which a logarithm of the coefficients
// moves by 1.
static const double LAYERS[KINDS][FINEST + 1] = {
    {20, 7, 4.5, 2.8, 1.8, 1.3, 1.0, .75, .6, .47, .37, .3, .24, .19, .15, .12},
    {25, 14, 9, 6.5, 4.5, 3.5, 2.8, 2.3, 1.9, 1.65, 1.4, 1.2, 1.02, .9, .8, .7},
};
static const double DISTANCES[KINDS][FINEST + 1] = {
    {40, 20, 10, 5, 2.6, 1.6, 1.1, .75, .5, .38, .3, .24, .19, .15, .12, .1},
    {40, 30, 20, 14, 10, 6.5, 4.2, 2.9, 2.1, 1.5, 1.1, .85, .65, .53, .43, .35},
};
static const double SMOOTH[KINDS][FINEST + 1] = {
    {8, 6, 3.2, 3.16, 2.5, 2.0, 1.58, 1.26, 1.0, .79, .63, .5, .4, .316, .25, .2},
    {8, 8, 8, 3.2, 3.2, 3.2, 3.2, 3.2, 3.2, 3.2, 3.15, 2.78, 2.44, 2.15, 1.89, 1.66},
};
// A panel that ends on a reversal and steps over its layer leaves an error of LAST lags at its last node, whose weight
// is 1 / stages^2: last diagonal entry of the inverse of the method's matrix.
static const double LAST[KINDS] = {13, 41};

static double least(double a, double b) { return a < b ? a : b; }
static double most(double a, double b) { return a > b ? a : b; }

// What the Stribeck curve asks of a panel that begins in its bell.
typedef struct {
    double
        lasts; // s, in which V moves by about half of itself and a Stribeck velocity, so that g(V) is resolved
    double tau;    // s, in which it moves by a Stribeck velocity
    double height; // 1, by which g still moves, over g
} Bell;

static Bell bell_at(const FcScene* scene, const FcBells* bells, double t) {
    const FcFriction* friction = scene->friction;
    const FcVelocity at = fc_drive_velocity(&scene->drive, t);
    const bool falls = t < bells->after && bells->after < bells->before;
    return (Bell){
        .lasts = fc_velocity_time_of_change(&at, friction->V_S + 0.5 * fabs(at.V)),
        .tau = fc_velocity_time_of_change(&at, friction->V_S),
        .height = (falls ? fc_stribeck(friction, at.V) : friction->staticRatio) - 1.0,
    };
}

double fc_mesh_dip_layer(const FcVelocity* at, double per_path) {
    const double curvature = fabs(at->curvature);
    return fmax(sqrt(2.0 * fabs(at->V) / curvature), cbrt(6.0 / (per_path * curvature)));
}

double fc_mesh_settled_back(const FcVelocity* at) {
    return fmin(fabs(at->V / at->rate), sqrt(2.0 * fabs(at->V / at->curvature)));
}

static bool depends_on_d(const FcScene* scene) {
    return scene->at_E.model != FC_CONTACT_CONSTANT || fc_limit_follows_load(scene->friction);
}

FcSmoothness fc_mesh_smoothness(const FcScene* scene, double h) {
    const FcDrive* drive = &scene->drive;
    FcSmoothness smooth = {.rate = fc_drive_vibrates(drive) ? drive->omega : 0.0};
    if (!depends_on_d(scene)) {
        return smooth;
    }
    const double d_rate = fabs(drive->d.rate) + drive->vibration.a_d * drive->omega;
    const double by_nearness = 3.0 / fc_scene_smallest_d(scene, h);
    const double E = fc_drive_smallest_E(drive, h);
    smooth.rate += 2.0 * scene->at_E.decay * d_rate;
    smooth.follows_d_and_E = scene->floats || (d_rate > 0.0 && by_nearness > 2.0 * scene->at_E.decay) ||
                             fc_drive_largest_E(drive, h) > 100.0 * E;
    if (!smooth.follows_d_and_E) {
        smooth.rate += by_nearness * d_rate + fabs(drive->E.rate) / E;
    }
    return smooth;
}

// Time [s] from t on over which the phase, ln(sigma) or ln(g) moves by 1, at the least; g by the normal force.
static double smooth_time(const FcScene* scene, const FcSmoothness* smooth, double t) {
    if (!smooth->follows_d_and_E) {
        return 1.0 / smooth->rate;
    }
    const FcDrive* drive = &scene->drive;
    // Twice the rates at t: they rise while the panel goes on.
    const double by_nearness = 2.0 * 3.0 / fc_scene_d(scene, t);
    const double by_E = 2.0 * fc_drive_E_growth(drive, t);
    const double d_rate = fc_scene_d_rate(scene, t);
    const double floating =
        scene->floats ? 4.0 * scene->at_E.decay * fabs(d_rate - fc_drive_d_rate(drive, t)) : 0.0;
    const double rate = smooth->rate + by_nearness * fabs(d_rate) + by_E + floating;
    const double curvature = by_nearness * drive->vibration.a_d * drive->omega * drive->omega;
    return 2.0 / (rate + sqrt(rate * rate + 2.0 * curvature)); // rate x + curvature x^2 / 2 = 1
}

// At the largest separation.
double fc_mesh_largest_saturation(const FcScene* scene, double h) {
    if (scene->floats || scene->drive.E.rate != 0.0) {
        return INFINITY;
    }
    const FcContactResponse there = fc_contact_response(&scene->at_E, fc_drive_largest_d(&scene->drive, h));
    const FcFriction* friction = scene->friction;
    const double limit = fc_limit_follows_load(friction) ? friction->mu * there.F_n : scene->F_C;
    return limit * fc_stribeck(friction, 0.0) / there.sigma;
}

FcMesh fc_mesh_make(const FcScene* scene, double end, double tolerance) {
    const double saturation = fc_mesh_largest_saturation(scene, end);
    return (FcMesh){
        .scene = scene,
        .end = end,
        .force = fc_scene_force_scale(scene),
        .allowed = tolerance,
        .moving_limit = fc_limit_follows_load(scene->friction) || fc_has_stribeck_curve(scene->friction),
        .saturation = saturation,
        .beyond = saturation / fc_stribeck(scene->friction, 0.0),
        .forgotten = -2.0 * log(tolerance) * saturation,
        .speed = fc_drive_largest_speed(&scene->drive, end),
        .smooth = fc_mesh_smoothness(scene, end),
    };
}

// Decades of accuracy that a panel needs for this allowed relative error.
static int decades(double allowed) {
    return !(allowed < 0.3) ? 0 : (int)least(FINEST, 0.15 + fc_digits(allowed)); // 0 for no number too
}

// Lengths of a panel in a bell of the Stribeck curve for what may be missed of the bell, of those that resolve it.
static const double BELL[FINEST + 1] = {4, 3, 1.7, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};

// Tolerances from which on fewer stages resolve the Stribeck curve.
static const double BELL_OF_FEW_STAGES = 5e-5;

// What limits a panel.
typedef struct {
    double left;         // s, to the stretch's end
    double after, ahead; // s, distances from the events, widened by their layers
    double smooth;       // s
    double bell;         // s, that the Stribeck curve allows
    bool fine;           // the bell needs the most stages
    double layer, layer_ahead;
    bool
        starts; // with a transient: not stepped over, though it be allowed to be, since what is estimated then is far off
    bool ends_at_event;  // or within its layer
    bool seen;           // errors are, at the interval's end
    double allowed_last; // relative error of a panel that ends at the event
    int for_transient, for_lag, for_last, for_quadrature;
} Limits;

static int finest(const Limits* limits) {
    const int finer = limits->for_transient > limits->for_lag ? limits->for_transient : limits->for_lag;
    return finer > limits->for_quadrature ? finer : limits->for_quadrature;
}

static double length(const Limits* limits, int kind) {
    const double distances = DISTANCES[kind][limits->for_lag];
    double h = least(SMOOTH[kind][finest(limits)] * limits->smooth, distances * limits->after);
    h = least(h, limits->bell);
    if (limits->for_transient > 0 || limits->starts) {
        h = least(h, LAYERS[kind][limits->for_transient] * limits->layer);
    }
    const double shrink = distances / (1.0 + distances);
    if (!limits->ends_at_event) {
        return least(limits->left, least(h, shrink * limits->ahead));
    }
    double last = LAYERS[kind][limits->for_last];
    if (limits->allowed_last > 1.0) {
        const double half = 0.5 * limits->allowed_last * LAST[kind];
        last = most(last, least(STAGES[kind] * sqrt(half), half));
    }
    last *= limits->layer_ahead;
    if (limits->left <= least(h, last)) {
        return limits->left;
    }
    // Up to where the last panel may begin.
    const double graded = most(least(shrink * limits->left, limits->left - 0.95 * last), 0.35 * limits->left);
    return least(h, graded);
}

static int more(int decades_needed, int caution) {
    return decades_needed + caution < FINEST ? decades_needed + caution : FINEST;
}

static FcPlan cheapest(Limits* limits, double for_transient, double for_lag, int gone_decades, int caution) {
    const int transient = decades(for_transient) - gone_decades;
    // The curve's bell is no exponential: few stages show little of what they miss of it.
    const bool fine_bell = isfinite(limits->bell) && limits->fine;
    const int first_in_bell = fine_bell && limits->starts ? 1 : 0;
    limits->for_transient = more(transient > 0 ? transient : 0, transient > 0 ? caution + first_in_bell : 0);
    limits->for_lag = more(decades(for_lag), caution);
    limits->for_last = more(decades(limits->allowed_last), caution);
    limits->allowed_last *= caution > 0 ? pow(10.0, -caution) : 1.0;
    const bool nine = fine_bell || (limits->seen && limits->ends_at_event);
    int kind = nine || finest(limits) > 5 ? NINE_STAGES : FIVE_STAGES;
    double h = length(limits, kind);
    if (h >= limits->left) {
        if (!nine && length(limits, FIVE_STAGES) >= limits->left) {
            kind = FIVE_STAGES;
        }
    } else if (h > 0.6 * limits->left && !limits->ends_at_event) {
        h = 0.6 * limits->left;
    }
    return (FcPlan){.h = h, .stages = STAGES[kind]};
}

double fc_mesh_left_at_end(const FcMesh* mesh, const FcStretch* stretch, const FcPlace* at, double t,
                           double gone) {
    const double about = at->path - MISSED_OF_PATH * fabs(stretch->displacement);
    const double at_least_here = most(about - mesh->speed * (t - at->t), 0.0);
    if (at_least_here + stretch->path_after > mesh->forgotten) {
        return 0.0;
    }
    double relaxes = stretch->path_after / mesh->saturation;
    if (t < stretch->end) {
        const double at_least =
            fabs(fc_drive_displacement(&mesh->scene->drive, t, stretch->end)) / mesh->saturation;
        // at_least too where the others are no numbers
        relaxes += most(SURE_OF_REST * (SURE_OF_WHOLE * stretch->relaxes - gone), at_least);
    }
    return exp(-relaxes);
}

// What has relaxed since the stretch's start when a panel of that length has gone by, about.
static double gone_after(const FcStretch* stretch, const FcPlace* at, double h) {
    return at->gone + (stretch->relaxes - at->gone) * h / (stretch->end - at->t);
}

// Length [s] of a panel that begins in a bell. What it misses of the curve acts while V goes on by V_S, and lives on.
static double length_in_bell(const FcMesh* mesh, const FcStretch* stretch, const FcPlace* at,
                             const Bell* bell, double lives) {
    const double near_rounding = mesh->allowed < 1e-7 ? 0.7 : 1.0;
    double allowed = SHARE_OF_MEAN * mesh->allowed * mesh->end / (lives + bell->tau);
    const double end = at->t + bell->lasts;
    const double gone = gone_after(stretch, at, bell->lasts);
    if (fc_mesh_left_at_end(mesh, stretch, at, end, gone) > mesh->allowed * mesh->allowed) {
        allowed = least(allowed, SHARE_AT_END * mesh->allowed);
    }
    return allowed < bell->height ? BELL[decades(allowed / bell->height)] * near_rounding * bell->lasts
                                  : INFINITY;
}

FcPlan fc_mesh_plan(const FcMesh* mesh, const FcStretch* stretch, const FcPlace* at, int caution) {
    const double tiny = 1e-300;
    const double base = SHARE_OF_MEAN * mesh->allowed;
    const double rest = mesh->end - at->t;
    const double x = at->t - stretch->start;
    const double after = x + stretch->back;
    const bool known = isfinite(stretch->event);
    const double ahead = known ? stretch->event - at->t + stretch->w_b : INFINITY;
    const double smooth = smooth_time(mesh->scene, &mesh->smooth, at->t);
    // d ln(sigma / g) / dt at the most: the lag is that, times the time in which the bristle relaxes
    const bool in_bell = fc_in_bell(&stretch->bells, at->t);
    const Bell bell = in_bell ? bell_at(mesh->scene, &stretch->bells, at->t) : (Bell){.lasts = INFINITY};
    const double drift =
        most(0.0, 1.0 / smooth - mesh->scene->drive.omega) + least(bell.height, 1.0) / bell.lasts;

    // How long an error lives, and times how long the lag's panel: the larger of here and at the event ahead, whose
    // part is bounded by what |V| is there and here.
    double lives = x == 0.0 ? stretch->w_a : at->rate > 0.0 ? 1.3 / at->rate : INFINITY;
    if (known) {
        lives = least(lives, most(stretch->w_a, stretch->w_b));
    }
    double lag_counts = lives * least(after, smooth);
    if (known) {
        const double near = most(0.25 * ahead, stretch->w_b);
        const double part = stretch->w_b / near;
        const double there = stretch->w_b * (stretch->reversal ? part : part * part);
        lives = most(lives, there);
        lag_counts = most(lag_counts, there * least(smooth, near));
    }
    lives = least(lives, rest);
    lag_counts = least(lag_counts, rest * least(rest, smooth));

    const double transient = least(at->transient, 1e6);
    const double gone = 0.434 * at->gone; // negative, or no number, where the stiffness overflows
    const int gone_decades = gone > 0.0 ? (int)least(1e3, gone) : 0;
    const double last_counts = drift * least(stretch->w_b, smooth) + at->lag;
    Limits limits = {
        .left = stretch->end - at->t,
        .after = after,
        .ahead = ahead,
        .smooth = smooth,
        .bell = in_bell ? length_in_bell(mesh, stretch, at, &bell, lives) : INFINITY,
        .fine = mesh->allowed < BELL_OF_FEW_STAGES * most(1.0, mesh->scene->friction->staticRatio - 1.0),
        .layer = at->layer,
        .layer_ahead = stretch->w_b,
        .starts = at->gone == 0.0 && transient > mesh->allowed,
        // The impulse and the work of a constant force are exact, those of another as good as the quadrature.
        .for_quadrature = mesh->moving_limit ? decades(mesh->allowed) : 0,
        .ends_at_event = known && stretch->event - stretch->end <= stretch->w_b,
        .allowed_last = base * mesh->end / (stretch->w_b * last_counts + tiny),
    };
    const double of_lag = mesh->moving_limit || mesh->allowed < COARSE ? 1.0 : OF_THE_LAG;
    double for_transient = base * mesh->end / (transient * lives + tiny);
    double for_lag = of_lag * base * mesh->end / (drift * lag_counts + tiny);
    FcPlan plan = cheapest(&limits, for_transient, for_lag, gone_decades, caution);

    // A panel that gets longer by being planned for the end is nearer to it, where less fades.
    for (double judged = 0.0; plan.h > judged;) {
        judged = plan.h;
        const double fades =
            fc_mesh_left_at_end(mesh, stretch, at, at->t + plan.h, gone_after(stretch, at, plan.h));
        if (!(fades > mesh->allowed * mesh->allowed)) {
            break;
        }
        const double at_end = SHARE_AT_END * mesh->allowed / fades;
        limits.seen = fades > SEEN;
        for_transient = least(for_transient, at_end / (transient + tiny));
        for_lag = least(for_lag, of_lag * at_end / (drift * least(lives, smooth) + tiny));
        limits.allowed_last =
            least(base * mesh->end / (stretch->w_b * last_counts + tiny), at_end / (last_counts + tiny));
        plan = cheapest(&limits, for_transient, for_lag, gone_decades, caution);
    }
    if (at->t < stretch->bells.before) {
        plan.h = least(plan.h, stretch->bells.before - at->t);
    }
    plan.in_bell = in_bell;
    plan.crosses_bell = in_bell && plan.h > bell.tau;
    plan.lives = lives;
    plan.grows = smooth;
    return plan;
}
