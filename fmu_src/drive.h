// What drives the contact over one communication step: V(t), d(t), E(t).
//
//     V(t) = V + V' t + V_1 cos(2 pi f t + theta_0)                (Eq. 24)
//     d(t) = d + d' t + a_d cos(2 pi f t + theta_0 + phase_d)      (section 3.2)
//     E(t) = E + E' t
//
// t is local: 0 at the start of the step; theta_0 is the phase of the vibration there. The rates are zero when
// the inputs are held. Local time keeps a step at 1e9 s as accurate as one at 0.
#ifndef FC_DRIVE_H
#define FC_DRIVE_H

typedef struct {
    double f;       // Hz
    double V_1;     // m/s  amplitude of the velocity
    double a_d;     // m    amplitude of the separation
    double phase_d; // rad  lead of the separation over the velocity
} Vibration;

typedef struct {
    double value; // at the start of the step
    double rate;  // per second
} LinearInput;

typedef struct {
    LinearInput V; // m/s
    LinearInput d; // m
    LinearInput E; // Pa
    Vibration vibration;
    double cos_phase_d, sin_phase_d;
    double omega;   // rad/s
    double theta_0; // rad, phase at local time 0
} Drive;

// The drive of a step that starts at the absolute time start + rest [s], rest being what rounding cut off start.
Drive drive_make(LinearInput V, LinearInput d, LinearInput E, Vibration vibration, double start, double rest);

int drive_vibrates(const Drive* drive);  // an amplitude is not zero
int drive_is_linear(const Drive* drive); // a rate is not zero
int drive_is_constant(const Drive* drive);

typedef struct {
    double V; // m/s
    double d; // m
} DriveValues;
DriveValues drive_values(const Drive* drive, double t); // both for the price of one angle

double drive_V(const Drive* drive, double t);             // m/s
double drive_d(const Drive* drive, double t);             // m
double drive_E(const Drive* drive, double t);             // Pa
double drive_V_rate(const Drive* drive, double t);        // m/s2
double drive_V_curvature(const Drive* drive, double t);   // m/s3
double drive_d_rate(const Drive* drive, double t);        // m/s
double drive_smallest_d(const Drive* drive, double h);    // lower bound of d over [0, h]
double drive_smallest_E(const Drive* drive, double h);    // lower bound of E over [0, h]
double drive_largest_E(const Drive* drive, double h);     // upper bound of E over [0, h]
double drive_largest_speed(const Drive* drive, double h); // upper bound of |V| over [0, h]

// integral of V over [t0, t1] [m], exact.
double drive_displacement(const Drive* drive, double t0, double t1);

// The first time after t, before end, at which V changes sign (a reversal) or |V| dips close to zero without doing so;
// end if there is none.
typedef struct {
    double time;  // s
    int reversal; // V changes sign here
} DriveEvent;
DriveEvent drive_next_event(const Drive* drive, double t, double end);

#endif
