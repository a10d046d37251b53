// Watches a bounded bristle of Dahl or LuGre while it is crossed by panels, for the first meeting with its bound.
//
// A panel's nodes give delta and D there (march/meeting.h). The polynomial through n nodes has the order n, the panel itself 2 n.
// That is enough if the bound is crossed cleanly: an error of the time enters squared, and the panel that is cut there says
// on which side of the bound it ends. If the bound may only be grazed the error enters as it is: then a panel whose nodes do
// not tell is refused.
#ifndef FC_SOLVER_WATCH_H
#define FC_SOLVER_WATCH_H

#include "solver/interval.h"
#include "solver/march/meeting.h"
#include "solver/panels/panel.h"

typedef struct FcWatch {
    const FcScene* bound; // model/regime.h
    double reach;         // m, the path of the step at the most: energies are relative to it
    int left;             // the side of the bound that it has just left at the start, else 0
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

// What the panel that has been taken from there does. FC_MEETS: *panel becomes the one that is cut at the meeting, *h its length, and
// watch->met says which bound. FC_MEETS_NONE: *h is the panel's length, or less if the panel was cut where it only seemed to meet.
FcWatched fc_watch_panel(FcWatch* watch, const FcInterval* interval, const FcPanelAt* at,
                         const FcTrajectories* from, FcPanel* panel, double* h, double* evaluations);

#endif
