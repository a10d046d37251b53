// Whether every call returns: scenes of any numbers, with a watch on each call.
//
//     watchdog CALLS [SEED] [--ordinary]   until so many calls have been made; --ordinary: numbers of usual contacts,
//                                          and no call may raise a floating-point exception
//     watchdog --scene SCENE [--ordinary]  one scene, and its calls
//
// A scene is drawn from its number: start values, and calls of co-simulation or model exchange, along a line or in the
// plane. Its numbers are usual ones or lie between 1e-300 and 1e300; some inputs are 0, as of importers that do not connect
// them. A worker makes the calls. A fault is a step that takes more than FC_MAX_EVALUATIONS and succeeds, a call that takes
// more than ten times the second of the processor's time that FC_MAX_EVALUATIONS promise, that ends the worker, that breaks a
// rule of host.h, or, with --ordinary, that divides by zero, overflows or has an invalid result.
#include <fenv.h>
#include <float.h>
#include <math.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "fmi2/instance.h"
#include "random.h"

static void begin(const char* call);
static int ended(int status);
static void demand(bool holds, const char* rule);
#define CALL(call) (begin(#call), ended(call))
#define HOLD(rule, text) demand(rule, text)
#include "host.h"

static const double LONGEST = 10.0; // s, of a call: no machine is so busy that a shorter one takes as long
// Of FC_MAX_EVALUATIONS: what a period may add to the last one that they allow.
static const double MAX_WORK = 1.1;

enum { MAX_ACTIONS = 90, TEXT = 200, MAX_SHOWN = 40 };

// What a host does, with a variable and a number. The first actions of a scene are its start values.
typedef enum { START, STEP, SET, RATE, OUTPUTS, STATES_RATES, OUTPUT_RATES, DIRECTIONAL, COPY, KINDS } Kind;
static const char* const KIND[] = {"start",           "step",         "set",         "rate",      "outputs",
                                   "rates of states", "output rates", "directional", "state copy"};

typedef struct {
    Kind kind;
    fmi2ValueReference variable;
    double value;
} Action;

typedef struct {
    bool exchange;
    int actions;
    Action action[MAX_ACTIONS];
} Scene;

typedef enum { SOUND, TOO_LONG, TOO_MUCH, ENDED, BROKEN, EXCEPTION } Fault;
static const char* const FAULT[] = {"sound",
                                    "takes too long",
                                    "takes more evaluations than a step may",
                                    "ends the process",
                                    "breaks a rule",
                                    "raises a floating-point exception"};

// What the worker tells the watch.
typedef struct {
    long scene;            // its number
    volatile double since; // s of the worker's time at which the present call began
    volatile long calls;
    double longest; // s
    double most;    // evaluations, of a step
    char call[TEXT];
    Fault fault;
    char what[2 * TEXT];
} Board;
static Board* board;
static bool ordinary;

// ---- scenes ----

// Usual: within a factor of two of the start value, of the stiffnesses within some decades. Of one that is 0, a part of what
// is likely.
static double usual(const FcVariableInfo* info, unsigned vr) {
    const bool is_stiffness = info->offset == offsetof(FcVariables, contact.sigma) ||
                              info->offset == offsetof(FcVariables, contact.stiffnessScale);
    double least = is_stiffness ? 1e-5 : 0.5, most = is_stiffness ? 1e3 : 2.0, scale = info->start;
    if (info->start == 0.0) {
        least = 1e-5, most = 2e-3, scale = 1e4; // N s/m, of a damping
        for (unsigned i = 0; i < fc_likely_count; i++) {
            scale = fc_likely[i].variable == vr ? fc_likely[i].high : scale;
        }
    }
    if (random_chance(0.65)) {
        return info->start;
    }
    if (info->causality == FC_CAUSALITY_INPUT && random_chance(0.2)) {
        return 0.0;
    }
    const double value = scale * random_log(least, most);
    const bool is_signed = info->min < 0.0 && (info->start == 0.0 || info->min > -DBL_MAX);
    return is_signed && random_chance(0.5) ? -value : fmin(fmax(value, info->min), info->max);
}

static double any_size(void) { return pow(10.0, 600.0 * random_01() - 300.0); }

// Of any size within the bounds.
static double extreme(const FcVariableInfo* info) {
    const double size = any_size();
    return random_chance(0.2)   ? fmax(info->min, 0.0)
           : info->min >= 0.0   ? fmin(fmax(size, info->min), info->max)
           : random_chance(0.5) ? -fmin(size, -info->min)
                                : fmin(size, info->max);
}

static double drawn(double wild, unsigned vr) {
    const FcVariableInfo* info = &fc_variables[vr];
    if (info->type != FC_TYPE_REAL) {
        const bool is_method = info->offset == offsetof(FcVariables, solver.method);
        return is_method && random_chance(0.9) ? 1 : 1 + random_below((int)info->max);
    }
    return random_chance(wild) ? extreme(info) : usual(info, vr);
}

