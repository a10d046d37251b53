// SUNDIALS CVODE: variable-order BDF of the contact as model exchange states it (model/motion.h): its motion,
// whose derivatives are the Jacobian, and the events that end a state of the bristle.
//
// CVODE is started anew at every event and at the reversals of V, in a time that begins at 0: it never steps
// over a kink, and no history outlives a step. The errors have absolute bounds, because an error of the
// deflection is multiplied when the contact stiffens. A Stribeck curve is a bump of g around V = 0: steps
// shrink with |V| so that none passes it unseen.
//
// With a mass (solver/body.h) V is w. The states are then those of the bristle, the impulse of its force, and the part of
// the position that F_t makes; v follows from them. Reversals of w are events.
#include "solver/cvode.h"

#include <stdio.h>

#include "model/extremes.h"

// FC_NO_CVODE leaves it out of any build: SUNDIALS takes memory from the heap, which some targets do not have.
#if defined(FC_WITH_SUNDIALS) && !defined(FC_NO_CVODE)

#include <assert.h>
#include <cvode/cvode.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "model/motion.h"
#include "model/pi.h"
#include "model/root.h"
#include "solver/periods/segments.h"

// Each is chosen empirically: half of it costs steps, twice of it doubles the error that passes
// (tests/solver/test_cvode.py). The part of solver.tolerance that bounds the local error of one step, so that the
// sum of the errors is within it, and that of a state, for its rounding.
#define LOCAL_ERROR_FRACTION 0.003
#define LOCAL_ERROR_FRACTION_OF_BODY 0.001 // what a mass remembers adds up
#define SMALLEST_LOCAL_ERROR 1e-14
#define STEPS_PER_PERIOD 8.0 // at least: the vibration can't slip between two steps
// A Stribeck curve falls from its peak within some V_S. In a step V moves by at most half of |V|, so that
// steps approach the peak geometrically, and on the peak by this part of V_S.
#define STRIBECK_STEP 0.25

// The states: the deflection, and the integrals of FcStepResult; with a mass what F_t adds to its position.
enum { DELTA, DELTA_Y, IMPULSE, IMPULSE_Y, WORK, HEAT, DRAG, POSITION, MAX_STATES };

// Indicators of events: those of a state of the bristle; with a mass w, and the slope of F_t over the rate of w.
enum { OF_STATE = 0, REVERSAL = 2, JUMP = 3, MAX_INDICATORS = 4 };

struct FcCvode {
    SUNContext context;
    N_Vector y;
    N_Vector allowed; // local errors
    SUNMatrix matrix;
    SUNLinearSolver linear_solver;
    void* cvode;
    int states; // their number
    // The present state of the bristle, for the callbacks.
    FcScene scene; // without damping, which is not a part of the result
    FcFriction friction;
    double start; // s, local time at which the state starts; CVODE's time is 0 there
    FcBristleState state;
    double evaluations; // of the motion
    char reason[160];   // CVODE's last error message
    // The mass at the start of the step, the damping, and the largest acceleration [m/s2].
    FcBody body;
    const FcFriction* damped;
    double delta_0, impulse_0, position;
    double acceleration;
};

static double* state(FcCvode* solver, FcStepResult* of, int k) {
    double* const all[] = {&of->delta, &of->delta_y, &of->impulse, &of->impulse_y,
                           &of->work,  &of->heat,    &of->drag,    &solver->position};
    return all[k];
}

// CVODE refuses 0, and squares what an error is over it.
static const double MIN_ALLOWED = 1e-100;

// The shortest communication step [s]: CVODE multiplies steps with each other, and numbers below 1e-308 take it long.
static const double SHORTEST = 1e-50;

// The largest number of evaluations in a communication step, a second of computing: each makes a scene.
static const double MAX_EVALUATIONS = 2e5;
static const double MAX_EVALUATIONS_OF_BODY = 4e5;

static bool has_body(const FcCvode* solver) { return solver->states > POSITION; }

// The impulse [N s] of F_t since the start of the step, at the time t [s].
static double impulse_of(const FcCvode* solver, double t, double delta, double impulse, double position) {
    const FcBody* body = &solver->body;
    assert(has_body(solver) && body->m > 0.0);
    double of = impulse - solver->impulse_0 + solver->damped->sigma_1 * (delta - solver->delta_0);
    if (solver->damped->sigma_2 != 0.0) {
        of += solver->damped->sigma_2 * (fc_drive_displacement(&solver->scene.drive, 0.0, t) + body->v * t +
                                         fc_body_pushed_twice(body, t) / body->m + position);
    }
    return of;
}

