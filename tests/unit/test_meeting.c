// Where a bristle meets its bound: closed forms, and dense samples of random courses.
#include "solver/meeting.h"

#include <stddef.h>

#include "check.h"
#include "model/regime.h"
#include "random.h"
#include "table_1.h"

static const double TWO_PI = 6.283185307179586;
static const double F = 20e3;  // Hz
static const double D = 20e-6; // m, the bound at the start
static const double MU = 0.2;
static const double OVER = 1e-13 * 20e-6;

typedef struct {
    FcContactParameters contact;
    FcFriction friction;
    FcScene scene; // points to them
    FcCourse course;
} Case;

// An elastic-plastic bristle from delta on: V = drift + A omega cos(omega t + theta), D' = the rate given.
static void make(Case* one, double delta, double drift, double A, double theta, double D_rate) {
    one->contact = table_1(FC_CONTACT_CONSTANT, FC_CONTACT_LOAD);
    one->friction = (FcFriction){
        .model = FC_ELASTIC_PLASTIC, .limit = FC_LIMIT_LOAD, .mu = MU, .staticRatio = 1.0, .V_S = 1.0};
    const double load_per_bound = one->contact.sigma / MU;
    const FcContactAtModulus at_E = fc_contact_at_modulus(&one->contact, 58e9);
    const FcDrive drive =
        fc_drive_make((FcLinearInput){drift, 0.0}, (FcLinearInput){14e-6, 0.0}, (FcLinearInput){58e9, 0.0},
                      (FcLinearInput){D * load_per_bound, D_rate * load_per_bound},
                      (FcVibration){.f = F, .V_1 = A * TWO_PI * F}, theta / (TWO_PI * F), 0.0);
    one->scene = fc_scene_make(&one->contact, &at_E, &one->friction, 55.0, &drive);
    one->course = (FcCourse){
        .scene = &one->scene, .bound = &one->scene, .exact = true, .still = D_rate == 0.0, .delta = {delta}};
}

// Over h by a panel of that rule.
static void run(Case* one, double h, int rule) {
    FcCourse* course = &one->course;
    FcPoints at;
    double evaluations = 0.0;
    fc_points(&one->scene, 0.0, h, rule, &at, &evaluations);
    course->count = at.count;
    for (int i = 0; i < at.count; i++) {
        course->t[i] = at.t[i];
        course->V[i] = at.V[i];
        course->delta[i] = course->delta[0] + fc_drive_displacement(&one->scene.drive, 0.0, at.t[i]);
        course->D[i] = at.limit[i] / at.sigma[i];
    }
}

static FcMeeting meeting_of(const Case* one) {
    double evaluations = 0.0;
    return fc_first_meeting(&one->course, OVER, 0.0, &evaluations);
}

// Times are told to `accurate`, over h.
static void check_meets(const Case* one, int side, double t, double h, double accurate) {
    const FcMeeting met = meeting_of(one);
    CHECK(met.side == side);
    CHECK_WITHIN(met.t, t, accurate * h);
}

// V held, and D held, falling or rising: delta_0 + V t = D + D' t.
static void crossings_between_points(void) {
    const double h = 1e-3;
    Case one;
    for (int side = -1; side <= 1; side += 2) {
        for (int exact = 0; exact <= 1; exact++) {
            for (double D_rate = -3e-3; D_rate < 4e-3; D_rate += 3e-3) {
                for (int rule = 0; rule < FC_RULES; rule++) {
                    make(&one, side * 5e-6, side * 25e-3, 0.0, 0.0, D_rate);
                    one.course.exact = exact;
                    run(&one, h, rule);
                    check_meets(&one, side, 15e-6 / (25e-3 - D_rate), h, 1e-12);
                }
            }
        }
    }
    make(&one, 5e-6, 14e-3, 0.0, 0.0, 0.0);
    run(&one, h, 1);
    CHECK(meeting_of(&one).side == 0);
    make(&one, 5e-6, 0.0, 0.0, 0.0, -19e-3); // the bound alone comes to it
    run(&one, h, 1);
    check_meets(&one, 1, 15e-6 / 19e-3, h, 1e-12);
}

// delta = A sin(omega t) goes beyond D around its top alone, between two points; or it does not.
static void hidden_and_grazing(void) {
    const double omega = TWO_PI * F;
    const double h = 0.9 * 3.141592653589793 / omega; // a radian and less between points
    for (int side = -1; side <= 1; side += 2) {
        for (double beyond = 1e-12; beyond < 0.02; beyond *= 10.0) {
            Case one;
            const double A = D * (1.0 + beyond);
            make(&one, 0.0, 0.0, A, side > 0 ? 0.0 : 0.5 * TWO_PI, 0.0);
            run(&one, h, 0);
            const double t = asin(1.0 / (1.0 + beyond)) / omega;
            check_meets(&one, side, t, h, 1e-15 / sqrt(beyond));
            one.course.exact = false; // by the cubic through the points
            if (beyond > 5e-3) {
                check_meets(&one, side, t, h, 0.01);
            }
            make(&one, 0.0, 0.0, D * (1.0 - beyond), side > 0 ? 0.0 : 0.5 * TWO_PI, 0.0);
            run(&one, h, 0);
            CHECK(meeting_of(&one).side == 0);
        }
        Case one; // by less than is told
        make(&one, 0.0, 0.0, D * (1.0 + 0.5e-13), side > 0 ? 0.0 : 0.5 * TWO_PI, 0.0);
        run(&one, h, 0);
        CHECK(meeting_of(&one).side == 0);
    }
}

