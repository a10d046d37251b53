#include "sequence.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2/variables.h"

// ---- Fields of a scene ----

#define FIELD(name, variable) {#name, #variable},
static const struct {
    const char *name, *variable; // of modelDescription.xml
} TABLE[] = {SCENE_FIELDS(FIELD)};
enum { FIELDS = sizeof TABLE / sizeof *TABLE };
_Static_assert(sizeof(ReferenceScene) == (FIELDS + 1) * sizeof(double), "a scene is its fields, and slips");

static double* field_of(ReferenceScene* scene, int k) { return (double*)(void*)scene + k; }

// The variable of a field; NULL for the step and rates.
static const FcVariableInfo* variable_of(int k) {
    for (unsigned vr = 0; vr < fc_variables_count; vr++) {
        if (strcmp(fc_variables[vr].name, TABLE[k].variable) == 0) {
            return &fc_variables[vr];
        }
    }
    return NULL;
}

// Its item's name if the field is a choice, which begin the table.
static const char* item_of(int k, double item) { return variable_of(k)->literals[(int)item - 1]; }
static bool is_choice(int k) { return variable_of(k) && variable_of(k)->literals; }

const char* law_name(double law) { return item_of(0, law); }
int laws(void) { return (int)variable_of(0)->max; }

void put_scene(const ReferenceScene* scene, FcVariables* variables) {
    ReferenceScene of = *scene;
    for (int k = 0; k < FIELDS; k++) {
        const FcVariableInfo* info = variable_of(k);
        if (info && info->literals) {
            *fc_variable_integer(variables, info) = (int)*field_of(&of, k);
        } else if (info) {
            *fc_variable_real(variables, info) = *field_of(&of, k);
        }
    }
}

ReferenceScene start_values(void) {
    ReferenceScene scene = {.h = 1e-4};
    for (int k = 0; k < FIELDS; k++) {
        const FcVariableInfo* info = variable_of(k);
        *field_of(&scene, k) = info ? info->start : *field_of(&scene, k);
    }
    return scene;
}

ReferenceScene scene_after(const ReferenceScene* before) {
    ReferenceScene s = *before;
    s.start = before->start + before->h;
    s.V += before->V_rate * before->h;
    s.F += before->F_rate * before->h;
    s.V_y += before->V_y_rate * before->h;
    s.d += before->d_rate * before->h;
    // As the FMU carries them on: a load that falls nearly to 0 has no digits to lose.
    s.E = fma(before->E_rate, before->h, s.E);
    s.load = fma(before->load_rate, before->h, s.load);
    s.V_rate = s.V_y_rate = s.d_rate = s.E_rate = s.load_rate = s.F_rate = 0.0;
    s.initial = START_GIVEN;
    return s;
}

// ---- Text ----

void sequence_text(const Sequence* sequence, char* text, size_t size) {
    size_t length = (size_t)snprintf(text, size, "tolerance=%g ", sequence->tolerance);
    if (sequence->method != 1) {
        length += (size_t)snprintf(text + length, size - length, "method=%d ", sequence->method);
    }
    for (int step = 0; step < sequence->steps; step++) {
        ReferenceScene usual = step == 0 ? start_values() : scene_after(&sequence->step[step - 1]);
        ReferenceScene scene = sequence->step[step];
        length += (size_t)snprintf(text + length, size - length, step == 0 ? "" : "then ");
        for (int k = 0; k < FIELDS && length + 100 < size; k++) {
            const double value = *field_of(&scene, k);
            if (value == *field_of(&usual, k)) {
                continue;
            }
            char word[40];
            snprintf(word, sizeof word, "%.15g", value);
            if (strtod(word, NULL) != value) {
                snprintf(word, sizeof word, "%.17g", value);
            }
            length += (size_t)snprintf(text + length, size - length, "%s=%s ", TABLE[k].name,
                                       is_choice(k) ? item_of(k, value) : word);
        }
    }
}

// Sets the field that the word name=value names. Returns false if there is none, or no such value.
static bool read_field(ReferenceScene* scene, const char* word) {
    char name[40], text[60], rest;
    int k = 0;
    if (sscanf(word, "%39[^=]=%59s", name, text) != 2) {
        return false;
    }
    while (k < FIELDS && strcmp(name, TABLE[k].name) != 0 && strcmp(name, TABLE[k].variable) != 0) {
        k++;
    }
    if (k < FIELDS && is_choice(k)) {
        const double items = variable_of(k)->max;
        double item = 1.0;
        while (item <= items && strcmp(text, item_of(k, item)) != 0) {
            item += 1.0;
        }
        *field_of(scene, k) = fmin(item, items);
        return item <= items;
    }
    return k < FIELDS && sscanf(text, "%lf%c", field_of(scene, k), &rest) == 1;
}

Sequence sequence_read(const char* text) {
    char copy[SEQUENCE_TEXT];
    snprintf(copy, sizeof copy, "%s", text);
    Sequence sequence = {.tolerance = 1e-4, .method = 1, .steps = 1, .step = {start_values()}};
    for (char* word = strtok(copy, " \n"); word != NULL; word = strtok(NULL, " \n")) {
        ReferenceScene* last = &sequence.step[sequence.steps - 1];
        if (strcmp(word, "then") == 0 && sequence.steps < MAX_STEPS) {
            sequence.step[sequence.steps++] = scene_after(last);
        } else if (sscanf(word, "method=%d", &sequence.method) != 1 &&
                   sscanf(word, "tolerance=%lf", &sequence.tolerance) != 1 && !read_field(last, word)) {
            fprintf(stderr, "hunt: %s is not a name=value of a scene\n", word);
            exit(2);
        }
    }
    return sequence;
}

void with_word(char* changed, const char* text, size_t begin, const char* word) {
    snprintf(changed, SEQUENCE_TEXT, "%.*s%s%s", (int)begin, text, word,
             text + begin + strcspn(text + begin, " ") + 1);
}

// Makes the word that begins there plain; returns whether it could.
static bool make_word_plain(char* text, size_t begin, StillShows* shows) {
    static const int DIGITS[] = {0, 1, 2, 3, 5, 8, 12}; // 0: without the word
    const size_t length = strcspn(text + begin, " ") + 1;
    int name;
    double value;
    const bool is_number = sscanf(text + begin, "%*[^= ]=%n%lf", &name, &value) == 1;
    for (int k = 0; k < (is_number ? 7 : 1); k++) {
        char plainer[SEQUENCE_TEXT], word[100] = "";
        if (k > 0) {
            snprintf(word, sizeof word, "%.*s%.*g ", name, text + begin, DIGITS[k], value);
        }
        with_word(plainer, text, begin, word);
        const Sequence sequence = sequence_read(plainer);
        if (strlen(word) < length && shows(&sequence)) {
            strcpy(text, plainer);
            return true;
        }
    }
    return false;
}

void make_plain(char* text, StillShows* shows) {
    for (bool changed = true; changed;) {
        changed = false;
        for (size_t begin = strcspn(text, " ") + 1; text[begin];) { // after the tolerance
            if (make_word_plain(text, begin, shows)) {
                changed = true;
            } else {
                begin += strcspn(text + begin, " ") + 1;
            }
        }
    }
}
