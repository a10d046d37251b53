// The way of a stuck bristle and its integral, against long double: from a reversal on, where V(a) is 0, all digits stay.
#include "solver/path.h"

#include "check.h"
#include "table_1.h"

static const double F = 20e3; // Hz
static const double V_1 = 1.44;

// z - sin z, 1 - cos z and z^2/2 - (1 - cos z) lose too many digits as differences below 0.1: their series there.
static long double series(long double z, int first) {
    long double term = 1.0L;
    for (int k = 1; k <= first; k++) {
        term *= z / k;
    }
    long double sum = 0.0L;
    for (int k = first; k < first + 40; k += 2) {
        sum += term;
        term *= -z * z / ((k + 1) * (k + 2));
    }
    return sum;
}

static void check_from(const FcScene* scene, double start, double s) {
    const FcDrive* drive = &scene->drive;
    const FcPath path = fc_path_from(scene, start);
    const double t = start + s;
    const long double omega = drive->omega;
    const long double exact_s = (long double)t - start;
    const long double z = omega * exact_s;
    const long double c = path.cos_theta;
    const long double n = path.sin_theta;
    const long double linear = exact_s * (path.V + 0.5L * path.V_rate * exact_s);
    const long double x = linear - V_1 / omega * (c * series(z, 3) + n * series(z, 2));
    const long double integral = exact_s * exact_s * (path.V / 2.0L + path.V_rate * exact_s / 6.0L) -
                                 V_1 / (omega * omega) * (c * series(z, 4) + n * series(z, 3));
    const long double parts =
        fabsl(linear) + V_1 / omega * (fabsl(c) * series(z, 3) + fabsl(n) * series(z, 2));
    const long double integral_parts =
        fabsl(linear) * exact_s + V_1 / (omega * omega) * (fabsl(c) * series(z, 4) + fabsl(n) * series(z, 3));
    CHECK_WITHIN(fc_path_at(&path, t), (double)x, 1e-15 * (double)parts);
    CHECK_WITHIN(fc_path_integral(&path, t), (double)integral, 1e-15 * (double)integral_parts);
}

int main(void) {
    const FcContactParameters contact = table_1(FC_CONTACT_CONSTANT, FC_CONTACT_SEPARATION);
    const FcContactAtModulus at_E = fc_contact_at_modulus(&contact, 58e9);
    const FcFriction friction = {.model = FC_ELASTIC_PLASTIC, .limit = FC_LIMIT_CONSTANT};
    const double phases[] = {0.0, 0.25, 0.1, 0.6};
    for (int k = 0; k < 4 * 2 * 60; k++) {
        const double rate = k / 4 % 2 == 0 ? 0.0 : 2e4;
        const double z = 1e-3 * pow(10.0, k / 8 * 0.052); // to 1.2
        const FcDrive drive = fc_drive_make((FcLinearInput){0.0, rate}, (FcLinearInput){14e-6, 0.0},
                                            (FcLinearInput){58e9, 0.0}, (FcLinearInput){100.0, 0.0},
                                            (FcVibration){.f = F, .V_1 = V_1}, phases[k % 4] / F, 0.0);
        const FcScene scene = fc_scene_make(&contact, &at_E, &friction, 55.0, &drive);
        check_from(&scene, 0.0, z / drive.omega);
    }
    return check_result();
}
