// The least evaluations with which the default's panels could do a vibration period, if their errors were known.
//
//     least_evaluations          a table: evaluations that the default takes, and the least, for each stiffness and tolerance
//
// For one scene, a dense grid in each stretch between two reversals, graded towards both; every panel between two grid
// points, of every kind and number of nodes, and its true error against a fine solution: in the force at the interval's
// end and in the mean, with what the bristle keeps of it. Then the cheapest sequence of panels whose errors sum up to no
// more than the tolerance (dynamic programming; the price of an error is found by bisection). Real step control knows
// estimates only, so it can't do as well: the table tells how much there is to be won by choosing panels better.
#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "solver/collocation.h"
#include "solver/gauss_panel.h"
#include "solver/mesh.h"
#include "solver/radau_panel.h"
#include "solver/settled_panel.h"
#include "table_1.h"

static const double PERIOD = 5e-5; // s
static const double F_C = 55.0;    // N

enum { MOST_POINTS = 160, KINDS = 7, STRETCHES = 3 };
static const int NODES[KINDS] = {3, 5, 9, 4, 6, 8, 12}; // Radau, then Gauss

typedef struct {
    FcContactParameters contact;
    FcFriction friction;
    FcScene scene;
} Slider;

static void make(Slider* slider, double sigma) {
    slider->contact = table_1(FC_CONTACT_ASPERITIES, FC_CONTACT_SEPARATION);
    slider->contact.stiffnessScale = sigma / 5.743065402e12;
    slider->friction =
        (FcFriction){.model = FC_DAHL, .limit = FC_LIMIT_CONSTANT, .staticRatio = 1.0, .V_S = 1e-3};
    const double E = 58.556936170e9;
    const FcContactAtModulus at_E = fc_contact_at_modulus(&slider->contact, E);
    const FcVibration vibration = {.f = 1.0 / PERIOD, .V_1 = 1.44, .a_d = 1.1e-6, .phase_d = 0.7};
    const FcDrive drive =
        fc_drive_make((FcLinearInput){5e-3, 0.0}, (FcLinearInput){14e-6, 0.0}, (FcLinearInput){E, 0.0},
                      (FcLinearInput){0.0, 0.0}, vibration, 0.0, 0.0);
    slider->scene = fc_scene_make(&slider->contact, &at_E, &slider->friction, F_C, &drive);
}

// One stretch: grid, fine solution, and what a unit of force at a grid point is worth at the interval's end and in the mean.
typedef struct {
    FcStretch stretch;
    double sign;
    int count;
    double t[MOST_POINTS];                         // s
    double delta[MOST_POINTS];                     // m
    double impulse[MOST_POINTS];                   // N s, since the stretch's start
    double sigma[MOST_POINTS];                     // N/m
    double to_end[MOST_POINTS];                    // 1
    double to_mean[MOST_POINTS];                   // 1
    double error[MOST_POINTS][MOST_POINTS][KINDS]; // 1, of a panel, from one point to another
    double settled[MOST_POINTS];                   // 1, of the closed form, from a point to the stretch's end
    double to_settle[MOST_POINTS];                 // evaluations that it takes
} Grid;
static Grid grids[STRETCHES];

static FcPanel panel_of(const Grid* grid, const FcScene* scene, int kind, double t, double h, double delta) {
    const FcTrajectories from = {.delta_0 = delta, .speed = 1.0};
    FcPanel panel;
    if (kind < 3) {
        fc_radau_panel(scene, NODES[kind], t, h, grid->sign, &from, &panel);
    } else {
        fc_gauss_panel(scene, t, h, NODES[kind], &from, &panel);
    }
    return panel;
}

static double end_of(const FcMap* map, double delta) { return (1.0 - map->relaxation) * delta + map->offset; }

static double impulse_of(const FcMap* map, double delta) {
    return map->impulse_slope * delta + map->impulse_offset;
}

