#include "contact/checks.h"

#include <math.h>
#include <stddef.h>

#include "model/extremes.h"
#include "solver/solver.h"

// The number of vibration periods since time 0 beyond which the phase is refused. Chosen empirically:
// neighbouring numbers of time are then 1/128 to 1/64 of a period apart. Twice the number would double this.
static const double MAX_CYCLES = 0x1p46;

// The largest factor by which E may change in a step. Chosen empirically: the tests cover it; a larger one is
// refused.
static const double MAX_CHANGE_OF_E = 10.0;

bool fc_fail_stiffness(FcMessage* message, double d, double E) {
    return fc_message_set(
        message,
        "the contact stiffness at d = %.9g m, E = %.9g Pa is beyond the largest number: check d and the "
        "parameters contact.*",
        d, E);
}

// The largest load [N] under which a vibration of the amplitude a_d [m] leaves the surfaces apart.
static double most_load(const FcContactAtModulus* at_E, double a_d) {
    return at_E->load_0 * exp(fc_contact_log_swell(at_E, a_d) - at_E->decay * a_d);
}

static bool fail_load(const FcContactAtModulus* at_E, double load, double a_d, FcMessage* message) {
    if (!(load < at_E->load_0)) {
        return fc_message_set(message,
                              "load = %.9g N presses the surfaces together: their separation must stay above "
                              "0 m, which it does up to %.9g N",
                              load, most_load(at_E, a_d));
    }
    double low = 0.0;
    double high = a_d;
    for (int i = 0; i < 60; i++) {
        const double middle = 0.5 * (low + high);
        *(load < most_load(at_E, middle) ? &low : &high) = middle;
    }
    return fc_message_set(message,
                          "vibration.a_d = %.9g m presses the surfaces together under load = %.9g N: their "
                          "separation must stay above 0 m, which it does up to %.9g m, or up to %.9g N",
                          a_d, load, low, most_load(at_E, a_d));
}

static bool fail_separation(const FcScene* scene, double h, FcMessage* message) {
    const FcDrive* drive = &scene->drive;
    const double a_d = drive->vibration.a_d;
    if (scene->contact->input == FC_CONTACT_LOAD) {
        return fail_load(&scene->at_E, fc_max(drive->load.value, fc_drive_load(drive, h)), a_d, message);
    }
    if (drive->d.rate == 0.0) {
        return fc_message_set(
            message,
            "vibration.a_d = %.9g m must be below d = %.9g m: the separation d - a_d must stay above 0 m",
            a_d, drive->d.value);
    }
    return fc_message_set(message,
                          "d moves from %.9g m to %.9g m in the step: with vibration.a_d = %.9g m the "
                          "separation must stay above 0 m",
                          drive->d.value, drive->d.value + drive->d.rate * h, a_d);
}

// Some tools send 0 for an input that is not connected.
static bool fail_input(FcMessage* message, const char* name, double value, const char* unit) {
    return fc_message_set(message, "%s = %.9g %s must be above 0 %s: the scene uses it%s", name, value, unit,
                          unit,
                          value == 0.0 ? "; an input that is not connected may have been sent as 0" : "");
}

bool fc_check_body(const FcVariables* v, const double rate[FC_INPUT_COUNT], FcMessage* message) {
    if (v->body.m == 0.0) {
        return true;
    }
    if (v->solver.method > FC_METHOD_CVODE) {
        return fc_message_set(
            message, "body.m = %.9g kg with solver.method = %d: a mass needs collocation (1) or cvode (2)",
            v->body.m, v->solver.method);
    }
    const struct {
        const char* name;
        double value;
        const char* unit;
    } across[] = {{"V_y", v->V_y, "m/s"},
                  {"the derivative of V_y", rate[FC_INPUT_V_Y], "m/s2"},
                  {"vibration.V_2", v->vibration.V_2, "m/s"},
                  {"delta_y_0", v->delta_y_0, "m"}};
    for (size_t i = 0; i < sizeof across / sizeof *across; i++) {
        if (across[i].value != 0.0) {
            return fc_message_set(
                message, "%s = %.9g %s must be 0 %s with body.m = %.9g kg: a mass moves along V alone",
                across[i].name, across[i].value, across[i].unit, across[i].unit, v->body.m);
        }
    }
    return true;
}

