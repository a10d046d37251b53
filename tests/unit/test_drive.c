// The drive: its phase, its values and slopes, and above all the times at which V reverses.
#include "model/drive.h"

#include <stdint.h>

#include "check.h"
#include "random.h"

static const double TWO_PI = 6.283185307179586;
static const double F = 20e3; // Hz
static const double PERIOD = 5e-5;

static double uniform(double low, double high) { return low + (high - low) * random_01(); }

typedef struct {
    double V, V_rate, V_1, d_rate, a_d, phase_d, start;
} Case;

static FcDrive drive_of(Case c) {
    return fc_drive_make((FcLinearInput){c.V, c.V_rate}, (FcLinearInput){14e-6, c.d_rate},
                         (FcLinearInput){58e9, 0.0}, (FcLinearInput){1.0, 0.0},
                         (FcVibration){F, c.V_1, c.a_d, c.phase_d, 0.0, 0.0}, c.start, 0.0);
}

// f t modulo 1 in whole numbers: every double t from 2^29 to 2^30 s is a multiple of 2^-23 s, and f is one of 1 Hz.
static double exact_cycles(uint64_t f, double t) {
    const uint64_t ticks = (uint64_t)(t * 0x1p23);
    return (double)((f * ticks) % 0x800000u) * 0x1p-23;
}

static void phase_is_exact_after_many_years(void) {
    for (int k = 0; k < 200; k++) {
        const double t = 1e9 + 1237.0 * k + 0x1p-23 * (k * k);
        const FcDrive drive = drive_of((Case){.V = 0.1, .V_1 = 1.0, .start = t});
        const double phase = TWO_PI * exact_cycles(20000u, t);
        CHECK_WITHIN(sin(drive.theta_0 - phase), 0.0, 2e-15);
        CHECK_WITHIN(fc_drive_V(&drive, 0.0), 0.1 + cos(phase), 2e-15);
    }
}

static void rest_of_the_time_counts(void) {
    const FcVibration vibration = {.f = F, .V_1 = 1.0};
    const FcLinearInput held = {1.0, 0.0};
    const double rest = 4e-8; // s, below the rounding of 1e9 s
    const FcDrive with = fc_drive_make(held, held, held, held, vibration, 1e9, rest);
    const FcDrive without = fc_drive_make(held, held, held, held, vibration, 1e9, 0.0);
    CHECK_WITHIN(with.theta_0 - without.theta_0, TWO_PI * F * rest, 2e-15);
}

static void amplitudes_and_rates_decide_what_moves(void) {
    const FcDrive held = drive_of((Case){.V = 0.1});
    const FcDrive sideways = drive_of((Case){.V = 0.1, .V_1 = 1.0});
    const FcDrive normal = drive_of((Case){.V = 0.1, .a_d = 1e-6});
    const FcDrive ramp = drive_of((Case){.V = 0.1, .V_rate = -2.0});
    const FcDrive approach = drive_of((Case){.V = 0.1, .d_rate = 1e-3});
    CHECK(fc_drive_is_constant(&held) && !fc_drive_vibrates(&held) && !fc_drive_is_linear(&held));
    CHECK(!fc_drive_is_constant(&sideways) && fc_drive_vibrates(&sideways) && !fc_drive_is_linear(&sideways));
    CHECK(!fc_drive_is_constant(&normal) && fc_drive_vibrates(&normal));
    CHECK(!fc_drive_is_constant(&ramp) && !fc_drive_vibrates(&ramp) && fc_drive_is_linear(&ramp));
    CHECK(!fc_drive_is_constant(&approach) && fc_drive_is_linear(&approach));
}

static const Case MOVING = {
    .V = 0.1, .V_rate = 900.0, .V_1 = 0.7, .d_rate = 0.02, .a_d = 1.1e-6, .phase_d = 0.7, .start = 0.3e-5};

// Eq. 24 and section 3.2 written down once more. An angle of up to 13 rad is rounded by 9e-16, on both sides.
static void values_follow_the_formulas(void) {
    const FcDrive drive = drive_of(MOVING);
    for (double t = 0.0; t < 2.0 * PERIOD; t += 0.07 * PERIOD) {
        const double angle = TWO_PI * F * (MOVING.start + t);
        const double V = 0.1 + 900.0 * t + 0.7 * cos(angle);
        const double d = 14e-6 + 0.02 * t + 1.1e-6 * cos(angle + 0.7);
        const FcDriveValues both = fc_drive_values_at_phase(&drive, t, fc_drive_phase(&drive, t));
        CHECK_WITHIN(fc_drive_V(&drive, t), V, 2e-15);
        CHECK_WITHIN(both.V, V, 2e-15);
        CHECK_WITHIN(fc_drive_d(&drive, t), d, 1e-20);
        CHECK_WITHIN(both.d, d, 1e-20);
    }
}

