// Whether every call returns: scenes of any numbers, with a watch on each call.
//
//     watchdog CALLS [SEED] [--ordinary]   until so many calls have been made; --ordinary: numbers of usual contacts,
//                                          and no call may raise a floating-point exception
//     watchdog --scene SCENE [--ordinary]  one scene, then the least part of it that fails
//
// A scene is drawn from its number: start values, and calls of co-simulation or model exchange, along a line or in the
// plane. Its numbers are usual ones or lie between 1e-300 and 1e300. A worker makes the calls. A call that takes more
// than a second of the processor's time, that ends the worker, that gives a number that is not finite, or, with
// --ordinary, that divides by zero, overflows or has an invalid result, is a fault.
#include <fenv.h>
#include <float.h>
#include <math.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "fmi2Functions.h"
#include "fmi2_library.h"
#include "variable_reference.h"

static const double LONGEST = 1.0; // s, of a call

enum { MOST_SETTINGS = 64, MOST_ACTIONS = 24, TEXT = 200, MOST_SHOWN = 40 };

// One step of a host: what is called, with its numbers.
typedef enum {
    STEP,
    SET,
    RATE,
    OUTPUTS,
    SETTLED,
    RATES_OF_STATES,
    OUTPUT_RATES,
    DIRECTIONAL,
    SETTLED_DIRECTIONAL,
    STATE_COPY,
    ACTION_COUNT
} Kind;
static const char* const KIND[] = {
    "step",         "set",         "rate",
    "outputs",      "settled",     "rates of states",
    "output rates", "directional", "settled directional",
    "state copy",
};

typedef struct {
    fmi2ValueReference variable;
    double value;
} Setting;

typedef struct {
    Kind kind;
    fmi2ValueReference variable;
    double value;
} Action;

typedef struct {
    bool exchange;
    int settings;
    Setting setting[MOST_SETTINGS];
    int actions;
    Action action[MOST_ACTIONS];
} Scene;

typedef enum { SOUND, TOO_LONG, ENDED, NOT_FINITE, EXCEPTION } Fault;
static const char* const FAULT[] = {"sound", "takes too long", "ends the process", "is not finite",
                                    "raises a floating-point exception"};

enum { NAMES = 32 };

// What the worker tells the watch.
typedef struct {
    long scene;
    volatile double since; // s of the worker's time at which the present call began
    volatile long calls;
    char call[TEXT]; // the present one
    Fault fault;
    char what[TEXT];
    struct {
        char name[48];
        double longest; // s
        long scene;
        long calls;
    } by_name[NAMES];
} Board;
static Board* board;
static bool ordinary;

// Numbers: splitmix64.

static uint64_t random_state;

