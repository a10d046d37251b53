// The slope in time of the force of a bristle that slips along a moving bound, damping included, against differences.
#include "model/derivatives.h"

#include "check.h"
#include "moving_scene.h"

static double force_on_bound(const FcScene* scene, double t, double side) {
    const FcCoefficients at = fc_scene_coefficients(scene, t);
    return fc_scene_outputs(scene, t, side * at.limit / at.sigma).F_t;
}

int main(void) {
    int slipped = 0;
    for (int k = 0; k < KINDS; k++) {
        Kind one = kind(k);
        one.friction.model = FC_ELASTIC_PLASTIC;
        const FcScene scene = moving_scene(&one.contact, &one.friction, 1.0);
        const FcCoefficients at = fc_scene_coefficients(&scene, 0.0);
        for (double side = -1.0; side < 2.0; side += 2.0) {
            const double delta = side * at.limit / at.sigma;
            if (fc_scene_slip_side(&scene, 0.0, delta) != side) {
                continue;
            }
            slipped++;
            const double tau = 1e-5 * PERIOD; // the difference's error is some (2 pi 1e-5)^2
            const double slope =
                (force_on_bound(&scene, tau, side) - force_on_bound(&scene, -tau, side)) / (2.0 * tau);
            const double size = fabs(slope) + at.limit * scene.drive.omega * 1e-3;
            CHECK_WITHIN(fc_force_rate(&scene, delta), slope, 1e-6 * size);
        }
    }
    CHECK(slipped >= KINDS / 2);
    return check_result();
}
