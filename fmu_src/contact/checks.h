// Checks of inputs, parameters and time that single bounds do not cover, and the texts that name a fault: the variable,
// its value and its bound. All return false with a message.
#ifndef FC_CONTACT_CHECKS_H
#define FC_CONTACT_CHECKS_H

#include "contact/friction_contact.h"

// The inputs that the law uses must be above 0. A load of 0 opens the contact.
bool fc_check_inputs(const FcVariables* v, FcMessage* message);

// A mass moves along V alone, by collocation or CVODE.
bool fc_check_body(const FcVariables* v, const double rate[FC_INPUT_COUNT], FcMessage* message);

// The time t [s] must determine the phase of the vibration.
bool fc_check_time(const FcDrive* drive, double t, FcMessage* message);

// Over the step [0, h] separation and modulus, if the law uses them, must stay positive, E near its start, and the
// stiffness and the limit finite.
bool fc_check_scene(const FcScene* scene, double h, FcMessage* message);

// Whether a step needs fc_check_scene. Single bounds suffice if nothing moves and the load does not decide.
bool fc_scene_is_to_be_checked(const FcScene* scene);

// A stiffness at the separation d [m] and the modulus E [Pa] beyond the largest number.
bool fc_fail_stiffness(FcMessage* message, double d, double E);

// A motion that is not finite.
bool fc_fail_motion(const FcScene* scene, const FcVariables* v, FcMessage* message);

// The faster of the two velocities, along and transverse, for a message: its input, and the amplitude of its vibration.
typedef struct {
    const char* name;
    double V; // m/s
    const char* vibration;
    double amplitude; // m/s
} FcFastest;
FcFastest fc_fastest(const FcDrive* drive);

#endif
