// What the C unit tests share: checks that say what they compared and go on, and a program's result.
//
//     int main(void) {
//         CHECK(fc_drive_vibrates(&drive));
//         CHECK_NEAR(fc_drive_V(&drive, 0.0), 1.445, 1e-15);
//         return check_result();
//     }
#ifndef FC_UNIT_CHECK_H
#define FC_UNIT_CHECK_H

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

static int check_failures;

static inline void check_truth(bool truth, const char* what, const char* file, int line) {
    if (!truth) {
        fprintf(stderr, "%s:%d: does not hold: %s\n", file, line, what);
        check_failures++;
    }
}

static inline void check_near(double got, double expected, double allowed, const char* what, const char* file,
                              int line) {
    if (!(fabs(got - expected) <= allowed)) {
        fprintf(stderr, "%s:%d: %s is %.17g, expected %.17g, off by %.3g, allowed %.3g\n", file, line, what,
                got, expected, fabs(got - expected), allowed);
        check_failures++;
    }
}

static inline int check_result(void) { return check_failures ? 1 : 0; }

#define CHECK(truth) check_truth((truth), #truth, __FILE__, __LINE__)
// |got - expected| at most allowed, or at most relative times |expected|.
#define CHECK_WITHIN(got, expected, allowed)                                                                 \
    check_near((got), (expected), (allowed), #got, __FILE__, __LINE__)
#define CHECK_NEAR(got, expected, relative)                                                                  \
    check_near((got), (expected), (relative) * fabs(expected), #got, __FILE__, __LINE__)

#endif
