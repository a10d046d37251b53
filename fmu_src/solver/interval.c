#include "solver/interval.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

// E or the load that moves by more than this factor is followed along the interval (FcPace.is_local). By hand: less costs
// panels, more trusts estimates that are too small.
static const double MOVES_FAR = 4.0;

double fc_digits(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return -0.30103 * ((int)(bits >> 52 & 0x7ff) - 1023); // log10(2) times the exponent
}

static FcPace pace_of(const FcScene* scene, double h) {
    const FcDrive* drive = &scene->drive;
    FcPace pace = {.phase = drive->omega};
    if (!fc_scene_depends_on_d(scene)) {
        return pace;
    }
    const double d_rate = fabs(drive->d.rate) + drive->vibration.a_d * drive->omega;
    const double by_decay = 2.0 * scene->at_E.decay;
    const double by_nearness = 3.0 / fc_scene_smallest_d(scene, h);
    const double E = fc_drive_smallest_E(drive, h);
    const double load = fmin(drive->load.value, fc_drive_load(drive, h));
    const bool load_moves_far = fmax(drive->load.value, fc_drive_load(drive, h)) > MOVES_FAR * load;
    pace.is_local = (d_rate > 0.0 && by_nearness > by_decay) ||
                    fc_drive_largest_E(drive, h) > MOVES_FAR * E || (scene->floats && load_moves_far);
    pace.log_sigma = by_decay * d_rate;
    if (!pace.is_local) {
        const double by_E = fabs(drive->E.rate) / E;
        // ln F_n moves with ln E by less than 2, and surfaces that float by that and the load over the decay.
        const double floating =
            scene->floats ? (2.0 * by_E + fabs(drive->load.rate) / load) / scene->at_E.decay : 0.0;
        pace.log_sigma += by_nearness * d_rate + by_E + (by_decay + by_nearness) * floating;
    }
    return pace;
}

double fc_smooth_time(const FcInterval* interval, double t) {
    const FcPace* pace = &interval->pace;
    if (!pace->is_local) {
        return 1.0 / (pace->phase + pace->log_sigma);
    }
    const FcScene* scene = interval->scene;
    const FcDrive* drive = &scene->drive;
    // Twice the rates at t: they rise while a panel goes on.
    const double by_nearness = 2.0 * 3.0 / fc_scene_d(scene, t);
    const double by_E = 2.0 * fc_drive_E_growth(drive, t);
    const double d_rate = fc_scene_d_rate(scene, t);
    const double floating =
        scene->floats ? 4.0 * scene->at_E.decay * fabs(d_rate - fc_drive_d_rate(drive, t)) : 0.0;
    const double rate = pace->phase + pace->log_sigma + by_nearness * fabs(d_rate) + by_E + floating;
    const double curvature = by_nearness * drive->vibration.a_d * drive->omega * drive->omega;
    return fc_time_to_move(rate, curvature, 1.0);
}

FcInterval fc_interval_make(const FcScene* scene, const FcScene* beyond_peaks, double duration,
                            double tolerance) {
    assert(duration >= 0.0 && tolerance > 0.0);
    FcInterval interval = {
        .scene = scene,
        .beyond_peaks = beyond_peaks,
        .duration = duration,
        .tolerance = tolerance,
        .pace = pace_of(scene, duration),
        .force = fc_scene_force_scale(scene),
        .stiffness = fc_scene_largest_stiffness(scene, duration),
        .limit = fc_scene_smallest_limit(scene, duration),
        .saturation = fc_scene_largest_saturation(scene, duration),
        .constant_sigma = fc_scene_stiffness_is_constant(scene),
        .speed = fc_drive_largest_speed(&scene->drive, duration),
        .has_peaks = beyond_peaks != scene,
        .moving_limit = fc_limit_follows_load(scene->friction) || beyond_peaks != scene,
    };
    interval.forgotten = 2.0 * 2.302585 * fc_digits(tolerance) * interval.saturation;
    return interval;
}