// At the start it meets the bound on which it lies if it is pushed, unless it has just left it; then it meets it as it comes back.
static void at_the_start(void) {
    const double omega = TWO_PI * F;
    const double h = 0.4 * TWO_PI / omega;
    for (int side = -1; side <= 1; side += 2) {
        for (int left = -1; left <= 1; left++) {
            Case one;
            make(&one, side * D, side * 0.1, 0.0, 0.0, 0.0); // pushed
            one.course.left = left;
            run(&one, h, 1);
            check_meets(&one, side, 0.0, h, left == side ? 1e-9 : 0.0);
            make(&one, side * D, -side * 0.1, 0.0, 0.0, 0.0); // pulled back
            one.course.left = left;
            run(&one, h, 1);
            CHECK(meeting_of(&one).side == 0);
            // Back first, and at the bound again where sin(omega t + theta) is what it was: after pi - 2 theta, theta = -0.1 ahead
            // of the turn at -pi / 2.
            make(&one, side * D, 0.0, 0.05 * D, (side > 0 ? -0.5 : 0.5) * 3.141592653589793 - 0.3, 0.0);
            one.course.left = left;
            run(&one, h, 2);
            check_meets(&one, side, 0.6 / omega, h, 1e-9);
        }
    }
}

// One that is not quite at the end of its push, and one that is back within the first cell.
static void just_left(void) {
    const double omega = TWO_PI * F;
    for (int side = -1; side <= 1; side += 2) {
        for (int left = -1; left <= 1; left++) {
            Case one; // pushed for 1e-8 / omega more
            make(&one, side * D, 0.0, 0.05 * D, (side > 0 ? 0.25 : 0.75) * TWO_PI - 1e-8, 0.0);
            one.course.left = left;
            run(&one, 0.2 / F, 1);
            CHECK(meeting_of(&one).side == (left == side ? 0 : side));
        }
        Case one; // beyond by rounding
        make(&one, side * D * (1.0 + 1e-14), 0.0, 0.05 * D, (side > 0 ? 0.75 : 0.25) * TWO_PI - 0.3, 0.0);
        run(&one, 0.9 / omega, 0);
        one.course.left = side;
        const int last = one.course.count - 1;
        one.course.t[1] = one.course.t[last];
        one.course.V[1] = one.course.V[last];
        one.course.delta[1] = one.course.delta[last];
        one.course.count = 2;
        check_meets(&one, side, 0.6 / omega, 0.9 / omega, 1e-9);
    }
}

// p on dense samples; the first one above `over`.
static FcMeeting by_samples(const Case* one, double h, double over) {
    enum { SAMPLES = 20000 };
    for (int i = 1; i <= SAMPLES; i++) {
        const double t = h * i / SAMPLES;
        const double delta = one->course.delta[0] + fc_drive_displacement(&one->scene.drive, 0.0, t);
        const double bound = fc_bound(&one->scene, t);
        if (fabs(delta) - bound > over) {
            return (FcMeeting){delta < 0.0 ? -1 : 1, t};
        }
    }
    return (FcMeeting){0, 0.0};
}

// Panels of up to a radian from node to node, of both sides.
static void random_courses(void) {
    int met = 0, forward = 0;
    for (int k = 0; k < 800; k++) {
        Case one;
        const double omega = TWO_PI * F;
        const int rule = (int)(FC_RULES * random_01());
        const double h = (rule == 0 ? 6.0 : rule == 1 ? 8.0 : 12.0) * random_log(0.05, 0.7) / omega;
        make(&one, 0.9 * D * (2.0 * random_01() - 1.0), 2.0 * D / h * (2.0 * random_01() - 1.0),
             random_log(0.05, 3.0) * D, TWO_PI * random_01(),
             random_01() < 0.5 ? 0.0 : 0.9 * D / h * (2.0 * random_01() - 1.0));
        run(&one, h, rule);
        const FcMeeting expected = by_samples(&one, h, 1e-9 * D);
        const FcMeeting got = meeting_of(&one);
        CHECK(got.side == expected.side);
        CHECK(expected.side == 0 || (got.t <= expected.t && got.t >= expected.t - h / 20000.0 * 1.1));
        met += got.side != 0;
        forward += got.side > 0;
    }
    CHECK(met > 200 && forward > 80 && forward < met - 80);
}

int main(void) {
    crossings_between_points();
    hidden_and_grazing();
    at_the_start();
    just_left();
    random_courses();
    return check_result();
}
