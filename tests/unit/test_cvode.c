// CVODE: no history outlives a step, and what it says that it evaluated.
#include "solver/methods.h"

#include "check.h"
#include "table_1.h"

enum { SKIPPED = 77 };

int main(void) {
    FcMessage message;
    FcCvode* solver = fc_cvode_new(&message);
    if (!solver) {
        return SKIPPED; // built without it
    }
    FcContactParameters contact = table_1(FC_CONTACT_ASPERITIES, FC_CONTACT_SEPARATION);
    contact.stiffnessScale = 1e-6;
    const FcFriction friction = {
        .model = FC_DAHL, .limit = FC_LIMIT_CONSTANT, .mu = 0.18, .staticRatio = 1.0, .V_S = 0.01};
    const FcContactAtModulus at_E = fc_contact_at_modulus(&contact, 58e9);
    const FcVibration vibration = {.f = 20e3, .V_1 = 1.44, .a_d = 1.1e-6, .phase_d = 0.7};
    const FcDrive drive =
        fc_drive_make((FcLinearInput){0.5, 0.0}, (FcLinearInput){14e-6, 0.0}, (FcLinearInput){58e9, 0.0},
                      (FcLinearInput){100.0, 0.0}, vibration, 0.0, 0.0);
    const FcScene scene = fc_scene_make(&contact, &at_E, &friction, 55.0, &drive);
    const FcSolverOptions options = {.tolerance = 1e-6, .force = 55.0};

    FcStepResult first = {.delta = 1e-6}, other = {.delta = -3e-6}, again = first, none = first;
    CHECK(fc_cvode_step(solver, &scene, &options, 1.3e-4, &first, &message));
    CHECK(fc_cvode_step(solver, &scene, &options, 2e-5, &other, &message));
    CHECK(fc_cvode_step(solver, &scene, &options, 1.3e-4, &again, &message));
    CHECK(first.delta == again.delta && first.impulse == again.impulse && first.work == again.work);
    CHECK(first.evaluations == again.evaluations && other.evaluations < first.evaluations);

    CHECK(fc_cvode_step(solver, &scene, &options, 0.0, &none, &message));
    CHECK(none.delta == 1e-6 && none.impulse == 0.0 && none.work == 0.0 && none.evaluations == 0.0);
    fc_cvode_free(solver);
    return check_result();
}
