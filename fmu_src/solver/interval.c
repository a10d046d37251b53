#include "solver/interval.h"

#include <assert.h>
#include <float.h>
#include <math.h>

#include "model/extremes.h"

// The largest rate of ln sigma over that of ln E. Derived: 2.11 by Eq. 3. A smaller factor plans panels that are
// too long for a large change of E, a larger one panels that are too short.
static const double BY_E = 2.2;

FcPace fc_pace(const FcScene* scene, double h) {
    assert(h >= 0.0);
    const FcDrive* drive = &scene->drive;
    FcPace pace = {.phase = drive->omega};
    if (!fc_scene_depends_on_d(scene)) {
        return pace;
    }
    const double d_rate = fabs(drive->d.rate) + drive->vibration.a_d * drive->omega;
    const double by_decay = 2.0 * scene->at_E.decay;
    const double by_nearness = 3.0 / fc_scene_smallest_d(scene, h);
    const double by_E = fabs(drive->E.rate) / fc_input_min(drive->E, h);
    pace.log_sigma = (by_decay + by_nearness) * d_rate + BY_E * by_E;
    if (scene->floats) {
        // d ln F_n / d ln E is below 2. Floating surfaces move by the change of ln F_n and of ln load, over
        // the decay.
        const double load = fc_min(drive->load.value, fc_drive_load(drive, h));
        const double floating = (2.0 * by_E + fabs(drive->load.rate) / load) / scene->at_E.decay;
        pace.log_sigma += (by_decay + by_nearness) * floating;
    }
    assert(!(pace.phase < 0.0 || pace.log_sigma < 0.0));
    return pace;
}

FcInterval fc_interval_make(const FcScene* scene, double duration, const FcSolverOptions* options) {
    assert(duration >= 0.0 && options->tolerance > 0.0 && options->force >= 0.0);
    const double stiffness = fc_scene_largest_stiffness(scene, duration);
    // An error of the deflection becomes one of the force, which grows with sigma up to the step's end.
    const double grows = options->stiffness_at_end > stiffness ? options->stiffness_at_end / stiffness : 1.0;
    assert(!(stiffness < 0.0 || grows < 1.0));
    return (FcInterval){.scene = scene,
                        .duration = duration,
                        .tolerance = options->tolerance,
                        .force = options->force / grows,
                        .speed = fc_drive_largest_speed(&scene->drive, duration),
                        .stiffness = stiffness,
                        .saturation = fc_min(DBL_MAX, fc_scene_largest_saturation(scene, duration)),
                        .pace = fc_pace(scene, duration)};
}
