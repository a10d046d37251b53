// One vibrating contact: its variables, its state, and how it advances. What FMI sees of the physics, with
// model/derivatives.h.
//
// FcVariables carries every variable of modelDescription.xml under its own name: contact.R_q is the C expression
// contact.R_q. The table that FMI uses is generated from the XML and finds them by offsetof.
#ifndef FC_FRICTION_CONTACT_H
#define FC_FRICTION_CONTACT_H

#include <stdbool.h>

#include "message.h"
#include "model/regime.h"
#include "model/scene.h"
#include "solver/jump.h"

// The values that modelDescription.xml gives them.
typedef enum { FC_STATE_GIVEN = 1, FC_STATE_SETTLED = 2 } FcInitialState;

typedef struct {
    double V;         // m/s  input
    double d;         // m    input
    double E;         // Pa   input
    double load;      // N    input
    double F_t;       // N    output
    double F_t_mean;  // N    output
    double F_n;       // N    output
    double W_f;       // J    output
    double Q_f;       // J    output
    double sigma;     // N/m  output
    double A_r;       // m2   output
    double delta;     // m    output, the state
    FcStateRates der; //      of delta, W_f, Q_f and delta_y
    double delta_0;   // m
    double F_C;       // N
    int initialState; // FcInitialState
    FcFriction friction;
    FcContactParameters contact;
    FcVibration vibration;
    struct {
        int method;         // FcMethod
        double tolerance;   // 1
        double stepSize;    // s
        double evaluations; // 1, evaluations of the coefficients of the bristle's equation since the start
    } solver;
    double F_t_settled; // N  output, computed when asked for and kept nowhere: 0 here (settled_force.h)
    double V_y;         // m/s  input, across V
    double F_y;         // N    output
    double F_y_mean;    // N    output
    double F_y_settled; // N    output, as F_t_settled
    double delta_y;     // m    output, the state across
    double delta_y_0;   // m
} FcVariables;

typedef enum { FC_INPUT_V, FC_INPUT_D, FC_INPUT_E, FC_INPUT_LOAD, FC_INPUT_V_Y, FC_INPUT_COUNT } FcInput;

// What model exchange keeps beside the variables (hybrid.h).
typedef struct {
    int regime;                   // FcRegime
    int changed;                  // a state was changed since the event began
    double seen_time;             // s, when the inputs were seen last
    double seen[FC_INPUT_COUNT];  // they themselves
    double speed[FC_INPUT_COUNT]; // 1/s times their units: how fast they move
    double nominal_delta;         // m
    double nominal_energy;        // J
    double lag;       // m, of delta behind the bound along which the bristle slips; in the plane of |delta|
    double lag_force; // N, the bristle's force there
    double lag_heat;  // J, what Q_f lags behind by
} FcHybrid;

// Plain data: a copy of it is a saved state, and advancing from equal states gives equal bits.
typedef struct {
    FcVariables variables;
    double time;                      // s, the communication point reached
    double time_rest;                 // s, what rounding cut off when time was computed as t + h
    double W_f_rest;                  // J, what rounding cut off the sums W_f
    double Q_f_rest;                  // J, and Q_f
    double rate[FC_INPUT_COUNT];      // time derivatives of the inputs over the last step
    double next_rate[FC_INPUT_COUNT]; // the same for the next step; zero again after it
    int next_rate_set; // one of them was set since the last step, so all of them hold, also a zero
    int slips;         // the other part of the bristle's state (FcBristle); in model exchange too
    FcPast past;       // what the last step left, from which inputs and parameters may jump
    FcHybrid hybrid;
} FcFrictionState;

typedef struct {
    FcFrictionState state;
    struct FcCvode* cvode; // only when solver.method = cvode
    // The contact at the modulus and the parameters it was last computed for.
    FcContactAtModulus at_E;
    FcContactParameters at_E_of;
    double at_E_E; // Pa, 0 before the first time
} FcFrictionContact;

// Functions that return bool return true, or false with *message filled and the contact unchanged.

// After all start values and parameters are set: checks their combination, starts the state from delta_0, or where it
// settles, at time start [s], computes the outputs.
bool fc_friction_contact_initialize(FcFrictionContact* contact, double start, FcMessage* message);
// Allocates what the method (one FcMethod) needs for stepping, unless it is there. A saved state does not carry it.
bool fc_friction_contact_prepare(FcFrictionContact* contact, int method, FcMessage* message);
void fc_friction_contact_free(FcFrictionContact* contact); // frees what the two above allocated

// Advances from t to t + h [s]; refuses an h below 0 or subnormal, and an end that is no finite number. The inputs move at
// next_rate and stay where they end. With h = 0 time stands still: F_t_mean is F_t, and next_rate is used up as by any step.
bool fc_friction_contact_advance(FcFrictionContact* contact, double t, double h, FcMessage* message);

// Recomputes F_t, F_n, sigma, A_r from the state and the present inputs and parameters, whose combination it checks
// (delta, F_t_mean, W_f and Q_f are what the last step left). Call after an input or a tunable parameter changed and
// before an output is read.
bool fc_friction_contact_refresh(FcFrictionContact* contact, FcMessage* message);

// The bristle as the last step left it, and what the scene that begins now makes of it.
FcBristle fc_friction_contact_bristle(const FcFrictionContact* contact);
FcBristle fc_friction_contact_reached(const FcFrictionContact* contact, const FcScene* scene);

// The scene that begins at the present time, with the inputs moving at the rates of the last step or, where new ones
// have been set, of the next. It points into the contact.
FcScene fc_friction_contact_scene(FcFrictionContact* contact);

// The scene at the present time with the inputs moving at these rates [1/s times their units], or held where they are NULL.
FcScene fc_friction_contact_scene_moving(FcFrictionContact* contact, const double rate[FC_INPUT_COUNT]);

// Whether the present inputs and parameters go together.
bool fc_friction_contact_check(FcFrictionContact* contact, FcMessage* message);

// Recomputes the rates of the states, der, for the outputs as they are; the law of friction may be any.
bool fc_friction_contact_refresh_rates(FcFrictionContact* contact, FcMessage* message);

// The faster of the two velocities along and across, for a message: its input, and the amplitude of its vibration.
typedef struct {
    const char* name;
    double V; // m/s
    const char* vibration;
    double amplitude; // m/s
} FcFastest;
FcFastest fc_fastest(const FcDrive* drive);

// The vibration is on and a step of h [s] exceeds half a period: F_t is then a sample, F_t_mean the output to use.
bool fc_friction_contact_undersamples(const FcFrictionContact* contact, double h);

#endif
