// Where the value of a variable lies, and which values it may take.
#ifndef FC_FMI2_VALUES_H
#define FC_FMI2_VALUES_H

#include "fmi2/variables.h"
#include "friction_contact.h"

static inline double* fc_variable_real(FcVariables* variables, const FcVariableInfo* info) {
    return (double*)(void*)((char*)variables + info->offset);
}

static inline int* fc_variable_integer(FcVariables* variables, const FcVariableInfo* info) {
    return (int*)(void*)((char*)variables + info->offset);
}

static inline double fc_variable_value(const FcVariables* variables, const FcVariableInfo* info) {
    const void* place = (const char*)variables + info->offset;
    return info->type == FC_TYPE_REAL ? *(const double*)place : *(const int*)place;
}

// Finite and within min and max, whose defaults are the largest finite numbers.
static inline int fc_variable_allows(const FcVariableInfo* info, double value) {
    return value >= info->min && value <= info->max;
}

// The place of an input variable in the arrays of friction_contact.h; FC_INPUT_COUNT for any other variable.
static inline FcInput fc_variable_input(const FcVariableInfo* info) {
    switch (info->offset) {
    case offsetof(FcVariables, V):
        return FC_INPUT_V;
    case offsetof(FcVariables, d):
        return FC_INPUT_D;
    case offsetof(FcVariables, E):
        return FC_INPUT_E;
    case offsetof(FcVariables, load):
        return FC_INPUT_LOAD;
    default:
        return FC_INPUT_COUNT;
    }
}

#endif
