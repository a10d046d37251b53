// One contact as a differential equation with events: the physics of FMI for model exchange. The states are
// delta, W_f, Q_f and delta_y. The inputs have their present values.
//
// A bounded bristle is in a state (model/bound.h) that changes only in fc_ode_update, at an event. It
// slips once it is beyond its bound and pushed. It is free again once the push ends. With static friction it
// breaks away and drops to the kinetic bound. A contact opens and closes at events, too. All events have a
// little hysteresis, so that the rounding of an event's time starts no second event. The motion between two
// events depends on time, states, inputs and regime alone. Inputs that jump at an event do so as between two
// steps of co-simulation (solver/input_jump.h).
//
// The push also depends on the speed at which the inputs move the bound. That speed is estimated from the
// inputs now and at the end of the integrator's last step. An error of it enters the moment of sticking, and
// delta and the force by its square. The rates of a bristle that slips do not contain the heat of that
// motion. It is summed from step to step, and the next event adds it to Q_f.
#ifndef FC_CONTACT_ODE_H
#define FC_CONTACT_ODE_H

#include "contact/friction_contact.h"

// Their numbers in modelDescription.xml.
enum { FC_STATE_COUNT = 4, FC_EVENT_INDICATOR_COUNT = 4 };

// False with *message filled for a law without a state, and if the nominal values are not finite numbers
// above 0.
bool fc_ode_allows(FcFrictionContact* contact, FcMessage* message);

// After fc_friction_contact_initialize.
void fc_ode_start(FcFrictionContact* contact);

// Moves the contact to the time [s] of the host's integrator.
void fc_ode_set_time(FcFrictionContact* contact, double time);

// Recomputes the outputs and the rates of the states. False with *message filled if the inputs are not a
// valid combination or a result is beyond the largest number.
bool fc_ode_refresh(FcFrictionContact* contact, FcMessage* message);

// Positive but at an event:
//   0   V with its vibration [m/s], for the kink of |V|; in the plane a slanting part of it, which is 0 at any reversal,
//       and harmlessly elsewhere; 1 in ElasticPlastic, which has no kink
//   1   (D - |delta|) / D + hysteresis while a bounded bristle is free, else 1
//   2   the push of a bristle that slips, beyond its bound, with hysteresis [m/s]; 1 if it does not slip
//   3   the distance of a closed contact from opening, or of an open one from closing: in the load [N], or in d [m]; 1 if
//       neither has an effect
// The first may have either sign. False as fc_ode_refresh.
bool fc_ode_indicators(FcFrictionContact* contact, double z[FC_EVENT_INDICATOR_COUNT], FcMessage* message);

// Call after each completed step of the integrator: stores the inputs. True if the state has ended. False
// also if the inputs are not a valid combination; the next evaluation reports this.
bool fc_ode_step_completed(FcFrictionContact* contact);

// Begins an event, with the inputs before it. Moves a slipping bristle onto its bound, which the inputs have
// moved, and adds the heat of that motion to Q_f. Stores the past from which inputs and parameters may jump.
void fc_ode_event_begins(FcFrictionContact* contact);

// The regime after the event. *changed says whether a state has changed since the event began,
// *nominals_changed whether the nominal values have. False as fc_ode_refresh.
bool fc_ode_update(FcFrictionContact* contact, bool* changed, bool* nominals_changed, FcMessage* message);

// The time [s] of the next event that the indicators may miss, because a step may pass two of their zeros, or that keeps
// an error control from passing over whole periods. Under vibration it is at most a third of a period ahead. Along a
// line it is the time at which the vibration, with the present inputs, turns a bounded bristle back from a bound, if
// that is sooner. A bounded bristle in the plane has a smaller part of the period. False if nothing vibrates.
bool fc_ode_next_event(FcFrictionContact* contact, double* time);

// Ends an event. A jump of the inputs in it is not a motion.
void fc_ode_event_ends(FcFrictionContact* contact);

// Nominal values at the present inputs. With the limit F of the force, that of delta is the bound or
// saturation length F / sigma without vibration. That of the energies is F times the larger of this length
// and the vibration's amplitude V_1 / (2 pi f). In the order delta [m], W_f [J], Q_f [J], delta_y [m]. False as
// fc_ode_refresh, with the nominals unchanged.
bool fc_ode_nominals(FcFrictionContact* contact, double nominals[FC_STATE_COUNT], FcMessage* message);

#endif
