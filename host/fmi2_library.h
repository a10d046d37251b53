// The FMI 2.0 functions of an FMU as a table, loaded from its shared library or linked in, and an instance that keeps
// what the FMU says.
//
//     Fmi2Library fmu;
//     char why[FMI2_TEXT];
//     if (!fmi2_library_open(&fmu, "binaries/linux64/FrictionContact.so", why, sizeof why)) { ... why ... }
//     Fmi2Instance contact;
//     if (!fmi2_instance_make(&contact, &fmu, "contact", guid, NULL)) { ... contact.said ... }
//     if (fmu.DoStep(contact.component, 0.0, 1e-5, fmi2True) > fmi2Warning) { ... contact.said ... }
//     fmi2_instance_free(&contact);
//     fmi2_library_close(&fmu);
//
// A program that the FMU is linked into takes fmi2_linked (fmi2_linked.c) in place of an opened library.
#ifndef HOST_FMI2_LIBRARY_H
#define HOST_FMI2_LIBRARY_H

#include <stdbool.h>
#include <stddef.h>

#include "fmi2FunctionTypes.h"

enum { FMI2_TEXT = 512 }; // bytes of a message, its end included

// Every FMU has these.
#define FMI2_COMMON_FUNCTIONS(X)                                                                             \
    X(GetTypesPlatform)                                                                                      \
    X(GetVersion)                                                                                            \
    X(SetDebugLogging)                                                                                       \
    X(Instantiate)                                                                                           \
    X(FreeInstance)                                                                                          \
    X(SetupExperiment)                                                                                       \
    X(EnterInitializationMode)                                                                               \
    X(ExitInitializationMode)                                                                                \
    X(Terminate)                                                                                             \
    X(Reset)                                                                                                 \
    X(GetReal)                                                                                               \
    X(GetInteger)                                                                                            \
    X(GetBoolean)                                                                                            \
    X(GetString)                                                                                             \
    X(SetReal)                                                                                               \
    X(SetInteger)                                                                                            \
    X(SetBoolean)                                                                                            \
    X(SetString)                                                                                             \
    X(GetFMUstate)                                                                                           \
    X(SetFMUstate)                                                                                           \
    X(FreeFMUstate)                                                                                          \
    X(SerializedFMUstateSize)                                                                                \
    X(SerializeFMUstate)                                                                                     \
    X(DeSerializeFMUstate)                                                                                   \
    X(GetDirectionalDerivative)

#define FMI2_CO_SIMULATION_FUNCTIONS(X)                                                                      \
    X(SetRealInputDerivatives)                                                                               \
    X(GetRealOutputDerivatives)                                                                              \
    X(DoStep)                                                                                                \
    X(CancelStep)                                                                                            \
    X(GetStatus)                                                                                             \
    X(GetRealStatus)                                                                                         \
    X(GetIntegerStatus)                                                                                      \
    X(GetBooleanStatus)                                                                                      \
    X(GetStringStatus)

#define FMI2_MODEL_EXCHANGE_FUNCTIONS(X)                                                                     \
    X(EnterEventMode)                                                                                        \
    X(NewDiscreteStates)                                                                                     \
    X(EnterContinuousTimeMode)                                                                               \
    X(CompletedIntegratorStep)                                                                               \
    X(SetTime)                                                                                               \
    X(SetContinuousStates)                                                                                   \
    X(GetDerivatives)                                                                                        \
    X(GetEventIndicators)                                                                                    \
    X(GetContinuousStates)                                                                                   \
    X(GetNominalsOfContinuousStates)

typedef struct {
    void* handle; // of the loaded library; NULL where the functions are linked in
#define FMI2_MEMBER(name) fmi2##name##TYPE* name;
    FMI2_COMMON_FUNCTIONS(FMI2_MEMBER)
    FMI2_CO_SIMULATION_FUNCTIONS(FMI2_MEMBER)
    FMI2_MODEL_EXCHANGE_FUNCTIONS(FMI2_MEMBER) // NULL where the FMU has no model exchange
#undef FMI2_MEMBER
} Fmi2Library;

// The functions of the FMU that the program is linked with (fmi2_linked.c); never closed.
extern const Fmi2Library fmi2_linked;

// Loads a shared library. Where it can't be loaded, or lacks a function of co-simulation, false and why in one line.
bool fmi2_library_open(Fmi2Library* library, const char* path, char* why, size_t size);
void fmi2_library_close(Fmi2Library* library);

// An instance with its logger. It must not be moved while it lives: the FMU keeps its address.
typedef struct {
    const Fmi2Library* library;
    fmi2Component component;
    fmi2CallbackFunctions callbacks;
    long errors;          // messages of a status worse than fmi2Warning so far
    char said[FMI2_TEXT]; // the last of them, in one line; "" where there is none
} Fmi2Instance;

// For co-simulation. False, with the FMU's message or another reason in instance->said, where the FMU does not give an
// instance.
bool fmi2_instance_make(Fmi2Instance* instance, const Fmi2Library* library, const char* name,
                        const char* guid, const char* resources);

// For either interface.
bool fmi2_instance_make_for(Fmi2Instance* instance, const Fmi2Library* library, fmi2Type type,
                            const char* name, const char* guid, const char* resources);

// Asks for the messages of errors alone: writing those that nobody reads takes a third of a short scenario's
// time. An FMU that does not know their category goes on writing all.
void fmi2_instance_log_errors(Fmi2Instance* instance);
void fmi2_instance_free(Fmi2Instance* instance); // nothing where it was not made

#endif
