// The least evaluations with which the default's panels could do a vibration period, if the size of their errors were known.
//
//     least_evaluations [TOLERANCES]     three tables, for each stiffness and tolerance: evaluations and time
//
// Five tolerances; 1e-2, 1e-3, 1e-4, 1e-6 and 1e-9 if none are given.
//
// For one scene, a dense grid in each stretch between two reversals, graded towards both; every panel between two grid
// points, of every kind and number of nodes, and its true errors against a fine solution: in the force at the interval's
// end, in the mean, in work and heat, with what the bristle keeps of them. Then the cheapest sequence of panels whose
// errors sum up to no more than the tolerance (dynamic programming; the price of an error is found by bisection).
//
// An error changes its sign here and there, and a panel that ends next to such a place is right by luck. So a panel counts
// with the worst of its neighbours, whose ends are the next points of the grid, and of nearby phases of the
// separation; the last column is the least with luck. Real step control knows bounds or estimates, so it can't do as well.
//
// The second table is what the best plan could do with the bounds and estimates that the default has: the fewest evaluations
// of panels that these let pass, and which are accurate without luck (some pass that aren't).
//
// A panel of few nodes is not much cheaper than one of more, one that is not judged cheaper than one that is. So the third
// table has times: of the panels that the default takes, of the cheapest that pass, and of the cheapest if their errors were
// known and none had to be judged; and the time of all that the default does; the mean over three starts. Each kind of panel
// is timed in one scene.
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "counted_panels.h"
#include "job.h"
#include "solver/bounded_panel.h"
#include "solver/collocation.h"
#include "solver/gauss_panel.h"
#include "solver/judge.h"
#include "solver/mesh.h"
#include "solver/radau_panel.h"
#include "solver/settled_panel.h"
#include "table_1.h"

static const double PERIOD = 5e-5; // s
static const double F_C = 55.0;    // N

// When the period begins, in periods; the evaluations are those of the first.
enum { STARTS = 3 };
static const double START[STARTS] = {0.0, 0.23, 0.27};

enum { MOST_POINTS = 160, STRETCHES = 3 };

enum { TOLERANCES = 5 };
static double tolerances[TOLERANCES] = {1e-2, 1e-3, 1e-4, 1e-6, 1e-9};

typedef struct {
    FcContactParameters contact;
    FcFriction friction;
    FcScene scene;
} Slider;

static void make(Slider* slider, double sigma, double start, double phase_d) {
    slider->contact = table_1(FC_CONTACT_ASPERITIES, FC_CONTACT_SEPARATION);
    slider->contact.stiffnessScale = sigma / 5.743065402e12;
    slider->friction =
        (FcFriction){.model = FC_DAHL, .limit = FC_LIMIT_CONSTANT, .staticRatio = 1.0, .V_S = 1e-3};
    const double E = 58.556936170e9;
    const FcContactAtModulus at_E = fc_contact_at_modulus(&slider->contact, E);
    const FcVibration vibration = {.f = 1.0 / PERIOD, .V_1 = 1.44, .a_d = 1.1e-6, .phase_d = phase_d};
    const FcDrive drive =
        fc_drive_make((FcLinearInput){5e-3, 0.0}, (FcLinearInput){14e-6, 0.0}, (FcLinearInput){E, 0.0},
                      (FcLinearInput){0.0, 0.0}, vibration, start * PERIOD, 0.0);
    slider->scene = fc_scene_make(&slider->contact, &at_E, &slider->friction, F_C, &drive);
}

typedef enum { REFUSED, JUDGED, BOUNDED } Passes;

// What a panel of each kind costs, and a node of a closed form: 1 for each evaluation, or a time.
typedef struct {
    double judged[KINDS];
    double bounded[KINDS]; // not judged; a Radau panel always is
    double node;
} Costs;
static const Costs EVALUATIONS = {{5, 9, 4, 6, 8, 12}, {5, 9, 4, 6, 8, 12}, 1.0};

// What is asked for: the force at the interval's end, the mean force, the work and the heat.
enum { RESULTS = 4 };

