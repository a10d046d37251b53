// The march against brute force: steps of a part in 3e4 of a period, halved where the regime changes. The laws are those of
// model/friction.h, written out here once more; all scenes are random.
#include "solver/march/march.h"

#include "check.h"
#include "model/regime.h"
#include "random.h"
#include "table_1.h"

static const double F = 20e3; // Hz
static const double TWO_PI = 6.283185307179586;
static const double TOLERANCE = 1e-6;
static const double OF_REFERENCE = 3e-7;

typedef struct {
    FcContactParameters contact;
    FcFriction friction;
    FcScene scene; // points to them
    double h;      // s
    FcStepResult start;
    FcSolverOptions options;
} Case;

// ---- brute force ----

enum { FREE, ON_BOUND, CATCHES_UP }; // the last: slips, but lies inside its bound

typedef struct {
    double delta, impulse, work, heat, drag;
    int regime, side;
    int changes;
} State;

typedef struct {
    double V, sigma, limit, D_static, D_slip, rate; // rate: of D_slip
} Moment;

static Moment moment(const FcScene* scene, double t) {
    const FcFriction* f = scene->friction;
    const FcCoefficients at = fc_scene_coefficients(scene, t);
    const double ratio = at.V / f->V_S;
    const bool has_curve = f->model != FC_DAHL;
    const double curve = has_curve ? 1.0 + (f->staticRatio - 1.0) * exp(-ratio * ratio) : 1.0;
    const double g = at.limit / curve;
    Moment now = {.V = at.V, .sigma = at.sigma, .limit = at.limit};
    now.D_static = (has_curve ? f->staticRatio : 1.0) * g / at.sigma;
    now.D_slip = f->model == FC_ELASTIC_PLASTIC ? at.limit / at.sigma : now.D_static;
    const FcLogRates rates = fc_scene_log_rates(scene, t);
    now.rate = now.D_slip * rates.ratio;
    if (f->model == FC_LUGRE) { // whose bound does not see the curve
        const double by_V = -2.0 * at.V / (f->V_S * f->V_S) * (curve - 1.0) / curve;
        now.rate = now.D_slip * (rates.ratio - by_V * fc_drive_V_rate(&scene->drive, t));
    }
    return now;
}

static double relaxation(const FcScene* scene, const Moment* at) {
    return scene->friction->model == FC_ELASTIC_PLASTIC ? 0.0 : at->sigma * fabs(at->V) / at->limit;
}

static double push_on(const FcScene* scene, const Moment* at, int side) {
    return side * at->V - relaxation(scene, at) * at->D_slip - at->rate;
}

static State moved(const FcScene* scene, State y, double t, double dt) {
    const Moment mid = moment(scene, t + 0.5 * dt);
    if (y.regime == ON_BOUND) {
        const Moment end = moment(scene, t + dt);
        y.delta = y.side * end.D_slip;
        const double force = mid.sigma * mid.D_slip;
        y.impulse += y.side * force * dt;
        y.work += y.side * force * mid.V * dt;
        y.heat += force * (y.side * mid.V - mid.rate) * dt;
        y.drag += y.side * mid.rate * mid.V * dt;
        return y;
    }
    const double r = relaxation(scene, &mid);
    const double x = r * dt;
    const double way = fc_drive_displacement(&scene->drive, t, t + dt);
    const double change = x > 0.0 ? (way / x - y.delta) * -expm1(-x) : way;
    const double middle = x > 0.0 ? y.delta + (way / x - y.delta) * -expm1(-0.5 * x) : y.delta + 0.5 * way;
    const double force = mid.sigma * middle;
    y.impulse += force * dt;
    y.work += force * mid.V * dt;
    y.heat += force * r * middle * dt;
    y.drag += change * mid.V;
    y.delta += change;
    return y;
}

