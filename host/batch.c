#include "batch.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct Batch {
    const Fmi2Library* fmu;
    BatchPlan plan;
    char** reason;         // of every scenario, NULL where it was not refused
    unsigned char* status; // of every scenario
    atomic_size_t next;    // scenario to be taken
    atomic_size_t limit;   // no scenario from here on need be run
    atomic_size_t finished;
    atomic_size_t refusals;
    atomic_bool is_stopped;
};

// What one thread works with.
typedef struct {
    Batch* batch;
    Fmi2Instance instance;
    bool is_used;                  // needs a reset before the next scenario
    fmi2ValueReference* reference; // of the start values: first the real ones, then the integers
    double* real;
    fmi2Integer* integer;
    bool reads_samples; // some result is made of all samples
    bool reads_change;
    double* settled; // variables after the settling
    double* sample;  // samples by variables; only the last one where no result is made of all
} Worker;

static double of(const BatchColumn* column, size_t scenario) {
    return column->value[scenario * column->stride];
}

size_t batch_plan_size(void) { return sizeof(BatchPlan); }

Fmi2Library* batch_load(const char* path, char* why, size_t size) {
    Fmi2Library* library = malloc(sizeof *library);
    if (!library) {
        snprintf(why, size, "no memory");
    } else if (!fmi2_library_open(library, path, why, size)) {
        free(library);
        library = NULL;
    }
    return library;
}

void batch_unload(Fmi2Library* library) {
    if (library) {
        fmi2_library_close(library);
        free(library);
    }
}

Batch* batch_begin(const Fmi2Library* library, const BatchPlan* plan) {
    Batch* batch = calloc(1, sizeof *batch);
    if (!batch) {
        return NULL;
    }
    batch->fmu = library;
    batch->plan = *plan;
    batch->reason = (char**)calloc(plan->scenarios + 1, sizeof *batch->reason);
    batch->status = calloc(plan->scenarios + 1, sizeof *batch->status);
    atomic_init(&batch->limit, plan->scenarios);
    if (!batch->reason || !batch->status) {
        batch_end(batch);
        return NULL;
    }
    return batch;
}

void batch_end(Batch* batch) {
    if (!batch) {
        return;
    }
    for (size_t i = 0; batch->reason && i < batch->plan.scenarios; i++) {
        free(batch->reason[i]);
    }
    free((void*)batch->reason);
    free(batch->status);
    free(batch);
}

void batch_stop(Batch* batch) { atomic_store(&batch->is_stopped, true); }
size_t batch_finished(const Batch* batch) { return atomic_load(&batch->finished); }
size_t batch_refusals(const Batch* batch) { return atomic_load(&batch->refusals); }
const unsigned char* batch_statuses(const Batch* batch) { return batch->status; }

const char* batch_reason(const Batch* batch, size_t scenario) {
    const bool is_lost = batch->status[scenario] == BATCH_REFUSED && !batch->reason[scenario];
    return is_lost ? "refused; no memory for the reason" : batch->reason[scenario];
}

// Sum by halves with eight accumulators at the ends: the rounding error grows like log n. In the order that NumPy sums
// in, so that means here and there agree to the last bit.
// NOLINTNEXTLINE(misc-no-recursion): as deep as log n
static double sum(const double* x, size_t stride, size_t n) {
    if (n < 8) {
        double total = 0.0;
        for (size_t i = 0; i < n; i++) {
            total += x[i * stride];
        }
        return total;
    }
    if (n > 128) {
        const size_t half = n / 2 - (n / 2) % 8;
        return sum(x, stride, half) + sum(x + half * stride, stride, n - half);
    }
    double part[8];
    for (size_t j = 0; j < 8; j++) {
        part[j] = x[j * stride];
    }
    size_t i = 8;
    for (; i + 8 <= n; i += 8) {
        for (size_t j = 0; j < 8; j++) {
            part[j] += x[(i + j) * stride];
        }
    }
    double total = ((part[0] + part[1]) + (part[2] + part[3])) + ((part[4] + part[5]) + (part[6] + part[7]));
    for (; i < n; i++) {
        total += x[i * stride];
    }
    return total;
}

static double extreme(const double* x, size_t stride, size_t n, double sign) {
    double most = sign * x[0];
    for (size_t i = 1; i < n; i++) {
        most = fmax(most, sign * x[i * stride]);
    }
    return sign * most;
}