// Five-point differences over 1e-3 of a period: the next term is (2 pi 1e-3)^4 / 30 = 5e-11 of the amplitude's slope.
static void slopes_are_derivatives(void) {
    const FcDrive drive = drive_of(MOVING);
    const double k = 1e-3 * PERIOD;
    const double omega = TWO_PI * F;
    for (double t = 0.0; t < 2.0 * PERIOD; t += 0.07 * PERIOD) {
#define SLOPE(q)                                                                                             \
    ((8.0 * (q(&drive, t + k) - q(&drive, t - k)) - (q(&drive, t + 2 * k) - q(&drive, t - 2 * k))) /         \
     (12.0 * k))
        CHECK_WITHIN(fc_drive_V_rate(&drive, t), SLOPE(fc_drive_V), 1e-10 * 0.7 * omega);
        CHECK_WITHIN(fc_drive_velocity(&drive, t).curvature, SLOPE(fc_drive_V_rate),
                     1e-10 * 0.7 * omega * omega);
        CHECK_WITHIN(fc_drive_d_rate(&drive, t), SLOPE(fc_drive_d), 1e-10 * 1.1e-6 * omega);
        const double moved =
            fc_drive_displacement(&drive, 0.0, t + k) - fc_drive_displacement(&drive, 0.0, t - k);
        const double further =
            fc_drive_displacement(&drive, 0.0, t + 2 * k) - fc_drive_displacement(&drive, 0.0, t - 2 * k);
        CHECK_WITHIN((8.0 * moved - further) / (12.0 * k), fc_drive_V(&drive, t), 1e-9);
    }
}

static void bounds_hold(void) {
    const double h = 1.7 * PERIOD;
    const double d_rates[] = {0.0, 0.02, -0.02};
    for (int i = 0; i < 3; i++) {
        Case c = MOVING;
        c.d_rate = d_rates[i];
        FcDrive drive = drive_of(c);
        drive.E.rate = i == 1 ? 1e12 : -1e12;
        double smallest_d = INFINITY, smallest_E = INFINITY, largest_E = 0.0, largest_speed = 0.0;
        for (double t = 0.0; t <= h; t += 1e-3 * PERIOD) {
            smallest_d = fmin(smallest_d, fc_drive_d(&drive, t));
            smallest_E = fmin(smallest_E, fc_drive_E(&drive, t));
            largest_E = fmax(largest_E, fc_drive_E(&drive, t));
            largest_speed = fmax(largest_speed, fabs(fc_drive_V(&drive, t)));
        }
        // They hold, and aren't farther off than the motion of the inputs in the step.
        CHECK(fc_drive_smallest_d(&drive, h) <= smallest_d);
        CHECK(fc_drive_smallest_d(&drive, h) >= smallest_d - fabs(c.d_rate) * h - 1e-11);
        CHECK(fc_drive_smallest_E(&drive, h) <= smallest_E &&
              fc_drive_smallest_E(&drive, h) >= smallest_E - 1e5);
        CHECK(fc_drive_largest_E(&drive, h) >= largest_E && fc_drive_largest_E(&drive, h) <= largest_E + 1e5);
        CHECK(fc_drive_largest_speed(&drive, h) >= largest_speed);
        CHECK(fc_drive_largest_speed(&drive, h) <= largest_speed + fabs(c.V_rate) * h + 1e-5);
    }
}

enum { MOST_EVENTS = 64 };
typedef struct {
    FcDriveEvent event[MOST_EVENTS];
    int count;
    int reversals;
} Events;

static Events events_until(const FcDrive* drive, double end) {
    Events all = {0};
    double t = 0.0;
    while (t < end && all.count < MOST_EVENTS) {
        const FcDriveEvent next = fc_drive_next_event(drive, t, end);
        CHECK(next.time > t && next.time <= end);
        if (!(next.time < end)) {
            CHECK(!next.reversal);
            break;
        }
        all.event[all.count++] = next;
        all.reversals += next.reversal;
        t = next.time;
    }
    return all;
}

