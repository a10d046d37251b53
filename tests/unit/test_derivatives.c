// The force's slope in time and the outputs' slopes by the inputs, against differences of the scene's own outputs: every
// contact, limit and law, damping and viscous friction included, bristles that stick and that slip.
#include "model/derivatives.h"

#include "check.h"
#include "moving_scene.h"
#include "random.h"

typedef struct {
    FcContactParameters contact;
    FcFriction friction;
    FcScene scene; // points to them
} Case;

static const double A_D = 1.1e-6; // m

static const double FREQUENCY = 19999.7; // Hz: a second holds no whole number of periods

static double of_either_sign(void) { return 2.0 * random_01() - 1.0; }

// Of inputs that move as fast as the vibration, or in minutes, or not at all.
static double rate_of_inputs(void) { return random_01() < 0.7 ? random_log(0.01, FREQUENCY) : 0.0; }

static double damping(void) {
    const double kind = random_01();
    return kind < 0.2 ? 0.0 : kind < 0.4 ? 1.0 : random_log(1.0, 100.0);
}

static double chosen(double probability, double value) { return random_01() < probability ? value : 0.0; }

static FcDrive random_drive(double E) {
    const double rate = rate_of_inputs();
    const double most = chosen(0.6, 1.0);
    const FcVibration vibration = {.f = FREQUENCY,
                                   .V_1 = chosen(0.8, most * random_log(0.05, 0.5)),
                                   .a_d = chosen(0.8, most * A_D * random_01()),
                                   .phase_d = TWO_PI * random_01()};
    return fc_drive_make(
        (FcLinearInput){copysign(random_log(0.01, 1.0), of_either_sign()), 0.1 * rate * of_either_sign()},
        (FcLinearInput){14e-6, chosen(0.6, 1e-6 * rate * of_either_sign())},
        (FcLinearInput){E, chosen(0.6, E * rate * of_either_sign())},
        (FcLinearInput){312.0, chosen(0.6, 312.0 * rate * of_either_sign())}, vibration,
        random_01() / FREQUENCY, 0.0);
}

static void make_random(Case* one, int k) {
    const int laws[] = {FC_DAHL, FC_LUGRE, FC_ELASTIC_PLASTIC, FC_COULOMB};
    const Kind made = kind(k);
    one->contact = made.contact;
    one->friction = made.friction;
    one->friction.model = laws[(int)(4.0 * random_01())];
    one->friction.sigma_1 = damping();
    one->friction.sigma_2 = damping();
    const double E = random_log(1e9, 60e9);
    const FcDrive drive = random_drive(E);
    FcContactAtModulus at_E = fc_contact_at_modulus(&one->contact, E);
    one->scene = fc_scene_make(&one->contact, &at_E, &one->friction, 55.0, &drive);
    // 1e5 to 1e9 N/m where the surfaces are now
    const double factor = random_log(1e5, 1e9) / fc_scene_stiffness(&one->scene, 0.0);
    one->contact.stiffnessScale *= factor;
    one->contact.sigma *= factor;
    at_E = fc_contact_at_modulus(&one->contact, E);
    one->scene = fc_scene_make(&one->contact, &at_E, &one->friction, 55.0, &drive);
}

// Of LuGre the bound is staticRatio times the limit without its curve.
static double bound(const FcScene* scene, double t) {
    const FcCoefficients at = fc_scene_coefficients(scene, t);
    const FcFriction* friction = scene->friction;
    const double ratio = at.V / friction->V_S;
    const double curve = 1.0 + (friction->staticRatio - 1.0) * exp(-ratio * ratio);
    return at.limit / at.sigma * (friction->model == FC_LUGRE ? friction->staticRatio / curve : 1.0);
}

// The deflection after t [s] from delta on: on the bound while it slips, else by one step of Runge and Kutta.
static double later(const FcScene* scene, double delta, double side, double t) {
    if (side != 0.0) {
        return side * bound(scene, t);
    }
    const double k_1 = fc_scene_deflection_rate(scene, 0.0, delta);
    const double k_2 = fc_scene_deflection_rate(scene, 0.5 * t, delta + 0.5 * t * k_1);
    const double k_3 = fc_scene_deflection_rate(scene, 0.5 * t, delta + 0.5 * t * k_2);
    const double k_4 = fc_scene_deflection_rate(scene, t, delta + t * k_3);
    return delta + t / 6.0 * (k_1 + 2.0 * k_2 + 2.0 * k_3 + k_4);
}

static double force_later(const FcScene* scene, double delta, double side, double t) {
    return fc_scene_outputs(scene, t, later(scene, delta, side, t)).F_t;
}

