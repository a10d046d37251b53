// The Stribeck peaks: beyond them the curve is not seen, and they are not wider than that asks for. Against
// V at dense samples, in contacts so stiff that the force follows its limit.
#include "solver/stribeck_peak.h"

#include "check.h"
#include "random.h"
#include "table_1.h"

static const double F = 20e3;        // Hz
static const double NOT_SEEN = 0.01; // of the tolerance
static const double GROWTH = 1.5;    // of a width that was estimated too short
enum { SCENES = 4000, SAMPLES = 300 };

static FcContactParameters contact;
static FcFriction friction;

static FcScene random_scene(double h) {
    contact = table_1(FC_CONTACT_CONSTANT, FC_CONTACT_SEPARATION);
    contact.sigma = 1e16;
    friction = (FcFriction){.model = FC_LUGRE,
                            .limit = FC_LIMIT_CONSTANT,
                            .mu = 0.2,
                            .staticRatio = 1.0 + random_log(0.05, 2.0),
                            .V_S = random_log(1e-3, 1.0)};
    const double V_1 = random_01() < 0.2 ? 0.0 : random_log(0.01, 3.0);
    const double kind = random_01();
    const double V =
        (kind < 0.5 ? V_1 * 3.0 * random_01() : random_log(1e-3, 3.0)) * (random_01() < 0.5 ? 1 : -1);
    const double V_rate = random_01() < 0.4 ? 0.0 : (random_01() - 0.5) * 4.0 * (fabs(V) + V_1) / h;
    const FcContactAtModulus at_E = fc_contact_at_modulus(&contact, 58e9);
    const FcDrive drive =
        fc_drive_make((FcLinearInput){V, V_rate}, (FcLinearInput){14e-6, 0.0}, (FcLinearInput){58e9, 0.0},
                      (FcLinearInput){1.0, 0.0}, (FcVibration){.f = F, .V_1 = V_1}, random_01() / F, 0.0);
    return fc_scene_make(&contact, &at_E, &friction, 55.0, &drive);
}

// What the curve adds to the limit, over it.
static double curve(const FcScene* scene, double t) {
    const double ratio = fc_drive_V(&scene->drive, t) / friction.V_S;
    return (friction.staticRatio - 1.0) * exp(-ratio * ratio);
}

// The least |V| of the linear part of V in the stretch: dips that are no events lie above half of it and V_1.
static double least_dip(const FcDrive* drive, double start, double end) {
    const double V_start = drive->V.value + drive->V.rate * start;
    const double V_end = drive->V.value + drive->V.rate * end;
    return 0.5 * (fmin(fabs(V_start), fabs(V_end)) + drive->vibration.V_1);
}

typedef struct {
    int peaks, whole, none;
} Seen;

static void check_stretch(const FcInterval* interval, double start, double end, Seen* seen) {
    const FcScene* scene = interval->scene;
    const FcPeakEdge a = fc_peak_edge(scene, start);
    const FcPeakEdge b = fc_peak_edge(scene, end);
    const double displacement = fc_drive_displacement(&scene->drive, start, end);
    const FcPeaks peaks = fc_peaks(interval, &a, &b, 55.0 / contact.sigma, displacement, 1.0);
    const double seen_from = NOT_SEEN * interval->tolerance;
    const double least =
        sqrt(log((friction.staticRatio - 1.0) / seen_from)); // reach for a force of the limit
    const double most = sqrt(log((friction.staticRatio - 1.0) * pow(friction.staticRatio, 2.0) / seen_from));
    CHECK(peaks.reach >= least * (1.0 - 1e-12) && peaks.reach <= most * (1.0 + 1e-12));
    CHECK_NEAR(peaks.digits, peaks.reach * peaks.reach / log(10.0) + log10(10.0 * NOT_SEEN), 1e-4);
    CHECK(peaks.after >= start && peaks.before <= end);
    if (peaks.after == end) {
        CHECK(peaks.before == end);
        for (int i = 0; i <= 2; i++) {
            CHECK(fc_in_peak(&peaks, start + 0.49 * i * (end - start)));
        }
    } else {
        CHECK(peaks.after < peaks.before);
        CHECK(!fc_in_peak(&peaks, peaks.after) && fc_in_peak(&peaks, peaks.before) == true);
    }
    double unseen = 0.0; // the largest outside the peaks
    double lowest = INFINITY;
    for (int i = 1; i < SAMPLES; i++) {
        const double t = peaks.after + (peaks.before - peaks.after) * i / SAMPLES;
        unseen = fmax(unseen, curve(scene, t));
        lowest = fmin(lowest, fabs(fc_drive_V(&scene->drive, start + (end - start) * i / SAMPLES)));
    }
    CHECK(peaks.after == end || unseen <= seen_from * (1.0 + 1e-9));
    // not wider than by one growth
    const double speed = peaks.reach * friction.V_S;
    const bool may_dip = fabs(scene->drive.V.rate) < scene->drive.vibration.V_1 * scene->drive.omega &&
                         speed > least_dip(&scene->drive, start, end);
    if (peaks.after == end) {
        CHECK(may_dip || fmin(fabs(a.at.V), fabs(b.at.V)) < speed); // two peaks that meet, or one
        seen->whole++;
        return;
    }
    CHECK(!may_dip);
    if (peaks.after > start) {
        CHECK(fabs(a.at.V) < speed);
        CHECK(fabs(fc_drive_V(&scene->drive, start + (peaks.after - start) / GROWTH * 0.999)) < speed ||
              peaks.after - start <= 1.001 * fc_velocity_time_of_change(&a.at, speed - fabs(a.at.V)));
    }
    if (peaks.before < end) {
        CHECK(fabs(b.at.V) < speed);
        CHECK(fabs(fc_drive_V(&scene->drive, end - (end - peaks.before) / GROWTH * 0.999)) < speed ||
              end - peaks.before <= 1.001 * fc_velocity_time_of_change(&b.at, speed - fabs(b.at.V)));
    }
    *(peaks.after > start || peaks.before < end ? &seen->peaks : &seen->none) += 1;
}

int main(void) {
    Seen seen = {0};
    for (int i = 0; i < SCENES; i++) {
        const double h = random_log(0.05, 2.0) / F;
        const FcScene scene = random_scene(h);
        const FcSolverOptions options = {.tolerance = random_log(1e-12, 1e-3), .force = 55.0};
        const FcInterval interval = fc_interval_make(&scene, &scene, h, &options);
        CHECK_NEAR(interval.saturation, 55.0 / contact.sigma * friction.staticRatio, 1e-15);
        double start = 0.0;
        while (start < h) {
            const FcDriveEvent next = fc_drive_next_event(&scene.drive, start, h);
            check_stretch(&interval, start, next.time, &seen);
            start = next.time;
        }
    }
    CHECK(seen.peaks > 1000 && seen.whole > 1000 && seen.none > 300);
    return check_result();
}
