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

// A scene and its step [start, start + h].
typedef struct {
    double start;                              // s
    double h;                                  // s
    double V, d, E, load;                      // m/s, m, Pa, N at the start of the step
    double V_rate, d_rate, E_rate, load_rate;  // per second
    double V_y, V_y_rate;                      // m/s, m/s2
    double f, V_1, a_d, phase_d, V_2, phase_2; // Hz, m/s, m, rad, m/s, rad
    double F_C, mu, staticRatio, V_S;          // N, 1, 1, m/s
    double sigma_1, sigma_2;                   // N s/m
    double delta_0, delta_y_0;                 // m
    double contact_sigma, stiffnessScale;      // N/m, 1
    double R_q, R, eta, A_n, nu, Y, c, lambda; // m, m, 1/m2, m2, 1, Pa, 1, 1
    int law, limit, contact, input, initial;
    int slips; // other than 0 if a bristle with static friction slips at the start
} ReferenceScene;

// The results of a step: the force at the end, its mean, and at the start with the inputs held after a jump [N]; work and
// heat [J] of the step, the heat with that of the jump; whether a bristle with static friction slips at the end. These are
// graded. The last ones are the deflection at the end [m].
enum { F_T, F_Y, F_T_MEAN, F_Y_MEAN, F_T_START, F_Y_START, W_F, Q_F, SLIPS_AT_END, DELTA, DELTA_Y, RESULTS };

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