// One stretch: grid, fine solution, and what a unit of force at a grid point is worth in the results.
typedef struct {
    FcStretch stretch;
    double sign;
    int count;
    double t[MOST_POINTS];                         // s
    FcStepResult at[MOST_POINTS];                  // of the fine solution, since the stretch's start
    double sigma[MOST_POINTS];                     // N/m
    double worth[MOST_POINTS][RESULTS];            // 1
    double error[MOST_POINTS][MOST_POINTS][KINDS]; // 1, of a panel, from one point to another
    double settled[MOST_POINTS];                   // 1, of the closed form, from a point to the stretch's end
    double to_settle[MOST_POINTS];                 // evaluations that it takes
    // How the default would let that panel pass at each tolerance, and whether the closed form.
    Passes passes[TOLERANCES][MOST_POINTS][MOST_POINTS][KINDS];
    bool settles[TOLERANCES][MOST_POINTS];
} Grid;
static Grid grids[STRETCHES];

// The displacement is known, which puts right what its quadrature misses: the path, and the work of a force at its limit.
static FcMap panel_of(const Grid* grid, const FcScene* scene, int kind, double t, double h, double delta) {
    const FcTrajectories from = {.delta_0 = delta, .speed = 1.0};
    FcPanel panel;
    if (kind < RADAU_KINDS) {
        fc_radau_panel(scene, NODES[kind], t, h, grid->sign, &from, &panel);
    } else {
        fc_gauss_panel(scene, t, h, NODES[kind], &from, &panel);
    }
    const double missed = fc_drive_displacement(&scene->drive, t, t + h) - panel.displacement;
    FcMap map = panel.map;
    if (kind < RADAU_KINDS) {
        map.work_offset += grid->sign * F_C * missed;
        map.heat_offset += grid->sign * F_C * missed;
    } else {
        map.offset += (1.0 - map.relaxation) * missed;
    }
    return map;
}

static double end_of(const FcMap* map, double delta) { return (1.0 - map->relaxation) * delta + map->offset; }

// Between two grid points: sixteen panels of nine stages.
static FcMap fine(const Grid* grid, const FcScene* scene, double t, double h, double delta) {
    FcMap map = fc_map_identity();
    for (int i = 0; i < 16; i++) {
        const FcMap part =
            panel_of(grid, scene, RADAU_KINDS - 1, t + i * h / 16, h / 16, end_of(&map, delta));
        fc_map_append(&map, &part);
    }
    return map;
}

static void add(Grid* grid, double t) {
    if (t > grid->stretch.start && t < grid->stretch.end && grid->count < MOST_POINTS - 1) {
        int i = grid->count++;
        for (; i > 0 && grid->t[i - 1] > t; i--) {
            grid->t[i] = grid->t[i - 1];
        }
        grid->t[i] = t;
    }
}

static void make_grid(Grid* grid) {
    const FcStretch* s = &grid->stretch;
    const double length = s->end - s->start;
    grid->count = 1;
    grid->t[0] = s->start;
    for (double x = 0.5; x * s->w_a < 0.6 * length; x *= 1.22) {
        add(grid, s->start + x * s->w_a);
    }
    for (double x = 0.35; x * s->w_b < 0.6 * length; x *= 1.25) {
        add(grid, s->end - x * s->w_b);
    }
    for (int i = 1; i < 24; i++) {
        add(grid, s->start + i * length / 24);
    }
    grid->t[grid->count++] = s->end;
}

static void solve_finely(Grid* grid, const FcScene* scene, double delta) {
    grid->at[0] = (FcStepResult){.delta = delta};
    for (int i = 0; i < grid->count; i++) {
        grid->sigma[i] = fc_scene_stiffness(scene, grid->t[i]);
        if (i + 1 < grid->count) {
            const double h = grid->t[i + 1] - grid->t[i];
            const FcMap map = fine(grid, scene, grid->t[i], h, grid->at[i].delta);
            grid->at[i + 1] = grid->at[i];
            fc_map_apply(&map, &grid->at[i + 1]);
        }
    }
}

// What work and heat are relative to, over F_C [m].
static double longest_path(const FcScene* scene) {
    return fc_drive_largest_speed(&scene->drive, PERIOD) * PERIOD;
}

