// Time derivatives in co-simulation: of inputs, given, and of F_t and F_y. Directional derivatives of outputs
// and rates: by the inputs from initialization mode on, in model exchange by the states too. All are formulas
// except those of F_t_settled and F_y_settled (settled_force.c), and the part of the rate of a bound for a
// slipping bristle, in F_t and F_y by its damping, in der(delta), der(delta_y) and der(Q_f)
// (model/derivatives.c), and the deflection after a jump of inputs. These are central differences.
#include <math.h>

#include "fmi2/instance.h"
#include "fmi2/log.h"
#include "fmi2/variables.h"
#include "model/derivatives.h"
#include "settled_force.h"

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
        instance->contact.state.next_rate[fc_variable_input(&fc_variables[vr[i]])] = value[i];
        instance->contact.state.next_rate_set = 1;
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
        if (info->offset != offsetof(FcVariables, F_t) && info->offset != offsetof(FcVariables, F_y)) {
            return fc_refuse(instance, call, "%s has no derivative in time here: only F_t and F_y have",
                             info->name);
        }
    }
    FcMessage message;
    if (!fc_instance_refresh_outputs(instance, &message)) {
        return fc_refuse(instance, call, "the outputs can't be computed: %s", message.text);
    }
    const FcScene scene = fc_friction_contact_scene(&instance->contact);
    const FcVector rate = fc_force_rate(&scene, fc_friction_contact_reached(&instance->contact, &scene));
    if (!isfinite(rate.x) || !isfinite(rate.y)) {
        return fc_refuse(instance, call, "the time derivative of %s is beyond the largest number",
                         isfinite(rate.x) ? "F_y" : "F_t");
    }
    for (size_t i = 0; i < nvr; i++) {
        value[i] = fc_variables[vr[i]].offset == offsetof(FcVariables, F_t) ? rate.x : rate.y;
    }
    return fmi2OK;
}

static double scaled(double slope, double change) {
    return slope != 0.0 && change != 0.0 ? slope * change : 0.0;
}

// The derivative of a logarithm along the direction, from its slopes by d, E and load.
static double log_along(const FcVariables* along, double by_d, double by_E, double by_load) {
    return scaled(by_d, along->d) + scaled(by_E, along->E) + scaled(by_load, along->load);
}

// The part of their sizes by which inputs are moved for a difference: its error is some 1e-9, by the square of the
// part and by rounding over it. Half or twice of it multiplies one of them by two or four.
static const double MOVED_PART = 3e-5;

// The deflection that inputs leave which have jumped, and by `change` of the direction more.
static FcVector reached_after(FcFrictionContact moved, FcVariables along, double change) {
    for (int input = 0; input < FC_INPUT_COUNT; input++) {
        *fc_input_of(&moved.state.variables, (FcInput)input) += change * *fc_input_of(&along, (FcInput)input);
    }
    const FcScene scene = fc_friction_contact_scene(&moved);
    const FcBristle end = fc_friction_contact_reached(&moved, &scene);
    return (FcVector){end.delta, end.delta_y};
}

// Its derivative along the direction, by a difference, since it may be the least bound on the way: a central one, or
// one to the side on which the bristle moves, if it does not on the other.
static FcVector reached_along(const FcFrictionContact* contact, FcVariables along) {
    FcVariables now = contact->state.variables;
    double part = 0.0;
    for (int input = 0; input < FC_INPUT_COUNT; input++) {
        const bool is_velocity = input == FC_INPUT_V || input == FC_INPUT_V_Y;
        const double size = is_velocity ? now.friction.V_S : *fc_input_of(&now, (FcInput)input);
        part = size > 0.0 ? fmax(part, fabs(*fc_input_of(&along, (FcInput)input)) / size) : part;
    }
    if (part == 0.0) {
        return (FcVector){0.0, 0.0};
    }
    double change = MOVED_PART / part;
    FcVector before = reached_after(*contact, along, -change);
    FcVector after = reached_after(*contact, along, change);
    const bool moves_before = before.x != now.delta || before.y != now.delta_y;
    if (moves_before && (after.x != now.delta || after.y != now.delta_y)) {
        return (FcVector){(after.x - before.x) / (2.0 * change), (after.y - before.y) / (2.0 * change)};
    }
    const FcVector here = reached_after(*contact, along, 0.0);
    change = moves_before ? -change : change;
    const FcVector near = moves_before ? before : after;
    const FcVector far = reached_after(*contact, along, 2.0 * change);
    return (FcVector){(4.0 * near.x - far.x - 3.0 * here.x) / (2.0 * change),
                      (4.0 * near.y - far.y - 3.0 * here.y) / (2.0 * change)};
}

