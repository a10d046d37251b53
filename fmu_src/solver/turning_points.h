// Where a bound of the stuck bristle stops coming nearer, and starts again.
//
// A bristle that sticks moves with V, its bounds +D and -D, D = g / sigma, with D'. So the upper bound comes nearer
// while V > D' and the lower one while V < -D'; the turning points are the roots of V - D' and V + D'. Between two
// of them each distance rises or falls all the time, and the bristle meets each bound at most once:
//
//        D ----.__                         .-- turns: the upper bound recedes
//     delta  /    '--.__  meets      __.--'
//           /            '---*---.--'
//          /  sticks          slips |  sticks
//
// With a constant D these are the reversals of V. With a moving one, V -+ D' and its slope are sampled in cells over
// which the scene is smooth; a cell whose samples do not exclude a second root is halved.
#ifndef FC_SOLVER_TURNING_POINTS_H
#define FC_SOLVER_TURNING_POINTS_H

#include <stdbool.h>

#include "model/scene.h"

// A stretch of time between turning points or the ends of cells.
typedef struct {
    double start, end;             // s
    double start_bound, end_bound; // m, D at both ends
    bool nears_upper, nears_lower; // the bound, in all of it
} FcPiece;

typedef struct {
    double t;           // s
    double D;           // m
    double q[2];        // m/s, V - D' and V + D'
    double q_rate[2];   // m/s2
    double smooth_time; // s
} FcBoundSample;

typedef struct {
    double t;
    int which; // 0: of V - D', 1: of V + D'
} FcTurningPoint;

enum { FC_MOST_TURNS_IN_CELL = 16 };

// Goes through [0, end] piece by piece.
typedef struct {
    const FcScene* scene;
    double end;          // s
    double t;            // s, reached
    double D;            // m, at t
    bool constant_bound; // D does not move
    bool nears_upper, nears_lower;
    double speed;           // m/s, |V| is never larger
    FcBoundSample cell_end; // the cell at hand, where the bound moves
    FcTurningPoint turns[FC_MOST_TURNS_IN_CELL];
    int turn_count, next_turn;
    double evaluations; // spent so far
} FcTurningPoints;

FcTurningPoints fc_turning_points(const FcScene* scene, double end);

// The next piece; points->t < points->end must hold. A bristle that starts it between lowest and highest [m] needs no
// turning points of a bound that it can't reach in the cell: the piece may then run on across them.
FcPiece fc_turning_points_next(FcTurningPoints* points, double lowest, double highest);

#endif
