#include "contact/settled_force.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "model/extremes.h"
#include "model/pi.h"
#include "solver/method.h"

// The tolerance of the forces whose differences make a derivative: as fine as the solver goes
// (friction_contact.c).
static const double TOLERANCE_OF_FORCES = 1e-12;

// The largest estimated error of a derivative that is accepted, over the derivative, or over the force's
// scale and the range: a tenth of the error that the tests allow. Half of it tries more ranges; below
// TOLERANCE_OF_FORCES times 2 POINTS^2 rounding limits it.
static const double GOOD_OVER_SLOPE = 1e-9;
static const double GOOD_OVER_FORCE = 1e-10;

// The factor by which a range is shortened if it is not accurate, and the number of ranges that are tried.
// Half or twice of them changes the number of tries. The last range is 4^-19 of the first, at which rounding
// limits the derivative.
static const double RANGE_SHORTENED_BY = 0.25;
enum { MAX_RANGES = 20 };

// The largest scale [m/s] of a range of V, for a very soft bristle. It keeps the range below MAX_SPEED
// (friction_contact.c); half or twice of it does, too.
static const double LARGEST_SCALE_OF_V = 1e12;

// The contact at time 0 with its inputs held.
static FcFrictionContact at_time_0(const FcFrictionContact* contact) {
    FcFrictionContact held = *contact;
    FcFrictionState* state = &held.state;
    state->variables.delta = 0.0;
    state->variables.delta_y = 0.0;
    state->variables.V += state->variables.body.v; // at which the mass moves, as if it went on
    state->variables.body.m = 0.0;
    state->clock.time = 0.0;
    state->clock.rest = 0.0;
    state->bristle.state = FC_FREE;
    memset(state->rates.last, 0, sizeof state->rates.last);
    state->rates.next_is_set = 0;
    return held;
}

// Without viscous friction. Adds its evaluations to *evaluations.
static bool dry_force(FcFrictionContact* held, double tolerance, FcVector* force, double* evaluations,
                      FcMessage* message) {
    if (!fc_friction_contact_refresh(held, message)) {
        return false;
    }
    const FcVariables* v = &held->state.variables;
    const FcScene scene = fc_friction_contact_scene(held);
    const FcBristle start =
        fc_project_onto_bound(&scene, (FcBristle){.delta = v->delta_0, .delta_y = v->delta_y_0});
    const double scale = fc_static_ratio(&v->friction) * fc_scene_mean_limit(&scene, 0.0);
    const FcSolverOptions options = {
        .tolerance = tolerance, .force = fc_max(scale, DBL_MIN), .step_size = v->solver.stepSize};
    fc_method_settled(&scene, &options, start, force, evaluations, &held->scatters);
    if (*evaluations > FC_MAX_EVALUATIONS) {
        return fc_message_set(message,
                              "F_t_settled, F_y_settled or a derivative of them needs more than %.0e "
                              "evaluations: vibration.a_d = %.9g m at "
                              "d = %.9g m moves the contact over too many orders of magnitude, or "
                              "no period is like another",
                              FC_MAX_EVALUATIONS, v->vibration.a_d, v->d);
    }
    return true;
}

static bool is_finite(FcVector of, const char* prefix, FcMessage* message) {
    return (isfinite(of.x) && isfinite(of.y)) ||
           fc_message_set(message, "%s%s is beyond the largest number", prefix,
                          isfinite(of.x) ? "F_y_settled" : "F_t_settled");
}

bool fc_settled_force(FcFrictionContact* contact, FcVector* force, FcMessage* message) {
    FcFrictionContact held = at_time_0(contact);
    const FcVariables* v = &held.state.variables;
    double evaluations = 0.0;
    if (!dry_force(&held, v->solver.tolerance, force, &evaluations, message)) {
        return false;
    }
    contact->scatters = held.scatters;
    force->x += v->friction.sigma_2 * v->V;
    force->y += v->friction.sigma_2 * v->V_y;
    return is_finite(*force, "", message);
}

