// The course of V = (V, V_y) over an interval: the near-zeros of |V|, and the variable in which |V| is smooth
// there.
//
// At a near-zero t_c the square of |V| is c^2 ((t - t_c)^2 + eps^2), to the lowest order: |V| has branch
// points at the distance eps from the real axis, and a kink if eps = 0, which is a reversal. With
//
//     t = t_c + L sinh(u)      L = max(eps, sqrt(tolerance) times the layer, sqrt(2 g / (sigma c)), over which a bristle relaxes there)
//
// |V| is smooth in u on either side of t_c: sqrt((t - t_c)^2 + eps^2) = eps cosh(u) if L = eps.
#ifndef FC_SOLVER_COURSE_H
#define FC_SOLVER_COURSE_H

#include "model/plane.h"

typedef struct {
    double center; // s, t_c
    double length; // s, L; infinite without a near-zero: then t = t_c + u
} FcStraight;

double fc_straight_time(const FcStraight* in, double u); // s
double fc_straight_pace(const FcStraight* in, double u); // s, dt/du
double fc_straight_place(const FcStraight* in, double t);

// A part of the interval without a near-zero inside, from a near-zero to halfway to the next one, or back.
typedef struct {
    double start, end; // s
    FcStraight in;
} FcHalf;

double fc_half_time(const FcHalf* half, double u); // s, within the half in spite of rounding

// Room for two near-zeros a period, over less than three periods.
enum { FC_MOST_HALVES = 24 };

// Finds the halves of [0, h], in their order; returns their number. If the scene vibrates, h [s] is less than
// two periods.
int fc_halves(const FcPlane* plane, double h, double tolerance, FcHalf halves[FC_MOST_HALVES]);

#endif