// What the rates of a scene may add up to [1/s]: differences over tau are off by (rate tau)^4 / 30 of the force.
static double fastest(const FcScene* scene) {
    const FcLogRates rates = fc_scene_log_rates(scene, 0.0);
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    const double of_V =
        fabs(fc_drive_V_rate(&scene->drive, 0.0)) * (1.0 / fabs(at.V) + 2.0 / scene->friction->V_S);
    return scene->drive.omega + fabs(rates.sigma) + fabs(rates.limit) + of_V + fc_relaxation_rate(&at);
}

// Of any law, sizes of its parts: the elastic one, that of damping and the viscous one [N].
static double force_scale(const FcScene* scene, double delta) {
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    return fabs(at.sigma * delta) + at.limit +
           scene->friction->sigma_1 * (fabs(at.V) + fabs(fc_scene_bound_rate(scene, 0.0))) +
           scene->friction->sigma_2 * fabs(at.V);
}

static void slope_in_time(const FcScene* scene, double delta, double side) {
    const double got = fc_force_rate(scene, delta);
    const double rate = fastest(scene);
    if (rate == 0.0) {
        CHECK(got == 0.0);
        return;
    }
    const double tau = 2e-3 / rate;
    const double slope =
        (8.0 * (force_later(scene, delta, side, tau) - force_later(scene, delta, side, -tau)) -
         (force_later(scene, delta, side, 2.0 * tau) - force_later(scene, delta, side, -2.0 * tau))) /
        (12.0 * tau);
    CHECK_WITHIN(got, slope, 1e-7 * (fabs(slope) + 1e-2 * rate * force_scale(scene, delta)));
}

// The scene with one input changed.
static FcScene with_input(const Case* one, int input, double change) {
    FcDrive drive = one->scene.drive;
    FcLinearInput* inputs[] = {&drive.V, &drive.d, &drive.E, &drive.load};
    inputs[input]->value += change;
    const FcContactAtModulus at_E = fc_contact_at_modulus(&one->contact, drive.E.value);
    return fc_scene_make(&one->contact, &at_E, &one->friction, 55.0, &drive);
}

static FcOutputs outputs_with(const Case* one, int input, double change, double delta, double side) {
    const FcScene scene = with_input(one, input, change);
    return fc_scene_outputs(&scene, 0.0, side != 0.0 ? side * bound(&scene, 0.0) : delta);
}

static FcSlopes difference(const FcOutputs* a, const FcOutputs* b, double distance) {
    return (FcSlopes){(b->F_t - a->F_t) / distance, (b->F_n - a->F_n) / distance,
                      (b->sigma - a->sigma) / distance, (b->A_r - a->A_r) / distance};
}

static double five_points(double near, double far) { return (4.0 * near - far) / 3.0; }

static void slopes_by_inputs(const Case* one, double delta, double side) {
    const FcGradient got = fc_gradient(&one->scene, delta);
    const FcDrive* drive = &one->scene.drive;
    const FcSlopes* slopes[] = {&got.by_V, &got.by_d, &got.by_E, &got.by_load};
    const double sizes[] = {fabs(drive->V.value), drive->d.value, drive->E.value, drive->load.value};
    const bool loaded = one->contact.input == FC_CONTACT_LOAD;
    const FcOutputs now = fc_scene_outputs(&one->scene, 0.0, delta);
    const double scale = force_scale(&one->scene, delta);
    for (int input = 0; input < 4; input++) {
        if (input == (loaded ? 1 : 3)) {
            CHECK(slopes[input]->F_t == 0.0 && slopes[input]->F_n == 0.0 && slopes[input]->sigma == 0.0);
            continue;
        }
        const double k = 5e-4 * (input == 0 ? fmin(sizes[0], 0.02) : sizes[input]);
        FcOutputs at[5];
        for (int i = 0; i < 5; i++) {
            at[i] = outputs_with(one, input, (i - 2) * k, delta, side);
        }
        const FcSlopes near = difference(&at[1], &at[3], 2.0 * k);
        const FcSlopes far = difference(&at[0], &at[4], 4.0 * k);
        const double allowed = 1e-7 / sizes[input];
        CHECK_WITHIN(slopes[input]->F_t, five_points(near.F_t, far.F_t), allowed * scale);
        CHECK_WITHIN(slopes[input]->F_n, five_points(near.F_n, far.F_n), allowed * now.F_n);
        CHECK_WITHIN(slopes[input]->sigma, five_points(near.sigma, far.sigma), allowed * now.sigma);
        CHECK_WITHIN(slopes[input]->A_r, five_points(near.A_r, far.A_r), allowed * now.A_r);
    }
    CHECK(!loaded || fabs(got.by_E.F_n) < 1e-14 / drive->E.value * now.F_n); // F_n is the load's
}

