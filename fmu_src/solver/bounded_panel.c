#include "solver/bounded_panel.h"

#include <math.h>

#include "solver/gauss_panel.h"

// Of the tolerance that a panel's bound may take, as the panels of an interval add up. No error of 200 000 random panels came
// to 0.4 of its bound, and 99 of 100 not to 0.02.
static const double SHARE = 0.5;

FcMotion fc_motion(const FcScene* scene, double duration, double largest_stiffness, double tolerance) {
    const FcDrive* drive = &scene->drive;
    FcMotion motion = {
        .phi_rate = 0.5 * drive->omega,
        .stiffness = largest_stiffness,
        .limit = fc_scene_smallest_limit(scene, duration),
        .allowed = SHARE * tolerance,
        .is_bounded = !scene->floats && drive->E.rate == 0.0,
    };
    if (scene->friction->sigma_1 != 0.0) {
        motion.damping = scene->friction->sigma_1 * fc_drive_largest_speed(drive, duration);
    }
    if (motion.is_bounded && !(fc_scene_stiffness_is_constant(scene) && fc_scene_limit_is_constant(scene))) {
        const double by_d = 2.0 * scene->at_E.decay + 3.0 / fc_scene_smallest_d(scene, duration); // 1/m
        motion.mu_rate = 0.5 * by_d * (fabs(drive->d.rate) + drive->vibration.a_d * drive->omega);
    }
    return motion;
}

// n nodes, and K at the most: 1, and what multiplies phi, mu, z and sqrt(z). Upper envelope of what
// cmake/fit_panel_bound.py measured.
enum { RULES = 4 };
static const struct {
    int n;
    double one, phi, mu, z, sqrt_z;
} RULE[RULES] = {
    {4, 3.30, 1.23, 1.34, 1.35, 1.03},
    {6, 3.49, 2.01, 1.80, 1.31, 2.15},
    {8, 4.55, 2.50, 1.99, 1.02, 3.41},
    {12, 10.44, 2.15, 2.48, 2.57, 0.17},
};

// x^2n
static double to_the_2n(double x, int n) {
    const double x_4 = x * x * (x * x);
    const double x_8 = x_4 * x_4;
    return n == 4 ? x_8 : n == 6 ? x_8 * x_4 : n == 8 ? x_8 * x_8 : x_8 * x_8 * x_8;
}

static double bound(const FcMotion* motion, int rule, double h, double z) {
    const double K = RULE[rule].one +
                     h * (RULE[rule].phi * motion->phi_rate + RULE[rule].mu * motion->mu_rate) +
                     RULE[rule].z * z + RULE[rule].sqrt_z * sqrt(z);
    return to_the_2n(K / (2.94 * RULE[rule].n), RULE[rule].n);
}

double fc_panel_bound(const FcMotion* motion, int n, double h, double z) {
    return bound(motion, n == 4 ? 0 : n == 6 ? 1 : n == 8 ? 2 : 3, h, z);
}

// What the bound may be: force is that of the deflection in it, of a bristle that settles at |X| / z.
static double allowed_bound(const FcMotion* motion, double X, double z, const FcTrajectories* from) {
    const double deflection = fabs(from->delta_0) + from->scale + fabs(X) / fc_most(1.0, z);
    const double force = motion->stiffness * deflection;
    // Heat goes with the square of a force beyond the limit.
    return motion->allowed / (force * fc_most(1.0, force / motion->limit) + motion->damping);
}

int fc_bounded_panel_nodes(const FcMotion* motion, double h, double X, double z, const FcTrajectories* from) {
    if (!motion->is_bounded || z > FC_MOST_BOUNDED) {
        return 0;
    }
    const double allowed = allowed_bound(motion, X, z, from);
    for (int rule = 0; rule < RULES; rule++) {
        if (bound(motion, rule, h, z) <= allowed) {
            return RULE[rule].n;
        }
    }
    return 0;
}

bool fc_bounded_panel(const FcScene* scene, const FcMotion* motion, double t, double h, double X, double z,
                      const FcTrajectories* from, FcPanel* panel, double* evaluations) {
    const int n = fc_bounded_panel_nodes(motion, h, X, z, from);
    if (n == 0) {
        return false;
    }
    fc_gauss_panel_unjudged(scene, t, h, n, from, panel);
    *evaluations += n;
    // The displacement is known; a bristle that forgets little would sum up what its quadrature misses.
    panel->map.offset += (1.0 - panel->map.relaxation) * (X - panel->displacement);
    return panel->z <= z || fc_panel_bound(motion, n, h, panel->z) <= allowed_bound(motion, X, z, from);
}
