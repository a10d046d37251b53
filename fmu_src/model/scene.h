// The scene of one communication step: a contact, its drive, and the law of friction. It gives the
// coefficients of the bristle's equation at any time of the step,
//
//     delta' = V(t) - sigma(t) |V(t)| delta / g(t)                       (Eq. 2; g = F_C in the paper)
//
// With contact.input = Load the surfaces float: the separation is the one
// at which the mean of F_n over a period of the vibration is the load.
#ifndef FC_MODEL_SCENE_H
#define FC_MODEL_SCENE_H

#include <math.h>
#include <stdbool.h>

#include "model/contact.h"
#include "model/drive.h"
#include "model/friction.h"

typedef struct {
    const FcContactParameters* contact;
    const FcFriction* friction;
    double F_C; // N, the constant limit
    FcDrive drive;
    FcContactAtModulus at_E; // the contact at the modulus of the start of the step
    double log_swell;        // ln of the mean over a period of F_n over F_n without vibration
    bool
        floats; // the separation follows a load that moves in the step, or a modulus: d(t) is not the drive's
    bool is_open; // at the start: no load presses the surfaces together, or they are far apart
} FcScene;

// Completes a scene, in place, whose drive is started (fc_drive_start). at_E is the contact at the drive's modulus at the start.
// Keeps the pointers.
void fc_scene_make(FcScene* scene, const FcContactParameters* contact, const FcContactAtModulus* at_E,
                   const FcFriction* friction, double F_C);

// The scene with its local time starting at t [s]; with vibration, t a whole number of periods.
FcScene fc_scene_later(const FcScene* scene, double t);

// The same with t at any phase.
FcScene fc_scene_from(const FcScene* scene, double t);

// Whether sigma or g, if the law uses them, depends on the separation.
static inline bool fc_uses_separation(const FcFriction* friction, int contact_model) {
    return fc_limit_follows_load(friction) ||
           (contact_model != FC_CONTACT_CONSTANT && fc_has_bristle(friction));
}
static inline bool fc_scene_depends_on_d(const FcScene* scene) {
    return fc_uses_separation(scene->friction, scene->at_E.model);
}

// Whether the bristle has lost its contact at the start: its force and its deflection are 0.
static inline bool fc_scene_is_separated(const FcScene* scene) {
    return scene->is_open && fc_scene_depends_on_d(scene);
}

// Whether the load, given or from d, moves, if the law uses it.
static inline bool fc_scene_has_segments(const FcScene* scene) {
    return fc_scene_depends_on_d(scene) && (scene->drive.load.rate != 0.0 || scene->drive.d.rate != 0.0);
}

// The part of the step by which a contact opens earlier and closes later. Derived: the effect on the bristle
// goes with its square. Twice the part has four times the effect.
#define FC_NEARLY_OPEN 0x1p-44

// The margin by which the contact is closed at the start: the load [N], or the distance to the separation at
// which it opens [m]. At 0 and below the contact is open.
double fc_scene_closed_by(const FcScene* scene);

// The time [s], up to `rest`, over which the scene is one segment from its start on, in a step of `whole` [s]:
// until the contact opens or closes, or the load, given or from d, has moved by a factor of 4. Sets is_open
// if the contact opens within 2^-44 of the step.
double fc_scene_segment(FcScene* scene, double rest, double whole);

// Whether g / sigma does not depend on the separation: F_n and Mindlin's stiffness fall with d alike.
static inline bool fc_scene_ratio_is_constant(const FcScene* scene) {
    return scene->at_E.model == FC_CONTACT_MINDLIN && fc_limit_follows_load(scene->friction);
}

// At the local time t [s].
double fc_scene_d(const FcScene* scene, double t);                  // m
double fc_scene_d_rate(const FcScene* scene, double t);             // m/s
FcContactResponse fc_scene_contact(const FcScene* scene, double t); // also of one that is open
double fc_scene_stiffness(const FcScene* scene, double t);          // N/m

// The coefficients of the bristle's equation at one time.
typedef struct {
    double V;     // m/s
    double sigma; // N/m
    double limit; // N, g
} FcCoefficients;

FcCoefficients fc_scene_coefficients(const FcScene* scene, double t);
// At the start, from the results of fc_scene_contact there.
FcCoefficients fc_scene_coefficients_of(const FcScene* scene, const FcContactResponse* response);
FcCoefficients fc_scene_coefficients_at_phase(const FcScene* scene, double t, FcPhase at_t);

// r = sigma |V| / g [1/s]: the equation is delta' = V - r delta.
static inline double fc_relaxation_rate(const FcCoefficients* at) {
    return at->sigma * fabs(at->V) / at->limit;
}

// Time derivatives of ln(sigma) and ln(g / sigma) [1/s] without the Stribeck curve, the second without cancellation; 0
// for a quantity that has become 0.
typedef struct {
    double sigma;
    double ratio;
} FcLogRates;
FcLogRates fc_scene_log_rates(const FcScene* scene, double t, FcPhase at_t);

// Bounds over [0, h], h [s] >= 0.
double fc_scene_smallest_d(const FcScene* scene, double h);          // m
double fc_scene_largest_stiffness(const FcScene* scene, double h);   // N/m
double fc_scene_smallest_limit(const FcScene* scene, double h);      // N
double fc_scene_smallest_saturation(const FcScene* scene, double h); // m, of g / sigma
double fc_scene_largest_saturation(const FcScene* scene, double h);  // m, of g / sigma

// Whether sigma and g, apart from the Stribeck curve, are constant over the step.
bool fc_scene_stiffness_is_constant(const FcScene* scene);
bool fc_scene_limit_is_constant(const FcScene* scene);

// F_C, or mu times the mean of F_n over a period of the vibration with the inputs of the time t [N].
double fc_scene_mean_limit(const FcScene* scene, double t);

#endif
