#include "sequence.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "names.h"

ReferenceScene scene_after(const ReferenceScene* before) {
    ReferenceScene s = *before;
    s.start = before->start + before->h;
    s.V += before->V_rate * before->h;
    s.d += before->d_rate * before->h;
    s.E += before->E_rate * before->h;
    s.load += before->load_rate * before->h;
    s.V_rate = s.d_rate = s.E_rate = s.load_rate = 0.0;
    s.initial = START_GIVEN;
    return s;
}

ReferenceScene no_change(void) {
    ReferenceScene none = {0};
    for (int k = 0; k < REFERENCE_DOUBLES; k++) {
        *scene_value(&none, k) = NAN;
    }
    return none;
}

ReferenceScene sequence_scene(const Sequence* sequence, int k, const ReferenceScene* before) {
    if (k == 0) {
        return sequence->step[0];
    }
    ReferenceScene scene = scene_after(before), changes = sequence->step[k];
    for (int i = 0; i < REFERENCE_DOUBLES; i++) {
        const double value = *scene_value(&changes, i);
        if (!isnan(value)) {
            *scene_value(&scene, i) = value;
        }
    }
    return scene;
}

// By their numbers from 1 on.
static const char* const METHODS[] = {"collocation", "cvode", "backwardEuler",
                                      "trapezoid",   "rk4",   "explicitEuler"};
enum { METHOD_COUNT = sizeof METHODS / sizeof *METHODS };

static bool read_method(const char* word, int* method) {
    for (int k = 0; strncmp(word, "method=", 7) == 0 && k < METHOD_COUNT; k++) {
        if (strcmp(word + 7, METHODS[k]) == 0) {
            *method = k + 1;
            return true;
        }
    }
    return false;
}

void sequence_text(const Sequence* sequence, char* text, size_t size) {
    size_t length = 0;
    if (sequence->method != 1) {
        length = (size_t)snprintf(text, size, "method=%s ", METHODS[sequence->method - 1]);
    }
    for (int k = 0; k < sequence->steps && length + 10 < size; k++) {
        const ReferenceScene usual = k == 0 ? reference_scene() : no_change();
        length += (size_t)snprintf(text + length, size - length, k == 0 ? "" : "then ");
        scene_text(&sequence->step[k], &usual, text + length, size - length);
        length += strlen(text + length);
    }
}

bool sequence_read(const char* text, Sequence* sequence, char* wrong, size_t size) {
    char copy[SEQUENCE_TEXT];
    snprintf(copy, sizeof copy, "%s", text);
    *sequence = (Sequence){.method = 1, .steps = 1, .step = {reference_scene()}};
    for (char* word = strtok(copy, " \n"); word != NULL; word = strtok(NULL, " \n")) {
        snprintf(wrong, size, "%s", word);
        if (strcmp(word, "then") == 0 && sequence->steps < MOST_STEPS) {
            sequence->step[sequence->steps++] = no_change();
        } else if (!read_method(word, &sequence->method) &&
                   !scene_read(word, &sequence->step[sequence->steps - 1])) {
            return false;
        }
    }
    return true;
}
