#include "model/drive.h"

#include <assert.h>
#include <math.h>

#include "model/extremes.h"
#include "model/pi.h"
#include "model/root.h"

// f t minus the nearest whole number, exact to the last bit of t: the product's rounding error is added back.
static double phase_in_cycles(double f, double t) {
    const double cycles = f * t;
    if (!isfinite(cycles)) {
        return 0.0;
    }
    const double lost = fma(f, t, -cycles);
    const double fraction = (cycles - rint(cycles)) + lost;
    return fraction - rint(fraction);
}

void fc_drive_start(FcDrive* drive, double start, double rest) {
    const FcVibration* vibration = &drive->vibration;
    assert(!(vibration->V_1 < 0.0 || vibration->V_2 < 0.0 || vibration->a_d < 0.0));
    drive->omega = drive->theta_0 = 0.0;
    drive->cos_phase_d = drive->sin_phase_d = drive->cos_phase_2 = drive->sin_phase_2 = 0.0;
    if (fc_drive_vibrates(drive)) {
        assert(vibration->f > 0.0);
        drive->omega = FC_TWO_PI * vibration->f;
        drive->cos_phase_d = cos(vibration->phase_d);
        drive->sin_phase_d = sin(vibration->phase_d);
        if (vibration->V_2 != 0.0) {
            drive->cos_phase_2 = cos(vibration->phase_2);
            drive->sin_phase_2 = sin(vibration->phase_2);
        }
        drive->theta_0 = FC_TWO_PI * (phase_in_cycles(vibration->f, start) + vibration->f * rest);
    }
}

bool fc_drive_vibrates(const FcDrive* drive) {
    const FcVibration* vibration = &drive->vibration;
    return vibration->V_1 != 0.0 || vibration->a_d != 0.0 || vibration->V_2 != 0.0;
}

bool fc_drive_is_linear(const FcDrive* drive) {
    return drive->V.rate != 0.0 || drive->d.rate != 0.0 || drive->E.rate != 0.0 || drive->load.rate != 0.0 ||
           drive->V_y.rate != 0.0;
}

bool fc_drive_is_planar(const FcDrive* drive) {
    return drive->V_y.value != 0.0 || drive->V_y.rate != 0.0 || drive->vibration.V_2 != 0.0;
}

bool fc_drive_is_constant(const FcDrive* drive) {
    return !fc_drive_vibrates(drive) && !fc_drive_is_linear(drive);
}

bool fc_drive_V_is_constant(const FcDrive* drive) {
    return drive->V.rate == 0.0 && drive->vibration.V_1 == 0.0;
}

static double theta(const FcDrive* drive, double t) { return drive->theta_0 + drive->omega * t; }

static double linear(FcLinearInput input, double t) { return input.value + input.rate * t; }

double fc_input_after(FcLinearInput input, double t) {
    return input.rate != 0.0 ? fma(input.rate, t, input.value) : input.value;
}

FcDrive fc_drive_later(const FcDrive* drive, double t) {
    FcDrive later = *drive;
    later.V.value = fc_input_after(drive->V, t);
    later.d.value = fc_input_after(drive->d, t);
    later.E.value = fc_input_after(drive->E, t);
    later.load.value = fc_input_after(drive->load, t);
    later.V_y.value = fc_input_after(drive->V_y, t);
    return later;
}

FcPhase fc_drive_phase(const FcDrive* drive, double t) {
    const double angle = theta(drive, t);
    return angle == 0.0 ? (FcPhase){0.0, 1.0} : (FcPhase){sin(angle), cos(angle)};
}

