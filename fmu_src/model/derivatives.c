#include "model/derivatives.h"

#include "model/special.h"

// a + factor b.
static FcContactLogSlope plus(FcContactLogSlope a, double factor, FcContactLogSlope b) {
    return (FcContactLogSlope){a.sigma + factor * b.sigma, a.A_r + factor * b.A_r, a.F_n + factor * b.F_n};
}

FcContactLogSlope fc_contact_along(const FcScene* scene, const FcDirection* along) {
    FcContactLogSlope change = {.sigma = along->log_stiffness};
    if (scene->is_open) {
        return change;
    }
    const FcDrive* drive = &scene->drive;
    const FcContactLogSlope by_d = fc_contact_slope_by_d(&scene->at_E, fc_scene_d(scene, 0.0));
    const FcContactLogSlope by_E = fc_contact_slope_by_E(scene->contact, drive->E.value);
    double d = along->swing;
    if (scene->contact->input == FC_CONTACT_SEPARATION) {
        d += along->d;
    } else { // d = (ln F_n(0) - ln load + ...) / decay
        const double decay = scene->at_E.decay;
        d += (by_E.F_n * along->E - along->load / drive->load.value) / decay;
        d += fc_bessel_ratio(decay * drive->vibration.a_d) * along->a_d;
    }
    change = along->E != 0.0 ? plus(change, along->E, by_E) : change;
    return d != 0.0 ? plus(change, d, by_d) : change;
}