bool fc_check_inputs(const FcVariables* v, FcMessage* message) {
    if (!fc_uses_separation(&v->friction, v->contact.model)) {
        return true;
    }
    if (!(v->E > 0.0)) {
        return fail_input(message, "E", v->E, "Pa");
    }
    return v->contact.input == FC_CONTACT_LOAD || v->d > 0.0 || fail_input(message, "d", v->d, "m");
}

// At both ends of the step and in it, in this order: E, and its change; the contact's factors that E moves; whether the
// contact is open throughout, which needs no more; the smallest d; the largest stiffness; the limit.
bool fc_check_scene(const FcScene* scene, double h, FcMessage* message) {
    if (!fc_scene_depends_on_d(scene)) {
        return true;
    }
    const FcDrive* drive = &scene->drive;
    const double E = drive->E.value;
    const double end = fc_drive_E(drive, h);
    if (!(fc_min(E, end) > 0.0)) {
        return fc_message_set(message, "E moves from %.9g Pa to %.9g Pa in the step: it must stay above 0 Pa",
                              E, end);
    }
    if (fc_max(E, end) > MAX_CHANGE_OF_E * fc_min(E, end)) {
        return fc_message_set(
            message,
            "E moves from %.9g Pa to %.9g Pa in the step: it may change by at most a factor of %g, "
            "up to %.9g Pa or down to %.9g Pa",
            E, end, MAX_CHANGE_OF_E, MAX_CHANGE_OF_E * E, E / MAX_CHANGE_OF_E);
    }
    if (!isfinite(scene->at_E.area_0) || !isfinite(scene->at_E.load_0) ||
        !isfinite(scene->at_E.stiffness_0)) {
        return fc_fail_stiffness(message, drive->d.value, fc_max(E, end));
    }
    const bool by_load = scene->contact->input == FC_CONTACT_LOAD;
    const bool stays_open = scene->is_open && !scene->floats;
    if (by_load && (stays_open || !(fc_max(drive->load.value, fc_drive_load(drive, h)) > 0.0))) {
        return true; // open throughout
    }
    const double d = fc_scene_smallest_d(scene, h);
    if (!(d > 0.0)) {
        return fail_separation(scene, h, message);
    }
    if (!isfinite(fc_scene_largest_stiffness(scene, h))) {
        return fc_fail_stiffness(message, d, fc_max(E, end));
    }
    if (!isfinite(fc_scene_mean_limit(scene, 0.0)) || !isfinite(fc_scene_mean_limit(scene, h))) {
        return fc_message_set(
            message,
            "friction.mu = %.9g times the normal force is beyond the largest number in the step; "
            "check d, load and contact.*",
            scene->friction->mu);
    }
    return true;
}

bool fc_scene_is_to_be_checked(const FcScene* scene) {
    return !fc_drive_is_constant(&scene->drive) || scene->contact->input == FC_CONTACT_LOAD ||
           fc_limit_follows_load(scene->friction);
}

FcFastest fc_fastest(const FcDrive* drive) {
    const FcVibration* v = &drive->vibration;
    return fabs(drive->V_y.value) + v->V_2 > fabs(drive->V.value) + v->V_1
               ? (FcFastest){"V_y", drive->V_y.value, "vibration.V_2", v->V_2}
               : (FcFastest){"V", drive->V.value, "vibration.V_1", v->V_1};
}

bool fc_fail_motion(const FcScene* scene, const FcVariables* v, FcMessage* message) {
    const FcFastest of = fc_fastest(&scene->drive);
    return fc_message_set(
        message,
        "F_t, F_y or the rate of delta, delta_y, W_f or Q_f is beyond the largest number: %s = "
        "%.9g m/s with %s = %.9g m/s, delta = %.9g m, delta_y = %.9g m",
        of.name, of.V, of.vibration, of.amplitude, v->delta, v->delta_y);
}

bool fc_check_time(const FcDrive* drive, double t, FcMessage* message) {
    const double f = drive->vibration.f;
    if (!fc_drive_vibrates(drive) || fabs(t) * f <= MAX_CYCLES) {
        return true;
    }
    return fc_message_set(
        message,
        "time = %.9g s is too large for vibration.f = %.9g Hz: beyond %.9g s its neighbouring "
        "numbers are more than 1/128 of a period apart",
        t, f, MAX_CYCLES / f);
}
