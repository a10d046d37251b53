// SUNDIALS CVODE: variable-order BDF of the contact as model exchange states it (model/regime.h): its motion,
// whose derivatives are the Jacobian, and the events that end a regime.
//
// CVODE is started anew at every event and at the reversals of V, in a time that begins at 0: it never steps
// over a kink, and no history outlives a step. The errors have absolute bounds, because an error of the
// deflection is multiplied when the contact stiffens. A Stribeck curve is a bump of g around V = 0: steps
// shrink with |V| so that none passes it unseen.
#include <stdio.h>

#include "model/extremes.h"
#include "solver/method.h"

// FC_NO_CVODE leaves it out of any build: SUNDIALS takes memory from the heap, which some targets do not have.
#if defined(FC_WITH_SUNDIALS) && !defined(FC_NO_CVODE)

#include <assert.h>
#include <cvode/cvode.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "model/regime.h"
#include "solver/pieces.h"

// Each is chosen empirically: half of it costs steps, twice of it doubles the error that passes
// (tests/solver/test_cvode.py). The part of solver.tolerance that bounds the local error of one step, so that the
// sum of the errors is within it, and that of a state, for its rounding.
#define LOCAL_ERROR_FRACTION 0.003
#define SMALLEST_LOCAL_ERROR 1e-14
#define STEPS_PER_PERIOD 8.0 // at least: the vibration can't slip between two steps
// A Stribeck curve falls from its peak within some V_S. In a step V moves by at most half of |V|, so that
// steps approach the peak geometrically, and on the peak by this part of V_S.
#define STRIBECK_STEP 0.25

// The states: the deflection, and the integrals of FcStepResult.
enum { DELTA, DELTA_Y, IMPULSE, IMPULSE_Y, WORK, HEAT, DRAG, STATES };

static double* state(FcStepResult* of, int k) {
    double* const all[STATES] = {&of->delta, &of->delta_y, &of->impulse, &of->impulse_y,
                                 &of->work,  &of->heat,    &of->drag};
    return all[k];
}

struct FcCvode {
    SUNContext context;
    N_Vector y;
    N_Vector allowed; // local errors
    SUNMatrix matrix;
    SUNLinearSolver linear_solver;
    void* cvode;
    // The present regime, for the callbacks.
    const FcScene* scene; // without damping
    double start;         // s, local time at which the regime starts; CVODE's time is 0 there
    FcRegime regime;
    int slips;
    double evaluations; // of the motion
    char reason[160];   // CVODE's last error message
};

// CVODE refuses 0, and squares what an error is over it.
static const double LEAST_ALLOWED = 1e-100;

// The shortest communication step [s]: CVODE multiplies steps with each other, and numbers below 1e-308 take it long.
static const double SHORTEST = 1e-50;

// The largest number of evaluations in a communication step, a second of computing: each makes a scene.
static const double MOST_EVALUATIONS = 2e5;

static FcScene scene_at(const FcCvode* solver, double tau) {
    return fc_scene_from(solver->scene, solver->start + tau);
}

static FcBristle bristle_of(const FcCvode* solver, N_Vector y) {
    return (FcBristle){.delta = NV_Ith_S(y, DELTA), .slips = solver->slips, .delta_y = NV_Ith_S(y, DELTA_Y)};
}

// Of a motion, or of its derivative by the deflection.
static void set_rates(const FcScene* now, const FcMotion* motion, double rate[STATES]) {
    rate[DELTA] = motion->rates.delta;
    rate[DELTA_Y] = motion->rates.delta_y;
    rate[IMPULSE] = motion->force.x;
    rate[IMPULSE_Y] = motion->force.y;
    rate[WORK] = motion->rates.W_f;
    rate[HEAT] = motion->rates.Q_f;
    rate[DRAG] = motion->rates.delta * fc_drive_V(&now->drive, 0.0) +
                 motion->rates.delta_y * fc_drive_V_y(&now->drive, 0.0);
}

static int right_hand_side(realtype tau, N_Vector y, N_Vector rates, void* user) {
    FcCvode* solver = user;
    const FcScene now = scene_at(solver, tau);
    const FcMotion motion = fc_motion(&now, solver->regime, bristle_of(solver, y));
    solver->evaluations += 1.0;
    set_rates(&now, &motion, NV_DATA_S(rates));
    return 0;
}

static int jacobian(realtype tau, N_Vector y, N_Vector rates, SUNMatrix J, void* user, N_Vector t1,
                    N_Vector t2, N_Vector t3) {
    (void)rates, (void)t1, (void)t2, (void)t3;
    const FcCvode* solver = user;
    const FcScene now = scene_at(solver, tau);
    const FcDirection along[] = {{.delta = 1.0}, {.delta_y = 1.0}};
    for (int k = DELTA; k <= DELTA_Y; k++) {
        const FcMotion by = fc_motion_along(&now, solver->regime, bristle_of(solver, y), &along[k]);
        set_rates(&now, &by, SM_COLUMN_D(J, k));
    }
    return 0;
}

