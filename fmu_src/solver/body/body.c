#include "solver/body/body.h"

#include <assert.h>
#include <math.h>

#include "model/extremes.h"
#include "model/motion.h"
#include "model/pi.h"
#include "model/root.h"

double fc_body_inertia(const FcScene* scene, FcBristle bristle, const FcBody* body) {
    assert(body->m > 0.0);
    if (bristle.state != FC_SLIPPING || !fc_has_static_friction(scene->friction) ||
        scene->friction->sigma_1 == 0.0) {
        return body->m;
    }
    const double change = 1.0 + fabs(scene->drive.V.rate); // F_t is linear in the rate of w
    FcScene faster = *scene;
    faster.drive.V.rate += change;
    const double F_t = fc_motion(scene, bristle).force.x;
    return body->m + (fc_motion(&faster, bristle).force.x - F_t) / change;
}

double fc_body_acceleration(const FcScene* scene, FcBristle bristle, const FcBody* body, double F) {
    const double inertia = fc_body_inertia(scene, bristle, body);
    return (F - fc_motion(scene, bristle).force.x) / fc_max(inertia, FC_MIN_INERTIA * body->m);
}

FcScene fc_body_scene(const FcScene* scene, const FcBody* body, FcBristle bristle) {
    FcScene seen = *scene;
    seen.drive.V.value += body->v;
    if (fc_has_bristle(seen.friction)) {
        const bool slips = fc_has_broken_away(seen.friction, bristle.state);
        bristle.state = slips ? FC_SLIPPING : fc_bristle_state(&seen, bristle);
        seen.drive.V.rate += fc_body_acceleration(&seen, bristle, body, body->F.value);
    }
    return seen;
}

// A bristle that drops from `first` [m], and by its damper moves the mass: w changes by per_delta [1/s] over the drop.
typedef struct {
    FcScene scene;
    double V, first, per_delta;
} Drop;

// The kinetic bound less the deflection [m], for fc_root_between.
static double inside_bound(void* context, double size) {
    Drop* of = context;
    of->scene.drive.V.value = of->V + of->per_delta * (of->first - size);
    const FcCoefficients at = fc_scene_coefficients(&of->scene, 0.0);
    return at.limit / at.sigma - size;
}

void fc_body_drop(const FcScene* scene, double m, double sigma_1, FcStepResult* now) {
    enum { SAMPLES = 64 }; // half of them pass over a smaller jump
    assert(m > 0.0 && sigma_1 >= 0.0 && fc_has_static_friction(scene->friction));
    const double side = fc_side(fc_bristle_of(now));
    Drop of = {*scene, scene->drive.V.value, fabs(now->delta), side * sigma_1 / m};
    const FcCoefficients at = fc_scene_coefficients(scene, 0.0);
    const double fall =
        of.first - at.limit / fc_stribeck(scene->friction, at.V) / at.sigma; // to that of a fast slip
    double outside = 0.0;
    double evaluations = 0.0;
    for (int k = 0; k <= SAMPLES; k++) {
        const double size = of.first - fall * k / SAMPLES;
        const double value = inside_bound(&of, size);
        if (value < 0.0) {
            outside = size;
        } else if (outside != 0.0) {
            const double at_outside = inside_bound(&of, outside);
            const double end =
                fc_root_between(inside_bound, &of, size, value, outside, at_outside, 0.0, &evaluations);
            const double w = fc_drive_V(&scene->drive, 0.0) + 0.5 * of.per_delta * (of.first - end);
            const double damping = -side * sigma_1 * (of.first - end) * w;
            now->work += damping;
            now->heat += damping + fc_drop_heat(at.sigma, of.first, end);
            assert(end >= 0.0 && end <= of.first);
            now->delta = side * end;
            now->state = FC_SLIPPING;
            return;
        }
    }
}

bool fc_body_refuse(const FcScene* scene, const FcBody* body, double h, const char* reason,
                    FcMessage* message) {
    assert(h >= 0.0 && body->m > 0.0);
    const double omega = sqrt(fc_scene_largest_stiffness(scene, h) / body->m);
    return fc_message_set(
        message,
        "body.m = %.9g kg: the step of %.5g s is refused: %s. The stuck mass rings at %.4g kHz, "
        "%.4g cycles in the step: set friction.sigma_1 to %.3g N s/m, or take friction.model = "
        "Coulomb",
        body->m, h, reason, 1e-3 * omega / FC_TWO_PI, omega * h / FC_TWO_PI, 0.4 * body->m * omega);
}
