#include "sequence.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---------------------------------------------------------------------------------------------------------------------
// Fields of a scene
// ---------------------------------------------------------------------------------------------------------------------

const char* const LAW_NAMES[] = {"Dahl", "Coulomb", "ElasticPlastic", "LuGre", NULL};
static const char* const LIMITS[] = {"Constant", "Load", NULL};
static const char* const CONTACTS[] = {"Asperities", "Constant", "Mindlin", NULL};
static const char* const INPUTS[] = {"Separation", "Load", NULL};
static const char* const STARTS[] = {"Given", "Settled", NULL};

typedef struct {
    const char* name;
    size_t offset;
    double start_value;
    const char* const* choices; // of the numbers 1, 2, ..; NULL for a double
} Field;

#define NUMBER(name, start_value) {#name, offsetof(ReferenceScene, name), start_value, NULL}
// clang-format off
static const Field TABLE[] = {
    {"law", offsetof(ReferenceScene, law), LAW_DAHL, LAW_NAMES},
    {"limit", offsetof(ReferenceScene, limit), LIMIT_CONSTANT, LIMITS},
    {"contact", offsetof(ReferenceScene, contact), CONTACT_ASPERITIES, CONTACTS},
    {"input", offsetof(ReferenceScene, input), INPUT_SEPARATION, INPUTS},
    {"initial", offsetof(ReferenceScene, initial), START_GIVEN, STARTS},
    NUMBER(start, 0.0), NUMBER(h, 1e-4), NUMBER(V, 0.005), NUMBER(d, 14e-6), NUMBER(E, 58.556936170e9),
    NUMBER(load, 312.44), NUMBER(V_rate, 0.0), NUMBER(d_rate, 0.0), NUMBER(E_rate, 0.0), NUMBER(load_rate, 0.0),
    NUMBER(f, 20e3), NUMBER(V_1, 0.0), NUMBER(a_d, 0.0), NUMBER(phase_d, 0.0), NUMBER(V_y, 0.0), NUMBER(V_y_rate, 0.0),
    NUMBER(V_2, 0.0), NUMBER(phase_2, 0.0), NUMBER(delta_y_0, 0.0), NUMBER(F_C, 55.0), NUMBER(mu, 0.176),
    NUMBER(staticRatio, 1.0), NUMBER(V_S, 0.01), NUMBER(sigma_1, 0.0), NUMBER(sigma_2, 0.0), NUMBER(delta_0, 0.0),
    NUMBER(contact_sigma, 2.5e6), NUMBER(stiffnessScale, 1.0), NUMBER(R_q, 6e-6), NUMBER(R, 1.7e-6), NUMBER(eta, 47e9),
    NUMBER(A_n, 1e-4), NUMBER(nu, 0.33), NUMBER(Y, 410e6), NUMBER(c, 17.0), NUMBER(lambda, 3.0),
};
// clang-format on
#undef NUMBER
enum { FIELDS = sizeof TABLE / sizeof *TABLE };

static double get(const ReferenceScene* scene, const Field* field) {
    const void* place = (const char*)scene + field->offset;
    return field->choices ? (double)*(const int*)place : *(const double*)place;
}

static void set(ReferenceScene* scene, const Field* field, double value) {
    void* place = (char*)scene + field->offset;
    if (field->choices) {
        *(int*)place = (int)value;
    } else {
        *(double*)place = value;
    }
}

ReferenceScene start_values(void) {
    ReferenceScene scene = {0};
    for (int k = 0; k < FIELDS; k++) {
        set(&scene, &TABLE[k], TABLE[k].start_value);
    }
    return scene;
}

ReferenceScene scene_after(const ReferenceScene* before) {
    ReferenceScene s = *before;
    s.start = before->start + before->h;
    s.V += before->V_rate * before->h;
    s.V_y += before->V_y_rate * before->h;
    s.d += before->d_rate * before->h;
    // As the FMU carries them on: a load that falls nearly to 0 has no digits to lose.
    s.E = fma(before->E_rate, before->h, s.E);
    s.load = fma(before->load_rate, before->h, s.load);
    s.V_rate = s.V_y_rate = s.d_rate = s.E_rate = s.load_rate = 0.0;
    s.initial = START_GIVEN;
    return s;
}

// ---------------------------------------------------------------------------------------------------------------------
// Text
// ---------------------------------------------------------------------------------------------------------------------

