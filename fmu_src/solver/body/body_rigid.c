// A mass without a bristle: Coulomb's law, or an open contact.
//
//     slips    m v' = F - s g - sigma_2 w, with s = sgn w, by Radau IIA of 9 stages: one linear system a panel, exact
//              where all is constant or linear
//     sticks   w = 0 and F_t = F + m V', as long as this is within the limit g
//
// A slip ends where s w falls to 0 and a stick where g^2 - F_t^2 does: at roots of the polynomials through the points of
// a panel. The mass sticks or slips on by the force that would hold it.
#include "solver/body/body_rigid.h"

#include <assert.h>
#include <float.h>
#include <math.h>

#include "model/extremes.h"
#include "model/pi.h"
#include "model/root.h"
#include "solver/integrate/tuning.h"
#include "solver/panel/radau.h"

enum { POINTS = FC_POINTS, START = FC_STAGES, LAST = FC_STAGES - 1 };

// The part of the allowed error that the estimate of a panel may take. Panels are cheap: a tenth of it makes 1.2 times as
// many.
static const double SHARE = 0.01;

// The rounding of a panel's force, over the forces.
static const double ROUNDING = 1e-13;

// An inaccurate panel is shortened by this factor, at most so often; others change the number of tries.
static const double SHORTENED = 0.7;
enum { MAX_TRIES = 60 };

// The part of a period that a panel goes through at the most: its polynomial of w is then right to 1e-10 of V_1.
static const double OF_PERIOD = 0.3;

typedef struct {
    const FcScene* scene;
    const FcBody* body; // at the start
    bool is_separated;
    double allowed; // N, error of the mean force of a panel
    double t;       // s, reached
    double v;       // m/s, there
    int side;       // of the slip; 0 if the mass sticks, or if the contact is open
    bool sticks;
} Rigid;

// A panel of length h.
typedef struct {
    double h;
    double FC_PAIRED v[POINTS];      // m/s
    double w[POINTS];                // m/s
    double F_t[POINTS];              // N
    double FC_PAIRED to_end[POINTS]; // what falls to 0 at the end of a slip [m/s] or of a stick [N2]
    double error;                    // N, of the mean force
} Panel;

static double limit_at(const Rigid* of, double t) {
    assert(t >= 0.0);
    return of->is_separated ? 0.0 : fc_scene_coefficients(of->scene, t).limit;
}

static double holding_force(const Rigid* of, double t) {
    const FcBody* body = of->body;
    return body->F.value + body->F.rate * t + body->m * fc_drive_velocity(&of->scene->drive, t).rate;
}

// The change of V with its vibration over [from, to], to the digits of the change.
static double change_of_V(const FcDrive* drive, double from, double to) {
    const double half = 0.5 * drive->omega * (to - from);
    const double middle = fc_drive_phase(drive, 0.5 * (from + to)).sine;
    return drive->V.rate * (to - from) - 2.0 * drive->vibration.V_1 * middle * sin(half);
}

static void make_slip(const Rigid* of, double h, Panel* panel) {
    const FcBody* body = of->body;
    const double sigma_2 = of->scene->friction->sigma_2;
    double z[POINTS];
    double F[POINTS]; // without viscous friction
    double V[POINTS];
    FcSystem row;
    for (int i = 0; i < POINTS; i++) {
        const double t = of->t + (i == START ? 0.0 : h * (FC_RADAU.node[i] + 0.5));
        z[i] = h * sigma_2 / body->m;
        V[i] = fc_drive_V(&of->scene->drive, t);
        panel->F_t[i] = of->side * limit_at(of, t);
        F[i] = body->F.value + body->F.rate * t - panel->F_t[i];
    }
    fc_collocation_begin(row, z);
    for (int i = 0; i < FC_STAGES; i++) {
        row[i][FC_FIRST] = h * F[i] / body->m - z[i] * (of->v + V[i]);
    }
    fc_collocation_solve(row, true, false);
    double FC_PAIRED slope[POINTS]; // N
    for (int i = 0; i < POINTS; i++) {
        panel->v[i] = of->v + (i == START ? 0.0 : row[i][FC_FIRST]);
        panel->w[i] = panel->v[i] + V[i];
        panel->F_t[i] += sigma_2 * panel->w[i];
        panel->to_end[i] = of->side * panel->w[i];
        slope[i] = F[i] - sigma_2 * panel->w[i];
    }
    panel->h = h;
    panel->error = fc_radau_quadrature_error(slope) + (1.0 + z[0]) * fc_radau_unresolved(slope, z[0]);
}

static void make_stick(const Rigid* of, double h, Panel* panel) {
    double largest = DBL_MIN;
    for (int i = 0; i < POINTS; i++) {
        const double t = of->t + (i == START ? 0.0 : h * (FC_RADAU.node[i] + 0.5));
        const double limit = limit_at(of, t);
        panel->F_t[i] = holding_force(of, t);
        panel->to_end[i] = (limit - panel->F_t[i]) * (limit + panel->F_t[i]);
        largest = fc_max(largest, limit);
    }
    panel->h = h;
    panel->error = fc_radau_quadrature_error(panel->to_end) / largest;
}

