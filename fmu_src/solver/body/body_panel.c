#include "solver/body/body_panel.h"
#include "solver/integrate/tuning.h"

#include <assert.h>
#include <math.h>

#include "solver/panel/radau.h"

enum { STAGES = FC_STAGES, POINTS = FC_POINTS, START = FC_STAGES, LAST = FC_STAGES - 1 };

// g at the velocity w, and its slope by w.
typedef struct {
    double g;     // N
    double slope; // N s/m
} Limit;

static Limit limit_at(const FcPlane* plane, double static_limit, double w) {
    const FcFriction* friction = plane->scene->friction;
    const double kinetic = static_limit / fc_static_ratio(friction);
    return fc_has_stribeck_curve(friction)
               ? (Limit){kinetic * fc_stribeck(friction, w), kinetic * fc_stribeck_slope(friction, w)}
               : (Limit){kinetic, 0.0};
}

// The bound along which a bristle slips: the kinetic one in ElasticPlastic, else the static one.
static Limit bound_at(const FcPlane* plane, double static_limit, double w) {
    return fc_may_stick(plane->scene->friction) ? limit_at(plane, static_limit, w)
                                                : (Limit){static_limit, 0.0};
}

// The integral of the force on the mass from the panel's start to a stage [N s].
static double pushed(const FcBody* body, const FcNodes* nodes, int i) {
    assert(i >= 0 && i < STAGES);
    const double t = nodes->t[START];
    const double x = nodes->t[i] - t;
    return x * (body->F.value + body->F.rate * (t + 0.5 * x));
}

// v at the stages is free - slope e, with e = delta - delta_0 there.
typedef struct {
    double free[STAGES];
    double FC_PAIRED slope[STAGES][POINTS]; // the last column is 0
} Velocity;

// v (1 + sigma_2 A tau / m) = v: by three columns at once.
static void add_viscous_friction(const FcNodes* nodes, double per_mass, Velocity* of) {
    assert(per_mass >= 0.0);
    for (int first = 0; first <= STAGES; first += 3) {
        FcSystem row;
        double z[STAGES];
        for (int i = 0; i < STAGES; i++) {
            z[i] = per_mass * nodes->tau[i];
        }
        fc_collocation_begin(row, z);
        for (int i = 0; i < STAGES; i++) {
            for (int k = 0; k < 3; k++) {
                row[i][FC_FIRST + k] = 0.0;
                for (int j = 0; j < STAGES && first + k <= STAGES; j++) {
                    row[i][FC_FIRST + k] +=
                        FC_RADAU.inverse[i][j] * (first + k < STAGES ? of->slope[j][first + k] : of->free[j]);
                }
            }
        }
        fc_collocation_solve(row, true, true);
        for (int i = 0; i < STAGES; i++) {
            for (int k = 0; k < 3 && first + k <= STAGES; k++) {
                *(first + k < STAGES ? &of->slope[i][first + k] : &of->free[i]) = row[i][FC_FIRST + k];
            }
        }
    }
}

FC_INLINE void find_velocity(const FcPlane* plane, const FcBody* body, const FcBodyStart* start,
                             const FcNodes* nodes, Velocity* of) {
    const FcFriction* friction = plane->scene->friction;
    const double over_m = 1.0 / body->m;
    double FC_PAIRED weight[POINTS]; // of a deflection in the impulse, over the mass
    for (int j = 0; j < POINTS; j++) {
        weight[j] = j == START ? 0.0 : nodes->tau[j] * nodes->sigma[j] * over_m;
    }
    for (int i = 0; i < STAGES; i++) {
        const double held = fc_dot(POINTS, FC_RADAU.matrix[i], weight) * start->delta;
        for (int j = 0; j < POINTS; j++) {
            of->slope[i][j] = FC_RADAU.matrix[i][j] * weight[j];
        }
        of->slope[i][i] += friction->sigma_1 * over_m;
        of->free[i] =
            start->v - held + (pushed(body, nodes, i) - friction->sigma_2 * nodes->moved[i]) * over_m;
    }
    if (friction->sigma_2 != 0.0) {
        add_viscous_friction(nodes, friction->sigma_2 * over_m, of);
    }
}