void sequence_text(const Sequence* sequence, char* text, size_t size) {
    size_t length = (size_t)snprintf(text, size, "tolerance=%g ", sequence->tolerance);
    if (sequence->method != 1) {
        length += (size_t)snprintf(text + length, size - length, "method=%d ", sequence->method);
    }
    for (int step = 0; step < sequence->steps; step++) {
        const ReferenceScene usual = step == 0 ? start_values() : scene_after(&sequence->step[step - 1]);
        length += (size_t)snprintf(text + length, size - length, step == 0 ? "" : "then ");
        for (int k = 0; k < FIELDS && length + 100 < size; k++) {
            const Field* field = &TABLE[k];
            const double value = get(&sequence->step[step], field);
            if (value == get(&usual, field)) {
                continue;
            }
            char word[40];
            for (int digits = 6; digits <= 17; digits++) { // as few as give the same number again
                snprintf(word, sizeof word, "%.*g", digits, value);
                if (strtod(word, NULL) == value) {
                    break;
                }
            }
            length += (size_t)snprintf(text + length, size - length, "%s=%s ", field->name,
                                       field->choices ? field->choices[(int)value - 1] : word);
        }
    }
}

// Sets the field that the word name=value names. Returns false if there is none, or no such value.
static bool read_field(ReferenceScene* scene, const char* word) {
    const size_t name = strcspn(word, "=");
    const char* value = word + name + (word[name] == '=');
    for (const Field* field = TABLE; field < TABLE + FIELDS; field++) {
        if (strlen(field->name) != name || strncmp(word, field->name, name) != 0) {
            continue;
        }
        for (int j = 0; field->choices && field->choices[j]; j++) {
            if (strcmp(value, field->choices[j]) == 0) {
                set(scene, field, j + 1);
                return true;
            }
        }
        char* end;
        const double number = strtod(value, &end);
        const bool is_number = !field->choices && end != value && *end == '\0';
        set(scene, field, is_number ? number : 1.0);
        return is_number;
    }
    return false;
}

Sequence sequence_read(const char* text) {
    char copy[SEQUENCE_TEXT];
    snprintf(copy, sizeof copy, "%s", text);
    Sequence sequence = {.tolerance = 1e-4, .method = 1, .steps = 1, .step = {start_values()}};
    for (char* word = strtok(copy, " \n"); word != NULL; word = strtok(NULL, " \n")) {
        ReferenceScene* last = &sequence.step[sequence.steps - 1];
        if (strcmp(word, "then") == 0 && sequence.steps < MOST_STEPS) {
            sequence.step[sequence.steps++] = scene_after(last);
        } else if (sscanf(word, "method=%d", &sequence.method) != 1 &&
                   sscanf(word, "tolerance=%lf", &sequence.tolerance) != 1 && !read_field(last, word)) {
            fprintf(stderr, "hunt: %s is not a name=value of a scene\n", word);
            exit(2);
        }
    }
    return sequence;
}

// Puts another word, or none, in place of a part of the text, if it still shows the miss.
static bool replace(char* text, size_t begin, size_t length, const char* word, StillShows* shows) {
    char plainer[SEQUENCE_TEXT];
    snprintf(plainer, sizeof plainer, "%.*s%s%s", (int)begin, text, word, text + begin + length);
    const Sequence sequence = sequence_read(plainer);
    const bool still = shows(&sequence);
    if (still) {
        strcpy(text, plainer);
    }
    return still;
}

void make_plain(char* text, StillShows* shows) {
    static const int DIGITS[] = {1, 2, 3, 5, 8, 12};
    for (bool changed = true; changed;) {
        changed = false;
        size_t begin = strcspn(text, " ") + 1; // after the tolerance
        while (text[begin]) {
            const size_t length = strcspn(text + begin, " ") + 1;
            if (replace(text, begin, length, "", shows)) {
                changed = true;
                continue;
            }
            char word[100];
            snprintf(word, sizeof word, "%.*s", (int)length, text + begin);
            int name;
            double value;
            const bool is_number = sscanf(word, "%*[^=]=%n%lf", &name, &value) == 1;
            for (size_t k = 0; is_number && k < sizeof DIGITS / sizeof *DIGITS; k++) {
                snprintf(word + name, sizeof word - (size_t)name, "%.*g ", DIGITS[k], value);
                if (strlen(word) < length && replace(text, begin, length, word, shows)) {
                    changed = true;
                    break;
                }
            }
            begin += strcspn(text + begin, " ") + 1;
        }
    }
}
