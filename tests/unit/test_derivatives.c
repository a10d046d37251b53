// The force's slope in time, the motion's and the contact's by the inputs, against differences of the force, the motion and the
// contact themselves: every contact, limit and law, damping and viscous friction included, bristles that stick and that slip.
#include "model/derivatives.h"

#include "check.h"
#include "model/regime.h"
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

static double bound_at(const FcScene* scene, int slips, double t) {
    FcFriction friction;
    const FcScene bound = fc_scene_of_bound(scene, slips, &friction);
    return fc_bound(&bound, t);
}

// The deflection after t [s]: on the bound while it slips, else by one step of Runge and Kutta.
static double later(const FcScene* scene, double delta, int side, double t) {
    if (side != 0) {
        return side * bound_at(scene, side, t);
    }
    const FcCoefficients start = fc_scene_coefficients(scene, 0.0);
    const FcCoefficients middle = fc_scene_coefficients(scene, 0.5 * t);
    const FcCoefficients end = fc_scene_coefficients(scene, t);
    const double k_1 = fc_free_rate(scene, &start, delta);
    const double k_2 = fc_free_rate(scene, &middle, delta + 0.5 * t * k_1);
    const double k_3 = fc_free_rate(scene, &middle, delta + 0.5 * t * k_2);
    const double k_4 = fc_free_rate(scene, &end, delta + t * k_3);
    return delta + t / 6.0 * (k_1 + 2.0 * k_2 + 2.0 * k_3 + k_4);
}

static double force_later(const FcScene* scene, double delta, int side, double t) {
    const FcScene then = fc_scene_from(scene, t);
    return fc_motion(&then, (FcRegime)side, (FcBristle){.delta = later(scene, delta, side, t)}).force.x;
}

// What the rates of a scene may add up to [1/s]: differences over tau are off by (rate tau)^4 / 30 of the force.
static double fastest(const FcScene* scene) {
    const FcLogRates rates = fc_scene_log_rates(scene, 0.0);
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    const double of_V =
        fabs(fc_drive_V_rate(&scene->drive, 0.0)) * (1.0 / fabs(at.V) + 2.0 / scene->friction->V_S);
    return scene->drive.omega + fabs(rates.sigma) + fabs(rates.limit) + of_V + fc_relaxation_rate(&at);
}

// Of any law, the size of a velocity of delta [m/s], and of the force [N]: its elastic part, that of damping and the viscous one.
static double velocity_scale(const FcScene* scene) {
    const FcLogRates rates = fc_scene_log_rates(scene, 0.0);
    return fabs(fc_drive_V(&scene->drive, 0.0)) + fabs(rates.ratio) * bound_at(scene, 0, 0.0);
}

static double force_scale(const FcScene* scene, double delta) {
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    return fabs(at.sigma * delta) + at.limit + scene->friction->sigma_1 * velocity_scale(scene) +
           scene->friction->sigma_2 * fabs(at.V);
}

