// A mass in the contact, that moves along V:
//
//     m v' = F - F_t        w = v + V(t)        x' = v
//
// with F_t = sigma delta + sigma_1 delta' + sigma_2 w, or of Coulomb's law. w, with the vibration, takes the place of V
// in the laws of friction. All that a step knows of the mass is the impulse of F_t: v = v_0 + (integral of F - impulse) / m,
// so a heavy mass loses no digits, and the balance of momentum holds to rounding.
#ifndef FC_SOLVER_BODY_BODY_H
#define FC_SOLVER_BODY_BODY_H

#include <assert.h>

#include "model/motion.h"
#include "solver/solver.h"

typedef struct {
    double m;        // kg, 0 without a mass
    FcLinearInput F; // N
    double v;        // m/s, at the start of the step
    double x;        // m
    bool sticks;     // Coulomb's law: whether a step has left it at rest on the other surface
} FcBody;

// The impulse of F over [0, t] [N s].
static inline double fc_body_pushed(const FcBody* body, double t) {
    return (body->F.value + 0.5 * body->F.rate * t) * t;
}

// Its integral [N s2].
static inline double fc_body_pushed_twice(const FcBody* body, double t) {
    return (body->F.value / 2.0 + body->F.rate / 6.0 * t) * t * t;
}

// Takes v and F to the end of a step of h [s], by the impulse of F_t [N s].
static inline void fc_body_move(FcBody* body, double h, double impulse) {
    assert(h >= 0.0 && body->m > 0.0);
    body->v += (fc_body_pushed(body, h) - impulse) / body->m;
    body->F.value += body->F.rate * h;
}

// m less what the damper takes of it [kg]: -dF_t/dw' where the kinetic bound follows w. At 0 w would jump, and before, at
// that part of m, it counts as having jumped. Chosen empirically: half of it costs evaluations.
static const double FC_MIN_INERTIA = 1e-3;
double fc_body_inertia(const FcScene* scene, FcBristle bristle, const FcBody* body);

// The acceleration [m/s2] under the force F [N] in a scene whose V contains v: the rate of the kinetic bound moves with it.
double fc_body_acceleration(const FcScene* scene, FcBristle bristle, const FcBody* body, double F);

// The scene as the bristle sees it at its start: V contains v, and with a bristle the rate of V contains v'.
FcScene fc_body_scene(const FcScene* scene, const FcBody* body, FcBristle bristle);

// A bristle with a damper breaks away, or jumps along the kinetic bound: delta falls to the first place on D(w), while
// m w + sigma_1 delta stays. Adds work and heat; V of the scene contains v before.
void fc_body_drop(const FcScene* scene, double m, double sigma_1, FcStepResult* now);

// Coulomb's law: whether the surfaces rest on each other at the start of a scene whose V contains v, and F_t [N] there, of
// which *sticks says whether it is below the limit.
bool fc_body_rests(const FcScene* scene, const FcBody* body);
double fc_body_rigid_force(const FcScene* scene, const FcBody* body, bool* sticks);

// Refuses a step of h [s] with a bristle: names the ringing and what ends it, a damping ratio of 0.2. Returns false.
bool fc_body_refuse(const FcScene* scene, const FcBody* body, double h, const char* reason,
                    FcMessage* message);

#endif
