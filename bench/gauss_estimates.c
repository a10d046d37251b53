// What a Gauss panel's estimates are about: prints the table RULE of fmu_src/solver/gauss_pieces.c, but for what other random
// numbers and a busy machine change.
//
//     gauss_estimates          a row for each number of nodes, and the scatter around it
//
// Random parts of random stretches between two reversals, for both models of the contact and both limits, with bristles
// that have settled, are still behind, or start anywhere. The decades of the tolerance from which on a panel that lasts for a
// whole stretch is accurate (solver/judge.h) are fit by least squares:
//
//     one + phi sqrt(phi) + mu sqrt(mu) + z sqrt(z)
//
// The time is that of one panel in a scene of middling stiffness, over that of one with 4 nodes.
#include <math.h>
#include <stdio.h>

#include "job.h"
#include "random.h"
#include "solver/gauss_panel.h"
#include "solver/judge.h"
#include "table_1.h"

static const double OMEGA = 6.283185307179586 * 20e3;
static const double PERIOD = 5e-5; // s
static const double F_C = 55.0;    // N
static const double V_1 = 1.44;    // m/s

enum { RULES = 4, TERMS = 4, PANELS = 60000 };
static const int NODES[RULES] = {4, 6, 8, 12};

typedef struct {
    FcContactParameters contact;
    FcFriction friction;
    FcScene scene;
} Slider;

static void make(Slider* slider, FcContactModel model, FcFrictionLimit limit, double z, double V, double a_d,
                 double phase_d) {
    slider->contact = table_1(model, FC_CONTACT_SEPARATION);
    slider->contact.stiffnessScale = z * F_C * 0.5 * OMEGA / V_1 / 5.743065402e12;
    slider->friction =
        (FcFriction){.model = FC_DAHL, .limit = limit, .mu = 0.176, .staticRatio = 1.0, .V_S = 1e-3};
    const FcContactAtModulus at_E = fc_contact_at_modulus(&slider->contact, 58e9);
    const FcVibration vibration = {.f = 1.0 / PERIOD, .V_1 = V_1, .a_d = a_d, .phase_d = phase_d};
    const FcDrive drive =
        fc_drive_make((FcLinearInput){V, 0.0}, (FcLinearInput){14e-6, 0.0}, (FcLinearInput){58e9, 0.0},
                      (FcLinearInput){0.0, 0.0}, vibration, 0.0, 0.0);
    slider->scene = fc_scene_make(&slider->contact, &at_E, &slider->friction, F_C, &drive);
}

typedef struct {
    double start, h; // s
    double delta;    // m
} Part;

// false where V does not reverse twice
static bool draw(Slider* slider, Part* part) {
    const FcContactModel model = random_01() < 0.6 ? FC_CONTACT_ASPERITIES : FC_CONTACT_MINDLIN;
    const FcFrictionLimit limit = random_01() < 0.8 ? FC_LIMIT_CONSTANT : FC_LIMIT_LOAD;
    const double a_d = random_01() < 0.2 ? 0.0 : fmin(1.4e-6, random_log(0.22e-6, 1.64e-6));
    const double V = random_01() < 0.5 ? 5e-3 : V_1 * (2.0 * random_01() - 1.0);
    make(slider, model, limit, random_log(0.3, 40.0), V, a_d, 6.28 * random_01());
    const FcDrive* drive = &slider->scene.drive;
    const double start = fc_drive_next_event(drive, 0.0, 2.0 * PERIOD).time;
    const double end = fc_drive_next_event(drive, start, 2.0 * PERIOD).time;
    if (!(end < 2.0 * PERIOD)) {
        return false;
    }
    const int pieces = random_01() < 0.3 ? 3 : 1 << (int)(4.0 * random_01());
    const int piece = (int)(pieces * random_01());
    part->h = (end - start) / pieces;
    part->start = start + piece * part->h;
    const FcCoefficients here = fc_scene_coefficients(&slider->scene, part->start);
    const double sign = fc_sign(fc_drive_displacement(drive, part->start, part->start + part->h));
    const double which = random_01();
    const double lag = piece == 0 || which < 0.4 ? -1.0 : which < 0.7 ? 1.0 : 2.0 * random_01() - 1.0;
    part->delta = sign * lag * here.limit / here.sigma;
    return true;
}

