// One vibrating contact: its variables, its state, and its steps. Together with model/motion.h it is the
// interface of the physics to FMI.
//
// FcVariables has every variable of modelDescription.xml under its own name: contact.R_q is the C expression
// contact.R_q. The table for FMI is generated from the XML and finds the variables by offsetof.
#ifndef FC_CONTACT_FRICTION_CONTACT_H
#define FC_CONTACT_FRICTION_CONTACT_H

#include <stdbool.h>

#include "message.h"
#include "model/motion.h"
#include "model/scene.h"
#include "solver/body/body_step.h"
#include "solver/input_jump.h"

// The values of modelDescription.xml.
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
        double evaluations; // 1, the work since the start, in evaluations of the coefficients
    } solver;
    double F_t_settled; // N  output, computed when it is read and not stored: 0 here (settled_force.h)
    double V_y;         // m/s  input, across V
    double F_y;         // N    output
    double F_y_mean;    // N    output
    double F_y_settled; // N    output, as F_t_settled
    double delta_y;     // m    output, the state across
    double delta_y_0;   // m
    double time;        // s, the independent variable, which FcFrictionState holds: 0 here
    struct {
        double m;   // kg, 0 without a mass
        double F;   // N    input
        double v;   // m/s  output, a state
        double x;   // m    output, a state
        double v_0; // m/s
        double x_0; // m
    } body;
} FcVariables;

typedef enum {
    FC_INPUT_V,
    FC_INPUT_D,
    FC_INPUT_E,
    FC_INPUT_LOAD,
    FC_INPUT_V_Y,
    FC_INPUT_F,
    FC_INPUT_COUNT
} FcInput;
double* fc_input_of(FcVariables* v, FcInput input);

// The state of model exchange besides the variables (ode.h).
typedef struct {
    int changed;                  // a state was changed since the event began
    int no_hole;                  // 0
    double seen_time;             // s, of the inputs that were seen last
    double seen[FC_INPUT_COUNT];  // these inputs
    double speed[FC_INPUT_COUNT]; // 1/s times their units: how fast they move
    double nominal_delta;         // m
    double nominal_energy;        // J
    double lag;       // m, of delta behind the bound along which the bristle slips; in the plane of |delta|
    double lag_force; // N, the bristle's force there
    double lag_heat;  // J, by which Q_f lags behind
} FcOdeState;

// Plain data: a copy of it is a saved state, and advancing from equal states gives equal bits.
typedef struct {
    FcVariables variables;
    struct {
        double time; // s, the communication point
        double rest; // s, the rounding error of time
    } clock;
    struct {
        double W_f, Q_f; // J
    } rest;              // the rounding errors of the sums
    struct {
        double last
            [FC_INPUT_COUNT]; // time derivatives of the inputs over the last step, 0 once an input is set again
        double next[FC_INPUT_COUNT]; // the same for the next step; 0 again after it
        int next_is_set; // one of them was set since the last step, so all of them hold, also a zero
        int no_hole;     // 0: no padding, so that equal states have equal bytes
    } rates;
    struct {
        FcPast past; // the end of the last step, from which inputs and parameters may jump
        int state;   // FcBristleState
        int no_hole; // 0
    } bristle;
    FcOdeState ode;
} FcFrictionState;

typedef struct {
    FcFrictionState state;
    struct FcCvode* cvode[2]; // without and with a body, where they are used
    // The contact at the modulus and the parameters it was last computed for.
    FcContactAtModulus at_E;
    FcContactParameters at_E_of;
    double at_E_E; // Pa, 0 before the first time
    bool scatters; // the settled state that was found last: no period of it repeats (solver/method.h)
} FcFrictionContact;

// Functions that return bool return true, or false with *message filled and the contact unchanged.

// Call after all start values and parameters are set. Checks their combination, starts the state at time
// start [s] from delta_0 or in the settled state, and computes the outputs.
bool fc_friction_contact_initialize(FcFrictionContact* contact, double start, FcMessage* message);
// Allocates the memory for stepping these variables, unless it exists. A saved state does not contain it.
bool fc_friction_contact_prepare(FcFrictionContact* contact, const FcVariables* of, FcMessage* message);
void fc_friction_contact_free(FcFrictionContact* contact); // frees the memory of the two above

// Advances from t to t + h [s]. Refuses an h below 0 or subnormal, and an end that is not finite. The inputs
// move at rates.next and keep their end values. With h = 0 time stands still: F_t_mean is F_t, and rates.next
// is used up as in any step.
bool fc_friction_contact_advance(FcFrictionContact* contact, double t, double h, FcMessage* message);

// Recomputes F_t, F_n, sigma and A_r from the state and the present inputs and parameters, whose combination
// it checks. delta, F_t_mean, W_f and Q_f keep the values of the last step. Call after an input or a tunable
// parameter has changed and before an output is read.
bool fc_friction_contact_refresh(FcFrictionContact* contact, FcMessage* message);

// The bristle at the end of the last step, and the same bristle at the start of the present scene.
FcBristle fc_friction_contact_bristle(const FcFrictionContact* contact);
FcBristle fc_friction_contact_reached(const FcFrictionContact* contact, const FcScene* scene);

// The scene that begins at the present time, with the inputs moving at the rates of the last step or, if new
// ones have been set, of the next. V contains the velocity of the body, and with a bristle the rate of V its
// acceleration. It points into the contact.
FcScene fc_friction_contact_scene(FcFrictionContact* contact);

// The scene at the present time with the inputs moving at these rates [1/s times their units], or held if
// they are NULL.
FcScene fc_friction_contact_scene_moving(FcFrictionContact* contact, const double rate[FC_INPUT_COUNT]);

// Sets F_t, F_y, their means, F_n, sigma and A_r.
void fc_set_outputs(FcVariables* v, FcVector force, FcVector mean, const FcContactResponse* contact);

// Whether the present inputs and parameters are a valid combination.
bool fc_friction_contact_check(FcFrictionContact* contact, FcMessage* message);

// The body at the present time, with the force moving as the inputs of the scene above.
FcBody fc_friction_contact_body(const FcFrictionContact* contact);

// Whether a mass sticks by Coulomb's law in that scene, so that F_t = body.F + m V'.
bool fc_friction_contact_sticks(FcFrictionContact* contact);

// Time derivative of (F_t, F_y) [N/s] in that scene.
FcVector fc_friction_contact_force_rate(FcFrictionContact* contact);

// Recomputes the rates of the states, der, for the present outputs and any law of friction.
bool fc_friction_contact_refresh_rates(FcFrictionContact* contact, FcMessage* message);

// Whether the vibration is on and a step of h [s] exceeds half a period. F_t is then one sample, and F_t_mean
// is the output to use.
bool fc_friction_contact_undersamples(const FcFrictionContact* contact, double h);

// The periods [1] in a step of h [s] in which a stuck mass rings without damping and vibration, beyond 1; else 0.
// F_t is then a sample, too.
double fc_friction_contact_rings(const FcFrictionContact* contact, double h);

#endif