static double chance(void) {
    uint64_t z = random_state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static bool happens(double probability) { return chance() < probability; }
static int one_of(int count) { return (int)(chance() * count); }
static double between(double low, double high) { return low * pow(high / low, chance()); }

// Usual magnitudes, and how often the value is another than the start value.
static const struct {
    size_t offset;
    double low, high, often;
    bool is_signed;
} USUAL[] = {
    {offsetof(FcVariables, V), 1e-4, 2.0, 1.0, true},
    {offsetof(FcVariables, V_y), 1e-4, 2.0, 0.3, true},
    {offsetof(FcVariables, d), 10e-6, 20e-6, 0.5, false},
    {offsetof(FcVariables, E), 1e10, 1e11, 0.3, false},
    {offsetof(FcVariables, load), 1.0, 1e3, 0.5, false},
    {offsetof(FcVariables, F_C), 1.0, 200.0, 0.3, false},
    {offsetof(FcVariables, delta_0), 1e-9, 1e-5, 0.3, true},
    {offsetof(FcVariables, delta_y_0), 1e-9, 1e-5, 0.1, true},
    {offsetof(FcVariables, friction.mu), 0.05, 0.6, 0.3, false},
    {offsetof(FcVariables, friction.staticRatio), 1.0, 3.0, 0.5, false},
    {offsetof(FcVariables, friction.V_S), 1e-3, 1.0, 0.5, false},
    {offsetof(FcVariables, friction.sigma_1), 0.1, 1e3, 0.3, false},
    {offsetof(FcVariables, friction.sigma_2), 0.1, 1e2, 0.3, false},
    {offsetof(FcVariables, contact.sigma), 1e5, 1e12, 0.7, false},
    {offsetof(FcVariables, contact.stiffnessScale), 1e-7, 1.0, 0.7, false},
    {offsetof(FcVariables, vibration.f), 1e3, 1e5, 0.3, false},
    {offsetof(FcVariables, vibration.V_1), 1e-3, 3.0, 0.6, false},
    {offsetof(FcVariables, vibration.V_2), 1e-3, 3.0, 0.3, false},
    {offsetof(FcVariables, vibration.a_d), 1e-8, 2e-6, 0.4, false},
    {offsetof(FcVariables, vibration.phase_d), 1e-2, 7.0, 0.5, true},
    {offsetof(FcVariables, vibration.phase_2), 1e-2, 7.0, 0.5, true},
    {offsetof(FcVariables, solver.tolerance), 1e-8, 1e-3, 0.3, false},
    {offsetof(FcVariables, solver.stepSize), 1e-9, 1e-7, 0.5, false},
};

// A usual value of a variable; its start value for one that the table does not have.
static double usual(const FcVariableInfo* info) {
    for (size_t i = 0; i < sizeof USUAL / sizeof *USUAL; i++) {
        if (USUAL[i].offset == info->offset && happens(USUAL[i].often)) {
            const double size = between(USUAL[i].low, USUAL[i].high);
            return USUAL[i].is_signed && happens(0.5) ? -size : size;
        }
    }
    return info->start;
}

static double any_size(void) { return pow(10.0, 600.0 * chance() - 300.0); }

// A value of any size within the bounds.
static double extreme(const FcVariableInfo* info) {
    if (happens(0.2)) {
        return info->min <= 0.0 ? 0.0 : info->min;
    }
    const double size = any_size();
    if (info->min < 0.0) {
        return happens(0.5) ? -fmin(size, -info->min) : fmin(size, info->max);
    }
    return size >= info->min && size <= info->max ? size
                                                  : between(fmax(info->min, 1e-300), fmin(info->max, 1e300));
}

static double drawn(const FcVariableInfo* info, double wild) {
    return happens(wild) ? extreme(info) : usual(info);
}

static int drawn_item(const FcVariableInfo* info) {
    const bool is_method = info->offset == offsetof(FcVariables, solver.method);
    return is_method && happens(0.9) ? 1 : 1 + one_of((int)info->max);
}

static Scene scene_of(long number) {
    random_state = (uint64_t)number * 0x2545f4914f6cdd1du;
    static const double WILD[] = {0.03, 0.1, 0.3, 0.0};
    const double wild = ordinary ? 0.0 : WILD[one_of(4)];
    Scene scene = {.exchange = happens(0.25)};
    for (unsigned vr = 0; vr < fc_variables_count; vr++) {
        const FcVariableInfo* info = &fc_variables[vr];
        if (!info->has_start ||
            (info->causality != FC_CAUSALITY_INPUT && info->causality != FC_CAUSALITY_PARAMETER)) {
            continue;
        }
        const double value = info->type == FC_TYPE_REAL ? drawn(info, wild) : drawn_item(info);
        if (value != info->start) {
            scene.setting[scene.settings++] = (Setting){vr, value};
        }
    }
    scene.actions = 4 + one_of(MOST_ACTIONS - 4);
    for (int i = 0; i < scene.actions; i++) {
        Action* action = &scene.action[i];
        action->kind = happens(0.4) ? STEP : (Kind)one_of(ACTION_COUNT);
        action->variable = fc_inputs[one_of((int)fc_inputs_count)];
        action->value = happens(wild) ? any_size() : 5e-5 * between(1e-2, 1e3);
        if (action->kind == SET) {
            action->value = drawn(&fc_variables[action->variable], wild);
        } else if (action->kind == RATE) {
            action->value = drawn(&fc_variables[action->variable], wild) * between(0.1, 1e4);
        }
    }
    return scene;
}

static void show(const Scene* scene) {
    printf("  %s\n", scene->exchange ? "model exchange" : "co-simulation");
    for (int i = 0; i < scene->settings; i++) {
        const FcVariableInfo* info = &fc_variables[scene->setting[i].variable];
        if (info->type == FC_TYPE_REAL) {
            printf("  %s = %.17g\n", info->name, scene->setting[i].value);
        } else {
            printf("  %s = %s\n", info->name, info->literals[(int)scene->setting[i].value - 1]);
        }
    }
    for (int i = 0; i < scene->actions; i++) {
        const Action* action = &scene->action[i];
        printf("  %s", KIND[action->kind]);
        if (action->kind == SET || action->kind == RATE || action->kind == DIRECTIONAL ||
            action->kind == SETTLED_DIRECTIONAL) {
            printf(" %s", fc_variables[action->variable].name);
        }
        if (action->kind == STEP || action->kind == SET || action->kind == RATE) {
            printf(" %.17g", action->value);
        }
        printf("\n");
    }
}

// The worker.

static double own_time(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void tell(Fault fault, const char* what) {
    if (board->fault == SOUND) {
        board->fault = fault;
        snprintf(board->what, sizeof board->what, "%s%s%s", board->call, what[0] ? ": " : "", what);
    }
}

static void begin(const char* call) {
    snprintf(board->call, sizeof board->call, "%s", call);
    feclearexcept(FE_ALL_EXCEPT);
    board->since = own_time();
}

// Counts the present call, which took this time [s].
static void count_call(double took) {
    board->since = HUGE_VAL;
    board->calls++;
    int i = 0;
    while (i < NAMES - 1 && board->by_name[i].name[0] && strcmp(board->by_name[i].name, board->call) != 0) {
        i++;
    }
    snprintf(board->by_name[i].name, sizeof board->by_name[i].name, "%.47s", board->call);
    board->by_name[i].calls++;
    if (took > board->by_name[i].longest) {
        board->by_name[i].longest = took;
        board->by_name[i].scene = board->scene;
    }
}

static fmi2Status ended(fmi2Status status) {
    const int raised = fetestexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
    const double took = own_time() - board->since;
    count_call(took);
    if (took > LONGEST) {
        tell(TOO_LONG, "");
    }
    if (ordinary && raised) {
        tell(EXCEPTION, raised & FE_INVALID     ? "invalid"
                        : raised & FE_DIVBYZERO ? "division by zero"
                                                : "overflow");
    }
    return status;
}

#define CALL(name, call) (begin(name), ended(call))

static void demand_finite(const double* values, size_t count, const char* what) {
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(values[i])) {
            tell(NOT_FINITE, what);
        }
    }
}

