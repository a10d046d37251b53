// Turning points of both bounds, piece by piece, against dense samples of how the bounds approach.
#include "solver/stick_slip/turning_points.h"

#include "check.h"
#include "random_bound.h"
#include "solver/solver.h"

enum { SCENES = 1500, SAMPLES = 4000, MOST = 1000 };
static const double TOLERANCE = 1e-12;
static const double NEXT_TO = 1e-7; // of the time gone through; the roots are closer

// Of one scene, gone through from end to end.
typedef struct {
    double evaluations;
    int count; // of turning points
    double turn[MOST];
} Turns;

static bool turns_near(const Turns* turns, double from, double to) {
    for (int i = 0; i < turns->count; i++) {
        if (turns->turn[i] >= from && turns->turn[i] <= to) {
            return true;
        }
    }
    return false;
}

// One bound starts or ceases to come nearer there, or only touches.
static bool is_a_turn(const FcScene* scene, double t, double end) {
    const FcBoundMotion at = fc_bound_motion(scene, t);
    const FcBoundMotion before = fc_bound_motion(scene, t - NEXT_TO * end);
    const FcBoundMotion after = fc_bound_motion(scene, t + NEXT_TO * end);
    const double speed = fabs(scene->drive.V.value) + scene->drive.vibration.V_1 + fabs(at.D_rate);
    for (int which = 0; which < 2; which++) {
        if ((approach(&before, which) > 0.0) != (approach(&after, which) > 0.0) ||
            fabs(approach(&at, which)) < 1e-9 * speed) {
            return true;
        }
    }
    return false;
}

// What a piece says of its start is right shortly after it, of a bound that the bristle may be on.
static void says_what_nears(const FcScene* scene, const FcPiece* piece, double end, int side) {
    const FcBoundMotion after = fc_bound_motion(scene, piece->start->t + NEXT_TO * end);
    for (int which = side < 0 ? 1 : 0; which <= (side > 0 ? 0 : 1); which++) {
        const double rate = approach(&after, which);
        if (fabs(rate) > 1e-5 * (scene->drive.vibration.V_1 + fabs(after.D_rate))) {
            CHECK(piece->nears[which] == (rate > 0.0));
        }
    }
}

// Where the bristle may be at a moment [m].
typedef struct {
    double lowest, highest;
} Place;

// Anywhere, or all but on the upper bound (1) or the lower one (-1).
static Place place_of(const FcBoundMotion* at, int side) {
    const double near = side * at->D * (1.0 - 1e-8);
    return side == 0 ? (Place){-FC_NO_BOUND, FC_NO_BOUND} : (Place){near, near};
}

// Pieces follow each other, and end at turning points where they say so.
static Turns go_through(const FcScene* scene, double end, int side) {
    Turns turns = {0};
    FcTurningPoints points;
    fc_turning_points_start(&points, scene, TOLERANCE, end);
    while (points.at->t < end && turns.count < MOST) {
        const double reached = points.at->t;
        FcPiece piece;
        const Place place = place_of(points.at, side);
        fc_turning_points_next(&points, place.lowest, place.highest, &piece);
        CHECK(piece.start->t == reached && piece.end->t >= reached && piece.end->t <= end);
        CHECK(points.at == piece.end);
        if (!(piece.end->t >= reached)) {
            break;
        }
        if (piece.end->t > reached + 2.0 * NEXT_TO * end) {
            says_what_nears(scene, &piece, end, side);
        }
        if (piece.turns) {
            CHECK(is_a_turn(scene, piece.end->t, end));
            turns.turn[turns.count++] = piece.end->t;
        }
    }
    CHECK(points.at->t == end);
    turns.evaluations = points.evaluations;
    return turns;
}

// Between two samples a bound ceases or starts to come nearer: a turning point lies there. Returns how many do.
static int none_is_missed(const FcScene* scene, const Turns* turns, double end, int first, int last) {
    int seen = 0;
    for (int which = first; which <= last; which++) {
        FcBoundMotion before = fc_bound_motion(scene, 0.0);
        for (int i = 1; i <= SAMPLES; i++) {
            const FcBoundMotion now = fc_bound_motion(scene, end * i / SAMPLES);
            const bool ceases = approach(&before, which) > 0.0 && !(approach(&now, which) > 0.0);
            const bool starts = approach(&before, which) < 0.0 && !(approach(&now, which) < 0.0);
            if (ceases || starts) {
                CHECK(turns_near(turns, before.t - NEXT_TO * end, now.t + NEXT_TO * end));
                seen++;
            }
            before = now;
        }
    }
    return seen;
}

