#include "solver/integrate/closed_form.h"

#include <assert.h>
#include <float.h>

#include "model/extremes.h"
#include "model/root.h"
#include "solver/integrate/events.h"
#include "solver/panel/arithmetic.h"

// Coulomb's law in a part, in which V keeps its sign.
static void take_coulomb(FcIntegrator* integrator) {
    const double t = integrator->at.t;
    const double end = integrator->part.end;
    assert(end >= t && integrator->part.side * integrator->part.side <= 1);
    const double force = integrator->part.side * fc_coefficients_at(integrator, end).limit;
    const double work = force * fc_drive_displacement(&integrator->interval->scene->drive, t, end);
    const FcMap map = {.impulse_offset = force * (end - t), .work_offset = work, .heat_offset = work};
    fc_accept_closed_form(integrator, &map, end);
}

// ElasticPlastic without static friction surely slips while |V| is larger than |D'| may be.
static bool slips_surely(FcIntegrator* integrator) {
    const FcInterval* interval = integrator->interval;
    const FcFriction* friction = interval->scene->friction;
    if (fc_has_static_friction(friction) || friction->sigma_1 != 0.0) {
        return false;
    }
    const double fastest = interval->pace.log_sigma * interval->saturation;
    const int side = integrator->along.offset < 0.0 ? -1 : 1;
    FcDrive slower = interval->scene->drive;
    slower.V.value -= side * fastest;
    const double t = integrator->at.t;
    const double end = fc_drive_next_event(&slower, t, integrator->part.end).time;
    if (!(end > t && side * fc_drive_V(&slower, 0.5 * (t + end)) > 0.0)) {
        return false;
    }
    const FcPlaneCoefficients at = fc_coefficients_at(integrator, end);
    const double force = side * at.static_limit;
    const double delta = force / at.sigma;
    assert(side * delta >= 0.0);
    const double work = force * fc_drive_displacement(&interval->scene->drive, t, end);
    const FcMap map = {.relaxation = 1.0,
                       .offset = delta,
                       .impulse_offset = force * (end - t),
                       .work_offset = work,
                       .heat_offset = work - force * (delta - integrator->along.offset)};
    fc_note_slip(integrator, t, end, side);
    fc_accept_closed_form(integrator, &map, end);
    return true;
}

typedef struct {
    const FcDrive* drive;
    double from; // s
    double path; // m, to the bound
    int side;
} PathToBound;

static double past_bound(void* context, double t) {
    const PathToBound* of = context;
    return of->side * fc_drive_displacement(of->drive, of->from, t) - of->path;
}

// The way of a bristle that hardly moves, over its bound. Chosen: the push decides, and the way is too short to show it.
static const double LITTLE_WAY = 1e-9;

// Whether a stuck bristle meets its bound in the part; sets *end to when, and *path [m] to how far it is.
static bool meets_in_part(FcIntegrator* integrator, double* end, double* path) {
    const FcInterval* interval = integrator->interval;
    const FcDrive* drive = &interval->scene->drive;
    const double t = integrator->at.t;
    const int side = integrator->part.side;
    const FcPlaneCoefficients at = fc_coefficients_at(integrator, t);
    const double D = at.static_limit / at.sigma;
    const double moves = side * fc_drive_displacement(drive, t, *end);
    assert(*end >= t && !(D < 0.0));
    *path = fc_max(0.0, D - side * integrator->along.offset);
    if (!(integrator->bristle.is_bounded && moves > *path)) {
        return false;
    }
    // One with static friction that is at its bound and hardly moves breaks away only if it is pushed.
    if (fc_has_static_friction(interval->scene->friction) && *path <= FC_ROUNDING_OF_DEFLECTION * D &&
        moves <= LITTLE_WAY * D && fc_is_unloading(integrator, (FcVector){side, 0.0})) {
        return false;
    }
    if (*path == 0.0) {
        *end = t;
        return true;
    }
    PathToBound of = {drive, t, *path, side};
    *end = fc_root_between(past_bound, &of, t, -*path, *end, moves - *path, DBL_EPSILON * D,
                           &integrator->evaluations);
    return true;
}

