#include "solver/affine_map.h"

#include <assert.h>
#include <math.h>

FcMap fc_map_identity(void) { return (FcMap){0}; }

// relaxation is 1 - P: composing it, and not P, keeps its digits where hardly anything relaxes.
FcMap fc_map_compose(const FcMap* first, const FcMap* second) {
    const double kept = 1.0 - first->relaxation;
    return (FcMap){
        .relaxation = first->relaxation + kept * second->relaxation,
        .offset = first->offset - second->relaxation * first->offset + second->offset,
        .impulse_slope = first->impulse_slope + second->impulse_slope * kept,
        .impulse_offset =
            first->impulse_offset + second->impulse_slope * first->offset + second->impulse_offset,
        .work_slope = first->work_slope + second->work_slope * kept,
        .work_offset = first->work_offset + second->work_slope * first->offset + second->work_offset,
    };
}

// By repeated squaring: composing adds no error that grows with n, so nothing special happens at P near 1.
FcMap fc_map_power(const FcMap* one, double n) {
    assert(n >= 0.0 && n == floor(n));
    FcMap power = fc_map_identity();
    FcMap square = *one;
    while (n >= 1.0) {
        if (fmod(n, 2.0) == 1.0) {
            power = fc_map_compose(&power, &square);
        }
        square = fc_map_compose(&square, &square);
        n = floor(0.5 * n);
    }
    return power;
}

void fc_map_apply(const FcMap* map, FcStepResult* result) {
    const double delta_0 = result->delta;
    result->delta = (1.0 - map->relaxation) * delta_0 + map->offset;
    result->impulse += map->impulse_slope * delta_0 + map->impulse_offset;
    result->work += map->work_slope * delta_0 + map->work_offset;
}

// (z - 1 + e^-z) / z^2, which tends to 1/2.
static double phi_2(double z) {
    if (z > 0.5) {
        return (z + expm1(-z)) / (z * z);
    }
    double sum = 0.0;
    for (int k = 14; k >= 2; k--) { // Taylor series by Horner: 1/2! - z/3! + z^2/4! - ...
        sum = (1.0 - z * sum) / k;
    }
    return sum;
}

FcMap fc_map_of_constant_scene(double V, double sigma, double F_C, double h) {
    assert(sigma >= 0.0 && F_C > 0.0 && h >= 0.0);
    const double z = sigma * fabs(V) * h / F_C;
    FcMap map;
    map.relaxation = -expm1(-z);
    if (z > 1.0) {
        const double saturated = copysign(F_C, V);
        map.offset = saturated / sigma * map.relaxation;
        map.impulse_slope = F_C / fabs(V) * map.relaxation;
        map.impulse_offset = saturated * (h - map.impulse_slope / sigma);
    } else {
        const double phi_1 = z > 0.0 ? map.relaxation / z : 1.0;
        map.offset = V * h * phi_1;
        map.impulse_slope = sigma * h * phi_1;
        map.impulse_offset = sigma * V * h * h * phi_2(z);
    }
    map.work_slope = V * map.impulse_slope;
    map.work_offset = V * map.impulse_offset;
    return map;
}