// First values of w for a bristle that relaxes: the mass goes on as it begins, but for its ringing.
static void guess_velocities(const FcPlane* plane, const FcBody* body, const FcBodyStart* start,
                             const FcNodes* nodes, double w[STAGES]) {
    const double sigma = nodes->sigma[START];
    const double a = fc_body_rates(plane, body, start, nodes->t[START], nodes->phase[START], sigma,
                                   nodes->static_limit[START])
                         .v;
    const double fade = 1.0 / (1.0 + sqrt(sigma / body->m) * nodes->duration);
    for (int i = 0; i < STAGES; i++) {
        w[i] = start->v + a * (nodes->t[i] - nodes->t[START]) * fade + nodes->V[i];
    }
}

// The coefficients of one iteration of Newton's method at the stages.
typedef struct {
    double by_w[STAGES]; // the derivative of delta' tau by w
    double z[STAGES];    // minus that by delta
    double left[STAGES]; // delta' tau
} Linear;

// Linearizes delta' = w - rho delta. The first velocities are guessed and do not follow e.
FC_INLINE void linearize(const FcPlane* plane, const FcBodyStart* start, const FcNodes* nodes,
                         const double w[STAGES], const double e[POINTS], bool is_guess, Linear* of) {
    for (int i = 0; i < STAGES; i++) {
        const double delta = start->delta + e[i];
        double rho = 0.0;
        double rho_slope = 0.0;
        if (start->kind == FC_RELAXES) {
            const Limit at = limit_at(plane, nodes->static_limit[i], w[i]);
            const double per_path = start->side * nodes->sigma[i] / at.g;
            rho = per_path * w[i];
            rho_slope = per_path - rho * at.slope / at.g;
        }
        of->z[i] = nodes->tau[i] * rho;
        of->by_w[i] = is_guess ? 0.0 : nodes->tau[i] * (1.0 - rho_slope * delta);
        of->left[i] = nodes->tau[i] * w[i] - of->z[i] * delta;
    }
}

// Solves for the change of e and adds it. Returns the largest change of the force [N].
FC_INLINE double improve(const FcNodes* nodes, const Velocity* velocity, const Linear* of, double e[POINTS]) {
    FcSystem row;
    fc_collocation_begin(row, of->z);
    for (int i = 0; i < STAGES; i++) {
        row[i][FC_FIRST] = of->left[i] - fc_dot(POINTS, FC_RADAU.inverse[i], e);
        for (int j = 0; j < STAGES; j++) {
            row[i][j] += of->by_w[i] * velocity->slope[i][j];
        }
    }
    fc_collocation_solve(row, true, false);
    double step = 0.0;
    for (int i = 0; i < STAGES; i++) {
        e[i] += row[i][FC_FIRST];
        step = fc_max(step, fabs(row[i][FC_FIRST]) * nodes->sigma[i]);
    }
    return step;
}

