#include "solver/pieces.h"

FcPieces fc_pieces(const FcScene* scene, double whole) {
    return (FcPieces){.of = scene, .whole = whole, .h = -1.0};
}

bool fc_next_piece(FcPieces* pieces) {
    const bool first = pieces->h < 0.0;
    if (!first && !(pieces->t < pieces->whole)) {
        return false;
    }
    pieces->scene = first ? *pieces->of : fc_scene_from(pieces->of, pieces->t);
    const double rest = pieces->whole - pieces->t;
    pieces->h = fc_scene_piece(&pieces->scene, rest, pieces->whole);
    const double next = pieces->t + pieces->h;
    const bool is_last = !(pieces->h < rest && next > pieces->t);
    pieces->h = is_last ? rest : pieces->h;
    pieces->t = is_last ? pieces->whole : next;
    return true;
}

void fc_loose_step(const FcScene* scene, FcStepResult* result) {
    if (result->delta != 0.0) {
        const double sigma = fc_scene_contact(scene, 0.0).sigma;
        result->heat += 0.5 * sigma * result->delta * result->delta;
        result->lost += result->delta;
        result->delta = 0.0;
    }
    result->slips = 0;
}
