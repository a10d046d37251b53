#include "solver/regime_integrals.h"

#include <math.h>

#include "solver/bound.h"
#include "solver/gauss_legendre.h"
#include "solver/solver.h"

// The longest panels of 8, 12 and 16 nodes, in smooth times: errors are then below 1e-13.
static const double SHORT_PANEL = 1.5;
static const double MIDDLE_PANEL = 3.5;
static const double LONG_PANEL = 6.0;

// The panel that starts at t.
typedef struct {
    const FcQuadrature* rule;
    double middle, half_length; // s
    double end;                 // s
} Panel;

static Panel panel_at(const FcScene* scene, double t, double end) {
    const double d = fc_scene_d(scene, t);
    const double smooth_time = fc_bound_smooth_time(scene, t, d, fc_scene_d_rate(scene, t));
    const double left = end - t;
    const double count = ceil(left / (LONG_PANEL * smooth_time));
    const double length = count > 1.0 ? left / count : left;
    const FcQuadrature* rule = length > MIDDLE_PANEL * smooth_time  ? &FC_GAUSS_16
                               : length > SHORT_PANEL * smooth_time ? &FC_GAUSS_12
                                                                    : &FC_GAUSS_8;
    return (Panel){
        .rule = rule,
        .middle = t + 0.5 * length,
        .half_length = 0.5 * length,
        .end = count > 1.0 && t + length > t ? t + length : end,
    };
}

static int node_count(const Panel* panel) { return 2 * panel->rule->half_count; }

// Nodes come in pairs around the middle.
static double node_time(const Panel* panel, int i) {
    const double offset = panel->half_length * panel->rule->node[i / 2];
    return i % 2 == 0 ? panel->middle - offset : panel->middle + offset;
}

static double node_weight(const Panel* panel, int i) {
    return panel->half_length * panel->rule->weight[i / 2];
}

static void add_stick_panel(const FcScene* scene, const FcPath* path, const Panel* panel,
                            FcStickIntegrals* sum) {
    for (int i = 0; i < node_count(panel); i++) {
        const double t = node_time(panel, i);
        const FcBoundMotion at = fc_bound_motion(scene, t);
        const double sigma = node_weight(panel, i) * at.sigma;
        const double x = fc_path_at_phase(path, t, at.sin_theta);
        sum->impulse_slope += sigma;
        sum->impulse_offset += sigma * x;
        sum->work_slope += sigma * at.V;
        sum->work_offset += sigma * at.V * x;
    }
}

FcStickIntegrals fc_stick_integrals(const FcScene* scene, const FcPath* path, double end, double x_end,
                                    double* evaluations) {
    FcStickIntegrals sum = {0};
    if (scene->friction->sigma_1 != 0.0) {
        sum.drag = fc_drive_square(&scene->drive, path->start, end);
    }
    if (fc_bound_stiffness_is_constant(scene)) {
        const double sigma = fc_scene_stiffness(scene, path->start);
        sum.impulse_slope = sigma * (end - path->start);
        sum.impulse_offset = sigma * fc_path_integral(path, end);
        sum.work_slope = sigma * x_end;
        sum.work_offset = 0.5 * sigma * x_end * x_end;
        *evaluations += 1.0;
        return sum;
    }
    for (double t = path->start; t < end && *evaluations <= FC_MOST_EVALUATIONS;) {
        const Panel panel = panel_at(scene, t, end);
        add_stick_panel(scene, path, &panel, &sum);
        *evaluations += 1.0 + node_count(&panel);
        t = panel.end;
    }
    return sum;
}

// Slipping along +D.
typedef struct {
    double limit;         // N s   integral of g
    double limit_V;       // J     integral of g V
    double limit_recedes; // J     integral of g D'
    double V_recedes;     // m2/s  integral of V D'
} SlipIntegrals;

static void add_slip_panel(const FcScene* scene, const Panel* panel, SlipIntegrals* sum) {
    for (int i = 0; i < node_count(panel); i++) {
        const FcBoundMotion at = fc_bound_motion(scene, node_time(panel, i));
        const double weight = node_weight(panel, i);
        sum->limit += weight * at.limit;
        sum->limit_V += weight * at.limit * at.V;
        sum->limit_recedes += weight * at.limit * at.D_rate;
        sum->V_recedes += weight * at.V * at.D_rate;
    }
}

FcTotals fc_slip_totals(const FcScene* scene, double side, double start, double end, double D_start,
                        double D_end, double* evaluations) {
    const bool bound_moves = !fc_bound_is_constant(scene);
    const bool limit_moves = !fc_bound_limit_is_constant(scene);
    SlipIntegrals sum = {0};
    if (limit_moves || (bound_moves && scene->friction->sigma_1 != 0.0)) {
        for (double t = start; t < end && *evaluations <= FC_MOST_EVALUATIONS;) {
            const Panel panel = panel_at(scene, t, end);
            add_slip_panel(scene, &panel, &sum);
            *evaluations += 1.0 + node_count(&panel);
            t = panel.end;
        }
    }
    if (!limit_moves) {
        const double g = fc_scene_coefficients(scene, start).limit;
        sum.limit = g * (end - start);
        sum.limit_V = g * fc_drive_displacement(&scene->drive, start, end);
        sum.limit_recedes = g * (D_end - D_start);
        *evaluations += 1.0;
    }
    return (FcTotals){
        .impulse = side * sum.limit,
        .work = side * sum.limit_V,
        .heat = side * sum.limit_V - sum.limit_recedes,
        .drag = scene->friction->sigma_1 != 0.0 ? side * sum.V_recedes : 0.0,
    };
}
