// The pieces of an interval: where the contact opens and closes, a load that moves by decades, nothing for held inputs.
#include "solver/pieces.h"

#include "check.h"
#include "random.h"
#include "table_1.h"

typedef struct {
    FcContactParameters contact;
    FcFriction friction;
    FcScene scene; // points to them
} Case;

static void make(Case* one, int input, FcLinearInput d, FcLinearInput load, double f) {
    one->contact = table_1(FC_CONTACT_ASPERITIES, input);
    one->friction =
        (FcFriction){.model = FC_DAHL, .limit = FC_LIMIT_LOAD, .mu = 0.2, .staticRatio = 1.0, .V_S = 0.01};
    const FcContactAtModulus at_E = fc_contact_at_modulus(&one->contact, 58e9);
    const FcDrive drive = fc_drive_make((FcLinearInput){0.1, 3.0}, d, (FcLinearInput){58e9, 0.0}, load,
                                        (FcVibration){.f = f, .V_1 = 0.3, .a_d = 1e-6}, 0.7e-5, 0.0);
    one->scene = fc_scene_make(&one->contact, &at_E, &one->friction, 55.0, &drive);
}

static void make_load(Case* one, double load, double rate) {
    make(one, FC_CONTACT_LOAD, (FcLinearInput){14e-6, 0.0}, (FcLinearInput){load, rate}, 20e3);
}

static double load_at(const FcScene* scene, double t) { return fc_scene_mean_limit(scene, t) / 0.2; }

typedef struct {
    int count, closed;
    double closes, opens; // s, where the first closed piece begins and the last one ends
} Seen;

// They cover the interval without a gap, each as the scene is there, and the load moves by at most a factor of 4 in one.
static Seen look(const FcScene* scene, double h) {
    Seen seen = {.closes = NAN, .opens = NAN};
    FcPieces pieces;
    fc_pieces_start(&pieces, scene, h);
    double t = 0.0;
    while (fc_next_piece(&pieces) && seen.count < 2000) {
        seen.count++;
        CHECK(pieces.h >= 0.0 && (pieces.h > 0.0 || h == 0.0));
        CHECK_WITHIN(pieces.t, t + pieces.h, 2e-16 * h);
        if (!pieces.scene->is_open) {
            const double start = load_at(pieces.scene, 0.0);
            const double end = load_at(pieces.scene, pieces.h);
            CHECK(fmax(start, end) <= 4.0001 * fmin(start, end) ||
                  fmin(start, end) < 1e-11 * load_at(scene, 0.0));
            for (double part = 0.0; part < 1.0; part += 0.3) {
                const double at = part * pieces.h;
                CHECK_NEAR(fc_drive_V(&pieces.scene->drive, at), fc_drive_V(&scene->drive, t + at), 1e-9);
                const double expected = load_at(scene, t + at);
                CHECK_WITHIN(load_at(pieces.scene, at), expected,
                             1e-9 * expected + 1e-15 * fabs(scene->drive.load.rate) * h);
            }
            seen.closes = seen.closed++ == 0 ? t : seen.closes;
            seen.opens = pieces.t;
        }
        t = pieces.t;
    }
    CHECK(t == h);
    CHECK(!fc_next_piece(&pieces));
    return seen;
}

static void held_inputs_are_one_piece(void) {
    Case one;
    make_load(&one, 300.0, 0.0);
    FcPieces pieces;
    const double lengths[] = {0.0, 1e-9, 1.0};
    for (int i = 0; i < 3; i++) {
        fc_pieces_start(&pieces, &one.scene, lengths[i]);
        CHECK(fc_next_piece(&pieces) && pieces.scene == &one.scene && pieces.h == lengths[i]);
        CHECK(!fc_next_piece(&pieces));
    }
    make_load(&one, 0.0, 0.0); // held open
    CHECK(look(&one.scene, 1.0).closed == 0);
    make_load(&one, 300.0, -1.0); // a law that asks for neither the load nor the stiffness
    one.friction = (FcFriction){.model = FC_COULOMB, .limit = FC_LIMIT_CONSTANT};
    CHECK(look(&one.scene, 400.0).count == 1);
}

