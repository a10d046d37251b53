#include "solver/panel/nodes.h"

#include <assert.h>
#include <math.h>

enum { POINTS = FC_POINTS, START = FC_STAGES, LAST = FC_STAGES - 1 };

// sin(x) and cos(x) - 1 by Taylor series (arithmetic.h), terms in pairs as there.
static inline double series_sin(double x) {
    const double y = x * x;
    const double y_2 = y * y;
    const double low = -1.0 / 6 + y * (1.0 / 120);
    const double high = (-1.0 / 5040 + y * (1.0 / 362880)) - y_2 * (1.0 / 39916800);
    return x + x * y * (low + y_2 * high);
}

static inline double series_cos_less_1(double x) {
    const double y = x * x;
    const double y_2 = y * y;
    const double low = (-1.0 / 2 + y * (1.0 / 24)) + y_2 * (-1.0 / 720 + y * (1.0 / 40320));
    const double high = -1.0 / 3628800 + y * (1.0 / 479001600);
    return y * (low + y_2 * y_2 * high);
}

// The largest number of halvings of an argument for the series. Each doubling back loses a digit of two; beyond,
// the library takes over.
enum { MAX_HALVINGS = 5 };
typedef struct {
    int count;
    double factor; // 2^-count
} Halvings;

static inline Halvings halvings(double size) {
    Halvings halved = {0, 1.0};
    while (size * halved.factor > FC_SERIES_RANGE && halved.count <= MAX_HALVINGS) {
        halved.factor *= 0.5;
        halved.count++;
    }
    return halved;
}

static inline bool fits(Halvings halved) { return halved.count <= MAX_HALVINGS; }

// x -> e^x - 1.
FC_INLINE void exp_less_1(double* x, Halvings halved) {
    for (int i = 0; i < POINTS; i++) {
        x[i] = fc_series_exp_less_1(halved.factor * x[i]);
    }
    for (int k = 0; k < halved.count; k++) {
        for (int i = 0; i < POINTS; i++) {
            x[i] *= 2.0 + x[i];
        }
    }
}

// The times of the points, as distances x [s] from the middle of the panel in u. False if u runs too far for the
// series.
FC_INLINE bool times_of_points(const FcPart* part, double u, double h, FcNodes* nodes, double* middle,
                               double* x) {
    const double place = u + 0.5 * h;
    if (isinf(part->in.length)) {
        *middle = part->in.center + place;
        for (int i = 0; i < POINTS; i++) {
            x[i] = h * FC_RADAU.node[i];
            nodes->tau[i] = h;
        }
        return true;
    }
    const Halvings halved = halvings(0.5 * h);
    if (!fits(halved)) {
        return false;
    }
    double e[POINTS];
    for (int i = 0; i < POINTS; i++) {
        e[i] = h * FC_RADAU.node[i];
    }
    exp_less_1(e, halved);
    const double half = 0.5 * part->in.length;
    const double up = half * exp(place);
    const double down = half * half / up;
    *middle = part->in.center + (up - down);
    for (int i = 0; i < POINTS; i++) {
        const double over = 1.0 / (1.0 + e[i]);
        x[i] = up * e[i] + down * e[i] * over;
        nodes->tau[i] = h * (up * (1.0 + e[i]) + down * over);
    }
    return true;
}

// A velocity along one axis at the middle, and its parts.
typedef struct {
    double V, still, rate; // m/s, m/s without the vibration, m/s2
    double cosine, sine;   // m/s, of the vibration
} Velocity;

FC_INLINE void velocities(const Velocity* at, double omega, const double* x, const double* cosine,
                          const double* sine, double* V, double* moved) {
    const double over = omega != 0.0 ? 1.0 / omega : 0.0;
    for (int i = 0; i < POINTS; i++) {
        V[i] = at->V + at->rate * x[i] + (at->cosine * cosine[i] - at->sine * sine[i]);
        moved[i] = at->still * x[i] + 0.5 * at->rate * x[i] * x[i] +
                   (at->sine * cosine[i] + at->cosine * sine[i]) * over;
    }
    for (int i = 0; i < POINTS; i++) {
        moved[i] -= moved[START];
    }
}

