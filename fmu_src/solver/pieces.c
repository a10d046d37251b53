#include "solver/pieces.h"

#include <assert.h>
#include <stddef.h>

#include "model/extremes.h"
#include "model/regime.h"
#include "solver/march.h"

void fc_pieces_start(FcPieces* pieces, const FcScene* scene, double whole) {
    assert(whole >= 0.0);
    pieces->of = scene;
    pieces->whole = whole;
    pieces->t = 0.0;
    pieces->scene = NULL;
}

bool fc_next_piece(FcPieces* pieces) {
    const bool first = pieces->scene == NULL;
    if (!first && !(pieces->t < pieces->whole)) {
        return false;
    }
    pieces->scene = pieces->of;
    pieces->h = pieces->whole;
    if (first && !fc_scene_has_pieces(pieces->of)) {
        pieces->t = pieces->whole;
        return true;
    }
    pieces->own = first ? *pieces->of : fc_scene_from(pieces->of, pieces->t);
    pieces->scene = &pieces->own;
    const double rest = pieces->whole - pieces->t;
    pieces->h = fc_scene_piece(&pieces->own, rest, pieces->whole);
    const double next = pieces->t + pieces->h;
    const bool is_last = !(pieces->h < rest && next > pieces->t);
    pieces->h = is_last ? rest : pieces->h;
    pieces->t = is_last ? pieces->whole : next;
    assert(pieces->h >= 0.0 && pieces->t <= pieces->whole);
    return true;
}

void fc_loose_step(FcStepResult* result) {
    result->lost += result->delta;
    result->lost_y += result->delta_y;
    result->delta = result->delta_y = 0.0;
    result->slips = 0;
    result->on_bound = false;
}

void fc_take_onto_bound(const FcScene* scene, FcStepResult* result) {
    const FcBristle bristle = fc_bristle_of(result);
    const FcBristle reached = fc_reach(scene, bristle);
    const double size = fc_size(bristle);
    const double D = fc_size(reached);
    if (D < size) {
        const FcDrive* drive = &scene->drive;
        result->heat += 0.5 * fc_scene_contact(scene, 0.0).sigma * (size - D) * (size + D);
        result->drag += (reached.delta - bristle.delta) * fc_drive_V(drive, 0.0) +
                        (reached.delta_y - bristle.delta_y) * fc_drive_V_y(drive, 0.0);
    }
    result->delta = reached.delta;
    result->delta_y = reached.delta_y;
    result->slips = reached.slips;
}

// A limit that falls by decades is too small at the step's end for the scale of the whole step: a piece has
// its own.
static FcSolverOptions options_of_piece(const FcSolverOptions* options, const FcPieces* pieces) {
    FcSolverOptions own = *options;
    const double limit = pieces->h < pieces->whole && options->damping > 0.0
                             ? fc_scene_smallest_limit(pieces->scene, pieces->h)
                             : 0.0;
    if (limit > 0.0) {
        own.force = fc_min(own.force, fc_force_beside_damping(options->largest, options->damping, limit));
    }
    return own;
}

void fc_take_pieces(const FcScene* scene, const FcSolverOptions* options, double duration,
                    FcStepResult* total) {
    FcPieces pieces;
    fc_pieces_start(&pieces, scene, duration);
    while (total->evaluations <= FC_MAX_EVALUATIONS && fc_next_piece(&pieces)) {
        if (fc_scene_is_loose(pieces.scene)) {
            fc_loose_step(total);
        } else {
            const FcSolverOptions own = options_of_piece(options, &pieces);
            fc_march_step(pieces.scene, &own, pieces.h, total);
        }
    }
}
