// The parts of an interval: they cover it, along a line V keeps its sign in each, and in the plane every minimum of |V|
// is an end of one, as dense samples find them.
#include "solver/integrate/time_map.h"

#include "check.h"
#include "random.h"
#include "table_1.h"

static const double F = 20e3; // Hz
static const double PERIOD = 5e-5;
static const double F_C = 55.0;
enum { SAMPLES = 5000 };

typedef struct {
    FcContactParameters contact;
    FcFriction friction;
    FcScene scene;
    FcPlane plane;
    FcPart parts[FC_MAX_PARTS];
    double h;
    int count;
} Course;

static void make(Course* course, FcLinearInput V, FcLinearInput V_y, FcVibration vibration, double phase,
                 double h) {
    course->contact = table_1(FC_CONTACT_CONSTANT, FC_CONTACT_SEPARATION);
    course->contact.sigma = random_log(1e4, 1e10);
    course->friction = (FcFriction){.model = random_01() < 0.5 ? FC_DAHL : FC_LUGRE,
                                    .limit = FC_LIMIT_CONSTANT,
                                    .staticRatio = 1.5,
                                    .V_S = random_log(1e-3, 1.0)};
    course->scene.drive = (FcDrive){
        .V = V, .d = {14e-6, 0.0}, .E = {58e9, 0.0}, .load = {1.0, 0.0}, .V_y = V_y, .vibration = vibration};
    fc_drive_start(&course->scene.drive, phase / F, 0.0);
    const FcContactAtModulus at_E = fc_contact_at_modulus(&course->contact, 58e9);
    fc_scene_make(&course->scene, &course->contact, &at_E, &course->friction, F_C);
    fc_plane_make(&course->plane, &course->scene);
    course->plane.is_one_dimensional = !fc_is_planar(&course->scene, (FcBristle){0});
    course->h = h;
    course->count = fc_parts(&course->plane, h, 1e-6, course->parts);
}

static void check_cover(const Course* course) {
    CHECK(course->count >= 1 && course->count <= FC_MAX_PARTS);
    CHECK(course->parts[0].start == 0.0 && course->parts[course->count - 1].end == course->h);
    for (int i = 0; i < course->count; i++) {
        const FcPart* part = &course->parts[i];
        CHECK(part->end > part->start && (i == 0 || part->start == course->parts[i - 1].end));
        for (int k = 1; k < 64; k++) {
            const double t = part->start + (part->end - part->start) * k / 64.0;
            const double V = fc_drive_V(&course->scene.drive, t);
            CHECK(!course->plane.is_one_dimensional || part->side * V > -1e-9);
            CHECK_WITHIN(fc_time_map_t(&part->in, fc_time_map_u(&part->in, t)), t, 1e-13 * course->h);
        }
    }
}

static double speed(const Course* course, double t) {
    return hypot(fc_drive_V(&course->scene.drive, t), fc_drive_V_y(&course->scene.drive, t));
}

// Of the minima of |V| that are below the samples around them.
static void check_minima(const Course* course, int* seen) {
    const double step = course->h / SAMPLES;
    for (int i = 2; i < SAMPLES - 1; i++) {
        const double t = i * step;
        const double here = speed(course, t);
        if (!(here < speed(course, t - step) && here <= speed(course, t + step))) {
            continue;
        }
        double nearest = INFINITY;
        for (int k = 0; k < course->count; k++) {
            nearest = fmin(nearest, fabs(course->parts[k].end - t));
        }
        CHECK(nearest <= 1.01 * step);
        *seen += 1;
    }
}

static void random_courses(void) {
    int seen = 0;
    for (int k = 0; k < 600; k++) {
        const bool planar = k % 2;
        const double V_1 = random_log(0.01, 3.0);
        const double h = PERIOD * random_log(0.01, 1.99);
        const FcVibration vibration = {
            .f = F, .V_1 = V_1, .V_2 = planar ? V_1 * random_01() : 0.0, .phase_2 = 6.0 * random_01()};
        const FcLinearInput V = {V_1 * (4.0 * random_01() - 2.0),
                                 random_01() < 0.5 ? 0.0 : V_1 / h * random_01()};
        const FcLinearInput V_y = {planar ? V_1 * (2.0 * random_01() - 1.0) : 0.0, 0.0};
        Course course;
        make(&course, V, V_y, vibration, random_01(), h);
        check_cover(&course);
        if (planar) {
            check_minima(&course, &seen);
        }
    }
    CHECK(seen > 100);
}

// |V| has two minima around an extremum of the vibration, at which its rate is exactly 0 too.
static void minima_around_an_extremum(void) {
    for (int side = -1; side <= 1; side += 2) {
        for (double away = 1e-4; away < 0.07; away *= 1.3) {
            for (double V_y = 1e-12; V_y < 1e-3; V_y *= 10.0) {
                int seen = 0;
                Course course;
                make(&course, (FcLinearInput){side * (1.0 - away), 0.0}, (FcLinearInput){V_y, 0.0},
                     (FcVibration){.f = F, .V_1 = 1.0}, 0.3 * random_01(), 1.2 * PERIOD);
                check_cover(&course);
                check_minima(&course, &seen);
                CHECK(seen >= 2);
            }
        }
    }
}

int main(void) {
    random_courses();
    minima_around_an_extremum();
    return check_result();
}
