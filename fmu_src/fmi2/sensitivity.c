#include "fmi2/sensitivity.h"

#include <math.h>
#include <string.h>

#include "contact/settled_force.h"
#include "fmi2/log.h"
#include "model/extremes.h"
#include "model/motion.h"

const FcVariableInfo* fc_expect_variable(const FcInstance* instance, FcCall call, fmi2ValueReference vr,
                                         FcCausality causality) {
    if (vr >= fc_variables_count) {
        fc_refuse(instance, call, "value reference %u is unknown; the largest is %u", vr,
                  fc_variables_count - 1);
        return NULL;
    }
    const FcVariableInfo* info = &fc_variables[vr];
    if (info->causality != causality) {
        fc_refuse(instance, call, "%s (value reference %u) is not an %s", info->name, vr,
                  causality == FC_CAUSALITY_INPUT ? "input" : "output");
        return NULL;
    }
    return info;
}

bool fc_has_sensitivity(const FcVariableInfo* info) {
    return info->causality == FC_CAUSALITY_INPUT || info->causality == FC_CAUSALITY_INDEPENDENT ||
           (info->causality == FC_CAUSALITY_PARAMETER && info->variability == FC_VARIABILITY_TUNABLE);
}

// The contact with one variable moved. A power of two moves it without rounding.
static FcFrictionContact moved_by(const FcFrictionContact* contact, const FcVariableInfo* info,
                                  double change) {
    FcFrictionContact moved = *contact;
    *(info->causality == FC_CAUSALITY_INDEPENDENT ? &moved.state.clock.rest
                                                  : fc_variable_real(&moved.state.variables, info)) += change;
    return moved;
}

// The power of two below this part of the change of a variable with which the contact becomes another one; 0 for a
// parameter that is 0.
static double small_change(const FcFrictionContact* contact, const FcVariableInfo* info, double part) {
    const FcVariables* v = &contact->state.variables;
    const double moment = 0.1 / v->vibration.f; // s
    double scale = fc_variable_value(v, info);
    if (strcmp(info->unit, "m/s") == 0) {
        scale = v->friction.V_S;
    } else if (strcmp(info->unit, "m") == 0) {
        scale = fc_min(v->d, v->contact.R_q / v->contact.lambda);
    } else if (strcmp(info->unit, "rad") == 0) {
        scale = 1.0;
    } else if (info->offset == offsetof(FcVariables, body.F)) {
        scale = v->F_C;
    } else if (info->causality == FC_CAUSALITY_INDEPENDENT) {
        scale = moment;
    } else if (info->offset == offsetof(FcVariables, vibration.f)) {
        scale *= fc_min(1.0, moment / fabs(contact->state.clock.time));
    }
    return scale > 0.0 ? ldexp(1.0, ilogb(part * scale)) : 0.0;
}

// The part for a difference of order 2: its error is some 1e-9, by the square of the part and by rounding over it.
// Half or twice of it multiplies one of them by two or four.
static const double MOVED_PART = 3e-5;

// The deflection that inputs and parameters leave which have jumped, and one of them by `change` more.
static FcVector reached_after(const FcFrictionContact* contact, const FcVariableInfo* info, double change) {
    FcFrictionContact moved = moved_by(contact, info, change);
    const FcScene scene = fc_friction_contact_scene(&moved);
    return fc_delta(fc_friction_contact_reached(&moved, &scene));
}

