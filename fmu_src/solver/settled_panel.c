#include "solver/settled_panel.h"

#include <math.h>

#include "model/constants.h"
#include "solver/settled_lag.h"

// Bounds are held this far below the tolerance.
static const double SHARE = 0.3;
static const double SHARE_OF_BELLS = 0.1;
// Of the force: a transient of that much is there where the bristle is told to have settled.
static const double ROUNDING = 4e-16;

// |V| [m/s].
static double speed_at_start(const FcSettledStart* from) {
    return from->at->rate * from->limit / from->sigma;
}

// Integral of x / (x + tau) over a duration [s]; the duration where x is infinite.
static double fading(double x, double duration) { return isfinite(x) ? x * log1p(duration / x) : duration; }

// Of the smaller of x and the duration: ln 2.
static const double LEAST_FADING = 0.69;

// Integral of 1 / |V| [s2/m] from the panel's start to its end, at the most but for a factor of 2: |V| grows about linearly
// from what it came from and falls so towards the reversal, whose layer is w_b wide.
static double slowness(const FcSettledStart* from, const FcVelocity* end) {
    const FcStretch* stretch = from->stretch;
    const double t = from->at->t;
    const double duration = from->end - t;
    const double after = t - stretch->start + stretch->back;
    double slow = fading(after, duration) / speed_at_start(from);
    if (stretch->event <= from->end) {
        slow += (2.0 + log1p(duration / stretch->w_b)) / fabs(end->rate);
    } else if (isfinite(stretch->event)) {
        const double ahead = stretch->event - from->end + stretch->w_b;
        slow += fading(ahead, duration) / fabs(end->V);
    }
    return slow;
}

// Error of the force at the end, over the limit: of second order in the lag.
static double error_at_end(const FcSettledStart* from, const FcVelocity* end, double drift) {
    const FcStretch* stretch = from->stretch;
    if (stretch->event <= from->end) {
        // The lag there is that of a linear V: bent, it is another by about half of V'' w / V'.
        const double lag = drift * stretch->w_b;
        const double bent = fabs(end->curvature / end->rate);
        return lag * (lag + (from->mesh->smooth.rate + bent) * stretch->w_b);
    }
    const double relaxes = from->mesh->saturation / fabs(end->V); // s
    const double after = from->end - stretch->start + stretch->back;
    const double ahead = isfinite(stretch->event) ? stretch->event - from->end : INFINITY;
    const double changes = from->mesh->smooth.rate + 1.0 / fmin(fmin(after, ahead), from->end - from->at->t);
    return drift * relaxes * relaxes * changes;
}

static bool has_bells(const FcSettledStart* from) { return from->first || from->last; }

static bool are_bells_accurate(const FcSettledStart* from) {
    const double error = (from->first ? from->first->error : 0.0) + (from->last ? from->last->error : 0.0);
    return error <= SHARE_OF_BELLS * from->mesh->allowed * from->mesh->end;
}

// What the interval's end or its mean see of the error at the end, over the limit: at a reversal it fades.
static double seen_at_end(const FcSettledStart* from, const FcVelocity* end, double drift) {
    const FcStretch* stretch = from->stretch;
    const FcMesh* mesh = from->mesh;
    const bool fades = stretch->event <= from->end;
    const double error = error_at_end(from, end, drift) + (from->last ? from->last->at_edge : 0.0);
    return error * (fades ? exp(-stretch->path_after / mesh->saturation) + stretch->w_b / mesh->end : 1.0);
}

static bool is_possible(const FcSettledStart* from) {
    const FcMesh* mesh = from->mesh;
    return !fc_limit_follows_load(mesh->scene->friction) && !mesh->smooth.follows_d_and_E &&
           isfinite(mesh->saturation) && (from->stretch->event > from->end || from->stretch->reversal);
}

// With a constant V the integral of the lag is known, and only its second order is missed.
static bool V_is_constant(const FcDrive* drive) {
    return drive->V.rate == 0.0 && drive->vibration.V_1 == 0.0;
}

// What the transient at the start may be beyond the lag there, which is behind the limit, over the Coulomb limit. Outside
// of bells it is what is left of the curve.
static double beyond_lag(const FcSettledStart* from) {
    const FcSettledBell* bell = from->first;
    const double curve = fabs(from->limit - from->scene->F_C); // N
    return bell ? (1.0 + bell->curve) * bell->lag : curve > 0.0 ? curve / from->scene->F_C : 0.0;
}