// Backwards: what is left of a deviation of the force at the end, and its part of the mean, the work and the heat.
static void find_worth(Grid* grid, const FcScene* scene, const double* after) {
    const int last = grid->count - 1;
    const double path = longest_path(scene);
    for (int k = 0; k < RESULTS; k++) {
        grid->worth[last][k] = after[k];
    }
    for (int i = last - 1; i >= 0; i--) {
        const double h = grid->t[i + 1] - grid->t[i];
        const FcMap map = fine(grid, scene, grid->t[i], h, 0.0);
        const double kept = (1.0 - map.relaxation) * grid->sigma[i + 1] / grid->sigma[i];
        const double of_heat = 2.0 * map.heat_square * grid->at[i].delta + map.heat_slope;
        const double here[RESULTS] = {0.0, map.impulse_slope / PERIOD, map.work_slope / path, of_heat / path};
        for (int k = 0; k < RESULTS; k++) {
            grid->worth[i][k] = kept * grid->worth[i + 1][k] + here[k] / grid->sigma[i];
        }
    }
}

// The largest of the errors of the results from grid point i to j, over F_C.
static double error_of(const Grid* grid, const FcScene* scene, int i, int j, const FcMap* map) {
    const double path = longest_path(scene);
    FcStepResult got = grid->at[i];
    fc_map_apply(map, &got);
    const FcStepResult* right = &grid->at[j];
    const double force = fabs(got.delta - right->delta) * grid->sigma[j];
    const double means[RESULTS] = {0.0, (got.impulse - right->impulse) / PERIOD,
                                   (got.work - right->work) / path, (got.heat - right->heat) / path};
    double error = 0.0;
    for (int k = 0; k < RESULTS; k++) {
        const double of_result = (force * fabs(grid->worth[j][k]) + fabs(means[k])) / F_C;
        error = isfinite(of_result) ? fmax(error, of_result) : INFINITY;
    }
    return error;
}

// The closed form from that grid point to the stretch's end.
static bool settle(const Grid* grid, const FcScene* scene, const FcMesh* mesh, int i, FcPanel* rest,
                   double* evaluations) {
    const FcCoefficients here = fc_scene_coefficients(scene, grid->t[i]);
    const double lag = fabs(grid->sign * here.limit - here.sigma * grid->at[i].delta) / F_C;
    const FcPlace at = {.t = grid->t[i], .rate = -fc_coefficients_rate(&here), .lag = lag};
    double too_long = INFINITY;
    const FcSettledStart from = {.scene = scene,
                                 .mesh = mesh,
                                 .stretch = &grid->stretch,
                                 .at = &at,
                                 .end = grid->stretch.end,
                                 .sign = grid->sign,
                                 .sigma = here.sigma,
                                 .limit = here.limit,
                                 .too_long = &too_long};
    return fc_settled_panel(&from, rest, evaluations);
}

static void judge_panels(Grid* grid, const FcScene* scene, const FcMesh* mesh) {
    for (int i = 0; i < grid->count; i++) {
        for (int j = i + 1; j < grid->count; j++) {
            for (int kind = 0; kind < KINDS; kind++) {
                const double h = grid->t[j] - grid->t[i];
                const FcMap map = panel_of(grid, scene, kind, grid->t[i], h, grid->at[i].delta);
                double* error = &grid->error[i][j][kind];
                *error = fmax(*error, error_of(grid, scene, i, j, &map));
            }
        }
        FcPanel rest;
        double taken = 0.0;
        const bool settles = settle(grid, scene, mesh, i, &rest, &taken);
        const double error = settles ? error_of(grid, scene, i, grid->count - 1, &rest.map) : INFINITY;
        grid->settled[i] = fmax(grid->settled[i], error);
        grid->to_settle[i] = fmax(grid->to_settle[i], taken);
    }
}

