// The variables of modelDescription.xml, for the C code.
//
// modelDescription.xml is the only source: tools/packing/variable_table.py writes the table at build time,
// and fc_variables[value reference] is the variable with that reference.
#ifndef FC_FMI2_VARIABLES_H
#define FC_FMI2_VARIABLES_H

#include <stdbool.h>
#include <stddef.h>

#include "contact/friction_contact.h"

typedef enum {
    FC_TYPE_REAL,
    FC_TYPE_INTEGER,
    FC_TYPE_BOOLEAN,
    FC_TYPE_STRING,
    FC_TYPE_ENUMERATION
} FcVariableType;
typedef enum {
    FC_CAUSALITY_PARAMETER,
    FC_CAUSALITY_INPUT,
    FC_CAUSALITY_OUTPUT,
    FC_CAUSALITY_LOCAL,
    FC_CAUSALITY_INDEPENDENT // time
} FcCausality;
typedef enum { FC_VARIABILITY_FIXED, FC_VARIABILITY_TUNABLE, FC_VARIABILITY_CONTINUOUS } FcVariability;

typedef struct {
    const char* name;
    const char* unit; // "" for an enumeration
    FcVariableType type;
    FcCausality causality;
    FcVariability variability;
    bool has_start;              // an output has none: its value is computed
    double start;                // in unit
    double min;                  // in unit, inclusive; -DBL_MAX if the XML gives none
    double max;                  // in unit, inclusive; DBL_MAX if the XML gives none
    const char* const* literals; // names of the enumeration's values 1, 2, ...; NULL for other types
    size_t offset; // into FcVariables of friction_contact.h: a double for Real, an int for Enumeration
} FcVariableInfo;

extern const FcVariableInfo fc_variables[];
extern const unsigned fc_variables_count;
extern const unsigned fc_inputs[]; // value references of the inputs
extern const unsigned fc_inputs_count;

// A setting, the enumeration that decides whether it is used, and its items with which it is, as bits from
// the lowest on. Variables are value references here and below.
typedef struct {
    unsigned setting, decider, items;
} FcUse;
extern const FcUse fc_uses[];
extern const unsigned fc_uses_count;

// The range of likely magnitudes of a value other than 0.
typedef struct {
    unsigned variable;
    double low, high;
} FcLikely;
extern const FcLikely fc_likely[];
extern const unsigned fc_likely_count;

extern const unsigned fc_event_indicators_count; // numberOfEventIndicators of the XML

extern const char fc_guid[];             // guid of the packaged modelDescription.xml
extern const char fc_model_identifier[]; // modelIdentifier of the XML

extern const char* const fc_log_categories[]; // names under LogCategories
extern const unsigned fc_log_categories_count;

// Names under LogCategories of modelDescription.xml: the first three are defined by FMI, logSolver by this
// FMU.
#define FC_LOG_STATUS_ERROR "logStatusError"
#define FC_LOG_STATUS_WARNING "logStatusWarning"
#define FC_LOG_EVENTS "logEvents" // life cycle: instantiated, initialized, terminated
#define FC_LOG_SOLVER "logSolver" // number of evaluations

// The place of a variable's value, and its range.
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

// The rate of a state.
static inline bool fc_variable_is_rate(const FcVariableInfo* info) {
    return info->offset >= offsetof(FcVariables, der) &&
           info->offset < offsetof(FcVariables, der) + sizeof(FcStateRates);
}

// One of delta, W_f, Q_f, delta_y: the states of model exchange.
static inline bool fc_variable_is_state(const FcVariableInfo* info) {
    return info->offset == offsetof(FcVariables, delta) || info->offset == offsetof(FcVariables, W_f) ||
           info->offset == offsetof(FcVariables, Q_f) || info->offset == offsetof(FcVariables, delta_y);
}

// F_t_settled and F_y_settled, computed only if they are read.
static inline bool fc_variable_is_settled_force(const FcVariableInfo* info) {
    return info->offset == offsetof(FcVariables, F_t_settled) ||
           info->offset == offsetof(FcVariables, F_y_settled);
}

// The place of an input variable in the arrays of friction_contact.h; FC_INPUT_COUNT for any other variable.
static inline FcInput fc_variable_input(const FcVariableInfo* info) {
    FcVariables any;
    int input = 0;
    while (input < FC_INPUT_COUNT && fc_input_of(&any, (FcInput)input) != fc_variable_real(&any, info)) {
        input++;
    }
    return (FcInput)input;
}

#endif