static void make_inputs_move(FcScene* scene, double end) {
    scene->drive.V.rate = (random_01() - 0.5) * 2.0 * scene->drive.vibration.V_1 / end;
    scene->drive.d.rate = (random_01() - 0.5) * (D_MEAN - scene->drive.vibration.a_d) / end;
    scene->drive.E.rate = random_01() < 0.2 ? (random_01() - 0.5) * E / end : 0.0;
}

// V put right so that a bound only touches the bristle: V - D' has a double root, which no division parts.
static void a_touch_costs_few_divisions(void) {
    double dearest = 0.0;
    for (int i = 0; i < 400; i++) {
        FcScene scene = random_scene();
        const double end = random_log(0.6, 2.0) / F;
        if (fc_bound_is_constant(&scene)) {
            continue;
        }
        const double shift = 0.3 * random_01() * end;
        const double step = 1e-4 * end;
        double lowest = INFINITY, at_lowest = 0.0;
        for (double t = shift; t < end; t += step) {
            const FcBoundMotion at = fc_bound_motion(&scene, t);
            if (approach(&at, 0) < lowest) {
                lowest = approach(&at, 0);
                at_lowest = t;
            }
        }
        double a = at_lowest - step, b = at_lowest + step; // by golden section
        for (int k = 0; k < 60; k++) {
            const double left = b - 0.6180339887498949 * (b - a);
            const double right = a + 0.6180339887498949 * (b - a);
            const FcBoundMotion at_left = fc_bound_motion(&scene, left);
            const FcBoundMotion at_right = fc_bound_motion(&scene, right);
            if (approach(&at_left, 0) < approach(&at_right, 0)) {
                b = right;
            } else {
                a = left;
            }
        }
        const FcBoundMotion touched = fc_bound_motion(&scene, 0.5 * (a + b));
        const double missed = random_01() < 0.5 ? 0.0 : 1e-13 * (2.0 * random_01() - 1.0);
        scene.drive.V.value -= approach(&touched, 0) * (1.0 + missed);
        const double cells = ceil(end / (1.5 * fc_bound_common_smooth_time(&scene, end)));
        const Turns turns = go_through(&scene, end, 0);
        dearest = fmax(dearest, turns.evaluations - cells);
    }
    CHECK(dearest < 200.0);
}

// Dahl's cells are joined up to the next reversal, here to the end; once the evaluations are spent none is added.
static void cells_are_joined_within_the_limit(void) {
    contact = table_1(FC_CONTACT_MINDLIN, FC_CONTACT_SEPARATION);
    friction = (FcFriction){.model = FC_DAHL, .limit = FC_LIMIT_LOAD, .mu = 0.18, .staticRatio = 1.0};
    const double end = 20.0 / F;
    const FcDrive drive = fc_drive_make((FcLinearInput){0.1, 0.0}, (FcLinearInput){D_MEAN, 0.0},
                                        (FcLinearInput){E, 0.5 * E / end}, (FcLinearInput){100.0, 0.0},
                                        (FcVibration){.f = F, .a_d = 1e-6}, 0.0, 0.0);
    const FcContactAtModulus at_E = fc_contact_at_modulus(&contact, E);
    const FcScene scene = fc_scene_make(&contact, &at_E, &friction, 55.0, &drive);
    for (int spent = 0; spent < 2; spent++) {
        FcTurningPoints points;
        FcPiece piece;
        fc_turning_points_start(&points, &scene, TOLERANCE, end);
        points.evaluations = spent ? 2.0 * FC_MOST_EVALUATIONS : 0.0;
        fc_turning_points_next(&points, -FC_NO_BOUND, FC_NO_BOUND, &piece);
        CHECK(spent ? piece.end->t < 0.1 * end : piece.end->t == end);
    }
}

int main(void) {
    a_touch_costs_few_divisions();
    cells_are_joined_within_the_limit();
    int seen = 0;
    for (int i = 0; i < SCENES; i++) {
        FcScene scene = random_scene();
        const double end = random_log(0.05, 4.0) / F;
        if (random_01() < 0.5) {
            make_inputs_move(&scene, end);
        }
        if (fc_bound_is_constant(&scene)) {
            continue;
        }
        const Turns all = go_through(&scene, end, 0);
        seen += none_is_missed(&scene, &all, end, 0, 1);
        if (i % 4 == 0) {
            const int side = i % 8 == 0 ? 1 : -1;
            const Turns near = go_through(&scene, end, side);
            none_is_missed(&scene, &near, end, side > 0 ? 0 : 1, side > 0 ? 0 : 1);
        }
    }
    CHECK(seen > 1000);
    return check_result();
}
