#include "solver/panel/arithmetic.h"

bool fc_has_avx;

#ifdef FC_WITH_AVX
#include <cpuid.h>

// The processor has it, and the system keeps its registers: bits 1 and 2 of XCR0. Compilers have a function for this, which
// zig does not link.
__attribute__((constructor)) static void look_for_avx(void) {
    unsigned a;
    unsigned b;
    unsigned c;
    unsigned d;
    const unsigned wanted = bit_OSXSAVE | bit_AVX;
    if (__get_cpuid(1, &a, &b, &c, &d) && (c & wanted) == wanted) {
        __asm__("xgetbv" : "=a"(a), "=d"(d) : "c"(0)); // NOLINT(portability-no-assembler)
        fc_has_avx = (a & 6U) == 6U;
    }
}
#endif