static void stick_to_meeting(FcIntegrator* integrator) {
    const FcScene* scene = integrator->interval->scene;
    const FcDrive* drive = &scene->drive;
    const double t = integrator->at.t;
    const double sigma = integrator->interval->stiffness;
    double end = integrator->part.end;
    double path;
    const bool meets = meets_in_part(integrator, &end, &path);
    assert(end >= t && end <= integrator->part.end && path >= 0.0);
    const double x = meets ? integrator->part.side * path : fc_drive_displacement(drive, t, end);
    const FcMap map = {.offset = x,
                       .impulse_slope = sigma * (end - t),
                       .impulse_offset = sigma * fc_drive_displacement_integral(drive, t, end),
                       .work_slope = sigma * x,
                       .work_offset = 0.5 * sigma * x * x,
                       .drag_offset = scene->friction->sigma_1 != 0.0 ? fc_drive_square(drive, t, end) : 0.0};
    fc_accept_closed_form(integrator, &map, end);
    if (meets) {
        fc_begin_slip(integrator, true);
    }
}

// The longest path, in radii of the bound, over which the quadrature of e^-X / D over the time has no error but rounding if V is
// linear in t. Derived: of e^-4 the remainder of order 17 is 1e-16.
static const double SHORT_PATH = 4.0;

// A bristle of Dahl's law with constant sigma and g, over a part in which V is linear and keeps its sign: deflection, work and
// heat are closed forms of the path X, and delta = D + (delta_0 - D) e^(-X / D). False if the path is too long.
static bool relax_along_path(FcIntegrator* integrator) {
    const FcDrive* drive = &integrator->interval->scene->drive;
    const double t = integrator->at.t;
    const double end = integrator->part.end;
    const double sigma = integrator->interval->stiffness;
    const double D = 1.0 / integrator->at.per_path;
    assert(end >= t && !(D < 0.0));
    const double X = fc_drive_displacement(drive, t, end);
    if (fc_drive_vibrates(drive) || fabs(X) > SHORT_PATH * D) {
        return false;
    }
    const FcCoefficients mean = {.V = X, .sigma = sigma, .limit = sigma * D};
    FcMap map = fc_map_of_constant_scene(&mean, 1.0);
    const double V = fc_drive_V(drive, t);
    double FC_PAIRED less_1[FC_POINTS];
    for (int i = 0; i < FC_POINTS; i++) {
        const double x = (0.5 + FC_RADAU.node[i]) * (end - t);
        less_1[i] = fc_exp_less(-fabs(x * (V + 0.5 * drive->V.rate * x)) / D, 1.0);
    }
    const double lost = fc_dot(FC_POINTS, FC_RADAU.weight, less_1);
    map.impulse_slope = sigma * (end - t) * (1.0 + lost);
    map.impulse_offset = -integrator->part.side * sigma * D * (end - t) * lost;
    fc_accept_closed_form(integrator, &map, end);
    return true;
}

bool fc_take_closed_form(FcIntegrator* integrator) {
    const FcScene* scene = integrator->interval->scene;
    const FcFriction* friction = scene->friction;
    if (!integrator->plane->is_one_dimensional || !fc_scene_limit_is_constant(scene)) {
        return false;
    }
    const bool has_constant_coefficients = fc_scene_stiffness_is_constant(scene);
    const bool has_moving_curve = fc_has_stribeck_curve(friction) && !fc_drive_V_is_constant(&scene->drive);
    switch (fc_kind(integrator)) {
    case FC_NO_BRISTLE:
        if (!has_moving_curve) {
            take_coulomb(integrator);
        }
        return !has_moving_curve;
    case FC_SLIPS:
        return fc_may_stick(friction) && slips_surely(integrator);
    case FC_STICKS:
        if (has_constant_coefficients && integrator->bristle.state == FC_FREE) {
            stick_to_meeting(integrator);
            return true;
        }
        return false;
    default:
        return integrator->from.has_constant_coefficients && relax_along_path(integrator);
    }
}