static double velocity_of(const FcCvode* solver, double t, double impulse) {
    return solver->body.v + (fc_body_pushed(&solver->body, t) - impulse) / solver->body.m;
}

// The scene in which the bristle moves; *impulse [N s] becomes that of F_t.
static FcScene scene_at(const FcCvode* solver, double tau, N_Vector y, double* impulse) {
    const double t = solver->start + tau;
    FcScene scene = fc_scene_from(&solver->scene, t);
    *impulse = 0.0;
    if (has_body(solver)) {
        *impulse = impulse_of(solver, t, NV_Ith_S(y, DELTA), NV_Ith_S(y, IMPULSE), NV_Ith_S(y, POSITION));
        scene.drive.V.value += velocity_of(solver, t, *impulse);
    }
    return scene;
}

static FcBristle bristle_of(const FcCvode* solver, N_Vector y) {
    return (FcBristle){.delta = NV_Ith_S(y, DELTA), .state = solver->state, .delta_y = NV_Ith_S(y, DELTA_Y)};
}

// Of a motion, or of its derivative by the deflection.
static void set_rates(const FcScene* now, const FcMotion* motion, double rate[MAX_STATES]) {
    rate[DELTA] = motion->rates.delta;
    rate[DELTA_Y] = motion->rates.delta_y;
    rate[IMPULSE] = motion->force.x;
    rate[IMPULSE_Y] = motion->force.y;
    rate[WORK] = motion->rates.W_f;
    rate[HEAT] = motion->rates.Q_f;
    rate[DRAG] = motion->rates.delta * fc_drive_V(&now->drive, 0.0) +
                 motion->rates.delta_y * fc_drive_V_y(&now->drive, 0.0);
}

// The bound of a bristle that slips moves with w.
static void add_acceleration(const FcCvode* solver, double t, FcBristle bristle, FcScene* scene) {
    if (has_body(solver) && bristle.state == FC_SLIPPING && fc_has_static_friction(scene->friction)) {
        FcScene damped = *scene;
        damped.friction = solver->damped;
        const double F = solver->body.F.value + solver->body.F.rate * t;
        scene->drive.V.rate += fc_body_acceleration(&damped, bristle, &solver->body, F);
    }
}

// m and the slope of F_t over the rate of w, of m, above 0 while w follows smoothly.
static double inertia_of(const FcCvode* solver, FcBristle bristle, const FcScene* scene) {
    FcScene damped = *scene;
    damped.friction = solver->damped;
    return fc_body_inertia(&damped, bristle, &solver->body) / solver->body.m - FC_MIN_INERTIA;
}

static int right_hand_side(realtype tau, N_Vector y, N_Vector rates, void* user) {
    FcCvode* solver = user;
    double impulse;
    FcScene now = scene_at(solver, tau, y, &impulse);
    add_acceleration(solver, solver->start + tau, bristle_of(solver, y), &now);
    const FcMotion motion = fc_motion(&now, bristle_of(solver, y));
    solver->evaluations += 1.0;
    double* rate = NV_DATA_S(rates);
    set_rates(&now, &motion, rate);
    if (has_body(solver)) {
        const double w = fc_drive_V(&now.drive, 0.0);
        const double damping = (solver->damped->sigma_1 * rate[DELTA] + solver->damped->sigma_2 * w) * w;
        rate[WORK] += damping;
        rate[HEAT] += damping;
        rate[POSITION] = -impulse / solver->body.m;
    }
    return 0;
}

// By delta, the impulse and the position, on each of which w depends. The rate of a bound that follows w is left out: it
// moves delta alone, on which nothing depends then but by sigma_1.
static void jacobian_of_body(const FcCvode* solver, const FcScene* now, N_Vector y, SUNMatrix J) {
    const FcFriction* damped = solver->damped;
    const double m = solver->body.m;
    assert(has_body(solver) && m > 0.0);
    const double w = fc_drive_V(&now->drive, 0.0);
    const FcBristle bristle = bristle_of(solver, y);
    const double delta_rate = fc_motion(now, bristle).rates.delta;
    const int of[] = {DELTA, IMPULSE, POSITION};
    const FcDirection along[] = {
        {.delta = 1.0, .V = -damped->sigma_1 / m}, {.V = -1.0 / m}, {.V = -damped->sigma_2 / m}};
    for (int k = 0; k < 3; k++) {
        const FcMotion by = fc_motion_along(now, bristle, &along[k]);
        double* column = SM_COLUMN_D(J, of[k]);
        set_rates(now, &by, column);
        const double damping = damped->sigma_1 * (by.rates.delta * w + delta_rate * along[k].V) +
                               2.0 * damped->sigma_2 * w * along[k].V;
        column[WORK] += damping;
        column[HEAT] += damping;
        column[POSITION] = along[k].V;
    }
}

