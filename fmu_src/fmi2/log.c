#include "fmi2/log.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { TEXT_SIZE = 512 };

unsigned log_category_bit(fmi2String category) {
    for (unsigned i = 0; category && i < variables_log_categories_count; i++) {
        if (strcmp(category, variables_log_categories[i]) == 0) {
            return 1u << i;
        }
    }
    return 0;
}

unsigned log_mask_quiet(void) {
    return log_category_bit(LOG_STATUS_ERROR) | log_category_bit(LOG_STATUS_WARNING);
}

unsigned log_mask_all(void) { return (1u << variables_log_categories_count) - 1u; }

static void send(const fmi2CallbackFunctions* callbacks, fmi2String name, fmi2Status status,
                 fmi2String category, const char* function, const char* format, va_list arguments) {
    char text[TEXT_SIZE];
    const int prefix = snprintf(text, sizeof text, "%s: ", function);
    vsnprintf(text + prefix, sizeof text - (size_t)prefix, format, arguments);

    char escaped[2 * TEXT_SIZE];
    size_t length = 0;
    for (const char* c = text; *c; c++) {
        if (*c == '%' || *c == '#') {
            escaped[length++] = *c;
        }
        escaped[length++] = *c;
    }
    escaped[length] = '\0';
    callbacks->logger(callbacks->componentEnvironment, name, status, category, escaped);
}

fmi2Status refuse(const Instance* instance, Call call, const char* format, ...) {
    if (instance->callbacks.logger) {
        va_list arguments;
        va_start(arguments, format);
        send(&instance->callbacks, instance->name, fmi2Error, LOG_STATUS_ERROR, call_table[call].function,
             format, arguments);
        va_end(arguments);
    }
    return fmi2Error;
}

void log_text(const Instance* instance, Call call, fmi2Status status, const char* category,
              const char* format, ...) {
    if (instance->callbacks.logger && (instance->log_mask & log_category_bit(category))) {
        va_list arguments;
        va_start(arguments, format);
        send(&instance->callbacks, instance->name, status, category, call_table[call].function, format,
             arguments);
        va_end(arguments);
    }
}

void log_refused_instance(const fmi2CallbackFunctions* callbacks, fmi2String name, const char* format, ...) {
    if (callbacks && callbacks->logger) {
        va_list arguments;
        va_start(arguments, format);
        send(callbacks, name ? name : "", fmi2Error, LOG_STATUS_ERROR, call_table[CALL_INSTANTIATE].function,
             format, arguments);
        va_end(arguments);
    }
}

QuantityText quantity_text(double value, const char* unit) {
    char printed[32];
    snprintf(printed, sizeof printed, "%.15g", value);

    // The host's locale may have put a separator of one or more bytes where the point belongs.
    QuantityText quantity;
    size_t length = 0;
    for (const char* c = printed; *c; c++) {
        if (strchr("0123456789+-einfa", *c)) {
            quantity.text[length++] = *c;
        } else if (length > 0 && quantity.text[length - 1] != '.') {
            quantity.text[length++] = '.';
        }
    }
    quantity.text[length] = '\0';
    if (unit[0] != '\0' && strcmp(unit, "1") != 0) {
        snprintf(quantity.text + length, sizeof quantity.text - length, " %s", unit);
    }
    return quantity;
}