// All Reals that are computed, F_t_settled and F_y_settled apart.
static size_t computed(fmi2ValueReference* vr, bool rates) {
    size_t count = 0;
    for (unsigned i = 0; i < fc_variables_count; i++) {
        const FcVariableInfo* info = &fc_variables[i];
        const bool is_output =
            info->causality == FC_CAUSALITY_OUTPUT || info->causality == FC_CAUSALITY_LOCAL;
        if (is_output && !fc_variable_is_settled_force(info) && fc_variable_is_rate(info) == rates &&
            info->offset != offsetof(FcVariables, solver.evaluations)) {
            vr[count++] = i;
        }
    }
    return count;
}

static void read_all(fmi2Component c, const char* name, const fmi2ValueReference* vr, size_t count) {
    double value[64];
    if (CALL(name, fmi2GetReal(c, vr, count, value)) == fmi2OK) {
        demand_finite(value, count, name);
    }
}

static void settled_pair(fmi2ValueReference vr[2]) {
    vr[0] = reference_of(offsetof(FcVariables, F_t_settled));
    vr[1] = reference_of(offsetof(FcVariables, F_y_settled));
}

static void copy_state(fmi2Component c) {
    fmi2FMUstate saved = NULL, again = NULL;
    static char bytes[4096];
    size_t size = 0;
    if (CALL("fmi2GetFMUstate", fmi2GetFMUstate(c, &saved)) != fmi2OK) {
        return;
    }
    CALL("fmi2SerializedFMUstateSize", fmi2SerializedFMUstateSize(c, saved, &size));
    CALL("fmi2SerializeFMUstate", fmi2SerializeFMUstate(c, saved, bytes, sizeof bytes));
    if (CALL("fmi2DeSerializeFMUstate", fmi2DeSerializeFMUstate(c, bytes, size, &again)) == fmi2OK) {
        CALL("fmi2SetFMUstate", fmi2SetFMUstate(c, again));
    } else {
        tell(NOT_FINITE, "the instance's own bytes are refused");
    }
    fmi2FreeFMUstate(c, &again);
    fmi2FreeFMUstate(c, &saved);
}