static Action drawn_action(double wild) {
    Action action = {.kind = random_chance(0.4) ? STEP : (Kind)(1 + random_below(KINDS - 1)),
                     .variable = fc_inputs[random_below((int)fc_inputs_count)]};
    const double duration = random_chance(wild) ? any_size() : 5e-5 * random_log(1e-2, 1e3);
    action.value = action.kind == STEP ? duration : drawn(wild, action.variable);
    action.value *= action.kind == RATE ? random_log(0.1, 1e4) : 1.0;
    return action;
}

static Scene scene_of(long number) {
    static const double WILD[] = {0.03, 0.1, 0.3, 0.0};
    random_state = (uint64_t)number * 0x2545f4914f6cdd1du;
    const double wild = ordinary ? 0.0 : WILD[random_below(4)];
    Scene scene = {.exchange = random_chance(0.25)};
    for (unsigned vr = 0; vr < fc_variables_count; vr++) {
        const FcVariableInfo* info = &fc_variables[vr];
        const double value = info->has_start ? drawn(wild, vr) : info->start;
        if (value != info->start) {
            scene.action[scene.actions++] = (Action){START, vr, value};
        }
    }
    for (int more = 4 + random_below(20); more > 0; more--) {
        scene.action[scene.actions++] = drawn_action(wild);
    }
    return scene;
}

// ---- the worker ----