// Its derivative by one variable, by a difference, since it may be the least bound on the way: to the side on which
// the bristle moves.
static FcVector reached_by(const FcFrictionContact* contact, const FcVariableInfo* info) {
    const FcVariables* now = &contact->state.variables;
    double change = small_change(contact, info, MOVED_PART);
    if (change == 0.0) {
        return (FcVector){0.0, 0.0};
    }
    FcVector near = reached_after(contact, info, change);
    if (near.x == now->delta && near.y == now->delta_y) {
        change = -change;
        if (!fc_variable_allows(info, fc_variable_value(now, info) + 2.0 * change)) {
            return (FcVector){0.0, 0.0};
        }
        near = reached_after(contact, info, change);
    }
    const FcVector here = reached_after(contact, info, 0.0);
    const FcVector far = reached_after(contact, info, 2.0 * change);
    return (FcVector){(4.0 * near.x - far.x - 3.0 * here.x) / (2.0 * change),
                      (4.0 * near.y - far.y - 3.0 * here.y) / (2.0 * change)};
}

// The scene that the outputs see: held in model exchange.
static FcScene scene_of(FcFrictionContact* contact, bool is_ode) {
    return is_ode ? fc_friction_contact_scene_moving(contact, NULL) : fc_friction_contact_scene(contact);
}

// The part for a difference of order 4 over 4 changes: its error is the fourth power of the part, and rounding over
// it. Half or twice of it multiplies one of them by two or sixteen.
static const double MOVED_PART_OF_ORDER_4 = 5e-4;

// The derivative by one variable of the rate of the bound along which the bristle slips. The variable rises, since
// it may be at its minimum.
static double bound_rate_by(const FcFrictionContact* contact, bool is_ode, const FcVariableInfo* info) {
    static const double weight[] = {-25.0, 48.0, -36.0, 16.0, -3.0};
    const double change = small_change(contact, info, MOVED_PART_OF_ORDER_4);
    double sum = 0.0;
    for (int k = 0; k < 5; k++) {
        FcFrictionContact moved = moved_by(contact, info, k * change);
        const FcScene scene = scene_of(&moved, is_ode);
        FcPlane plane;
        fc_plane_make(&plane, &scene);
        sum += weight[k] * fc_bound(&plane, FC_SLIPPING, 0.0).rate;
    }
    return change != 0.0 ? sum / (12.0 * change) : 0.0;
}

// The direction in the space of the motion: the vibration moves the velocities and the separation.
static FcDirection direction_of(const FcFrictionContact* contact, const FcVariables* along) {
    const FcVariables* v = &contact->state.variables;
    const FcVibration* of = &v->vibration;
    const FcVibration* change = &along->vibration;
    FcDrive drive = {.vibration = *of};
    drive.vibration.V_1 = 1.0; // without it there would be no phase if nothing vibrates
    fc_drive_start(&drive, contact->state.clock.time, contact->state.clock.rest);
    const double time = contact->state.clock.time + contact->state.clock.rest;
    const double turn = drive.omega * (time * change->f / of->f + along->time);
    const double angle = drive.theta_0;
    const double across = angle + of->phase_2;
    const double apart = angle + of->phase_d;
    return (FcDirection){
        .V = along->V + change->V_1 * cos(angle) - of->V_1 * sin(angle) * turn,
        .d = along->d,
        .swing = change->a_d * cos(apart) - of->a_d * sin(apart) * (turn + change->phase_d),
        .a_d = change->a_d,
        .E = along->E,
        .load = along->load,
        .delta = along->delta,
        .V_y = along->V_y + change->V_2 * cos(across) - of->V_2 * sin(across) * (turn + change->phase_2),
        .delta_y = along->delta_y,
        .log_limit =
            fc_limit_follows_load(&v->friction) ? along->friction.mu / v->friction.mu : along->F_C / v->F_C,
        .log_stiffness = v->contact.model == FC_CONTACT_CONSTANT
                             ? along->contact.sigma / v->contact.sigma
                             : along->contact.stiffnessScale / v->contact.stiffnessScale,
        .staticRatio = fc_may_have_static_friction(&v->friction) ? along->friction.staticRatio : 0.0,
        .V_S = along->friction.V_S,
        .sigma_1 = along->friction.sigma_1,
        .sigma_2 = along->friction.sigma_2,
    };
}