static void directional(fmi2Component c, const char* name, fmi2ValueReference input,
                        const fmi2ValueReference* vr, size_t count) {
    double value[64];
    const double one = 1.0;
    if (CALL(name, fmi2GetDirectionalDerivative(c, vr, count, &input, 1, &one, value)) == fmi2OK) {
        demand_finite(value, count, name);
    }
}

// A step of co-simulation, or what an integrator does in one.
static void step(fmi2Component c, bool exchange, double* t, double h) {
    if (!exchange) {
        if (CALL("fmi2DoStep", fmi2DoStep(c, *t, h, fmi2True)) <= fmi2Warning) {
            *t = *t + h;
        }
        return;
    }
    double x[4], rate[4], z[4];
    int event = 0, terminate = 0;
    const double next = *t + h;
    if (!isfinite(next) || CALL("fmi2SetTime", fmi2SetTime(c, next)) != fmi2OK) {
        return;
    }
    *t = next;
    if (CALL("fmi2GetDerivatives", fmi2GetDerivatives(c, rate, 4)) == fmi2OK) {
        demand_finite(rate, 4, "a rate");
        if (CALL("fmi2GetContinuousStates", fmi2GetContinuousStates(c, x, 4)) == fmi2OK) {
            for (int i = 0; i < 4; i++) {
                x[i] += h * rate[i];
            }
            CALL("fmi2SetContinuousStates", fmi2SetContinuousStates(c, x, 4));
        }
    }
    if (CALL("fmi2GetEventIndicators", fmi2GetEventIndicators(c, z, 4)) == fmi2OK) {
        demand_finite(z, 4, "an indicator");
    }
    CALL("fmi2CompletedIntegratorStep", fmi2CompletedIntegratorStep(c, fmi2True, &event, &terminate));
    if (CALL("fmi2EnterEventMode", fmi2EnterEventMode(c)) == fmi2OK) {
        fmi2EventInfo info;
        if (CALL("fmi2NewDiscreteStates", fmi2NewDiscreteStates(c, &info)) == fmi2OK &&
            info.nextEventTimeDefined && !(info.nextEventTime > *t)) {
            tell(NOT_FINITE, "the next event is not ahead");
        }
        CALL("fmi2GetNominalsOfContinuousStates", fmi2GetNominalsOfContinuousStates(c, x, 4));
        CALL("fmi2EnterContinuousTimeMode", fmi2EnterContinuousTimeMode(c));
    }
}

