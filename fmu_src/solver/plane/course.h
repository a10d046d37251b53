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

// A part of the interval, between the middles of three near-zeros; if |V| has a kink in u, as at a reversal, from or
// to the near-zero.
typedef struct {
    double start, end; // s
    FcStraight in;
} FcPart;

double fc_part_time(const FcPart* part, double u); // s, within the part in spite of rounding

// Room for two near-zeros a period, over less than three periods.
enum { FC_MOST_PARTS = 24 };

// Finds the parts of [0, h], in their order; returns their number. If the scene vibrates, h [s] is less than
// two periods.
int fc_parts(const FcPlane* plane, double h, double tolerance, FcPart parts[FC_MOST_PARTS]);

#endif