// Whether the regime holds on, and if not, what comes at the end.
static bool changes(const FcScene* scene, const State* y, double t, State* next) {
    const Moment at = moment(scene, t);
    const bool drops = scene->friction->model == FC_ELASTIC_PLASTIC && scene->friction->staticRatio > 1.0;
    *next = *y;
    const int side = y->regime == FREE ? (y->delta < 0.0 ? -1 : 1) : y->side;
    const double bound = y->regime == FREE ? at.D_static : at.D_slip;
    const bool beyond = side * y->delta > bound * (1.0 + 1e-14);
    const bool pushed = push_on(scene, &at, side) > 0.0;
    if (y->regime != ON_BOUND && beyond) {
        next->delta = side * at.D_slip;
        next->heat += 0.5 * at.sigma * (y->delta * y->delta - next->delta * next->delta);
        next->drag += (next->delta - y->delta) * at.V;
        next->regime = pushed ? ON_BOUND : FREE;
        next->side = side;
        return y->regime != FREE || drops || pushed;
    }
    if (y->regime != FREE && !pushed) {
        next->regime = FREE;
        return true;
    }
    return false;
}

static void brute_step(const FcScene* scene, State* y, double t, double dt, int depth) {
    const State after = moved(scene, *y, t, dt);
    State next;
    if (!changes(scene, &after, t + dt, &next)) {
        *y = next;
    } else if (depth == 30) {
        *y = next;
        y->changes++;
    } else {
        brute_step(scene, y, t, 0.5 * dt, depth + 1);
        brute_step(scene, y, t + 0.5 * dt, 0.5 * dt, depth + 1);
    }
}

static State brute_force(const Case* one) {
    const Moment at = moment(&one->scene, 0.0);
    State y = {.delta = one->start.delta};
    y.side = one->start.slips != 0 ? one->start.slips : y.delta < 0.0 ? -1 : 1;
    const bool on_bound = y.side * y.delta >= at.D_slip * (1.0 - 1e-13);
    const bool may_slip = one->start.slips != 0 || one->friction.model != FC_ELASTIC_PLASTIC ||
                          one->friction.staticRatio == 1.0;
    if (may_slip && on_bound && push_on(&one->scene, &at, y.side) > 0.0) {
        y.regime = ON_BOUND;
    } else if (one->start.slips != 0) {
        y.regime = CATCHES_UP;
    }
    const double steps = ceil(3e4 * one->h * F) + 100.0;
    for (double i = 0.0; i < steps; i += 1.0) {
        brute_step(&one->scene, &y, one->h * i / steps, one->h / steps, 0);
    }
    return y;
}

// ---- scenes ----

static double either_sign(void) { return 2.0 * random_01() - 1.0; }