// delta' = w - rho delta, rho = sigma side w / g: Newton's method in e. A stuck bristle has rho = 0 and needs one solution.
// In steps: v as a function of e; first values of w; then in each iteration the coefficients, the change of e, v and delta
// from e, and whether the next change is small enough.
FC_INLINE bool find_deflections(const FcPlane* plane, const FcBody* body, const FcBodyStart* start,
                                double close, const FcNodes* nodes, FcBodyPanel* panel, double* solves) {
    const bool relaxes = start->kind == FC_RELAXES;
    assert(start->kind != FC_SLIPS && (start->side != 0) == relaxes);
    Velocity velocity;
    find_velocity(plane, body, start, nodes, &velocity);
    double FC_PAIRED e[POINTS] = {0.0};
    double w[STAGES];
    double last = HUGE_VAL;
    if (relaxes) {
        guess_velocities(plane, body, start, nodes, w);
    } else {
        for (int i = 0; i < STAGES; i++) {
            w[i] = velocity.free[i] + nodes->V[i];
        }
    }
    for (int tries = 0; tries <= FC_MAX_ITERATIONS; tries++) {
        const bool is_guess = relaxes && tries == 0;
        Linear of;
        linearize(plane, start, nodes, w, e, is_guess, &of);
        const double step = improve(nodes, &velocity, &of, e);
        *solves += 1.0;
        for (int i = 0; i < STAGES; i++) {
            panel->v[i] = velocity.free[i] - fc_dot(POINTS, velocity.slope[i], e);
            w[i] = panel->v[i] + nodes->V[i];
            panel->delta[i] = start->delta + e[i];
        }
        if (!isfinite(step)) {
            return false;
        }
        // The next step is the square of this one over the limit, at the most tenfold.
        const bool is_small = 10.0 * step * step < close * nodes->static_limit[START] && step < 0.05 * last;
        if (!relaxes || (!is_guess && (is_small || step <= 0.01 * close))) {
            return true;
        }
        last = step;
    }
    return false;
}

// delta = side D(w): Newton's method in v, which a bound that w does not move needs once.
//
//     m A^-1 (v - v_0) + sigma_1 A^-1 (delta - delta_0) = tau (F - side g - sigma_2 w)
//
// Each iteration in three steps: both sides and their derivatives by v at the stages; the change of v from the linear system;
// the end, with delta from the last v, if that change is small or the bound does not move.
static bool find_slip(const FcPlane* plane, const FcBody* body, const FcBodyStart* start, double close,
                      const FcNodes* nodes, FcBodyPanel* panel, double* solves) {
    const FcFriction* friction = plane->scene->friction;
    const double m = body->m;
    assert(start->side == 1 || start->side == -1);
    const bool is_linear = !fc_may_stick(friction) || !fc_has_static_friction(friction);
    for (int i = 0; i < STAGES; i++) {
        panel->v[i] = start->v;
    }
    for (int tries = 0; tries < FC_MAX_ITERATIONS; tries++) {
        double z[STAGES];
        double moved[STAGES]; // m (v - v_0) + sigma_1 (delta - delta_0)
        double by_v[STAGES];  // of that, over m
        double left[STAGES];
        for (int i = 0; i < STAGES; i++) {
            const double w = panel->v[i] + nodes->V[i];
            const Limit at = bound_at(plane, nodes->static_limit[i], w);
            panel->delta[i] = start->side * at.g / nodes->sigma[i];
            moved[i] = m * (panel->v[i] - start->v) + friction->sigma_1 * (panel->delta[i] - start->delta);
            by_v[i] = 1.0 + friction->sigma_1 * start->side * at.slope / (nodes->sigma[i] * m);
            z[i] = nodes->tau[i] * (start->side * at.slope + friction->sigma_2) / m;
            left[i] = nodes->tau[i] *
                      (fc_input_after(body->F, nodes->t[i]) - start->side * at.g - friction->sigma_2 * w);
        }
        FcSystem row;
        fc_collocation_begin(row, z);
        for (int i = 0; i < STAGES; i++) {
            row[i][FC_FIRST] = left[i] / m;
            for (int j = 0; j < STAGES; j++) {
                row[i][FC_FIRST] -= FC_RADAU.inverse[i][j] * moved[j] / m;
                row[i][j] += FC_RADAU.inverse[i][j] * (by_v[j] - 1.0);
            }
        }
        fc_collocation_solve(row, true, false);
        *solves += 1.0;
        double step = 0.0; // m/s
        for (int i = 0; i < STAGES; i++) {
            panel->v[i] += row[i][FC_FIRST];
            step = fc_max(step, fabs(row[i][FC_FIRST]));
        }
        if (!isfinite(step)) {
            return false;
        }
        if (is_linear || step * m <= 0.01 * close * nodes->duration ||
            step <= FC_BODY_ROUNDING * fabs(panel->v[LAST])) {
            for (int i = 0; i < STAGES; i++) {
                const double w = panel->v[i] + nodes->V[i];
                panel->delta[i] =
                    start->side * bound_at(plane, nodes->static_limit[i], w).g / nodes->sigma[i];
            }
            return true;
        }
    }
    return false;
}

