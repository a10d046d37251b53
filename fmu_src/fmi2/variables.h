// What modelDescription.xml says of each variable, as the C code sees it.
//
// modelDescription.xml is the only source: cmake/generate_variables.py writes the table at build time,
// and variables_table[value reference] is the variable with that reference.
#ifndef FC_VARIABLES_H
#define FC_VARIABLES_H

#include <stddef.h>

typedef enum { TYPE_REAL, TYPE_INTEGER, TYPE_BOOLEAN, TYPE_STRING, TYPE_ENUMERATION } VariableType;
typedef enum { CAUSALITY_PARAMETER, CAUSALITY_INPUT, CAUSALITY_OUTPUT, CAUSALITY_LOCAL } Causality;
typedef enum { VARIABILITY_FIXED, VARIABILITY_TUNABLE, VARIABILITY_CONTINUOUS } Variability;

typedef struct {
    const char* name;
    const char* unit; // "" for an enumeration
    VariableType type;
    Causality causality;
    Variability variability;
    int has_start;               // an output has none: its value is computed
    double start;                // in unit
    double min;                  // in unit, inclusive; -DBL_MAX where the XML gives none
    double max;                  // in unit, inclusive; DBL_MAX where the XML gives none
    const char* const* literals; // names of the enumeration's values 1, 2, ...; NULL for other types
    size_t offset; // into Variables of friction_contact.h: a double for Real, an int for Enumeration
} VariableInfo;

extern const VariableInfo variables_table[];
extern const unsigned variables_count;

extern const char variables_guid[];             // guid of the packaged modelDescription.xml
extern const char variables_model_identifier[]; // modelIdentifier of the XML

extern const char* const variables_log_categories[]; // names under LogCategories
extern const unsigned variables_log_categories_count;

#define LOG_STATUS_ERROR "logStatusError"
#define LOG_STATUS_WARNING "logStatusWarning"
#define LOG_EVENTS "logEvents" // life cycle: instantiated, initialized, terminated
#define LOG_SOLVER "logSolver" // messages of the numerical solver

#endif
