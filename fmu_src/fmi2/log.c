#include "fmi2/log.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

// The length of a message in bytes; longer ones are cut off. Chosen empirically: the longest FcMessage and
// its prefix fit. Half of it would cut messages.
enum { TEXT_SIZE = 512 };

unsigned fc_log_category_bit(fmi2String category) {
    for (unsigned i = 0; category && i < fc_log_categories_count; i++) {
        if (strcmp(category, fc_log_categories[i]) == 0) {
            return 1u << i;
        }
    }
    return 0;
}

unsigned fc_log_mask_quiet(void) {
    return fc_log_category_bit(FC_LOG_STATUS_ERROR) | fc_log_category_bit(FC_LOG_STATUS_WARNING);
}

unsigned fc_log_mask_all(void) { return (1u << fc_log_categories_count) - 1u; }

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

// The host's locale may have put a separator of one or more bytes in place of the decimal point.
static void restore_decimal_points(char* text) {
    char half[16];
    snprintf(half, sizeof half, "%.1f", 0.5); // 0, separator, 5
    const size_t width = strlen(half) - 2;
    if (half[1] == '.') {
        return;
    }
    char* to = text;
    for (const char* from = text; *from; to++) {
        const bool is_separator =
            from > text && is_digit(from[-1]) && strncmp(from, half + 1, width) == 0 && is_digit(from[width]);
        *to = is_separator ? '.' : *from;
        from += is_separator ? width : 1;
    }
    *to = '\0';
}

static void send_text(const fmi2CallbackFunctions* callbacks, fmi2String name, fmi2Status status,
                      fmi2String category, const char* function, const char* format, va_list arguments) {
    char text[TEXT_SIZE];
    const int prefix = snprintf(text, sizeof text, "%s: ", function);
    vsnprintf(text + prefix, sizeof text - (size_t)prefix, format, arguments);
    restore_decimal_points(text);

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

fmi2Status fc_refuse(const FcInstance* instance, FcCall call, const char* format, ...) {
    if (instance->callbacks.logger) {
        va_list arguments;
        va_start(arguments, format);
        send_text(&instance->callbacks, instance->name, fmi2Error, FC_LOG_STATUS_ERROR,
                  fc_call_table[call].function, format, arguments);
        va_end(arguments);
    }
    return fmi2Error;
}

bool fc_log_reaches(const FcInstance* instance, const char* category) {
    return instance->callbacks.logger && (instance->log_mask & fc_log_category_bit(category));
}

void fc_log_send(const FcInstance* instance, FcCall call, fmi2Status status, const char* category,
                 const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    send_text(&instance->callbacks, instance->name, status, category, fc_call_table[call].function, format,
              arguments);
    va_end(arguments);
}

void fc_log_refused_instance(const fmi2CallbackFunctions* callbacks, fmi2String name, const char* format,
                             ...) {
    if (callbacks && callbacks->logger) {
        va_list arguments;
        va_start(arguments, format);
        send_text(callbacks, name ? name : "", fmi2Error, FC_LOG_STATUS_ERROR,
                  fc_call_table[FC_CALL_INSTANTIATE].function, format, arguments);
        va_end(arguments);
    }
}

FcQuantityText fc_quantity_text(double value, const char* unit) {
    const bool without_unit = unit[0] == '\0' || strcmp(unit, "1") == 0;
    FcQuantityText quantity;
    snprintf(quantity.text, sizeof quantity.text, "%.15g%s%s", value, without_unit ? "" : " ",
             without_unit ? "" : unit);
    return quantity;
}