// How the default's bound, or its estimates, let that panel pass.
static Passes passes(const Grid* grid, const FcScene* scene, const FcMotion* motion, int i, int j, int kind,
                     double tolerance) {
    const FcStretch* stretch = &grid->stretch;
    const double t = grid->t[i];
    const double h = grid->t[j] - t;
    const FcTrajectories from = {.delta_0 = grid->at[i].delta,
                                 .speed = fc_drive_largest_speed(&scene->drive, PERIOD),
                                 .held = kind < RADAU_KINDS ? grid->sign * F_C : 0.0};
    FcPanel panel;
    if (kind < RADAU_KINDS) {
        fc_radau_panel(scene, NODES[kind], t, h, grid->sign, &from, &panel);
        const FcErrorLife life = {.lives = grid->worth[j][1], .lasts = h / PERIOD, .grows = 1.0};
        const FcExcess over = fc_radau_panel_excess(&panel, &life, tolerance * F_C);
        return fmax(over.mean, grid->worth[j][0] * over.end) <= 1.0 ? JUDGED : REFUSED;
    }
    fc_gauss_panel(scene, t, h, NODES[kind], &from, &panel);
    const double X = fc_drive_displacement(&scene->drive, t, t + h);
    const int needed = fc_bounded_panel_nodes(motion, h, X, panel.z, &from);
    if (needed > 0 && needed <= NODES[kind]) {
        return BOUNDED;
    }
    const double share = h / (stretch->end - stretch->start);
    return fc_gauss_panel_is_accurate(&panel, NODES[kind], share, false, 0.0, tolerance * F_C) ? JUDGED
                                                                                               : REFUSED;
}

static void ask_for_passes(Grid* grid, const FcScene* scene, int k) {
    const double stiffness = fc_scene_largest_stiffness(scene, PERIOD);
    const FcMotion motion = fc_motion(scene, PERIOD, stiffness, tolerances[k] * F_C);
    const FcMesh mesh = fc_mesh_make(scene, PERIOD, tolerances[k]);
    for (int i = 0; i < grid->count; i++) {
        for (int j = i + 1; j < grid->count; j++) {
            for (int kind = 0; kind < KINDS; kind++) {
                grid->passes[k][i][j][kind] = passes(grid, scene, &motion, i, j, kind, tolerances[k]);
            }
        }
        FcPanel rest;
        double taken = 0.0;
        grid->settles[k][i] = settle(grid, scene, &mesh, i, &rest, &taken);
    }
}

// Of the tolerance that the error of a panel which passes may be.
static const double SHARE = 0.2;

// What the cheapest panels that pass cost.
static double cheapest_passing(const Grid* grid, int k, const Costs* costs) {
    double cost[MOST_POINTS];
    const int last = grid->count - 1;
    cost[last] = 0.0;
    for (int i = last - 1; i >= 0; i--) {
        cost[i] = grid->settles[k][i] ? costs->node * grid->to_settle[i] : INFINITY;
        for (int j = i + 1; j <= last; j++) {
            for (int kind = 0; kind < KINDS; kind++) {
                const Passes how = grid->passes[k][i][j][kind];
                if (how != REFUSED && grid->error[i][j][kind] <= SHARE * tolerances[k]) {
                    const double of_panel = how == JUDGED ? costs->judged[kind] : costs->bounded[kind];
                    cost[i] = fmin(cost[i], of_panel + cost[j]);
                }
            }
        }
    }
    return cost[0];
}

// What is right by luck counts as its neighbours do.
static void take_luck_away(Grid* grid) {
    static Grid was;
    was = *grid;
    const int last = grid->count - 1;
    for (int i = 0; i < last; i++) {
        for (int j = i + 1; j <= last; j++) {
            for (int k = (i > 0 ? i - 1 : i); k <= (i > 0 ? i + 1 : i); k++) {
                for (int l = (j < last ? j - 1 : j); l <= (j < last ? j + 1 : j); l++) {
                    for (int kind = 0; k < l && kind < KINDS; kind++) {
                        grid->error[i][j][kind] = fmax(grid->error[i][j][kind], was.error[k][l][kind]);
                    }
                }
            }
        }
        grid->settled[i] = fmax(grid->settled[i], was.settled[i + 1 < last ? i + 1 : i]);
    }
}

