// The time map: the parts of an interval, and the graded change of variable t(u) in which each is crossed.
//
// |V| is least at its centers: reversals along a line, near-zeros in the plane, and minima that touch 0. Near a center
// t_c, to the lowest order n,
//
//     |V|^2 = a^2 (x^2n + eps^2n),      x = t - t_c,      a = |d^n V/dt^n| / n!
//
// It has branch points at the distance eps from the real axis; at a reversal eps = 0. Its relaxation time there is
// the layer, ((n + 1) g / (sigma a))^(1 / (n + 1)). With
//
//     t = t_c + L sinh(u)      along a line L = max(eps, layer), since V is analytic on either side;
//                              in the plane L = max(eps, sqrt(tolerance) layer), since V turns within eps
//
// the motion is smooth in u on either side of t_c. A Stribeck curve shortens L to the time in which V moves by V_S; where
// the curve has ended a part is cut, and the variable is that of the layer.
#ifndef FC_SOLVER_INTEGRATE_TIME_MAP_H
#define FC_SOLVER_INTEGRATE_TIME_MAP_H

#include "model/plane.h"

typedef struct {
    double center; // s, t_c
    double length; // s, L; infinite for t = t_c + u
} FcTimeMap;

double fc_time_map_t(const FcTimeMap* in, double u);     // s
double fc_time_map_dt_du(const FcTimeMap* in, double u); // s, dt/du
double fc_time_map_u(const FcTimeMap* in, double t);

// At a center |V|, |V'|, |V''| / 2 and |V'''| / 6: bounds of |V| beside it.
typedef struct {
    double of[4];
} FcSpeedBound;

// A part of the interval, on one side of the center of its variable.
typedef struct {
    double start, end; // s
    FcTimeMap in;
    int side; // along a line, the sign of V; 0 in the plane
    double
        strip_ratio; // the strip of u in which the force is analytic, over that of a reversal at which V' != 0
    FcSpeedBound speed_bound;
} FcPart;

double fc_part_time(const FcPart* part, double u); // s, within the part in spite of rounding

// An upper bound of |V| [m/s] at the distance x [s] from the center.
static inline double fc_part_speed(const FcPart* part, double x) {
    x = fabs(x);
    return part->speed_bound.of[0] +
           x * (part->speed_bound.of[1] + x * (part->speed_bound.of[2] + x * part->speed_bound.of[3]));
}

// Room for two centers a period over less than three periods, with up to four parts each.
enum { FC_MAX_PARTS = 40 };

// Finds the parts of [0, h], in their order; returns their number. If the scene vibrates, h [s] > 0 is less than
// two periods.
int fc_parts(const FcPlane* plane, double h, double tolerance, FcPart parts[FC_MAX_PARTS]);

#endif