// Between two grid points: sixteen panels of nine stages.
static FcMap fine(const Grid* grid, const FcScene* scene, double t, double h, double delta) {
    FcMap map = fc_map_identity();
    for (int i = 0; i < 16; i++) {
        const FcPanel panel = panel_of(grid, scene, 2, t + i * h / 16, h / 16, end_of(&map, delta));
        map = fc_map_compose(&map, &panel.map);
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
    grid->delta[0] = delta;
    grid->impulse[0] = 0.0;
    for (int i = 0; i < grid->count; i++) {
        grid->sigma[i] = fc_scene_stiffness(scene, grid->t[i]);
        if (i + 1 < grid->count) {
            const FcMap map = fine(grid, scene, grid->t[i], grid->t[i + 1] - grid->t[i], grid->delta[i]);
            grid->delta[i + 1] = end_of(&map, grid->delta[i]);
            grid->impulse[i + 1] = grid->impulse[i] + impulse_of(&map, grid->delta[i]);
        }
    }
}

// Backwards: what is left of a deviation, and its part of the mean.
static void worth(Grid* grid, const FcScene* scene, double end, double end_after, double mean_after) {
    const int last = grid->count - 1;
    grid->to_end[last] = end_after;
    grid->to_mean[last] = mean_after;
    for (int i = last - 1; i >= 0; i--) {
        const FcMap map = fine(grid, scene, grid->t[i], grid->t[i + 1] - grid->t[i], 0.0);
        const double kept = (1.0 - map.relaxation) * grid->sigma[i + 1] / grid->sigma[i];
        grid->to_end[i] = kept * grid->to_end[i + 1];
        grid->to_mean[i] = kept * grid->to_mean[i + 1] + map.impulse_slope / grid->sigma[i] / end;
    }
}

static double error_of(const Grid* grid, int i, int j, const FcMap* map, double end) {
    const double of_force = fabs(end_of(map, grid->delta[i]) - grid->delta[j]) * grid->sigma[j];
    const double of_impulse = fabs(impulse_of(map, grid->delta[i]) - (grid->impulse[j] - grid->impulse[i]));
    const double error =
        (of_force * fmax(grid->to_end[j], 0.0) + of_force * fmax(grid->to_mean[j], 0.0) + of_impulse / end) /
        F_C;
    return isfinite(error) ? error : INFINITY;
}

static void judge_panels(Grid* grid, const FcScene* scene, const FcMesh* mesh, double end) {
    for (int i = 0; i < grid->count; i++) {
        for (int j = i + 1; j < grid->count; j++) {
            for (int kind = 0; kind < KINDS; kind++) {
                const FcPanel panel =
                    panel_of(grid, scene, kind, grid->t[i], grid->t[j] - grid->t[i], grid->delta[i]);
                grid->error[i][j][kind] = error_of(grid, i, j, &panel.map, end);
            }
        }
        const FcCoefficients here = fc_scene_coefficients(scene, grid->t[i]);
        const FcPlace at = {.t = grid->t[i], .rate = -fc_coefficients_rate(&here)};
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
        FcPanel rest;
        double taken = 0.0;
        const bool settles = fc_settled_panel(&from, &rest, &taken);
        grid->settled[i] = settles ? error_of(grid, i, grid->count - 1, &rest.map, end) : INFINITY;
        grid->to_settle[i] = taken;
    }
}

// The cheapest sequence of panels where an error costs `price`: its evaluations and the sum of its errors.
static double cheapest(const Grid* grid, double price, double* error) {
    double cost[MOST_POINTS];
    double errors[MOST_POINTS];
    double nodes[MOST_POINTS];
    const int last = grid->count - 1;
    cost[last] = errors[last] = nodes[last] = 0.0;
    for (int i = last - 1; i >= 0; i--) {
        cost[i] = grid->to_settle[i] + price * grid->settled[i];
        errors[i] = grid->settled[i];
        nodes[i] = grid->to_settle[i];
        for (int j = i + 1; j <= last; j++) {
            for (int kind = 0; kind < KINDS; kind++) {
                const double of_panel = grid->error[i][j][kind];
                const double whole = NODES[kind] + price * of_panel + cost[j];
                if (whole < cost[i]) {
                    cost[i] = whole;
                    errors[i] = of_panel + errors[j];
                    nodes[i] = NODES[kind] + nodes[j];
                }
            }
        }
    }
    *error += errors[0];
    return nodes[0];
}

static double least(double tolerance, int stretches) {
    double low = 0.0; // ln of the price
    double high = 60.0;
    double evaluations = INFINITY;
    for (int k = 0; k < 60; k++) {
        const double middle = 0.5 * (low + high);
        double error = 0.0;
        double nodes = 0.0;
        for (int i = 0; i < stretches; i++) {
            nodes += cheapest(&grids[i], exp(middle), &error);
        }
        if (error <= tolerance) {
            evaluations = fmin(evaluations, nodes);
            high = middle;
        } else {
            low = middle;
        }
    }
    return evaluations;
}

// The grids of one period from the settled deflection.
static int make_grids(const FcScene* scene, double delta) {
    const FcMesh mesh = fc_mesh_make(scene, PERIOD, 1e200); // accepts every closed form
    int count = 0;
    double start = 0.0;
    for (; start < PERIOD && count < STRETCHES; count++) {
        const FcDriveEvent event = fc_drive_next_event(&scene->drive, start, 2.0 * PERIOD);
        Grid* grid = &grids[count];
        grid->stretch = (FcStretch){
            .start = start, .end = fmin(event.time, PERIOD), .event = event.time, .reversal = true};
        FcStretch* s = &grid->stretch;
        const FcVelocity at_start = fc_drive_velocity(&scene->drive, s->start);
        const FcVelocity at_event = fc_drive_velocity(&scene->drive, s->event);
        s->at_start = fc_scene_coefficients(scene, s->start);
        s->at_end = fc_scene_coefficients(scene, s->end);
        s->w_a = fc_mesh_layer(&at_start, s->at_start.sigma / s->at_start.limit);
        s->back = start > 0.0 ? s->w_a : fmax(s->w_a, fc_mesh_settled_back(&at_start));
        s->w_b = fc_mesh_layer(&at_event, s->at_end.sigma / s->at_end.limit);
        grid->sign = fc_sign(fc_drive_displacement(&scene->drive, s->start, s->end));
        make_grid(grid);
        solve_finely(grid, scene, delta);
        delta = grid->delta[grid->count - 1];
        start = s->end;
    }
    double to_end = 1.0;
    double to_mean = 0.0;
    for (int i = count - 1; i >= 0; i--) {
        worth(&grids[i], scene, PERIOD, to_end, to_mean);
        to_end = grids[i].to_end[0];
        to_mean = grids[i].to_mean[0];
        judge_panels(&grids[i], scene, &mesh, PERIOD);
    }
    return count;
}

int main(void) {
    const double tolerances[] = {1e-2, 1e-3, 1e-4, 1e-6, 1e-9};
    printf("sigma [N/m]");
    for (int k = 0; k < 5; k++) {
        printf("        %.0e", tolerances[k]);
    }
    printf("\n");
    for (double sigma = 6e4; sigma < 1e13; sigma *= 10.0) {
        Slider slider;
        make(&slider, sigma);
        const FcScene* scene = &slider.scene;
        double delta = 0.0;
        const FcSolverOptions tight = {.tolerance = 1e-13};
        double evaluations = 0.0;
        for (int period = 0; period < 200; period++) {
            const FcMap map =
                fc_collocation_interval(scene, &tight, PERIOD, delta, FC_MAP_THIS_START, &evaluations);
            delta = end_of(&map, delta);
        }
        const int stretches = make_grids(scene, delta);
        printf("%11.0e", sigma);
        for (int k = 0; k < 5; k++) {
            const FcSolverOptions options = {.tolerance = tolerances[k]};
            double taken = 0.0;
            fc_collocation_interval(scene, &options, PERIOD, delta, FC_MAP_THIS_START, &taken);
            printf("  %4.0f of %4.0f", least(tolerances[k], stretches), taken);
        }
        printf("\n");
    }
    return 0;
}