static int jacobian(realtype tau, N_Vector y, N_Vector rates, SUNMatrix J, void* user, N_Vector t1,
                    N_Vector t2, N_Vector t3) {
    (void)rates, (void)t1, (void)t2, (void)t3;
    const FcCvode* solver = user;
    double impulse;
    const FcScene now = scene_at(solver, tau, y, &impulse);
    if (has_body(solver)) {
        jacobian_of_body(solver, &now, y, J);
        return 0;
    }
    const FcDirection along[] = {{.delta = 1.0}, {.delta_y = 1.0}};
    for (int k = DELTA; k <= DELTA_Y; k++) {
        const FcMotion by = fc_motion_along(&now, bristle_of(solver, y), &along[k]);
        set_rates(&now, &by, SM_COLUMN_D(J, k));
    }
    return 0;
}

static int indicators(realtype tau, N_Vector y, realtype* z, void* user) {
    const FcCvode* solver = user;
    double impulse;
    FcScene now = scene_at(solver, tau, y, &impulse);
    const FcBristle bristle = bristle_of(solver, y);
    if (has_body(solver)) {
        z[REVERSAL] = fc_may_stick(solver->scene.friction) ? 1.0 : fc_drive_V(&now.drive, 0.0);
        z[JUMP] = inertia_of(solver, bristle, &now);
        add_acceleration(solver, solver->start + tau, bristle, &now);
    }
    fc_bound_indicators(&now, bristle, &z[OF_STATE]);
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
    solver->y = N_VNew_Serial(solver->states, solver->context);
    solver->allowed = N_VNew_Serial(solver->states, solver->context);
    solver->matrix = SUNDenseMatrix(solver->states, solver->states, solver->context);
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
           CVodeRootInit(cvode, has_body(solver) ? MAX_INDICATORS : REVERSAL, indicators) == CV_SUCCESS &&
           CVodeSetLinearSolver(cvode, solver->linear_solver, solver->matrix) == CVLS_SUCCESS &&
           CVodeSetJacFn(cvode, jacobian) == CVLS_SUCCESS;
}