// Laws by turns. kappa of 0.03 to 30, everything moves or not, the load by less than a half.
static void draw(Case* one, int k) {
    const int contacts[] = {FC_CONTACT_ASPERITIES, FC_CONTACT_MINDLIN, FC_CONTACT_CONSTANT};
    const int laws[] = {FC_ELASTIC_PLASTIC, FC_ELASTIC_PLASTIC, FC_DAHL, FC_LUGRE};
    const int input = random_01() < 0.5 ? FC_CONTACT_LOAD : FC_CONTACT_SEPARATION;
    one->contact = table_1(contacts[(int)(3.0 * random_01())], input);
    const double V_1 = random_01() < 0.2 ? 0.0 : random_log(0.05, 2.0);
    one->friction = (FcFriction){
        .model = laws[k % 4],
        .limit = k % 4 > 1 || random_01() < 0.6 ? FC_LIMIT_LOAD : FC_LIMIT_CONSTANT,
        .mu = 0.2,
        .staticRatio = k % 4 == 0 || k % 4 == 2 ? 1.0 : 1.0 + random_log(0.05, 1.5),
        .V_S = (V_1 + 0.05) * random_log(0.03, 3.0),
        .sigma_1 = 1.0,
    };
    one->h = random_log(0.05, 1.5) / F;
    const double rate = random_01() < 0.5 ? 0.0 : 1.0 / one->h;
    const FcDrive drive = fc_drive_make(
        (FcLinearInput){(V_1 + 0.1) * 1.5 * either_sign(), rate * (V_1 + 0.1) * either_sign()},
        (FcLinearInput){14e-6, 1e-6 * rate * either_sign()},
        (FcLinearInput){58e9, 0.3 * 58e9 * rate * either_sign()},
        (FcLinearInput){300.0, 150.0 * rate * either_sign()},
        (FcVibration){.f = F,
                      .V_1 = V_1,
                      .a_d = random_01() < 0.3 ? 0.0 : random_log(k % 4 < 2 ? 1e-8 : 3e-7, 3e-6),
                      .phase_d = TWO_PI * random_01()},
        random_01() / F, 0.0);
    FcContactAtModulus at_E = fc_contact_at_modulus(&one->contact, 58e9);
    one->scene = fc_scene_make(&one->contact, &at_E, &one->friction, 60.0, &drive);
    const double kappa = random_log(0.03, 30.0);
    const double wanted = kappa * 60.0 * TWO_PI * F / (V_1 + 0.1);
    const double factor = wanted / fc_scene_stiffness(&one->scene, 0.0);
    one->contact.stiffnessScale *= factor;
    one->contact.sigma *= factor;
    at_E = fc_contact_at_modulus(&one->contact, 58e9);
    one->scene = fc_scene_make(&one->contact, &at_E, &one->friction, 60.0, &drive);
    const Moment start = moment(&one->scene, 0.0);
    const double delta = start.D_static * 1.2 * either_sign();
    const bool slips = k % 4 == 1 && random_01() < 0.4; // on its bound, or inside
    const FcBristle from = {.delta = delta, .slips = slips ? (delta < 0.0 ? -1 : 1) : 0};
    const FcBristle reached = fc_reach(&one->scene, from);
    one->start = (FcStepResult){.delta = reached.delta, .slips = reached.slips};
    const double limit =
        fmax(fc_scene_mean_limit(&one->scene, 0.0), fc_scene_mean_limit(&one->scene, one->h));
    one->options = (FcSolverOptions){.tolerance = TOLERANCE,
                                     .force = one->friction.staticRatio *
                                              fmax(limit, start.sigma * fabs(reached.delta))};
}

static double path_of(const Case* one) { return fc_drive_largest_speed(&one->scene.drive, one->h) * one->h; }

// Whether there was a meeting, or an end of a slip.
static bool is_as_brute_force(const Case* one) {
    FcStepResult got = one->start;
    fc_march_step(&one->scene, &one->options, one->h, &got);
    const State expected = brute_force(one);
    const double force = (TOLERANCE + OF_REFERENCE) * one->options.force;
    const double sigma = fc_scene_stiffness(&one->scene, one->h);
    CHECK_WITHIN(sigma * got.delta, sigma * expected.delta, force);
    CHECK_WITHIN(got.impulse, expected.impulse, force * one->h);
    CHECK_WITHIN(got.work, expected.work, force * path_of(one));
    CHECK_WITHIN(got.heat, expected.heat, force * path_of(one));
    // of the damping, which the tolerance divides by what it adds (friction_contact.c)
    CHECK_WITHIN(got.drag, expected.drag,
                 3.0 * force / one->options.force * path_of(one) * path_of(one) / one->h);
    if (fc_has_static_friction(&one->friction)) {
        CHECK(got.slips == (expected.regime == FREE ? 0 : expected.side));
    }
    const bool starts_inside = fabs(one->start.delta) < 0.999 * moment(&one->scene, 0.0).D_static;
    CHECK(expected.changes == 0 || !starts_inside || fc_march_may_touch(&one->scene));
    return expected.changes > 0;
}

static void random_scenes(void) {
    int of_law[4] = {0}; // scenes in which something happens
    for (int k = 0; k < 400; k++) {
        Case one;
        draw(&one, k);
        of_law[k % 4] += is_as_brute_force(&one);
    }
    for (int law = 0; law < 4; law++) {
        CHECK(of_law[law] > 10);
    }
}