// If V nearly cancels V_1, |V| may be less than the rounding of either, and the stiffest contacts would relax
// wrongly. 1 - |cos| = sin^2 / (1 + |cos|) keeps its digits if |cos| is nearly 1.
double fc_drive_V_at_phase(const FcDrive* drive, double t, FcPhase at_t) {
    const double V_1 = drive->vibration.V_1;
    const double cosine = at_t.cosine;
    const double V = linear(drive->V, t) + V_1 * cosine;
    if (!(fabs(V) < 0.05 * V_1) || fabs(cosine) < 0.9) {
        return V;
    }
    const double turn = copysign(V_1, cosine);
    return (drive->V.value + turn) +
           (drive->V.rate * t - turn * (at_t.sine * at_t.sine / (1.0 + fabs(cosine))));
}

// Sine and cosine of the angle of the transverse vibration.
static FcPhase phase_across(const FcDrive* drive, FcPhase at_t) {
    return (FcPhase){.sine = at_t.sine * drive->cos_phase_2 + at_t.cosine * drive->sin_phase_2,
                     .cosine = at_t.cosine * drive->cos_phase_2 - at_t.sine * drive->sin_phase_2};
}

double fc_drive_V_y_at_phase(const FcDrive* drive, double t, FcPhase at_t) {
    return linear(drive->V_y, t) + drive->vibration.V_2 * phase_across(drive, at_t).cosine;
}

// The velocity V of an input that vibrates by an amplitude; at its angle.
static FcVelocity velocity(double V, FcLinearInput input, double amplitude, double omega, FcPhase at) {
    const double acceleration = amplitude * omega;
    return (FcVelocity){.V = V,
                        .rate = input.rate - acceleration * at.sine,
                        .curvature = -acceleration * omega * at.cosine,
                        .third = acceleration * omega * omega * at.sine};
}

FcVelocity fc_drive_velocity_at_phase(const FcDrive* drive, double t, FcPhase at_t) {
    return velocity(fc_drive_V_at_phase(drive, t, at_t), drive->V, drive->vibration.V_1, drive->omega, at_t);
}

FcVelocity fc_drive_velocity_y_at_phase(const FcDrive* drive, double t, FcPhase at_t) {
    return velocity(fc_drive_V_y_at_phase(drive, t, at_t), drive->V_y, drive->vibration.V_2, drive->omega,
                    phase_across(drive, at_t));
}

FcDrive fc_drive_across(const FcDrive* drive) {
    FcDrive across = *drive;
    across.V = drive->V_y;
    across.vibration.V_1 = drive->vibration.V_2;
    across.theta_0 += drive->vibration.phase_2;
    across.vibration.phase_d -= drive->vibration.phase_2;
    across.cos_phase_d = cos(across.vibration.phase_d);
    across.sin_phase_d = sin(across.vibration.phase_d);
    across.V_y = (FcLinearInput){0.0, 0.0};
    across.vibration.V_2 = 0.0;
    return across;
}

FcDriveValues fc_drive_values_at_phase(const FcDrive* drive, double t, FcPhase at_t) {
    const double by_cosine = at_t.cosine * drive->cos_phase_d - at_t.sine * drive->sin_phase_d;
    return (FcDriveValues){.V = fc_drive_V_at_phase(drive, t, at_t),
                           .d = linear(drive->d, t) + drive->vibration.a_d * by_cosine};
}

double fc_drive_V(const FcDrive* drive, double t) {
    return drive->vibration.V_1 == 0.0 ? linear(drive->V, t)
                                       : fc_drive_V_at_phase(drive, t, fc_drive_phase(drive, t));
}

double fc_drive_V_y(const FcDrive* drive, double t) {
    return fc_drive_is_planar(drive) ? fc_drive_V_y_at_phase(drive, t, fc_drive_phase(drive, t)) : 0.0;
}

double fc_drive_d(const FcDrive* drive, double t) {
    return drive->vibration.a_d == 0.0 ? linear(drive->d, t)
                                       : fc_drive_values_at_phase(drive, t, fc_drive_phase(drive, t)).d;
}

double fc_drive_E(const FcDrive* drive, double t) { return fc_input_after(drive->E, t); }

double fc_drive_load(const FcDrive* drive, double t) { return fc_input_after(drive->load, t); }

