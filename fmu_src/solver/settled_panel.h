// The rest of a stretch once the bristle follows its constant limit, in closed form.
//
// With s = sgn V, the settled deflection D = s g / sigma and y = sigma delta - s g, the bristle obeys
//
//     y' = rho (s g + y) - r y,     r = sigma |V| / g,     rho = sigma' / sigma
//
// A transient y decays with r; what stays is the lag s g rho / r, and next to it a part of about 1 / (r T), T being the
// time over which r or rho change. Where the mean of the lag over the interval is within the tolerance, only the end and
// the transient are left to be told. Without vibration of the stiffness there is no lag at all; where V is constant, its
// integral is s g (|D| at the start - |D| at the end) / |V|, and what is missed is of second order. Bells of the Stribeck
// curve that the panel starts or ends in add what solver/settled_bell.h says.
#ifndef FC_SOLVER_SETTLED_PANEL_H
#define FC_SOLVER_SETTLED_PANEL_H

#include "solver/mesh.h"
#include "solver/panel.h"
#include "solver/settled_bell.h"

// Where and of what the panel begins, and where it ends.
typedef struct {
    const FcScene* scene; // of the coefficients beyond bells
    const FcMesh* mesh;
    const FcStretch* stretch;
    const FcPlace* at;
    double end;          // s, of the stretch, or where V enters the bell before it
    double sign;         // of V
    double sigma, limit; // N/m, N, at the start
    const FcSettledBell *first,
        *last;        // of the Stribeck curve, that the panel starts and ends in; NULL for none
    double* too_long; // s, span in which the lag could not be told: half as long is tried next
} FcSettledStart;

// Whether the panel's error is small enough for what the interval is allowed; if so, the panel. Adds to
// *evaluations what it takes.
bool fc_settled_panel(const FcSettledStart* start, FcPanel* panel, double* evaluations);

#endif
