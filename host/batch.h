// Many scenarios of an FMU: columns of values in, columns of results out.
//
// A scenario sets the values of its row, settles in one step that is not read, then takes `samples` equal steps and
// reads after each of them:
//
//     0 --- settle --- | h | h | h | ... | h |     h = duration / samples
//
// or steps of given lengths, with inputs that are set before each of them and move at given rates.
//
// Settle and duration are seconds, or periods 1/f where the plan names the frequency f.
//
//     Batch* batch = batch_begin(&fmu, &plan);
//     batch_work(batch, why, sizeof why);     on as many threads as one likes; returns when no scenario is left
//     ... batch_statuses(batch)[i], plan.result[k].value[i] ...
//     batch_end(batch);
//
// Each call of batch_work has one instance that it resets between scenarios. A refused scenario keeps the FMU's
// message and leaves its results untouched; the others go on.
#ifndef HOST_BATCH_H
#define HOST_BATCH_H

#include "fmi2_library.h"

#ifdef _WIN32
#define BATCH_API __declspec(dllexport)
#else
#define BATCH_API __attribute__((visibility("default")))
#endif

// Values that the scenarios have of one thing, one after another; or one value for all, then stride is 0.
typedef struct {
    const double* value;
    size_t stride; // 1 or 0
} BatchColumn;

typedef struct {
    fmi2ValueReference reference;
    int is_integer; // or an enumeration: its values are whole numbers
    BatchColumn column;
} BatchStart;

typedef enum {
    BATCH_END,     // after the last step
    BATCH_CHANGE,  // from after the settling to after the last step
    BATCH_MEAN,    // of the samples
    BATCH_LEAST,   // of the samples
    BATCH_MOST,    // of the samples
    BATCH_SAMPLES, // all of them: `samples` values a scenario
} BatchStatistic;

typedef struct {
    int variable;  // index into BatchPlan.variable
    int statistic; // BatchStatistic
    double* value; // of every scenario, `samples` each where the statistic is BATCH_SAMPLES
} BatchResult;

// Everything is the caller's and must stay in place until batch_end.
typedef struct {
    const char* guid;
    const char* resources; // URI, or NULL
    size_t scenarios;
    size_t starts;
    const BatchStart* start;
    size_t variables;
    const fmi2ValueReference* variable; // real variables that are read
    size_t results;
    const BatchResult* result;
    const fmi2ValueReference* frequency; // of the vibration, Hz: times are its periods; NULL: seconds
    double begin;                        // time at which every scenario starts, s
    BatchColumn settle;
    BatchColumn duration;
    size_t samples;
    size_t inputs; // that move, alike in all scenarios
    const fmi2ValueReference* input;
    const double* moves;  // samples by inputs: what they are set to before each step
    const double* rates;  // samples by inputs: their time derivatives over each step; NULL: they are held
    const double* step;   // length of each step; NULL: all are duration / samples
    int stops_at_refusal; // then no scenario after the first one that is refused need be run
} BatchPlan;

typedef enum { BATCH_NOT_RUN, BATCH_DONE, BATCH_REFUSED } BatchStatus;

typedef struct Batch Batch;

// What a caller in another language checks its own declaration of BatchPlan against.
BATCH_API size_t batch_plan_size(void);

// The library of an FMU, loaded; NULL and why where that fails. It must outlive its batches.
BATCH_API Fmi2Library* batch_load(const char* path, char* why, size_t size);
BATCH_API void batch_unload(Fmi2Library* library);

// NULL where memory lacks.
BATCH_API Batch* batch_begin(const Fmi2Library* library, const BatchPlan* plan);

// Runs scenarios that no other thread has taken until none is left or batch_stop is called. False and why where the
// FMU gives no instance or memory lacks.
BATCH_API int batch_work(Batch* batch, char* why, size_t size);

// These may be called at any time, from any thread. A stop takes effect at the end of the present steps.
BATCH_API void batch_stop(Batch* batch);
BATCH_API size_t batch_finished(const Batch* batch); // scenarios done or refused so far
BATCH_API size_t batch_refusals(const Batch* batch);

// After all batch_work have returned.
BATCH_API const unsigned char* batch_statuses(const Batch* batch);       // BatchStatus of every scenario
BATCH_API const char* batch_reason(const Batch* batch, size_t scenario); // of a refusal, else NULL
BATCH_API void batch_end(Batch* batch);

#endif
