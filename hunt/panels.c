// Lists the panels of the steps of a sequence, as the march takes them: for a look at a miss, and for the picture of
// docs/solver.md.
//
//     cmake --build --preset default --target panels
//     build/hunt/panels "tolerance=1e-6 V=0.5 V_1=1.44 law=LuGre staticRatio=1.3"
//
// A line a panel: the times and the places in u of its ends, L of t = t_c + L sinh u (inf for t = u), z, the estimated
// errors of its end and of its mean over the allowed force, the error ratio by which the controller judges both (at most 1 of
// an accepted panel), how often it was made, and what it is:
//
//     relaxes, sticks, slips, coulomb    the motion
//     known                              a closed form, which has neither z nor errors
//
// The linker puts the functions __wrap_... between the march and its own (CMakeLists.txt).
#include <math.h>
#include <stdio.h>

#include "contact/friction_contact.h"
#include "sequence.h"
#include "solver/integrate/integrator.h"
#include "solver/integrate/march.h"
#include "trial.h"

static bool lists = false; // while a step is taken
static double evaluations; // up to the last panel of the step

static const char* const KINDS[] = {
    [FC_RELAXES] = "relaxes", [FC_STICKS] = "sticks", [FC_SLIPS] = "slips", [FC_NO_BRISTLE] = "coulomb"};

// The place from which a panel is taken, and its kind, which an event at its end may change.
typedef struct {
    double t, u;
    const char* kind;
} From;

static From from_of(const FcIntegrator* integrator, const char* kind) {
    return (From){integrator->at.t, integrator->at.u, kind};
}

static void print_panel(const FcIntegrator* integrator, From from, const FcPanel* panel) {
    const double allowed = fc_allowed_force(integrator->interval);
    const double made = (integrator->evaluations - evaluations) / FC_STAGES;
    evaluations = integrator->evaluations;
    if (lists) {
        printf("%.9e %.9e %13.6e %13.6e %10.3e %9.2e %8.1e %8.1e %8.1e %4.0f %s\n", from.t, integrator->at.t,
               from.u, integrator->at.u, integrator->part.in.length, panel->z, panel->end_error / allowed,
               panel->mean_error / allowed, isnan(panel->z) ? NAN : integrator->error_ratio, made, from.kind);
    }
}

// ---- between the march and its functions ----

#define WRAP(type, name, ...)                                                                                \
    type __real_##name(__VA_ARGS__);                                                                         \
    type __wrap_##name(__VA_ARGS__);                                                                         \
    type __wrap_##name(__VA_ARGS__)

WRAP(void, fc_accept_panel, FcIntegrator* integrator, const FcNodes* nodes, FcPanel* panel, double h) {
    const From from = from_of(integrator, KINDS[fc_kind(integrator)]);
    __real_fc_accept_panel(integrator, nodes, panel, h);
    print_panel(integrator, from, panel);
}

WRAP(void, fc_accept_closed_form, FcIntegrator* integrator, const FcMap* map, double t) {
    const From from = from_of(integrator, "known");
    const FcPanel none = {.z = NAN, .end_error = NAN, .mean_error = NAN};
    __real_fc_accept_closed_form(integrator, map, t);
    print_panel(integrator, from, &none);
}

WRAP(bool, fc_friction_contact_advance, FcFrictionContact* contact, double t, double h, FcMessage* message) {
    lists = true;
    evaluations = 0.0;
    printf("step from %.17g s of %.17g s\n%15s %15s %13s %13s %10s %9s %8s %8s %8s %4s kind\n", t, h, "t",
           "t_end", "u", "u_end", "L", "z", "of_end", "of_mean", "ratio", "made");
    const bool is_taken = __real_fc_friction_contact_advance(contact, t, h, message);
    lists = false;
    return is_taken;
}

int main(int argc, char** argv) {
    if (argc != 2) {
        fprintf(stderr,
                "panels \"NAME=VALUE ..\": lists the panels of a sequence, as hunt --replay reads it\n");
        return 2;
    }
    static Trial trial;
    const Sequence sequence = sequence_read(argv[1]);
    trial_run(&trial, &sequence, false);
    if (trial.refused) {
        printf("refused: %s\n", trial.message.text);
    }
    return trial.refused;
}
