// The budget: which part of solver.tolerance each part of the solver may use.
//
// The tolerance, times the largest force of the step, bounds the error of F_t at the end of a communication
// step and of its mean over the step. Work and heat have the same bound over the path. "Allowed" below is
// that product [N] for a force, and the tolerance alone [1] for a relative error.
//
//     part                     may use, of the allowed error                        the rest is for
//     Gauss panel, bounded     half; its bound is an upper bound                    the sum over panels
//     Gauss panel, judged      10 times; its estimate is 10 to 1e5 times too large  the few estimates that are too small
//     Radau panel, planned     0.003 for the mean, 0.001 at the end                 the scatter of the plan's tables
//     Radau panel, judged      10 times for the mean, a fifth at the end            as for Gauss panels
//     settled panel            0.3                                                  terms of higher order
//     Stribeck peak            a hundredth beyond its edges                         the sum over the peaks of a step
//
// An estimate that is too small matters less for the mean, which sees many panels, than at the end. If z < 1,
// a judged Radau panel may use z times its shares. A judged Gauss panel may use all of its share in the mean
// and z times it at the end (panels/judge.c).
#ifndef FC_SOLVER_BUDGET_H
#define FC_SOLVER_BUDGET_H

// All are chosen empirically. Half of a share costs panels; twice of it doubles the error that passes, and
// tests/solver, tests/physics and the hunt hold the tolerance. The shares of plans decide the cost alone.

// The largest bound that is accepted. Of 200 000 random panels no error reached 0.4 of its bound, and 99 of
// 100 stayed below 0.02 (test_bounded_panel).
static const double FC_SHARE_OF_BOUNDED_PANEL = 0.5;

// The largest estimate of a judged Gauss panel that is accepted, over the allowed error: most estimates are
// 10 to 1e5 times too large. In a Stribeck peak the excess is smaller, and some estimates are up to 2.5 times too
// small.
static const double FC_SHARE_OF_GAUSS_PANEL = 10.0;
static const double FC_SHARE_OF_GAUSS_PANEL_IN_PEAK = 0.4;

// The errors for which a Radau panel is planned.
static const double FC_PLAN_FOR_MEAN = 0.003;
static const double FC_PLAN_AT_END = 0.001;
// The largest estimates of Radau panels that are accepted, for the mean and at the end; the same in a
// Stribeck peak.
static const double FC_SHARE_OF_RADAU_MEAN = 10.0;
static const double FC_SHARE_OF_RADAU_END = 0.2;
static const double FC_SHARE_OF_RADAU_MEAN_IN_PEAK = 1.0;
static const double FC_SHARE_OF_RADAU_END_IN_PEAK = 0.05;
// Rounding of a panel's force, over the limit: 900 eps. A smaller error would only shorten Radau panels.
static const double FC_ROUNDING_OF_PANEL = 2e-13;

// The largest error of the closed form of a settled panel.
static const double FC_SHARE_OF_SETTLED_PANEL = 0.3;
// The largest effect of the rest of the Stribeck curve on the mean, at the start of a settled panel.
static const double FC_SHARE_OF_CURVE_LEFT = 0.05;

// The march. FREE: a free motion between meetings. FORMULA: the estimate of a quadrature of a formula, which
// is 10 to 1e5 times too large. EVENT: a bristle that passes its bound by less does not meet it; along a
// line in ElasticPlastic, which meets its bound to rounding, the error of a meeting and of the end of a slip.
// CUT: the distance to the bound at the cut of a panel. GRAZE: the error between the nodes of a panel
// that may graze the bound.
static const double FC_SHARE_OF_FREE = 0.5;
static const double FC_SHARE_OF_FORMULA = 3.0;
static const double FC_SHARE_OF_EVENT = 0.02;
static const double FC_SHARE_OF_CUT = 0.1;
static const double FC_SHARE_OF_GRAZE = 0.1;

// The largest tolerance of a settled state in the plane. Chosen empirically: a bristle that turns little in
// each period adds up the errors of many. At ten times of it a settled force missed by twice; a tenth of it
// costs panels.
static const double FC_MOST_TOLERANCE_OF_SETTLED_PLANE = 1e-3;

// The largest error of the interpolated maps of moving periods.
static const double FC_SHARE_OF_LEAP = 0.2;

// The largest effect of the Stribeck curve beyond the edges of its peak.
static const double FC_SHARE_BEYOND_PEAK = 0.01;

#endif