static double time_of(clockid_t clock) {
    struct timespec now = {0};
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void tell(Fault fault, const char* what) {
    if (board->fault == SOUND) {
        board->fault = fault;
        snprintf(board->what, sizeof board->what, "%s: %s", board->call, what);
    }
}

static void demand(bool holds, const char* rule) {
    if (!holds) {
        tell(BROKEN, rule);
    }
}

static void begin(const char* call) {
    snprintf(board->call, sizeof board->call, "%s", call);
    feclearexcept(FE_ALL_EXCEPT);
    board->since = time_of(CLOCK_PROCESS_CPUTIME_ID);
}

static int ended(int status) {
    const int raised = fetestexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
    const double took = time_of(CLOCK_PROCESS_CPUTIME_ID) - board->since;
    board->since = HUGE_VAL;
    board->calls++;
    board->longest = fmax(board->longest, took);
    if (took > LONGEST) {
        tell(TOO_LONG, "it ended");
    }
    if (ordinary && raised) {
        tell(EXCEPTION, raised & FE_INVALID ? "invalid" : "division by zero or overflow");
    }
    return status;
}

// The work so far.
static double evaluations_of(fmi2Component c) {
    return ((const FcInstance*)c)->contact.state.variables.solver.evaluations;
}

// A step, or the start, that has succeeded after so many evaluations.
static void judge_work(fmi2Component c, double before) {
    const double work = evaluations_of(c) - before;
    board->most = fmax(board->most, work);
    if (work > MAX_WORK * FC_MAX_EVALUATIONS) {
        tell(TOO_MUCH, "");
    }
}

static void copy_state(fmi2Component c) {
    const StateBytes bytes = state_of(c);
    fmi2FMUstate again = NULL;
    HOLD(CALL(fmi2DeSerializeFMUstate(c, bytes.bytes, bytes.size, &again)) == fmi2OK, "it reads its bytes");
    CALL(fmi2SetFMUstate(c, again));
    fmi2FreeFMUstate(c, &again);
}

static void slopes(fmi2Component c, Chosen* is, fmi2ValueReference input) {
    fmi2ValueReference vr[REALS_MOST];
    double value[REALS_MOST];
    const double one = 1.0;
    const size_t count = choose_reals(is, vr);
    if (CALL(fmi2GetDirectionalDerivative(c, vr, count, &input, 1, &one, value)) == fmi2OK) {
        check_finite(value, count, "a directional derivative is a number");
    }
}

static void output_rates(fmi2Component c) {
    const fmi2ValueReference vr[] = {reference_of(offsetof(FcVariables, F_t)),
                                     reference_of(offsetof(FcVariables, F_y))};
    const int orders[] = {1, 1};
    double value[2];
    if (CALL(fmi2GetRealOutputDerivatives(c, vr, 2, orders, value)) == fmi2OK) {
        check_finite(value, 2, "an output's rate is a number");
    }
}

// What an integrator does in a step. One of Euler's that is too long may diverge: in usual scenes not up to an overflow.
static void integrate(fmi2Component c, double* t, double h) {
    double x[STATES], rate[STATES];
    const double farthest = ordinary ? 1e100 : DBL_MAX;
    if (!isfinite(*t + h) || CALL(fmi2SetTime(c, *t + h)) != fmi2OK) {
        return;
    }
    *t = *t + h;
    if (rates(c) == fmi2OK && fmi2GetDerivatives(c, rate, STATES) == fmi2OK &&
        CALL(fmi2GetContinuousStates(c, x, STATES)) == fmi2OK) {
        for (int i = 0; i < STATES; i++) {
            x[i] = fmax(-farthest, fmin(farthest, x[i] + h * rate[i]));
        }
        CALL(fmi2SetContinuousStates(c, x, STATES));
    }
    indicators(c);
    complete(c);
    if (CALL(fmi2EnterEventMode(c)) == fmi2OK) {
        update(c);
        nominals(c);
        CALL(fmi2EnterContinuousTimeMode(c));
    }
}

static void act(fmi2Component c, bool exchange, const Action* action, double* t) {
    const fmi2ValueReference vr = action->variable;
    const double value = action->value;
    const int item = (int)fmin(fabs(value), 100.0), first = 1;
    const bool is_real = fc_variables[vr].type == FC_TYPE_REAL;
    const double before = evaluations_of(c);
    switch (action->kind) {
    case START:
    case SET:
        is_real ? CALL(fmi2SetReal(c, &vr, 1, &value)) : CALL(fmi2SetInteger(c, &vr, 1, &item));
        break;
    case STEP:
        if (exchange) {
            integrate(c, t, value);
        } else if (CALL(fmi2DoStep(c, *t, value, fmi2True)) <= fmi2Warning) {
            *t = *t + value;
            judge_work(c, before);
        }
        break;
    case RATE:
        if (!exchange) {
            CALL(fmi2SetRealInputDerivatives(c, &vr, 1, &first, &value));
        }
        break;
    case OUTPUTS:
        read_reals(c, is_plain);
        read_reals(c, fc_variable_is_settled_force);
        break;
    case STATES_RATES:
        read_reals(c, fc_variable_is_rate);
        break;
    case OUTPUT_RATES:
        if (!exchange) {
            output_rates(c);
        }
        break;
    case DIRECTIONAL:
        slopes(c, is_computed, vr);
        slopes(c, fc_variable_is_settled_force, vr);
        break;
    default:
        copy_state(c);
    }
}

static void run(const Scene* scene) {
    Fmi2Instance instance;
    instantiate_for(&instance, scene->exchange ? fmi2ModelExchange : fmi2CoSimulation);
    fmi2_instance_log_errors(&instance);
    fmi2Component c = instance.component;
    double t = 0.0;
    int i = 0;
    for (; i < scene->actions && scene->action[i].kind == START; i++) {
        act(c, scene->exchange, &scene->action[i], &t);
    }
    fmi2SetupExperiment(c, 0, 0.0, t, 0, 0.0);
    fmi2EnterInitializationMode(c);
    if (CALL(fmi2ExitInitializationMode(c)) == fmi2OK) {
        judge_work(c, 0.0);
        if (scene->exchange) {
            update(c);
            CALL(fmi2EnterContinuousTimeMode(c));
        }
        for (; i < scene->actions && board->fault == SOUND; i++) {
            act(c, scene->exchange, &scene->action[i], &t);
        }
    }
    fmi2_instance_free(&instance);
}

// ---- the watch ----

// Waits for the worker; ends it if its present call takes too long.
static void watch(pid_t worker) {
    int status = 0;
    clockid_t clock;
    while (waitpid(worker, &status, WNOHANG) == 0) {
        if (clock_getcpuclockid(worker, &clock) == 0 && time_of(clock) - board->since > LONGEST) {
            kill(worker, SIGKILL);
            waitpid(worker, &status, 0);
            board->calls++;
            tell(TOO_LONG, "it was ended");
            return;
        }
        usleep(2000);
    }
    if (WIFSIGNALED(status)) {
        tell(ENDED, strsignal(WTERMSIG(status)));
    }
}

// Scenes from board->scene on in a worker of its own, up to a number of calls or a fault.
static Fault run_from(long calls) {
    board->fault = SOUND;
    board->since = HUGE_VAL;
    const pid_t worker = fork();
    if (worker == 0) {
        do {
            const Scene scene = scene_of(board->scene);
            run(&scene);
        } while (board->fault == SOUND && board->calls < calls && ++board->scene);
        _exit(0);
    }
    watch(worker);
    return board->fault;
}

static int run_one(long number) {
    const Scene scene = scene_of(number);
    board->scene = number;
    const Fault fault = run_from(0);
    printf("scene %ld: %s %s\n  %s\n", number, FAULT[fault], board->what,
           scene.exchange ? "model exchange" : "co-simulation");
    for (const Action* action = scene.action; action < scene.action + scene.actions; action++) {
        printf("  %s %s %.17g\n", KIND[action->kind], fc_variables[action->variable].name, action->value);
    }
    return fault != SOUND;
}

static int run_many(long calls, long first) {
    long faults = 0;
    board->scene = first;
    while (board->calls < calls) {
        if (run_from(calls) != SOUND && faults++ < MAX_SHOWN) {
            printf("scene %ld %s: %s\n", board->scene, FAULT[board->fault], board->what);
        }
        board->scene++;
    }
    printf("%ld calls in %ld scenes, the longest %.2g s, a step of at most %.2g evaluations\n%ld faults\n",
           board->calls, board->scene - first, board->longest, board->most, faults);
    return faults > 0;
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
    return run_many(strtol(words[1], NULL, 10), first);
}
