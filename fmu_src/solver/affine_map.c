#include "solver/affine_map.h"

#include <assert.h>
#include <math.h>

// relaxation is 1 - P. Composing it instead of P keeps its digits if hardly anything relaxes.
void fc_map_append(FcMap* map, const FcMap* next) {
    assert(fc_map_contracts(map) && fc_map_contracts(next));
    const double kept = 1.0 - map->relaxation;
    const double offset = map->offset;
    map->relaxation += kept * next->relaxation;
    map->offset = offset - next->relaxation * offset + next->offset;
    map->impulse_slope += next->impulse_slope * kept;
    map->impulse_offset += next->impulse_slope * offset + next->impulse_offset;
    map->work_slope += next->work_slope * kept;
    map->work_offset += next->work_slope * offset + next->work_offset;
    map->drag_slope += next->drag_slope * kept;
    map->drag_offset += next->drag_slope * offset + next->drag_offset;
    map->heat_offset += (next->heat_square * offset + next->heat_slope) * offset + next->heat_offset;
    map->heat_slope += (2.0 * next->heat_square * offset + next->heat_slope) * kept;
    map->heat_square += next->heat_square * kept * kept;
}

// By repeated squaring. Composing adds no error that grows with n, so P near 1 needs no special care.
FcMap fc_map_power(const FcMap* one, double n) {
    assert(n >= 0.0 && n == floor(n));
    FcMap power = {0}; // the identity
    FcMap square = *one;
    while (n >= 1.0) {
        if (fmod(n, 2.0) == 1.0) {
            fc_map_append(&power, &square);
        }
        const FcMap half = square;
        fc_map_append(&square, &half);
        n = floor(0.5 * n);
    }
    assert(fc_map_contracts(&power));
    return power;
}

FcMap fc_map_of_one_start(const FcStepResult* result) {
    return (FcMap){.relaxation = 1.0,
                   .offset = result->delta,
                   .impulse_offset = result->impulse,
                   .work_offset = result->work,
                   .drag_offset = result->drag,
                   .heat_offset = result->heat};
}

void fc_map_apply(const FcMap* map, FcStepResult* result) {
    assert(fc_map_contracts(map));
    const double delta_0 = result->delta;
    result->delta = delta_0 - map->relaxation * delta_0 + map->offset; // digits of a small change
    result->impulse += map->impulse_slope * delta_0 + map->impulse_offset;
    result->work += map->work_slope * delta_0 + map->work_offset;
    result->drag += map->drag_slope * delta_0 + map->drag_offset;
    result->heat += (map->heat_square * delta_0 + map->heat_slope) * delta_0 + map->heat_offset;
}

void fc_map_apply_across(const FcMap* map, FcStepResult* result) {
    FcStepResult part = {.delta = result->delta_y};
    fc_map_apply(map, &part);
    result->delta_y = part.delta;
    result->impulse_y += part.impulse;
    result->work += part.work;
    result->drag += part.drag;
    result->heat += part.heat;
}

// (1/2 - (z - 1 + e^-z) / z^2) / z, which tends to 1/6, for z in [0, 1]: 1/3! - z/4! + z^2/5! - ... TERMS are
// 1/3! to 1/17!, below which all is rounding.
static double phi_3(double z) {
    assert(!(z < 0.0 || z > 1.0));
    // clang-format off
    static const double TERMS[] = {
        1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720, 1.0 / 5040, 1.0 / 40320, 1.0 / 362880, 1.0 / 3628800,
        1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800.0, 1.0 / 87178291200.0, 1.0 / 1307674368e3,
        1.0 / 20922789888e3, 1.0 / 355687428096e3};
    // clang-format on
    double sum = 0.0;
    for (int k = (int)(sizeof TERMS / sizeof *TERMS) - 1; k >= 0; k--) {
        sum = TERMS[k] - z * sum;
    }
    return sum;
}

// A path with constant sigma and g on which V keeps its sign, with z = sigma |displacement| / g. The unit of
// force is the smaller of two: sigma times the displacement, the force at the end without relaxation, and g,
// the settled force.
typedef struct {
    double force;      // N, the unit
    double stiffness;  // N/m, the unit over the displacement
    double relaxation; // 1 - e^-z
    double offset;     // m, deflection at the end of a bristle that starts relaxed
    double end;        // its force then, in the unit
    double mean;       // the mean of its force along the path, in the unit
    double heat;       // its heat over the displacement, in the unit
} PathParts;

static PathParts parts_of_path(double sigma, double limit, double displacement) {
    const double z = sigma * fabs(displacement) / limit;
    PathParts parts = {.relaxation = -expm1(-z)};
    if (z > 1.0) {
        parts.force = copysign(limit, displacement);
        parts.stiffness = limit / fabs(displacement);
        parts.end = parts.relaxation;
        parts.offset = parts.force / sigma * parts.end;
        parts.mean = 1.0 - parts.relaxation / z;
        parts.heat = 1.0 - parts.relaxation * (1.0 + 0.5 * parts.relaxation) / z;
    } else {
        const double third = phi_3(z);
        const double second = 0.5 - z * third; // (z - relaxation) / z^2
        parts.force = sigma * displacement;
        parts.stiffness = sigma;
        parts.end = 1.0 - z * second;
        parts.offset = displacement * parts.end;
        parts.mean = second;
        parts.heat = z * (second - third - 0.5 * z * second * second);
    }
    assert(!(parts.relaxation < 0.0 || parts.relaxation > 1.0));
    assert(!(parts.end < 0.0 || parts.end > 1.0 || parts.mean < 0.0 || parts.mean > 1.0));
    return parts;
}

// With the settled deflection D = s g / sigma, s = sgn X: delta = D + (delta_0 - D) e^-x/|D| along the path x. Work and
// heat are the integrals of sigma delta and sigma delta |delta| / D over it, drag = V (delta_1 - delta_0).
FcMap fc_map_of_constant_scene(const FcCoefficients* at, double h) {
    assert(!(at->sigma < 0.0) && at->limit > 0.0 && h >= 0.0); // a sigma of NaN passes
    const double displacement = at->V * h;
    const PathParts parts = parts_of_path(at->sigma, at->limit, displacement);
    return (FcMap){
        .relaxation = parts.relaxation,
        .offset = parts.offset,
        .impulse_slope = parts.stiffness * h * parts.end,
        .impulse_offset = parts.force * h * parts.mean,
        .work_slope = parts.force * parts.end,
        .work_offset = parts.force * displacement * parts.mean,
        .drag_slope = -at->V * parts.relaxation,
        .drag_offset = at->V * parts.offset,
        // sigma (delta_0 e + D (1 - e))^2 / |D| integrated, e = e^-x/|D|
        .heat_square = 0.5 * at->sigma * parts.relaxation * (2.0 - parts.relaxation),
        .heat_slope = at->sigma * parts.offset * parts.relaxation,
        .heat_offset = parts.force * displacement * parts.heat,
    };
}
