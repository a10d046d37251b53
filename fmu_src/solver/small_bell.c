#include "solver/small_bell.h"

#include <math.h>

// How far the fits below reach, and their errors.
static const double MOST_LOG_RATIO = 1.79;
static const double FIT_OF_MEAN = 3e-6;
static const double FIT_OF_DEVIATION = 2e-5;
// Of the cube of what changes in a bell: what two points miss. No error of 800 random bells came to 0.8 of its bound.
static const double THIRD_ORDER = 0.03;

// Fits of the mean and the deviation by quadrature of u^2 f and u^3 f.
FcBellShape fc_bell_shape(double staticRatio) {
    const double L = log(staticRatio);
    return (FcBellShape){
        .log_ratio = L,
        .mean = 0.8862261 + L * (0.129789 + L * (0.00494123 - L * 0.00084186)),
        .deviation = 0.4632437 + L * (0.0215802 + L * 0.0018678),
        .is_known = L <= MOST_LOG_RATIO,
    };
}

FcSmallBellPlace fc_small_bell_place(const FcScene* scene, const FcVelocity* at, double side,
                                     double fastest) {
    const FcDrive* drive = &scene->drive;
    const double tau = scene->friction->V_S / fabs(at->rate);
    const double bend = side * tau * at->curvature / at->rate;
    const double jerk = -drive->omega * drive->omega * (at->rate - drive->V.rate); // m/s4, V'''
    const double turn = tau * tau * jerk / at->rate;
    return (FcSmallBellPlace){
        .tau = tau, .bend = bend, .turn = turn, .changes = fastest * tau + fabs(bend) + sqrt(fabs(turn))};
}

FcSmallBellError fc_small_bell_error(const FcSmallBellPlace* place, const FcBellShape* shape, double V_S,
                                     double per_path, double force, double damping) {
    const double changes = place->changes;
    const double length =
        0.5 * per_path * V_S * place->tau; // 1, path in which the curve falls e-fold, over g / sigma
    const double relaxes = 2.0 * (1.0 + shape->log_ratio) * length;
    const double growth = shape->log_ratio * length;
    // of J; of where and when the bell does it; and of that, where the deflection is about the bell's path
    const double of_growth = changes * (FIT_OF_MEAN + changes * (FIT_OF_DEVIATION + THIRD_ORDER * changes)) +
                             growth * growth * growth;
    const double of_place = changes + relaxes;
    const double placed = force * of_place + length;
    return (FcSmallBellError){
        .lasts = growth * (force * of_growth + length * of_place),
        .impulse = growth * place->tau * placed,
        .work =
            growth / per_path * (force * force * (of_growth + relaxes) + (2.0 * relaxes + damping) * placed),
    };
}

FcMap fc_small_bell(const FcScene* scene, const FcBellShape* shape, const FcSmallBellPlace* place, double t,
                    double side, double sign) {
    const double V_S = scene->friction->V_S;
    const double b = place->bend;
    const double c = place->turn;
    double growth = 0.0; // 1, J
    double heat = 0.0;   // N/m, of the square of the deflection
    for (int i = 0; i < 2; i++) {
        const double u = shape->mean + (i == 0 ? -shape->deviation : shape->deviation);
        // u = x + b x^2 / 2 + c x^3 / 6, x being the time over tau
        const double x = u * (1.0 + u * (-0.5 * b + u * (0.5 * b * b - c / 6.0)));
        const double sigma = fc_scene_stiffness(scene, t + side * place->tau * x);
        const double J =
            0.25 * shape->log_ratio * V_S * place->tau * sigma / (scene->F_C * (1.0 + x * (b + 0.5 * c * x)));
        growth += J;
        heat += sigma * J;
    }
    // What the bell does is not done at the reversal but on average `late` after it, where the path is `off` from it.
    const double late = side * shape->mean * place->tau; // s
    const double off = 0.5 * side * sign * V_S * place->tau *
                       (shape->mean * shape->mean + shape->deviation * shape->deviation); // m
    const double speed = sign * shape->mean * V_S;
    return (FcMap){
        .relaxation = -growth * (1.0 + growth * (1.0 / 2 + growth * (1.0 / 6))),
        .offset = growth * off,
        .impulse_slope = -heat * late,
        .impulse_offset = -heat * late * off,
        .work_slope = -heat * off,
        .work_offset = -heat * off * off,
        .drag_slope = speed * growth,
        .drag_offset = speed * growth * off,
        .heat_square = -heat,
        .heat_slope = -2.0 * heat * off,
        .heat_offset = -heat * off * off,
    };
}