// sigma and the static limit of a separation that moves from that of the middle.
FC_INLINE void of_separation(const FcScene* scene, double d_middle, const double* moved, Halvings halved,
                             FcNodes* nodes) {
    const FcContactAtModulus* c = &scene->at_E;
    double e[POINTS];
    for (int i = 0; i < POINTS; i++) {
        e[i] = -c->decay * moved[i];
    }
    exp_less_1(e, halved);
    const double e_middle = fc_contact_decayed(c, d_middle);
    for (int i = 0; i < POINTS; i++) {
        e[i] = e_middle + e_middle * e[i];
    }
    if (c->model == FC_CONTACT_ASPERITIES) {
        for (int i = 0; i < POINTS; i++) {
            const double d = d_middle + moved[i];
            nodes->sigma[i] = c->stiffness_0 * (e[i] * e[i]) / (d * d * d);
        }
    } else if (c->model == FC_CONTACT_MINDLIN) {
        for (int i = 0; i < POINTS; i++) {
            nodes->sigma[i] = c->stiffness_0 * e[i];
        }
    }
    if (fc_limit_follows_load(scene->friction)) {
        for (int i = 0; i < POINTS; i++) {
            nodes->static_limit[i] = scene->friction->mu * (c->load_0 * e[i]);
        }
    }
}

// sin and cos - 1 of the vibration's angle at the times x, from that of the middle on: series of a halved angle, doubled back.
FC_INLINE void turn(const double* x, double omega, Halvings angle, double* sine, double* cosine) {
    const double pace = omega * angle.factor;
    for (int i = 0; i < POINTS; i++) {
        sine[i] = series_sin(pace * x[i]);
        cosine[i] = series_cos_less_1(pace * x[i]);
    }
    for (int k = 0; k < angle.count; k++) {
        for (int i = 0; i < POINTS; i++) {
            sine[i] *= 2.0 * (1.0 + cosine[i]);
            cosine[i] *= 2.0 * (2.0 + cosine[i]);
        }
    }
}

// Everything by series about the middle, in four steps: the times; the vibration's angle; the velocities and displacements;
// the contact. False if they would be too long, or an input moves otherwise than in V and d.
FC_INLINE bool with_series(const FcPlane* plane, const FcPart* part, double u, double h, FcNodes* nodes) {
    const FcScene* scene = &plane->of_static_limit;
    const FcDrive* drive = &scene->drive;
    double x[POINTS];
    double middle;
    if (scene->floats || drive->E.rate != 0.0 || !times_of_points(part, u, h, nodes, &middle, x)) {
        return false;
    }
    // The vibration's angle, from that of the middle.
    const double farthest = fc_max(fabs(x[START]), fabs(x[LAST]));
    const Halvings angle = halvings(farthest * drive->omega);
    const bool moves = fc_scene_depends_on_d(scene);
    const double motion =
        farthest * fabs(drive->d.rate) + drive->vibration.a_d * fc_min(farthest * drive->omega, 2.0);
    const Halvings exponent = halvings(moves ? scene->at_E.decay * motion : 0.0);
    if (!fits(angle) || !fits(exponent)) {
        return false;
    }
    const FcPhase at = fc_drive_phase(drive, middle);
    const double c = at.cosine;
    const double s = at.sine;
    double sine[POINTS];
    double cosine[POINTS]; // less 1
    turn(x, drive->omega, angle, sine, cosine);
    for (int i = 0; i < POINTS; i++) {
        nodes->t[i] = fc_min(fc_max(middle + x[i], part->start), part->end);
        nodes->phase[i] = (FcPhase){s + (s * cosine[i] + c * sine[i]), c + (c * cosine[i] - s * sine[i])};
        nodes->sigma[i] = scene->at_E.stiffness_0;
        nodes->static_limit[i] = scene->F_C;
    }
    nodes->duration = x[LAST] - x[START];
    // V and the displacement.
    const Velocity along = {.V = fc_drive_V_at_phase(drive, middle, at),
                            .still = drive->V.value + drive->V.rate * middle,
                            .rate = drive->V.rate,
                            .cosine = drive->vibration.V_1 * c,
                            .sine = drive->vibration.V_1 * s};
    velocities(&along, drive->omega, x, cosine, sine, nodes->V, nodes->moved);
    if (!plane->is_one_dimensional) {
        const double V_2 = drive->vibration.V_2;
        const Velocity across = {.V = fc_drive_V_y_at_phase(drive, middle, at),
                                 .still = drive->V_y.value + drive->V_y.rate * middle,
                                 .rate = drive->V_y.rate,
                                 .cosine = V_2 * (c * drive->cos_phase_2 - s * drive->sin_phase_2),
                                 .sine = V_2 * (s * drive->cos_phase_2 + c * drive->sin_phase_2)};
        velocities(&across, drive->omega, x, cosine, sine, nodes->V_y, nodes->moved_y);
    }
    // The contact.
    if (moves) {
        const double d_c = drive->vibration.a_d * (c * drive->cos_phase_d - s * drive->sin_phase_d);
        const double d_s = drive->vibration.a_d * (s * drive->cos_phase_d + c * drive->sin_phase_d);
        double moved[POINTS];
        for (int i = 0; i < POINTS; i++) {
            moved[i] = drive->d.rate * x[i] + (d_c * cosine[i] - d_s * sine[i]);
        }
        of_separation(scene, drive->d.value + drive->d.rate * middle + d_c, moved, exponent, nodes);
    }
    return true;
}

