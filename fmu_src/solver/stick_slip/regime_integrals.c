#include "solver/stick_slip/regime_integrals.h"

#include <assert.h>
#include <math.h>

#include "solver/panels/nodes.h"
#include "solver/panels/panel.h"
#include "solver/panels/panel_tables.h"
#include "solver/solver.h"

// The longest panels of n nodes, in smooth times, for k digits. Derived but for the factor 1, by hand: n 10^(-k / 2n), the error
// falling with the length to the power 2n.
enum { GAUSS_RULES = 4, MOST_DIGITS = 13 };
static const double LONGEST[GAUSS_RULES][MOST_DIGITS + 1] = {
    {4, 3, 2.25, 1.69, 1.26, 0.949, 0.711, 0.533, 0.4, 0.3, 0.225, 0.169, 0.126, 0.0949},
    {6, 4.95, 4.09, 3.37, 2.78, 2.3, 1.9, 1.57, 1.29, 1.07, 0.881, 0.727, 0.6, 0.495},
    {8, 6.93, 6, 5.2, 4.5, 3.9, 3.37, 2.92, 2.53, 2.19, 1.9, 1.64, 1.42, 1.23},
    {12, 10.9, 9.9, 9, 8.18, 7.43, 6.75, 6.13, 5.57, 5.06, 4.6, 4.18, 3.79, 3.45},
};

// No panel is longer than this part of the time to a zero of E or the load, where ln g has a pole, which the longest panels
// for few digits would reach. By hand: this far from it (5/3 of half the panel's length, from its middle) the error of n nodes falls
// like 3^(-2n).
static const double WAY_TO_POLE = 0.75;

FcIntegrator fc_integrator(const FcScene* scene, double smooth_time, double tolerance) {
    int digits = -1;
    for (double reached = 1.0; reached > tolerance && digits < MOST_DIGITS; reached *= 0.1) {
        digits++;
    }
    return (FcIntegrator){.scene = scene, .smooth_time = smooth_time, .digits = digits > 0 ? digits : 0};
}

// The panel that starts at t.
typedef struct {
    int rule;
    double start, length; // s
    double end;           // s
} Panel;

// The longest panel from t on [s] that ends well before a zero of E or the load.
static double longest_before_pole(const FcDrive* drive, double t) {
    return WAY_TO_POLE / fmax(fc_drive_E_growth(drive, t), fc_drive_load_growth(drive, t));
}

// Where V grazes zero |V| is at most this part of V_1. By hand: less breaks the work's accuracy there, more costs nodes.
static const double GRAZES = 0.05;

static bool grazes(const FcDrive* drive, double t) {
    const double most = GRAZES * drive->vibration.V_1;
    return fabs(fabs(drive->V.value + drive->V.rate * t) - drive->vibration.V_1) < most &&
           fabs(fc_drive_V(drive, t)) < most;
}

// The error of the work counts over the path, which is far shorter than V and V_1 are where V grazes zero.
static FcIntegrator where_it_grazes(const FcIntegrator* integrator, double start, double end) {
    const FcDrive* drive = &integrator->scene->drive;
    FcIntegrator finer = *integrator;
    if (grazes(drive, start) && grazes(drive, 0.5 * (start + end)) && grazes(drive, end)) {
        const double fastest = fmax(fabs(fc_drive_V(drive, start)), fabs(fc_drive_V(drive, end)));
        double speed = drive->vibration.V_1;
        for (; fastest < speed && finer.digits < MOST_DIGITS; speed *= 0.1) {
            finer.digits++;
        }
    }
    return finer;
}

static Panel panel_at(const FcIntegrator* integrator, double t, double end) {
    const FcScene* scene = integrator->scene;
    double smooth_time = integrator->smooth_time;
    if (!(smooth_time > 0.0)) {
        const FcPhase at_t = fc_drive_phase(&scene->drive, t);
        const FcBoundMotion at = {.t = t,
                                  .V = fc_drive_V_at_phase(&scene->drive, t, at_t),
                                  .d = fc_scene_d_at_phase(scene, t, at_t),
                                  .d_rate = fc_scene_d_rate_at_phase(scene, t, at_t)};
        smooth_time = fc_bound_smooth_time(scene, &at);
    }
    const double left = end - t;
    const double longest = fmin(LONGEST[GAUSS_RULES - 1][integrator->digits] * smooth_time,
                                longest_before_pole(&scene->drive, t));
    const double count = fmax(1.0, ceil(left / longest));
    Panel panel = {.start = t, .length = left / count, .end = end};
    while (panel.length > LONGEST[panel.rule][integrator->digits] * smooth_time &&
           panel.rule < GAUSS_RULES - 1) {
        panel.rule++;
    }
    if (count > 1.0 && t + panel.length > t) {
        panel.end = t + panel.length;
    }
    return panel;
}

