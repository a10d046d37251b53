// The bound of the elastic-plastic bristle: what one evaluation gives, against the scene and against differences.
#include "solver/stick_slip/bound.h"

#include "check.h"
#include "moving_scene.h"
#include "random.h"

static double bound(const FcScene* scene, double t) { return fc_bound_motion(scene, t).D; }

static double rate(const FcScene* scene, double t) { return fc_bound_motion(scene, t).D_rate; }

static void motion_agrees_with_the_scene(const FcScene* scene, double t) {
    const FcBoundMotion now = fc_bound_motion(scene, t);
    const FcCoefficients at = fc_scene_coefficients(scene, t);
    CHECK_NEAR(now.V, at.V, 1e-14);
    CHECK_NEAR(now.V_rate, fc_drive_V_rate(&scene->drive, t), 1e-13);
    CHECK_NEAR(now.sigma, at.sigma, 1e-13);
    CHECK_NEAR(now.limit, at.limit, 1e-13);
    CHECK_NEAR(now.D, at.limit / at.sigma, 1e-13);
    CHECK_NEAR(now.d, fc_scene_d(scene, t), 1e-14);
    CHECK_WITHIN(now.d_rate, fc_scene_d_rate(scene, t), 1e-13 * TWO_PI * F * 1.1e-6);
}

// A rate's differences are off by less than 1e-7 of omega times it; E' and load' change by d' once more.
static void rates_are_derivatives(const FcScene* scene, double t) {
    const double omega = TWO_PI * F;
    const FcBoundMotion now = fc_bound_motion(scene, t);
    CHECK_WITHIN(now.D_rate, slope(bound, scene, t), 1e-7 * omega * now.D);
    CHECK_WITHIN(now.D_curvature, slope(rate, scene, t), 1e-6 * omega * omega * now.D);
}

static void what_stands_still_is_known(const FcScene* scene) {
    bool sigma_moves = false, limit_moves = false, D_moves = false;
    const FcBoundMotion first = fc_bound_motion(scene, 0.0);
    for (double t = 0.0; t < PERIOD; t += 0.09 * PERIOD) {
        const FcBoundMotion now = fc_bound_motion(scene, t);
        sigma_moves |= fabs(now.sigma / first.sigma - 1.0) > 1e-12;
        const double curve = fc_stribeck(scene->friction, now.V) / fc_stribeck(scene->friction, first.V);
        limit_moves |= fabs(now.limit / first.limit / curve - 1.0) > 1e-12;
        D_moves |= fabs(now.D / first.D - 1.0) > 1e-12;
    }
    CHECK(fc_scene_stiffness_is_constant(scene) == !sigma_moves);
    CHECK(fc_scene_limit_is_constant(scene) == !limit_moves);
    CHECK(fc_bound_is_constant(scene) == !D_moves);
}

static void are_alike(const FcBoundMotion* a, const FcBoundMotion* b, double omega) {
    CHECK_WITHIN(a->t, b->t, 1e-15 / omega);
    CHECK_WITHIN(a->V, b->V, 1e-13);
    CHECK_WITHIN(a->V_rate, b->V_rate, 1e-13 * omega);
    CHECK_NEAR(a->sigma, b->sigma, 1e-13);
    CHECK_NEAR(a->limit, b->limit, 1e-13);
    CHECK_NEAR(a->D, b->D, 1e-13);
    CHECK_WITHIN(a->D_rate, b->D_rate, 1e-13 * omega * b->D);
}

// Two periods of them, one after the other.
static void many_motions_are_each_as_alone(const FcScene* scene) {
    enum { COUNT = 33 };
    FcBoundMotion at[COUNT];
    fc_bound_motions(scene, 0.1 * PERIOD, PERIOD / 16, COUNT, at);
    for (int i = 0; i < COUNT; i++) {
        const FcBoundMotion alone = fc_bound_motion(scene, 0.1 * PERIOD + i * (PERIOD / 16));
        are_alike(&at[i], &alone, TWO_PI * F);
    }
}

