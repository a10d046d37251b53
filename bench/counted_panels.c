// The default once more, with its panels counted on the way: its own source, compiled under other names.
#include "counted_panels.h"

#include "solver/gauss_panel.h"
#include "solver/radau_panel.h"

static PanelCounts counts;

static int kind_of(int nodes) {
    int kind = 0;
    while (NODES[kind] != nodes) {
        kind++;
    }
    return kind;
}

static void counted_radau_panel(const FcScene* scene, int stages, double t, double h, double sign,
                                const FcTrajectories* from, FcPanel* panel) {
    counts.judged[kind_of(stages)]++;
    fc_radau_panel(scene, stages, t, h, sign, from, panel);
}

static void counted_gauss_panel(const FcScene* scene, double t, double h, int count,
                                const FcTrajectories* from, FcPanel* panel) {
    counts.judged[kind_of(count)]++;
    fc_gauss_panel(scene, t, h, count, from, panel);
}

static void counted_gauss_panel_unjudged(const FcScene* scene, double t, double h, int count,
                                         const FcTrajectories* from, FcPanel* panel) {
    counts.bounded[kind_of(count)]++;
    fc_gauss_panel_unjudged(scene, t, h, count, from, panel);
}

#define fc_radau_panel counted_radau_panel
#define fc_gauss_panel counted_gauss_panel
#define fc_gauss_panel_unjudged counted_gauss_panel_unjudged
#define fc_motion counted_motion
#define fc_panel_bound counted_panel_bound
#define fc_bounded_panel_nodes counted_bounded_panel_nodes
#define fc_bounded_panel counted_bounded_panel
#define fc_collocation_interval counted_collocation_interval
#define fc_collocation_constant counted_collocation_constant
#include "solver/bounded_panel.c"
#include "solver/collocation.c"

PanelCounts count_panels(const FcScene* scene, double tolerance, double duration, double delta_0) {
    const FcSolverOptions options = {.tolerance = tolerance};
    counts = (PanelCounts){.other_evaluations = 0.0};
    fc_collocation_interval(scene, &options, duration, delta_0, FC_MAP_THIS_START, &counts.other_evaluations);
    for (int kind = 0; kind < KINDS; kind++) {
        counts.other_evaluations -= (counts.judged[kind] + counts.bounded[kind]) * NODES[kind];
    }
    return counts;
}
