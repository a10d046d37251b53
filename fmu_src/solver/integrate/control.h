// The step size controller of the march: it plans the length of each panel, and judges its estimated errors by their error
// ratio, above 1 of which the panel is rejected and made again, shorter.
#ifndef FC_SOLVER_INTEGRATE_CONTROL_H
#define FC_SOLVER_INTEGRATE_CONTROL_H

#include "solver/integrate/time_map.h"
#include "solver/interval.h"
#include "solver/panel/panel.h"

// The motion of a panel; Coulomb's law has no bristle.
typedef enum { FC_RELAXES, FC_STICKS, FC_SLIPS, FC_NO_BRISTLE } FcKind;

// The place that the march has reached.
typedef struct {
    double u, t;     // of the part [1 or s], and s
    double rate;     // 1/s, r, or |V| / D of a stuck bristle
    double per_path; // 1/m, sigma / g
} FcPosition;

typedef struct {
    const FcPlane* plane;
    const FcInterval* interval;
    double log_transient; // ln of the rest of the transient over the allowed error
    double log_force;     // ln of the force over the allowed error
    double span;          // s, the longest panel if the force is of the size of the limit
    double longest;       // the same in u
    bool settles;         // along a line, to a constant force
} FcControl;

// A panel that was refused so often in a row is accepted: 0.3^12 of its length, at which rounding limits it.
enum { FC_MAX_REJECTIONS = 12 };

// transient [N]: of the start.
void fc_control_start(FcControl* control, const FcPlane* plane, const FcInterval* interval, double transient);

// The length in u of the next panel, at most up to `end` in u and, unless it is 0, `proposed`.
double fc_control_length(const FcControl* control, const FcPart* part, const FcPosition* at, FcKind kind,
                         double end, double proposed);

// The factor by which the panel's errors of the mean are too large, and in *of_end that at the end, before it fades along the
// path to the interval's end.
double fc_control_error_ratio(const FcControl* control, const FcPart* part, const FcNodes* nodes,
                              const FcPanel* panel, double* of_end);

// The factor by which a panel is shortened that was refused, and that by which the one after it may be longer if there
// were refusals, for an error ratio above 1.
double fc_control_reduction(double error_ratio);
double fc_control_growth(double error_ratio);

#endif
