// What every solver method does: take the deflection over one communication step.
#ifndef FC_SOLVER_H
#define FC_SOLVER_H

#include "dahl.h"
#include "message.h"

typedef enum {
    METHOD_COLLOCATION = 1,
    METHOD_CVODE = 2,
    METHOD_BACKWARD_EULER = 3,
    METHOD_TRAPEZOID = 4,
    METHOD_RK4 = 5,
    METHOD_EXPLICIT_EULER = 6
} SolverMethod;

typedef struct {
    double tolerance; // 1  bound of the error of F_t and of its mean, over F_C
    double step_size; // s  internal step of the fixed-step methods
} SolverOptions;

typedef struct {
    double delta;       // m    deflection at the end of the step
    double impulse;     // N s  integral of F_t dt over the step
    double work;        // J    integral of F_t V dt over the step
    double evaluations; // 1    evaluations of a(t), b(t)
} StepResult;

// Evaluations in one communication step, some 10 s of computing: a step that needs more is refused, so that none
// seems to hang. Only inputs that move over many orders of magnitude get there.
#ifndef FC_MOST_EVALUATIONS
#define FC_MOST_EVALUATIONS 1e8
#endif

// Each of these returns 1 and fills *result, or returns 0, fills *message and leaves *result alone.
// h [s] >= 0; delta_0 [m] the deflection at the start of the step.
int collocation_step(const DahlProblem* problem, const SolverOptions* options, double h, double delta_0,
                     StepResult* result, Message* message);
int fixed_step_step(const DahlProblem* problem, SolverMethod method, const SolverOptions* options, double h,
                    double delta_0, StepResult* result, Message* message);

// CVODE keeps its memory between steps, never its state. Built without SUNDIALS, cvode_solver_new returns NULL and
// says so in *message.
typedef struct CvodeSolver CvodeSolver;
CvodeSolver* cvode_solver_new(Message* message);
void cvode_solver_free(CvodeSolver* solver); // NULL is allowed
int cvode_solver_step(CvodeSolver* solver, const DahlProblem* problem, const SolverOptions* options, double h,
                      double delta_0, StepResult* result, Message* message);

#endif