// An event tells its phase, and from one to the next leads the same way as from anywhere: up to the rounding of the angles.
static void events_tell_what_follows(void) {
    const double means[] = {0.0, 0.3, -0.6, 0.69, 0.71, -0.75, 1.5};
    for (int i = 0; i < 7; i++) {
        for (int moves = 0; moves < 2; moves++) {
            Case c = MOVING;
            c.V = means[i];
            c.V_rate = moves ? 900.0 : 0.0;
            const FcDrive drive = drive_of(c);
            const double end = 3.3 * PERIOD;
            const Events all = events_until(&drive, end);
            for (int k = 0; k < all.count; k++) {
                const FcDriveEvent* event = &all.event[k];
                const FcPhase phase = fc_drive_phase(&drive, event->time);
                CHECK_WITHIN(event->phase.cosine, phase.cosine, 1e-14);
                CHECK_WITHIN(event->phase.sine, phase.sine, 1e-14);
                if (event->reversal) { // but for the rounding of the time
                    CHECK_WITHIN(fc_drive_V_at_phase(&drive, event->time, event->phase), 0.0, 5e-15);
                }
                const FcDriveEvent after = fc_drive_next_event(&drive, event->time, end);
                const bool is_last = k + 1 == all.count;
                CHECK(after.reversal == (!is_last && all.event[k + 1].reversal));
                CHECK_NEAR(after.time, is_last ? end : all.event[k + 1].time, 1e-14);
            }
        }
    }
}

// In closed form, but from the ends' phases instead of the middle's.
static void displacements_between_phases(void) {
    const FcDrive drive = drive_of(MOVING);
    for (double t0 = 0.0; t0 < PERIOD; t0 += 0.13 * PERIOD) {
        for (double h = 1e-3 * PERIOD; h < 2.0 * PERIOD; h *= 1.6) {
            CHECK_WITHIN(fc_drive_displacement_between(&drive, t0, fc_drive_phase(&drive, t0), t0 + h,
                                                       fc_drive_phase(&drive, t0 + h)),
                         fc_drive_displacement(&drive, t0, t0 + h), 1e-14 * 0.7 * PERIOD);
        }
    }
}

// Where V = V_1 cos crosses -V, in closed form, on both sides of each half period's end.
static void reversals_of_held_vibration(void) {
    const double V[] = {0.0, 0.005, -0.005, 0.5, -0.5, 1.4399};
    for (int i = 0; i < 6; i++) {
        const FcDrive drive = drive_of((Case){.V = V[i], .V_1 = 1.44});
        const Events all = events_until(&drive, 3.0 * PERIOD);
        CHECK(all.count == 6 && all.reversals == 6);
        const double first = acos(-V[i] / 1.44) / (TWO_PI * F);
        for (int k = 0; k < all.count; k++) {
            const double expected = k % 2 ? (k / 2 + 1) * PERIOD - first : k / 2 * PERIOD + first;
            // A root is known as well as V's rounding over its slope allows.
            const double slope = fabs(fc_drive_V_rate(&drive, expected));
            CHECK_WITHIN(all.event[k].time, expected, 2e-15 * PERIOD + 2e-15 / slope);
        }
    }
}

// V and V_1 apart by 2^-40 of themselves: the two reversals lie 2 sqrt(2e-12) / omega around half a period.
static void grazing_reversals(void) {
    const double gap = 0x1p-40;
    const FcDrive drive = drive_of((Case){.V = 1.0 - gap, .V_1 = 1.0});
    const Events all = events_until(&drive, PERIOD);
    CHECK(all.count == 2 && all.reversals == 2);
    const double apart = 2.0 * sqrt(2.0 * gap) / (TWO_PI * F);
    CHECK_NEAR(all.event[1].time - all.event[0].time, apart, 1e-9);
    CHECK_WITHIN(0.5 * (all.event[1].time + all.event[0].time), 0.5 * PERIOD, 1e-15 * PERIOD);
}