// The Gauss rules there are, and their nodes.
static const FcGaussRule* const GAUSS_RULE[GAUSS_RULES] = {&FC_GAUSS_4, &FC_GAUSS_6, &FC_GAUSS_8,
                                                           &FC_GAUSS_12};
static const int GAUSS_NODES[GAUSS_RULES] = {4, 6, 8, 12};

static FcMap stick_panel(const FcScene* scene, const Panel* panel) {
    const FcGaussRule* rule = GAUSS_RULE[panel->rule];
    const int n = GAUSS_NODES[panel->rule];
    const double h = panel->length;
    FcNodeCoefficients at;
    fc_node_coefficients(scene, panel->start, h, rule->node, n, &at);
    double x[FC_MOST_NODES] = {0.0};
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++) {
            x[i] += rule->integral[j][i] * at.V[j];
        }
    }
    FcMap map = {.offset = h * fc_dot(n, rule->weight, at.V)};
    for (int i = 0; i < n; i++) {
        const double slope = rule->weight[i] * h * at.sigma[i];
        const double offset = slope * h * x[i];
        map.impulse_slope += slope;
        map.impulse_offset += offset;
        map.work_slope += slope * at.V[i];
        map.work_offset += offset * at.V[i];
    }
    return map;
}

FcMap fc_stick_map(const FcIntegrator* integrator, double start, double end, double x, double* evaluations) {
    assert(end >= start);
    const FcScene* scene = integrator->scene;
    const FcDrive* drive = &scene->drive;
    FcMap map = fc_map_identity();
    if (fc_scene_stiffness_is_constant(scene)) {
        const double sigma = scene->at_E.model == FC_CONTACT_CONSTANT ? scene->at_E.stiffness_0
                                                                      : fc_scene_stiffness(scene, start);
        map.impulse_slope = sigma * (end - start);
        map.impulse_offset = sigma * fc_drive_displacement_integral(drive, start, end);
        map.work_slope = sigma * x;
        map.work_offset = 0.5 * sigma * x * x;
        *evaluations += 1.0;
    } else {
        const FcIntegrator of_work = where_it_grazes(integrator, start, end);
        for (double t = start; t < end && *evaluations <= FC_MOST_EVALUATIONS;) {
            const Panel panel = panel_at(&of_work, t, end);
            const FcMap next = stick_panel(scene, &panel);
            fc_map_append(&map, &next);
            *evaluations += GAUSS_NODES[panel.rule];
            t = panel.end;
        }
    }
    map.offset = x;
    map.drag_offset = scene->friction->sigma_1 != 0.0 ? fc_drive_square(drive, start, end) : 0.0;
    return map;
}

// Adds the panel's part; where the rates of the bound count, what it recedes too.
static void add_slip_panel(const FcScene* scene, const Panel* panel, bool with_rates, FcSlipIntegrals* sum,
                           double* evaluations) {
    const FcGaussRule* rule = GAUSS_RULE[panel->rule];
    const int n = GAUSS_NODES[panel->rule];
    const double h = panel->length;
    FcNodeCoefficients at;
    fc_node_coefficients(scene, panel->start, h, rule->node, n, &at);
    for (int i = 0; i < n; i++) {
        const double limit = rule->weight[i] * h * at.limit[i];
        sum->limit += limit;
        sum->limit_V += limit * at.V[i];
        if (with_rates) {
            const double recedes = fc_bound_motion(scene, panel->start + (0.5 + rule->node[i]) * h).D_rate;
            sum->limit_recedes += limit * recedes;
            sum->V_recedes += rule->weight[i] * h * at.V[i] * recedes;
        }
    }
    *evaluations += with_rates ? 2.0 * n : n;
}

static FcSlipIntegrals quadrature_of_slip(const FcIntegrator* integrator, double start, double end,
                                          bool with_rates, double* evaluations) {
    FcSlipIntegrals sum = {0};
    const FcIntegrator of_work = where_it_grazes(integrator, start, end);
    for (double t = start; t < end && *evaluations <= FC_MOST_EVALUATIONS;) {
        const Panel panel = panel_at(&of_work, t, end);
        add_slip_panel(integrator->scene, &panel, with_rates, &sum, evaluations);
        t = panel.end;
    }
    return sum;
}