// The cheapest sequence of panels where an error costs `price`: what it costs and the sum of its errors.
static double cheapest(const Grid* grid, const Costs* costs, double price, double* error) {
    double whole[MOST_POINTS]; // with the price of the errors
    double errors[MOST_POINTS];
    double cost[MOST_POINTS];
    const int last = grid->count - 1;
    whole[last] = errors[last] = cost[last] = 0.0;
    for (int i = last - 1; i >= 0; i--) {
        errors[i] = grid->settled[i];
        cost[i] = costs->node * grid->to_settle[i];
        whole[i] = cost[i] + price * errors[i];
        for (int j = i + 1; j <= last; j++) {
            for (int kind = 0; kind < KINDS; kind++) {
                const double of_panel = grid->error[i][j][kind];
                const double with_panel = costs->bounded[kind] + price * of_panel + whole[j];
                if (with_panel < whole[i]) {
                    whole[i] = with_panel;
                    errors[i] = of_panel + errors[j];
                    cost[i] = costs->bounded[kind] + cost[j];
                }
            }
        }
    }
    *error += errors[0];
    return cost[0];
}

static double least(double tolerance, int stretches, const Costs* costs) {
    double low = 0.0; // ln of the price
    double high = 60.0;
    double found = INFINITY;
    for (int k = 0; k < 60; k++) {
        const double middle = 0.5 * (low + high);
        double error = 0.0;
        double cost = 0.0;
        for (int i = 0; i < stretches; i++) {
            cost += cheapest(&grids[i], costs, exp(middle), &error);
        }
        if (error <= tolerance) {
            found = fmin(found, cost);
            high = middle;
        } else {
            low = middle;
        }
    }
    return found;
}

static double settled_deflection(const FcScene* scene) {
    double delta = 0.0;
    const FcSolverOptions tight = {.tolerance = 1e-13};
    double evaluations = 0.0;
    for (int period = 0; period < 200; period++) {
        const FcMap map =
            fc_collocation_interval(scene, &tight, PERIOD, delta, FC_MAP_THIS_START, &evaluations);
        delta = end_of(&map, delta);
    }
    return delta;
}

// The grids of one period from the settled deflection. first: of several scenes that differ in the phase of d.
static int judge(const FcScene* scene, bool first) {
    const FcMesh mesh = fc_mesh_make(scene, PERIOD, 1e200); // accepts every closed form
    double delta = settled_deflection(scene);
    int count = 0;
    double start = 0.0;
    for (; start < PERIOD && count < STRETCHES; count++) {
        const FcDriveEvent event = fc_drive_next_event(&scene->drive, start, 2.0 * PERIOD);
        Grid* grid = &grids[count];
        if (first) {
            *grid = (Grid){.count = 0};
        }
        grid->stretch = (FcStretch){
            .start = start, .end = fmin(event.time, PERIOD), .event = event.time, .reversal = true};
        FcStretch* s = &grid->stretch;
        s->start_phase = fc_drive_phase(&scene->drive, s->start);
        s->end_phase = fc_drive_phase(&scene->drive, s->end);
        s->event_phase = event.phase;
        const FcVelocity at_start = fc_drive_velocity(&scene->drive, s->start);
        const FcVelocity at_event = fc_drive_velocity(&scene->drive, s->event);
        s->at_start = fc_scene_coefficients(scene, s->start);
        s->at_end = fc_scene_coefficients(scene, s->end);
        s->w_a = fc_mesh_layer(&at_start, s->at_start.sigma / s->at_start.limit);
        s->back = start > 0.0 ? s->w_a : fmax(s->w_a, fc_mesh_settled_back(&at_start));
        s->w_b = fc_mesh_layer(&at_event, s->at_end.sigma / s->at_end.limit);
        grid->sign = fc_sign(fc_drive_displacement(&scene->drive, s->start, s->end));
        if (first) {
            make_grid(grid);
        }
        solve_finely(grid, scene, delta);
        delta = grid->at[grid->count - 1].delta;
        start = s->end;
    }
    double after[RESULTS] = {1.0, 0.0, 0.0, 0.0};
    for (int i = count - 1; i >= 0; i--) {
        find_worth(&grids[i], scene, after);
        for (int k = 0; k < RESULTS; k++) {
            after[k] = grids[i].worth[0][k];
        }
        judge_panels(&grids[i], scene, &mesh);
    }
    return count;
}

