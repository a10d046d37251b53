// A mass on a stuck bristle of constant stiffness without damping, in closed form. With phi = omega t + theta of the vibration,
//
//     m delta'' + sigma delta = F + F' t + m V' - m V_1 omega sin(phi)
//     delta = A + B t + Z sin(phi) + C cos(w t) + S sin(w t)        w^2 = sigma / m        Z = -m V_1 omega / (sigma - m omega^2)
#ifndef FC_SOLVER_BODY_BODY_STUCK_H
#define FC_SOLVER_BODY_BODY_STUCK_H

#include "solver/body/body_panel.h"

typedef struct {
    double A, B, Z, C, S;  // m, m/s, m, m, m
    double omega, ringing; // rad/s, of the vibration, and w
    FcPhase phase;         // of the vibration at the start
} FcBodyStuck;

// The motion from a time t [s] of the step on. False if it has no such form: the coefficients move, the bristle is damped, or
// the vibration is so near resonance that Z would cost digits.
bool fc_body_stuck_start(const FcPlane* plane, const FcBody* body, const FcBodyStart* at, double t,
                         FcBodyStuck* stuck);

// delta [m] after the time x [s]; *rate [m/s] is delta', and *integral [m s] that of delta over [0, x].
double fc_body_stuck_delta(const FcBodyStuck* stuck, double x, double* rate, double* integral);

// A time [s] up to `end` before which |delta| surely stays below D [m].
double fc_body_stuck_free_time(const FcBodyStuck* stuck, double D, double end);

#endif