// With a constant stiffness the work is what is stored and the heat, whatever the regimes.
static void work_is_stored_or_heat(void) {
    for (int k = 0; k < 400; k++) {
        Case one;
        draw(&one, k);
        one.contact.model = FC_CONTACT_CONSTANT;
        const FcContactAtModulus at_E = fc_contact_at_modulus(&one.contact, 58e9);
        one.scene = fc_scene_make(&one.contact, &at_E, &one.friction, 60.0, &one.scene.drive);
        const FcBristle reached =
            fc_reach(&one.scene, (FcBristle){.delta = one.start.delta, .slips = one.start.slips});
        FcStepResult got = {.delta = reached.delta, .slips = reached.slips};
        fc_march_step(&one.scene, &one.options, one.h, &got);
        const double stored =
            0.5 * one.contact.sigma * (got.delta * got.delta - reached.delta * reached.delta);
        CHECK_WITHIN(got.work, stored + got.heat, 2.0 * TOLERANCE * one.options.force * path_of(&one));
    }
}

// The map of a period is what the march makes of any start, the bound being far away.
static void a_map_of_one_that_sticks(void) {
    for (int k = 0; k < 400; k += 4) { // staticRatio = 1
        Case one;
        draw(&one, k);
        one.friction.mu *= 1e4;
        FcDrive drive = one.scene.drive;
        drive.V.rate = drive.d.rate = drive.E.rate = drive.load.rate = 0.0;
        drive.load.value = 300.0;
        one.scene = fc_scene_make(&one.contact, &one.scene.at_E, &one.friction, 6e5, &drive);
        double evaluations = 0.0;
        const FcMap map = fc_march_stuck(&one.scene, &one.options, 1.0 / F, &evaluations);
        FcStepResult by_map = one.start;
        fc_map_apply(&map, &by_map);
        FcStepResult marched = one.start;
        fc_march_step(&one.scene, &one.options, 1.0 / F, &marched);
        const double force = TOLERANCE * one.options.force;
        const double path = fc_drive_largest_speed(&drive, 1.0 / F) / F;
        CHECK(marched.meetings == 0 && map.relaxation == 0.0);
        CHECK_WITHIN(by_map.delta, marched.delta, 1e-14 * (path + fabs(marched.delta)));
        CHECK_WITHIN(by_map.impulse, marched.impulse, force / F);
        CHECK_WITHIN(by_map.work, marched.work, force * path);
        CHECK_WITHIN(by_map.drag, marched.drag, 1e-12 * path * path * F);
    }
}

// A step in two, cut anywhere, the second from where the first has come.
static void a_step_may_be_cut(void) {
    for (int k = 0; k < 2000; k++) {
        Case one;
        draw(&one, k);
        one.options.tolerance = 1e-7;
        const double cut = one.h * random_01();
        FcStepResult whole = one.start;
        fc_march_step(&one.scene, &one.options, one.h, &whole);
        FcStepResult parts = one.start;
        fc_march_step(&one.scene, &one.options, cut, &parts);
        const FcScene rest = fc_scene_from(&one.scene, cut);
        const FcBristle reached = fc_reach(&rest, (FcBristle){.delta = parts.delta, .slips = parts.slips});
        parts.delta = reached.delta;
        parts.slips = reached.slips;
        fc_march_step(&rest, &one.options, one.h - cut, &parts);
        const double force = 3.0 * one.options.tolerance * one.options.force;
        const double sigma = fc_scene_stiffness(&one.scene, one.h);
        CHECK_WITHIN(sigma * parts.delta, sigma * whole.delta, force);
        CHECK(parts.slips == whole.slips);
        CHECK_WITHIN(parts.impulse, whole.impulse, force * one.h);
        CHECK_WITHIN(parts.work, whole.work, force * path_of(&one));
        CHECK_WITHIN(parts.heat, whole.heat, force * path_of(&one));
    }
}

int main(void) {
    random_scenes();
    work_is_stored_or_heat();
    a_map_of_one_that_sticks();
    a_step_may_be_cut();
    return check_result();
}
