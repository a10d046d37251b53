#include "solver/coulomb.h"

#include <math.h>

#include "solver/gauss_legendre.h"

// Integrals of g and of g V over a time in which V does not reverse.
typedef struct {
    double limit; // N s
    double work;  // J
} LimitIntegrals;

static LimitIntegrals integrals_over_panel(const FcScene* scene, double start, double end) {
    const FcQuadrature* rule = &FC_GAUSS_16;
    const double half = 0.5 * (end - start);
    const double middle = 0.5 * (start + end);
    LimitIntegrals sum = {0.0, 0.0};
    for (int i = 0; i < rule->half_count; i++) {
        const FcCoefficients before = fc_scene_coefficients(scene, middle - half * rule->node[i]);
        const FcCoefficients after = fc_scene_coefficients(scene, middle + half * rule->node[i]);
        sum.limit += half * rule->weight[i] * (before.limit + after.limit);
        sum.work += half * rule->weight[i] * (before.limit * before.V + after.limit * after.V);
    }
    return sum;
}

// Rate [1/s] of the phase and ln(g), E and load held.
static double rate(const FcScene* scene) {
    const FcDrive* drive = &scene->drive;
    return drive->omega + scene->at_E.decay * (fabs(drive->d.rate) + drive->vibration.a_d * drive->omega);
}

// Time [s] from t on in which the phase and ln(g) move by about 2, over which the rule above is exact to rounding.
static double panel_length(const FcScene* scene, double t) {
    const FcDrive* drive = &scene->drive;
    // twice: they rise over the panel
    const double by_E = 2.0 * fc_drive_E_growth(drive, t);
    const double by_load = 2.0 * fc_drive_load_growth(drive, t);
    return 2.0 / (rate(scene) + by_E + by_load);
}

static LimitIntegrals integrals_of_limit(const FcScene* scene, double start, double end,
                                         double* evaluations) {
    if (scene->friction->limit == FC_LIMIT_CONSTANT) {
        *evaluations += 1.0;
        return (LimitIntegrals){scene->F_C * (end - start),
                                scene->F_C * fc_drive_displacement(&scene->drive, start, end)};
    }
    LimitIntegrals sum = {0.0, 0.0};
    const double least = FC_GAUSS_16.half_count * (end - start) * rate(scene); // evaluations, at 16 a panel
    if (least > FC_MOST_EVALUATIONS) {
        *evaluations += least; // is refused: not begun
        return sum;
    }
    for (double t = start; t < end && *evaluations <= FC_MOST_EVALUATIONS;) {
        const double length = panel_length(scene, t);
        const double next = t + length < end && t + length > t ? t + length : end;
        const LimitIntegrals panel = integrals_over_panel(scene, t, next);
        sum.limit += panel.limit;
        sum.work += panel.work;
        *evaluations += 2.0 * FC_GAUSS_16.half_count;
        t = next;
    }
    return sum;
}

FcMap fc_coulomb_interval(const FcScene* scene, const FcSolverOptions* options, double duration,
                          double delta_0, FcMapScope scope, double* evaluations) {
    (void)scope;
    (void)options;
    (void)delta_0;
    FcMap map = fc_map_identity();
    for (double t = 0.0; t < duration && *evaluations <= FC_MOST_EVALUATIONS;) {
        const double next = fc_drive_next_event(&scene->drive, t, duration).time;
        const double V = fc_drive_V(&scene->drive, 0.5 * (t + next));
        const double side = V > 0.0 ? 1.0 : V < 0.0 ? -1.0 : 0.0;
        const LimitIntegrals integrals = integrals_of_limit(scene, t, next, evaluations);
        map.impulse_offset += side * integrals.limit;
        map.work_offset += side * integrals.work;
        t = next;
    }
    map.heat_offset = map.work_offset;
    return map;
}
