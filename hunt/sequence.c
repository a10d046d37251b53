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
static const Field TABLE[FIELDS] = {
    NUMBER(start, 0.0), NUMBER(h, 1e-4), NUMBER(V, 0.005), NUMBER(d, 14e-6), NUMBER(E, 58.556936170e9),
    NUMBER(load, 312.44), NUMBER(V_rate, 0.0), NUMBER(d_rate, 0.0), NUMBER(E_rate, 0.0), NUMBER(load_rate, 0.0),
    NUMBER(f, 20e3), NUMBER(V_1, 0.0), NUMBER(a_d, 0.0), NUMBER(phase_d, 0.0), NUMBER(V_y, 0.0), NUMBER(V_y_rate, 0.0),
    NUMBER(V_2, 0.0), NUMBER(phase_2, 0.0), NUMBER(delta_y_0, 0.0), NUMBER(F_C, 55.0), NUMBER(mu, 0.176),
    NUMBER(staticRatio, 1.0), NUMBER(V_S, 0.01), NUMBER(sigma_1, 0.0), NUMBER(sigma_2, 0.0), NUMBER(delta_0, 0.0),
    NUMBER(contact_sigma, 2.5e6), NUMBER(stiffnessScale, 1.0), NUMBER(R_q, 6e-6), NUMBER(R, 1.7e-6), NUMBER(eta, 47e9),
    NUMBER(A_n, 1e-4), NUMBER(nu, 0.33), NUMBER(Y, 410e6), NUMBER(c, 17.0), NUMBER(lambda, 3.0),
    {"law", offsetof(ReferenceScene, law), LAW_DAHL, LAW_NAMES},
    {"limit", offsetof(ReferenceScene, limit), LIMIT_CONSTANT, LIMITS},
    {"contact", offsetof(ReferenceScene, contact), CONTACT_ASPERITIES, CONTACTS},
    {"input", offsetof(ReferenceScene, input), INPUT_SEPARATION, INPUTS},
    {"initial", offsetof(ReferenceScene, initial), START_GIVEN, STARTS},
};
// clang-format on
#undef NUMBER

double scene_get(const ReferenceScene* scene, int field) {
    const void* place = (const char*)scene + TABLE[field].offset;
    return TABLE[field].choices ? (double)*(const int*)place : *(const double*)place;
}

void scene_set(ReferenceScene* scene, int field, double value) {
    void* place = (char*)scene + TABLE[field].offset;
    if (TABLE[field].choices) {
        *(int*)place = (int)value;
    } else {
        *(double*)place = value;
    }
}

ReferenceScene start_values(void) {
    ReferenceScene scene = {0};
    for (int k = 0; k < FIELDS; k++) {
        scene_set(&scene, k, TABLE[k].start_value);
    }
    return scene;
}

// The same number, or both none.
static bool are_same(double a, double b) { return a == b || (isnan(a) && isnan(b)); }

// ---------------------------------------------------------------------------------------------------------------------
// Steps
// ---------------------------------------------------------------------------------------------------------------------

ReferenceScene scene_after(const ReferenceScene* before) {
    ReferenceScene s = *before;
    s.start = before->start + before->h;
    s.V += before->V_rate * before->h;
    s.V_y += before->V_y_rate * before->h;
    s.d += before->d_rate * before->h;
    s.E += before->E_rate * before->h;
    s.load += before->load_rate * before->h;
    s.V_rate = s.V_y_rate = s.d_rate = s.E_rate = s.load_rate = 0.0;
    s.initial = START_GIVEN;
    return s;
}

ReferenceScene changes_between(const ReferenceScene* left, const ReferenceScene* scene) {
    ReferenceScene changes = {0};
    for (int k = 0; k < REFERENCE_DOUBLES; k++) {
        const double value = scene_get(scene, k);
        scene_set(&changes, k, are_same(value, scene_get(left, k)) ? NAN : value);
    }
    return changes;
}

static ReferenceScene no_change(void) {
    const ReferenceScene any = {0};
    return changes_between(&any, &any);
}

ReferenceScene sequence_scene(const Sequence* sequence, int k, const ReferenceScene* before) {
    if (k == 0) {
        return sequence->step[0];
    }
    ReferenceScene scene = scene_after(before);
    for (int i = 0; i < REFERENCE_DOUBLES; i++) {
        const double value = scene_get(&sequence->step[k], i);
        scene_set(&scene, i, isnan(value) ? scene_get(&scene, i) : value);
    }
    return scene;
}

static ReferenceScene usual_step(int step) { return step == 0 ? start_values() : no_change(); }

// ---------------------------------------------------------------------------------------------------------------------
// Text
// ---------------------------------------------------------------------------------------------------------------------