static int indicators(realtype tau, N_Vector y, realtype* z, void* user) {
    const FcCvode* solver = user;
    const FcScene now = scene_at(solver, tau);
    fc_regime_indicators(&now, solver->regime, bristle_of(solver, y), z);
    return 0;
}

static void keep_reason(int code, const char* module, const char* function, char* text, void* user) {
    (void)module, (void)function;
    FcCvode* solver = user;
    if (code < 0) {
        snprintf(solver->reason, sizeof solver->reason, "%s", text);
    }
}

static bool set_up(FcCvode* solver) {
    if (SUNContext_Create(NULL, &solver->context) != 0) {
        return false;
    }
    solver->y = N_VNew_Serial(STATES, solver->context);
    solver->allowed = N_VNew_Serial(STATES, solver->context);
    solver->matrix = SUNDenseMatrix(STATES, STATES, solver->context);
    if (!solver->y || !solver->allowed || !solver->matrix) {
        return false;
    }
    void* cvode = solver->cvode = CVodeCreate(CV_BDF, solver->context);
    solver->linear_solver = SUNLinSol_Dense(solver->y, solver->matrix, solver->context);
    if (!cvode || !solver->linear_solver) {
        return false;
    }
    N_VConst(0.0, solver->y);
    return CVodeSetErrHandlerFn(cvode, keep_reason, solver) == CV_SUCCESS &&
           CVodeInit(cvode, right_hand_side, 0.0, solver->y) == CV_SUCCESS &&
           CVodeSetUserData(cvode, solver) == CV_SUCCESS &&
           CVodeRootInit(cvode, 2, indicators) == CV_SUCCESS &&
           CVodeSetLinearSolver(cvode, solver->linear_solver, solver->matrix) == CVLS_SUCCESS &&
           CVodeSetJacFn(cvode, jacobian) == CVLS_SUCCESS;
}

FcCvode* fc_cvode_new(FcMessage* message) {
    FcCvode* solver = calloc(1, sizeof *solver);
    if (solver && set_up(solver)) {
        return solver;
    }
    fc_cvode_free(solver);
    fc_message_set(message, "solver.method = cvode: no memory for CVODE");
    return NULL;
}

void fc_cvode_free(FcCvode* solver) {
    if (!solver) {
        return;
    }
    CVodeFree(&solver->cvode);
    SUNLinSolFree(solver->linear_solver);
    SUNMatDestroy(solver->matrix);
    N_VDestroy(solver->allowed);
    N_VDestroy(solver->y);
    SUNContext_Free(&solver->context);
    free(solver);
}

// Of the vibration in h [s].
static double periods_of(const FcDrive* drive, double h) {
    return fc_drive_vibrates(drive) ? h * drive->vibration.f : 0.0;
}

// The allowed local errors of the states over a step of h [s]: that of the force, times the integrals. Errors add
// up over the vibration periods that the bristle remembers: Dahl and LuGre forget a path of g / sigma.
static void set_allowed(FcCvode* solver, const FcScene* scene, const FcSolverOptions* options, double h) {
    const double stiffness = fc_scene_largest_stiffness(scene, h);
    const double path = fc_drive_largest_speed(&scene->drive, h) * h;
    const double forgets =
        scene->friction->model == FC_ELASTIC_PLASTIC ? 1.0 : stiffness * path / options->force;
    const double periods = fc_most(1.0, periods_of(&scene->drive, h) / fc_most(1.0, forgets));
    const double force = LOCAL_ERROR_FRACTION * options->tolerance / periods * options->force;
    const double delta = force / stiffness;
    const double of[STATES] = {delta,        delta,        force * h,       force * h,
                               force * path, force * path, delta * path / h};
    for (int k = 0; k < STATES; k++) {
        NV_Ith_S(solver->allowed, k) = fc_most(of[k], LEAST_ALLOWED);
    }
}

// Longest step [s] from the time t [s] that can't go over the peak of a Stribeck curve; INFINITY without one.
static double stribeck_step(const FcScene* scene, double t) {
    if (!fc_has_stribeck_curve(scene->friction)) {
        return INFINITY;
    }
    const FcDrive* drive = &scene->drive;
    const FcVibration* vibration = &drive->vibration;
    const double rate = hypot(drive->V.rate, drive->V_y.rate) +
                        drive->omega * hypot(vibration->V_1, vibration->V_2); // at most
    const double speed = hypot(fc_drive_V(drive, t), fc_drive_V_y(drive, t));
    const double change = fc_most(STRIBECK_STEP * scene->friction->V_S, 0.5 * speed);
    return rate > 0.0 ? change / rate : INFINITY;
}

