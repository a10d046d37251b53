#include "solver/still.h"

#include <float.h>

#include "model/extremes.h"
#include "model/root.h"
#include "solver/arithmetic.h"
#include "solver/events.h"

// Coulomb's law in a part, in which V keeps its sign.
static void take_coulomb(FcCrossing* crossing) {
    const double t = crossing->at.t;
    const double end = crossing->part.end;
    const double force = crossing->part.side * fc_coefficients_at(crossing, end).limit;
    const double work = force * fc_drive_displacement(&crossing->interval->scene->drive, t, end);
    const FcMap map = {.impulse_offset = force * (end - t), .work_offset = work, .heat_offset = work};
    fc_append_known(crossing, &map, end);
}

// ElasticPlastic without static friction surely slips while |V| is larger than |D'| may be.
static bool slips_surely(FcCrossing* crossing) {
    const FcInterval* interval = crossing->interval;
    const FcFriction* friction = interval->scene->friction;
    if (fc_has_static_friction(friction) || friction->sigma_1 != 0.0) {
        return false;
    }
    const double fastest = interval->pace.log_sigma * interval->saturation;
    const int side = crossing->along.offset < 0.0 ? -1 : 1;
    FcDrive slower = interval->scene->drive;
    slower.V.value -= side * fastest;
    const double t = crossing->at.t;
    const double end = fc_drive_next_event(&slower, t, crossing->part.end).time;
    if (!(end > t && side * fc_drive_V(&slower, 0.5 * (t + end)) > 0.0)) {
        return false;
    }
    const FcPlaneCoefficients at = fc_coefficients_at(crossing, end);
    const double force = side * at.static_limit;
    const double delta = force / at.sigma;
    const double work = force * fc_drive_displacement(&interval->scene->drive, t, end);
    const FcMap map = {.relaxation = 1.0,
                       .offset = delta,
                       .impulse_offset = force * (end - t),
                       .work_offset = work,
                       .heat_offset = work - force * (delta - crossing->along.offset)};
    fc_note_slip(crossing, t, end, side);
    fc_append_known(crossing, &map, end);
    return true;
}

typedef struct {
    const FcDrive* drive;
    double from; // s
    double way;  // m, to the bound
    int side;
} WayToBound;

static double past_bound(void* context, double t) {
    const WayToBound* of = context;
    return of->side * fc_drive_displacement(of->drive, of->from, t) - of->way;
}

// Whether a stuck bristle meets its bound in the part; sets *end to when, and *way [m] to how far it is.
static bool meets_in_part(FcCrossing* crossing, double* end, double* way) {
    const FcInterval* interval = crossing->interval;
    const FcDrive* drive = &interval->scene->drive;
    const double t = crossing->at.t;
    const int side = crossing->part.side;
    const FcPlaneCoefficients at = fc_coefficients_at(crossing, t);
    const double D = at.static_limit / at.sigma;
    const double moves = side * fc_drive_displacement(drive, t, *end);
    *way = fc_max(0.0, D - side * crossing->along.offset);
    if (!(crossing->is_bounded && moves > *way)) {
        return false;
    }
    // One with static friction that is at its bound and hardly moves breaks away only if it is pushed.
    if (fc_has_static_friction(interval->scene->friction) && *way <= 1e-13 * D && moves <= 1e-9 * D &&
        fc_falls_behind(crossing, (FcVector){side, 0.0})) {
        return false;
    }
    if (*way == 0.0) {
        *end = t;
        return true;
    }
    WayToBound of = {drive, t, *way, side};
    *end = fc_root_between(past_bound, &of, t, -*way, *end, moves - *way, DBL_EPSILON * D,
                           &crossing->evaluations);
    return true;
}

static void stick_to_meeting(FcCrossing* crossing) {
    const FcScene* scene = crossing->interval->scene;
    const FcDrive* drive = &scene->drive;
    const double t = crossing->at.t;
    const double sigma = crossing->interval->stiffness;
    double end = crossing->part.end;
    double way;
    const bool meets = meets_in_part(crossing, &end, &way);
    const double x = meets ? crossing->part.side * way : fc_drive_displacement(drive, t, end);
    const FcMap map = {.offset = x,
                       .impulse_slope = sigma * (end - t),
                       .impulse_offset = sigma * fc_drive_displacement_integral(drive, t, end),
                       .work_slope = sigma * x,
                       .work_offset = 0.5 * sigma * x * x,
                       .drag_offset = scene->friction->sigma_1 != 0.0 ? fc_drive_square(drive, t, end) : 0.0};
    fc_append_known(crossing, &map, end);
    if (meets) {
        fc_begin_slip(crossing, true);
    }
}

// The longest path, in radii of the bound, over which the quadrature of e^-X / D over the time has no error but rounding if V is
// linear in t. Derived: of e^-4 the remainder of order 17 is 1e-16.
static const double SHORT_PATH = 4.0;

// A bristle of Dahl's law with constant sigma and g, over a part in which V is linear and keeps its sign: deflection, work and
// heat are closed forms of the path X, and delta = D + (delta_0 - D) e^(-X / D). False if the path is too long.
static bool relax_along_path(FcCrossing* crossing) {
    const FcDrive* drive = &crossing->interval->scene->drive;
    const double t = crossing->at.t;
    const double end = crossing->part.end;
    const double sigma = crossing->interval->stiffness;
    const double D = 1.0 / crossing->at.per_path;
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
    map.impulse_offset = -crossing->part.side * sigma * D * (end - t) * lost;
    fc_append_known(crossing, &map, end);
    return true;
}

bool fc_take_still(FcCrossing* crossing) {
    const FcScene* scene = crossing->interval->scene;
    const FcFriction* friction = scene->friction;
    if (!crossing->plane->on_line || !fc_scene_limit_is_constant(scene)) {
        return false;
    }
    const bool is_still = fc_scene_stiffness_is_constant(scene);
    const bool has_moving_curve = fc_has_stribeck_curve(friction) && !fc_drive_V_is_constant(&scene->drive);
    switch (fc_kind(crossing)) {
    case FC_NO_BRISTLE:
        if (!has_moving_curve) {
            take_coulomb(crossing);
        }
        return !has_moving_curve;
    case FC_SLIPS:
        return friction->model == FC_ELASTIC_PLASTIC && slips_surely(crossing);
    case FC_STICKS:
        if (is_still && crossing->slips == 0) {
            stick_to_meeting(crossing);
            return true;
        }
        return false;
    default:
        return crossing->from.is_still && relax_along_path(crossing);
    }
}
