// The budget: which part of solver.tolerance each part of the solver may use.
//
// The tolerance, times the largest force of the step, bounds the error of F_t at the end of a communication step and of its mean
// over the step; work and heat are held to the same over the path. "Allowed" below is that product [N] for a force, and
// the tolerance alone [1] for what is relative to the force.
//
//     who                      may use, of what is allowed                          the rest is for
//     Gauss panel, bounded     half; its bound is an upper bound                    the sum over panels
//     Gauss panel, judged      10 times; its estimate is 10 to 1e5 times too large  the few estimates that are too small
//     Radau panel, planned     0.003 for the mean, 0.001 at the end                 what the plan's tables scatter by
//     Radau panel, judged      10 times for the mean, a fifth at the end            as for Gauss panels
//     settled panel            0.3                                                  terms of higher order
//     Stribeck peak            a hundredth beyond its edges                         the sum over the peaks of a step
//
// An estimate that is too small matters less for the mean, where it is one of many panels, than at the end. Where z < 1 a judged
// Radau panel may use z times its shares, a judged Gauss panel all of its share in the mean and z times it at the end
// (panels/judge.c).
#ifndef FC_SOLVER_BUDGET_H
#define FC_SOLVER_BUDGET_H

// All are chosen by hand: smaller ones cost panels, larger ones break the tolerance, which tests/solver, tests/physics and the
// hunt hold. Those of plans decide the cost alone.

// What the bound may be. Of 200 000 random panels no error came to 0.4 of its bound, and 99 of 100 not to 0.02
// (test_bounded_panel).
static const double FC_SHARE_OF_BOUNDED_PANEL = 0.5;

// A judged Gauss panel passes where its estimate is at most this many times what is allowed: most estimates are 10 to 1e5
// times too large. In a Stribeck peak they are less so, and now and then too small. Over a panel that relaxes by more than
// FC_STEEP, which is no share, or begins as if it did, the estimate of the mean may be half the error.
static const double FC_SHARE_OF_GAUSS_PANEL = 10.0;
static const double FC_SHARE_OF_GAUSS_PANEL_IN_PEAK = 1.0;
static const double FC_STEEP = 4.0;
static const double FC_SHARE_OF_STEEP_PANEL = 0.05; // of whichever of the two shares holds, for the mean

// What a Radau panel is planned for.
static const double FC_PLAN_FOR_MEAN = 0.003;
static const double FC_PLAN_AT_END = 0.001;
// Estimates of Radau panels, for the mean and at the end; in a Stribeck peak.
static const double FC_SHARE_OF_RADAU_MEAN = 10.0;
static const double FC_SHARE_OF_RADAU_END = 0.2;
static const double FC_SHARE_OF_RADAU_MEAN_IN_PEAK = 1.0;
static const double FC_SHARE_OF_RADAU_END_IN_PEAK = 0.05;
// Rounding of a panel's force, over the limit, 900 eps: asking a Radau panel for less would only shorten it.
static const double FC_ROUNDING_OF_PANEL = 2e-13;

// What the closed form of a settled panel may miss.
static const double FC_SHARE_OF_SETTLED_PANEL = 0.3;
// What may be left of the Stribeck curve, in the mean, where a settled panel begins.
static const double FC_SHARE_OF_CURVE_LEFT = 0.05;

// The march. What a free motion may use, between meetings; the estimated error of a quadrature of a formula, which is 10 to 1e5 times
// too large; a meeting that a bound is passed by less in is none; what is left to the bound where a panel is cut; what the
// nodes of a panel that may graze the bound may miss between them.
static const double FC_SHARE_OF_FREE = 0.5;
static const double FC_SHARE_OF_FORMULA = 3.0;
static const double FC_SHARE_OF_EVENT = 0.02;
static const double FC_SHARE_OF_CUT = 0.1;
static const double FC_SHARE_OF_GRAZE = 0.1;

// What interpolating the maps of moving periods may miss.
static const double FC_SHARE_OF_LEAP = 0.1;

// What the Stribeck curve may do beyond the edges of its peak.
static const double FC_SHARE_BEYOND_PEAK = 0.01;

#endif
