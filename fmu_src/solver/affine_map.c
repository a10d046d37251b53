#include "solver/affine_map.h"

#include <assert.h>
#include <math.h>

FcMap fc_map_identity(void) { return (FcMap){0}; }

// relaxation is 1 - P: composing it, and not P, keeps its digits where hardly anything relaxes.
FcMap fc_map_compose(const FcMap* first, const FcMap* second) {
    const double kept = 1.0 - first->relaxation;
    const double offset = first->offset;
    return (FcMap){
        .relaxation = first->relaxation + kept * second->relaxation,
        .offset = offset - second->relaxation * offset + second->offset,
        .impulse_slope = first->impulse_slope + second->impulse_slope * kept,
        .impulse_offset = first->impulse_offset + second->impulse_slope * offset + second->impulse_offset,
        .work_slope = first->work_slope + second->work_slope * kept,
        .work_offset = first->work_offset + second->work_slope * offset + second->work_offset,
        .drag_slope = first->drag_slope + second->drag_slope * kept,
        .drag_offset = first->drag_offset + second->drag_slope * offset + second->drag_offset,
        .heat_square = first->heat_square + second->heat_square * kept * kept,
        .heat_slope = first->heat_slope + (2.0 * second->heat_square * offset + second->heat_slope) * kept,
        .heat_offset = first->heat_offset + (second->heat_square * offset + second->heat_slope) * offset +
                       second->heat_offset,
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
    result->drag += map->drag_slope * delta_0 + map->drag_offset;
    result->heat += (map->heat_square * delta_0 + map->heat_slope) * delta_0 + map->heat_offset;
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

// Integral of (1 - e^-x)^2 over [0, z], over z^3, for z up to 1: the sum over k >= 3 of
// (-1)^(k+1) (2^(k-1) - 2) z^(k-3) / k!.
static double phi_heat(double z) {
    double sum = 0.0;
    double power = 1.0; // (-z)^(k-3) 3! / k!
    double two = 4.0;   // 2^(k-1)
    for (int k = 3; k < 30; k++) {
        sum += (two - 2.0) * power;
        power *= -z / (k + 1);
        two *= 2.0;
    }
    return sum / 6.0;
}

// With r = sigma |V| / g, s = sgn V and the settled deflection D = s g / sigma:
//     delta = D + (delta_0 - D) e^-rt,   heat = integral of sigma r delta^2 dt,   drag = V (delta_1 - delta_0).
FcMap fc_map_of_constant_scene(const FcCoefficients* at, double h) {
    assert(!(at->sigma < 0.0) && at->limit > 0.0 && h >= 0.0); // a sigma that is no number goes through
    const double V = at->V;
    const double sigma = at->sigma;
    const double z = -fc_coefficients_rate(at) * h;
    FcMap map;
    map.relaxation = -expm1(-z);
    if (z > 1.0) {
        const double saturated = copysign(at->limit, V);
        map.offset = saturated / sigma * map.relaxation;
        map.impulse_slope = at->limit / fabs(V) * map.relaxation;
        map.impulse_offset = saturated * (h - map.impulse_slope / sigma);
        map.heat_offset = saturated * V * h * (1.0 - map.relaxation * (1.0 + 0.5 * map.relaxation) / z);
    } else {
        const double phi_1 = z > 0.0 ? map.relaxation / z : 1.0;
        map.offset = V * h * phi_1;
        map.impulse_slope = sigma * h * phi_1;
        map.impulse_offset = sigma * V * h * h * phi_2(z);
        map.heat_offset = sigma * V * h * V * h * z * phi_heat(z);
    }
    map.work_slope = V * map.impulse_slope;
    map.work_offset = V * map.impulse_offset;
    map.drag_slope = -V * map.relaxation;
    map.drag_offset = V * map.offset;
    // With e = e^-rt: sigma r (delta_0 e + D (1 - e))^2 integrated, and D sigma r = sigma V.
    map.heat_square = 0.5 * sigma * map.relaxation * (2.0 - map.relaxation);
    map.heat_slope = sigma * map.offset * map.relaxation;
    return map;
}
