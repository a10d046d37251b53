// Where a bound of the stuck bristle starts to recede.
//
// A bristle that sticks moves with V, its bounds +D and -D, D = g / sigma, with D'. So the upper bound comes nearer at
// the rate V - D' and the lower one at -V - D'. At a turning point one of them stops coming nearer: from one turning
// point to the next each bound only comes nearer, only recedes, or recedes first. So the bristle meets it at most once,
// and does if it is beyond at the end:
//
//        D ----.__                         .-- turns: the upper bound recedes
//     delta  /    '--.__  meets      __.--'
//           /            '---*---.--'
//          /  sticks          slips |  sticks
//
// With a constant D these are the reversals of V. With a moving one they may be known but for small windows
// (known_turns.h); elsewhere the rates and their slopes are sampled in cells over which the scene is smooth; a cell whose
// samples do not exclude a second root is halved.
#ifndef FC_SOLVER_TURNING_POINTS_H
#define FC_SOLVER_TURNING_POINTS_H

#include <stdbool.h>

#include "solver/bound.h"
#include "solver/known_turns.h"

// A stretch of time between turning points or the ends of cells.
typedef struct {
    const FcBoundMotion* start; // both until the next piece is asked for
    const FcBoundMotion* end;
    bool nears[2]; // at the start: the upper bound, the lower one
    bool turns;    // it ends at a turning point
} FcPiece;

typedef struct {
    FcBoundMotion at;
    int which;        // 0: the upper bound, 1: the lower one
    bool nears_after; // else it recedes
} FcTurningPoint;

enum { FC_CELLS_AT_ONCE = 16, FC_MOST_TURNS_IN_CELL = 16 };

// Goes through [0, end] piece by piece.
typedef struct {
    const FcScene* scene;
    double end;          // s
    double last_step;    // of the roots, bracketed_root.h
    double longest_way;  // s, of theirs
    bool constant_bound; // D does not move
    FcKnownTurns known;
    double next_known;                          // number of the turn
    int turned;                                 // the bound that recedes from the point reached on, or -1
    bool has_last;                              // the last of the samples ends the step
    double speed;                               // m/s, |V| is never larger
    double smooth_time;                         // s, of bound.h, common to all cells or 0
    const FcBoundMotion* at;                    // reached
    FcBoundMotion sample[FC_CELLS_AT_ONCE + 1]; // ends of cells
    int ahead, sample_count;                    // the one that ends the cell at hand, and the last
    FcTurningPoint turn[FC_MOST_TURNS_IN_CELL]; // in the cell at hand
    int next_turn, turn_count;
    double evaluations; // spent so far
} FcTurningPoints;

// D at a turning point is within tolerance / 100 of itself, in rounding where it stands still.
void fc_turning_points_start(FcTurningPoints* points, const FcScene* scene, double tolerance, double end);

// Before the first piece: uses what is known of the turning points for a bristle that starts between lowest and highest [m].
void fc_turning_points_foresee(FcTurningPoints* points, double lowest, double highest);

// The next piece; points->at->t < points->end must hold. A bristle that starts it between lowest and highest [m] needs
// no turning points of a bound that it can't reach in the cell: the piece may then run on across them.
void fc_turning_points_next(FcTurningPoints* points, double lowest, double highest, FcPiece* piece);

// A bristle that starts the piece on a bound that recedes may lie beyond it at the end, and so have met it again: ends the
// piece where the bound still recedes.
void fc_turning_points_shorten(FcTurningPoints* points, FcPiece* piece, int which);

// The motion at t [s] for what V and D need.
FcBoundMotion fc_turning_points_motion(const FcTurningPoints* points, double t);

#endif