typedef enum {
    NOT_SETTLED,
    LAG_UNSEEN, // or known: the mean is the limit's
    LAG_SEEN,   // by the mean
} Settled;

// A layer at the end that is no longer than this of the span may be resolved by the poles of the lag.
static const double LONGEST_LAYER = 0.02;

// Whether it is not worth while to integrate the lag: at half of its largest the second order is too large.
static bool is_lag_too_large(const FcSettledStart* from, double drift, double allowed) {
    const FcMesh* mesh = from->mesh;
    const FcStretch* stretch = from->stretch;
    const double w_b = stretch->event <= from->end ? stretch->w_b : 0.0;
    const double rate = from->at->rate;
    const double span = from->end - from->at->t;
    return has_bells(from) || span > 0.5 * *from->too_long || w_b > LONGEST_LAYER * span ||
           0.5 * drift * (0.5 / (rate * rate) + w_b * w_b * w_b * mesh->smooth.rate) > allowed * mesh->end;
}

// What a panel that may be settled was found to go through.
typedef struct {
    double displacement;         // m
    FcVelocity at_start, at_end; // V
    FcPhase end_phase;
} Course;

// Cheap tests first: they fail on most panels.
static Settled settled(const FcSettledStart* from, Course* course) {
    const FcMesh* mesh = from->mesh;
    const FcStretch* stretch = from->stretch;
    const FcPlace* at = from->at;
    if (!(at->rate > 0.0) || !is_possible(from) || (has_bells(from) && !are_bells_accurate(from))) {
        return NOT_SETTLED;
    }
    const double allowed = SHARE * mesh->allowed;
    const FcDrive* drive = &mesh->scene->drive;
    const double drift = mesh->smooth.rate - drive->omega; // 1/s, |rho| at the most
    const double after = at->t - stretch->start + stretch->back;
    const double lag_lasts = 2.0 * drift * mesh->beyond; // m, but for what is in the error of the bells
    const bool known = V_is_constant(drive);
    const bool seen = !known && lag_lasts * LEAST_FADING * fc_least(after, from->end - at->t) >
                                    allowed * mesh->end * speed_at_start(from);
    if (seen && is_lag_too_large(from, drift, allowed)) {
        return NOT_SETTLED;
    }
    const double lag = at->lag + beyond_lag(from);
    const double allowed_changes = allowed * mesh->end * at->rate * at->rate / (lag + ROUNDING); // 1/s
    if (mesh->smooth.rate + 1.0 / after > allowed_changes) {
        return NOT_SETTLED;
    }
    const FcPhase start_phase = fc_stretch_phase(stretch, drive, at->t);
    course->at_start = fc_drive_velocity_at_phase(drive, at->t, start_phase);
    if (mesh->smooth.rate + 1.0 / fc_mesh_settled_back(&course->at_start) > allowed_changes) {
        return NOT_SETTLED;
    }
    course->end_phase = fc_stretch_phase(stretch, drive, from->end);
    course->displacement =
        fc_drive_displacement_between(drive, at->t, start_phase, from->end, course->end_phase);
    if (!(lag * exp(-fabs(course->displacement) / mesh->saturation) <= allowed * allowed)) {
        return NOT_SETTLED;
    }
    course->at_end = fc_drive_velocity_at_phase(drive, from->end, course->end_phase);
    if (!(seen_at_end(from, &course->at_end, drift) <= allowed)) {
        return NOT_SETTLED;
    }
    if (known || (!seen && lag_lasts * slowness(from, &course->at_end) <= allowed * mesh->end)) {
        return LAG_UNSEEN;
    }
    return is_lag_too_large(from, drift, allowed) ? NOT_SETTLED : LAG_SEEN;
}

// What the force lags behind the limit at the end, over the limit.
static double lag_at_end(const FcSettledStart* from, const FcCoefficients* end, double rho) {
    const FcStretch* stretch = from->stretch;
    if (stretch->event <= from->end) {
        // the layer is that of the static limit, which counts where the bristle follows the bell
        const double limit = from->last ? 1.0 : fc_stribeck(from->mesh->scene->friction, 0.0);
        return rho * stretch->w_b * 0.5 * sqrt(FC_PI / limit);
    }
    return rho / -fc_coefficients_rate(end);
}

