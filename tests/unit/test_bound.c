// The bound of the elastic-plastic bristle: what one evaluation gives, against the scene and against differences.
#include "solver/bound.h"

#include "check.h"
#include "moving_scene.h"

static double rate(const FcScene* scene, double t) { return fc_bound_motion(scene, t).D_rate; }

static void motion_agrees_with_the_scene(const FcScene* scene, double t) {
    const FcBoundMotion now = fc_bound_motion(scene, t);
    const FcCoefficients at = fc_scene_coefficients(scene, t);
    CHECK_NEAR(now.V, at.V, 1e-14);
    CHECK_NEAR(now.V_rate, fc_drive_V_rate(&scene->drive, t), 1e-13);
    CHECK_NEAR(now.sigma, at.sigma, 1e-13);
    CHECK_NEAR(now.limit, at.limit, 1e-13);
    CHECK_NEAR(now.D, at.limit / at.sigma, 1e-13);
    CHECK_NEAR(fc_bound(scene, t), now.D, 1e-13);
    CHECK_NEAR(now.d, fc_scene_d(scene, t), 1e-14);
    CHECK_WITHIN(now.d_rate, fc_scene_d_rate(scene, t), 1e-13 * TWO_PI * F * 1.1e-6);
    CHECK_WITHIN(now.sin_theta, sin(scene->drive.theta_0 + TWO_PI * F * t), 1e-14);
}

// A rate's differences are off by less than 1e-7 of omega times it; E' and load' change by d' once more.
static void rates_are_derivatives(const FcScene* scene, double t) {
    const double omega = TWO_PI * F;
    const FcBoundMotion now = fc_bound_motion(scene, t);
    CHECK_WITHIN(now.D_rate, slope(fc_bound, scene, t), 1e-7 * omega * now.D);
    CHECK_WITHIN(now.D_curvature, slope(rate, scene, t), 1e-6 * omega * omega * now.D);
}

static void what_stands_still_is_known(const FcScene* scene) {
    bool sigma_moves = false, limit_moves = false, D_moves = false;
    const FcBoundMotion first = fc_bound_motion(scene, 0.0);
    for (double t = 0.0; t < PERIOD; t += 0.09 * PERIOD) {
        const FcBoundMotion now = fc_bound_motion(scene, t);
        sigma_moves |= fabs(now.sigma / first.sigma - 1.0) > 1e-12;
        limit_moves |= fabs(now.limit / first.limit - 1.0) > 1e-12;
        D_moves |= fabs(now.D / first.D - 1.0) > 1e-12;
    }
    CHECK(fc_bound_stiffness_is_constant(scene) == !sigma_moves);
    CHECK(fc_bound_limit_is_constant(scene) == !limit_moves);
    CHECK(fc_bound_is_constant(scene) == !D_moves);
}

int main(void) {
    for (int k = 0; k < KINDS; k++) {
        Kind one = kind(k);
        one.friction.model = FC_ELASTIC_PLASTIC;
        for (double rates = 0.0; rates <= 1.0; rates += 1.0) {
            const FcScene scene = moving_scene(&one.contact, &one.friction, rates);
            for (double t = 0.01 * PERIOD; t < PERIOD; t += 0.09 * PERIOD) {
                motion_agrees_with_the_scene(&scene, t);
                rates_are_derivatives(&scene, t);
            }
            what_stands_still_is_known(&scene);
        }
    }
    return check_result();
}
