// Hunts for wrong answers: draws sequences of steps at random, takes them with the FMU's core, grades each step by the
// reference (trial.h has the rule), and prints each step that is not within the tolerance.
//
//     cmake --preset default && cmake --build --preset default --target hunt
//     build/hunt/hunt --seed 1 --scenes 20000 --jobs 2
//     build/hunt/hunt --replay "tolerance=1e-6 V=0.5 V_1=1.44 law=LuGre staticRatio=1.3 then V=0.2"
//
// Each miss is one line, with the sequence as --replay reads it. The last line has the sums. Ends with 1 if a step missed.
#include <getopt.h>
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "scenes.h"
#include "trial.h"

enum { MOST_JOBS = 64 };

typedef struct {
    double seed, scenes, minutes, jobs;
    double minimize; // misses that are made plain, at most
    Kind kind;
    const char *replay, *file;
} Options;

// A hunt, by several threads.
typedef struct {
    Options options;
    time_t begin;
    atomic_ullong next; // the number of the sequence to be drawn next, from 0 on
    pthread_mutex_t lock;
    long sequences, steps, misses, refused, unknown;
    double worst; // error over the allowed error
    double work;  // the sum of ln(1 + evaluations) over the sequences
} Hunt;

// Whether a step of the sequence misses by 1.5 allowed errors or more, in any result.
static bool still_misses(const Sequence* sequence) {
    Trial trial;
    trial_run(&trial, sequence);
    return trial.worst > 1.5;
}

static void print_miss(Hunt* hunt, const Sequence* sequence, const TrialStep* taken, int step) {
    char text[SEQUENCE_TEXT];
    sequence_text(sequence, text, sizeof text);
    printf("miss law=%s ratio=%.3g of=%s step=%d kappa=%.1e: %s\n", law_name(taken->scene.law),
           taken->verdict.ratio, GRADE_NAMES[taken->verdict.of], step + 1, scene_kappa(&taken->scene), text);
    if (hunt->options.minimize > 0 && still_misses(sequence)) {
        hunt->options.minimize--;
        make_plain(text, still_misses);
        printf("plain: %s\n", text);
    }
    fflush(stdout);
}

static void print_step(const TrialStep* taken, int step) {
    printf("step %d: ratio %.3g of %s; S %g N, path %g m, from delta %.17g, %.17g side %g\n", step + 1,
           taken->verdict.ratio, GRADE_NAMES[taken->verdict.of], taken->truth.S, taken->truth.path,
           taken->scene.delta_0, taken->scene.delta_y_0, taken->scene.slips);
    for (int k = 0; k < RESULTS; k++) {
        printf("  %-9s  FMU %24.17g  reference %24.17g\n", GRADE_NAMES[k], taken->step.result[k],
               taken->truth.result[k]);
    }
    if (step == 0) {
        printf("  settled    FMU %.17g, %.17g  reference %.17g, %.17g\n", taken->settled.x, taken->settled.y,
               taken->settled_truth[0], taken->settled_truth[1]);
    }
}

static void try_sequence(Hunt* hunt, Sequence sequence) {
    Trial trial;
    trial_run(&trial, &sequence);
    pthread_mutex_lock(&hunt->lock);
    hunt->sequences++;
    hunt->steps += trial.steps;
    hunt->unknown += trial.unknown;
    hunt->refused += trial.refused;
    hunt->worst = fmax(hunt->worst, trial.worst);
    hunt->work += log1p(trial.evaluations);
    if (trial.refused) {
        char text[SEQUENCE_TEXT];
        sequence_text(&sequence, text, sizeof text);
        printf("refused step=%d: %s; %s\n", trial.steps + 1, trial.message.text, text);
    }
    for (int k = 0; k < trial.steps; k++) {
        if (!(trial.taken[k].verdict.ratio <= 1.0)) {
            hunt->misses++;
            print_miss(hunt, &sequence, &trial.taken[k], k);
        }
        if (hunt->options.replay) {
            print_step(&trial.taken[k], k);
        }
    }
    pthread_mutex_unlock(&hunt->lock);
}

static void* run_job(void* of) {
    Hunt* hunt = of;
    const Options* o = &hunt->options;
    while (difftime(time(NULL), hunt->begin) < 60.0 * o->minutes) {
        const uint64_t number = hunt->next++;
        if ((double)number >= o->scenes) {
            break;
        }
        try_sequence(hunt, sequence_drawn((uint64_t)o->seed, number, o->kind));
    }
    return NULL;
}

