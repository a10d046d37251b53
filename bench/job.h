// A benchmark job, read from standard input as lines of a keyword and its numbers, and what is measured of it.
//
//     start 0             s, start of the run
//     step 5e-5           s, communication step H
//     count 20            steps
//     budget 0.05         s of CPU time for repeating the run, which is done at least three times
//     calls 1             every step has the length 0 and stays at the start: what the calls of the FMU cost
//     instances 10000     of the FMU, each of which makes step k before one makes step k + 1; 1 if it is not given
//     linear 1            inputs move linearly between their samples; 0: they are held over a step
//     integer 27 1        start value: value reference, value
//     real 28 1e-6        the same
//     output 3            value reference to read after every step; the first ones' values are printed
//     input 0 4 1 2 3 4   value reference, number of samples, samples; taken in turn, again from the first
//     evaluations 30      value reference of the count of right-hand sides, read at the end
//
// Printed: "cpu", the median seconds of a run; "evaluations"; "allocations" in the last run's steps and
// "allocations_to_start" where count_allocations.c is preloaded; "row" with the outputs of every step; or "failed"
// with the number of the step and the reason.
#ifndef BENCH_JOB_H
#define BENCH_JOB_H

#include <stddef.h>

enum { JOB_VALUES = 64, JOB_OUTPUTS = 8, JOB_INPUTS = 4 };

typedef struct {
    unsigned reference;
    double value;
    int is_integer;
} StartValue;

typedef struct {
    unsigned reference;
    int samples;
    double* sample; // owned
} Input;

typedef struct {
    double start;  // s
    double step;   // s
    double budget; // s
    int count;
    int instances;
    int calls;
    int linear;
    int values;
    StartValue value[JOB_VALUES];
    int outputs;
    unsigned output[JOB_OUTPUTS];
    int inputs;
    Input input[JOB_INPUTS];
    int counts_evaluations;
    unsigned evaluations;
} Job;

Job job_read(void); // stops the program with a message if a line can't be understood
double job_sample(const Input* input, int k);

// One run of a job: its own set-up, then the steps between two looks at the clock.
typedef struct {
    double cpu;                // s
    double evaluations;        // of the right-hand side
    long allocations;          // heap allocations in the steps; -1 where nobody counts them
    long allocations_to_start; // the same in the set-up
    double* row;               // outputs of all steps, count by outputs; owned by the job's measurement
    int failed_at;             // number of the step, or -1
    char reason[400];
} Run;

typedef void (*RunJob)(const Job* job, Run* run);

// Repeats the run within the job's budget and prints the medians, or the failure.
void job_measure(const Job* job, RunJob run_job);

double cpu_seconds(void); // of this thread

#endif
