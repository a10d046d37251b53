#include "fmi2_library.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#endif

static const struct {
    const char* name;
    size_t offset; // of its pointer in Fmi2Library
    bool is_needed;
} WANTED[] = {
#define ALWAYS(name) {"fmi2" #name, offsetof(Fmi2Library, name), true},
#define IF_ANY(name) {"fmi2" #name, offsetof(Fmi2Library, name), false},
    FMI2_COMMON_FUNCTIONS(ALWAYS) FMI2_CO_SIMULATION_FUNCTIONS(ALWAYS) FMI2_MODEL_EXCHANGE_FUNCTIONS(IF_ANY)};

static void one_line(char* text) {
    for (; *text; text++) {
        if (*text == '\n' || *text == '\r') {
            *text = ' ';
        }
    }
}

#ifdef _WIN32

static void* open_handle(const char* path, char* why, size_t size) {
    HMODULE handle = LoadLibraryA(path);
    if (!handle) {
        snprintf(why, size, "%s: can't be loaded (error %lu)", path, (unsigned long)GetLastError());
    }
    return handle;
}

static void find_function(void* handle, const char* name, void* target) {
    FARPROC function = GetProcAddress(handle, name);
    memcpy(target, &function, sizeof function);
}

static void close_handle(void* handle) { FreeLibrary(handle); }

#else

static void* open_handle(const char* path, char* why, size_t size) {
    void* handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!handle) {
        snprintf(why, size, "%s", dlerror());
        one_line(why);
    }
    return handle;
}

// ISO C has no conversion from what the loader gives to a function.
static void find_function(void* handle, const char* name, void* target) {
    void* function = dlsym(handle, name);
    memcpy(target, (const void*)&function, sizeof function);
}

static void close_handle(void* handle) { dlclose(handle); }

#endif

bool fmi2_library_open(Fmi2Library* library, const char* path, char* why, size_t size) {
    Fmi2Library opened = {.handle = open_handle(path, why, size)};
    if (!opened.handle) {
        return false;
    }
    for (size_t i = 0; i < sizeof WANTED / sizeof *WANTED; i++) {
        char* target = (char*)&opened + WANTED[i].offset;
        find_function(opened.handle, WANTED[i].name, target);
        static const char none[sizeof opened.DoStep];
        if (WANTED[i].is_needed && memcmp(target, none, sizeof none) == 0) {
            snprintf(why, size, "%s: lacks %s", path, WANTED[i].name);
            close_handle(opened.handle);
            return false;
        }
    }
    *library = opened;
    return true;
}

void fmi2_library_close(Fmi2Library* library) {
    if (library->handle) {
        close_handle(library->handle);
    }
    *library = (Fmi2Library){0};
}

static void keep_error(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status,
                       fmi2String category, fmi2String text, ...) {
    (void)name, (void)category;
    Fmi2Instance* instance = environment;
    if (status <= fmi2Warning || status == fmi2Pending) {
        return;
    }
    va_list arguments;
    va_start(arguments, text);
    vsnprintf(instance->said, sizeof instance->said, text, arguments);
    va_end(arguments);
    one_line(instance->said);
    instance->errors++;
}

bool fmi2_instance_make(Fmi2Instance* instance, const Fmi2Library* library, const char* name,
                        const char* guid, const char* resources) {
    return fmi2_instance_make_for(instance, library, fmi2CoSimulation, name, guid, resources);
}

bool fmi2_instance_make_for(Fmi2Instance* instance, const Fmi2Library* library, fmi2Type type,
                            const char* name, const char* guid, const char* resources) {
    *instance = (Fmi2Instance){
        .library = library,
        .callbacks = {keep_error, calloc, free, NULL, instance},
    };
    instance->component =
        library->Instantiate(name, type, guid, resources, &instance->callbacks, fmi2False, fmi2True);
    if (!instance->component && !instance->said[0]) {
        snprintf(instance->said, sizeof instance->said, "the FMU gives no instance, and no reason");
    }
    return instance->component != NULL;
}

void fmi2_instance_log_errors(Fmi2Instance* instance) {
    static const fmi2String errors[] = {"logStatusError"};
    const long before = instance->errors;
    instance->library->SetDebugLogging(instance->component, fmi2True, 1, errors);
    instance->errors = before;
    instance->said[0] = '\0';
}

void fmi2_instance_free(Fmi2Instance* instance) {
    if (instance->component) {
        instance->library->FreeInstance(instance->component);
        instance->component = NULL;
    }
}
