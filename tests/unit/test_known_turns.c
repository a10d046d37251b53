// Turning points that are known but for small windows: all that there are, against dense samples.
#include "solver/known_turns.h"

#include "check.h"
#include "random_bound.h"

enum { SAMPLES = 4000, SCENES = 3000 }; // samples over two periods

// Each sampled time at which a bound starts to recede must be the next known turn of it, none left out. Returns how
// many were seen.
static int all_are_known(const FcScene* scene, const FcKnownTurns* known, int first, int last) {
    const double end = 2.0 / F;
    int seen = 0;
    for (int which = first; which <= last; which++) {
        const bool alternate = known->which[0] != known->which[1];
        int n = known->which[0] == which ? 0 : 1;
        FcBoundMotion before = fc_bound_motion(scene, 0.0);
        for (int i = 1; i <= SAMPLES; i++) {
            const FcBoundMotion now = fc_bound_motion(scene, end * i / SAMPLES);
            if (approach(&before, which) > 0.0 && !(approach(&now, which) > 0.0)) {
                const double middle = known->middle[n % 2] + n / 2 * known->cycle;
                CHECK(known->which[n % 2] == which);
                CHECK(now.t >= middle - 0.25 / F && before.t <= middle + 0.25 / F);
                n += alternate ? 2 : 1;
                seen++;
            }
            before = now;
        }
        // and none is known that has not come by a quarter of a period before the end
        CHECK(known->middle[n % 2] + n / 2 * known->cycle + 0.25 / F >= end * (1.0 - 1e-12));
    }
    return seen;
}

// Of a period, by samples.
typedef struct {
    double fastest;           // m/s, the largest |D'|
    double most_bent;         // m/s2, the largest |D''|
    double least_bent_slowly; // m/s2, the least |D''| where |D'| is below the largest speed of V
} Sampled;

static Sampled sampled(const FcScene* scene) {
    const double speed = fc_drive_largest_speed(&scene->drive, 0.0);
    Sampled all = {.least_bent_slowly = INFINITY};
    for (int i = 0; i < SAMPLES / 4; i++) {
        const FcBoundMotion now = fc_bound_motion(scene, 4.0 * i / SAMPLES / F);
        all.fastest = fmax(all.fastest, fabs(now.D_rate));
        all.most_bent = fmax(all.most_bent, fabs(now.D_curvature));
        if (fabs(now.D_rate) <= speed) {
            all.least_bent_slowly = fmin(all.least_bent_slowly, fabs(now.D_curvature));
        }
    }
    return all;
}

// V' where V is so small that D' may be as large.
static double least_slope_of_V(const FcScene* scene, double fastest) {
    const double cosine = (fabs(scene->drive.V.value) + fastest) / scene->drive.vibration.V_1;
    return cosine < 1.0 ? scene->drive.vibration.V_1 * scene->drive.omega * sqrt(1.0 - cosine * cosine) : 0.0;
}

// Turns are taken as known only where no bound can turn twice in a window; and they are where that holds by far: with d
// moving so little that D is a cosine, by a tenth.
static void what_is_known_is_proved(void) {
    int slow = 0, fast = 0, narrow = 0;
    for (int i = 0; i < 10000; i++) {
        FcScene scene = random_scene();
        if (fc_bound_is_constant(&scene)) {
            continue;
        }
        const bool aims =
            random_01() < 0.5; // at where it is decided: V near to what D' leaves of V_1, or D'' to V'
        if (aims) {
            const Sampled all = sampled(&scene);
            const double V_1 = scene.drive.vibration.V_1;
            if (random_01() < 0.5 && all.fastest < V_1) {
                scene.drive.V.value = (V_1 - all.fastest) * (1.0 - random_log(1e-4, 0.3));
            }
        }
        const FcBoundMotion start = fc_bound_motion(&scene, 0.0);
        const FcKnownTurns known = fc_known_turns(&scene, &start, 1.0 / F, start.D, start.D);
        const Sampled all = sampled(&scene);
        const double slope = least_slope_of_V(&scene, all.fastest);
        const double V_slope = scene.drive.vibration.V_1 * scene.drive.omega;
        const double swing =
            fabs(fc_bound_log_slope(&scene, scene.drive.d.value)) * scene.drive.vibration.a_d;
        if (known.known && known.which[0] != known.which[1]) {
            CHECK(all.most_bent <= slope);
            slow++;
        } else if (known.known) {
            CHECK(all.least_bent_slowly >= V_slope);
            fast++;
        } else if (swing < 0.03) {
            CHECK(all.most_bent > 0.88 * slope);
            const bool reaches_one =
                start.D * (1.0 - 2.0 * swing) > fc_drive_largest_speed(&scene.drive, 0.0) / F;
            CHECK(!reaches_one || all.least_bent_slowly < 1.15 * V_slope);
            narrow++;
        }
    }
    CHECK(slow > 1000 && fast > 500 && narrow > 100);
}

int main(void) {
    what_is_known_is_proved();
    int slow = 0, fast = 0;
    for (int i = 0; i < SCENES; i++) {
        const FcScene scene = random_scene();
        const FcBoundMotion start = fc_bound_motion(&scene, 0.0);
        const bool at_upper = random_01() < 0.5;
        const double delta = at_upper ? start.D : -start.D;
        const FcKnownTurns known = fc_known_turns(&scene, &start, 1.0 / F, delta, delta);
        if (!known.known || fc_bound_is_constant(&scene)) {
            continue;
        }
        if (known.which[0] != known.which[1]) {
            slow += all_are_known(&scene, &known, 0, 1);
        } else {
            CHECK(known.which[0] == (at_upper ? 0 : 1));
            fast += all_are_known(&scene, &known, known.which[0], known.which[0]);
        }
    }
    CHECK(slow > 1000 && fast > 200);
    FcScene moving = random_scene();
    moving.drive.V.rate = 1.0; // what moves is not foreseen
    const FcBoundMotion start = fc_bound_motion(&moving, 0.0);
    CHECK(!fc_known_turns(&moving, &start, 1.0 / F, 0.0, 0.0).known);
    return check_result();
}