// Next to the angle at which V = -(1 + gap) + cos touches zero, in long double: -gap - 2 sin^2(x / 2). The angle itself is
// rounded, by 1e-15 at a full turn; V is small and keeps its digits all the same.
static void V_keeps_its_digits_where_it_touches_zero(void) {
    const double gaps[] = {0.0, 0x1p-20, -0x1p-20, 0x1p-45, -0x1p-45};
    const long double pi = 3.141592653589793238462643L;
    for (int i = 0; i < 5; i++) {
        for (int turned = 0; turned < 2; turned++) { // V_1 cos, and its negative half a period later
            const double V = (turned ? 1.0 : -1.0) * (1.0 + gaps[i]);
            const FcDrive drive = drive_of((Case){.V = V, .V_1 = 1.0});
            for (double x = 1e-8; x < 0.2; x *= 3.0) {
                const double t = ((turned ? 0.5 : 1.0) + x / TWO_PI) * PERIOD;
                const double turn = turned ? 1.0 : 2.0;
                const long double angle = (long double)drive.omega * t - (long double)turn * pi;
                const long double half = sinl(0.5L * angle);
                const long double dips = gaps[i] + 2.0L * half * half;
                const double expected = (double)(turned ? dips : -dips);
                const double rounding = 2e-15 * x + 1e-15 * fabs(expected);
                CHECK_WITHIN(fc_drive_V(&drive, t), expected, rounding);
                const FcDriveValues both = fc_drive_values_at_phase(&drive, t, fc_drive_phase(&drive, t));
                CHECK_WITHIN(both.V, expected, rounding);
                CHECK_WITHIN(fc_drive_velocity(&drive, t).V, expected, rounding);
                // and the path over as much on either side: -2 (gap x + x - sin x)
                const double h = x / drive.omega;
                const double middle = turn * 0.5 * PERIOD;
                const double y = x * x;
                const double rest = y / 6.0 * (1.0 - y / 20.0 * (1.0 - y / 42.0 * (1.0 - y / 72.0)));
                const double path = 2.0 * h * (gaps[i] + rest);
                CHECK_WITHIN(fc_drive_displacement(&drive, middle - h, middle + h), turned ? path : -path,
                             4e-15 * x * h + 1e-15 * PERIOD * (fabs(gaps[i]) + y));
            }
        }
    }
}

// V just touches zero, or stays above it: one dip a period, at half of it, while it is deep enough to matter.
static void dips_are_no_reversals(void) {
    const double V[] = {1.0, -1.0, 1.0 + 1e-12, 1.5};
    for (int i = 0; i < 4; i++) {
        const FcDrive drive = drive_of((Case){.V = V[i], .V_1 = 1.0});
        const Events all = events_until(&drive, 2.25 * PERIOD);
        CHECK(all.reversals == 0 && all.count == 2);
        for (int k = 0; k < all.count; k++) {
            const double expected = V[i] > 0.0 ? (k + 0.5) * PERIOD : (k + 1) * PERIOD;
            CHECK_WITHIN(all.event[k].time, expected, 1e-15 * PERIOD * (k + 1));
        }
    }
    const FcDrive fast = drive_of((Case){.V = 30.0, .V_1 = 1.0});
    CHECK(events_until(&fast, 3.0 * PERIOD).count == 0);
}

static void a_ramp_reverses_once(void) {
    const FcDrive turning = drive_of((Case){.V = 0.1, .V_rate = -300.0});
    const Events all = events_until(&turning, 1e-3);
    CHECK(all.count == 1 && all.reversals == 1);
    CHECK_NEAR(all.event[0].time, 0.1 / 300.0, 3e-16);
    const FcDrive leaving = drive_of((Case){.V = 0.1, .V_rate = 300.0});
    const FcDrive held = drive_of((Case){.V = 0.1});
    const FcDrive at_rest = drive_of((Case){.V = 0.0});
    CHECK(events_until(&leaving, 1e-3).count == 0);
    CHECK(events_until(&held, 1e-3).count == 0);
    CHECK(events_until(&at_rest, 1e-3).count == 0);
}

// Every change of sign that a fine walk sees is a reversal, in order, with V of either sign beside it.
static void check_by_walking(const FcDrive* drive, double end, int walked) {
    const Events all = events_until(drive, end);
    int k = 0;
    double before = fc_drive_V(drive, 0.0);
    for (int i = 1; i <= walked; i++) {
        const double t = end * i / walked;
        const double now = fc_drive_V(drive, t);
        if ((before < 0.0) != (now < 0.0)) {
            while (k < all.count && !all.event[k].reversal) {
                k++;
            }
            CHECK(k < all.count);
            if (k >= all.count) {
                return;
            }
            const double root = all.event[k].time;
            CHECK(root > t - 2.0 * end / walked && root <= t + 1e-15);
            const double rounding = 4e-16 * drive->vibration.V_1 + 4e-16 * fabs(drive->V.rate * end) + 1e-15;
            const double slope = fabs(fc_drive_V_rate(drive, root));
            CHECK_WITHIN(fc_drive_V(drive, root), 0.0, rounding + 4e-16 * end * slope);
            k++;
        }
        before = now;
    }
    while (k < all.count && !all.event[k].reversal) {
        k++;
    }
    CHECK(k == all.count);
}

