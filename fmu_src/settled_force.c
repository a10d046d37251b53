#include "settled_force.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "model/constants.h"
#include "solver/methods/method.h"

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
enum { MOST_RANGES = 20 };

// The largest scale [m/s] of a range of V, for a very soft bristle. It keeps the range below MOST_SPEED
// (friction_contact.c); half or twice of it does, too.
static const double LARGEST_SCALE_OF_V = 1e12;

// The contact at time 0 with its inputs held.
static FcFrictionContact at_time_0(const FcFrictionContact* contact) {
    FcFrictionContact held = *contact;
    FcFrictionState* state = &held.state;
    state->variables.delta = 0.0;
    state->variables.delta_y = 0.0;
    state->time = 0.0;
    state->time_rest = 0.0;
    state->slips = 0;
    memset(state->rate, 0, sizeof state->rate);
    state->next_rate_set = 0;
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
    const FcBristle start = fc_reach(&scene, (FcBristle){.delta = v->delta_0, .delta_y = v->delta_y_0});
    const double scale = fc_static_ratio(&v->friction) * fc_scene_mean_limit(&scene, 0.0);
    const FcSolverOptions options = {
        .tolerance = tolerance, .force = fmax(scale, DBL_MIN), .step_size = v->solver.stepSize};
    fc_method_settled(&scene, &options, start, force, evaluations);
    if (*evaluations > FC_MOST_EVALUATIONS) {
        return fc_message_set(message,
                              "F_t_settled, F_y_settled or a derivative of them needs more than %.0e "
                              "evaluations: vibration.a_d = %.9g m at "
                              "d = %.9g m moves the contact over too many orders of magnitude",
                              FC_MOST_EVALUATIONS, v->vibration.a_d, v->d);
    }
    return true;
}

static bool is_finite(FcVector of, const char* prefix, FcMessage* message) {
    return (isfinite(of.x) && isfinite(of.y)) ||
           fc_message_set(message, "%s%s is beyond the largest number", prefix,
                          isfinite(of.x) ? "F_y_settled" : "F_t_settled");
}

bool fc_settled_force(const FcFrictionContact* contact, FcVector* force, FcMessage* message) {
    FcFrictionContact held = at_time_0(contact);
    const FcVariables* v = &held.state.variables;
    double evaluations = 0.0;
    if (!dry_force(&held, v->solver.tolerance, force, &evaluations, message)) {
        return false;
    }
    force->x += v->friction.sigma_2 * v->V;
    force->y += v->friction.sigma_2 * v->V_y;
    return is_finite(*force, "", message);
}

static const double PART_OF_SCALE = 0.25; // for the first range

// For a velocity, along or transverse, with its amplitude.
static double first_range_of_V(const FcVariables* v, const FcScene* scene, double V, double amplitude) {
    const double speed = fabs(V);
    double scale = fmax(amplitude, speed - amplitude);
    if (amplitude == 0.0) {
        const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
        const double reach = at.limit / at.sigma * v->vibration.f; // of the bristle, in a period
        scale =
            fmax(speed, fc_drive_vibrates(&scene->drive) ? fmin(reach, LARGEST_SCALE_OF_V) : v->friction.V_S);
    }
    const double room = speed >= amplitude ? speed - amplitude : speed; // towards 0
    return copysign(PART_OF_SCALE * scale, room > PART_OF_SCALE * scale ? -V : V);
}

// The first range [the input's unit] over which the force is fitted, with its sign. It contains neither V = 0
// nor |V| = V_1, at which the force has jumps and kinks, and leads to surfaces farther apart.
static double first_range(const FcFrictionContact* held, const FcScene* scene, FcInput input) {
    const FcVariables* v = &held->state.variables;
    const double part = PART_OF_SCALE;
    switch (input) {
    case FC_INPUT_V:
        return first_range_of_V(v, scene, v->V, v->vibration.V_1);
    case FC_INPUT_V_Y:
        return first_range_of_V(v, scene, v->V_y, v->vibration.V_2);
    case FC_INPUT_D:
        return part * fmin(1.0 / scene->at_E.decay, v->d);
    case FC_INPUT_E:
        return part * v->E;
    default:
        return -part * v->load;
    }
}

// The derivative at the start of a range by the polynomial through the force at POINTS Chebyshev points, and
// the largest of its last terms. With the coefficients c_k of T_k over the range, the derivative there is 2 /
// range times the sum of (-1)^(k + 1) k^2 c_k. Half the points need a shorter range; twice as many multiply
// rounding by four.
enum { POINTS = 8 };
static bool slope_over(FcFrictionContact* held, FcInput input, double range, FcVector* slope, double* error,
                       double* evaluations, FcMessage* message) {
    double* const x = fc_input_of(&held->state.variables, input);
    const double start = *x;
    FcVector force[POINTS];
    for (int j = 0; j < POINTS; j++) {
        *x = start + 0.5 * range * (1.0 + cos(FC_PI * (j + 0.5) / POINTS));
        if (!dry_force(held, TOLERANCE_OF_FORCES, &force[j], evaluations, message)) {
            return false;
        }
    }
    *x = start;
    *slope = (FcVector){0.0, 0.0};
    *error = 0.0;
    for (int k = 1; k < POINTS; k++) {
        FcVector c = {0.0, 0.0};
        for (int j = 0; j < POINTS; j++) {
            const double at_point = cos(FC_PI * k * (j + 0.5) / POINTS);
            c.x += 2.0 / POINTS * (force[j].x - force[0].x) * at_point;
            c.y += 2.0 / POINTS * (force[j].y - force[0].y) * at_point;
        }
        const FcVector term = {2.0 * k * k * c.x / range, 2.0 * k * k * c.y / range};
        slope->x += k % 2 == 1 ? term.x : -term.x;
        slope->y += k % 2 == 1 ? term.y : -term.y;
        *error = k >= POINTS - 2 ? fmax(*error, hypot(term.x, term.y)) : 0.0;
    }
    return true;
}

// The range is shortened until the last terms are small, or rounding.
bool fc_settled_force_slope(const FcFrictionContact* contact, FcInput input, FcVector* slope,
                            FcMessage* message) {
    FcFrictionContact held = at_time_0(contact);
    if (!fc_friction_contact_refresh(&held, message)) {
        return false;
    }
    const FcScene scene = fc_friction_contact_scene(&held);
    const double force = fc_scene_mean_limit(&scene, 0.0);
    double range = first_range(&held, &scene, input);
    const double usual = force / fabs(range);
    double least = INFINITY;
    const bool is_flat =
        range == 0.0 || fc_scene_is_loose(&scene); // an input that counts for nothing, or no contact
    *slope = is_flat ? (FcVector){0.0, 0.0} : (FcVector){NAN, NAN};
    double evaluations = 0.0;
    for (int tried = 0; tried < MOST_RANGES && !is_flat; tried++) {
        FcVector found;
        double error;
        if (!slope_over(&held, input, range, &found, &error, &evaluations, message)) {
            return false;
        }
        const double size = hypot(found.x, found.y);
        if (isinf(least) || error < least * (size + usual)) {
            least = error / (size + usual);
            *slope = found;
        }
        if (error <= GOOD_OVER_SLOPE * size || error * fabs(range) <= GOOD_OVER_FORCE * force) {
            break;
        }
        range *= RANGE_SHORTENED_BY;
    }
    slope->x += input == FC_INPUT_V ? held.state.variables.friction.sigma_2 : 0.0;
    slope->y += input == FC_INPUT_V_Y ? held.state.variables.friction.sigma_2 : 0.0;
    return is_finite(*slope, "the derivative of ", message);
}