// Nearby the errors fall with the third power of the distance.
static void nearby_it_is_a_parabola(const FcScene* scene, double t) {
    const FcBoundMotion at = fc_bound_motion(scene, t);
    double error[2];
    for (int k = 0; k < 2; k++) {
        const double later = t + (k == 0 ? 1e-2 : 1e-3) * PERIOD;
        const FcBoundMotion there = fc_bound_motion(scene, later);
        const FcBoundMotion nearby = fc_bound_nearby(scene, &at, later);
        CHECK(nearby.t == later);
        error[k] = fabs(nearby.D - there.D) / there.D;
        CHECK_WITHIN(nearby.V, there.V, 1e-2); // of second order
        CHECK_WITHIN(nearby.d, there.d, 1e-2 * fabs(nearby.d - at.d));
    }
    CHECK(error[0] < 3e-3 && error[1] < 1e-12 + 3e-3 * error[0]);
}

static void of_a_standing_bound_V_moves_alone(const FcScene* scene, double t) {
    const FcBoundMotion now = fc_bound_motion(scene, t);
    const FcBoundMotion at = {.t = 1.0, .V = 2.0, .D = 3.0, .limit = 4.0};
    const FcBoundMotion standing = fc_bound_standing(scene, &at, t);
    CHECK(standing.D == 3.0 && standing.D_rate == 0.0 && standing.limit == 4.0 && standing.t == t);
    CHECK_NEAR(standing.V, now.V, 1e-15);
    CHECK_NEAR(standing.V_rate, now.V_rate, 1e-15);
}

static void the_common_smooth_time_is_nowhere_too_long(const FcScene* scene) {
    const double common = fc_bound_common_smooth_time(scene, PERIOD);
    CHECK(common > 0.0 || scene->floats || scene->drive.E.rate != 0.0 ||
          fc_has_stribeck_curve(scene->friction));
    for (double t = 0.0; t < PERIOD; t += 0.01 * PERIOD) {
        const double rate = TWO_PI * F + fabs(fc_scene_log_rates(scene, t).sigma);
        CHECK(common * rate < 1.0 + 1e-12);
    }
}

// Beyond the bound a bristle loses sigma (delta^2 - D^2) / 2.
static void what_is_beyond_is_lost(void) {
    const FcBoundMotion at = {.sigma = 3.0, .D = 2.0};
    CHECK(fc_bound_reached(&at, 1.5) == 1.5 && fc_bound_loss(&at, 1.5) == 0.0);
    CHECK(fc_bound_reached(&at, 4.0) == 2.0 && fc_bound_loss(&at, 4.0) == 18.0);
    CHECK(fc_bound_reached(&at, -4.0) == -2.0 && fc_bound_loss(&at, -4.0) == 18.0);
}

// The x at which speed x + acceleration x^2 / 2 is the distance, by bisection.
static double time_to_move(double speed, double acceleration, double distance) {
    double a = 0.0, b = 1e9;
    while (b - a > 1e-15 * b) {
        const double x = a < 1e-6 * b ? 1e-3 * b : 0.5 * (a + b);
        *(speed * x + 0.5 * acceleration * x * x < distance ? &a : &b) = x;
    }
    return b;
}

