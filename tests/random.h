// Numbers that look random, the same in every run.
#ifndef FC_TESTS_RANDOM_H
#define FC_TESTS_RANDOM_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

static uint64_t random_state = 88172645463325252u;

// In [0, 1): splitmix64.
static inline double random_01(void) {
    uint64_t z = random_state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static inline double random_log(double low, double high) { return low * pow(high / low, random_01()); }
static inline bool random_chance(double probability) { return random_01() < probability; }
static inline int random_below(int count) { return (int)(random_01() * count); }

#endif
