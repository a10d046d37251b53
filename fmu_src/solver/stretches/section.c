#include "solver/stretches/section.h"

#include <assert.h>
#include <math.h>

#include "model/constants.h"
#include "solver/panels/gauss_rule.h"

// This file makes plans, whose panels are judged afterwards: it decides tries and time, not accuracy.
// Constants that are not marked as derived or fitted are chosen empirically.
//
// Gauss panels may be cheaper for a section over which the bristle relaxes by less than this, in a peak and
// elsewhere, and the phase and ln(sigma) together move by less than SLOW. Half of it leaves sections to Radau
// panels, which cost more. Twice of it plans panels that are refused.
static const double SOFT_IN_PEAK = 2.5;
static const double SOFT = 40.0;
static const double SLOW = 15.0;
// If the bristle may relax by this much, sigma is sampled in the section: it may be many times its value at
// the interval's start.
static const double WORTH_SAMPLING = 0.5;
// A peak adds this to the change over a panel, beyond its width.
static const double PEAK_CHANGE = 2.0;
// n nodes resolve e^z if z is less than half of n (panels/judge.c); a little less, since z is an estimate
// here.
static const double RESOLVED = 0.47;
// The time of Radau panels, over that of a Gauss panel of 4 nodes: of those between two reversals half a
// period apart, up to FEW_DECADES of accuracy and for each decade more; and of one panel.
static const double TIME_OF_RADAU = 7.0;
static const double FEW_DECADES = 3.0;
static const double TIME_FOR_EACH_DECADE = 2.3;
static const double TIME_OF_RADAU_PANEL = 2.3;
// phi, half of the angle [rad] by which the vibration turns, of half a period. Derived: pi / 2.
static const double PHI_OF_HALF_PERIOD = 0.5 * FC_PI;

// n nodes are accurate over a whole stretch at tolerances down to 10^(one + phi sqrt(phi) + mu sqrt(mu) + z
// sqrt(z)), about, with the columns as factors: fitted by least squares to random panels, with a scatter of
// half a decade (4 nodes) to one and a half (12). The program of that fit is not kept, since an error of the
// plan costs tries alone. time: of a panel, over that of 4 nodes.
enum { PLANNED_RULES = 4 }; // of 4, 6, 8 and 12 nodes
static const struct {
    int nodes;
    double time;
    double one, phi, mu, z;
} PLAN[PLANNED_RULES] = {
    {4, 1.00, -4.44, 2.14, 0.42, 0.65},
    {6, 1.25, -10.16, 5.06, 0.99, 1.91},
    {8, 1.40, -15.04, 6.49, 1.65, 3.05},
    {12, 1.93, -19.12, 6.23, 2.21, 3.30},
};

// The mean sees each of n panels by its share of the stretch, so each may have SPARED[n] decades of accuracy
// less. Derived: lg n.
enum { MOST_PANELS = 12 };
static const double SPARED[MOST_PANELS + 1] = {0, 0, .3, .48, .6, .7, .78, .85, .9, .95, 1, 1.04, 1.08};

// Whether a stretch that is all peak passes so much of the curve that evenly spread nodes may miss it.
static bool is_narrow_somewhere(const FcStretch* stretch) {
    const FcScene* scene = stretch->interval->scene;
    const FcDrive* drive = &scene->drive;
    const double moves = 2.0 * drive->vibration.V_1 + fabs(drive->V.rate) * (stretch->end - stretch->start);
    return stretch->peaks.after == stretch->end && moves > 3.0 * scene->friction->V_S;
}

static FcRelaxation measured(const FcSection* section, double* evaluations) {
    enum { N = 4 };
    const FcGaussRule* rule = &FC_GAUSS_4;
    const double duration = section->end - section->start;
    FcNodeCoefficients at;
    fc_node_coefficients(section->scene, section->start, duration, rule->node, N, &at);
    *evaluations += N;
    double z[N]; // at the rate of the node throughout
    for (int i = 0; i < N; i++) {
        z[i] = duration * at.sigma[i] * fabs(at.V[i]) / at.limit[i];
    }
    const double first = rule->weight[0] * z[0] + rule->weight[1] * z[1];
    const double second = rule->weight[2] * z[2] + rule->weight[3] * z[3];
    return (FcRelaxation){
        .whole = first + second,
        .half = fc_most(first, second),
        .fastest = fc_most(fc_most(z[0], z[1]), fc_most(z[2], z[3])),
    };
}

static void find_relaxation(const FcStretch* stretch, FcSection* section, double* evaluations) {
    const FcInterval* interval = stretch->interval;
    const double X = fabs(fc_stretch_displacement(stretch, section->start, section->end));
    const double z = stretch->per_path * X;
    const double most = interval->stiffness / interval->limit * X;
    section->is_measured = !section->in_peak && most > WORTH_SAMPLING && z < SOFT;
    section->z = section->is_measured ? measured(section, evaluations) : (FcRelaxation){z, z, z};
}

