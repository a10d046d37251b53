// The scene at a time, the jump of its inputs, and tools: what the references along the sliding and in the plane share.
#ifndef HUNT_MOMENT_H
#define HUNT_MOMENT_H

#include <stddef.h>

#include "reference.h"

typedef long double Real;

// By how much of its bound a bristle that slips may be inside it: what the rounding of a phase leaves.
#define ON_BOUND 1e-10L

// ---------------------------------------------------------------------------------------------------------------------
// Radau's right rule on [0, 1] and its collocation matrix; linear equations; roots
// ---------------------------------------------------------------------------------------------------------------------

enum { MOST_STAGES = 12 };

typedef struct {
    int stages;
    Real node[MOST_STAGES];            // the last one is 1
    Real weight[MOST_STAGES];          // sum 1
    Real to[MOST_STAGES][MOST_STAGES]; // to[i][j]: integral of the j-th Lagrange polynomial over [0, node i]
} Rule;

const Rule* rule_of(int stages);

// Solves A x = b in place for each b, pivoting by columns.
void solve(int n, Real A[MOST_STAGES][MOST_STAGES], int count, Real b[][MOST_STAGES]);

typedef Real Function(const void* context, Real x);

// Where a function passes zero between low and high, on the side of high.
Real crossing(Function* function, const void* context, Real low, Real high);

int sign_of(Real x);

// Sine of x + shift pi / 2.
Real sine(Real x, int shift);

// ---------------------------------------------------------------------------------------------------------------------
// The scene at a time
// ---------------------------------------------------------------------------------------------------------------------

// What F_n and sigma are over their power of e^(-lambda d / R_q), and the derivatives of their logarithms by E.
typedef struct {
    Real force, by_force;         // N
    Real stiffness, by_stiffness; // N/m; N m2 for Asperities
} AtModulus;

// A component of the velocity: V + rate t + swing cos(omega t + theta).
typedef struct {
    Real V, rate, swing, theta;
    Real start; // m/s, at t = 0
} Drive;

typedef struct {
    ReferenceScene scene;
    Drive along, transverse;
    Real h, omega, theta_0, decay, swell, excess;
    Real no_load;   // s, when a load that moves is 0
    AtModulus held; // at the modulus of the start
    bool elastic;   // the law is ElasticPlastic
    bool bounded;   // a bristle has a bound: ElasticPlastic's, or the limit of Dahl's and LuGre's that moves
    bool open;      // nothing touches
    bool open_ends; // a bristle is taken as if it had no bound: for the map of a period that touches none
    Real S;         // N
    Real top;       // m/s, the largest |V|
    const Rule* rule;
    int fineness;
    Real panels;
} World;

// At a local time; rates are time derivatives of logarithms, found only when they are asked for.
typedef struct {
    Real V, V_y;                   // m/s
    Real sigma;                    // N/m
    Real coulomb;                  // N, F_C or mu F_n
    Real g;                        // N, where the bristle's force tends
    Real B;                        // N, the bound of what does not slip
    Real bound_rate, kinetic_rate; // of ln(B / sigma), ln(g / sigma)
} At;

World make_world(const ReferenceScene* scene, Real h, int fineness);

// The same with its inputs held.
World held_world(const World* w, Real h);

bool is_held(const ReferenceScene* s);

Real velocity(const World* w, const Drive* drive, Real t);
Real velocity_rate(const World* w, const Drive* drive, Real t);

// Integral of a component over [a, b].
Real travel(const World* w, const Drive* drive, Real a, Real b);

At scene_at(const World* w, Real t, bool with_rates);

// The bound [m] of a bristle that sticks, or of one that slips, and how fast it moves [m/s].
Real bound(const World* w, const At* at, bool sticks);
Real bound_rate(const World* w, const At* at, bool sticks);

// What the tolerance is relative to [N], from the length [m] of the deflection at the start.
Real largest_force(const World* w, Real length);

// What the jump of the inputs, or a start beyond the bound, does to the deflection [m], or its length in the plane; returns
// its heat [J].
Real jump(const ReferenceScene* before, const World* w, Real* delta, int* slip);

// ---------------------------------------------------------------------------------------------------------------------
// Cuts of the step
// ---------------------------------------------------------------------------------------------------------------------

bool is_open(const World* w, Real t);

// The part of [0, h] in which the contact is closed; empty: from = to = h.
typedef struct {
    Real from, to;
} Closed;

Closed closed_part(const World* w);

typedef struct {
    Real* time;
    size_t count, room;
} Cuts;

void* memory(void* old, size_t size);
void cut(Cuts* cuts, Real t);

// Of V_S, where Stribeck's curve is cut.
enum { LEVELS = 10 };
extern const Real MULTIPLES[LEVELS];

// Sorted, without repetition, inside the part.
void tidy(Cuts* cuts, Closed part);

#endif
