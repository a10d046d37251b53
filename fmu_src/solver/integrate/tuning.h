// All constants of the solver that are chosen and not derived: each with its meaning, and the width of its
// plateau, that is the range over which neither the misses of the hunt nor the evaluations change.
//
// tools.constants.plateaus measures the evaluations and the worst error of the scenes of the benchmarks at half and
// twice of each; "0.99, 1.02" is what half and twice of it cost in evaluations. The tolerance, times the largest force of the
// step, bounds the errors of F_t at the end of a communication step and of its mean. Work and heat have the same bound over
// the path. "Allowed" is that product [N].
#ifndef FC_SOLVER_INTEGRATE_TUNING_H
#define FC_SOLVER_INTEGRATE_TUNING_H

// ---- accuracy ----

// The one safety factor: on every estimated error, and in the plan of a panel's length. The method is of order
// 17: 0.99, 1.02.
static const double FC_SAFETY = 4.0;

// The estimate that is accepted, over the allowed error: for the mean, in which the errors of panels differ in sign; at
// the end. 1.01, 1.00; 1.01, 0.99.
static const double FC_SHARE_OF_MEAN = 10.0;
static const double FC_SHARE_OF_END = 0.2;

// The part of a defect that acts on the mean over a panel, since the defect changes sign between the points: 1.00, 1.00.
static const double FC_MEAN_OF_DEFECT = 0.1;

// A bristle that passes its bound by a smaller part of the allowed error does not meet it: 1.00, 1.00.
static const double FC_SHARE_OF_EVENT = 0.02;

// The largest error of the interpolated maps of moving periods, over the allowed error.
static const double FC_SHARE_OF_BLOCK = 0.2;

// ---- lengths of panels: they decide the cost alone ----

// The part of the strip in which the force is analytic that a panel takes (control.c): 1.03, 1.02.
static const double FC_PART_OF_STRIP = 0.4;

// The relaxation in a panel, times the seventh root of its transient over the allowed error: 1.00, 1.01.
static const double FC_RELAXATION = 60.0;

// The longest panel in the variable u: 1.00, 1.00.
static const double FC_MAX_LENGTH_U = 6.0;

// The longest panel in time, over that in which the contact moves by 1, for a tolerance of 1. 1.07 at half of it; 1.5 times
// of it costs nothing.
static const double FC_MAX_PHASE = 12.0;

// The farthest way of a stuck bristle in a panel, in radii of its bound: so far the points show a meeting. 1.01, 1.00.
static const double FC_MAX_RADII = 4.0;

// The velocity over V_S beyond which a part of the interval has the variable of the layer, not of the curve:
// e^-36 of the curve is left. Two thirds of it cost 1.005, 1.5 times of it 1.001.
static const double FC_END_OF_CURVE = 6.0;

#endif