static void act(fmi2Component c, bool exchange, const Action* action, double* t) {
    fmi2ValueReference vr[64];
    double value[2];
    const int orders[2] = {1, 1};
    switch (action->kind) {
    case STEP:
        step(c, exchange, t, action->value);
        break;
    case SET:
        CALL("fmi2SetReal", fmi2SetReal(c, &action->variable, 1, &action->value));
        break;
    case RATE:
        if (!exchange) {
            CALL("fmi2SetRealInputDerivatives",
                 fmi2SetRealInputDerivatives(c, &action->variable, 1, orders, &action->value));
        }
        break;
    case OUTPUTS:
        read_all(c, "fmi2GetReal of outputs", vr, computed(vr, false));
        break;
    case SETTLED:
        settled_pair(vr);
        read_all(c, "fmi2GetReal of F_t_settled", vr, 2);
        break;
    case RATES_OF_STATES:
        read_all(c, "fmi2GetReal of rates", vr, computed(vr, true));
        break;
    case OUTPUT_RATES:
        vr[0] = reference_of(offsetof(FcVariables, F_t));
        vr[1] = reference_of(offsetof(FcVariables, F_y));
        if (!exchange && CALL("fmi2GetRealOutputDerivatives",
                              fmi2GetRealOutputDerivatives(c, vr, 2, orders, value)) == fmi2OK) {
            demand_finite(value, 2, "an output's rate");
        }
        break;
    case DIRECTIONAL:
        directional(c, "fmi2GetDirectionalDerivative", action->variable, vr, computed(vr, false));
        break;
    case SETTLED_DIRECTIONAL:
        settled_pair(vr);
        directional(c, "fmi2GetDirectionalDerivative of F_t_settled", action->variable, vr, 2);
        break;
    default:
        copy_state(c);
    }
}

static void run(const Scene* scene) {
    Fmi2Instance instance;
    const fmi2Type type = scene->exchange ? fmi2ModelExchange : fmi2CoSimulation;
    if (!fmi2_instance_make_for(&instance, &fmi2_linked, type, "watched", fc_guid, NULL)) {
        tell(ENDED, instance.said);
        return;
    }
    fmi2_instance_log_errors(&instance);
    fmi2Component c = instance.component;
    for (int i = 0; i < scene->settings; i++) {
        const Setting* of = &scene->setting[i];
        const int item = (int)(fabs(of->value) < 100.0 ? of->value : 0.0);
        if (fc_variables[of->variable].type == FC_TYPE_REAL) {
            CALL("fmi2SetReal", fmi2SetReal(c, &of->variable, 1, &of->value));
        } else {
            CALL("fmi2SetInteger", fmi2SetInteger(c, &of->variable, 1, &item));
        }
    }
    double t = 0.0;
    fmi2SetupExperiment(c, 0, 0.0, t, 0, 0.0);
    fmi2EnterInitializationMode(c);
    if (CALL("fmi2ExitInitializationMode", fmi2ExitInitializationMode(c)) == fmi2OK) {
        if (scene->exchange) {
            fmi2EventInfo info;
            CALL("fmi2NewDiscreteStates", fmi2NewDiscreteStates(c, &info));
            CALL("fmi2EnterContinuousTimeMode", fmi2EnterContinuousTimeMode(c));
        }
        for (int i = 0; i < scene->actions && board->fault == SOUND; i++) {
            act(c, scene->exchange, &scene->action[i], &t);
        }
    }
    fmi2_instance_free(&instance);
}

// The watch.

