// The constants of the march, of the periods and of a mass that are chosen and not derived: each with its meaning, and the
// width of its plateau, that is the range over which neither the misses of the hunt nor the evaluations change.
//
// tools.constants.plateaus measures the evaluations and the worst error of the scenes of the benchmarks at half and
// twice of each; "0.99, 1.02" is what half and twice of it cost in evaluations. The tolerance, times the largest force of the
// step, bounds the errors of F_t at the end of a communication step and of its mean. Work and heat have the same bound over
// the path. "Allowed" is that product [N].
#ifndef FC_SOLVER_INTEGRATE_TUNING_H
#define FC_SOLVER_INTEGRATE_TUNING_H

#include "model/friction.h"

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

// The velocity over V_S beyond which a part of the interval has the variable of the layer, not of the curve: one V_S
// beyond the end of its peak, where e^-36 of it is left, one eps. Two thirds of it cost 1.005, 1.5 times of it 1.001.
static const double FC_END_OF_CURVE = FC_END_OF_PEAK + 1.0;

// ---- Newton's method of a panel ----

// The largest number of iterations of Newton's method. Chosen empirically: a panel that needs more is too
// long. Half of it refuses good panels, twice of it costs time.
enum { FC_MAX_ITERATIONS = 12 };

// ---- blocks of periods ----

// The fewest periods of a block. Chosen empirically: a block costs about as many. Fewer periods are computed
// one by one.
static const double FC_MIN_PERIODS = 12.0;
// The number of periods in which a bristle that meets its bound forgets its start: in the plane its angle; on
// a line, if it slips for no time, all of it. Chosen empirically: fewer are refused more often, more cost
// more. Each sample costs two times as many, so fewer periods than FC_MIN_PERIODS_OF_SLIPS are computed one by one.
enum { FC_WARM_UP = 3 };
static const double FC_MIN_PERIODS_OF_SLIPS = 60.0;

// FC_MIN_POINTS, FC_MAX_POINTS: the numbers of points of the interpolation. FC_MAX_PART_OF_BLOCK: the largest part of a
// block's periods that may be points. Chosen empirically: a block that needs more gains nothing. Half of them
// refuses more blocks.
enum { FC_MIN_POINTS = 4, FC_MAX_POINTS = 17 };
static const double FC_MAX_PART_OF_BLOCK = 0.7;
// The largest accepted error at the last point but one, over that at the last. Chosen empirically: both are
// seldom small by chance. Half of it costs points; three times of it let a work miss by 1.04 tolerances.
static const double FC_MAX_ERROR_BEFORE = 10.0;

// The number of parts of a block, or up to twice as many, between whose ends the bound is taken as linear; in each the
// free bristle with the least margin is followed. Chosen empirically: half of them may miss a meeting, twice as many cost
// evaluations.
enum { FC_PARTS_OF_BLOCK = 64 };

// The number of times in a period at which the margin of a stuck bristle is looked at. Chosen empirically: of 240 scenes made to hide a
// meeting half of them miss none. Twice as many cost evaluations.
enum { FC_PHASES = 8 };

// ---- periods that repeat ----

// The largest number of periods with moving inputs. Twice as many would take twice the time, which may be
// minutes.
static const double FC_MAX_CHANGING_PERIODS = 1e6;

// The largest difference of the ends of two periods that count as equal, over the deflection. Half of it costs a part of a
// period; twice of it accepts ends that still change by twice as much. It is times the part that relaxes in a period: the
// remaining distance to the end is the change of a period over that part.
static const double FC_SAME_END = 1e-10;

// The least such part: FC_SAME_END times it, 1e-14, is a change by rounding, and counts as none whatever relaxes. All ends of
// ElasticPlastic, in which nothing relaxes, are judged by it.
static const double FC_MIN_CHANGE = 1e-4;

// The largest part of a start that a period may forget if its end determines its start: at one half the start
// has twice the error of the end. More would multiply the error further.
static const double FC_MAX_FORGOTTEN = 0.5;

// The largest number of periods that meet the bound before a repetition is given up. With static friction the
// place of sticking may depend on the place of break-away. Then periods need not repeat, and the mean over
// the last third of the meetings counts. Half as many would give a mean over fewer periods; twice as many
// would cost twice the time.
enum { FC_MAX_MEETINGS = 1000 };
// The same in the plane, over that, while the mean still drifts by more than the tolerance: a bristle that slips
// little in each period turns slowly. Chosen empirically: half of it left a found scene 3e-5 of the force away,
// twice of it costs twice the time of a chaotic motion.
enum { FC_LONGER_IF_DRIFTING = 4 };

// What a period and the power of a map cost beside their evaluations, in evaluations. Chosen empirically: with them no watched
// call with usual numbers takes a second.
static const double FC_WORK_OF_PERIOD = 10.0;
static const double FC_WORK_OF_POWER = 30.0;

// The farthest that a step of Newton moves the deflection, over it. Chosen empirically: without a limit one of
// 143 drawn scenes settles elsewhere, at half of it errors grow.
static const double FC_MAX_NEWTON_STEP = 1.0;

// ---- the march of a mass ----

// The safety factor on the estimated errors of delta and v, whose effects on each other are not estimated. Chosen empirically:
// a third of it misses in hunts; three times of it costs 1.07.
static const double FC_BODY_SAFETY = 1000.0;
// The part of its layer by which a reversal may be missed, over the root of the tolerance. Derived: the effect goes with its
// square.
static const double FC_BODY_SHARE_OF_LAYER = 0.05;
// The part of the tolerance by which a bristle may pass its bound, if its force drops there, and if it does not.
static const double FC_BODY_SHARE_OF_DROP = 1e-5;
static const double FC_BODY_SHARE_OF_EVENT = 1e-3;
// A panel that begins beyond so many times the end of a Stribeck curve is cut at it.
static const double FC_BODY_MARGIN_OF_CURVE = 1.2;
// Lengths, which decide the cost alone: by which the phase of the contact or of the ringing moves in a panel; of a panel in u;
// and from a reversal in layers, beyond which the variable is t.
static const double FC_BODY_MAX_PHASE = 2.0;
static const double FC_BODY_MAX_LENGTH_U = 3.0;
static const double FC_BODY_END_OF_LAYER = 30.0;
// The part of the tolerance that periods which are counted may change.
static const double FC_BODY_SHARE_OF_PERIODS = 0.1;
// Of two panels of which the longer shows an event and the shorter does not, this part of the longer is looked at next.
static const double FC_BODY_BETWEEN = 0.1;
// Cuts at one event, refusals of one panel, and panels in a row that do not get on, at an event that rounding hides.
enum { FC_BODY_MAX_CUTS = 24, FC_BODY_MAX_REJECTIONS = 25, FC_BODY_MAX_STALLED = 50 };

#endif