FcCvode* fc_cvode_new(bool with_body, FcMessage* message) {
    FcCvode* solver = calloc(1, sizeof *solver);
    if (solver) {
        solver->states = with_body ? MAX_STATES : POSITION;
    }
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
// up over the vibration periods that the bristle remembers: Dahl and LuGre forget a path of g / sigma. With a mass those of
// ringing without vibration, and of energies, which are never forgotten, add up as those of chance do.
static void set_allowed(FcCvode* solver, const FcScene* scene, const FcSolverOptions* options, double h) {
    assert(h >= 0.0 && options->tolerance > 0.0 && options->force >= 0.0);
    const double stiffness = fc_scene_largest_stiffness(scene, h);
    const double vibrations = periods_of(&scene->drive, h);
    const double ring = has_body(solver) ? sqrt(solver->body.m / stiffness) : INFINITY; // s, of an angle of 1
    FcDrive drive = scene->drive;
    drive.V.value += solver->body.v;
    const double path = (fc_drive_largest_speed(&drive, h) + options->force / stiffness / ring) * h;
    const double forgets = fc_may_stick(scene->friction) ? 1.0 : stiffness * path / options->force;
    double periods = fc_max(1.0, vibrations / fc_max(1.0, forgets));
    double energy = 1.0; // in errors of the force
    if (has_body(solver) && vibrations == 0.0) {
        periods = fc_max(1.0, sqrt(h / (FC_TWO_PI * ring)));
    } else if (has_body(solver)) {
        energy = fc_min(1.0, periods / sqrt(fc_max(1.0, vibrations)));
    }
    const double fraction = has_body(solver) ? LOCAL_ERROR_FRACTION_OF_BODY : LOCAL_ERROR_FRACTION;
    const double force = fraction * options->tolerance / periods * options->force;
    const double delta = force / stiffness;
    energy *= force * path;
    const double impulse = force * fc_min(h, ring);
    const double moved = has_body(solver) ? impulse * h / solver->body.m : 0.0;
    const double of[] = {delta, delta, impulse, force * h, energy, energy, delta * path / h, moved};
    for (int k = 0; k < solver->states; k++) {
        NV_Ith_S(solver->allowed, k) = fc_max(of[k], MIN_ALLOWED);
    }
}

// Longest step [s] from the time t [s] that can't go over the peak of a Stribeck curve; INFINITY without one.
static double stribeck_step(const FcCvode* solver, double tau) {
    if (!fc_has_stribeck_curve(solver->scene.friction)) {
        return INFINITY;
    }
    const FcScene* scene = &solver->scene;
    const FcDrive* drive = &scene->drive;
    const FcVibration* vibration = &drive->vibration;
    double rate = hypot(drive->V.rate, drive->V_y.rate) +
                  drive->omega * hypot(vibration->V_1, vibration->V_2); // at most
    const double t = solver->start + tau;
    double speed = hypot(fc_drive_V(drive, t), fc_drive_V_y(drive, t));
    if (has_body(solver)) {
        double impulse;
        const FcScene now = scene_at(solver, tau, solver->y, &impulse);
        speed = fabs(fc_drive_V(&now.drive, 0.0));
        rate += solver->acceleration;
    }
    const double change = fc_max(STRIBECK_STEP * scene->friction->V_S, 0.5 * speed);
    assert(change > 0.0);
    return rate > 0.0 ? change / rate : INFINITY;
}

static void put(FcCvode* solver, FcStepResult* now) {
    for (int k = 0; k < solver->states; k++) {
        NV_Ith_S(solver->y, k) = *state(solver, now, k);
    }
}

// The scene at the start of a state of the bristle.
static FcScene scene_with(FcCvode* solver, FcStepResult* now) {
    put(solver, now);
    double impulse;
    FcScene scene = scene_at(solver, 0.0, solver->y, &impulse);
    FcBristle slipping = fc_bristle_of(now); // if it slips
    slipping.state = FC_SLIPPING;
    add_acceleration(solver, solver->start, slipping, &scene);
    return scene;
}

// Begins the state that the bristle has at the time t [s].
static void begin_state(FcCvode* solver, double t, FcStepResult* now) {
    solver->start = t;
    FcScene scene = scene_with(solver, now);
    if (has_body(solver) && fc_has_static_friction(scene.friction)) {
        // What it does then is known after the drop, since it moves w and by the force its rate.
        const double reached = fc_size(fc_project_onto_bound(&scene, fc_bristle_of(now)));
        FcBristle before = fc_bristle_of(now);
        before.state = solver->state;
        const bool breaks_away = !fc_has_broken_away(scene.friction, now->state) &&
                                 reached < (1.0 - 2.0 * FC_ROUNDING_OF_BOUND) * fc_size(fc_bristle_of(now));
        if (breaks_away || inertia_of(solver, before, &scene) <= 0.0) {
            fc_body_drop(&scene, solver->body.m, solver->damped->sigma_1, now);
            scene = scene_with(solver, now);
        }
    }
    fc_project_result(&scene, now);
    now->state = solver->state = fc_bristle_state_at_event(&scene, fc_bristle_of(now));
    put(solver, now);
}

// Integrates from the start of the state up to its end, or for duration [s]; returns the time taken [s], NaN
// if CVODE fails.
static double integrate_state(FcCvode* solver, double duration) {
    void* cvode = solver->cvode;
    const double parts = STEPS_PER_PERIOD * periods_of(&solver->scene.drive, duration);
    snprintf(solver->reason, sizeof solver->reason, "%s", "too much work in one step");
    if (!(duration > 0.0) || CVodeReInit(cvode, 0.0, solver->y) != CV_SUCCESS ||
        CVodeSVtolerances(cvode, SMALLEST_LOCAL_ERROR, solver->allowed) != CV_SUCCESS ||
        CVodeSetMaxStep(cvode, duration / fc_max(1.0, parts)) != CV_SUCCESS) {
        return NAN;
    }
    double tau = 0.0;
    int flag = CV_SUCCESS;
    while (tau < duration && flag != CV_ROOT_RETURN) {
        const double step = stribeck_step(solver, tau);
        CVodeSetStopTime(cvode, fc_min(tau + step, duration));
        flag = CVode(cvode, duration, solver->y, &tau, CV_ONE_STEP);
        solver->evaluations += 1.0; // of the indicators
        const double most = has_body(solver) ? MAX_EVALUATIONS_OF_BODY : MAX_EVALUATIONS;
        if (flag >= 0 && solver->evaluations > most) {
            snprintf(solver->reason, sizeof solver->reason,
                     "it needs more than %.0e evaluations; use smaller steps%s", most,
                     has_body(solver) ? "" : " or collocation");
            flag = CV_TOO_MUCH_WORK;
        }
        if (flag < 0) {
            return NAN;
        }
    }
    return tau;
}

// Takes *result over [0, h] of the scene without damping. False with solver->reason.
static bool integrate(FcCvode* solver, const FcScene* scene, const FcSolverOptions* options, double h,
                      double* t, FcStepResult* result) {
    solver->friction = *scene->friction;
    solver->friction.sigma_1 = solver->friction.sigma_2 = 0.0;
    solver->scene = *scene;
    solver->scene.friction = &solver->friction;
    solver->evaluations = 0.0;
    solver->state = FC_FREE;
    set_allowed(solver, scene, options, h);
    FcStepResult now = *result;
    for (*t = 0.0; *t < h;) {
        begin_state(solver, *t, &now);
        const double stop = has_body(solver) ? h : fc_drive_next_event(&scene->drive, *t, h).time;
        assert(stop >= *t && stop <= h);
        const double taken = integrate_state(solver, stop - *t);
        if (!isfinite(taken)) {
            return false;
        }
        *t = taken < stop - *t ? *t + taken : stop;
        for (int k = 0; k < solver->states; k++) {
            *state(solver, &now, k) = NV_Ith_S(solver->y, k);
        }
    }
    now.evaluations += solver->evaluations;
    *result = now;
    return true;
}

bool fc_cvode_step(FcCvode* solver, const FcScene* scene, const FcSolverOptions* options, double h,
                   FcStepResult* result, FcMessage* message) {
    assert(solver && !has_body(solver) && h >= 0.0 && options->tolerance > 0.0);
    if (h > 0.0 && h < SHORTEST) {
        return fc_message_set(
            message,
            "solver.method = cvode: the communication step of %.5g s is below %.0e s; use collocation", h,
            SHORTEST);
    }
    double t;
    return integrate(solver, scene, options, h, &t, result) ||
           fc_message_set(message,
                          "solver.method = cvode failed %.9g s into the communication step of %.5g s: %s", t,
                          h, solver->reason);
}

bool fc_body_cvode_step(FcCvode* solver, const FcScene* scene, const FcSolverOptions* options, double h,
                        FcBody* body, FcStepResult* result, FcMessage* message) {
    assert(solver && has_body(solver) && h >= 0.0 && options->tolerance > 0.0);
    const double F = fc_max(fabs(body->F.value), fabs(body->F.value + body->F.rate * h));
    solver->body = *body;
    solver->damped = scene->friction;
    solver->delta_0 = result->delta;
    solver->impulse_0 = result->impulse;
    solver->position = 0.0;
    solver->acceleration = (F + options->largest) / body->m;
    double t;
    if (h > 0.0 && (h < SHORTEST || !integrate(solver, scene, options, h, &t, result))) {
        return fc_body_refuse(scene, body, h, h < SHORTEST ? "it is too short for cvode" : solver->reason,
                              message);
    }
    const double impulse = impulse_of(solver, h, result->delta, result->impulse, solver->position);
    result->impulse = solver->impulse_0 + impulse;
    body->x += body->v * h + fc_body_pushed_twice(body, h) / body->m + solver->position;
    fc_body_move(body, h, impulse);
    return true;
}

#else

FcCvode* fc_cvode_new(bool with_body, FcMessage* message) {
    (void)with_body;
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

bool fc_body_cvode_step(FcCvode* solver, const FcScene* scene, const FcSolverOptions* options, double h,
                        FcBody* body, FcStepResult* result, FcMessage* message) {
    (void)solver, (void)scene, (void)options, (void)h, (void)body, (void)result;
    return fc_message_set(message, "solver.method = cvode is not in this build");
}

#endif
