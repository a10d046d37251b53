#include "dahl.h"

#include <math.h>

DahlProblem dahl_problem(const ContactParameters* contact, const Drive* drive, double F_C) {
    return (DahlProblem){
        .contact = contact, .at_E = contact_at_modulus(contact, drive->E.value), .drive = *drive, .F_C = F_C};
}

// The contact at the modulus of the time t.
static ContactAtModulus contact_at(const DahlProblem* problem, double t) {
    const Drive* drive = &problem->drive;
    return drive->E.rate == 0.0 ? problem->at_E : contact_at_modulus(problem->contact, drive_E(drive, t));
}

ContactState dahl_contact_state(const DahlProblem* problem, double t) {
    const ContactAtModulus at_E = contact_at(problem, t);
    return contact_state(&at_E, drive_d(&problem->drive, t));
}

DahlCoefficients dahl_coefficients(const DahlProblem* problem, double t) {
    const DriveValues now = drive_values(&problem->drive, t);
    if (problem->at_E.constant) {
        return (DahlCoefficients){.V = now.V, .sigma = problem->at_E.stiffness_0};
    }
    if (problem->drive.E.rate == 0.0) {
        return (DahlCoefficients){.V = now.V, .sigma = contact_stiffness(&problem->at_E, now.d)};
    }
    const ContactAtModulus at_E = contact_at(problem, t);
    return (DahlCoefficients){.V = now.V, .sigma = contact_stiffness(&at_E, now.d)};
}

double dahl_stiffness(const DahlProblem* problem, double t) { return dahl_coefficients(problem, t).sigma; }

double dahl_log_stiffness_rate(const DahlProblem* problem, double t) {
    const Drive* drive = &problem->drive;
    const double d = drive_d(drive, t);
    const double E = drive_E(drive, t);
    const double sigma = dahl_stiffness(problem, t);
    const ContactGradient slope = contact_stiffness_gradient(problem->contact, d, E);
    return sigma > 0.0 ? (slope.by_d * drive_d_rate(drive, t) + slope.by_E * drive->E.rate) / sigma : 0.0;
}

double dahl_largest_stiffness(const DahlProblem* problem, double h) {
    const Drive* drive = &problem->drive;
    if (drive->E.rate == 0.0) {
        return contact_stiffness(&problem->at_E, drive_smallest_d(drive, h));
    }
    const ContactAtModulus stiffest = contact_at_modulus(problem->contact, drive_largest_E(drive, h));
    return contact_stiffness(&stiffest, drive_smallest_d(drive, h));
}

DahlMap dahl_identity(void) { return (DahlMap){0}; }

// relaxation is 1 - P: composing it, and not P, keeps its digits where hardly anything relaxes.
DahlMap dahl_compose(const DahlMap* first, const DahlMap* second) {
    const double kept = 1.0 - first->relaxation;
    return (DahlMap){
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
DahlMap dahl_power(const DahlMap* one, double n) {
    DahlMap power = dahl_identity();
    DahlMap square = *one;
    while (n >= 1.0) {
        if (fmod(n, 2.0) == 1.0) {
            power = dahl_compose(&power, &square);
        }
        square = dahl_compose(&square, &square);
        n = floor(0.5 * n);
    }
    return power;
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

DahlMap dahl_constant_map(double V, double sigma, double F_C, double h) {
    const double z = sigma * fabs(V) * h / F_C;
    DahlMap map;
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