FcBodyRates fc_body_rates(const FcPlane* plane, const FcBody* body, const FcBodyStart* at, double t,
                          FcPhase phase, double sigma, double static_limit) {
    const FcFriction* friction = plane->scene->friction;
    assert(sigma >= 0.0 && static_limit > 0.0 && (at->kind == FC_STICKS) == (at->side == 0));
    const FcVelocity V = fc_drive_velocity_at_phase(&plane->scene->drive, t, phase);
    const double w = at->v + V.V;
    const Limit limit = limit_at(plane, static_limit, w);
    const double F = fc_input_after(body->F, t) - friction->sigma_2 * w;
    FcBodyRates of = {.limit = limit.g, .inertia = 1.0};
    if (at->kind != FC_STICKS && !fc_may_stick(friction)) {
        of.relaxation = sigma * fabs(w) / limit.g;
    }
    if (at->kind != FC_SLIPS) {
        const double rho = at->kind == FC_RELAXES ? at->side * sigma * w / limit.g : 0.0;
        of.delta = w - rho * at->delta;
        of.v = (F - sigma * at->delta - friction->sigma_1 * of.delta) / body->m;
    } else { // delta' = side D' + by_w w'
        const Limit bound = bound_at(plane, static_limit, w);
        const double D = bound.g / sigma;
        const double by_w = at->side * bound.slope / sigma;
        double delta = by_w * V.rate;
        if (fc_scene_depends_on_d(plane->scene)) {
            delta += at->side * D * fc_scene_log_rates(&plane->of_static_limit, t, phase).ratio;
        }
        of.inertia = 1.0 + friction->sigma_1 * by_w / body->m;
        of.v = (F - at->side * bound.g - friction->sigma_1 * delta) /
               (body->m * fc_max(of.inertia, FC_MIN_INERTIA));
        of.delta = delta + by_w * of.v;
        of.push = at->side * (w - of.delta) - of.relaxation * D;
    }
    of.w = of.v + V.rate;
    return of;
}

void fc_body_panel_rates(const FcPlane* plane, const FcBody* body, const FcBodyStart* start, FcNodes* nodes,
                         FcBodyPanel* panel) {
    for (int i = 0; i < POINTS; i++) {
        const FcBodyStart at = {start->kind, start->side, panel->delta[i], panel->v[i]};
        panel->w[i] = panel->v[i] + nodes->V[i];
        panel->rate[i] = fc_body_rates(plane, body, &at, nodes->t[i], nodes->phase[i], nodes->sigma[i],
                                       nodes->static_limit[i]);
        nodes->limit[i] = panel->rate[i].limit;
    }
}

bool fc_body_panel(const FcPlane* plane, const FcBody* body, const FcBodyStart* start, double close,
                   FcNodes* nodes, FcBodyPanel* panel, double* solves) {
    assert(body->m > 0.0 && close > 0.0 && plane->is_one_dimensional);
    panel->delta[START] = start->delta;
    panel->v[START] = start->v;
    const bool is_solved = start->kind == FC_SLIPS
                               ? find_slip(plane, body, start, close, nodes, panel, solves)
                               : find_deflections(plane, body, start, close, nodes, panel, solves);
    if (is_solved) {
        fc_body_panel_rates(plane, body, start, nodes, panel);
    }
    return is_solved;
}