static const double PART_OF_SCALE = 0.25; // for the first range

// For a velocity, along or transverse, with its amplitude.
static double first_range_of_V(const FcVariables* v, const FcScene* scene, double V, double amplitude) {
    const double speed = fabs(V);
    double scale = fc_max(amplitude, speed - amplitude);
    if (amplitude == 0.0) {
        const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
        const double reach = at.limit / at.sigma * v->vibration.f; // of the bristle, in a period
        scale = fc_max(speed, fc_drive_vibrates(&scene->drive) ? fc_min(reach, LARGEST_SCALE_OF_V)
                                                               : v->friction.V_S);
    }
    const double room = speed >= amplitude ? speed - amplitude : speed; // towards 0
    return copysign(PART_OF_SCALE * scale, room > PART_OF_SCALE * scale ? -V : V);
}

// For an amplitude of a velocity: away from |V|, or to larger ones from 0.
static double first_range_of_amplitude(const FcVariables* v, double V, double amplitude) {
    const double speed = fabs(V);
    const double room = fabs(amplitude - speed);
    if (amplitude == 0.0) {
        return PART_OF_SCALE * (speed > 0.0 ? speed : v->friction.V_S);
    }
    return PART_OF_SCALE * (amplitude < speed ? -fc_min(room, amplitude) : amplitude);
}

// The first range [the variable's unit] over which the force is fitted, with its sign. It contains neither V = 0
// nor |V| = V_1, at which the force has jumps and kinks, and leads to surfaces farther apart, and away from the
// bounds of the variable. 0 for a variable that the mean does not depend on.
static double first_range(const FcFrictionContact* held, const FcScene* scene, size_t variable) {
    const FcVariables* v = &held->state.variables;
    const double decay = scene->at_E.decay;
    switch (variable) {
    case offsetof(FcVariables, V):
        return first_range_of_V(v, scene, v->V, v->vibration.V_1);
    case offsetof(FcVariables, V_y):
        return first_range_of_V(v, scene, v->V_y, v->vibration.V_2);
    case offsetof(FcVariables, vibration.V_1):
        return first_range_of_amplitude(v, v->V, v->vibration.V_1);
    case offsetof(FcVariables, vibration.V_2):
        return first_range_of_amplitude(v, v->V_y, v->vibration.V_2);
    case offsetof(FcVariables, d):
        return PART_OF_SCALE * fc_min(1.0 / decay, v->d);
    case offsetof(FcVariables, vibration.a_d):
        return PART_OF_SCALE * (v->vibration.a_d > 0.0 ? -fc_min(1.0 / decay, v->vibration.a_d)
                                                       : fc_min(1.0 / decay, fc_scene_d(scene, 0.0)));
    case offsetof(FcVariables, vibration.phase_d):
    case offsetof(FcVariables, vibration.phase_2):
        return PART_OF_SCALE;
    case offsetof(FcVariables, load):
        return -PART_OF_SCALE * v->load;
    case offsetof(FcVariables, body.F):
    case offsetof(FcVariables, friction.sigma_1):
    case offsetof(FcVariables, friction.sigma_2):
        return 0.0;
    default:
        return PART_OF_SCALE * *(const double*)(const void*)((const char*)v + variable);
    }
}