// In four steps: the bristle to which the inputs lead; the direction of its deflection, if the bound leads it; what each
// variable moves of that place and of the rate of the bound; the derivatives of the outputs along the direction.
FcVariables fc_sensitivities(FcInstance* instance, const FcVariables* along) {
    FcFrictionContact* contact = &instance->contact;
    const bool is_ode = fc_instance_is_ode(instance);
    const FcScene scene = scene_of(contact, is_ode);
    const FcBristle bristle = fc_friction_contact_bristle(contact);
    FcBristle reached = is_ode ? bristle : fc_friction_contact_reached(contact, &scene);
    FcDirection direction = direction_of(contact, along);
    reached.state = is_ode ? bristle.state : fc_bristle_state(&scene, reached);
    const bool slips = reached.state == FC_SLIPPING;
    const bool has_jumped = reached.delta != bristle.delta || reached.delta_y != bristle.delta_y;
    const bool is_led = has_jumped || (slips && !is_ode); // by its bound, as inputs move that
    if (is_led) { // the present deflection counts by its direction alone
        const double shrinks = fc_size(reached) / fc_size(bristle);
        const FcVector n = fc_direction(fc_delta(bristle), (FcVector){1.0, 0.0});
        const double turns = shrinks * fc_across(n, (FcVector){along->delta, along->delta_y});
        direction.delta = -turns * n.y;
        direction.delta_y = turns * n.x;
    }
    for (unsigned vr = 0; vr < fc_variables_count; vr++) {
        const FcVariableInfo* info = &fc_variables[vr];
        const double change = fc_has_sensitivity(info) ? fc_variable_value(along, info) : 0.0;
        if (change != 0.0 && is_led && !fc_scene_is_separated(&scene)) {
            const FcVector moves = reached_by(contact, info);
            direction.delta += change * moves.x;
            direction.delta_y += change * moves.y;
        }
        if (change != 0.0 && slips) {
            direction.bound_rate += change * bound_rate_by(contact, is_ode, info);
        }
    }
    FcMotion motion = fc_motion_along(&scene, reached, &direction);
    if (fc_friction_contact_sticks(contact)) { // at a jump of V it would slip
        motion.force.x = direction.V == 0.0 ? along->body.F : NAN;
    }
    const FcContactResponse now = fc_scene_contact(&scene, 0.0);
    const FcContactLogSlope by = fc_contact_along(&scene, &direction);
    // Before the first step F_t_mean is F_t, and F_y_mean F_y.
    const bool mean_is_force = is_ode || instance->experiment.mode == FC_INITIALIZATION_MODE;
    return (FcVariables){
        .F_t = motion.force.x,
        .F_y = motion.force.y,
        .F_t_mean = mean_is_force ? motion.force.x : 0.0,
        .F_y_mean = mean_is_force ? motion.force.y : 0.0,
        .F_n = now.F_n != 0.0 ? now.F_n * by.F_n : 0.0,
        .sigma = now.sigma != 0.0 ? now.sigma * by.sigma : 0.0,
        .A_r = now.A_r != 0.0 ? now.A_r * by.A_r : 0.0,
        .delta = along->delta,
        .W_f = along->W_f,
        .Q_f = along->Q_f,
        .delta_y = along->delta_y,
        .der = motion.rates,
    };
}

bool fc_settled_sensitivities(const FcFrictionContact* contact, FcVariables along, FcVector* derivative,
                              FcMessage* message) {
    *derivative = (FcVector){0.0, 0.0};
    for (unsigned vr = 0; vr < fc_variables_count; vr++) {
        const FcVariableInfo* info = &fc_variables[vr];
        const double change = fc_has_sensitivity(info) ? fc_variable_value(&along, info) : 0.0;
        FcVector slope = {0.0, 0.0};
        if (change != 0.0 && !fc_settled_force_slope(contact, info->offset, &slope, message)) {
            return false;
        }
        *derivative = fc_plus(*derivative, change, slope);
    }
    return true;
}