static void make(const Rigid* of, double h, Panel* panel) {
    assert(h >= 0.0 && (of->side == 0) == (of->sticks || of->is_separated));
    (of->sticks ? make_stick : make_slip)(of, h, panel);
}

// The polynomial through the points of a panel, at a part of it, for fc_root_between.
static double at_part(void* points, double part) {
    const double* f = points;
    double above = 0.0;
    double below = 0.0;
    for (int i = 0; i < POINTS; i++) {
        const double distance = part - (i == START ? 0.0 : FC_RADAU.node[i] + 0.5);
        if (distance == 0.0) {
            return f[i];
        }
        above += FC_RADAU.barycentric[i] / distance * f[i];
        below += FC_RADAU.barycentric[i] / distance;
    }
    return above / below;
}

// The first part of the panel at which the function falls to 0, after it has been above 0; 1 if there is none. *rose
// says whether it is above 0 at the first sample or before.
static double first_fall(double* points, bool* rose) {
    double f[FC_SAMPLES + 1] = {points[START]};
    for (int k = 1; k <= FC_SAMPLES; k++) {
        for (int i = 0; i < POINTS; i++) {
            f[k] += FC_RADAU.sample[i][k - 1] * points[i];
        }
    }
    assert(isfinite(f[0]));
    *rose = f[0] > 0.0 || f[1] > 0.0;
    double evaluations = 0.0;
    for (int k = 1; k <= FC_SAMPLES; k++) {
        const double before = (k - 1.0) / FC_SAMPLES;
        double place = (double)k / FC_SAMPLES;
        double value = f[k];
        for (int i = 0; i < FC_STAGES && value > 0.0; i++) { // the points lie closer at the ends
            const double at = FC_RADAU.node[i] + 0.5;
            if (at > before && at < place && points[i] <= 0.0) {
                place = at;
                value = points[i];
            }
        }
        if (value > 0.0 && k < FC_SAMPLES && f[k - 1] > value &&
            f[k + 1] > value) { // it may dip between the samples
            const double rise = f[k + 1] - f[k - 1];
            place -= 0.5 * rise / (f[k + 1] - 2.0 * value + f[k - 1]) / FC_SAMPLES;
            value = at_part(points, place);
        }
        if (f[k - 1] > 0.0 && value <= 0.0 && place > before) {
            return fc_root_between(at_part, points, before, f[k - 1], place, value, 0.0, &evaluations);
        }
    }
    return 1.0;
}

// Chooses between sticking and slipping at w = 0.
static void choose(Rigid* of) {
    const double force = holding_force(of, of->t);
    of->sticks = !of->is_separated && fabs(force) <= limit_at(of, of->t);
    of->side = of->sticks || of->is_separated ? 0 : force < 0.0 ? -1 : 1;
}

// Makes the next panel, as long as it is accurate and, if it begins a slip, shows the slip rising. Returns the part of
// it at which its motion ends, 1 for none. `length` [s] becomes that of the panel.
static double take_accurate(const Rigid* of, double* length, Panel* panel, double* evaluations) {
    for (int tries = 0;; tries++) {
        make(of, *length, panel);
        *evaluations += FC_STAGES;
        if (FC_SAFETY * panel->error > of->allowed && tries < MAX_TRIES) {
            *length *= SHORTENED;
            continue;
        }
        bool rose = true;
        const double part = of->is_separated ? 1.0 : first_fall(panel->to_end, &rose);
        if (rose || tries >= MAX_TRIES) {
            return part;
        }
        *length /= FC_SAMPLES;
    }
}

// Shortens the panel to its end of a slip: the part, and then Newton's method for w = 0.
static void end_slip(const Rigid* of, double part, Panel* panel, double* evaluations) {
    const double most = panel->h;
    assert(part >= 0.0 && part <= 1.0 && of->side != 0);
    double length = part * most;
    double change = INFINITY;
    while (length > 0.0 && length <= most && fabs(change) > DBL_EPSILON * (of->t + length)) {
        const double last = change;
        make_slip(of, length, panel);
        *evaluations += FC_STAGES;
        change = -panel->w[LAST] * of->body->m / (holding_force(of, of->t + length) - panel->F_t[LAST]);
        if (!(fabs(change) < 0.5 * fabs(last))) { // rounding
            break;
        }
        length += change;
    }
}

bool fc_body_rests(const FcScene* scene, const FcBody* body) {
    const FcDrive* drive = &scene->drive;
    const double parts = fabs(drive->V.value) + fabs(body->v); // of w: V without v may be as large as v
    const double V_1 = fabs(drive->vibration.V_1);
    const double rounding = 4.0 * DBL_EPSILON * (parts + V_1 * (2.0 + fabs(drive->theta_0)));
    return fabs(fc_drive_V(drive, 0.0)) <= rounding;
}

