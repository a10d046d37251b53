// What modelDescription.xml says of each variable, as the C code sees it.
//
// modelDescription.xml is the only source: frictionlab/packing/variable_table.py writes the table at build time,
// and fc_variables[value reference] is the variable with that reference.
#ifndef FC_FMI2_VARIABLES_H
#define FC_FMI2_VARIABLES_H

#include <stdbool.h>

#include <stddef.h>

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
    FC_CAUSALITY_LOCAL
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
    double min;                  // in unit, inclusive; -DBL_MAX where the XML gives none
    double max;                  // in unit, inclusive; DBL_MAX where the XML gives none
    const char* const* literals; // names of the enumeration's values 1, 2, ...; NULL for other types
    size_t offset; // into FcVariables of friction_contact.h: a double for Real, an int for Enumeration
} FcVariableInfo;

extern const FcVariableInfo fc_variables[];
extern const unsigned fc_variables_count;

extern const char fc_guid[];             // guid of the packaged modelDescription.xml
extern const char fc_model_identifier[]; // modelIdentifier of the XML

extern const char* const fc_log_categories[]; // names under LogCategories
extern const unsigned fc_log_categories_count;

#define FC_LOG_STATUS_ERROR "logStatusError"
#define FC_LOG_STATUS_WARNING "logStatusWarning"
#define FC_LOG_EVENTS "logEvents" // life cycle: instantiated, initialized, terminated
#define FC_LOG_SOLVER "logSolver" // messages of the numerical solver

#endif
