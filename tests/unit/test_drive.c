// The drive: its phase, its values and slopes, and above all the times at which V reverses.
#include "model/drive.h"

#include <stdint.h>

#include "check.h"
#include "random.h"

static const double TWO_PI = 6.283185307179586;
static const double F = 20e3; // Hz
static const double PERIOD = 5e-5;

static double uniform(double low, double high) { return low + (high - low) * random_01(); }

static const FcLinearInput HELD = {1.0, 0.0};

typedef struct {
    double V, V_rate, V_1, start, rest;
} Case;

static FcDrive drive_of(Case c) {
    FcDrive drive = {
        .V = {c.V, c.V_rate}, .d = HELD, .E = HELD, .load = HELD, .vibration = {.f = F, .V_1 = c.V_1}};
    fc_drive_start(&drive, c.start, c.rest);
    return drive;
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
    const double rest = 4e-8; // s, below the rounding of 1e9 s
    const FcDrive with = drive_of((Case){.V_1 = 1.0, .start = 1e9, .rest = rest});
    const FcDrive without = drive_of((Case){.V_1 = 1.0, .start = 1e9});
    CHECK_WITHIN(with.theta_0 - without.theta_0, TWO_PI * F * rest, 2e-15);
}

enum { MAX_EVENTS = 64 };
typedef struct {
    double reversal[MAX_EVENTS]; // s, their times
    int events, reversals;
} Events;

static Events events_until(const FcDrive* drive, double end) {
    Events all = {.events = 0};
    for (double t = 0.0; t < end && all.events < MAX_EVENTS;) {
        const FcDriveEvent next = fc_drive_next_event(drive, t, end);
        CHECK(next.time > t && next.time <= end && !(next.reversal && next.time == end));
        all.events += next.time < end;
        if (next.reversal) {
            all.reversal[all.reversals++] = next.time;
        }
        t = next.time;
    }
    return all;
}

// V and V_1 apart by 2^-40 of themselves: the two reversals lie 2 sqrt(2e-12) / omega around half a period.
static void grazing_reversals(void) {
    const double gap = 0x1p-40;
    const FcDrive drive = drive_of((Case){.V = 1.0 - gap, .V_1 = 1.0});
    const Events all = events_until(&drive, PERIOD);
    CHECK(all.events == 2 && all.reversals == 2);
    const double apart = 2.0 * sqrt(2.0 * gap) / (TWO_PI * F);
    CHECK_NEAR(all.reversal[1] - all.reversal[0], apart, 1e-9);
    CHECK_WITHIN(0.5 * (all.reversal[1] + all.reversal[0]), 0.5 * PERIOD, 1e-15 * PERIOD);
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

// Every change of sign that a fine walk sees is a reversal, in order, with V of either sign beside it.
static void check_by_walking(const FcDrive* drive, double end, int walked) {
    const Events all = events_until(drive, end);
    int k = 0;
    double before = fc_drive_V(drive, 0.0);
    for (int i = 1; i <= walked; i++) {
        const double t = end * i / walked;
        const double now = fc_drive_V(drive, t);
        if ((before < 0.0) != (now < 0.0)) {
            CHECK(k < all.reversals);
            if (k >= all.reversals) {
                return;
            }
            const double root = all.reversal[k++];
            CHECK(root > t - 2.0 * end / walked && root <= t + 1e-15);
            const double rounding = 4e-16 * drive->vibration.V_1 + 4e-16 * fabs(drive->V.rate * end) + 1e-15;
            const double slope = fabs(fc_drive_velocity(drive, root).rate);
            CHECK_WITHIN(fc_drive_V(drive, root), 0.0, rounding + 4e-16 * end * slope);
        }
        before = now;
    }
    CHECK(k == all.reversals);
}

static void reversals_of_linear_inputs(void) {
    for (int i = 0; i < 300; i++) {
        const double steepness = uniform(-1.5, 1.5); // V' over the vibration's largest slope
        const FcDrive drive = drive_of((Case){.V = uniform(-2.0, 2.0),
                                              .V_rate = (i % 3 ? 1.0 : 0.01) * steepness * TWO_PI * F,
                                              .V_1 = 1.0,
                                              .start = uniform(0.0, PERIOD)});
        check_by_walking(&drive, 2.6 * PERIOD, 20000);
    }
}

// V turns in a step over which a slow vibration goes on by less than its phase is known to.
static void reversal_of_a_fast_input_over_a_slow_vibration(void) {
    const FcLinearInput V = {0.0118295, -1.177e9};
    FcDrive drive = {.V = V, .d = HELD, .E = HELD, .load = HELD, .vibration = {.f = 1e-4, .V_1 = 1e-3}};
    fc_drive_start(&drive, 1000.0, 0.0);
    const double end = 1.83e-11;
    const FcDriveEvent event = fc_drive_next_event(&drive, 0.0, end);
    CHECK(event.time < end && event.reversal);
    CHECK_NEAR(event.time, fc_drive_V(&drive, 0.0) / 1.177e9, 1e-12);
    CHECK(fc_drive_next_event(&drive, event.time, end).time == end);
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
        const double V_1 = i < 28 ? 0.0 : 0.7;
        const Case c = {0.2 - 0.8 * h * V_rate, V_rate, V_1, 0.21 * (i / 28) / F, 0.0};
        const FcDrive drive = drive_of(c);
        long double displacement = 0.0, square = 0.0, integral = 0.0; // of the displacement
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

// In units of 2^-40 Pa and 2^-40 s every number here is a whole one.
static void what_is_left_of_E_and_load_has_its_digits(void) {
    const uint64_t start = 1000000;
    for (uint64_t k = 0; k < 100; k++) {
        const uint64_t rate = 0x7fffffffu - 2u * k;
        const uint64_t ticks = (start << 40) / rate;
        const double left = (double)((start << 40) - rate * ticks) * 0x1p-40;
        const FcLinearInput falls = {(double)start, -(double)rate};
        const FcDrive drive = {.V = HELD, .d = HELD, .E = falls, .load = falls};
        CHECK_NEAR(fc_drive_E(&drive, (double)ticks * 0x1p-40), left, 1e-15);
        CHECK_NEAR(fc_drive_load(&drive, (double)ticks * 0x1p-40), left, 1e-15);
    }
}

int main(void) {
    what_is_left_of_E_and_load_has_its_digits();
    phase_is_exact_after_many_years();
    rest_of_the_time_counts();
    integrals_of_V();
    grazing_reversals();
    V_keeps_its_digits_where_it_touches_zero();
    reversals_of_linear_inputs();
    reversal_of_a_fast_input_over_a_slow_vibration();
    return check_result();
}
