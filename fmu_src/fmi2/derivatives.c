// Time derivatives in co-simulation: of inputs, given, and of F_t and F_y. Directional derivatives of outputs
// and rates: by inputs, tunable parameters and time from initialization mode on, and then by the states too. All
// are formulas except those of F_t_settled and F_y_settled (settled_force.c), and the part of the rate of
// a bound for a slipping bristle, in F_t and F_y by its damping, in der(delta), der(delta_y) and der(Q_f), and the
// deflection after a jump. These are differences.
#include <math.h>
#include <string.h>

#include "contact/settled_force.h"
#include "fmi2/instance.h"
#include "fmi2/log.h"
#include "fmi2/variables.h"
#include "model/extremes.h"
#include "model/motion.h"

// The variable of the reference if it has the causality; otherwise NULL, after logging the reason.
static const FcVariableInfo* expect(const FcInstance* instance, FcCall call, fmi2ValueReference vr,
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

// Whether the arrays exist and name time derivatives of order 1 of variables of the causality. Logs the
// reason if not.
static bool asks_for_rates(const FcInstance* instance, FcCall call, FcCausality causality,
                           const fmi2ValueReference vr[], size_t nvr, const fmi2Integer order[],
                           const fmi2Real value[]) {
    if (nvr > 0 && (!vr || !order || !value)) {
        fc_refuse(instance, call, "vr, order or value is NULL");
        return false;
    }
    for (size_t i = 0; i < nvr; i++) {
        const FcVariableInfo* info = expect(instance, call, vr[i], causality);
        if (!info) {
            return false;
        }
        if (order[i] != 1) {
            fc_refuse(instance, call, "order = %d of %s: only order 1 is supported", order[i], info->name);
            return false;
        }
    }
    return true;
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                       const fmi2Integer order[], const fmi2Real value[]) {
    const FcCall call = FC_CALL_SET_REAL_INPUT_DERIVATIVES;
    FcInstance* instance = fc_instance_enter(c, call);
    if (!instance || !asks_for_rates(instance, call, FC_CAUSALITY_INPUT, vr, nvr, order, value)) {
        return fmi2Error;
    }
    for (size_t i = 0; i < nvr; i++) {
        const FcVariableInfo* info = &fc_variables[vr[i]];
        if (!isfinite(value[i])) {
            return fc_refuse(instance, call, "derivative of %s = %s per s is not a finite number", info->name,
                             fc_quantity_text(value[i], info->unit).text);
        }
    }
    for (size_t i = 0; i < nvr; i++) {
        instance->contact.state.rates.next[fc_variable_input(&fc_variables[vr[i]])] = value[i];
        instance->contact.state.rates.next_is_set = 1;
    }
    instance->experiment.outputs_stale |= nvr > 0;
    return fmi2OK;
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                        const fmi2Integer order[], fmi2Real value[]) {
    const FcCall call = FC_CALL_GET_REAL_OUTPUT_DERIVATIVES;
    FcInstance* instance = fc_instance_enter(c, call);
    if (!instance || !asks_for_rates(instance, call, FC_CAUSALITY_OUTPUT, vr, nvr, order, value)) {
        return fmi2Error;
    }
    for (size_t i = 0; i < nvr; i++) {
        const FcVariableInfo* info = &fc_variables[vr[i]];
        const size_t place = info->offset;
        if (place != offsetof(FcVariables, F_t) && place != offsetof(FcVariables, F_y) &&
            place != offsetof(FcVariables, body.v) && place != offsetof(FcVariables, body.x)) {
            return fc_refuse(instance, call,
                             "%s has no derivative in time here: only F_t, F_y, body.v and body.x have",
                             info->name);
        }
    }
    FcMessage message;
    if (!fc_instance_refresh_outputs(instance, &message)) {
        return fc_refuse(instance, call, "the outputs can't be computed: %s", message.text);
    }
    const FcVariables* v = &instance->contact.state.variables;
    const FcVector rate = fc_friction_contact_force_rate(&instance->contact);
    const double acceleration = v->body.m > 0.0 ? (v->body.F - v->F_t) / v->body.m : 0.0;
    const FcVariables rates = {.F_t = rate.x, .F_y = rate.y, .body = {.v = acceleration, .x = v->body.v}};
    if (!isfinite(rate.x) || !isfinite(rate.y)) {
        return fc_refuse(instance, call, "the time derivative of %s is beyond the largest number",
                         isfinite(rate.x) ? "F_y" : "F_t");
    }
    for (size_t i = 0; i < nvr; i++) {
        value[i] = fc_variable_value(&rates, &fc_variables[vr[i]]);
    }
    return fmi2OK;
}

// Whether there are derivatives by the variable in every mode: an input, a tunable parameter or time.
static bool is_known(const FcVariableInfo* info) {
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
    FcVector near = reached_after(contact, info, change);
    if (near.x == now->delta && near.y == now->delta_y) {
        change = -change;
        near = reached_after(contact, info, change);
    }
    const double end = fc_variable_value(now, info) + 2.0 * change;
    if (change == 0.0 || (change < 0.0 && !fc_variable_allows(info, end))) {
        return (FcVector){0.0, 0.0};
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

// All derivatives along a direction of inputs, parameters and states, at the places of the variables; those of
// F_t_settled and F_y_settled stay 0. So do those of outputs that do not depend on the present values.
static FcVariables derivatives_along(FcInstance* instance, const FcVariables* along) {
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
        const double change = is_known(info) ? fc_variable_value(along, info) : 0.0;
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

// The derivatives of F_t_settled and F_y_settled along the direction, which cost many periods of the
// vibration.
static bool settled_force_along(const FcFrictionContact* contact, FcVariables along, FcVector* derivative,
                                FcMessage* message) {
    *derivative = (FcVector){0.0, 0.0};
    for (unsigned vr = 0; vr < fc_variables_count; vr++) {
        const FcVariableInfo* info = &fc_variables[vr];
        const double change = is_known(info) ? fc_variable_value(&along, info) : 0.0;
        FcVector slope = {0.0, 0.0};
        if (change != 0.0 && !fc_settled_force_slope(contact, info->offset, &slope, message)) {
            return false;
        }
        *derivative = fc_plus(*derivative, change, slope);
    }
    return true;
}

// The variable by which a derivative is asked for; otherwise NULL, after logging the reason.
static const FcVariableInfo* expect_known(const FcInstance* instance, fmi2ValueReference vr) {
    const FcCall call = FC_CALL_GET_DIRECTIONAL_DERIVATIVE;
    const FcFriction* friction = &instance->contact.state.variables.friction;
    if (vr >= fc_variables_count) {
        return expect(instance, call, vr, FC_CAUSALITY_INPUT); // none
    }
    const FcVariableInfo* info = &fc_variables[vr];
    const bool is_started = instance->experiment.mode != FC_INITIALIZATION_MODE;
    if (!is_known(info) && !(is_started && fc_variable_is_state(info))) {
        fc_refuse(instance, call,
                  "%s (value reference %u) is not an input, a tunable parameter, time or, after "
                  "initialization, a state",
                  info->name, vr);
        return NULL;
    }
    if (info->offset == offsetof(FcVariables, friction.staticRatio) && fc_may_stick(friction) &&
        friction->staticRatio == 1.0) {
        fc_refuse(instance, call,
                  "%s = 1: a slipping bristle would stick at any larger ratio, so that there is no "
                  "derivative",
                  info->name);
        return NULL;
    }
    return info;
}

// Reads the direction; false after logging the fault.
static bool read_direction(const FcInstance* instance, const fmi2ValueReference vr[], size_t n,
                           const fmi2Real change[], FcVariables* direction) {
    const FcCall call = FC_CALL_GET_DIRECTIONAL_DERIVATIVE;
    for (size_t k = 0; k < n; k++) {
        const FcVariableInfo* info = expect_known(instance, vr[k]);
        if (!info) {
            return false;
        }
        if (!isfinite(change[k])) {
            fc_refuse(instance, call, "direction of %s = %s is not a finite number", info->name,
                      fc_quantity_text(change[k], info->unit).text);
            return false;
        }
        *fc_variable_real(direction, info) += change[k];
    }
    return true;
}

// Whether an output or rate has a derivative by the variable; otherwise false, after logging the reason. Means of a
// step, and a settled start, are results of many periods, which are not differentiated.
static bool has_derivative(const FcInstance* instance, const FcVariableInfo* unknown,
                           const FcVariableInfo* known) {
    const size_t place = unknown->offset;
    const bool is_mean = place == offsetof(FcVariables, F_t_mean) || place == offsetof(FcVariables, F_y_mean);
    const bool is_force = place == offsetof(FcVariables, F_t) || place == offsetof(FcVariables, F_y);
    const bool is_state = fc_variable_is_state(unknown);
    const char* reason = NULL;
    if (instance->experiment.mode == FC_INITIALIZATION_MODE) {
        const bool is_settled = instance->contact.state.variables.initialState == FC_STATE_SETTLED;
        if (is_settled && (is_mean || is_force || is_state || fc_variable_is_rate(unknown))) {
            reason = "in initialization mode with initialState = Settled; afterwards it has";
        }
    } else if (!fc_instance_is_ode(instance) && known->causality == FC_CAUSALITY_PARAMETER &&
               (is_mean || is_state)) {
        reason = "in co-simulation, since the last step left it; F_t_settled and F_y_settled have";
    }
    if (reason) {
        fc_refuse(instance, FC_CALL_GET_DIRECTIONAL_DERIVATIVE, "%s has no derivative by %s %s",
                  unknown->name, known->name, reason);
    }
    return reason == NULL;
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference vUnknown_ref[],
                                        size_t nUnknown, const fmi2ValueReference vKnown_ref[], size_t nKnown,
                                        const fmi2Real dvKnown[], fmi2Real dvUnknown[]) {
    const FcCall call = FC_CALL_GET_DIRECTIONAL_DERIVATIVE;
    FcInstance* instance = fc_instance_enter(c, call);
    if (!instance) {
        return fmi2Error;
    }
    if ((nUnknown > 0 && (!vUnknown_ref || !dvUnknown)) || (nKnown > 0 && (!vKnown_ref || !dvKnown))) {
        return fc_refuse(instance, call, "vUnknown_ref, vKnown_ref, dvKnown or dvUnknown is NULL");
    }
    FcVariables direction;
    memset(&direction, 0, sizeof direction);
    if (!read_direction(instance, vKnown_ref, nKnown, dvKnown, &direction)) {
        return fmi2Error;
    }
    bool asks_settled = false;
    for (size_t u = 0; u < nUnknown; u++) {
        const bool is_rate =
            vUnknown_ref[u] < fc_variables_count && fc_variable_is_rate(&fc_variables[vUnknown_ref[u]]);
        if (!is_rate && !expect(instance, call, vUnknown_ref[u], FC_CAUSALITY_OUTPUT)) {
            return fmi2Error;
        }
        for (size_t k = 0; k < nKnown; k++) {
            if (!has_derivative(instance, &fc_variables[vUnknown_ref[u]], &fc_variables[vKnown_ref[k]])) {
                return fmi2Error;
            }
        }
        asks_settled |= fc_variable_is_settled_force(&fc_variables[vUnknown_ref[u]]);
    }
    FcMessage message;
    FcVector of_settled = {0.0, 0.0};
    if (!fc_instance_refresh_outputs(instance, &message) ||
        (asks_settled && !settled_force_along(&instance->contact, direction, &of_settled, &message))) {
        return fc_refuse(instance, call, "the outputs can't be computed: %s", message.text);
    }
    FcVariables slopes = derivatives_along(instance, &direction);
    slopes.F_t_settled = of_settled.x;
    slopes.F_y_settled = of_settled.y;
    for (size_t u = 0; u < nUnknown; u++) {
        const FcVariableInfo* info = &fc_variables[vUnknown_ref[u]];
        if (!isfinite(fc_variable_value(&slopes, info))) {
            return fc_refuse(instance, call,
                             "the derivative of %s does not exist here, or is beyond the largest number",
                             info->name);
        }
    }
    for (size_t u = 0; u < nUnknown; u++) {
        dvUnknown[u] = fc_variable_value(&slopes, &fc_variables[vUnknown_ref[u]]);
    }
    return fmi2OK;
}
