// A panel of a mass on its contact, by Radau IIA as without a mass (relaxation.c). With w = v + V, the velocity of the mass over
// the other surface,
//
//     m v' = F(t) - F_t      F_t = sigma delta + sigma_1 delta' + sigma_2 w
//
// so v at the points is linear in the deflections there, and a mass adds no unknown: the linear system of a bristle becomes
// Newton's method of the same size.
#ifndef FC_SOLVER_BODY_BODY_PANEL_H
#define FC_SOLVER_BODY_BODY_PANEL_H

#include "solver/body/body.h"
#include "solver/integrate/control.h"
#include "solver/panel/arithmetic.h"
#include "solver/panel/nodes.h"

// The rounding of a time, a velocity or a squared deflection, over the largest: 5 eps.
static const double FC_BODY_ROUNDING = 1e-15;

// The start of a panel.
typedef struct {
    FcKind kind;  // FC_RELAXES, FC_STICKS or FC_SLIPS
    int side;     // the sign of w of a bristle that relaxes, or of the bound of one that slips
    double delta; // m
    double v;     // m/s
} FcBodyStart;

// Rates at one time.
typedef struct {
    double limit;      // N, g
    double relaxation; // 1/s, sigma |w| / g; 0 in ElasticPlastic
    double delta;      // m/s
    double v, w;       // m/s2
    double push;       // m/s, of a bristle that slips
    double inertia;    // 1, what a damper leaves of m along a bound that follows w
} FcBodyRates;
FcBodyRates fc_body_rates(const FcPlane* plane, const FcBody* body, const FcBodyStart* at, double t,
                          FcPhase phase, double sigma, double static_limit);

// At the points of the panel: its stages, and then its start.
typedef struct {
    double delta[FC_POINTS]; // m
    double v[FC_POINTS];     // m/s
    double w[FC_POINTS];     // m/s
    FcBodyRates rate[FC_POINTS];
} FcBodyPanel;

// Solves the panel; sets nodes->limit. close [N] is an error of the force that counts as none. Adds the solutions of a
// system to *solves. False if Newton's method does not converge: the panel is too long.
bool fc_body_panel(const FcPlane* plane, const FcBody* body, const FcBodyStart* start, double close,
                   FcNodes* nodes, FcBodyPanel* panel, double* solves);

FC_TWICE(fc_body_panel);

// Sets w and the rates at the points, and nodes->limit, from delta and v there.
void fc_body_panel_rates(const FcPlane* plane, const FcBody* body, const FcBodyStart* start, FcNodes* nodes,
                         FcBodyPanel* panel);

#endif