static void reversals_of_linear_inputs(void) {
    for (int i = 0; i < 300; i++) {
        const double steepness = uniform(-1.5, 1.5); // V' over the vibration's largest slope
        const Case c = {.V = uniform(-2.0, 2.0),
                        .V_rate = i % 3 ? steepness * TWO_PI * F : 0.01 * steepness * TWO_PI * F,
                        .V_1 = 1.0,
                        .start = uniform(0.0, PERIOD)};
        const FcDrive drive = drive_of(c);
        check_by_walking(&drive, 2.6 * PERIOD, 20000);
    }
}

static void an_event_at_the_end_is_beyond_it(void) {
    const FcDrive ramp = drive_of((Case){.V = -1.0, .V_rate = 2.0});
    CHECK(!fc_drive_next_event(&ramp, 0.0, 0.5).reversal);
    CHECK(fc_drive_next_event(&ramp, 0.0, 0.75).reversal &&
          fc_drive_next_event(&ramp, 0.0, 0.75).time == 0.5);
}

// V turns in a step over which a slow vibration goes on by less than its phase is known to.
static void reversal_of_a_fast_input_over_a_slow_vibration(void) {
    const FcLinearInput V = {0.0118295, -1.177e9};
    const FcLinearInput held = {1.0, 0.0};
    const FcDrive drive =
        fc_drive_make(V, held, held, held, (FcVibration){.f = 1e-4, .V_1 = 1e-3}, 1000.0, 0.0);
    const double end = 1.83e-11;
    const FcDriveEvent event = fc_drive_next_event(&drive, 0.0, end);
    CHECK(event.time < end && event.reversal);
    CHECK_NEAR(event.time, fc_drive_V(&drive, 0.0) / 1.177e9, 1e-12);
    CHECK(fc_drive_next_event(&drive, event.time, end).time == end);
}

// V rises from below -V_1: near its end the ramp lets V graze zero in a dip before it crosses for good.
static void dips_of_linear_inputs(void) {
    const FcDrive above = drive_of((Case){.V = 1.2, .V_rate = 1.0, .V_1 = 1.0});
    const Events all = events_until(&above, 2.0 * PERIOD);
    CHECK(all.count == 2 && all.reversals == 0);
    for (int k = 0; k < all.count; k++) { // where V' + V_1 omega sin = 0, beside half periods
        CHECK_WITHIN(all.event[k].time, (k + 0.5) * PERIOD, 1e-5 * PERIOD);
        CHECK_WITHIN(fc_drive_V_rate(&above, all.event[k].time), 0.0, 1e-9 * TWO_PI * F);
    }
}

// Boole's rule in long double, its error a power of six of the division.
static void integrals_of_V(void) {
    const double duration[] = {1e-3, 0.03, 0.199, 0.201, 1.0, 7.0, 40.0}; // rad
    const double rate[] = {0.0, 1e-3, 1.0, -10.0};                        // of the vibration's largest
    const long double weight[] = {28.0L / 45, 64.0L / 45, 24.0L / 45, 64.0L / 45};
    enum { POINTS = 4 * 2000 };
    for (int i = 0; i < 7 * 4 * 5; i++) {
        const double omega = TWO_PI * F;
        const double h = duration[i % 7] / omega;
        const double start = 0.3 * h;
        const double V_rate = rate[i / 7 % 4] * omega;
        const Case c = {.V = 0.2 - 0.8 * h * V_rate,
                        .V_rate = V_rate,
                        .V_1 = i < 28 ? 0.0 : 0.7,
                        .start = 0.21 * (i / 28) / F};
        const FcDrive drive = drive_of(c);
        long double displacement = 0.0;
        long double integral = 0.0; // of the displacement
        long double square = 0.0;
        for (int k = 0; k <= POINTS; k++) {
            const long double t = start + (long double)h * k / POINTS;
            const long double V = c.V + c.V_rate * t + c.V_1 * cosl(drive.theta_0 + drive.omega * t);
            const long double w = weight[k % 4] * (k == 0 || k == POINTS ? 0.5L : 1.0L) * h / POINTS;
            displacement += w * V;
            integral += w * V * (start + (long double)h - t);
            square += w * V * V;
        }
        const double speed = 0.9 + h * fabs(V_rate);
        CHECK_WITHIN(fc_drive_displacement(&drive, start, start + h), (double)displacement,
                     2e-15 * speed * h);
        CHECK_WITHIN(fc_drive_displacement_integral(&drive, start, start + h), (double)integral,
                     2e-15 * speed * h * h);
        CHECK_WITHIN(fc_drive_square(&drive, start, start + h), (double)square, 4e-15 * speed * speed * h);
    }
}