FcVelocity fc_drive_velocity(const FcDrive* drive, double t) {
    return drive->vibration.V_1 == 0.0 ? (FcVelocity){.V = linear(drive->V, t), .rate = drive->V.rate}
                                       : fc_drive_velocity_at_phase(drive, t, fc_drive_phase(drive, t));
}

double fc_velocity_time_of_change(const FcVelocity* at, double change) {
    assert(!(change < 0.0));
    const double time = fc_time_to_move(fabs(at->rate), fabs(at->curvature), change);
    const double third = fabs(at->third);
    return third == 0.0 || third * time * time * time <= 6.0 * change ? time : cbrt(6.0 * change / third);
}

double fc_drive_d_rate_at_phase(const FcDrive* drive, FcPhase at_t) {
    return drive->d.rate - drive->vibration.a_d * drive->omega *
                               (at_t.sine * drive->cos_phase_d + at_t.cosine * drive->sin_phase_d);
}

double fc_input_min(FcLinearInput input, double h) { return fc_min(input.value, linear(input, h)); }

double fc_input_max(FcLinearInput input, double h) { return fc_max(input.value, linear(input, h)); }

double fc_drive_largest_speed(const FcDrive* drive, double h) {
    assert(!(h < 0.0));
    const double along = fc_max(fabs(drive->V.value), fabs(linear(drive->V, h))) + drive->vibration.V_1;
    if (!fc_drive_is_planar(drive)) {
        return along;
    }
    return hypot(along, fc_max(fabs(drive->V_y.value), fabs(linear(drive->V_y, h))) + drive->vibration.V_2);
}

// Half an angle [rad] up to which the displacement is a series. Derived: the remainder of the series is below
// 1e-16 there. Twice the angle would leave a larger remainder.
static const double SERIES_UP_TO = 0.5;

double fc_drive_displacement(const FcDrive* drive, double t0, double t1) {
    const double duration = t1 - t0;
    const double middle = 0.5 * (t0 + t1);
    if (drive->vibration.V_1 == 0.0) {
        return linear(drive->V, middle) * duration;
    }
    const double half = 0.5 * drive->omega * duration;
    const FcPhase at_middle = fc_drive_phase(drive, middle);
    const double V_c = drive->vibration.V_1 * at_middle.cosine;
    if (half > SERIES_UP_TO) {
        return linear(drive->V, middle) * duration + 2.0 * V_c / drive->omega * sin(half);
    }
    // V in the middle, as one number since V may nearly cancel V_1, minus the effect of the vibration's
    // curvature, 1 - sin(half) / half.
    const double y = half * half;
    const double bent =
        y / 6 * (1.0 - y / 20 * (1.0 - y / 42 * (1.0 - y / 72 * (1.0 - y / 110 * (1.0 - y / 156)))));
    return (fc_drive_V_at_phase(drive, middle, at_middle) - V_c * bent) * duration;
}

// The integral of tau sin(omega tau) over an interval centred at tau = 0, s being omega times half its
// length. It vanishes like s^3.
static double sine_moment(double omega, double s) {
    assert(omega > 0.0);
    return s > 0.1 ? 2.0 * (sin(s) - s * cos(s)) / (omega * omega)
                   : 2.0 * s * s * s * (1.0 / 3 - s * s * (1.0 / 30 - s * s * (1.0 / 840 - s * s / 45360))) /
                         (omega * omega);
}

// The integral of (t1 - t) V(t) is half the duration times the displacement less that of (t - middle) V(t).
double fc_drive_displacement_integral(const FcDrive* drive, double t0, double t1) {
    const double duration = t1 - t0;
    double moment = drive->V.rate * duration * duration * duration / 12.0;
    if (drive->vibration.V_1 != 0.0) {
        const double omega = drive->omega;
        moment -= drive->vibration.V_1 * sin(theta(drive, 0.5 * (t0 + t1))) *
                  sine_moment(omega, 0.5 * omega * duration);
    }
    return 0.5 * duration * fc_drive_displacement(drive, t0, t1) - moment;
}