// The phase and the logarithms of sigma and g move by 1 in it at the most, omega x + slope (|d'| x + a_d omega^2 x^2 / 2) = 1;
// but far apart, where both are 0 in rounding, it ends before d may be back, or with the phase; and everywhere before d, E or
// the load may fall to zero.
static double expected_smooth_time(const FcScene* scene, double d, double d_rate) {
    const FcDrive* drive = &scene->drive;
    const double omega = drive->omega;
    const double decay = scene->at_E.decay;
    const double slope = scene->at_E.model == FC_CONTACT_ASPERITIES ? 2.0 * decay + 3.0 / d : decay;
    const double acceleration = drive->vibration.a_d * omega * omega;
    double x = time_to_move(omega + slope * fabs(d_rate), slope * acceleration, 1.0);
    const double gone = 750.0 / decay;
    if (d > gone && !scene->floats) {
        const double back = 0.08 * time_to_move(fabs(d_rate), acceleration, d - gone);
        x = fmax(x, omega > 0.0 ? fmin(back, 1.0 / omega) : back);
    }
    const double poles[] = {time_to_move(fabs(d_rate), acceleration, d), drive->E.value / fabs(drive->E.rate),
                            drive->load.value / fabs(drive->load.rate)};
    for (int i = 0; i < 3; i++) {
        x = fmin(x, 0.12 * poles[i]);
    }
    return x;
}

// With a Stribeck curve V moves by half of V_S too, or until it may be back from beyond 6 V_S: the rates add up.
static double with_stribeck_curve(const FcScene* scene, double time) {
    const FcFriction* friction = scene->friction;
    if (friction->staticRatio == 1.0) {
        return time;
    }
    const double fastest = scene->drive.vibration.V_1 * scene->drive.omega;
    const double V = fabs(0.1 + scene->drive.vibration.V_1 * cos(scene->drive.theta_0));
    return 1.0 / (1.0 / time + fastest / fmax(0.5 * friction->V_S, 0.08 * (V - 6.0 * friction->V_S)));
}

static void smooth_times(void) {
    int far = 0;
    for (int k = 0; k < 200 * KINDS; k++) {
        Kind one = kind(k);
        one.friction.model = FC_ELASTIC_PLASTIC;
        one.friction.staticRatio = random_01() < 0.5 ? 1.0 : 1.5;
        one.friction.V_S = random_log(1e-3, 1.0);
        const bool vibrates = random_01() < 0.7;
        const FcVibration vibration = {.f = random_log(1.0, 1e5),
                                       .V_1 = vibrates ? 0.3 : 0.0,
                                       .a_d = vibrates ? random_log(1e-8, 13e-6) : 0.0,
                                       .phase_d = TWO_PI * random_01()};
        const double d_start = random_01() < 0.6 ? 14e-6 : random_log(1.5e-3, 1e-2);
        const double d_moves = random_01() < 0.5 ? 0.0 : random_log(1e-4, 100.0) * (random_01() - 0.5);
        const double E_moves = random_01() < 0.5 ? 0.0 : random_log(1.0, 1e5) * 9e9 * (random_01() - 0.5);
        const double load_moves =
            random_01() < 0.5 ? 0.0 : random_log(1.0, 1e5) * 312.0 * (random_01() - 0.5);
        const FcDrive drive = fc_drive_make((FcLinearInput){0.1, 0.0}, (FcLinearInput){d_start, d_moves},
                                            (FcLinearInput){9e9, E_moves}, (FcLinearInput){312.0, load_moves},
                                            vibration, random_01(), 0.0);
        const FcContactAtModulus at_E = fc_contact_at_modulus(&one.contact, 9e9);
        const FcScene scene = fc_scene_make(&one.contact, &at_E, &one.friction, 55.0, &drive);
        const double d = fc_scene_d(&scene, 0.0);
        const double d_rate = fc_scene_d_rate(&scene, 0.0);
        if (!(d > 0.0)) {
            continue;
        }
        const FcBoundMotion at = {.V = 0.1 + vibration.V_1 * cos(drive.theta_0), .d = d, .d_rate = d_rate};
        const double x = fc_bound_smooth_time(&scene, &at);
        if (fc_scene_stiffness_is_constant(&scene) && fc_scene_limit_is_constant(&scene)) {
            const double expected = with_stribeck_curve(&scene, 1.0 / drive.omega);
            CHECK(x == expected || fabs(x / expected - 1.0) < 1e-12);
            continue;
        }
        CHECK_NEAR(x, with_stribeck_curve(&scene, expected_smooth_time(&scene, d, d_rate)), 1e-12);
        far += d > 750.0 / at_E.decay;
    }
    CHECK(far > 300);
}

