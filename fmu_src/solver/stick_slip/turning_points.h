// Where a bound of the bristle starts to recede.
//
// A bristle that does not slip along its bounds +D and -D moves with V - |V| k delta / D, k being 0 in ElasticPlastic and at
// least 1 in Dahl and LuGre, where it relaxes. For one that is on it, the upper bound comes nearer at the rate
// V - |V| k - D' and the lower one at -V - |V| k - D'. How far the bristle is beyond the bound, p < 0, follows
//
//     p' = rate - (|V| k / D) p
//
// so that p crosses zero once at the most while the rate keeps its sign, and does if p > 0 at the end. At a turning point
// the rate changes its sign:
//
//        D ----.__                         .-- turns: the upper bound recedes
//     delta  /    '--.__  meets      __.--'
//           /            '---*---.--'
//          /  sticks          slips |  sticks
//
// With a constant D and k = 0 these are the reversals of V. Elsewhere the rates and their slopes are sampled in cells over
// which the scene is smooth; where k > 0 a cell ends at a reversal, at which the slopes jump. A cell whose samples do not
// exclude a second root is divided.
#ifndef FC_SOLVER_TURNING_POINTS_H
#define FC_SOLVER_TURNING_POINTS_H

#include <stdbool.h>

#include "solver/stick_slip/bound.h"

// The time between turning points or the ends of cells.
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

// By hand: samples taken together, which costs memory alone, and turns of a cell; any more are left out.
enum { FC_CELLS_AT_ONCE = 16, FC_MOST_TURNS_IN_CELL = 16 };

// Goes through [0, end] piece by piece.
typedef struct {
    const FcScene* law;
    const FcScene* scene; // of the bound: that of the law in ElasticPlastic, else
    FcScene bound_scene;  // this one, with
    FcFriction friction;
    bool relaxes;              // k > 0
    FcDriveEvent event;        // where it relaxes: the next reversal of V
    double sign;               // of V in the cell at hand
    FcBoundMotion piece_start; // where it relaxes
    double end;                // s
    double last_step;          // of the roots, model/root.h
    double tolerance;    // 1, of how far a bristle moves between a turning point and the root found, over D
    bool constant_bound; // D does not move
    double speed;        // m/s, |V| is never larger
    double smooth_time;  // s, of bound.h, common to all cells or 0
    double peak_time;    // s, the same of the cell at hand where D has a Stribeck peak, else 0
    const FcBoundMotion* at;                    // reached
    FcBoundMotion sample[FC_CELLS_AT_ONCE + 1]; // ends of cells
    int ahead, sample_count;                    // the one that ends the cell at hand, and the last
    FcTurningPoint turn[FC_MOST_TURNS_IN_CELL]; // in the cell at hand
    int next_turn, turn_count;
    double evaluations; // spent so far
} FcTurningPoints;

// D at a turning point is within tolerance / 100 of itself, in rounding where it stands still.
void fc_turning_points_start(FcTurningPoints* points, const FcScene* scene, double tolerance, double end);

// The next piece; points->at->t < points->end must hold. A bristle that starts it between lowest and highest [m] needs
// no turning points of a bound that it can't reach in the cell: the piece may then run on across them. Where it relaxes, a
// piece ends at a turning point of either bound, or where one comes nearer or recedes that did not at its start.
void fc_turning_points_next(FcTurningPoints* points, double lowest, double highest, FcPiece* piece);

// The motion at t [s] for what V and D need.
FcBoundMotion fc_turning_points_motion(const FcTurningPoints* points, double t);

#endif