double fc_body_rigid_force(const FcScene* scene, const FcBody* body, bool* sticks) {
    const Rigid of = {.scene = scene, .body = body, .is_separated = fc_scene_is_separated(scene)};
    assert(body->m > 0.0 && !fc_has_bristle(scene->friction) && fc_body_rests(scene, body));
    const double limit = limit_at(&of, 0.0);
    const double force = holding_force(&of, 0.0);
    *sticks = fabs(force) < limit;
    return fc_max(-limit, fc_min(limit, force));
}

// The state at the start of a step of the length h, and the error that a panel may have.
static Rigid begin(const FcScene* scene, const FcSolverOptions* options, double h, const FcBody* body) {
    const FcScene seen = fc_body_scene(scene, body, (FcBristle){0});
    const double w = fc_drive_V(&seen.drive, 0.0);
    const double F = fc_max(fabs(body->F.value), fabs(body->F.value + body->F.rate * h));
    Rigid of = {.scene = scene,
                .body = body,
                .is_separated = fc_scene_is_separated(scene),
                .allowed = fc_max(SHARE * options->tolerance * options->largest,
                                  ROUNDING * (options->largest + F) + DBL_MIN), // also where no force acts
                .v = body->v};
    of.side = of.is_separated ? 0 : w < 0.0 ? -1 : 1;
    if (fc_body_rests(&seen, body)) {
        choose(&of);
    }
    return of;
}

// Adds the impulse of F_t, the way of the mass, and the work and heat of the panel up to `end`.
static void add_panel(const Rigid* of, const Panel* panel, double end, double* impulse, double* moved,
                      FcStepResult* result) {
    const FcBody* body = of->body;
    const FcDrive* drive = &of->scene->drive;
    assert(end >= of->t);
    if (of->sticks) {
        *impulse += fc_body_pushed(body, end) - fc_body_pushed(body, of->t) +
                    body->m * change_of_V(drive, of->t, end);
        *moved -= fc_drive_displacement(drive, of->t, end);
        return;
    }
    for (int i = 0; i < FC_STAGES; i++) {
        const double weight = FC_RADAU.weight[i] * panel->h;
        *impulse += weight * panel->F_t[i];
        *moved += weight * panel->v[i];
        result->work += weight * panel->F_t[i] * panel->w[i];
        result->heat += weight * panel->F_t[i] * panel->w[i];
    }
}

// A step goes from panel to panel, each in four steps: it is made as long as it is accurate; it is cut where its slip or
// stick ends; its integrals are added; the mass sticks or slips on.
bool fc_body_rigid_step(const FcScene* scene, const FcSolverOptions* options, double h, FcBody* body,
                        FcStepResult* result, FcMessage* message) {
    assert(h >= 0.0 && body->m > 0.0 && (!fc_has_bristle(scene->friction) || fc_scene_is_separated(scene)));
    Rigid of = begin(scene, options, h, body);
    double impulse = 0.0;
    double moved = 0.0;
    const FcDrive* drive = &scene->drive;
    const double longest = drive->omega != 0.0 ? OF_PERIOD * FC_TWO_PI / drive->omega : h;
    double next = longest;
    while (of.t < h) {
        const double rest = h - of.t;
        double length = fc_min(fc_min(next, longest), rest);
        Panel panel;
        const double part = take_accurate(&of, &length, &panel, &result->evaluations);
        if (result->evaluations > FC_MAX_EVALUATIONS || length == 0.0) { // by underflow
            return fc_message_set(message, "body.m = %.9g kg: the step needs more than %.0e evaluations",
                                  body->m, FC_MAX_EVALUATIONS);
        }
        next = length * fc_min(4.0, pow(of.allowed / (FC_SAFETY * panel.error + DBL_MIN), 1.0 / 16.0));
        if (part < 1.0 && of.sticks) {
            panel.h = part * length;
        } else if (part < 1.0) {
            end_slip(&of, part, &panel, &result->evaluations);
        }
        const double end = panel.h < rest ? of.t + panel.h : h;
        assert(end >= of.t && end <= h);
        add_panel(&of, &panel, end, &impulse, &moved, result);
        of.t = end;
        if (part < 1.0 && of.sticks) {
            of.sticks = false;
            of.side = holding_force(&of, of.t) < 0.0 ? -1 : 1;
        } else if (!of.sticks && !of.is_separated && (part < 1.0 || of.side * panel.w[LAST] <= 0.0)) {
            choose(&of);
            impulse += of.sticks ? body->m * panel.w[LAST] : 0.0; // so that w is 0 without rounding
        }
        of.v = body->v + (fc_body_pushed(body, of.t) - impulse) / body->m;
    }
    assert(of.t == h);
    result->impulse += impulse;
    body->x += moved;
    fc_body_move(body, h, impulse);
    body->sticks = of.sticks;
    return true;
}
