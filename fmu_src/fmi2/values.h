// Where the value of a variable lies, and which values it may take.
#ifndef FC_VALUES_H
#define FC_VALUES_H

#include "fmi2/variables.h"
#include "friction_contact.h"

static inline double* variable_real(Variables* variables, const VariableInfo* info) {
    return (double*)(void*)((char*)variables + info->offset);
}

static inline int* variable_integer(Variables* variables, const VariableInfo* info) {
    return (int*)(void*)((char*)variables + info->offset);
}

// Finite and within min and max, whose defaults are the largest finite numbers.
static inline int variable_allows(const VariableInfo* info, double value) {
    return value >= info->min && value <= info->max;
}

// The place of an input variable in the arrays of friction_contact.h; INPUT_COUNT for any other variable.
static inline Input variable_input(const VariableInfo* info) {
    switch (info->offset) {
    case offsetof(Variables, V):
        return INPUT_V;
    case offsetof(Variables, d):
        return INPUT_D;
    case offsetof(Variables, E):
        return INPUT_E;
    default:
        return INPUT_COUNT;
    }
}

#endif
