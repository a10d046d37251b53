// An interval of constant contact against the path-wise closed form in long double, time by Simpson's rule on a fine grid.
#include "solver/constant_contact.h"

#include "check.h"
#include "model/constants.h"
#include "random.h"
#include "table_1.h"

static const double LIMIT = 55.0;
static const FcFriction DAHL = {
    .model = FC_DAHL, .limit = FC_LIMIT_CONSTANT, .staticRatio = 1.0, .V_S = 0.05};
static FcContactParameters contact;

static FcScene scene_of(const FcFriction* friction, double sigma, FcLinearInput V, FcVibration vibration,
                        double start) {
    contact = table_1(FC_CONTACT_CONSTANT, FC_CONTACT_SEPARATION);
    contact.sigma = sigma;
    const FcContactAtModulus at_E = fc_contact_at_modulus(&contact, 58e9);
    const FcDrive drive = fc_drive_make(V, (FcLinearInput){14e-6, 0.0}, (FcLinearInput){58e9, 0.0},
                                        (FcLinearInput){200.0, 0.0}, vibration, start, 0.0);
    return fc_scene_make(&contact, &at_E, friction, LIMIT, &drive);
}

typedef struct {
    long double delta, impulse, work, heat, drag;
} Exact;

static long double velocity(const FcDrive* drive, long double t) {
    return drive->V.value + drive->V.rate * t +
           drive->vibration.V_1 * cosl(drive->omega * t + (long double)drive->theta_0);
}

static long double position(const FcDrive* drive, long double t) {
    const long double linear = drive->V.value * t + 0.5L * drive->V.rate * t * t;
    return drive->vibration.V_1 == 0.0 ? linear
                                       : linear + drive->vibration.V_1 / (long double)drive->omega *
                                                      sinl(drive->omega * t + (long double)drive->theta_0);
}

// In cells so short that the few in which V turns don't count; in each the force goes with the path.
static Exact exact(const FcScene* scene, long double h, long double delta_0) {
    enum { CELLS = 20000 };
    const long double sigma = scene->at_E.stiffness_0;
    Exact result = {.delta = delta_0};
    long double x = position(&scene->drive, 0.0L);
    for (int k = 0; k < CELLS; k++) {
        const long double begin = h * k / CELLS;
        const long double middle = h * (2 * k + 1) / (2 * CELLS);
        const long double end = h * (k + 1) / CELLS;
        const long double moved[2] = {position(&scene->drive, middle) - x, position(&scene->drive, end) - x};
        long double delta[2];
        for (int i = 0; i < 2; i++) {
            const long double D = copysignl(LIMIT / sigma, moved[i]);
            delta[i] = result.delta - (result.delta - D) * -expm1l(-moved[i] / D);
        }
        const long double times[3] = {begin, middle, end};
        const long double F[3] = {sigma * result.delta, sigma * delta[0], sigma * delta[1]};
        const long double weight[3] = {1.0L / 6, 4.0L / 6, 1.0L / 6};
        for (int i = 0; i < 3; i++) {
            const long double dt = weight[i] * h / CELLS;
            const long double V = velocity(&scene->drive, times[i]);
            const long double rate = V - fabsl(V) * F[i] / LIMIT; // of the deflection
            result.impulse += dt * F[i];
            result.work += dt * F[i] * V;
            result.heat += dt * F[i] * (V - rate);
            result.drag += dt * rate * V;
        }
        result.delta = delta[1];
        x += moved[1];
    }
    return result;
}

// Of a map for any start, from two of them.
static void check(const FcScene* scene, double h, double tolerance) {
    const double D = LIMIT / scene->at_E.stiffness_0;
    const double path = h * fc_drive_largest_speed(&scene->drive, h);
    const double starts[] = {0.4 * D, -0.9 * D};
    FcMap map;
    double evaluations = 0.0;
    CHECK(fc_constant_contact_interval(scene, tolerance, h, starts[0], FC_MAP_ANY_START, &map, &evaluations));
    CHECK(evaluations >= 4.0 && evaluations == floor(evaluations));
    for (int i = 0; i < 2; i++) {
        FcStepResult got = {.delta = starts[i]};
        fc_map_apply(&map, &got);
        const Exact expected = exact(scene, h, starts[i]);
        const double allowed = fmax(tolerance, 1e-8) * LIMIT; // the grid's
        CHECK_WITHIN(got.delta, (double)expected.delta, 1e-8 * D);
        CHECK_WITHIN(got.impulse, (double)expected.impulse, allowed * h);
        CHECK_WITHIN(got.work, (double)expected.work, 1e-8 * LIMIT * path);
        CHECK_WITHIN(got.heat, (double)expected.heat, 1e-8 * LIMIT * path);
        CHECK_WITHIN(got.drag, (double)expected.drag, fmax(tolerance, 1e-8) * path * path / h);
    }
}

