#include "coulomb.h"

#include "periods.h"

double coulomb_force(double V, double F_C) { return V > 0.0 ? F_C : V < 0.0 ? -F_C : 0.0; }

static DahlMap coulomb_interval(const DahlProblem* problem, const SolverOptions* options, double duration,
                                double delta_0, MapScope scope, double* evaluations) {
    (void)scope;
    (void)options;
    (void)delta_0;
    DahlMap map = dahl_identity();
    for (double t = 0.0; t < duration;) {
        const double next = drive_next_event(&problem->drive, t, duration).time;
        const double force = coulomb_force(drive_V(&problem->drive, 0.5 * (t + next)), problem->F_C);
        map.impulse_offset += force * (next - t);
        map.work_offset += force * drive_displacement(&problem->drive, t, next);
        *evaluations += 1.0;
        t = next;
    }
    return map;
}

int coulomb_step(const DahlProblem* problem, const SolverOptions* options, double h, double delta_0,
                 StepResult* result, Message* message) {
    return periods_step(coulomb_interval, problem, options, h, delta_0, result, message);
}
