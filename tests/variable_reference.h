// The value reference of a variable, by its place in FcVariables: reference_of(offsetof(FcVariables, vibration.f)).
#ifndef FC_TESTS_VARIABLE_REFERENCE_H
#define FC_TESTS_VARIABLE_REFERENCE_H

#include <stddef.h>

#include "contact/friction_contact.h"
#include "fmi2/variables.h"
#include "fmi2TypesPlatform.h"

static inline fmi2ValueReference reference_of(size_t offset) {
    fmi2ValueReference vr = 0;
    while (fc_variables[vr].offset != offset) {
        vr++;
    }
    return vr;
}

#endif