// All derivatives along a direction of inputs and states, at the places of the variables; those of F_t_settled and
// F_y_settled stay 0. So do those of outputs that do not depend on the present inputs.
static FcVariables derivatives_along(FcInstance* instance, const FcVariables* along) {
    FcFrictionContact* contact = &instance->contact;
    const bool hybrid = fc_instance_is_hybrid(instance);
    const FcScene scene =
        hybrid ? fc_friction_contact_scene_moving(contact, NULL) : fc_friction_contact_scene(contact);
    const FcBristle bristle = fc_friction_contact_bristle(contact);
    const FcBristle reached = hybrid ? bristle : fc_friction_contact_reached(contact, &scene);
    FcDirection direction = {.V = along->V,
                             .d = along->d,
                             .E = along->E,
                             .load = along->load,
                             .delta = along->delta,
                             .V_y = along->V_y,
                             .delta_y = along->delta_y};
    if ((reached.delta != bristle.delta || reached.delta_y != bristle.delta_y) &&
        !fc_scene_is_loose(&scene)) { // an input has jumped and moved it
        const FcVector moves = reached_along(contact, *along);
        direction.delta = moves.x;
        direction.delta_y = moves.y;
    }
    const FcRegime regime = hybrid ? (FcRegime)contact->state.hybrid.regime : fc_regime(&scene, reached);
    const FcMotion motion = fc_motion_along(&scene, regime, reached, &direction);
    const FcContactResponse now = fc_scene_contact(&scene, 0.0);
    const FcLogSlopes by = fc_log_slopes(&scene);
    // Before the first step F_t_mean is F_t, and F_y_mean F_y.
    const bool mean_is_force = hybrid || instance->experiment.mode == FC_INITIALIZATION_MODE;
    return (FcVariables){
        .F_t = motion.force.x,
        .F_y = motion.force.y,
        .F_t_mean = mean_is_force ? motion.force.x : 0.0,
        .F_y_mean = mean_is_force ? motion.force.y : 0.0,
        .F_n = scaled(now.F_n, log_along(along, by.by_d.F_n, by.by_E.F_n, by.by_load.F_n)),
        .sigma = scaled(now.sigma, log_along(along, by.by_d.sigma, by.by_E.sigma, by.by_load.sigma)),
        .A_r = scaled(now.A_r, log_along(along, by.by_d.A_r, by.by_E.A_r, by.by_load.A_r)),
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
    for (int input = 0; input < FC_INPUT_COUNT; input++) {
        const double change = *fc_input_of(&along, (FcInput)input);
        FcVector slope = {0.0, 0.0};
        if (change != 0.0 && !fc_settled_force_slope(contact, (FcInput)input, &slope, message)) {
            return false;
        }
        derivative->x += scaled(slope.x, change);
        derivative->y += scaled(slope.y, change);
    }
    return true;
}

// Reads the direction; false after logging the fault.
static bool read_direction(const FcInstance* instance, const fmi2ValueReference vr[], size_t n,
                           const fmi2Real change[], FcVariables* direction) {
    const FcCall call = FC_CALL_GET_DIRECTIONAL_DERIVATIVE;
    for (size_t k = 0; k < n; k++) {
        const bool is_state = fc_instance_is_hybrid(instance) && vr[k] < fc_variables_count &&
                              fc_variable_is_state(&fc_variables[vr[k]]);
        const FcVariableInfo* info =
            is_state ? &fc_variables[vr[k]] : expect(instance, call, vr[k], FC_CAUSALITY_INPUT);
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
    FcVariables direction = {.V = 0.0};
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
            return fc_refuse(instance, call, "the derivative of %s is beyond the largest number", info->name);
        }
    }
    for (size_t u = 0; u < nUnknown; u++) {
        dvUnknown[u] = fc_variable_value(&slopes, &fc_variables[vUnknown_ref[u]]);
    }
    return fmi2OK;
}
