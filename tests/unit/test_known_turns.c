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

int main(void) {
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