static void random_intervals_are_within_the_tolerance(void) {
    const double tolerances[] = {1e-2, 1e-4, 1e-6, 1e-8};
    for (int k = 0; k < 60; k++) {
        const double V_1 = k % 3 == 0 ? 0.0 : random_log(1e-3, 3.0);
        const double h = random_log(1e-7, 4.9e-5);
        const double V = (2.0 * random_01() - 1.0) * random_log(1e-3, 2.0);
        const double rate = k % 2 == 0 ? 0.0 : (2.0 * random_01() - 1.0) * 2.0 * V / h;
        const double speed = fabs(V) + fabs(rate) * h + V_1;
        const double sigma = random_log(1e-4, 5.0) * LIMIT / (speed * h); // relaxes by up to 5
        const FcVibration vibration = {.f = 20e3, .V_1 = V_1};
        const FcScene scene = scene_of(&DAHL, sigma, (FcLinearInput){V, rate}, vibration, random_01());
        check(&scene, h, tolerances[k % 4]);
    }
}

// From rest with V = a t: the mean over [0, h] of e^(-q t^2) is sqrt(pi / q) erf(h sqrt(q)) / 2 h.
static void an_acceleration_is_an_error_function(void) {
    const double sigma = 2.5e6;
    const double h = 5e-6;
    for (double a = 1e3; a < 2e6; a *= 3.0) {
        const FcScene scene = scene_of(&DAHL, sigma, (FcLinearInput){0.0, a}, (FcVibration){.f = 20e3}, 0.0);
        FcMap map;
        double evaluations = 0.0;
        CHECK(fc_constant_contact_interval(&scene, 1e-12, h, 0.0, FC_MAP_THIS_START, &map, &evaluations));
        const double root = sqrt(0.5 * sigma * a / LIMIT);
        const double left = 0.5 * sqrt(FC_PI) * erf(h * root) / (h * root);
        CHECK_WITHIN(map.impulse_offset, LIMIT * h * (1.0 - left), 1e-12 * LIMIT * h);
        CHECK_NEAR(map.impulse_slope, sigma * h * left, 1e-12);
    }
}

// Deep in presliding the map is that of a spring, with all its digits.
static void presliding_keeps_its_digits(void) {
    const FcScene scene = scene_of(&DAHL, 1e-6, (FcLinearInput){0.0, 10.0}, (FcVibration){.f = 20e3}, 0.0);
    const double h = 1e-6;
    const double x = 5.0 * h * h;
    FcMap map;
    double evaluations = 0.0;
    CHECK(fc_constant_contact_interval(&scene, 1e-6, h, 0.0, FC_MAP_THIS_START, &map, &evaluations));
    CHECK_NEAR(map.offset, x, 1e-15);
    CHECK_NEAR(map.impulse_offset, 1e-6 * x * h / 3.0, 1e-14);
    CHECK_NEAR(map.work_offset, 0.5e-6 * x * x, 1e-14);
    CHECK_NEAR(map.heat_offset, 1e-6 * x * x * (1e-6 * x / LIMIT) / 3.0, 1e-14);
}

static void what_relaxes_too_much_is_left_to_others(void) {
    const FcVibration none = {.f = 20e3};
    const FcScene scene = scene_of(&DAHL, 6.1 * LIMIT / 1e-6, (FcLinearInput){1.0, 0.0}, none, 0.0);
    FcMap map;
    double evaluations = 0.0;
    CHECK(!fc_constant_contact_interval(&scene, 1e-6, 1e-6, 0.0, FC_MAP_THIS_START, &map, &evaluations));
    CHECK(evaluations == 0.0);
}

static void only_constant_contacts_are_taken(void) {
    FcFriction friction = DAHL;
    const FcVibration vibration = {.f = 20e3, .V_1 = 0.3};
    FcScene scene = scene_of(&friction, 1e6, (FcLinearInput){1.0, 0.0}, vibration, 0.0);
    CHECK(fc_is_constant_contact(&scene));
    friction.model = FC_LUGRE;
    CHECK(fc_is_constant_contact(&scene)); // staticRatio 1: no Stribeck curve
    friction.staticRatio = 1.3;
    CHECK(!fc_is_constant_contact(&scene));
    friction = DAHL;
    scene.drive.d.rate = 1e-6;
    CHECK(fc_is_constant_contact(&scene));
    friction.limit = FC_LIMIT_LOAD;
    CHECK(!fc_is_constant_contact(&scene));
    friction.limit = FC_LIMIT_CONSTANT;
    scene.at_E.model = FC_CONTACT_ASPERITIES;
    CHECK(!fc_is_constant_contact(&scene));
    scene.drive.d.rate = 0.0;
    CHECK(fc_is_constant_contact(&scene));
}

int main(void) {
    random_intervals_are_within_the_tolerance();
    an_acceleration_is_an_error_function();
    presliding_keeps_its_digits();
    what_relaxes_too_much_is_left_to_others();
    only_constant_contacts_are_taken();
    return check_result();
}