// A bristle on its bound relaxes at the rate sigma |V| / g, over |V| / D: k is the bound over the law's limit at V.
static void on_its_bound_a_bristle_relaxes(void) {
    for (int model = FC_DAHL; model <= FC_LUGRE; model += FC_LUGRE - FC_DAHL) {
        const FcFriction friction = law(model, FC_LIMIT_LOAD);
        FcBoundMotion at[3] = {{.V = 0.0}, {.V = -0.1}, {.V = 0.35}};
        fc_bound_relaxes(&friction, 3, at);
        for (int i = 0; i < 3; i++) {
            const double curve = 1.0 + 0.5 * exp(-at[i].V * at[i].V / 0.04);
            const double slope = -2.0 * at[i].V / 0.04 * (curve - 1.0);
            CHECK_NEAR(at[i].k, model == FC_LUGRE ? 1.5 / curve : 1.0, 1e-14);
            CHECK_WITHIN(at[i].k_slope, model == FC_LUGRE ? -1.5 * slope / (curve * curve) : 0.0, 1e-13);
        }
    }
}

// Without vibration and with E held, D falls only if the surfaces go the one way: apart with a constant stiffness, together
// with asperities, whose stiffness rises more than the load. Mindlin's D stands still.
static void a_bound_falls_one_way(void) {
    for (int model = FC_CONTACT_ASPERITIES; model <= FC_CONTACT_MINDLIN; model++) {
        for (double rates = -1.0; rates <= 1.0; rates += 1.0) {
            for (int input = FC_CONTACT_SEPARATION; input <= FC_CONTACT_LOAD; input++) {
                const FcContactParameters contact = table_1(model, input);
                FcFriction friction = law(FC_ELASTIC_PLASTIC, FC_LIMIT_LOAD);
                friction.staticRatio = 1.0;
                FcDrive drive = moving_scene(&contact, &friction, rates).drive;
                drive = fc_drive_make(drive.V, (FcLinearInput){14e-6, 0.02 * rates},
                                      (FcLinearInput){9e9, 0.0}, drive.load, (FcVibration){.f = F}, 0.0, 0.0);
                drive.load = (FcLinearInput){312.0, -1e6 * rates};
                const FcContactAtModulus at_E = fc_contact_at_modulus(&contact, 9e9);
                FcScene scene = fc_scene_make(&contact, &at_E, &friction, 55.0, &drive);
                const bool falls = bound(&scene, PERIOD) < bound(&scene, 0.0) * (1.0 - 1e-9);
                CHECK(fc_bound_may_fall(&scene) == falls);
            }
        }
    }
}

int main(void) {
    on_its_bound_a_bristle_relaxes();
    a_bound_falls_one_way();
    smooth_times();
    what_is_beyond_is_lost();
    for (int k = 0; k < KINDS; k++) {
        Kind one = kind(k);
        one.friction.model = FC_ELASTIC_PLASTIC;
        for (double rates = 0.0; rates <= 1.0; rates += 1.0) {
            const FcScene scene = moving_scene(&one.contact, &one.friction, rates);
            for (double t = 0.01 * PERIOD; t < PERIOD; t += 0.09 * PERIOD) {
                motion_agrees_with_the_scene(&scene, t);
                rates_are_derivatives(&scene, t);
                nearby_it_is_a_parabola(&scene, t);
                of_a_standing_bound_V_moves_alone(&scene, t);
            }
            many_motions_are_each_as_alone(&scene);
            the_common_smooth_time_is_nowhere_too_long(&scene);
            what_stands_still_is_known(&scene);
        }
    }
    return check_result();
}
