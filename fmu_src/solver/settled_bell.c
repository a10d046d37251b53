#include "solver/settled_bell.h"

#include <math.h>

#include "model/constants.h"

// The series in the lag and in the bend of V(t) are told by their first terms up to here.
static const double MOST_LAG = 0.15;
static const double MOST_BEND = 0.3;

bool fc_may_follow_in_bell(const FcFriction* friction, const FcVelocity* at_reversal, double layer,
                           double error) {
    const double tau = friction->V_S / fabs(at_reversal->rate);
    const double follows = layer * layer / (tau * tau);
    return follows <= MOST_LAG && 3.0 * (friction->staticRatio - 1.0) * tau * follows * follows <= error;
}

FcSettledBell fc_settled_bell(const FcScene* scene, const FcVelocity* edge, double side, double sign,
                              double reach, double sigma, double drift) {
    const FcFriction* friction = scene->friction;
    const FcDrive* drive = &scene->drive;
    const double excess = friction->staticRatio - 1.0;
    const double S = friction->V_S;
    const double A = scene->F_C / sigma;          // m
    const double rate = sign * side * edge->rate; // m/s2, of |V| away from the edge
    const double per_path = 2.0 * rate / (S * S); // 1/m, 1 / l
    const double follows = (1.0 + excess) * A * per_path;
    const double tau = S / rate;                             // s
    const double bend = sign * edge->curvature * tau / rate; // 1, by how much the rate changes in tau
    const double bends_on =
        drive->omega * drive->omega * (fabs(edge->rate) + fabs(drive->V.rate)) * tau * tau / rate;
    if (!(rate > 0.0) || follows > MOST_LAG || fabs(bend) * reach > MOST_BEND ||
        bends_on * reach * reach > MOST_BEND) {
        return (FcSettledBell){.error = INFINITY};
    }
    // Integrals of w, w u, w u^2 and of w + excess w^2, the last one times u too, over u = |V| / V_S from the edge on.
    const double u = fmax(0.0, sign * edge->V / S);
    double w = 1.0;
    double w_0 = 0.5 * sqrt(FC_PI);
    double w_square = sqrt(FC_PI / 8.0);
    if (u > 0.0) {
        w = exp(-u * u);
        w_0 *= erfc(u);
        w_square *= erfc(sqrt(2.0) * u);
    }
    const double w_1 = 0.5 * w;
    const double w_2 = 0.5 * (u * w + w_0);
    const double lag_0 = w_0 + excess * w_square;
    const double lag_1 = 0.5 * w * (1.0 + 0.5 * excess * w);
    // dt = tau (1 - bend (u - u at the edge)) du
    // A moving stiffness lags in the bell by drift A / V more than beyond, from the layer at the reversal on.
    const double drifts = 2.0 * drift * tau * (1.0 - 0.5 * log(follows));
    const double limit = excess * scene->F_C;
    const double lags = side * limit * A; // J
    const double work = limit * S * tau * (w_1 - bend * (w_2 - u * w_1));
    return (FcSettledBell){
        .impulse = limit * tau * (w_0 - bend * (w_1 - u * w_0)) + 2.0 * lags / S * lag_0,
        .work = work + 2.0 * lags * lag_1,
        .heat = work + 4.0 * lags * lag_1,
        .drag = -side * excess * A * S * (u * w + w_0),
        .curve = excess * w,
        .lag = side * excess * w * A * per_path,
        .error = excess * tau *
                 (follows * (3.0 * follows + fabs(bend) + drifts) + 1.5 * bend * bend + 0.5 * bends_on),
        .at_edge = excess * w * follows * (2.0 * follows + fabs(bend) + drifts),
    };
}
