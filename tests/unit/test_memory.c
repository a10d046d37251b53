// Memory: every allocation that fails is a refusal with a message, and nothing that was allocated is left behind.
//
// The linker gives this program the allocations of the FMU and of SUNDIALS (-Wl,--wrap).
#define _POSIX_C_SOURCE 200809L // fork
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef FC_WITH_SUNDIALS
#include <sundials/sundials_context.h>
#endif

#include "check.h"
#include "fmi2/variables.h"
#include "fmi2Functions.h"
#include "fmi2_library.h"
#include "solver/method.h"
#include "solver/solver.h"
#include "variable_reference.h"

void* __real_malloc(size_t size);
void* __real_calloc(size_t count, size_t size);
void __real_free(void* memory);
void* __wrap_malloc(size_t size);
void* __wrap_calloc(size_t count, size_t size);
void __wrap_free(void* memory);

static long live;        // blocks that are allocated now
static long allocations; // so far
static long failing;     // number of the allocation that fails; 0: none

static bool fails(void) { return ++allocations == failing; }

static void* count(void* memory) {
    live += memory != NULL;
    return memory;
}

void* __wrap_malloc(size_t size) { return count(fails() ? NULL : __real_malloc(size)); }
void* __wrap_calloc(size_t number, size_t size) {
    return count(fails() ? NULL : __real_calloc(number, size));
}

void __wrap_free(void* memory) {
    live -= memory != NULL;
    __real_free(memory);
}

// A life with a state saved and restored by bytes, and two steps. True if every call was OK.
static bool live_once(Fmi2Instance* contact, fmi2FMUstate* saved, int method) {
    if (!fmi2_instance_make(contact, &fmi2_linked, "unit", fc_guid, NULL)) {
        return false;
    }
    fmi2Component c = contact->component;
    const fmi2ValueReference reference = reference_of(offsetof(FcVariables, solver.method));
    char bytes[4096];
    size_t size = 0;
    return fmi2SetInteger(c, &reference, 1, &method) == fmi2OK && fmi2EnterInitializationMode(c) == fmi2OK &&
           fmi2ExitInitializationMode(c) == fmi2OK && fmi2DoStep(c, 0.0, 1e-5, fmi2True) == fmi2OK &&
           fmi2GetFMUstate(c, saved) == fmi2OK && fmi2SerializedFMUstateSize(c, *saved, &size) == fmi2OK &&
           fmi2SerializeFMUstate(c, *saved, bytes, sizeof bytes) == fmi2OK &&
           fmi2FreeFMUstate(c, saved) == fmi2OK && fmi2DeSerializeFMUstate(c, bytes, size, saved) == fmi2OK &&
           fmi2SetFMUstate(c, *saved) == fmi2OK && fmi2DoStep(c, 1e-5, 1e-5, fmi2True) == fmi2OK;
}

static void give_back(Fmi2Instance* contact, fmi2FMUstate* saved) {
    if (contact->component) {
        CHECK(fmi2FreeFMUstate(contact->component, saved) == fmi2OK);
    }
    fmi2_instance_free(contact);
    CHECK(live == 0);
}

static void nothing_is_left_behind(int method) {
    Fmi2Instance contact;
    fmi2FMUstate saved = NULL;
    failing = 0;
    CHECK(live_once(&contact, &saved, method));
    CHECK(fmi2Reset(contact.component) == fmi2OK);
    give_back(&contact, &saved);
}

static void every_failure_is_told(void) {
    bool lived = false;
    for (failing = 1; !lived && failing < 10; failing++) {
        Fmi2Instance contact;
        fmi2FMUstate saved = NULL;
        allocations = 0;
        lived = live_once(&contact, &saved, FC_METHOD_COLLOCATION);
        CHECK(lived == (allocations < failing));
        CHECK(lived || strstr(contact.said, "memory"));
        give_back(&contact, &saved);
    }
    CHECK(failing - 1 == 4); // the instance and the saved state, twice, then none failed
}

#ifdef FC_WITH_SUNDIALS

// SUNDIALS 6.4.1 itself uses the memory of some of its allocations without a look, in SUNContext_Create and in
// CVodeInit. What this code asks of it in between, and its own, must be told.
static long allocations_of_a_context(void) {
    SUNContext context;
    failing = 0;
    allocations = 0;
    CHECK(SUNContext_Create(NULL, &context) == 0);
    const long count = allocations;
    SUNContext_Free(&context);
    return count;
}

static void check_new_cvode(void) {
    FcMessage message = {""};
    allocations = 0;
    const bool with_body = failing % 2 != 0; // which allocate alike
    FcCvode* solver = fc_cvode_new(with_body, &message);
    CHECK(solver == NULL && allocations >= failing);
    CHECK(strcmp(message.text, "solver.method = cvode: no memory for CVODE") == 0);
    CHECK(live == 0);
}

// In a process of its own: false where SUNDIALS brings it down.
static bool survives_failure(long number) {
    const pid_t child = fork();
    if (child == 0) {
        signal(SIGSEGV, SIG_DFL); // a sanitizer's handler would make an ordinary end of it
        failing = number;
        check_new_cvode();
        _exit(check_result());
    }
    int status = 0;
    CHECK(child > 0 && waitpid(child, &status, 0) == child);
    CHECK(!WIFEXITED(status) || WEXITSTATUS(status) == 0);
    return WIFEXITED(status);
}

static void every_failure_of_cvode_is_told(void) {
    CHECK(survives_failure(1)); // its own struct
    long told = 0;
    for (long number = 2 + allocations_of_a_context(); told < 100 && survives_failure(number); number++) {
        told++;
    }
    CHECK(told >= 10 && told < 100); // the vectors, the matrix, the linear solver and CVODE have several each
}

#endif

int main(void) {
    nothing_is_left_behind(FC_METHOD_COLLOCATION);
    every_failure_is_told();
#ifdef FC_WITH_SUNDIALS
    nothing_is_left_behind(FC_METHOD_CVODE);
    every_failure_of_cvode_is_told();
#endif
    return check_result();
}