static void keep_results(const Worker* w, size_t scenario) {
    const BatchPlan* plan = &w->batch->plan;
    const size_t width = plan->variables;
    const size_t n = plan->samples;
    const double* last = w->sample + (w->reads_samples ? (n - 1) * width : 0);
    for (size_t i = 0; i < plan->results; i++) {
        const BatchResult* result = &plan->result[i];
        const size_t variable = (size_t)result->variable;
        const double* x = w->sample + variable;
        double* value = result->value + scenario;
        switch ((BatchStatistic)result->statistic) {
        case BATCH_END:
            *value = last[variable];
            break;
        case BATCH_CHANGE:
            *value = last[variable] - w->settled[variable];
            break;
        case BATCH_MEAN:
            *value = sum(x, width, n) / (double)n;
            break;
        case BATCH_LEAST:
            *value = extreme(x, width, n, -1.0);
            break;
        case BATCH_MOST:
            *value = extreme(x, width, n, 1.0);
            break;
        case BATCH_SAMPLES:
            for (size_t k = 0; k < n; k++) {
                result->value[scenario * n + k] = x[k * width];
            }
        }
    }
}

static bool accepted(fmi2Status status) { return status <= fmi2Warning; }

static bool initialize(Worker* w, size_t scenario) {
    const Fmi2Library* fmu = w->batch->fmu;
    const BatchPlan* plan = &w->batch->plan;
    fmi2Component c = w->instance.component;
    size_t reals = 0;
    size_t integers = 0;
    for (size_t i = 0; i < plan->starts; i++) {
        const double value = of(&plan->start[i].column, scenario);
        if (plan->start[i].is_integer) {
            w->integer[integers++] = (fmi2Integer)value;
        } else {
            w->real[reals++] = value;
        }
    }
    return accepted(fmu->SetupExperiment(c, fmi2False, 0.0, plan->begin, fmi2False, 0.0)) &&
           accepted(fmu->SetReal(c, w->reference, reals, w->real)) &&
           accepted(fmu->SetInteger(c, w->reference + reals, integers, w->integer)) &&
           accepted(fmu->EnterInitializationMode(c)) && accepted(fmu->ExitInitializationMode(c));
}

static bool read_variables(const Worker* w, double* value) {
    const BatchPlan* plan = &w->batch->plan;
    return accepted(w->batch->fmu->GetReal(w->instance.component, plan->variable, plan->variables, value));
}

static bool move_inputs(const Worker* w, size_t sample) {
    const Fmi2Library* fmu = w->batch->fmu;
    const BatchPlan* plan = &w->batch->plan;
    fmi2Component c = w->instance.component;
    const fmi2Integer first = 1;
    const size_t at = sample * plan->inputs;
    bool is_moved =
        plan->inputs == 0 || accepted(fmu->SetReal(c, plan->input, plan->inputs, plan->moves + at));
    for (size_t i = 0; is_moved && plan->rates && i < plan->inputs; i++) {
        is_moved =
            accepted(fmu->SetRealInputDerivatives(c, &plan->input[i], 1, &first, &plan->rates[at + i]));
    }
    return is_moved;
}

static bool simulate(Worker* w, size_t scenario) {
    const Fmi2Library* fmu = w->batch->fmu;
    const BatchPlan* plan = &w->batch->plan;
    fmi2Component c = w->instance.component;
    double unit = 1.0; // s
    if (plan->frequency) {
        double f = 0.0;
        if (!accepted(fmu->GetReal(c, plan->frequency, 1, &f))) {
            return false;
        }
        unit = 1.0 / f;
    }
    const double settle = of(&plan->settle, scenario) * unit;
    const double h = of(&plan->duration, scenario) * unit / (double)plan->samples;
    double t = plan->begin;
    if (settle > 0.0) {
        if (!accepted(fmu->DoStep(c, t, settle, fmi2True))) {
            return false;
        }
        t += settle;
    }
    if (w->reads_change && !read_variables(w, w->settled)) {
        return false;
    }
    for (size_t k = 0; k < plan->samples; k++) {
        const double step = plan->step ? plan->step[k] * unit : h;
        if (atomic_load_explicit(&w->batch->is_stopped, memory_order_relaxed) || !move_inputs(w, k) ||
            !accepted(fmu->DoStep(c, t, step, fmi2True)) ||
            (w->reads_samples && !read_variables(w, w->sample + k * plan->variables))) {
            return false;
        }
        t += step;
    }
    return w->reads_samples || read_variables(w, w->sample);
}

