// The pieces of an interval that are crossed one after the other (fc_scene_piece): a load that moves by
// decades, and a contact that opens and closes.
#ifndef FC_SOLVER_PIECES_H
#define FC_SOLVER_PIECES_H

#include <stdbool.h>

#include "solver/solver.h"

typedef struct {
    const FcScene* of;
    double whole, t;      // s, the interval, and the start of the next piece
    const FcScene* scene; // of the piece
    double h;             // s, its length
    FcScene own;          // the piece's, if it is not the interval's
} FcPieces;

// The interval [0, whole] of the scene. Keeps the pointer, and points into itself.
void fc_pieces_start(FcPieces* pieces, const FcScene* scene, double whole);

// Takes the next piece; false if there is none. Even an interval of no length has one.
bool fc_next_piece(FcPieces* pieces);

// A step of any length without contact: the bristle is lost. It has no energy: with a constant stiffness its
// bound has fallen to 0 before, else the stiffness has.
void fc_loose_step(FcStepResult* result);

// The bristle of the result at the start of the scene, beyond whose bound a step has taken it: fc_reach. The
// energy that it loses is heat.
void fc_take_onto_bound(const FcScene* scene, FcStepResult* result);

// Takes *total over an interval of at most a period, piece by piece.
void fc_take_pieces(const FcScene* scene, const FcSolverOptions* options, double duration,
                    FcStepResult* total);

#endif
