#include "solver/known_turns.h"

#include <math.h>

#include "model/constants.h"

// How D moves with d.
typedef struct {
    double mean;            // m, D at the mean of d
    double steepest, least; // 1, |d ln D / dd| a_d at the most and the least
    double bends;           // 1, its change
    bool rises;             // with d
} Swing;

static Swing swing(const FcScene* scene) {
    const FcDrive* drive = &scene->drive;
    const double a_d = drive->vibration.a_d;
    const double nearest = drive->d.value - a_d;
    const double at_nearest = fc_bound_log_slope(scene, nearest);
    return (Swing){
        .mean = fc_bound_at_separation(scene, drive->d.value),
        .steepest = fabs(at_nearest) * a_d,
        .least = fabs(fc_bound_log_slope(scene, drive->d.value + a_d)) * a_d,
        .bends = scene->at_E.model == FC_CONTACT_ASPERITIES ? 3.0 * (a_d / nearest) * (a_d / nearest) : 0.0,
        .rises = at_nearest > 0.0};
}

// The bound moves slowly: one turn a reversal of V.
static bool moves_slowly(const FcDrive* drive, const Swing* D) {
    const double A = D->steepest;
    const double V_1 = drive->vibration.V_1;
    const double fastest = drive->omega * D->mean * A * exp(A < 1.0 ? 0.5 * A * A : A - 0.5);
    const double cosine = (fabs(drive->V.value) + fastest) / V_1;
    return cosine < 1.0 &&
           drive->omega * D->mean * exp(A) * (A + D->bends) < V_1 * sqrt(1.0 - cosine * cosine);
}

// The bound moves fast: one turn at the least D.
static bool moves_fast(const FcDrive* drive, const Swing* D) {
    const double A = D->least;
    const double V_1 = drive->vibration.V_1;
    const double least = drive->omega * D->mean * exp(-D->steepest);
    const double sine = (fabs(drive->V.value) + V_1) / (least * A);
    return sine < 1.0 &&
           least * (A * sqrt(1.0 - sine * sine) - (D->steepest * D->steepest + D->bends) * sine * sine) > V_1;
}

// The one bound that a bristle can reach in [0, end]: 0, 1, or -1 where it may be both.
static int reachable_bound(const FcDrive* drive, const Swing* D, double end, double lowest, double highest) {
    const double reach = fabs(drive->V.value) * end + 2.0 * drive->vibration.V_1 / drive->omega;
    const double least = D->mean * exp(-D->steepest);
    return fmin(lowest, least) - reach > -least ? 0 : fmax(highest, -least) + reach < least ? 1 : -1;
}

static FcKnownTurns at_reversals(const FcDrive* drive, const FcBoundMotion* start) {
    const double now = drive->theta_0 - FC_TWO_PI * floor(drive->theta_0 / FC_TWO_PI);
    const double falls = acos(-drive->V.value / drive->vibration.V_1); // V falls through zero
    int half = now < FC_PI ? 0 : 1;
    if (!(fc_bound_approach(start, half) > 0.0)) {
        half++;
    }
    FcKnownTurns turns = {.known = true, .cycle = FC_TWO_PI / drive->omega};
    for (int n = 0; n < 2; n++, half++) {
        turns.which[n] = half % 2;
        turns.middle[n] = ((half + 0.5) * FC_PI - now) / drive->omega;
        turns.guess[n] =
            (half % 2 == 0 ? half * FC_PI + falls - now : (half + 1) * FC_PI - falls - now) / drive->omega;
    }
    return turns;
}

static FcKnownTurns at_least_bound(const FcDrive* drive, const Swing* D, const FcBoundMotion* start,
                                   int which) {
    const double phase = drive->theta_0 + drive->vibration.phase_d + (D->rises ? FC_PI : 0.0);
    const double now = remainder(phase, FC_TWO_PI); // 0: the least D
    const bool past = now > 0.5 * FC_PI || (now >= -0.5 * FC_PI && !(fc_bound_approach(start, which) > 0.0));
    FcKnownTurns turns = {.known = true, .cycle = 2.0 * FC_TWO_PI / drive->omega};
    for (int n = 0; n < 2; n++) {
        turns.which[n] = which;
        turns.middle[n] = ((past ? n + 1 : n) * FC_TWO_PI - now) / drive->omega;
        turns.guess[n] = turns.middle[n];
    }
    return turns;
}

FcKnownTurns fc_known_turns(const FcScene* scene, const FcBoundMotion* start, double end, double lowest,
                            double highest) {
    const FcDrive* drive = &scene->drive;
    const FcKnownTurns none = {.known = false};
    if (scene->floats || drive->E.rate != 0.0 || drive->V.rate != 0.0 || drive->d.rate != 0.0 ||
        drive->vibration.V_1 == 0.0) {
        return none;
    }
    const Swing D = swing(scene);
    if (moves_slowly(drive, &D)) {
        return at_reversals(drive, start);
    }
    const int which = moves_fast(drive, &D) ? reachable_bound(drive, &D, end, lowest, highest) : -1;
    return which < 0 ? none : at_least_bound(drive, &D, start, which);
}