// Positive nodes on [-1, 1] and weights of the Gauss rule of eight nodes (Abramowitz and Stegun, table 25.4).
static const double GAUSS[4][2] = {{0.1834346424956498, 0.3626837833783620},
                                   {0.5255324099163290, 0.3137066458778873},
                                   {0.7966664774136267, 0.2223810344533745},
                                   {0.9602898564975363, 0.1012285362903763}};

static double square_by_quadrature(const FcDrive* drive, double middle, double half) {
    double square = 0.0;
    for (int k = 0; k < 4; k++) {
        const double before = fc_drive_V(drive, middle - GAUSS[k][0] * half);
        const double after = fc_drive_V(drive, middle + GAUSS[k][0] * half);
        square += GAUSS[k][1] * (before * before + after * after);
    }
    return square * half;
}

// The part of the sum of its terms below which the square of V has lost three digits to cancellation, for
// example if V grazes zero or in a short step around a reversal. The vibration then turns by less than 2 rad,
// over which eight nodes err by less than 1e-13 of the terms. A smaller part would keep lost digits.
static const double CANCELS = 1e-3;

// With tau = t - middle, V = v + V' tau + V_1 cos(theta + omega tau), s = omega duration / 2 and S = sin(s):
// the integrals of (v + V' tau)^2, of 2 (v + V' tau) V_1 cos and of V_1^2 cos^2.
double fc_drive_square(const FcDrive* drive, double t0, double t1) {
    assert(!(t1 < t0));
    const double duration = t1 - t0;
    const double middle = 0.5 * (t0 + t1);
    const double v = linear(drive->V, middle);
    const double rate = drive->V.rate;
    const double V_1 = drive->vibration.V_1;
    const double still = (v * v + rate * rate * duration * duration / 12.0) * duration;
    if (V_1 == 0.0) {
        return still;
    }
    const double omega = drive->omega;
    const double angle = theta(drive, middle);
    const double s = 0.5 * omega * duration;
    const double mixed =
        2.0 * V_1 * (2.0 * v * sin(s) / omega * cos(angle) - rate * sine_moment(omega, s) * sin(angle));
    const double own = V_1 * V_1 * (0.5 * duration + 0.5 * sin(2.0 * s) / omega * cos(2.0 * angle));
    const double square = still + mixed + own;
    return square < CANCELS * (still + V_1 * V_1 * duration)
               ? square_by_quadrature(drive, middle, 0.5 * duration)
               : square;
}

// Roots of V nearer than this, over 1 + the angle [rad], are one root. Chosen empirically, 450 eps: a smaller
// distance finds a root again through rounding, a larger one passes over a second root.
static const double SAME_ANGLE = 1e-13;

static double least_ahead(double angle) { return SAME_ANGLE * (1.0 + fabs(angle)); }

// The distance from now, more than `least`, to the next angle that equals target modulo 2 pi.
static double angle_ahead(double now, double target, double least) {
    assert(!(least < 0.0 || least > FC_TWO_PI));
    double ahead = fmod(target - now, FC_TWO_PI);
    if (ahead < 0.0) {
        ahead += FC_TWO_PI;
    }
    return ahead > least ? ahead : ahead + FC_TWO_PI;
}

static double V_at(void* drive, double t) { return fc_drive_V(drive, t); }

// Whether |V| dips below half of |V| + V_1 at t. A shallower dip is smooth enough to be stepped over.
static bool is_dip(const FcDrive* drive, double t) {
    const FcVelocity at = fc_drive_velocity(drive, t);
    return at.V * at.curvature >= 0.0 &&
           fabs(at.V) < 0.5 * (fabs(linear(drive->V, t)) + drive->vibration.V_1);
}

// The largest |V| over V_1 at which V passes zero steeply enough for acos and its cosine to keep their
// digits. Chosen empirically: at this value acos multiplies rounding by 1 / sqrt(1 - 0.9^2) = 2.3, at larger
// values by more.
static const double AWAY_FROM_GRAZING = 0.9;

