// A fixed sequence of numbers that look random, so that every run checks the same scenes.
#ifndef FC_UNIT_RANDOM_H
#define FC_UNIT_RANDOM_H

#include <math.h>

// In [0, 1): xorshift64.
static inline double random_01(void) {
    static unsigned long long state = 88172645463325252ull;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (double)(state >> 11) / 9007199254740992.0;
}

static inline double random_log(double low, double high) { return low * pow(high / low, random_01()); }

#endif
