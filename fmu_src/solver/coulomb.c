#include "solver/coulomb.h"

double fc_coulomb_force(double V, double F_C) { return V > 0.0 ? F_C : V < 0.0 ? -F_C : 0.0; }

FcMap fc_coulomb_interval(const FcScene* scene, const FcSolverOptions* options, double duration,
                          double delta_0, FcMapScope scope, double* evaluations) {
    (void)scope;
    (void)options;
    (void)delta_0;
    FcMap map = fc_map_identity();
    for (double t = 0.0; t < duration;) {
        const double next = fc_drive_next_event(&scene->drive, t, duration).time;
        const double force = fc_coulomb_force(fc_drive_V(&scene->drive, 0.5 * (t + next)), scene->F_C);
        map.impulse_offset += force * (next - t);
        map.work_offset += force * fc_drive_displacement(&scene->drive, t, next);
        *evaluations += 1.0;
        t = next;
    }
    return map;
}