static void slope_in_time(const FcScene* scene, double delta, int side) {
    const double got = fc_force_rate(scene, (FcBristle){.delta = delta, .slips = side}).x;
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

// All that has a slope.
enum { F_T, DELTA, W, Q, BOUND, LOG_SIGMA, LOG_AREA, LOG_LOAD, QUANTITIES };
typedef struct {
    double of[QUANTITIES];
} All;

static All all_of(const FcScene* scene, double delta, int side) {
    const FcMotion motion = fc_motion(scene, (FcRegime)side, (FcBristle){.delta = delta});
    const FcContactResponse contact = fc_scene_contact(scene, 0.0);
    return (All){{motion.force.x, motion.rates.delta, motion.rates.W_f, motion.rates.Q_f,
                  bound_at(scene, side, 0.0), log(contact.sigma), log(contact.A_r), log(contact.F_n)}};
}

static All slopes_of(const FcScene* scene, double delta, int side, const FcDirection* along,
                     FcContactLogSlope contact) {
    const FcMotion motion = fc_motion_along(scene, (FcRegime)side, (FcBristle){.delta = delta}, along);
    const FcBristle on_bound = {.delta = bound_at(scene, side, 0.0), .slips = side};
    return (All){{motion.force.x, motion.rates.delta, motion.rates.W_f, motion.rates.Q_f,
                  fc_bound_along(scene, on_bound, along).x, contact.sigma, contact.A_r, contact.F_n}};
}

// The deflection itself moves, too, by which the motion of a bristle that is free changes.
static void slopes_by_inputs(const Case* one, double delta, int side) {
    const FcDrive* drive = &one->scene.drive;
    const FcLogSlopes log_slopes = fc_log_slopes(&one->scene);
    const FcContactLogSlope contact[] = {{0}, log_slopes.by_d, log_slopes.by_E, log_slopes.by_load};
    const double sizes[] = {fabs(drive->V.value), drive->d.value, drive->E.value, drive->load.value};
    const double force = force_scale(&one->scene, delta);
    const double V = velocity_scale(&one->scene);
    const double scale[QUANTITIES] = {force, V,   force * V, force * V, bound_at(&one->scene, side, 0.0),
                                      1.0,   1.0, 1.0};
    for (int input = 0; input < 4; input++) {
        if (input == (one->contact.input == FC_CONTACT_LOAD ? 1 : 3)) {
            continue; // no input of this contact
        }
        const double k = 5e-4 * (input == 0 ? fmin(sizes[0], 0.02) : sizes[input]);
        const double with_it = 0.1 * delta / sizes[input];
        const FcDirection along = {
            .V = input == 0, .d = input == 1, .E = input == 2, .load = input == 3, .delta = with_it};
        const All got = slopes_of(&one->scene, delta, side, &along, contact[input]);
        All at[5];
        for (int i = 0; i < 5; i++) {
            const FcScene moved = with_input(one, input, (i - 2) * k);
            at[i] = all_of(&moved, delta + (i - 2) * k * with_it, side);
        }
        for (int q = 0; q < QUANTITIES; q++) {
            const double slope =
                (8.0 * (at[3].of[q] - at[1].of[q]) - (at[4].of[q] - at[0].of[q])) / (12.0 * k);
            // of a bound's rate the code's is a difference itself
            CHECK_WITHIN(got.of[q], slope, (side != 0 && q < BOUND ? 3e-6 : 1e-7) / sizes[input] * scale[q]);
        }
    }
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
    const FcDirection by_V = {.V = 1.0};
    CHECK_NEAR(fc_force_rate(&scene, (FcBristle){.delta = 1e-6}).x,
               (friction.sigma_1 + friction.sigma_2) * 7.0, 1e-14);
    CHECK_NEAR(fc_motion_along(&scene, FC_FREE, (FcBristle){.delta = 1e-6}, &by_V).force.x,
               friction.sigma_1 + friction.sigma_2, 1e-14);
}

// A contact that is open has viscous friction alone.
static void open_contacts(void) {
    for (int k = 0; k < KINDS; k++) {
        const Kind one = kind(k);
        FcScene scene = moving_scene(&one.contact, &one.friction, 1.0);
        scene.is_open = true;
        if (!fc_scene_is_loose(&scene)) {
            continue;
        }
        const FcDirection along = {1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0};
        const FcMotion change = fc_motion_along(&scene, FC_FREE, (FcBristle){0}, &along);
        CHECK(change.force.x == 3.0 && change.rates.delta == 0.0);
        CHECK_NEAR(fc_force_rate(&scene, (FcBristle){0}).x, 3.0 * fc_drive_V_rate(&scene.drive, 0.0), 1e-14);
        CHECK(fc_log_slopes(&scene).by_d.sigma == 0.0 && fc_log_slopes(&scene).by_load.F_n == 0.0);
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
    const double delta = bound_at(&scene, 0, 0.0);
    const double moves = at_E.decay * d_rate; // 1/s
    const double expected = friction.sigma_1 * moves * moves * delta;
    const double found = fc_force_rate(&scene, (FcBristle){.delta = delta}).x;
    CHECK(fc_regime(&scene, (FcBristle){.delta = delta}) == FC_SLIPS_FORWARD);
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
    open_contacts();
    slipping_in_any_separation();
    int slipped = 0;
    for (int k = 0; k < 200 * KINDS; k++) {
        Case one;
        make_random(&one, k);
        const double V = fc_drive_V(&one.scene.drive, 0.0);
        if (fabs(V) < 0.02) {
            continue; // differences across a reversal
        }
        double delta = 0.9 * (2.0 * random_01() - 1.0) * bound_at(&one.scene, 1, 0.0);
        int side = 0;
        if (fc_is_bounded(&one.friction) && random_01() < 0.6) {
            side = V < 0.0 ? -1 : 1;
            delta = side * bound_at(&one.scene, side, 0.0);
            if (fc_regime(&one.scene, (FcBristle){.delta = delta, .slips = side}) != (FcRegime)side) {
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
