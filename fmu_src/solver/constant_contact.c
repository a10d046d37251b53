#include "solver/constant_contact.h"

#include <math.h>

#include "solver/gauss_rule.h"
#include "solver/mesh.h"

// What an estimated error of the mean may be, over the tolerance: the estimates are 10^3 and more times too large.
static const double OF_THE_MEAN = 300.0;
// Of panels in the interval that 12 nodes don't resolve.
enum { MOST_HALVINGS = 8 };

bool fc_is_constant_contact(const FcScene* scene) {
    return fc_scene_stiffness_is_constant(scene) && fc_scene_limit_is_constant(scene) &&
           !fc_has_stribeck_curve(scene->friction);
}

// The panel [t, t + h] over which V keeps its sign. Estimates its error of the mean force over it.
FC_INLINE void panel_of(const FcGaussRule* rule, int n, const FcScene* scene, double t, double h,
                        double displacement, const FcTrajectories* from, FcPanel* panel) {
    FcNodeCoefficients at;
    fc_node_coefficients(scene, t, h, rule->node, n, &at);
    const double sigma = at.sigma[0];
    const double limit = at.limit[0];
    const double settled = copysign(limit / sigma, displacement); // D
    double z[FC_GAUSS_MOST_NODES];
    double G[FC_GAUSS_MOST_NODES];    // x / |D|
    double gone[FC_GAUSS_MOST_NODES]; // 1 - e^-G
    double f[FC_GAUSS_MOST_NODES];
    for (int i = 0; i < n; i++) {
        z[i] = h * at.V[i] / settled;
    }
    fc_gauss_integrate(rule, n, z, G);
    panel->map = fc_map_of_path(sigma, limit, displacement);
    panel->z = displacement / settled;
    fc_exponentials_less_1(n, G, panel->z, gone);
    double time_gone = 0.0; // s, integral of 1 - e^-G
    double V_V_left = 0.0;  // m2/s, integral of V^2 e^-G
    for (int i = 0; i < n; i++) {
        const double V_V = at.V[i] * at.V[i];
        const double left = 1.0 / (1.0 + gone[i]);
        gone[i] *= left;
        time_gone += rule->weight[i] * gone[i];
        V_V_left += rule->weight[i] * V_V * left;
        f[i] = gone[i] * (1.0 + V_V / (from->speed * from->speed));
    }
    time_gone *= h;
    V_V_left *= h;
    panel->map.impulse_slope = sigma * (h - time_gone);
    panel->map.impulse_offset = copysign(limit, displacement) * time_gone;
    panel->map.drag_slope = -V_V_left / settled;
    panel->map.drag_offset = V_V_left;
    panel->mean_error = sigma * (fabs(from->delta_0 - settled) + from->scale) * fc_gauss_error(rule, n, f);
}

static void panel_of_nodes(int count, const FcScene* scene, double t, double h, double displacement,
                           const FcTrajectories* from, FcPanel* panel) {
    switch (count) { // constants where panel_of is inlined
    case 4:
        panel_of(&FC_GAUSS_4, 4, scene, t, h, displacement, from, panel);
        break;
    case 6:
        panel_of(&FC_GAUSS_6, 6, scene, t, h, displacement, from, panel);
        break;
    case 8:
        panel_of(&FC_GAUSS_8, 8, scene, t, h, displacement, from, panel);
        break;
    default:
        panel_of(&FC_GAUSS_12, 12, scene, t, h, displacement, from, panel);
        break;
    }
}

// How many nodes are about needed for a panel over which the bristle relaxes by z and the phase moves by that angle.
static double nodes_for(double tolerance, double z, double angle) {
    return 1.0 + 0.4 * fc_digits(tolerance) + 0.7 * (z + angle);
}

// count nodes resolve e^z where z is less than half of count; beyond that the estimate says little.
static bool is_resolved(double z, int count) { return z < 0.5 * count; }

// Of the fewest nodes that are accurate: their error of the impulse is at most allowed [N s]. Otherwise false.
static bool accurate_panel(const FcScene* scene, double t, double h, double displacement, double nodes,
                           const FcTrajectories* from, double allowed, FcPanel* panel, double* evaluations) {
    for (int count = fc_gauss_count(nodes);; count = fc_gauss_count(count + 1.0)) {
        panel_of_nodes(count, scene, t, h, displacement, from, panel);
        *evaluations += count;
        if (is_resolved(panel->z, count) && h * panel->mean_error <= allowed) {
            return true;
        }
        if (count == FC_GAUSS_MOST_NODES) {
            return false;
        }
    }
}

typedef struct {
    const FcScene* scene;
    double tolerance; // 1
    double settled;   // m, |D|
    double allowed;   // N s, error of a panel's impulse
    FcTrajectories from;
    FcMap* map; // of what is crossed
    int halvings;
    double* evaluations;
} Progress;

// Goes from t to the end of a stretch over which V keeps its sign, of that displacement [m]. false where it can't.
static bool cross(Progress* progress, double t, double end, double displacement) {
    const FcDrive* drive = &progress->scene->drive;
    FcTrajectories* from = &progress->from;
    while (t < end) {
        double part_end = end;
        double X = displacement;
        FcPanel panel;
        for (;;) {
            const double z = fabs(X) / progress->settled;
            if (!is_resolved(z, FC_GAUSS_MOST_NODES)) {
                return false;
            }
            const double nodes = nodes_for(progress->tolerance, z, drive->omega * (part_end - t));
            if (accurate_panel(progress->scene, t, part_end - t, X, nodes, from, progress->allowed, &panel,
                               progress->evaluations)) {
                break;
            }
            part_end = t + 0.5 * (part_end - t);
            if (++progress->halvings > MOST_HALVINGS || !(part_end > t)) {
                return false;
            }
            X = fc_drive_displacement(drive, t, part_end);
        }
        fc_map_append(progress->map, &panel.map);
        from->delta_0 = (1.0 - panel.map.relaxation) * from->delta_0 + panel.map.offset;
        from->scale *= 1.0 - panel.map.relaxation;
        t = part_end;
        displacement = t < end ? fc_drive_displacement(drive, t, end) : 0.0;
    }
    return true;
}

bool fc_constant_contact_interval(const FcScene* scene, double tolerance, double duration, double delta_0,
                                  FcMapScope scope, FcMap* map, double* evaluations) {
    const FcDrive* drive = &scene->drive;
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    const double settled = at.limit / at.sigma;
    Progress progress = {
        .scene = scene,
        .tolerance = tolerance,
        .settled = settled,
        .allowed = OF_THE_MEAN * tolerance * at.limit * duration,
        .from = {.delta_0 = delta_0,
                 .scale = scope == FC_MAP_ANY_START ? fmax(fabs(delta_0), settled) : 0.0,
                 .speed = fc_drive_largest_speed(drive, duration) + 1e-300},
        .map = map,
        .evaluations = evaluations,
    };
    if (!isfinite(settled)) { // without stiffness
        return false;
    }
    *map = fc_map_identity();
    double t = 0.0;
    FcPhase phase = fc_drive_phase(drive, 0.0);
    FcDriveEvent event = fc_drive_next_event(drive, 0.0, duration);
    while (t < duration) {
        const FcPhase next = event.time < duration ? event.phase : fc_drive_phase(drive, duration);
        const double X = fc_drive_displacement_between(drive, t, phase, event.time, next);
        if (!cross(&progress, t, event.time, X)) {
            return false;
        }
        t = event.time;
        phase = next;
        if (t < duration) {
            event = fc_drive_event_after(drive, &event, duration);
        }
    }
    return true;
}
