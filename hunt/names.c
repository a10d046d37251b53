#include "names.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

_Static_assert(sizeof(ReferenceScene) >= REFERENCE_DOUBLES * sizeof(double) + 6 * sizeof(int) &&
                   offsetof(ReferenceScene, law) == REFERENCE_DOUBLES * sizeof(double),
               "SCENE_NAMES names every double of ReferenceScene in its order");

// clang-format off
const char* const SCENE_NAMES[REFERENCE_DOUBLES] = {
    "start", "h", "V", "d", "E", "load", "V_rate", "d_rate", "E_rate", "load_rate", "f", "V_1", "a_d", "phase_d",
    "F_C", "mu", "staticRatio", "V_S", "sigma_1", "sigma_2", "delta_0", "contact_sigma", "stiffnessScale",
    "R_q", "R", "eta", "A_n", "nu", "Y", "c", "lambda"};
// clang-format on

typedef struct {
    const char* name;
    size_t offset;
    const char* choices[5]; // of the numbers 1, 2, ..
} Choice;

static const Choice CHOICES[] = {
    {"law", offsetof(ReferenceScene, law), {"Dahl", "Coulomb", "ElasticPlastic", "LuGre"}},
    {"limit", offsetof(ReferenceScene, limit), {"Constant", "Load"}},
    {"contact", offsetof(ReferenceScene, contact), {"Asperities", "Constant", "Mindlin"}},
    {"input", offsetof(ReferenceScene, input), {"Separation", "Load"}},
    {"initial", offsetof(ReferenceScene, initial), {"Given", "Settled"}},
};
_Static_assert(sizeof CHOICES / sizeof *CHOICES == SCENE_CHOICES, "names.h says how many there are");

double* scene_value(ReferenceScene* scene, int index) { return (double*)(void*)scene + index; }

int* scene_choice(ReferenceScene* scene, int k) { return (int*)(void*)((char*)scene + CHOICES[k].offset); }

// As few digits as give the same number again.
static void number_text(double value, char* text, size_t size) {
    for (int digits = 6; digits <= 17; digits++) {
        snprintf(text, size, "%.*g", digits, value);
        if (strtod(text, NULL) == value) {
            break;
        }
    }
}

// The same number, or both none.
static bool are_same(double a, double b) { return a == b || (isnan(a) && isnan(b)); }

void scene_text(const ReferenceScene* scene, const ReferenceScene* usual, char* text, size_t size) {
    ReferenceScene mine = *scene, other = *usual;
    size_t length = 0;
    text[0] = '\0';
    for (int k = 0; k < SCENE_CHOICES && length < size; k++) {
        if (*scene_choice(&mine, k) != *scene_choice(&other, k)) {
            length += (size_t)snprintf(text + length, size - length, "%s=%s ", CHOICES[k].name,
                                       CHOICES[k].choices[*scene_choice(&mine, k) - 1]);
        }
    }
    for (int k = 0; k < REFERENCE_DOUBLES && length < size; k++) {
        if (!are_same(*scene_value(&mine, k), *scene_value(&other, k))) {
            char number[40];
            number_text(*scene_value(&mine, k), number, sizeof number);
            length += (size_t)snprintf(text + length, size - length, "%s=%s ", SCENE_NAMES[k], number);
        }
    }
}

static bool read_choice(ReferenceScene* scene, const char* name, const char* value) {
    for (int k = 0; k < SCENE_CHOICES; k++) {
        for (int j = 0; strcmp(name, CHOICES[k].name) == 0 && CHOICES[k].choices[j] != NULL; j++) {
            if (strcmp(value, CHOICES[k].choices[j]) == 0) {
                *scene_choice(scene, k) = j + 1;
                return true;
            }
        }
    }
    return false;
}

static bool read_number(ReferenceScene* scene, const char* name, const char* value) {
    for (int k = 0; k < REFERENCE_DOUBLES; k++) {
        char* end;
        if (strcmp(name, SCENE_NAMES[k]) == 0) {
            *scene_value(scene, k) = strtod(value, &end);
            return end != value && *end == '\0';
        }
    }
    return false;
}

bool scene_read(const char* word, ReferenceScene* scene) {
    char name[100];
    snprintf(name, sizeof name, "%s", word);
    char* equals = strchr(name, '=');
    if (equals == NULL) {
        return false;
    }
    *equals = '\0';
    return read_choice(scene, name, equals + 1) || read_number(scene, name, equals + 1);
}
