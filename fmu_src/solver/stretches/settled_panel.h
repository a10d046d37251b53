// The rest of a stretch once the bristle follows its constant limit, in closed form.
//
// With s = sgn V, the settled deflection D = s g / sigma and y = sigma delta - s g, the bristle obeys
//
//     y' = rho (s g + y) - r y,     r = sigma |V| / g,     rho = sigma' / sigma
//
// A transient y decays with r; what stays is the lag s g rho / r, and next to it a part of about 1 / (r T), T being the
// time over which r or rho change. Where the mean of the lag over the interval is within the tolerance, only the end and
// the transient are left to be told; else stretches/settled_lag.h integrates the lag. Without vibration of the stiffness
// there is no lag at all; where V is constant, its integral is s g (|D| at the start - |D| at the end) / |V|, and what is
// missed is of second order. The panel goes from where the Stribeck curve is not seen any more to where its next peak begins.
#ifndef FC_SOLVER_SETTLED_PANEL_H
#define FC_SOLVER_SETTLED_PANEL_H

#include "solver/panels/panel.h"
#include "solver/stretches/mesh.h"

// Whether the bristle may be followed from that place in the stretch to `end` [s] or the next peak with an error that is
// small enough for what the interval is allowed; if so, the panel, and *end is where it ends. *panel holds the panel before.
// *too_long [s] is a span in which the lag could not be told, at first infinite: half as long is tried next. Adds to
// *evaluations what it takes.
bool fc_settled_panel(const FcStretch* stretch, const FcPlace* at, double* end, double* too_long,
                      FcPanel* panel, double* evaluations);

#endif