static void fail(const char* what) {
    perror(what);
    exit(2);
}

static void run_all(Hunt* hunt) {
    pthread_t jobs[MOST_JOBS];
    for (int k = 0; k < hunt->options.jobs; k++) {
        if (pthread_create(&jobs[k], NULL, run_job, hunt) != 0) {
            fail("hunt: a job");
        }
    }
    for (int k = 0; k < hunt->options.jobs; k++) {
        pthread_join(jobs[k], NULL);
    }
    printf("\nseed %.0f", hunt->options.seed);
}

// Each line is a sequence; # begins a comment.
static void replay_file(Hunt* hunt) {
    FILE* file = fopen(hunt->options.file, "r");
    char line[SEQUENCE_TEXT];
    if (file == NULL) {
        fail(hunt->options.file);
    }
    while (fgets(line, sizeof line, file) != NULL) {
        if (line[0] != '#' && line[0] != '\n') {
            try_sequence(hunt, sequence_read(line));
        }
    }
    fclose(file);
}

static void usage(void) {
    fprintf(stderr,
            "hunt [--seed S] [--scenes N] [--minutes M] [--jobs J] [--minimize K] [--plane] [--near-line]\n"
            "     [--replay \"NAME=VALUE ..\"] [--file FILE]\n"
            "--minimize: makes K misses plain.\n"
            "--plane: scenes that slide, or vibrate, across. --near-line: short steps that slide 1e-9 m/s "
            "across.\n"
            "--replay: one sequence, with the results of its steps. --file: the sequences of a file, one a "
            "line.\n");
    exit(2);
}

static double number_of(const char* text) {
    char* end;
    const double value = strtod(text, &end);
    if (end == text || *end != '\0' || !(value >= 0.0)) {
        usage();
    }
    return value;
}

static Options read_options(int argc, char** argv) {
    enum { SEED, SCENES, MINUTES, JOBS, MINIMIZE, FILE_NAME, REPLAY };
    Options o = {.seed = 1.0, .minutes = INFINITY, .jobs = 1.0};
    int kind = ALONG;
    const struct option names[] = {{"seed", 1, NULL, SEED},         {"scenes", 1, NULL, SCENES},
                                   {"minutes", 1, NULL, MINUTES},   {"jobs", 1, NULL, JOBS},
                                   {"minimize", 1, NULL, MINIMIZE}, {"plane", 0, &kind, PLANE},
                                   {"file", 1, NULL, FILE_NAME},    {"near-line", 0, &kind, NEAR_LINE},
                                   {"replay", 1, NULL, REPLAY},     {0}};
    double* const numbers[] = {&o.seed, &o.scenes, &o.minutes, &o.jobs, &o.minimize};
    for (int name, index; (name = getopt_long(argc, argv, "", names, &index)) != -1;) {
        if (name == FILE_NAME) {
            o.file = optarg;
        } else if (name == REPLAY) {
            o.replay = optarg;
        } else if (name > REPLAY) { // it is not known
            usage();
        } else if (optarg) {
            *numbers[name] = number_of(optarg);
        }
    }
    if (optind < argc) {
        usage();
    }
    o.kind = (Kind)kind;
    o.scenes = o.scenes > 0.0 ? o.scenes : isinf(o.minutes) ? 1000.0 : INFINITY;
    o.jobs = fmin(MOST_JOBS, fmax(1.0, o.jobs));
    return o;
}

int main(int argc, char** argv) {
    static Hunt hunt = {.lock = PTHREAD_MUTEX_INITIALIZER};
    hunt.options = read_options(argc, argv);
    hunt.begin = time(NULL);
    if (hunt.options.replay) {
        try_sequence(&hunt, sequence_read(hunt.options.replay));
        return 0;
    }
    if (hunt.options.file) {
        replay_file(&hunt);
    } else {
        run_all(&hunt);
    }
    printf(
        "\n%ld sequences of %ld steps, %ld refused, %ld beyond the reference, %ld misses, worst error %.2g, "
        "%.5g evaluations a sequence\n",
        hunt.sequences, hunt.steps, hunt.refused, hunt.unknown, hunt.misses, hunt.worst,
        exp(hunt.work / (double)hunt.sequences));
    return hunt.misses > 0 || (hunt.options.file && hunt.refused > 0);
}