// acos(-V / V_1), which loses half of its digits next to 1 and -1.
static double angle_of_reversal(double V, double V_1) {
    assert(fabs(V) < fabs(V_1));
    return fabs(V) < AWAY_FROM_GRAZING * fabs(V_1) ? acos(-V / V_1) : 2.0 * atan(sqrt((V_1 + V) / (V_1 - V)));
}

static FcDriveEvent first_of_held_vibration(const FcDrive* drive, double t, double end) {
    const double V_1 = drive->vibration.V_1;
    const double V = drive->V.value;
    const double now = theta(drive, t);
    const double least = t > 0.0 ? least_ahead(now) : 0.0; // at t = 0 any root ahead counts
    if (fabs(V) < fabs(V_1)) {
        const double root = angle_of_reversal(V, V_1);
        const double time =
            t + fc_min(angle_ahead(now, root, least), angle_ahead(now, -root, least)) / drive->omega;
        return time < end ? (FcDriveEvent){time, true} : (FcDriveEvent){end, false};
    }
    const double time = t + angle_ahead(now, (V > 0.0) == (V_1 > 0.0) ? FC_PI : 0.0, least) / drive->omega;
    return time < end && is_dip(drive, time) ? (FcDriveEvent){time, false} : (FcDriveEvent){end, false};
}

// The largest |V| at the floating-point number next to a root t.
static double rounding_of_V(const FcDrive* drive, double t) {
    return fabs(drive->vibration.V_1) * least_ahead(theta(drive, t)) +
           1e-15 * (fabs(drive->V.value) + fabs(drive->V.rate) * t);
}

static FcDriveEvent first_of_linear_vibration(const FcDrive* drive, double t, double end) {
    // V is monotone between the angles at which sin(theta) = V' / (V_1 omega), if there are any.
    const double slope = drive->V.rate / (drive->vibration.V_1 * drive->omega);
    double from = t;
    double V_from = fc_drive_V(drive, from);
    if (V_from == 0.0 || (t > 0.0 && fabs(V_from) <= rounding_of_V(drive, t))) { // t is a root
        from += least_ahead(theta(drive, t)) / drive->omega;
        V_from = fc_drive_V(drive, from);
    }
    while (from < end) {
        double to = end;
        if (fabs(slope) < 1.0) {
            const double now = theta(drive, from);
            const double angle = asin(slope);
            const double least = least_ahead(now);
            const double turns =
                fc_min(angle_ahead(now, angle, least), angle_ahead(now, FC_PI - angle, least));
            to = fc_min(end, from + turns / drive->omega);
        }
        const double V_to = fc_drive_V(drive, to);
        if ((V_from < 0.0) != (V_to < 0.0)) {
            double evaluations = 0.0;
            FcDrive at = *drive;
            const double root = fc_root_between(V_at, &at, from, V_from, to, V_to, 0.0, &evaluations);
            return (FcDriveEvent){root, true};
        }
        if (to < end && is_dip(drive, to)) {
            return (FcDriveEvent){to, false};
        }
        from = to;
        V_from = V_to;
    }
    return (FcDriveEvent){end, false};
}

FcDriveEvent fc_drive_next_event(const FcDrive* drive, double t, double end) {
    assert(t >= 0.0 && end >= t);
    if (drive->vibration.V_1 == 0.0 && drive->V.rate == 0.0) {
        return (FcDriveEvent){end, false};
    }
    if (drive->vibration.V_1 == 0.0) {
        const double root = -drive->V.value / drive->V.rate;
        return root > t && root < end ? (FcDriveEvent){root, true} : (FcDriveEvent){end, false};
    }
    const FcDriveEvent event = drive->V.rate == 0.0 ? first_of_held_vibration(drive, t, end)
                                                    : first_of_linear_vibration(drive, t, end);
    assert(!(event.time < t || event.time > end));
    return event;
}
