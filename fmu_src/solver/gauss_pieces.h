// Into how many Gauss panels of how many nodes a part of a stretch is cut, so that hardly one is refused.
//
// Only the price depends on it: whether a panel is accurate is judged afterwards, by its own estimate (solver/panel.h).
#ifndef FC_SOLVER_GAUSS_PIECES_H
#define FC_SOLVER_GAUSS_PIECES_H

typedef struct {
    int count; // of equal lengths; 0 where Radau panels are about cheaper
    int nodes; // 4, 6, 8 or 12
} FcGaussPieces;

// What relaxes, about: in all, in the half where more does, and if it went on as fast as it ever does.
typedef struct {
    double whole, half, fastest;
} FcRelaxation;

// phi: half the angle by which the vibration turns; mu: half of what ln(sigma) may move by; decades of accuracy asked for.
FcGaussPieces fc_gauss_pieces(double phi, double mu, const FcRelaxation* z, double decades);

// In a bell of the Stribeck curve, through which about this much changes.
FcGaussPieces fc_gauss_pieces_in_bell(double change, double decades);

#endif