// Normal equations of the least squares, solved by elimination.
typedef struct {
    double row[TERMS][TERMS + 1];
} Fit;

static void add(Fit* fit, const double* term, double value) {
    for (int i = 0; i < TERMS; i++) {
        for (int j = 0; j < TERMS; j++) {
            fit->row[i][j] += term[i] * term[j];
        }
        fit->row[i][TERMS] += term[i] * value;
    }
}

static void solve(Fit* fit, double* found) {
    for (int k = 0; k < TERMS; k++) {
        for (int i = 0; i < TERMS; i++) {
            const double factor = i == k ? 0.0 : fit->row[i][k] / fit->row[k][k];
            for (int j = k; j <= TERMS; j++) {
                fit->row[i][j] -= factor * fit->row[k][j];
            }
        }
    }
    for (int k = 0; k < TERMS; k++) {
        found[k] = fit->row[k][TERMS] / fit->row[k][k];
    }
}

typedef struct {
    double term[TERMS];
    double decades;
} Sample;
static Sample samples[RULES][PANELS];
static int counts[RULES];

static void measure(const Slider* slider, const Part* part) {
    const FcScene* scene = &slider->scene;
    const FcTrajectories from = {.delta_0 = part->delta,
                                 .speed = fc_drive_largest_speed(&scene->drive, PERIOD)};
    const double limit = fc_scene_smallest_limit(scene, PERIOD);
    const double mu = part->h * scene->at_E.decay * scene->drive.vibration.a_d * OMEGA;
    for (int i = 0; i < RULES; i++) {
        FcPanel panel;
        fc_gauss_panel(scene, part->start, part->h, NODES[i], &from, &panel);
        const FcExcess over = fc_gauss_panel_excess(&panel, 1.0, false, 0.0, limit);
        const double error = fmax(over.mean, over.end);
        if (fc_gauss_panel_is_resolved(&panel, NODES[i]) && error > 3e-13 && error < 1.0) {
            samples[i][counts[i]++] =
                (Sample){{1.0, sqrt(0.5 * OMEGA * part->h), sqrt(mu), sqrt(panel.z)}, log10(error)};
        }
    }
}

static double off(const Sample* sample, const double* found) {
    double sum = -sample->decades;
    for (int k = 0; k < TERMS; k++) {
        sum += found[k] * sample->term[k];
    }
    return sum;
}

static double time_of_panel(int nodes) {
    enum { TIMES = 200000, TURNS = 5 };
    Slider slider;
    make(&slider, FC_CONTACT_ASPERITIES, FC_LIMIT_CONSTANT, 7.5, 5e-3, 1.1e-6, 0.7);
    double least = INFINITY;
    volatile double used = 0.0;
    for (int turn = 0; turn < TURNS; turn++) {
        const double start = cpu_seconds();
        for (int i = 0; i < TIMES; i++) {
            const FcTrajectories from = {.delta_0 = 1e-6 + 1e-12 * i, .speed = V_1};
            FcPanel panel;
            fc_gauss_panel(&slider.scene, 1e-6, 5e-6, nodes, &from, &panel);
            used += panel.map.offset;
        }
        least = fmin(least, cpu_seconds() - start);
    }
    return least;
}

int main(void) {
    for (int k = 0; k < PANELS; k++) {
        Slider slider;
        Part part;
        if (draw(&slider, &part)) {
            measure(&slider, &part);
        }
    }
    const double of_least = time_of_panel(NODES[0]);
    for (int i = 0; i < RULES; i++) {
        Fit fit = {{{0.0}}};
        double found[TERMS];
        for (int k = 0; k < counts[i]; k++) {
            add(&fit, samples[i][k].term, samples[i][k].decades);
        }
        solve(&fit, found);
        double square = 0.0;
        for (int k = 0; k < counts[i]; k++) {
            const double is_off = off(&samples[i][k], found);
            square += is_off * is_off;
        }
        printf("    {%d, %.2f, %.2f, %.2f, %.2f, %.2f}, // of %d panels, off by %.1f decades (r.m.s.)\n",
               NODES[i], time_of_panel(NODES[i]) / of_least, found[0], found[1], found[2], found[3],
               counts[i], sqrt(square / counts[i]));
    }
    return 0;
}