static void a_load_that_falls_opens_the_contact(void) {
    for (int k = 0; k < 100; k++) {
        Case one;
        const double h = random_log(1e-9, 1e3);
        const double open = h * random_01();
        make_load(&one, 300.0, -300.0 / open);
        const Seen seen = look(&one.scene, h);
        CHECK(seen.closes == 0.0);
        CHECK_WITHIN(seen.opens, open, 1e-12 * h);
        CHECK(seen.count < 30);
    }
}

static void a_load_that_rises_closes_it(void) {
    for (int k = 0; k < 100; k++) {
        Case one;
        const double h = random_log(1e-9, 1e3);
        const double closes = h * random_01();
        make_load(&one, -300.0, 300.0 / closes);
        const Seen seen = look(&one.scene, h);
        CHECK_WITHIN(seen.closes, closes, 1e-12 * h);
        CHECK(seen.opens == h && seen.count < 30);
    }
}

// Steps that end or begin at a load of 0 exactly, and those that fall short of it by rounding.
static void edges(void) {
    Case one;
    make_load(&one, 300.0, -300.0);
    CHECK_WITHIN(look(&one.scene, 1.0).opens, 1.0, 1e-12);
    make_load(&one, 0.0, 300.0);
    const Seen closing = look(&one.scene, 1.0);
    CHECK_WITHIN(closing.closes, 0.0, 1e-12);
    CHECK(closing.closed > 0);
    make_load(&one, 0.0, -300.0);
    CHECK(look(&one.scene, 1.0).closed == 0);
    make_load(&one, 300.0 * 0x1p-52, -300.0);
    look(&one.scene, 1.0);
}

// 12 decades up and down: each factor of 4 is a piece.
static void decades_of_load(void) {
    Case one;
    make_load(&one, 1e-10, 100.0);
    const Seen rises = look(&one.scene, 1.0);
    CHECK(rises.count >= 20 && rises.count <= 22); // log_4 1e12 = 19.93
    make_load(&one, 100.0, -(100.0 - 1e-10));
    CHECK(look(&one.scene, 1.0).count <= 22);
    make_load(&one, 100.0, -50.0); // less than a factor of 4
    CHECK(look(&one.scene, 1.0).count == 1);
}

// Surfaces that are moved apart until nothing presses them: a load of e^(-decay d).
static void a_separation_that_grows(void) {
    const double decay = 3.0 / 6e-6;
    for (int back = 0; back <= 1; back++) {
        Case one;
        const double near = 10e-6, far = 1e-3;
        make(&one, FC_CONTACT_SEPARATION,
             back ? (FcLinearInput){far, near - far} : (FcLinearInput){near, far - near},
             (FcLinearInput){1.0, 0.0}, 20e3);
        const Seen seen = look(&one.scene, 1.0);
        const double edge = back ? seen.closes : seen.opens;
        const double d = one.scene.drive.d.value + one.scene.drive.d.rate * edge;
        const double F_n = one.scene.at_E.load_0 * exp(-decay * d);
        const double sigma = one.scene.at_E.stiffness_0 * exp(-2.0 * decay * d) / (d * d * d);
        CHECK(fmin(F_n, sigma) < 1e-95 && fmin(F_n, sigma) > 1e-105);
        CHECK((back ? seen.opens : seen.closes) == (back ? 1.0 : 0.0));
    }
}

// The deflection goes without motion, force and heat.
static void a_step_without_contact(void) {
    FcStepResult result = {.delta = -3e-6, .slips = -1, .heat = 1.0, .impulse = 2.0};
    fc_loose_step(&result);
    CHECK(result.delta == 0.0 && result.slips == 0 && result.lost == -3e-6 && result.impulse == 2.0);
    CHECK(result.heat == 1.0);
}

int main(void) {
    held_inputs_are_one_piece();
    a_load_that_falls_opens_the_contact();
    a_load_that_rises_closes_it();
    edges();
    decades_of_load();
    a_separation_that_grows();
    a_step_without_contact();
    return check_result();
}
