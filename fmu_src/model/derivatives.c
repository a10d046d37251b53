#include "model/derivatives.h"

#include <math.h>

#include "model/regime.h"

static FcContactLogSlope times(FcContactLogSlope slope, double factor) {
    return (FcContactLogSlope){slope.sigma * factor, slope.A_r * factor, slope.F_n * factor};
}

static FcContactLogSlope plus(FcContactLogSlope a, FcContactLogSlope b) {
    return (FcContactLogSlope){a.sigma + b.sigma, a.A_r + b.A_r, a.F_n + b.F_n};
}

FcLogSlopes fc_log_slopes(const FcScene* scene) {
    if (scene->is_open) {
        return (FcLogSlopes){.by_d = {.sigma = 0.0}};
    }
    const FcDrive* drive = &scene->drive;
    const FcContactLogSlope by_d = fc_contact_slope_by_d(&scene->at_E, fc_scene_d(scene, 0.0));
    const FcContactLogSlope by_E = fc_contact_slope_by_E(scene->contact, drive->E.value);
    if (scene->contact->input == FC_CONTACT_SEPARATION) {
        return (FcLogSlopes){.by_d = by_d, .by_E = by_E};
    }
    // d = (ln F_n(0) - ln load + ...) / decay
    const double decay = scene->at_E.decay;
    return (FcLogSlopes){
        .by_E = plus(by_E, times(by_d, by_E.F_n / decay)),
        .by_load = times(by_d, -1.0 / (decay * drive->load.value)),
    };
}

// The rate of the bound with one input changed.
static double bound_rate_with(const FcScene* bound, size_t input, double value) {
    FcDrive drive = bound->drive;
    ((FcLinearInput*)(void*)((char*)&drive + input))->value = value;
    const FcContactAtModulus at_E = fc_contact_at_modulus(bound->contact, drive.E.value);
    const FcScene moved = fc_scene_make(bound->contact, &at_E, bound->friction, bound->F_C, &drive);
    return fc_bound_in_plane(&moved, 0.0).rate;
}

double fc_bound_rate_slope(const FcScene* bound, size_t input) {
    const double value = ((const FcLinearInput*)(const void*)((const char*)&bound->drive + input))->value;
    const bool is_velocity = input == offsetof(FcDrive, V) || input == offsetof(FcDrive, V_y);
    const double change = 1e-5 * (is_velocity ? bound->friction->V_S : value);
    return (bound_rate_with(bound, input, value + change) - bound_rate_with(bound, input, value - change)) /
           (2.0 * change);
}
