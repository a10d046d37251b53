// The error of a panel that is told beforehand, against its true one: the equation integrated in long double.
#include "solver/gauss_panel.h"

#include "check.h"
#include "random.h"
#include "solver/budget.h"
#include "table_1.h"

static const double F_C = 55.0;
static const double OMEGA = 6.283185307179586 * 20e3;

typedef struct {
    FcContactParameters contact;
    FcFriction friction;
    FcScene scene;
    double h;
} Panel;

// Half the angle and half of what ln(sigma) moves by up to 2, any phase, model and limit, on which V keeps its sign. A third
// begin or end where V reverses.
static bool draw(Panel* panel) {
    const int models[] = {FC_CONTACT_ASPERITIES, FC_CONTACT_MINDLIN, FC_CONTACT_CONSTANT};
    panel->contact = table_1(models[(int)(3.0 * random_01())], FC_CONTACT_SEPARATION);
    panel->contact.sigma = 1e6;
    panel->contact.stiffnessScale = random_log(1e-9, 1e-4);
    panel->friction = (FcFriction){.model = FC_DAHL,
                                   .limit = random_01() < 0.3 ? FC_LIMIT_LOAD : FC_LIMIT_CONSTANT,
                                   .mu = 0.176,
                                   .staticRatio = 1.0,
                                   .V_S = 0.1};
    panel->h = random_log(0.02, 4.0) / OMEGA;
    FcVibration vibration = {
        .f = 20e3, .V_1 = random_log(0.01, 3.0), .a_d = 0.0, .phase_d = 7.0 * random_01()};
    FcLinearInput V = {.value = (2.0 * random_01() - 1.0) * 3.0};
    FcLinearInput d = {.value = 14e-6};
    if (random_01() < 0.7) {
        vibration.a_d = random_log(1e-8, 3e-6);
    }
    if (random_01() < 0.4) {
        V.rate = (2.0 * random_01() - 1.0) / panel->h;
        d.rate = (2.0 * random_01() - 1.0) * 2e-6 / panel->h;
    }
    const FcContactAtModulus at_E = fc_contact_at_modulus(&panel->contact, 58e9);
    FcDrive drive = fc_drive_make(V, d, (FcLinearInput){58e9, 0.0}, (FcLinearInput){200.0, 0.0}, vibration,
                                  random_01() / 20e3, 0.0);
    const double event = fc_drive_next_event(&drive, 0.0, panel->h).time;
    if (event < panel->h) { // from there on, or up to there
        if (random_01() < 0.5) {
            panel->h = event;
        } else {
            drive.theta_0 += OMEGA * event;
            drive.V.value += V.rate * event;
            drive.d.value += d.rate * event;
            panel->h = fc_drive_next_event(&drive, 0.0, panel->h).time;
        }
    }
    panel->scene = fc_scene_make(&panel->contact, &at_E, &panel->friction, F_C, &drive);
    return panel->h > 1e-9;
}

typedef struct {
    long double delta, impulse, work, heat, path;
} State;

static State slope(const FcScene* scene, double t, const State* y) {
    const FcCoefficients at = fc_scene_coefficients(scene, t);
    const long double slip = (long double)at.sigma * fabs(at.V) / at.limit * y->delta;
    const long double force = at.sigma * y->delta;
    return (State){at.V - slip, force, force * at.V, force * slip, fabs(at.V)};
}

static State moved(const State* y, long double h, const State* k) {
    return (State){y->delta + h * k->delta, y->impulse + h * k->impulse, y->work + h * k->work,
                   y->heat + h * k->heat, y->path + h * k->path};
}

// Runge-Kutta of fourth order in 400 steps: errors of some 1e-10.
static State exact(const FcScene* scene, double h, double delta_0) {
    enum { STEPS = 400 };
    State y = {.delta = delta_0};
    const long double step = h / (long double)STEPS;
    for (int i = 0; i < STEPS; i++) {
        const double t[] = {h * i / STEPS, h * (i + 0.5) / STEPS, h * (i + 1) / STEPS};
        const State k1 = slope(scene, t[0], &y);
        const State y1 = moved(&y, step / 2, &k1);
        const State k2 = slope(scene, t[1], &y1);
        const State y2 = moved(&y, step / 2, &k2);
        const State k3 = slope(scene, t[1], &y2);
        const State y3 = moved(&y, step, &k3);
        const State k4 = slope(scene, t[2], &y3);
        const State* k[] = {&k1, &k2, &k3, &k4};
        for (int j = 0; j < 4; j++) {
            y = moved(&y, step / (j == 0 || j == 3 ? 6 : 3), k[j]);
        }
    }
    return y;
}

// The largest error of the panel that the solver takes, over its share of the tolerance; its nodes in *count, 0 where it
// takes none.
static double excess(const Panel* panel, double tolerance, double start, int* count) {
    const FcScene* scene = &panel->scene;
    const FcSolverOptions options = {.tolerance = tolerance, .force = fc_scene_mean_limit(scene, 0.0)};
    const FcInterval interval = fc_interval_make(scene, scene, panel->h, &options);
    const double X = fc_drive_displacement(&scene->drive, 0.0, panel->h);
    const FcTrajectories from = {.delta_0 = start * interval.limit / interval.stiffness, .speed = 1.0};
    const double z = interval.stiffness * fabs(X) / interval.limit;
    FcPanel of;
    double evaluations = 0.0;
    *count = 0;
    if (!fc_bounded_panel(&interval, scene, 0.0, panel->h, X, z, &from, &of, &evaluations) || of.z < 1e-3) {
        return 0.0;
    }
    *count = (int)evaluations;
    const State right = exact(scene, panel->h, from.delta_0);
    const double allowed = FC_SHARE_OF_BOUNDED_PANEL * fc_allowed_force(&interval) + 1e-9 * F_C;
    FcStepResult got = {.delta = from.delta_0};
    fc_map_apply(&of.map, &got);
    const double sigma = fc_scene_stiffness(scene, panel->h);
    const double errors[] = {
        sigma * fabs(got.delta - (double)right.delta) / fmin(1.0, of.z),
        fabs(got.impulse - (double)right.impulse) / panel->h,
        fabs(got.work - (double)right.work) / (double)right.path,
        fabs(got.heat - (double)right.heat) / (double)right.path,
    };
    double largest = 0.0;
    for (int i = 0; i < 4; i++) {
        largest = fmax(largest, errors[i] / allowed);
    }
    return largest;
}

static void errors_are_bounded(void) {
    static const double STARTS[] = {-1.0, 0.0, 0.7};
    int panels_of[13] = {0}; // by their nodes
    for (int k = 0; k < 8000; k++) {
        Panel panel;
        if (!draw(&panel)) {
            continue;
        }
        int count;
        const double got = excess(&panel, random_log(1e-8, 1e-2), STARTS[k % 3], &count);
        CHECK(got <= 1.0);
        panels_of[count]++;
    }
    CHECK(panels_of[4] > 400 && panels_of[6] > 400 && panels_of[8] > 400 && panels_of[12] > 400);
}

int main(void) {
    errors_are_bounded();
    return check_result();
}
