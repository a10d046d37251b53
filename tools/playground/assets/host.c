// What a page needs around the FMU: one instance, its last error message, and memory to pass numbers through.
//
// Compiled with the sources of the FMU into WebAssembly that imports nothing. A page calls the fmi2 functions
// themselves; a logger it can't give, since a function of JavaScript is no function of C.
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "fmi2/variables.h"
#include "fmi2Functions.h"

#define EXPORT __attribute__((visibility("default")))

enum { MESSAGE_SIZE = 1024, ROOM = 64 };

static char message[MESSAGE_SIZE];
static double numbers[ROOM];
static fmi2ValueReference references[ROOM];

static void keep_error(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status,
                       fmi2String category, fmi2String format, ...) {
    (void)environment;
    (void)name;
    (void)category;
    if (status < fmi2Error) {
        return;
    }
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
}

static const fmi2CallbackFunctions callbacks = {keep_error, calloc, free, NULL, NULL};

// A new instance, or NULL.
EXPORT fmi2Component host_instantiate(void) {
    return fmi2Instantiate("page", fmi2CoSimulation, fc_guid, NULL, &callbacks, fmi2False, fmi2False);
}

// The message of the last call that gave fmi2Error.
EXPORT const char* host_message(void) { return message; }

// Room for 64 values and as many value references of one call.
EXPORT double* host_numbers(void) { return numbers; }
EXPORT fmi2ValueReference* host_references(void) { return references; }
