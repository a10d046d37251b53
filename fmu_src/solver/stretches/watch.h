// Watches a bounded bristle of Dahl or LuGre, panel by panel, for the first meeting with its bound.
//
// A panel's nodes give delta and D there (march/meeting.h). The polynomial through n nodes has the order n,
// the panel itself 2 n. That suffices if the bristle crosses its bound: an error of the time enters squared,
// and the panel that is cut there shows on which side of the bound it ends. If the bristle may graze its
// bound, the error enters linearly. Then a panel whose nodes are not accurate enough is refused.
#ifndef FC_SOLVER_WATCH_H
#define FC_SOLVER_WATCH_H

#include "solver/interval.h"
#include "solver/march/meeting.h"
#include "solver/panels/panel.h"

typedef struct FcWatch {
    const FcScene* bound; // model/regime.h
    double reach;         // m, the largest path of the step: the scale of energies
    int left;             // the side of the bound that the bristle has just left at the start, else 0
    FcMeeting met;        // side 0 until then
    FcPanelNodes nodes;   // of the last panel
} FcWatch;

// The kind of a panel: a Gauss rule of n nodes, or Radau.
typedef struct {
    const FcScene* scene;
    double t, h; // s
    int nodes;   // of a Gauss panel, 0 for Radau
    double sign; // of V
} FcPanelAt;

typedef enum { FC_MEETS_NONE, FC_MEETS, FC_UNRESOLVED } FcWatched;

// Watches the panel taken from there. FC_MEETS: *panel becomes the panel that is cut at the meeting, *h its
// length, and watch->met the meeting. FC_MEETS_NONE: *h is the panel's length, or less if the panel was cut
// at a point at which the bristle turned back. FC_UNRESOLVED: refused.
FcWatched fc_watch_panel(FcWatch* watch, const FcInterval* interval, const FcPanelAt* at,
                         const FcTrajectories* from, FcPanel* panel, double* h, double* evaluations);

#endif