void sequence_text(const Sequence* sequence, char* text, size_t size) {
    size_t length = (size_t)snprintf(text, size, "tolerance=%g ", sequence->tolerance);
    if (sequence->method != 1) {
        length += (size_t)snprintf(text + length, size - length, "method=%d ", sequence->method);
    }
    for (int step = 0; step < sequence->steps; step++) {
        const ReferenceScene usual = usual_step(step);
        length += (size_t)snprintf(text + length, size - length, step == 0 ? "" : "then ");
        for (int k = 0; k < FIELDS && length + 100 < size; k++) {
            const int field = (k + LAW_FIELD) % FIELDS; // the enumerations first
            const double value = scene_get(&sequence->step[step], field);
            if (are_same(value, scene_get(&usual, field))) {
                continue;
            }
            char word[40];
            for (int digits = 6; digits <= 17; digits++) { // as few as give the same number again
                snprintf(word, sizeof word, "%.*g", digits, value);
                if (strtod(word, NULL) == value) {
                    break;
                }
            }
            const char* const* choices = TABLE[field].choices;
            length += (size_t)snprintf(text + length, size - length, "%s=%s ", TABLE[field].name,
                                       choices ? choices[(int)value - 1] : word);
        }
    }
}

// Sets the field that the word name=value names.
static bool read_field(ReferenceScene* scene, const char* word) {
    const size_t name = strcspn(word, "=");
    const char* value = word + name + (word[name] == '=');
    for (int k = 0; k < FIELDS; k++) {
        if (strlen(TABLE[k].name) != name || strncmp(word, TABLE[k].name, name) != 0) {
            continue;
        }
        char* end;
        const char* const* choices = TABLE[k].choices;
        for (int j = 0; choices && choices[j]; j++) {
            if (strcmp(value, choices[j]) == 0) {
                scene_set(scene, k, j + 1);
                return true;
            }
        }
        const double number = strtod(value, &end);
        if (choices || end == value || *end) {
            return false;
        }
        scene_set(scene, k, number);
        return true;
    }
    return false;
}

bool sequence_read(const char* text, Sequence* sequence, char* wrong, size_t size) {
    char copy[SEQUENCE_TEXT];
    snprintf(copy, sizeof copy, "%s", text);
    *sequence = (Sequence){.tolerance = 1e-4, .method = 1, .steps = 1, .step = {start_values()}};
    for (char* word = strtok(copy, " \n"); word != NULL; word = strtok(NULL, " \n")) {
        snprintf(wrong, size, "%s", word);
        if (strcmp(word, "then") == 0 && sequence->steps < MOST_STEPS) {
            sequence->step[sequence->steps++] = no_change();
        } else if (sscanf(word, "method=%d", &sequence->method) != 1 &&
                   sscanf(word, "tolerance=%lf", &sequence->tolerance) != 1 &&
                   !read_field(&sequence->step[sequence->steps - 1], word)) {
            return false;
        }
    }
    return true;
}

// ---------------------------------------------------------------------------------------------------------------------
// Plainer
// ---------------------------------------------------------------------------------------------------------------------

// Takes the plainer sequence if it still shows the miss.
static bool keep(Sequence* plain, const Sequence* plainer, StillShows* shows) {
    const bool kept = shows(plainer);
    *plain = kept ? *plainer : *plain;
    return kept;
}

// Tries the start value, then ever more digits.
static bool simplify_field(Sequence* plain, int step, int field, StillShows* shows) {
    static const int DIGITS[] = {0, 1, 2, 3, 5, 8, 12};
    const ReferenceScene base = usual_step(step);
    const double value = scene_get(&plain->step[step], field), usual = scene_get(&base, field);
    const int tries = field < REFERENCE_DOUBLES ? sizeof DIGITS / sizeof *DIGITS : 1;
    for (int k = 0; k < tries && !are_same(value, usual); k++) {
        char text[40];
        snprintf(text, sizeof text, "%.*g", DIGITS[k], value);
        const double plainer = k == 0 ? usual : strtod(text, NULL);
        Sequence changed = *plain;
        scene_set(&changed.step[step], field, plainer);
        if (plainer == value) { // it has so few digits already
            return false;
        }
        if (keep(plain, &changed, shows)) {
            return true;
        }
    }
    return false;
}

Sequence minimized(const Sequence* sequence, StillShows* shows) {
    Sequence plain = *sequence;
    for (bool changed = true; changed;) {
        Sequence fewer = plain;
        fewer.steps--;
        changed = fewer.steps > 0 && keep(&plain, &fewer, shows);
        for (int step = 0; step < plain.steps; step++) {
            for (int k = 0; k < (step == 0 ? FIELDS : LAW_FIELD); k++) {
                changed = (k != LAW_FIELD && simplify_field(&plain, step, k, shows)) || changed;
            }
        }
    }
    return plain;
}
