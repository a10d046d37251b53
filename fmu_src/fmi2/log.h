// Messages to the host: whole texts, filtered by the categories that modelDescription.xml declares.
//
// Errors always reach the logger, since a status without a reason helps nobody. Warnings do unless the host
// asks for other categories only. The other categories are silent until fmi2Instantiate or
// fmi2SetDebugLogging turns them on. The logger gets the finished text as its format, with '%' and '#'
// doubled as FMI 2.0 asks: hosts that format and hosts that print the format as it is show the same. Numbers
// have a decimal point in every locale. Nothing goes to stdout or stderr.
#ifndef FC_FMI2_LOG_H
#define FC_FMI2_LOG_H

#include "fmi2/instance.h"
#include "fmi2/variables.h"

// Logs "<function>: <text>" as an error and returns fmi2Error.
fmi2Status fc_refuse(const FcInstance* instance, FcCall call, const char* format, ...) FC_PRINTF_LIKE(3, 4);

// Logs "<function>: <text>" in the category, with the status that the function will return or a milder one.
// The numbers of the text are formatted only if the category is logged, since formatting costs as much as a
// short step.
#define fc_log(instance, call, status, category, ...)                                                        \
    do {                                                                                                     \
        if (fc_log_reaches(instance, category)) {                                                            \
            fc_log_send(instance, call, status, category, __VA_ARGS__);                                      \
        }                                                                                                    \
    } while (0)
bool fc_log_reaches(const FcInstance* instance, const char* category);
void fc_log_send(const FcInstance* instance, FcCall call, fmi2Status status, const char* category,
                 const char* format, ...) FC_PRINTF_LIKE(5, 6);

// The same before there is an instance.
void fc_log_refused_instance(const fmi2CallbackFunctions* callbacks, fmi2String name, const char* format, ...)
    FC_PRINTF_LIKE(3, 4);

// log_mask with debug logging off (errors and warnings) and on (everything).
unsigned fc_log_mask_quiet(void);
unsigned fc_log_mask_all(void);

// The bit of the category in log_mask; 0 if there is no such category or it is NULL.
unsigned fc_log_category_bit(fmi2String category);

// A value with 15 significant digits and its unit, unless that is "" or "1".
typedef struct {
    char text[48];
} FcQuantityText;
FcQuantityText fc_quantity_text(double value, const char* unit);

#endif
