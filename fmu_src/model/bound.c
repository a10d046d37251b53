#include "model/bound.h"

#include <math.h>

// The direction in which a bristle slips, or else that of its deflection.
static FcVector direction_of_slip(const FcScene* scene, FcBristle bristle) {
    return bristle.state != FC_FREE && !fc_is_planar(scene, bristle)
               ? (FcVector){fc_side(bristle), 0.0}
               : fc_direction_or_zero(fc_delta(bristle));
}

void fc_at_bound(FcAtBound* of, const FcScene* scene, FcBristle bristle) {
    const FcPhase phase = fc_drive_phase(&scene->drive, 0.0);
    fc_plane_make(&of->plane, scene);
    of->at = fc_plane_coefficients(&of->plane, 0.0, phase);
    of->bound = fc_plane_bound(&of->plane, &of->at, bristle.state, 0.0, phase);
    of->n = direction_of_slip(scene, bristle);
}

static bool is_on_bound(const FcAtBound* of, FcBristle bristle) {
    return fc_product(of->n, fc_delta(bristle)) >= (1.0 - FC_INSIDE_BOUND) * of->bound.D;
}

static double push(const FcAtBound* of) { return fc_plane_push(&of->plane, &of->at, &of->bound, of->n); }

double fc_push(const FcScene* scene, FcBristle bristle) {
    FcAtBound of;
    fc_at_bound(&of, scene, bristle);
    return push(&of);
}

static FcBristle moved_onto(const FcAtBound* of, FcBristle bristle) {
    const FcVector n = fc_direction_or_zero(fc_delta(bristle));
    bristle.delta = of->bound.D * n.x;
    bristle.delta_y = of->bound.D * n.y;
    return bristle;
}

FcBristle fc_project_onto_bound(const FcScene* scene, FcBristle bristle) {
    if (fc_scene_is_separated(scene)) {
        return (FcBristle){0};
    }
    if (!fc_is_bounded(scene->friction)) {
        return bristle;
    }
    FcAtBound of;
    fc_at_bound(&of, scene, bristle);
    const double size = fc_size(bristle);
    if (size > of.bound.D) {
        if (fc_has_static_friction(scene->friction) && bristle.state == FC_FREE &&
            size > (1.0 + FC_ROUNDING_OF_BOUND) * of.bound.D) {
            bristle.state = FC_SLIPPING; // it breaks away
            fc_at_bound(&of, scene, bristle);
        }
        bristle = moved_onto(&of, bristle);
    }
    // A bristle with a push of 0 remains slipping. Its motion decides whether it sticks.
    if (bristle.state != FC_FREE) {
        bristle.state = push(&of) < 0.0                                      ? FC_FREE
                        : is_on_bound(&of, bristle)                          ? FC_SLIPPING
                        : fc_has_broken_away(scene->friction, bristle.state) ? FC_CATCHING_UP
                                                                             : FC_FREE;
    }
    return bristle;
}

FcBristle fc_scale_onto_bound(const FcScene* scene, FcBristle bristle) {
    FcAtBound of;
    fc_at_bound(&of, scene, bristle);
    return moved_onto(&of, bristle);
}

FcBristleState fc_bristle_state(const FcScene* scene, FcBristle bristle) {
    const bool has_broken_away = fc_has_broken_away(scene->friction, bristle.state);
    if (!fc_is_bounded(scene->friction) || fc_scene_is_separated(scene) ||
        (fc_has_static_friction(scene->friction) && !has_broken_away)) {
        return FC_FREE;
    }
    FcAtBound of;
    fc_at_bound(&of, scene, bristle);
    return is_on_bound(&of, bristle) && push(&of) > 0.0 ? FC_SLIPPING
           : has_broken_away                            ? FC_CATCHING_UP
                                                        : FC_FREE;
}

FcBristleState fc_bristle_state_at_event(const FcScene* scene, FcBristle bristle) {
    if (bristle.state != FC_FREE && !(fc_push(scene, bristle) > 0.0)) {
        return fc_bristle_state(scene, (FcBristle){.delta = bristle.delta, .delta_y = bristle.delta_y});
    }
    return fc_bristle_state(scene, bristle);
}

// The hysteresis of an event, over the bound and over the velocities: far above rounding, far below the
// tolerance of an integrator. Half or twice of it moves the events by as little.
static const double HYSTERESIS = 1e-10;

void fc_bound_indicators(const FcScene* scene, FcBristle bristle, double z[2]) {
    z[0] = z[1] = 1.0;
    if (!fc_is_bounded(scene->friction) || fc_scene_is_separated(scene)) {
        return;
    }
    FcAtBound of;
    fc_at_bound(&of, scene, bristle);
    if (bristle.state != FC_SLIPPING) {
        z[0] = (1.0 - fc_size(bristle) / of.bound.D) + HYSTERESIS;
    }
    if (bristle.state != FC_FREE) {
        const double speed = fc_drive_largest_speed(&scene->drive, 0.0) + fabs(of.bound.rate);
        z[1] = push(&of) + HYSTERESIS * speed;
    }
}