// At a reversal |V| has a kink: the slopes are the mean of both sides.
static void at_a_reversal(void) {
    const FcContactParameters contact = table_1(FC_CONTACT_CONSTANT, FC_CONTACT_SEPARATION);
    const FcFriction friction = law(FC_DAHL, FC_LIMIT_CONSTANT);
    const FcDrive drive =
        fc_drive_make((FcLinearInput){0.0, 7.0}, (FcLinearInput){14e-6, 0.0}, (FcLinearInput){9e9, 0.0},
                      (FcLinearInput){312.0, 0.0}, (FcVibration){.f = FREQUENCY}, 0.0, 0.0);
    const FcContactAtModulus at_E = fc_contact_at_modulus(&contact, 9e9);
    const FcScene scene = fc_scene_make(&contact, &at_E, &friction, 55.0, &drive);
    CHECK_NEAR(fc_force_rate(&scene, 1e-6), (friction.sigma_1 + friction.sigma_2) * 7.0, 1e-14);
    CHECK_NEAR(fc_gradient(&scene, 1e-6).by_V.F_t, friction.sigma_1 + friction.sigma_2, 1e-14);
}

// So far apart that sigma is 0: nothing is undefined.
static void far_apart(void) {
    for (int k = 0; k < KINDS; k++) {
        Kind one = kind(k);
        one.friction.model = FC_ELASTIC_PLASTIC;
        if (one.contact.input == FC_CONTACT_LOAD || one.friction.limit == FC_LIMIT_LOAD) {
            continue; // refused
        }
        FcScene scene = moving_scene(&one.contact, &one.friction, 1.0);
        scene.drive.d.value = 1.0;
        CHECK(isfinite(fc_force_rate(&scene, 1e-9)));
        const FcGradient gradient = fc_gradient(&scene, 1e-9);
        CHECK(isfinite(gradient.by_V.F_t) && isfinite(gradient.by_d.F_t) && isfinite(gradient.by_E.F_t));
    }
}

// Mindlin's bound grows by e^(decay d), so that of a bristle that slips is known: its damping changes by
// sigma_1 (decay d')^2 times the bound.
static void slipping_while_the_surfaces_move(double d, double d_rate) {
    const FcContactParameters contact = table_1(FC_CONTACT_MINDLIN, FC_CONTACT_SEPARATION);
    const FcFriction friction = {.model = FC_ELASTIC_PLASTIC,
                                 .limit = FC_LIMIT_CONSTANT,
                                 .staticRatio = 1.0,
                                 .V_S = 1.0,
                                 .sigma_1 = 30.0};
    const FcContactAtModulus at_E = fc_contact_at_modulus(&contact, 58e9);
    const FcLinearInput still = {0.0, 0.0};
    const FcDrive drive = fc_drive_make((FcLinearInput){0.5, 0.0}, (FcLinearInput){d, d_rate},
                                        (FcLinearInput){58e9, 0.0}, still, (FcVibration){.f = 2e4}, 0.0, 0.0);
    const FcScene scene = fc_scene_make(&contact, &at_E, &friction, 55.0, &drive);
    const double delta = bound(&scene, 0.0);
    const double moves = at_E.decay * d_rate; // 1/s
    const double expected = friction.sigma_1 * moves * moves * delta;
    const double found = fc_force_rate(&scene, delta);
    CHECK(fc_scene_slip_side(&scene, 0.0, delta) == 1.0);
    CHECK(fabs(found - expected) <= 1e-6 * expected);
}

static void slipping_in_any_separation(void) {
    slipping_while_the_surfaces_move(14e-6, 1e-2);
    slipping_while_the_surfaces_move(14e-6, 0.0);
    slipping_while_the_surfaces_move(14e-6, 4.9406564584124654e-324);
    slipping_while_the_surfaces_move(1e-12, 1e-4); // closer than it takes to see a change
    slipping_while_the_surfaces_move(1e-12, -1e-4);
}

int main(void) {
    at_a_reversal();
    far_apart();
    slipping_in_any_separation();
    int slipped = 0;
    for (int k = 0; k < 200 * KINDS; k++) {
        Case one;
        make_random(&one, k);
        const double V = fc_drive_V(&one.scene.drive, 0.0);
        if (fabs(V) < 0.02) {
            continue; // differences across a reversal
        }
        double delta = 0.9 * (2.0 * random_01() - 1.0) * bound(&one.scene, 0.0);
        double side = 0.0;
        if (fc_is_bounded(&one.friction) && random_01() < 0.6) {
            delta = copysign(bound(&one.scene, 0.0), V);
            side = fc_scene_slip_side(&one.scene, 0.0, delta);
            if (side == 0.0) {
                continue; // the bound recedes faster than V
            }
            slipped++;
        }
        slope_in_time(&one.scene, delta, side);
        slopes_by_inputs(&one, delta, side);
    }
    CHECK(slipped > 2 * KINDS);
    return check_result();
}