// Whether D is a function of the separation alone.
static bool bound_follows_d(const FcScene* scene) {
    return !scene->floats && scene->drive.E.rate == 0.0 && !fc_has_stribeck_curve(scene->friction);
}

// Whether g stands still.
static bool limit_is_constant(const FcScene* scene) {
    return fc_scene_limit_is_constant(scene) &&
           (!fc_has_stribeck_curve(scene->friction) || fc_drive_V_is_constant(&scene->drive));
}

// Integral of g dD along the bound up to here, g following the load and D the separation:
//
//     Constant     g = sigma D                          sigma D^2 / 2
//     Asperities   g = g_0 e,  D = g d^3 / (s_0 e^2)    g_0^2 / s_0 (d^3 + decay d^4 / 4),      e = e^(-decay d)
static double receding_work(const FcScene* scene, const FcBoundMotion* at) {
    const FcContactAtModulus* c = &scene->at_E;
    if (c->model == FC_CONTACT_CONSTANT) {
        return 0.5 * c->stiffness_0 * at->D * at->D;
    }
    const double g_0 = scene->friction->mu * c->load_0;
    return g_0 / c->stiffness_0 * g_0 * at->d * at->d * at->d * (1.0 + 0.25 * c->decay * at->d);
}

// For g and V alone: with asperities ln sigma moves with d at least twice as fast as ln g.
static FcIntegrator integrator_of_limit(const FcIntegrator* integrator) {
    FcIntegrator of_limit = *integrator;
    if (integrator->scene->at_E.model == FC_CONTACT_ASPERITIES && integrator->smooth_time > 0.0) {
        of_limit.smooth_time = 2.0 / (1.0 / integrator->smooth_time + integrator->scene->drive.omega);
    }
    return of_limit;
}

// The error of the heat counts over the path, and D may move by much more than that.
static FcIntegrator integrator_of_heat(const FcIntegrator* integrator, const FcBoundMotion* start,
                                       const FcBoundMotion* end) {
    FcIntegrator of_heat = *integrator;
    const double D_moves = end->D - start->D;
    double path = fc_drive_largest_speed(&integrator->scene->drive, end->t) * (end->t - start->t);
    while (path < fabs(D_moves) && of_heat.digits < MOST_DIGITS) {
        path *= 10.0;
        of_heat.digits++;
    }
    return of_heat;
}

FcSlipIntegrals fc_limit_integrals(const FcIntegrator* integrator, double start, double end,
                                   double* evaluations) {
    assert(end >= start);
    const FcScene* scene = integrator->scene;
    if (limit_is_constant(scene)) {
        const double limit = fc_scene_coefficients(scene, start).limit;
        *evaluations += 1.0;
        return (FcSlipIntegrals){.limit = limit * (end - start),
                                 .limit_V = limit * fc_drive_displacement(&scene->drive, start, end)};
    }
    const FcIntegrator of_limit = integrator_of_limit(integrator);
    return quadrature_of_slip(&of_limit, start, end, false, evaluations);
}

void fc_add_slip(const FcIntegrator* integrator, double side, const FcBoundMotion* start,
                 const FcBoundMotion* end, FcStepResult* result) {
    assert(side == 1.0 || side == -1.0);
    const FcScene* scene = integrator->scene;
    const bool damps = scene->friction->sigma_1 != 0.0;
    const bool bound_moves = !fc_bound_is_constant(scene);
    const bool limit_moves = !limit_is_constant(scene);
    FcSlipIntegrals sum;
    if (bound_moves && (damps || (limit_moves && !bound_follows_d(scene)))) {
        const FcIntegrator of_heat = integrator_of_heat(integrator, start, end);
        sum = quadrature_of_slip(&of_heat, start->t, end->t, true, &result->evaluations);
    } else {
        sum = fc_limit_integrals(integrator, start->t, end->t, &result->evaluations);
    }
    if (!limit_moves) {
        sum.limit_recedes = start->limit * (end->D - start->D);
    } else if (bound_moves && bound_follows_d(scene)) {
        sum.limit_recedes = receding_work(scene, end) - receding_work(scene, start);
    }
    result->delta = side * end->D;
    result->impulse += side * sum.limit;
    result->work += side * sum.limit_V;
    result->heat += side * sum.limit_V - sum.limit_recedes;
    result->drag += damps ? side * sum.V_recedes : 0.0;
}