static bool is_soft(const FcPace* pace, const FcSection* section) {
    return section->z.whole < (section->in_peak ? SOFT_IN_PEAK : SOFT) &&
           (section->end - section->start) * (pace->phase + pace->log_sigma) < SLOW;
}

int fc_sections(const FcStretch* stretch, FcSection* sections, double* evaluations) {
    const FcInterval* interval = stretch->interval;
    const double ends[] = {stretch->start, stretch->peaks.after, stretch->peaks.before, stretch->end};
    assert(ends[0] <= ends[1] && ends[1] <= ends[2] && ends[2] <= ends[3]);
    const bool narrow = is_narrow_somewhere(stretch);
    int count = 0;
    for (int i = 0; i < 3; i++) {
        const double duration = ends[i + 1] - ends[i];
        if (!(duration > 0.0)) {
            continue;
        }
        FcSection* section = &sections[count++];
        section->in_peak = i != 1;
        section->scene = section->in_peak ? interval->scene : interval->beyond_peaks;
        section->start = ends[i];
        section->end = ends[i + 1];
        section->share = duration / (stretch->end - stretch->start);
        assert(section->share <= 1.0);
        find_relaxation(stretch, section, evaluations);
        section->forgets = stretch->per_path * (fabs(stretch->displacement) + stretch->path_after);
        section->soft = !narrow && is_soft(&interval->pace, section);
    }
    return count;
}

// The first rule whose estimate will be small enough; PLANNED_RULES if there is none.
static int rule_for(double phi, double mu, double z, double decades) {
    const double root_phi = sqrt(phi);
    const double root_mu = sqrt(mu);
    const double root_z = sqrt(z);
    for (int i = 0; i < PLANNED_RULES; i++) {
        const double of_estimate =
            PLAN[i].one + PLAN[i].phi * root_phi + PLAN[i].mu * root_mu + PLAN[i].z * root_z;
        if (of_estimate < -decades && z < RESOLVED * PLAN[i].nodes) {
            return i;
        }
    }
    return PLANNED_RULES;
}

FcGaussPlan fc_gauss_plan(double phi, double mu, const FcRelaxation* z, double decades) {
    assert(!(phi < 0.0 || mu < 0.0 || z->half > z->whole));
    const double of_half_period = TIME_OF_RADAU + TIME_FOR_EACH_DECADE * fc_most(0.0, decades - FEW_DECADES);
    double least =
        fc_most(TIME_OF_RADAU_PANEL, of_half_period * fc_least(1.0, fc_most(phi, mu) / PHI_OF_HALF_PERIOD));
    FcGaussPlan cheapest = {0, FC_GAUSS_MOST_NODES};
    for (int n = 1; n <= MOST_PANELS && n * PLAN[0].time < least; n++) {
        const double of_panel = n == 1 ? z->whole : n == 2 ? z->half : z->fastest / n;
        const int i = rule_for(phi / n, mu / n, of_panel, decades - SPARED[n]);
        if (i < PLANNED_RULES && n * PLAN[i].time < least) {
            least = n * PLAN[i].time;
            cheapest = (FcGaussPlan){n, PLAN[i].nodes};
        }
    }
    return cheapest;
}

// The number of nodes for a panel in a peak, for about this change over it.
static double nodes_for(double decades, double change) { return 2.0 + 0.6 * decades + 0.5 * change; }

static FcGaussPlan plan_in_peak(double change, double decades) {
    const double room = fc_most(2.0, FC_GAUSS_MOST_NODES - nodes_for(decades, 0.0));
    const double count = fc_most(1.0, ceil(0.5 * change / room));
    assert(room >= 2.0 && count >= 1.0);
    return (FcGaussPlan){(int)fc_least(count, 1e9), fc_gauss_count(nodes_for(decades, change / count))};
}

FcGaussPlan fc_section_plan(const FcStretch* stretch, const FcSection* section) {
    const FcPace* pace = &stretch->interval->pace;
    const double duration = section->end - section->start;
    const double phase = pace->phase * duration;
    const double log_sigma = pace->log_sigma * duration;
    if (section->in_peak) {
        const double change =
            1.4 * (phase + log_sigma) + 2.0 * section->z.whole + PEAK_CHANGE + stretch->peaks.reach;
        return plan_in_peak(change, stretch->peaks.digits);
    }
    const double decades = fc_digits(stretch->interval->tolerance) - fc_digits(section->share);
    return fc_gauss_plan(0.5 * phase, 0.5 * log_sigma, &section->z, decades);
}