// What a bell that the panel starts in adds: to the force that stays, and to what the transient starts from.
static void add_first(const FcSettledStart* from, double force, FcPanel* panel) {
    const FcSettledBell* bell = from->first;
    FcMap* map = &panel->map;
    const double stays = force * panel->displacement; // J
    const double limit = from->sign * from->limit;
    const double followed = limit * (1.0 + bell->lag); // N, by the transient
    const double D = followed / from->sigma;
    map->impulse_offset += from->sign * bell->impulse - (followed - force) / from->at->rate;
    map->work_slope = limit;
    map->work_offset = stays + bell->work - limit * D;
    map->drag_offset = bell->drag - map->drag_slope * D;
    map->heat_slope = 2.0 * limit - followed;
    map->heat_offset = stays + bell->heat - (2.0 * limit - 0.5 * followed) * D;
}

static void add_last(const FcSettledStart* from, FcPanel* panel) {
    const FcSettledBell* bell = from->last;
    panel->map.offset *= (1.0 + bell->curve) * (1.0 + bell->lag);
    panel->map.impulse_offset += from->sign * bell->impulse;
    panel->map.work_offset += bell->work;
    panel->map.drag_offset += bell->drag;
    panel->map.heat_offset += bell->heat;
    panel->limit *= 1.0 + bell->curve;
    panel->rate /= 1.0 + bell->curve;
}

static FcCoefficients coefficients_at_end(const FcSettledStart* from, FcPhase end_phase) {
    const FcStretch* stretch = from->stretch;
    if (from->end < stretch->end || !isfinite(stretch->event)) {
        return fc_scene_coefficients_at_phase(from->scene, from->end, end_phase);
    }
    FcCoefficients end = stretch->at_end;
    end.limit = from->scene->F_C; // beyond the Stribeck curve
    return end;
}

bool fc_settled_panel(const FcSettledStart* from, FcPanel* panel, double* evaluations) {
    Course course;
    const Settled as = settled(from, &course);
    if (as == NOT_SETTLED) {
        return false;
    }
    const double X = course.displacement;
    const FcCoefficients end = coefficients_at_end(from, course.end_phase);
    const double rho = fc_scene_log_rates_at_phase(from->scene, from->end, course.end_phase).sigma;
    *evaluations += 1.0;
    const FcDrive* drive = &from->scene->drive;
    const double force = from->sign * from->scene->F_C;
    const double D = force / from->sigma;
    const double V = from->sign * speed_at_start(from);
    const double relaxes = 1.0 / from->at->rate; // s
    const double lags = D - force / end.sigma;   // m, what D goes back by: the integral of V times the lag
    FcLag lag = {0.0, 0.0};
    if (as == LAG_SEEN) {
        const FcLagSpan span = {.mesh = from->mesh,
                                .stretch = from->stretch,
                                .t = from->at->t,
                                .end = from->end,
                                .rate = from->at->rate,
                                .V_at_t = course.at_start,
                                .V_at_end = course.at_end,
                                .at_end = end,
                                .rho = rho,
                                .allowed = SHARE * from->mesh->allowed * from->mesh->end};
        if (!fc_settled_lag(&span, &lag, from->too_long, evaluations)) {
            return false;
        }
    } else if (V_is_constant(drive)) {
        lag = (FcLag){lags / V, V * (1.0 / end.sigma - 1.0 / from->sigma)};
    }
    *panel = (FcPanel){
        .z = fabs(X) / from->mesh->saturation,
        .rate = -fc_coefficients_rate(&end),
        .sigma = end.sigma,
        .limit = end.limit,
        .displacement = X,
    };
    // The transient is (delta_0 - D) e^-rt, and sigma r D = sigma V.
    panel->map = (FcMap){
        .relaxation = 1.0,
        .offset = force * (1.0 + lag_at_end(from, &end, rho)) / end.sigma,
        .impulse_slope = from->sigma * relaxes,
        .impulse_offset = force * (from->end - from->at->t - relaxes + lag.time),
        .work_slope = force,
        .work_offset = force * (X - D + lags),
        .drag_slope = -V,
        .drag_offset = V * D + force * lag.drag,
        .heat_square = 0.5 * from->sigma,
        .heat_slope = force,
        .heat_offset = force * (X - 1.5 * D + 2.0 * lags),
    };
    if (from->first) {
        add_first(from, force, panel);
    }
    if (from->last) {
        add_last(from, panel);
    }
    return true;
}