static void refuse(Worker* w, size_t scenario) {
    Batch* batch = w->batch;
    const char* said = w->instance.said[0] ? w->instance.said : "refused without a message";
    const size_t size = strlen(said) + 1;
    batch->reason[scenario] = malloc(size);
    if (batch->reason[scenario]) {
        memcpy(batch->reason[scenario], said, size);
    }
    batch->status[scenario] = BATCH_REFUSED;
    atomic_fetch_add(&batch->refusals, 1);
    atomic_fetch_add(&batch->finished, 1);
    if (batch->plan.stops_at_refusal) {
        size_t limit = atomic_load(&batch->limit);
        while (scenario < limit && !atomic_compare_exchange_weak(&batch->limit, &limit, scenario)) {
        }
    }
}

// A new instance at the first scenario, and where the FMU does not take its own one back.
static bool get_ready(Worker* w) {
    const Fmi2Library* fmu = w->batch->fmu;
    if (w->instance.component && (!w->is_used || accepted(fmu->Reset(w->instance.component)))) {
        w->instance.said[0] = '\0';
        w->is_used = true;
        return true;
    }
    fmi2_instance_free(&w->instance);
    w->is_used = true;
    if (!fmi2_instance_make(&w->instance, fmu, "batch", w->batch->plan.guid, w->batch->plan.resources)) {
        return false;
    }
    fmi2_instance_log_errors(&w->instance);
    return true;
}

static void run_scenario(Worker* w, size_t scenario) {
    Batch* batch = w->batch;
    if (initialize(w, scenario) && simulate(w, scenario)) {
        keep_results(w, scenario);
        batch->status[scenario] = BATCH_DONE;
        atomic_fetch_add(&batch->finished, 1);
    } else if (!atomic_load(&batch->is_stopped)) {
        refuse(w, scenario);
    }
}

static bool worker_make(Worker* w, Batch* batch) {
    const BatchPlan* plan = &batch->plan;
    *w = (Worker){.batch = batch};
    for (size_t i = 0; i < plan->results; i++) {
        const int statistic = plan->result[i].statistic;
        w->reads_change |= statistic == BATCH_CHANGE;
        w->reads_samples |= statistic != BATCH_CHANGE && statistic != BATCH_END;
    }
    const size_t rows = w->reads_samples ? plan->samples : 1;
    w->reference = calloc(plan->starts + 1, sizeof *w->reference);
    w->real = calloc(plan->starts + 1, sizeof *w->real);
    w->integer = calloc(plan->starts + 1, sizeof *w->integer);
    w->settled = calloc(plan->variables + 1, sizeof *w->settled);
    w->sample = calloc(rows * plan->variables + 1, sizeof *w->sample);
    if (!w->reference || !w->real || !w->integer || !w->settled || !w->sample) {
        return false;
    }
    size_t count = 0;
    for (int is_integer = 0; is_integer <= 1; is_integer++) {
        for (size_t i = 0; i < plan->starts; i++) {
            if ((plan->start[i].is_integer != 0) == is_integer) {
                w->reference[count++] = plan->start[i].reference;
            }
        }
    }
    return true;
}

static void worker_free(Worker* w) {
    fmi2_instance_free(&w->instance);
    free(w->reference);
    free(w->real);
    free(w->integer);
    free(w->settled);
    free(w->sample);
}

int batch_work(Batch* batch, char* why, size_t size) {
    Worker w;
    bool is_able = worker_make(&w, batch);
    if (!is_able) {
        snprintf(why, size, "no memory");
    }
    while (is_able && !atomic_load(&batch->is_stopped)) {
        const size_t scenario = atomic_fetch_add(&batch->next, 1);
        if (scenario >= atomic_load(&batch->limit)) {
            break;
        }
        is_able = get_ready(&w);
        if (is_able) {
            run_scenario(&w, scenario);
        } else {
            snprintf(why, size, "%s", w.instance.said);
        }
    }
    worker_free(&w);
    return is_able;
}
