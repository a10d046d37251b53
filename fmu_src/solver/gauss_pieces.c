#include "solver/gauss_pieces.h"

#include <math.h>

#include "model/constants.h"
#include "solver/gauss_rule.h"

// Decades of the tolerance from which on a panel is accurate that lasts for a whole stretch: about one + phi sqrt(phi) +
// mu sqrt(mu) + z sqrt(z), as bench/gauss_estimates prints it but for hundredths, with a scatter of half a decade (4 nodes) to
// one and a half (12). time: of a panel, of 4 nodes 1; the program's own differ by up to a seventh with the build.
enum { RULES = 4 };
static const struct {
    int nodes;
    double time;
    double one, phi, mu, z;
} RULE[RULES] = {
    {4, 1.00, -4.44, 2.14, 0.42, 0.65},
    {6, 1.25, -10.16, 5.06, 0.99, 1.91},
    {8, 1.40, -15.04, 6.49, 1.65, 3.05},
    {12, 1.93, -19.12, 6.23, 2.21, 3.30},
};
// n nodes resolve e^z where z is less than half of n.
static const double RESOLVED = 0.47;
// Time of the Radau panels between two reversals half a period apart, up to so many decades, and for each more; of one panel.
static const double RADAU = 7.0;
static const double FEW_DECADES = 3.0;
static const double RADAU_FOR_EACH = 2.3;
static const double HALF_PERIOD = 0.5 * FC_PI;
static const double RADAU_PANEL = 2.3;

enum { MOST_PIECES = 12 };
// The mean sees a piece by its share of the stretch: decades that each of so many is spared.
static const double SPARED[MOST_PIECES + 1] = {0, 0, .3, .48, .6, .7, .78, .85, .9, .95, 1, 1.04, 1.08};

// The first rule whose estimate will be small enough; RULES if there is none.
static int rule_for(double phi, double mu, double z, double decades) {
    const double root_phi = sqrt(phi);
    const double root_mu = sqrt(mu);
    const double root_z = sqrt(z);
    for (int i = 0; i < RULES; i++) {
        const double of_estimate =
            RULE[i].one + RULE[i].phi * root_phi + RULE[i].mu * root_mu + RULE[i].z * root_z;
        if (of_estimate < -decades && z < RESOLVED * RULE[i].nodes) {
            return i;
        }
    }
    return RULES;
}

static double time_of_radau_panels(double phi, double mu, double decades) {
    const double of_half_period = RADAU + RADAU_FOR_EACH * fc_most(0.0, decades - FEW_DECADES);
    return fc_most(RADAU_PANEL, of_half_period * fc_least(1.0, fc_most(phi, mu) / HALF_PERIOD));
}

FcGaussPieces fc_gauss_pieces(double phi, double mu, const FcRelaxation* z, double decades) {
    double least = time_of_radau_panels(phi, mu, decades);
    FcGaussPieces cheapest = {0, FC_GAUSS_MOST_NODES};
    for (int n = 1; n <= MOST_PIECES && n * RULE[0].time < least; n++) {
        const double of_piece = n == 1 ? z->whole : n == 2 ? z->half : z->fastest / n;
        const int i = rule_for(phi / n, mu / n, of_piece, decades - SPARED[n]);
        if (i < RULES && n * RULE[i].time < least) {
            least = n * RULE[i].time;
            cheapest = (FcGaussPieces){n, RULE[i].nodes};
        }
    }
    return cheapest;
}

// Number of nodes for a panel over which about this much changes.
static double nodes_for(double decades, double change) { return 2.0 + 0.6 * decades + 0.5 * change; }

FcGaussPieces fc_gauss_pieces_in_bell(double change, double decades) {
    const double room = fc_most(2.0, FC_GAUSS_MOST_NODES - nodes_for(decades, 0.0));
    const double count = fc_most(1.0, ceil(0.5 * change / room));
    return (FcGaussPieces){(int)fc_least(count, 1e9), fc_gauss_count(nodes_for(decades, change / count))};
}
