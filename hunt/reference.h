// One communication step of a scene by brute force in extended precision: what the FMU is held against.
//
// Written from docs/physics.md alone; it shares no line with fmu_src. Time is cut at every reversal of V, at every dip
// and bend of the velocity, and where a bristle may meet its bound. Between cuts the equation of the bristle is solved by
// Radau collocation with ten stages on panels that are halved until one panel and its two halves agree.
#ifndef HUNT_REFERENCE_H
#define HUNT_REFERENCE_H

#ifdef __cplusplus
extern "C" {
#endif

// The numbers of the enumerations are those of modelDescription.xml.
enum { LAW_DAHL = 1, LAW_COULOMB = 2, LAW_ELASTIC_PLASTIC = 3, LAW_LUGRE = 4 };
enum { LIMIT_CONSTANT = 1, LIMIT_LOAD = 2 };
enum { CONTACT_ASPERITIES = 1, CONTACT_CONSTANT = 2, CONTACT_MINDLIN = 3 };
enum { INPUT_SEPARATION = 1, INPUT_LOAD = 2 };
enum { START_GIVEN = 1, START_SETTLED = 2 };

// A scene and its step [start, start + h]. Doubles first, so that a table of names finds them all by their index.
typedef struct {
    double start;                              // s
    double h;                                  // s
    double V, d, E, load;                      // m/s, m, Pa, N at the start of the step
    double V_rate, d_rate, E_rate, load_rate;  // per second
    double f, V_1, a_d, phase_d;               // Hz, m/s, m, rad
    double F_C, mu, staticRatio, V_S;          // N, 1, 1, m/s
    double sigma_1, sigma_2;                   // N s/m
    double delta_0;                            // m
    double contact_sigma, stiffnessScale;      // N/m, 1
    double R_q, R, eta, A_n, nu, Y, c, lambda; // m, m, 1/m2, m2, 1, Pa, 1, 1
    int law, limit, contact, input, initial;
    int binds; // whether a limit that follows the load binds the bristle of Dahl and LuGre
} ReferenceScene;

enum { REFERENCE_DOUBLES = 31 };

typedef struct {
    double delta; // m, at the end
    double F_t;   // N, at the end
    double
        F_t_other; // N, the same were it on the other side of a jump: slipping or not, V forward or backward
    double gap;    // N, how far the bristle's force is from that jump
    double sigma;  // N/m, at the end
    double F_t_mean;                   // N
    double work;                       // J, of F_t in the step
    double heat;                       // J
    double delta_start;                // m, where the step starts: inside its bound, or settled
    double F_t_start;                  // N, with held inputs
    double F_t_start_other, gap_start; // N, as at the end
    double limit;                      // N, time mean of F_C or of mu F_n over the step
    double scale; // N, that, or F_C or mu times the mean of F_n over a period at the start, whichever is less
    double path;  // m, time integral of |V|
    double largest;    // N, largest |sigma delta| seen at a node
    double changed;    // s into the step, when the bristle last met or left its bound; negative: at no time
    double panels;     // panels that were solved
    double unresolved; // panels that did not agree at the smallest size
} ReferenceStep;

// Scenes with Table 1's surfaces and the start values of modelDescription.xml, binds set.
ReferenceScene reference_scene(void);

// fineness 1, or more for more panels from the start and a second number of stages: for checks of the result itself.
void reference_step(const ReferenceScene* scene, int fineness, ReferenceStep* result);

// Only what errors are relative to, without solving for the bristle: path, sigma at the end, and for scale the least over the
// step of the mean limit, which is no larger than that of reference_step. largest is that of the start; no jump is near.
void reference_frame(const ReferenceScene* scene, ReferenceStep* frame);

#ifdef __cplusplus
}
#endif

#endif