static double time_of(pid_t worker) {
    clockid_t clock;
    struct timespec now;
    if (clock_getcpuclockid(worker, &clock) != 0 || clock_gettime(clock, &now) != 0) {
        return 0.0;
    }
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// Waits for the worker; ends it if its present call takes too long.
static void watch(pid_t worker) {
    int status = 0;
    while (waitpid(worker, &status, WNOHANG) == 0) {
        if (time_of(worker) - board->since > LONGEST) {
            kill(worker, SIGKILL);
            waitpid(worker, &status, 0);
            count_call(HUGE_VAL);
            tell(TOO_LONG, "without end");
            return;
        }
        usleep(2000);
    }
    if (WIFSIGNALED(status)) {
        char what[TEXT];
        snprintf(what, sizeof what, "signal %d", WTERMSIG(status));
        tell(ENDED, what);
    }
}

// The fault of a scene in a worker of its own.
static Fault fault_of(const Scene* scene) {
    board->fault = SOUND;
    board->since = HUGE_VAL;
    const pid_t worker = fork();
    if (worker == 0) {
        run(scene);
        _exit(0);
    }
    watch(worker);
    return board->fault;
}

// Leaves out each setting and each action that the fault does not need.
static void reduce(Scene* scene, Fault fault) {
    for (int i = scene->actions - 1; i >= 0; i--) {
        Scene less = *scene;
        memmove(&less.action[i], &less.action[i + 1], sizeof(Action) * (size_t)(less.actions - 1 - i));
        less.actions--;
        if (fault_of(&less) == fault) {
            *scene = less;
        }
    }
    for (int i = scene->settings - 1; i >= 0; i--) {
        Scene less = *scene;
        memmove(&less.setting[i], &less.setting[i + 1], sizeof(Setting) * (size_t)(less.settings - 1 - i));
        less.settings--;
        if (fault_of(&less) == fault) {
            *scene = less;
        }
    }
    fault_of(scene);
}

static int run_one(long number) {
    board->scene = number;
    Scene scene = scene_of(number);
    const Fault fault = fault_of(&scene);
    printf("scene %ld: %s%s%s\n", number, FAULT[fault], fault ? ": " : "", fault ? board->what : "");
    if (fault != SOUND) {
        reduce(&scene, fault);
        printf("reduced: %s\n", board->what);
    }
    show(&scene);
    return fault != SOUND;
}

static long run_many(long calls, long first) {
    long faults = 0;
    board->scene = first;
    while (board->calls < calls) {
        board->fault = SOUND;
        board->since = HUGE_VAL;
        const pid_t worker = fork();
        if (worker == 0) {
            for (; board->calls < calls && board->fault == SOUND; board->scene++) {
                const Scene scene = scene_of(board->scene);
                run(&scene);
            }
            _exit(0);
        }
        watch(worker);
        if (board->fault != SOUND) {
            // A worker that ended well is already at the next scene.
            const bool moved_on = board->fault != ENDED && !strstr(board->what, "without end");
            const long scene = board->scene - (moved_on ? 1 : 0);
            if (faults++ < MOST_SHOWN) {
                printf("scene %ld %s: %s\n", scene, FAULT[board->fault], board->what);
            }
            board->scene = scene + 1;
        }
    }
    return faults;
}

int main(int count, char** words) {
    setvbuf(stdout, NULL, _IOLBF, BUFSIZ);
    board = mmap(NULL, sizeof *board, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (board == MAP_FAILED || count < 2) {
        fprintf(stderr, "usage: watchdog CALLS [SEED] [--ordinary] | --scene SCENE [--ordinary]\n");
        return 2;
    }
    ordinary = strcmp(words[count - 1], "--ordinary") == 0;
    if (strcmp(words[1], "--scene") == 0) {
        return run_one(strtol(words[2], NULL, 10));
    }
    const long first = count > 2 && words[2][0] != '-' ? 1000000000 * strtol(words[2], NULL, 10) : 0;
    const long faults = run_many(strtol(words[1], NULL, 10), first);
    printf("%-48s %12s %12s %12s\n", "call", "calls", "longest [s]", "in scene");
    for (int i = 0; i < NAMES && board->by_name[i].name[0]; i++) {
        printf("%-48s %12ld %12.2g %12ld\n", board->by_name[i].name, board->by_name[i].calls,
               board->by_name[i].longest, board->by_name[i].scene);
    }
    printf("%ld calls in %ld scenes, %ld faults\n", board->calls, board->scene - first, faults);
    return faults > 0;
}
