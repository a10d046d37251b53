// One communication step of a scene by brute force in extended precision: the reference that grades the FMU.
//
// Written from docs/physics.md alone; it shares no line with fmu_src. Velocity, deflection and force are vectors: a line is a
// plane with nothing across. Time is cut at every reversal and extreme of the velocity. In between Radau collocation solves
// the law of a bristle, or the angle of one that slips along its bound. Panels are halved until one panel and its two halves
// agree, and until no bound can be met unseen between two nodes. Many equal periods that touch no bound are taken as one map.
#ifndef HUNT_REFERENCE_H
#define HUNT_REFERENCE_H

#include <stdbool.h>

// The numbers of the enumerations are those of modelDescription.xml.
enum { LAW_DAHL = 1, LAW_COULOMB = 2, LAW_ELASTIC_PLASTIC = 3, LAW_LUGRE = 4 };
enum { LIMIT_CONSTANT = 1, LIMIT_LOAD = 2 };
enum { CONTACT_ASPERITIES = 1, CONTACT_CONSTANT = 2, CONTACT_MINDLIN = 3 };
enum { INPUT_SEPARATION = 1, INPUT_LOAD = 2 };
enum { START_GIVEN = 1, START_SETTLED = 2 };

// A scene and its step [start, start + h], in SI units: V, d, E and load at the start of the step, rates per second. Beside
// each field stands its name in modelDescription.xml, if it has one there. A choice is the number of an item.
// clang-format off
#define SCENE_FIELDS(X) \
    X(law, friction.model) X(limit, friction.limit) X(contact, contact.model) X(input, contact.input) \
    X(initial, initialState) X(start, start) X(h, h) X(V, V) X(d, d) X(E, E) X(load, load) X(V_rate, V_rate) \
    X(d_rate, d_rate) X(E_rate, E_rate) X(load_rate, load_rate) X(f, vibration.f) X(V_1, vibration.V_1) \
    X(a_d, vibration.a_d) X(phase_d, vibration.phase_d) X(V_y, V_y) X(V_y_rate, V_y_rate) X(V_2, vibration.V_2) \
    X(phase_2, vibration.phase_2) X(delta_y_0, delta_y_0) X(F_C, F_C) X(mu, friction.mu) \
    X(staticRatio, friction.staticRatio) X(V_S, friction.V_S) X(sigma_1, friction.sigma_1) \
    X(sigma_2, friction.sigma_2) X(delta_0, delta_0) X(contact_sigma, contact.sigma) \
    X(stiffnessScale, contact.stiffnessScale) X(R_q, contact.R_q) X(R, contact.R) X(eta, contact.eta) \
    X(A_n, contact.A_n) X(nu, contact.nu) X(Y, contact.Y) X(c, contact.c) X(lambda, contact.lambda) \
    X(m, body.m) X(F, body.F) X(F_rate, F_rate) X(v_0, body.v_0) X(x_0, body.x_0)
// clang-format on
#define FIELD(name, variable) double name;
typedef struct {
    SCENE_FIELDS(FIELD)
    double slips; // other than 0 if a bristle with static friction slips at the start
} ReferenceScene;
#undef FIELD

// The results of a step: the force at the end, its mean, and at the start with the inputs held after a jump [N]; work and
// heat [J] of the step, the heat with that of the jump; velocity [m/s] and place [m] of the mass; whether a bristle with
// static friction slips at the end. These are graded. The last ones are the deflection at the end [m].
enum {
    F_T,
    F_Y,
    F_T_MEAN,
    F_Y_MEAN,
    F_T_START,
    F_Y_START,
    W_F,
    Q_F,
    BODY_V,
    BODY_X,
    SLIPS_AT_END,
    DELTA,
    DELTA_Y,
    RESULTS
};

typedef struct {
    double result[RESULTS];
    double S;    // N, the scale of errors of forces
    double path; // m, time integral of |V|
    bool known;  // false: it takes more panels or cycles than the reference goes through, and only S is known
} ReferenceStep;

// before: the inputs and parameters at the end of the last step, NULL at the very start. fineness 1, or 2 for
// smaller panels: for checks of the result itself.
void reference_step(const ReferenceScene* before, const ReferenceScene* scene, int fineness,
                    ReferenceStep* result);

bool vibrates(const ReferenceScene* scene);

// At the start of a scene, at the separation about which it vibrates. A load below 1e-99 N counts as that.
typedef struct {
    double d, limit, sigma; // m, N, N/m
} ReferenceRest;
ReferenceRest reference_rest(const ReferenceScene* scene);

// F_t_settled and F_y_settled [N] of the scene's inputs, held, from its start; false if no periods were found that repeat. S is
// that of a step of length 0.
bool reference_settled_force(const ReferenceScene* scene, double force[2], double* S);

#endif
