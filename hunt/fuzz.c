// The hunt guided by coverage: libFuzzer draws the bytes of a sequence, and what leads the solver along new ways is kept.
// Ends with abort where a step misses what is promised.
//
// The first byte chooses the tolerance, the second the law, the third the method; the rest is the sequence.
#include <stdio.h>
#include <stdlib.h>

#include "scenes.h"
#include "trial.h"

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

static const double TOLERANCES[] = {1e-2, 1e-3, 1e-4, 1e-6, 1e-9};
static const double MOST_PERIODS = 4.0; // of a step that the reference takes, which is 1 ms for each

// Mostly the default; else cvode and the methods of fixed steps.
static int method_of(uint8_t byte) { return byte % 4 < 3 ? FMU_COLLOCATION : FMU_CVODE + byte / 4 % 5; }

// A step that the reference would take long over is cut.
static void shorten(ReferenceScene* scene) {
    if (scene->h * scene->f > MOST_PERIODS && scene->h * scene->f < 32.0) {
        scene->h = MOST_PERIODS / scene->f;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    if (size < 3) {
        return 0;
    }
    const double tolerance = TOLERANCES[data[0] % (sizeof TOLERANCES / sizeof *TOLERANCES)];
    const Grammar grammar = {.law = 1 + data[1] % 4, .settled = 1, .method = method_of(data[2])};
    Sequence sequence = sequence_from_bytes(data + 3, size - 3, &grammar);
    shorten(&sequence.step[0]);
    Trial trial = {0};
    trial_run(&trial, &sequence, MOST_STEPS, tolerance);
    const Verdict worst = trial_worst(&trial, sequence.method, tolerance);
    if (!(worst.ratio <= worst.granted) && !trial_is_unsure(&trial, &worst, tolerance)) {
        char text[SEQUENCE_TEXT];
        sequence_text(&sequence, text, sizeof text);
        fprintf(stderr, "miss ratio=%g of=%s step=%d: tolerance=%g %s\n", worst.ratio, GRADE_NAMES[worst.of],
                worst.step + 1, tolerance, text);
        abort();
    }
    return 0;
}