// The derivative at the start of a range by the polynomial through the force at POINTS Chebyshev points, the
// largest of its last terms, and the distance *missed [N] of the polynomial from the force at the start: a kink
// before the first point. With the coefficients c_k of T_k over the range, the derivative there is 2 / range times
// the sum of (-1)^(k + 1) k^2 c_k. Half the points need a shorter range; twice as many multiply rounding by four.
enum { POINTS = 8 };
static bool slope_over(FcFrictionContact* held, size_t variable, double range, FcVector* slope, double* error,
                       double* missed, double* evaluations, FcMessage* message) {
    double* const x = (double*)(void*)((char*)&held->state.variables + variable);
    const double start = *x;
    FcVector force[POINTS];
    for (int j = 0; j < POINTS; j++) {
        *x = start + 0.5 * range * (1.0 + cos(FC_PI * (j + 0.5) / POINTS));
        if (!dry_force(held, TOLERANCE_OF_FORCES, &force[j], evaluations, message)) {
            return false;
        }
    }
    *x = start;
    FcVector gap; // from the force at the start, which is no point, to the polynomial
    if (!dry_force(held, TOLERANCE_OF_FORCES, &gap, evaluations, message)) {
        return false;
    }
    for (int j = 0; j < POINTS; j++) {
        gap = fc_plus(gap, -1.0 / POINTS, force[j]);
    }
    *slope = (FcVector){0.0, 0.0};
    *error = 0.0;
    for (int k = 1; k < POINTS; k++) {
        FcVector c = {0.0, 0.0};
        for (int j = 0; j < POINTS; j++) {
            const double at_point = cos(FC_PI * k * (j + 0.5) / POINTS);
            c = fc_plus(c, 2.0 / POINTS * at_point, fc_plus(force[j], -1.0, force[0]));
        }
        const double sign = k % 2 == 1 ? 1.0 : -1.0;
        const double factor = 2.0 * k * k / range;
        *slope = fc_plus(*slope, sign * factor, c);
        gap = fc_plus(gap, sign, c);
        *error = k >= POINTS - 2 ? fc_max(*error, fabs(factor) * hypot(c.x, c.y)) : 0.0;
    }
    *missed = hypot(gap.x, gap.y);
    return true;
}

// In three steps: a first range, 0 for an input that counts for nothing; the slope over the range, which is shortened until
// the last terms are small, or rounding; the slope of the viscous force. The slope with the least error is kept.
bool fc_settled_force_slope(const FcFrictionContact* contact, size_t variable, FcVector* slope,
                            FcMessage* message) {
    FcFrictionContact held = at_time_0(contact);
    if (!fc_friction_contact_refresh(&held, message)) {
        return false;
    }
    const FcScene scene = fc_friction_contact_scene(&held);
    const double force = fc_scene_mean_limit(&scene, 0.0);
    // 0: an input that counts for nothing, or no contact.
    double range = fc_scene_is_separated(&scene) ? 0.0 : first_range(&held, &scene, variable);
    const double usual = range != 0.0 ? force / fabs(range) : 0.0;
    double least = INFINITY;
    *slope = range == 0.0 ? (FcVector){0.0, 0.0} : (FcVector){NAN, NAN};
    double evaluations = 0.0;
    for (int tried = 0; tried < MAX_RANGES && range != 0.0; tried++) {
        FcVector found;
        double error;
        double missed;
        if (!slope_over(&held, variable, range, &found, &error, &missed, &evaluations, message)) {
            return false;
        }
        if (isnan(error + missed)) { // no settled force
            break;
        }
        const double size = hypot(found.x, found.y);
        const bool is_good =
            missed <= GOOD_OVER_FORCE * force &&
            (error <= GOOD_OVER_SLOPE * size || error * fabs(range) <= GOOD_OVER_FORCE * force);
        if (is_good || isinf(least) || error < least * (size + usual)) {
            least = error / (size + usual);
            *slope = found;
        }
        if (is_good) {
            break;
        }
        range *= RANGE_SHORTENED_BY;
    }
    const FcVariables* v = &held.state.variables;
    const bool is_viscous = variable == offsetof(FcVariables, friction.sigma_2);
    slope->x += variable == offsetof(FcVariables, V) ? v->friction.sigma_2 : is_viscous ? v->V : 0.0;
    slope->y += variable == offsetof(FcVariables, V_y) ? v->friction.sigma_2 : is_viscous ? v->V_y : 0.0;
    return is_finite(*slope, "the derivative of ", message);
}
