// The stop operator by brute force in long double, the reference of the elastic-plastic law: delta follows the path and
// is cut off at the bound at the end of every small step. A step in which anything changes between sticking and
// slipping is divided by four, down to a part in 4^14; the integrals are Boole's rule. Inputs E and load held.
#ifndef FC_UNIT_STOP_OPERATOR_H
#define FC_UNIT_STOP_OPERATOR_H

#include <math.h>
#include <stdbool.h>

#include "model/scene.h"

typedef struct {
    long double delta, impulse, work, heat, drag;
    long double path;  // m, integral of |V|
    long double limit; // N, the largest
    int side;          // +1, -1: slips along the bound, 0: sticks, 2: not known yet
} StopOperator;

typedef struct {
    long double V, sigma, limit, D, D_rate, log_sigma_rate;
} StopMoment;

static inline StopMoment stop_moment(const FcScene* scene, long double t) {
    const FcDrive* drive = &scene->drive;
    const FcVibration* vibration = &drive->vibration;
    const long double theta = drive->theta_0 + (long double)drive->omega * t;
    const long double theta_d = theta + vibration->phase_d;
    const long double d = drive->d.value + drive->d.rate * t + vibration->a_d * cosl(theta_d);
    const long double d_rate = drive->d.rate - vibration->a_d * (long double)drive->omega * sinl(theta_d);
    const long double decay = scene->at_E.decay;
    const long double e = expl(-decay * d);
    StopMoment at = {.V = drive->V.value + drive->V.rate * t + vibration->V_1 * cosl(theta)};
    at.sigma = scene->at_E.stiffness_0;
    if (scene->at_E.model == FC_CONTACT_ASPERITIES) {
        at.sigma *= e * e / (d * d * d);
        at.log_sigma_rate = -(2.0L * decay + 3.0L / d) * d_rate;
    } else if (scene->at_E.model == FC_CONTACT_MINDLIN) {
        at.sigma *= e;
        at.log_sigma_rate = -decay * d_rate;
    }
    const bool load = scene->friction->limit == FC_LIMIT_LOAD;
    at.limit = load ? (long double)scene->friction->mu * scene->at_E.load_0 * e : scene->F_C;
    at.D = at.limit / at.sigma;
    at.D_rate = at.D * ((load ? -decay * d_rate : 0.0L) - at.log_sigma_rate);
    return at;
}

static inline long double stop_way(const FcScene* scene, long double a, long double b) {
    const FcDrive* drive = &scene->drive;
    const long double middle = 0.5L * (a + b);
    long double way = (drive->V.value + drive->V.rate * middle) * (b - a);
    if (drive->vibration.V_1 != 0.0) {
        const long double omega = drive->omega;
        way += 2.0L * drive->vibration.V_1 / omega * sinl(0.5L * omega * (b - a)) *
               cosl(drive->theta_0 + omega * middle);
    }
    return way;
}

// Adds Boole's rule for a step in which side does not change.
static inline void stop_add(StopOperator* stop, const StopMoment at[5], const long double delta[5], int side,
                            long double dt) {
    static const long double weight[5] = {7.0L / 90, 32.0L / 90, 12.0L / 90, 32.0L / 90, 7.0L / 90};
    // dQ = F V dt - d(sigma delta^2 / 2) + sigma' delta^2 / 2 dt
    stop->heat -= 0.5L * (at[4].sigma * delta[4] * delta[4] - at[0].sigma * delta[0] * delta[0]);
    for (int i = 0; i < 5; i++) {
        const long double w = weight[i] * dt;
        const long double F = at[i].sigma * delta[i];
        const long double delta_rate = side == 0 ? at[i].V : (long double)side * at[i].D_rate;
        stop->impulse += w * F;
        stop->work += w * F * at[i].V;
        stop->heat += w * (F * at[i].V + 0.5L * at[i].log_sigma_rate * F * delta[i]);
        stop->drag += w * delta_rate * at[i].V;
        stop->path += w * fabsl(at[i].V);
        stop->limit = fmaxl(stop->limit, at[i].limit);
    }
}

static inline void stop_step(StopOperator* stop, const FcScene* scene, long double t, long double dt,
                             int depth) {
    StopMoment at[5];
    long double delta[5] = {stop->delta};
    bool changes = false;
    int side = stop->side;
    for (int i = 0; i < 5; i++) {
        at[i] = stop_moment(scene, t + 0.25L * dt * (long double)i);
    }
    for (int i = 0; i < 4; i++) {
        const long double a = t + 0.25L * dt * (long double)i;
        const long double free = delta[i] + stop_way(scene, a, a + 0.25L * dt);
        delta[i + 1] = fmaxl(-at[i + 1].D, fminl(at[i + 1].D, free));
        const int now = free >= at[i + 1].D ? 1 : free <= -at[i + 1].D ? -1 : 0;
        changes |= now != side;
        side = now;
    }
    for (int i = 0; i < 5 && side != 0 && depth < 8; i++) {
        changes |= (long double)side * at[i].V < at[i].D_rate; // leaves the bound within the step
    }
    if (changes && depth < 14) {
        for (int i = 0; i < 4; i++) {
            stop_step(stop, scene, t + 0.25L * dt * (long double)i, 0.25L * dt, depth + 1);
        }
        return;
    }
    stop_add(stop, at, delta, side, dt);
    stop->delta = delta[4];
    stop->side = side;
}

// Over [0, h] from delta_0 in this many steps.
static inline StopOperator stop_operator(const FcScene* scene, double h, double delta_0, int steps) {
    const long double D = stop_moment(scene, 0.0L).D;
    StopOperator stop = {.delta = fmaxl(-D, fminl(D, delta_0)), .side = 2};
    for (int i = 0; i < steps; i++) {
        stop_step(&stop, scene, (long double)h * i / steps, (long double)h / steps, 0);
    }
    return stop;
}

#endif