// From a reversal on V is -V_1 sin(omega t), whose square is (V_1 omega)^2 h^3 / 3 but for (omega h)^2 / 5 of it.
static void the_square_of_V_after_a_reversal(void) {
    const FcDrive drive = drive_of((Case){.V_1 = 0.7, .start = 0.25 / F});
    const double omega = TWO_PI * F;
    for (double part = 1e-7; part < 2e-4; part *= 10.0) {
        const double h = part / omega;
        const double square = 0.7 * 0.7 * part * part * h / 3.0;
        CHECK_WITHIN(fc_drive_square(&drive, 0.0, h), square, 1e-8 * square);
    }
}

// |E'| / E and |load'| / load.
static void growths_are_relative_rates(void) {
    for (double sign = -1.0; sign < 2.0; sign += 2.0) {
        FcDrive drive = drive_of((Case){.V = 0.1});
        drive.E = (FcLinearInput){8e9, sign * 2e9};
        drive.load = (FcLinearInput){40.0, sign * 4.0};
        CHECK_NEAR(fc_drive_E_growth(&drive, 1.5), 2e9 / (8e9 + sign * 3e9), 1e-15);
        CHECK_NEAR(fc_drive_load_growth(&drive, 1.5), 4.0 / (40.0 + sign * 6.0), 1e-15);
    }
}

// |V'| x + |V''| x^2 / 2 is the change after that time.
static void a_parabola_takes_this_long(void) {
    for (int i = 0; i < 200; i++) {
        const FcVelocity at = {.V = uniform(-1.0, 1.0),
                               .rate = i % 5 ? uniform(-9.0, 9.0) : 0.0,
                               .curvature = i % 7   ? uniform(-300.0, 300.0)
                                            : i % 5 ? 0.0
                                                    : 7.0};
        const double change = uniform(1e-6, 10.0);
        const double x = fc_velocity_time_of_change(&at, change);
        CHECK_NEAR(fabs(at.rate) * x + 0.5 * fabs(at.curvature) * x * x, change, 1e-14);
    }
}

// In units of 2^-40 Pa and 2^-40 s every number here is a whole one.
static void what_is_left_of_E_and_load_has_its_digits(void) {
    const uint64_t start = 1000000;
    const FcLinearInput held = {1.0, 0.0};
    for (uint64_t k = 0; k < 100; k++) {
        const uint64_t rate = 0x7fffffffu - 2u * k;
        const uint64_t ticks = (start << 40) / rate;
        const double left = (double)((start << 40) - rate * ticks) * 0x1p-40;
        const FcLinearInput falls = {(double)start, -(double)rate};
        const FcDrive drive = fc_drive_make(held, held, falls, falls, (FcVibration){.f = F}, 0.0, 0.0);
        CHECK_NEAR(fc_drive_E(&drive, (double)ticks * 0x1p-40), left, 1e-15);
        CHECK_NEAR(fc_drive_load(&drive, (double)ticks * 0x1p-40), left, 1e-15);
    }
}

int main(void) {
    what_is_left_of_E_and_load_has_its_digits();
    growths_are_relative_rates();
    a_parabola_takes_this_long();
    phase_is_exact_after_many_years();
    rest_of_the_time_counts();
    amplitudes_and_rates_decide_what_moves();
    values_follow_the_formulas();
    slopes_are_derivatives();
    integrals_of_V();
    the_square_of_V_after_a_reversal();
    bounds_hold();
    reversals_of_held_vibration();
    events_tell_what_follows();
    displacements_between_phases();
    grazing_reversals();
    V_keeps_its_digits_where_it_touches_zero();
    dips_are_no_reversals();
    a_ramp_reverses_once();
    reversals_of_linear_inputs();
    dips_of_linear_inputs();
    reversal_of_a_fast_input_over_a_slow_vibration();
    an_event_at_the_end_is_beyond_it();
    return check_result();
}
