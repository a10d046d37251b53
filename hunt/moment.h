// The scene at a time, and vectors.
#ifndef HUNT_MOMENT_H
#define HUNT_MOMENT_H

#include <complex.h>

#include "reference.h"

typedef long double Real;

static const Real PI = 3.141592653589793238462643383279502884L;

// The real part is along the sliding, the imaginary one across.
typedef long double _Complex Vector;

Real dot(Vector a, Vector b);
Vector across(Vector a); // turned by a quarter
Real length_of(Vector a);
Vector along(Vector a, Real length); // of that length along another, or 0
Vector direction(Real turns);        // (cos, sin) of 2 pi turns

// ---- The scene at a time ----

// The factors of F_n and sigma before their powers of e^(-lambda d / R_q), and the derivatives of their logarithms by E.
typedef struct {
    Real force, by_force;         // N
    Real stiffness, by_stiffness; // N/m; N m2 for Asperities
} AtModulus;

typedef struct {
    ReferenceScene scene;
    // The velocity [m/s] is start + rate t + Re(x turn), Re(y turn), with turn = e^(i omega t) - 1.
    Vector start, rate, x, y;
    // The separation [m] is d + d_rate t + Re(swing e^(i omega t)).
    Real d, d_rate;
    Vector swing;
    Real h, omega, decay, swell, excess;
    Real cycle;     // 1, the part of a period before the start
    AtModulus held; // at the modulus of the start
    bool elastic;   // the law is ElasticPlastic
    bool bounded;   // a bristle has a bound: ElasticPlastic's, or the limit of Dahl's and LuGre's that moves
    bool open;      // nothing touches
    bool ramp;      // between two steps: nothing moves a bristle but its bound
    bool pushed;    // after the ramp, a bristle that has broken away
    // On a ramp: rates [1/s] of the logarithms of F_C or mu, of the stiffness's factor, ..
    struct {
        Real limit, scale, ratio, V_S;
    } ln_rate;
    Real S;   // N
    Real top; // m/s, the largest |V|
    int fineness;
    Real panels; // taken so far
} World;

// At a local time; rates are time derivatives of logarithms.
typedef struct {
    Vector V;                      // m/s, 0 on a ramp
    Vector input;                  // m/s, the same on a ramp too
    Real F_n, sigma;               // N, N/m
    Real coulomb;                  // N, F_C or mu F_n
    Real g;                        // N, the force to which a bristle tends
    Real B;                        // N, the bound of a bristle that sticks
    Real bound_rate, kinetic_rate; // of ln(B / sigma), ln(g / sigma)
} At;

World make_world(const ReferenceScene* scene, Real h, int fineness);

// The separation [m] at the start, with the vibration.
Real separation(const World* w);

bool is_open(const World* w, Real t);

// The velocity at a time and its derivatives up to that order.
void velocities(const World* w, Real t, int order, Vector* V);

At scene_at(const World* w, Real t);

// The bound [m] of a bristle that sticks, or of one that slips, and how fast it moves [m/s].
Real bound(const World* w, const At* at, bool sticks);
Real bound_rate(const World* w, const At* at, bool sticks);

// Mean of the limit over a period of the vibration with the inputs of a time [N].
Real mean_limit(const World* w, Real t);

#endif
