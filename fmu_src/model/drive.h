// The motion of the contact over one communication step: V(t), d(t) or load(t), E(t).
//
//     V(t) = V + V' t + V_1 cos(2 pi f t + theta_0)                (Eq. 24)
//     d(t) = d + d' t + a_d cos(2 pi f t + theta_0 + phase_d)      (section 3.2)
//     E(t) = E + E' t              load(t) = load + load' t
//     V_y(t) = V_y + V_y' t + V_2 cos(2 pi f t + theta_0 + phase_2), transverse to V, in the plane of the contact
//
// t is local: 0 at the start of the step; theta_0 is the phase of the vibration there. The rates are zero
// when the inputs are held. Local time keeps a step at 1e9 s as accurate as one at 0.
#ifndef FC_MODEL_DRIVE_H
#define FC_MODEL_DRIVE_H

#include <assert.h>
#include <math.h>
#include <stdbool.h>

typedef struct {
    double f;       // Hz
    double V_1;     // m/s  amplitude of the velocity
    double a_d;     // m    amplitude of the separation
    double phase_d; // rad  lead of the separation over the velocity
    double V_2;     // m/s  amplitude of the velocity across
    double phase_2; // rad  lead of the velocity across over that along
} FcVibration;

typedef struct {
    double value; // at the start of the step
    double rate;  // per second
} FcLinearInput;

// An input after t [s], with one rounding. If an input falls by decades, the rounding of the product would
// be many times the rest.
double fc_input_after(FcLinearInput input, double t);

// Bounds of an input over [0, h].
double fc_input_min(FcLinearInput input, double h);
double fc_input_max(FcLinearInput input, double h);

typedef struct {
    FcLinearInput V;    // m/s
    FcLinearInput d;    // m
    FcLinearInput E;    // Pa
    FcLinearInput load; // N
    FcLinearInput V_y;  // m/s
    FcVibration vibration;
    double cos_phase_d, sin_phase_d;
    double cos_phase_2, sin_phase_2;
    double omega;   // rad/s
    double theta_0; // rad, phase at local time 0
} FcDrive;

// Starts a drive whose inputs and vibration are set, in place: a step begins at the absolute time start + rest [s]; rest is
// the part that rounding cut off start.
void fc_drive_start(FcDrive* drive, double start, double rest);

// The same drive with its local time starting at t [s]; with vibration, t a whole number of periods.
FcDrive fc_drive_later(const FcDrive* drive, double t);

bool fc_drive_vibrates(const FcDrive* drive);  // an amplitude is not zero
bool fc_drive_is_linear(const FcDrive* drive); // a rate is not zero
bool fc_drive_is_constant(const FcDrive* drive);
bool fc_drive_is_planar(const FcDrive* drive); // it moves across
bool fc_drive_V_is_constant(const FcDrive* drive);

// Sine and cosine of the vibration's angle 2 pi f t + theta_0. The sine comes first. In the other order gcc
// reads both at once as soon as sincos has written them one by one, and the processor waits.
typedef struct {
    double sine;
    double cosine;
} FcPhase;
FcPhase fc_drive_phase(const FcDrive* drive, double t);

typedef struct {
    double V; // m/s
    double d; // m
} FcDriveValues;
FcDriveValues fc_drive_values_at_phase(const FcDrive* drive, double t, FcPhase at_t);

double fc_drive_V_at_phase(const FcDrive* drive, double t, FcPhase at_t);   // m/s
double fc_drive_V_y_at_phase(const FcDrive* drive, double t, FcPhase at_t); // m/s

// The drive whose V is V_y of this one, for the functions of V below.
FcDrive fc_drive_across(const FcDrive* drive);

double fc_drive_V(const FcDrive* drive, double t);    // m/s
double fc_drive_V_y(const FcDrive* drive, double t);  // m/s
double fc_drive_d(const FcDrive* drive, double t);    // m
double fc_drive_E(const FcDrive* drive, double t);    // Pa
double fc_drive_load(const FcDrive* drive, double t); // N
double fc_drive_d_rate_at_phase(const FcDrive* drive, FcPhase at_t);
double fc_drive_largest_speed(const FcDrive* drive, double h); // upper bound of |V| over [0, h], in the plane

// The time [s] in which a quantity with this rate and curvature, neither negative, moves by change: the root
// of rate x + curvature x^2 / 2 = change; infinite if it does not move.
static inline double fc_time_to_move(double rate, double curvature, double change) {
    assert(!(rate < 0.0 || curvature < 0.0 || change < 0.0));
    if (rate == 0.0 && curvature == 0.0) {
        return INFINITY;
    }
    return 2.0 * change / (rate + sqrt(rate * rate + 2.0 * curvature * change));
}

// V and its derivatives.
typedef struct {
    double V;         // m/s
    double rate;      // m/s2
    double curvature; // m/s3
    double third;     // m/s4
} FcVelocity;
FcVelocity fc_drive_velocity(const FcDrive* drive, double t);
FcVelocity fc_drive_velocity_at_phase(const FcDrive* drive, double t, FcPhase at_t);
FcVelocity fc_drive_velocity_y_at_phase(const FcDrive* drive, double t, FcPhase at_t); // of V_y

// Time [s] in which V moves by change [m/s]: fc_time_to_move of |V'| and |V''|, or by the third derivative alone.
double fc_velocity_time_of_change(const FcVelocity* at, double change);

// integral of V over [t0, t1] [m], exact.
double fc_drive_displacement(const FcDrive* drive, double t0, double t1);

// integral of the displacement from t0 on over [t0, t1] [m s], exact.
double fc_drive_displacement_integral(const FcDrive* drive, double t0, double t1);

// integral of V^2 over [t0, t1] [m2/s], exact.
double fc_drive_square(const FcDrive* drive, double t0, double t1);

// A time at which V changes sign (a reversal) or |V| dips close to zero without a change of sign.
typedef struct {
    double time;   // s
    bool reversal; // V changes sign here
} FcDriveEvent;

// The first event after t and before end; if there is none, the time end. An event exactly at t
// does not count. At t = 0, the start of a scene, an event counts at any distance ahead. For t > 0 an event
// that is ahead by no more than the rounding of the phase or of V is t itself.
FcDriveEvent fc_drive_next_event(const FcDrive* drive, double t, double end);

#endif
