#define _POSIX_C_SOURCE 200809L
#include "job.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MIN_RUNS = 3, MAX_RUNS = 1001 };

double cpu_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void stop(const char* what, const char* detail) {
    fprintf(stderr, "error: %s: %s\n", what, detail);
    exit(2);
}

static void* allocate(size_t count, size_t size) {
    void* memory = calloc(count ? count : 1, size);
    if (!memory) {
        stop("no memory", "for the samples or outputs of the job");
    }
    return memory;
}

static double read_number(const char* keyword) {
    double number = 0.0;
    if (scanf("%lf", &number) != 1) {
        stop("a number is missing after", keyword);
    }
    return number;
}

static void read_input(Job* job) {
    if (job->inputs == JOB_INPUTS) {
        stop("too many lines of", "input");
    }
    Input* input = &job->input[job->inputs++];
    input->reference = (unsigned)read_number("input");
    input->samples = (int)read_number("input");
    if (input->samples < 1) {
        stop("the number of samples must be at least 1 in", "input");
    }
    input->sample = allocate((size_t)input->samples, sizeof *input->sample);
    for (int k = 0; k < input->samples; k++) {
        input->sample[k] = read_number("input");
    }
}

static void read_value(Job* job, const char* keyword) {
    if (job->values == JOB_VALUES) {
        stop("too many start values at", keyword);
    }
    StartValue* value = &job->value[job->values++];
    value->is_integer = strcmp(keyword, "integer") == 0;
    value->reference = (unsigned)read_number(keyword);
    value->value = read_number(keyword);
}

Job job_read(void) {
    Job job = {.count = 1, .step = 1.0, .instances = 1};
    char keyword[32];
    while (scanf("%31s", keyword) == 1) {
        if (strcmp(keyword, "start") == 0) {
            job.start = read_number(keyword);
        } else if (strcmp(keyword, "step") == 0) {
            job.step = read_number(keyword);
        } else if (strcmp(keyword, "budget") == 0) {
            job.budget = read_number(keyword);
        } else if (strcmp(keyword, "count") == 0) {
            job.count = (int)read_number(keyword);
        } else if (strcmp(keyword, "instances") == 0) {
            job.instances = (int)read_number(keyword);
        } else if (strcmp(keyword, "calls") == 0) {
            job.calls = (int)read_number(keyword);
        } else if (strcmp(keyword, "linear") == 0) {
            job.linear = (int)read_number(keyword);
        } else if (strcmp(keyword, "integer") == 0 || strcmp(keyword, "real") == 0) {
            read_value(&job, keyword);
        } else if (strcmp(keyword, "output") == 0 && job.outputs < JOB_OUTPUTS) {
            job.output[job.outputs++] = (unsigned)read_number(keyword);
        } else if (strcmp(keyword, "input") == 0) {
            read_input(&job);
        } else if (strcmp(keyword, "evaluations") == 0) {
            job.counts_evaluations = 1;
            job.evaluations = (unsigned)read_number(keyword);
        } else {
            stop("unknown keyword, or too many lines of it", keyword);
        }
    }
    return job;
}

double job_sample(const Input* input, int k) { return input->sample[k % input->samples]; }

static int ascending(const void* a, const void* b) {
    const double x = *(const double*)a;
    const double y = *(const double*)b;
    return (x > y) - (x < y);
}

static double median(double* values, int count) {
    qsort(values, (size_t)count, sizeof *values, ascending);
    return values[count / 2];
}

static void print_rows(const Job* job, const Run* run) {
    for (int k = 0; k < job->count; k++) {
        printf("row");
        for (int i = 0; i < job->outputs; i++) {
            printf(" %.17g", run->row[k * job->outputs + i]);
        }
        printf("\n");
    }
}

void job_measure(const Job* job, RunJob run_job) {
    static double cpu[MAX_RUNS];
    Run run = {.failed_at = -1, .allocations = -1};
    run.row = allocate((size_t)job->count * (size_t)job->outputs, sizeof *run.row);
    int runs = 0;
    double spent = 0.0;
    while (runs < MIN_RUNS || (spent < job->budget && runs < MAX_RUNS)) {
        run_job(job, &run);
        if (run.failed_at >= 0) {
            printf("failed %d %s\n", run.failed_at, run.reason);
            return;
        }
        cpu[runs++] = run.cpu;
        spent += run.cpu;
        if (spent > 20.0 * job->budget) {
            break; // a slow method: one run tells
        }
    }
    printf("cpu %.9g\nevaluations %.17g\n", median(cpu, runs), run.evaluations);
    if (run.allocations >= 0) {
        printf("allocations %ld\nallocations_to_start %ld\n", run.allocations, run.allocations_to_start);
    }
    print_rows(job, &run);
    free(run.row);
}
