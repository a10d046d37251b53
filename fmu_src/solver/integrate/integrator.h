// The integrator: it takes the parts of an interval panel by panel. What all motions have in common.
#ifndef FC_SOLVER_INTEGRATE_INTEGRATOR_H
#define FC_SOLVER_INTEGRATE_INTEGRATOR_H

#include "solver/integrate/control.h"

// The distance of a deflection from its bound, over the bound, that counts as 0: rounding, 450 eps.
static const double FC_ROUNDING_OF_DEFLECTION = 1e-13;

typedef struct {
    const FcPlane* plane;
    const FcInterval* interval;
    FcDrive across;            // fc_drive_across, in the plane
    FcPlaneCoefficients first; // at the start
    FcControl control;
    // The parts, and the place reached.
    const FcPart* parts;
    int count, number;
    FcPart part; // the present one, in the variable of the present motion
    FcPosition at;
    double end, length_u;   // of the part, in u
    double h;               // of the next panel, in u; 0 if nothing proposes one
    double* remaining_path; // m, the path after each part, at the least; found if it is needed
    // The motion up to that place.
    FcMap along, across_map;
    FcPanelStart from; // of the next panel, and whether the maps are for any start
    double scale;      // m, of all these starts
    struct {
        FcBristleState state;
        bool touches;    // it is free and at its bound: whether it is pushed decides next
        bool is_bounded; // it may meet a bound
        bool is_stalled; // at an event that rounding hides: a little push counts as none, and then it slips
        bool is_rigid;   // rounding cannot see its length beside the path: its force is Coulomb's
    } bristle;
    struct {
        int meetings;         // of the bristle with its bound
        double heat;          // J, of break-away
        double drag;          // m2/s, of its drops
        FcVector by_start[2]; // as in FcStepResult
        double slip_length;   // s, of the longest slip, which lasts
        double slip_time;     // s, into the interval, its middle
        int slip_side;
    } sums;
    double error_ratio; // of the panel that the controller judged last, over what is allowed
    double evaluations;
} FcIntegrator;

// The memory of the parts of an integrator, which is filled as far as there are any.
typedef struct {
    FcPart parts[FC_MAX_PARTS];
    double remaining_path[FC_MAX_PARTS];
} FcWorkspace;

// An integrator of the interval from its start on, with its parts, or in one part; the bristle is to be set.
void fc_integrator_start(FcIntegrator* integrator, FcWorkspace* workspace, const FcPlane* plane,
                         const FcInterval* interval, bool in_one_part, double evaluations);

FcKind fc_kind(const FcIntegrator* integrator);
FcVector fc_integrator_delta(const FcIntegrator* integrator); // m, now
void fc_set_delta(FcIntegrator* integrator, FcVector delta);
FcPlaneCoefficients fc_coefficients_at(const FcIntegrator* integrator, double t);

// The largest velocity [m/s] of the bristle and its bound together.
double fc_largest_push(const FcIntegrator* integrator);

// The path from the place reached in the present part to the interval's end, at the least [m].
double fc_path_left(FcIntegrator* integrator, double t);

// Begins a part, and the same part again in the variable of the present motion: a stuck bristle moves smoothly in t, one
// that slips or relaxes in u.
void fc_begin_part(FcIntegrator* integrator, int number);
void fc_choose_variable(FcIntegrator* integrator);
bool fc_part_is_crossed(const FcIntegrator* integrator);

// Makes the panel of the length h [u] at the present place, which is too long for its equation if it is false.
bool fc_make_panel(FcIntegrator* integrator, double h, FcNodes* nodes, FcPanel* panel);
// The same of a part of a panel that was solved.
void fc_resolve_shorter(FcIntegrator* integrator, double h, FcNodes* nodes, FcPanel* panel);

// Makes the next panel, as long as it is accurate; returns its length in u.
// - It is planned, made and judged, and shortened until its errors are small enough.
// - After FC_MAX_REJECTIONS of them it is accepted. If it could not be solved, the deflection becomes no number, for which
//   the step is refused.
double fc_step_adaptive(FcIntegrator* integrator, FcNodes* nodes, FcPanel* panel);

// Adds the panel's integrals, and goes to its end.
void fc_accept_panel(FcIntegrator* integrator, const FcNodes* nodes, FcPanel* panel, double h);
// The same of a closed form that ends at the time t [s].
void fc_accept_closed_form(FcIntegrator* integrator, const FcMap* map, double t);
// Notes a slip along a line, for a multirevolution step.
void fc_note_slip(FcIntegrator* integrator, double start, double end, int side);

#endif
