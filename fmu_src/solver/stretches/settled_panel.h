// The rest of a stretch once the bristle follows its constant limit, in closed form.
//
// With s = sgn V, the settled deflection D = s g / sigma and y = sigma delta - s g, the bristle obeys
//
//     y' = rho (s g + y) - r y,     r = sigma |V| / g,     rho = sigma' / sigma
//
// A transient y decays with r. The lag s g rho / r stays, and beside it a part of about 1 / (r T), with the
// time T over which r or rho change. If the mean of the lag over the interval is within the tolerance, only
// the end and the transient need formulas. Else stretches/settled_lag.h integrates the lag. A constant
// stiffness has no lag. With a constant V the integral of the lag is s g (|D| at the start - |D| at the end)
// / |V|, with an error of second order. The panel begins as soon as the Stribeck curve is not seen, and ends
// at its next peak.
#ifndef FC_SOLVER_SETTLED_PANEL_H
#define FC_SOLVER_SETTLED_PANEL_H

#include "solver/panels/panel.h"
#include "solver/stretches/mesh.h"

// Follows the bristle from that place in the stretch to `end` [s] or the next peak; false if the error may
// exceed the interval's share. *panel holds the panel before and becomes the new one, and *end becomes its
// end. *too_long [s] is a span whose lag could not be integrated, at first infinite: half as long is tried
// next. Adds its evaluations to *evaluations.
bool fc_settled_panel(const FcStretch* stretch, const FcPlace* at, double* end, double* too_long,
                      FcPanel* panel, double* evaluations);

#endif