// Begins the regime that the bristle has at the time t [s].
static void begin_regime(FcCvode* solver, double t, FcStepResult* now) {
    solver->start = t;
    const FcScene scene = scene_at(solver, 0.0);
    fc_take_onto_bound(&scene, now);
    const bool slips = now->slips != 0 && fc_push(&scene, fc_bristle_of(now)) > 0.0;
    now->slips = slips ? now->slips : 0; // at the event of a push of 0
    solver->slips = now->slips;
    solver->regime = fc_regime(&scene, fc_bristle_of(now));
    now->on_bound = solver->regime != FC_FREE;
    for (int k = 0; k < STATES; k++) {
        NV_Ith_S(solver->y, k) = *state(now, k);
    }
}

// Integrates from the start of the regime up to its end, or for duration [s]; returns the time taken [s], NaN
// if CVODE fails.
static double integrate_regime(FcCvode* solver, double duration) {
    void* cvode = solver->cvode;
    const double parts = STEPS_PER_PERIOD * periods_of(&solver->scene->drive, duration);
    snprintf(solver->reason, sizeof solver->reason, "%s", "too much work in one step");
    if (!(duration > 0.0) || CVodeReInit(cvode, 0.0, solver->y) != CV_SUCCESS ||
        CVodeSVtolerances(cvode, SMALLEST_LOCAL_ERROR, solver->allowed) != CV_SUCCESS ||
        CVodeSetMaxStep(cvode, duration / fc_most(1.0, parts)) != CV_SUCCESS) {
        return NAN;
    }
    double tau = 0.0;
    int flag = CV_SUCCESS;
    while (tau < duration && flag != CV_ROOT_RETURN) {
        const double step = stribeck_step(solver->scene, solver->start + tau);
        CVodeSetStopTime(cvode, fc_least(tau + step, duration));
        flag = CVode(cvode, duration, solver->y, &tau, CV_ONE_STEP);
        solver->evaluations += 1.0; // of the indicators
        if (flag >= 0 && solver->evaluations > MOST_EVALUATIONS) {
            snprintf(solver->reason, sizeof solver->reason,
                     "it needs more than %.0e evaluations; use smaller steps or collocation",
                     MOST_EVALUATIONS);
            flag = CV_TOO_MUCH_WORK;
        }
        if (flag < 0) {
            return NAN;
        }
    }
    return tau;
}

bool fc_cvode_step(FcCvode* solver, const FcScene* scene, const FcSolverOptions* options, double h,
                   FcStepResult* result, FcMessage* message) {
    assert(solver && h >= 0.0 && options->tolerance > 0.0);
    if (h > 0.0 && h < SHORTEST) {
        return fc_message_set(
            message,
            "solver.method = cvode: the communication step of %.5g s is below %.0e s; use collocation", h,
            SHORTEST);
    }
    FcFriction friction = *scene->friction; // the damping is not a part of the result
    friction.sigma_1 = friction.sigma_2 = 0.0;
    FcScene undamped = *scene;
    undamped.friction = &friction;
    solver->scene = &undamped;
    solver->evaluations = 0.0;
    set_allowed(solver, scene, options, h);
    FcStepResult now = *result;
    for (double t = 0.0; t < h;) {
        begin_regime(solver, t, &now);
        const double stop = fc_drive_next_event(&scene->drive, t, h).time;
        const double taken = integrate_regime(solver, stop - t);
        if (!isfinite(taken)) {
            return fc_message_set(
                message, "solver.method = cvode failed %.9g s into the communication step of %.5g s: %s", t,
                h, solver->reason);
        }
        t = taken < stop - t ? t + taken : stop;
        for (int k = 0; k < STATES; k++) {
            *state(&now, k) = NV_Ith_S(solver->y, k);
        }
    }
    now.evaluations += solver->evaluations;
    *result = now;
    return true;
}

#else

FcCvode* fc_cvode_new(FcMessage* message) {
    fc_message_set(message,
                   "solver.method = cvode is not in this build (built without SUNDIALS); rebuild with "
                   "-DWITH_SUNDIALS=ON or use collocation");
    return NULL;
}

void fc_cvode_free(FcCvode* solver) { (void)solver; }

bool fc_cvode_step(FcCvode* solver, const FcScene* scene, const FcSolverOptions* options, double h,
                   FcStepResult* result, FcMessage* message) {
    (void)solver, (void)scene, (void)options, (void)h, (void)result;
    return fc_message_set(message, "solver.method = cvode is not in this build");
}

#endif
