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
    state->time = 0.0;
    state->time_rest = 0.0;
    state->slips = 0;
    memset(state->rate, 0, sizeof state->rate);
    state->next_rate_set = 0;
    return held;
}

// The force without viscous friction. Adds its evaluations to *evaluations.
static bool dry_force(FcFrictionContact* held, double tolerance, double* force, double* evaluations,
                      FcMessage* message) {
    if (!fc_friction_contact_refresh(held, message)) {
        return false;
    }
    const FcVariables* v = &held->state.variables;
    const FcScene scene = fc_friction_contact_scene(held);
    const FcBristle start = fc_reach(&scene, (FcBristle){v->delta_0, 0});
    const double scale = fc_static_ratio(&v->friction) * fc_scene_mean_limit(&scene, 0.0);
    const FcSolverOptions options = {
        .tolerance = tolerance, .force = fmax(scale, DBL_MIN), .step_size = v->solver.stepSize};
    fc_method_settled(&scene, &options, start, force, evaluations);
    if (*evaluations > FC_MOST_EVALUATIONS) {
        return fc_message_set(
            message,
            "F_t_settled or its derivative needs more than %.0e evaluations: vibration.a_d = %.9g m at "
            "d = %.9g m moves the contact over too many orders of magnitude",
            FC_MOST_EVALUATIONS, v->vibration.a_d, v->d);
    }
    return true;
}

static bool is_finite(double number, const char* name, FcMessage* message) {
    return isfinite(number) || fc_message_set(message, "%s is beyond the largest number", name);
}

bool fc_settled_force(const FcFrictionContact* contact, double* force, FcMessage* message) {
    FcFrictionContact held = at_time_0(contact);
    const FcVariables* v = &held.state.variables;
    double dry;
    double evaluations = 0.0;
    if (!dry_force(&held, v->solver.tolerance, &dry, &evaluations, message)) {
        return false;
    }
    *force = dry + v->friction.sigma_2 * v->V;
    return is_finite(*force, "F_t_settled", message);
}

static double* input_of(FcVariables* v, FcInput input) {
    double* const inputs[FC_INPUT_COUNT] = {
        [FC_INPUT_V] = &v->V, [FC_INPUT_D] = &v->d, [FC_INPUT_E] = &v->E, [FC_INPUT_LOAD] = &v->load};
    return inputs[input];
}

// The first range [the input's unit] over which the force is fitted, with its sign. It leads to surfaces
// farther apart, and passes neither V = 0 nor |V| = V_1, at which the force has jumps and kinks.
static double first_range(const FcFrictionContact* held, const FcScene* scene, FcInput input) {
    const FcVariables* v = &held->state.variables;
    const double V_1 = v->vibration.V_1;
    const double speed = fabs(v->V);
    const double part = 0.25;
    switch (input) {
    case FC_INPUT_V: {
        double scale = fmax(V_1, speed - V_1);
        if (V_1 == 0.0) {
            const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
            const double reach = at.limit / at.sigma * v->vibration.f; // of the bristle, in a period
            scale = fmax(speed, fc_drive_vibrates(&scene->drive) ? fmin(reach, LARGEST_SCALE_OF_V)
                                                                 : v->friction.V_S);
        }
        const double room = speed >= V_1 ? speed - V_1 : speed; // towards 0
        return copysign(part * scale, room > part * scale ? -v->V : v->V);
    }
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
static bool slope_over(FcFrictionContact* held, FcInput input, double range, double* slope, double* error,
                       double* evaluations, FcMessage* message) {
    double* const x = input_of(&held->state.variables, input);
    const double start = *x;
    double force[POINTS];
    for (int j = 0; j < POINTS; j++) {
        *x = start + 0.5 * range * (1.0 + cos(FC_PI * (j + 0.5) / POINTS));
        if (!dry_force(held, TOLERANCE_OF_FORCES, &force[j], evaluations, message)) {
            return false;
        }
    }
    *x = start;
    *slope = 0.0;
    *error = 0.0;
    for (int k = 1; k < POINTS; k++) {
        double c = 0.0;
        for (int j = 0; j < POINTS; j++) {
            c += 2.0 / POINTS * (force[j] - force[0]) * cos(FC_PI * k * (j + 0.5) / POINTS);
        }
        const double term = 2.0 * k * k * c / range;
        *slope += k % 2 == 1 ? term : -term;
        *error = k >= POINTS - 2 ? fmax(*error, fabs(term)) : 0.0;
    }
    return true;
}

// The range is shortened until the last terms are small, or rounding.
bool fc_settled_force_slope(const FcFrictionContact* contact, FcInput input, double* slope,
                            FcMessage* message) {
    FcFrictionContact held = at_time_0(contact);
    if (!fc_friction_contact_refresh(&held, message)) {
        return false;
    }
    const FcScene scene = fc_friction_contact_scene(&held);
    const double force = fc_scene_mean_limit(&scene, 0.0);
    double range = first_range(&held, &scene, input);
    const double usual = force / fabs(range);
    double least = DBL_MAX;
    *slope = NAN;
    double evaluations = 0.0;
    for (int tried = 0; tried < MOST_RANGES; tried++) {
        double found;
        double error;
        if (!slope_over(&held, input, range, &found, &error, &evaluations, message)) {
            return false;
        }
        if (error < least * (fabs(found) + usual)) {
            least = error / (fabs(found) + usual);
            *slope = found;
        }
        if (error <= GOOD_OVER_SLOPE * fabs(found) || error * fabs(range) <= GOOD_OVER_FORCE * force) {
            break;
        }
        range *= RANGE_SHORTENED_BY;
    }
    *slope += input == FC_INPUT_V ? held.state.variables.friction.sigma_2 : 0.0;
    return is_finite(*slope, "the derivative of F_t_settled", message);
}
