// Numbers that look random, the same in every run; each thread has its own.
#ifndef FC_TESTS_RANDOM_H
#define FC_TESTS_RANDOM_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

static _Thread_local uint64_t random_state = 88172645463325252u;

// splitmix64
static inline uint64_t random_bits(void) {
    uint64_t z = random_state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

// In [0, 1)
static inline double random_01(void) { return (double)(random_bits() >> 11) * 0x1p-53; }
static inline double random_log(double low, double high) { return low * pow(high / low, random_01()); }
static inline bool random_chance(double probability) { return random_01() < probability; }
static inline int random_below(int count) { return (int)(random_01() * count); }

#endif
