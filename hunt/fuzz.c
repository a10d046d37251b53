// The hunt guided by coverage: libFuzzer draws the bytes of a sequence, and what leads the solver along new ways is kept.
// Ends with abort where a step is not within the tolerance.
//
// The first byte chooses the tolerance, the second the law; the rest is the sequence.
#include <stdio.h>
#include <stdlib.h>

#include "scenes.h"
#include "trial.h"

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

static const double TOLERANCES[] = {1e-2, 1e-3, 1e-4, 1e-6, 1e-8};

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    static Trial trial;
    if (size < 2) {
        return 0;
    }
    const double tolerance = TOLERANCES[data[0] % (sizeof TOLERANCES / sizeof *TOLERANCES)];
    const Grammar grammar = {.law = 1 + data[1] % 4};
    const Sequence sequence = sequence_from_bytes(data + 2, size - 2, &grammar);
    trial_run(&trial, &sequence, tolerance);
    const int worst = trial_worst(&trial);
    if (worst >= 0 && !(trial.taken[worst].verdict.ratio <= 1.0)) {
        char text[SEQUENCE_TEXT];
        sequence_text(&sequence, text, sizeof text);
        fprintf(stderr, "miss ratio=%g of=%s step=%d: tolerance=%g %s\n", trial.taken[worst].verdict.ratio,
                GRADE_NAMES[trial.taken[worst].verdict.of], worst + 1, tolerance, text);
        abort();
    }
    return 0;
}