static double evaluations_of_default(const FcScene* scene, double tolerance) {
    const FcSolverOptions options = {.tolerance = tolerance};
    double taken = 0.0;
    fc_collocation_interval(scene, &options, PERIOD, settled_deflection(scene), FC_MAP_THIS_START, &taken);
    return taken;
}

enum { TURNS = 7, TIMES = 20000 };
static volatile double used; // so that what is timed is done

// ns
static double time_of_panel(int kind, bool judged) {
    Slider slider;
    make(&slider, 6e6, 0.0, 0.7);
    const FcScene* scene = &slider.scene;
    const double start = fc_drive_next_event(&scene->drive, 0.0, PERIOD).time;
    const double h = 0.2 * PERIOD;
    const double sign = fc_sign(fc_drive_displacement(&scene->drive, start, start + h));
    double least_time = INFINITY;
    for (int turn = 0; turn < TURNS; turn++) {
        const double before = cpu_seconds();
        for (int i = 0; i < TIMES; i++) {
            const FcTrajectories from = {.delta_0 = 1e-6 + 1e-12 * i, .speed = 1.44, .held = sign * F_C};
            FcPanel panel;
            if (kind < RADAU_KINDS) {
                fc_radau_panel(scene, NODES[kind], start, h, sign, &from, &panel);
            } else if (judged) {
                fc_gauss_panel(scene, start, h, NODES[kind], &from, &panel);
            } else {
                fc_gauss_panel_unjudged(scene, start, h, NODES[kind], &from, &panel);
            }
            used = panel.map.offset;
        }
        least_time = fmin(least_time, cpu_seconds() - before);
    }
    return 1e9 * least_time / TIMES;
}

static Costs measured_times(void) {
    Costs costs;
    for (int kind = 0; kind < KINDS; kind++) {
        costs.judged[kind] = time_of_panel(kind, true);
        costs.bounded[kind] = time_of_panel(kind, false);
    }
    costs.node = costs.bounded[KINDS - 1] / NODES[KINDS - 1];
    return costs;
}

static double time_of_default(const FcScene* scene, double tolerance) {
    const FcSolverOptions options = {.tolerance = tolerance};
    const double delta = settled_deflection(scene);
    double least_time = INFINITY;
    for (int turn = 0; turn < TURNS; turn++) {
        const double before = cpu_seconds();
        for (int i = 0; i < TIMES / 4; i++) {
            double taken = 0.0;
            used = fc_collocation_interval(scene, &options, PERIOD, delta, FC_MAP_THIS_START, &taken).offset;
        }
        least_time = fmin(least_time, cpu_seconds() - before);
    }
    return 1e9 * least_time / (TIMES / 4);
}

static double time_of_its_panels(const FcScene* scene, double tolerance, const Costs* times) {
    const PanelCounts counts = count_panels(scene, tolerance, PERIOD, settled_deflection(scene));
    double sum = counts.other_evaluations * times->node;
    for (int kind = 0; kind < KINDS; kind++) {
        sum += counts.judged[kind] * times->judged[kind] + counts.bounded[kind] * times->bounded[kind];
    }
    return sum;
}

// Of a period at each tolerance: evaluations and times [ns].
typedef struct {
    double sigma;                     // N/m
    double taken[TOLERANCES];         // by the default
    double with_luck[TOLERANCES];     // the least of the scene itself
    double least[TOLERANCES];         // without luck
    double passing[TOLERANCES];       // of panels that pass
    double time[TOLERANCES];          // of the default
    double time_taken[TOLERANCES];    // by its panels
    double time_of_least[TOLERANCES]; // of panels, if errors were known
    double time_passing[TOLERANCES];
} Row;