static void with_library(const FcPlane* plane, const FcPart* part, double u, double h, FcNodes* nodes) {
    const FcDrive* drive = &plane->scene->drive;
    const FcDrive across = fc_drive_across(drive);
    nodes->duration = 0.0;
    for (int i = 0; i < POINTS; i++) {
        const double place = u + (0.5 + FC_RADAU.node[i]) * h;
        nodes->t[i] = fc_part_time(part, place);
        nodes->tau[i] = h * fc_time_map_dt_du(&part->in, place);
        nodes->phase[i] = fc_drive_phase(drive, nodes->t[i]);
        const FcPlaneCoefficients at = fc_plane_coefficients(plane, nodes->t[i], nodes->phase[i]);
        nodes->V[i] = at.V.x;
        nodes->V_y[i] = at.V.y;
        nodes->sigma[i] = at.sigma;
        nodes->static_limit[i] = at.static_limit;
        nodes->duration += FC_RADAU.weight[i] * nodes->tau[i];
    }
    for (int i = 0; i < POINTS; i++) {
        nodes->moved[i] = fc_drive_displacement(drive, nodes->t[START], nodes->t[i]);
        nodes->moved_y[i] =
            plane->is_one_dimensional ? 0.0 : fc_drive_displacement(&across, nodes->t[START], nodes->t[i]);
    }
}

void fc_nodes_make(const FcPlane* plane, const FcPart* part, double u, double h, FcNodes* nodes) {
    assert(part->start <= part->end);
    assert(h >= 0.0 && (plane->is_one_dimensional ? part->side * part->side <= 1 : part->side == 0));
    if (!with_series(plane, part, u, h, nodes)) {
        with_library(plane, part, u, h, nodes);
    }
    assert(!(nodes->duration < 0.0 || nodes->t[START] < part->start || nodes->t[LAST] > part->end));
    nodes->side = part->side;
    for (int i = 0; i < POINTS && plane->is_one_dimensional; i++) {
        nodes->V_y[i] = nodes->moved_y[i] = 0.0;
        nodes->speed[i] = part->side * nodes->V[i];
    }
    for (int i = 0; i < POINTS && !plane->is_one_dimensional; i++) {
        nodes->speed[i] = hypot(nodes->V[i], nodes->V_y[i]);
    }
    for (int i = 0; i < POINTS; i++) {
        nodes->limit[i] = nodes->static_limit[i];
    }
    const FcFriction* friction = plane->scene->friction;
    if (fc_has_stribeck_curve(friction)) {
        const double R = friction->staticRatio;
        for (int i = 0; i < POINTS; i++) {
            const double log_peak = fc_stribeck_log_peak(friction, nodes->speed[i]);
            nodes->limit[i] *= (1.0 + (R - 1.0) * fc_exp_less(log_peak, 0.0)) / R;
        }
    }
}