static Row row_of(double sigma, double start, const Costs* times) {
    static const double PHASES[] = {0.7, 0.4, 0.55, 0.85, 1.0}; // of d, the scene's own first
    enum { PHASE_COUNT = 5 };
    Row row = {.sigma = sigma};
    int stretches = 0;
    for (int phase = 0; phase < PHASE_COUNT; phase++) {
        Slider slider;
        make(&slider, sigma, start, PHASES[phase]);
        const FcScene* scene = &slider.scene;
        stretches = judge(scene, phase == 0);
        for (int k = 0; phase == 0 && k < TOLERANCES; k++) {
            row.taken[k] = evaluations_of_default(scene, tolerances[k]);
            row.time[k] = time_of_default(scene, tolerances[k]);
            row.time_taken[k] = time_of_its_panels(scene, tolerances[k], times);
            row.with_luck[k] = least(tolerances[k], stretches, &EVALUATIONS);
            for (int i = 0; i < stretches; i++) {
                ask_for_passes(&grids[i], scene, k);
            }
        }
    }
    for (int i = 0; i < stretches; i++) {
        take_luck_away(&grids[i]);
    }
    for (int k = 0; k < TOLERANCES; k++) {
        row.least[k] = least(tolerances[k], stretches, &EVALUATIONS);
        row.time_of_least[k] = least(tolerances[k], stretches, times);
        for (int i = 0; i < stretches; i++) {
            row.passing[k] += cheapest_passing(&grids[i], k, &EVALUATIONS);
            row.time_passing[k] += cheapest_passing(&grids[i], k, times);
        }
    }
    return row;
}

static void add_times(Row* sum, const Row* part) {
    for (int k = 0; k < TOLERANCES; k++) {
        sum->time[k] += part->time[k];
        sum->time_taken[k] += part->time_taken[k];
        sum->time_of_least[k] += part->time_of_least[k];
        sum->time_passing[k] += part->time_passing[k];
    }
}

static void print_head(const char* of) {
    printf("%s\nsigma [N/m]", of);
    for (int k = 0; k < TOLERANCES; k++) {
        printf("              %.0e", tolerances[k]);
    }
    printf("\n");
}

int main(int argc, char** argv) {
    enum { ROWS = 9 };
    if (argc != 1 && argc != 1 + TOLERANCES) {
        fprintf(stderr, "least_evaluations takes %d tolerances, or none\n", TOLERANCES);
        return 2;
    }
    for (int k = 0; k + 1 < argc; k++) {
        tolerances[k] = strtod(argv[k + 1], NULL);
    }
    Row rows[ROWS];
    const Costs times = measured_times();
    double sigma = 6e4;
    for (int r = 0; r < ROWS; r++) {
        rows[r] = row_of(sigma, START[0], &times);
        for (int i = 1; i < STARTS; i++) {
            const Row later = row_of(sigma, START[i], &times);
            add_times(&rows[r], &later);
        }
        sigma *= 10.0;
    }
    print_head("The least if errors were known, of what the default takes (with luck)");
    for (int r = 0; r < ROWS; r++) {
        printf("%11.0e", rows[r].sigma);
        for (int k = 0; k < TOLERANCES; k++) {
            printf("  %4.0f of %4.0f (%3.0f)", rows[r].least[k], rows[r].taken[k], rows[r].with_luck[k]);
        }
        printf("\n");
    }
    print_head("\nThe least of panels that pass, of what the default takes");
    for (int r = 0; r < ROWS; r++) {
        printf("%11.0e", rows[r].sigma);
        for (int k = 0; k < TOLERANCES; k++) {
            printf("        %4.0f of %4.0f", rows[r].passing[k], rows[r].taken[k]);
        }
        printf("\n");
    }
    printf("\nTimes of panels [ns], judged and not:");
    for (int kind = 0; kind < KINDS; kind++) {
        printf("  %s %d %.0f, %.0f", kind < RADAU_KINDS ? "Radau" : "Gauss", NODES[kind], times.judged[kind],
               times.bounded[kind]);
    }
    print_head("\nTimes [ns]: the default's panels, the cheapest that pass, and if errors were known (all "
               "that the default does)");
    for (int r = 0; r < ROWS; r++) {
        printf("%11.0e", rows[r].sigma);
        for (int k = 0; k < TOLERANCES; k++) {
            printf("  %4.0f %4.0f %4.0f (%4.0f)", rows[r].time_taken[k] / STARTS,
                   rows[r].time_passing[k] / STARTS, rows[r].time_of_least[k] / STARTS,
                   rows[r].time[k] / STARTS);
        }
        printf("\n");
    }
    return 0;
}
