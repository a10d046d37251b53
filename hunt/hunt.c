// Hunts for wrong answers: draws sequences of steps at random, takes them with the FMU's core, grades each step by the
// reference (trial.h has the rule), and prints each step that is not within the tolerance.
//
//     cmake --preset default && cmake --build --preset default --target hunt
//     build/hunt/hunt --seed 1 --scenes 20000 --jobs 2
//     build/hunt/hunt --replay "tolerance=1e-6 V=0.5 V_1=1.44 law=LuGre staticRatio=1.3 then V=0.2"
//
// Each miss is one line: the error over the allowed error, the result that missed, and the sequence, as --replay reads it. The
// last lines are a table by law and the sums. Ends with 1 if a step missed.
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

enum { MOST_JOBS = 64, LAWS = 4 };
static const double NEARLY_NONE = 1e-9; // m/s, across

typedef struct {
    double seed, scenes, minutes, jobs;
    double minimize; // misses that are made plain, at most
    bool plane, near_line;
    const char *replay, *file;
} Options;

typedef struct {
    long steps, misses;
    double worst; // error over the allowed error
} Row;

// A hunt, by several threads.
typedef struct {
    Options options;
    time_t begin;
    atomic_ullong next; // the number of the sequence to be drawn next, from 0 on
    pthread_mutex_t lock;
    Row law[LAWS];
    long sequences, refused, unknown;
} Hunt;

// Whether a step of the sequence misses by 1.5 allowed errors or more, in any result.
static bool still_misses(const Sequence* sequence) {
    Trial trial;
    trial_run(&trial, sequence);
    return trial.worst > 1.5;
}

static void print_miss(Hunt* hunt, const Sequence* sequence, const char* text, const TrialStep* taken,
                       int step) {
    printf("miss law=%s ratio=%.3g of=%s step=%d kappa=%.1e: %s\n", law_name(taken->scene.law),
           taken->verdict.ratio, GRADE_NAMES[taken->verdict.of], step + 1, scene_kappa(&taken->scene), text);
    if (hunt->options.minimize > 0 && !hunt->options.near_line && still_misses(sequence)) {
        hunt->options.minimize--;
        char plain[SEQUENCE_TEXT];
        snprintf(plain, sizeof plain, "%s", text);
        make_plain(plain, still_misses);
        printf("plain: %s\n", plain);
    }
    fflush(stdout);
}

static void print_step(const TrialStep* taken, int step) {
    const FmuStep* s = &taken->step;
    const ReferenceStep* t = &taken->truth;
    printf("step %d: ratio %.3g of %s; S %g N, path %g m, from delta %.17g, %.17g side %g\n", step + 1,
           taken->verdict.ratio, GRADE_NAMES[taken->verdict.of], t->S, t->path, taken->scene.delta_0,
           taken->scene.delta_y_0, taken->scene.slips);
    for (int k = 0; k < RESULTS; k++) {
        printf("  %-9s  FMU %24.17g  reference %24.17g\n", GRADE_NAMES[k], s->result[k], t->result[k]);
    }
    if (step == 0) {
        printf("  settled    FMU %.17g, %.17g  reference %.17g, %.17g\n", taken->settled.x, taken->settled.y,
               taken->settled_truth[0], taken->settled_truth[1]);
    }
}

static void try_sequence(Hunt* hunt, Sequence sequence) {
    Trial trial;
    char text[SEQUENCE_TEXT];
    sequence_text(&sequence, text, sizeof text);
    if (hunt->options.near_line) {
        trial_near_line(&trial, &sequence, NEARLY_NONE);
    } else {
        trial_run(&trial, &sequence);
    }
    pthread_mutex_lock(&hunt->lock);
    hunt->sequences++;
    hunt->unknown += trial.unknown;
    hunt->refused += trial.refused;
    if (trial.refused) {
        printf("refused step=%d: %s; %s\n", trial.steps + 1, trial.message.text, text);
    }
    for (int k = 0; k < trial.steps; k++) {
        const TrialStep* taken = &trial.taken[k];
        const double ratio = taken->verdict.ratio;
        Row* row = &hunt->law[(int)taken->scene.law - 1];
        row->steps++;
        row->worst = fmax(row->worst, ratio);
        if (!(ratio <= 1.0)) {
            row->misses++;
            print_miss(hunt, &sequence, text, taken, k);
        }
        if (hunt->options.replay) {
            print_step(taken, k);
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
        try_sequence(hunt, sequence_drawn((uint64_t)o->seed, number, o->plane));
    }
    return NULL;
}

static void run_all(Hunt* hunt) {
    pthread_t jobs[MOST_JOBS];
    for (int k = 0; k < hunt->options.jobs; k++) {
        if (pthread_create(&jobs[k], NULL, run_job, hunt) != 0) {
            perror("hunt: a job");
            exit(2);
        }
    }
    for (int k = 0; k < hunt->options.jobs; k++) {
        pthread_join(jobs[k], NULL);
    }
    printf("\nseed %.0f\n", hunt->options.seed);
}

// Each line is a sequence; # begins a comment.
static void replay_file(Hunt* hunt) {
    FILE* file = fopen(hunt->options.file, "r");
    char line[SEQUENCE_TEXT];
    if (file == NULL) {
        perror(hunt->options.file);
        exit(2);
    }
    while (fgets(line, sizeof line, file) != NULL) {
        if (line[0] != '#' && line[0] != '\n') {
            try_sequence(hunt, sequence_read(line));
        }
    }
    fclose(file);
}

// Returns the misses.
static long print_sums(const Hunt* hunt) {
    long misses = 0, steps = 0;
    printf("\n| law | steps | misses | worst error over the allowed error |\n|---|---|---|---|\n");
    for (int k = 0; k < LAWS; k++) {
        const Row* row = &hunt->law[k];
        misses += row->misses;
        steps += row->steps;
        printf("| %s | %ld | %ld | %.2g |\n", law_name(k + 1), row->steps, row->misses, row->worst);
    }
    printf("\n%ld sequences of %ld steps, %ld refused, %ld beyond the reference, %ld misses\n",
           hunt->sequences, steps, hunt->refused, hunt->unknown, misses);
    return misses;
}

static void usage(void) {
    fprintf(stderr,
            "hunt [--seed S] [--scenes N] [--minutes M] [--jobs J] [--minimize K] [--plane] [--near-line]\n"
            "     [--replay \"NAME=VALUE ..\"] [--file FILE]\n"
            "--minimize: makes K misses plain.\n"
            "--plane: scenes that slide, or vibrate, across.\n"
            "--near-line: the first step along a line, and once more with V_y = 1e-9 m/s: within two "
            "tolerances.\n"
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
    enum { SEED, SCENES, MINUTES, JOBS, MINIMIZE, FILE_NAME, REPLAY, PLANE, NEAR_LINE };
    static const struct option NAMES[] = {{"seed", 1, NULL, SEED},           {"scenes", 1, NULL, SCENES},
                                          {"minutes", 1, NULL, MINUTES},     {"jobs", 1, NULL, JOBS},
                                          {"minimize", 1, NULL, MINIMIZE},   {"plane", 0, NULL, PLANE},
                                          {"file", 1, NULL, FILE_NAME},      {"replay", 1, NULL, REPLAY},
                                          {"near-line", 0, NULL, NEAR_LINE}, {0}};
    Options o = {.seed = 1.0, .minutes = INFINITY, .jobs = 1.0};
    double* const numbers[] = {&o.seed, &o.scenes, &o.minutes, &o.jobs, &o.minimize};
    for (int name; (name = getopt_long(argc, argv, "", NAMES, NULL)) != -1;) {
        if (name == FILE_NAME) {
            o.file = optarg;
        } else if (name == REPLAY) {
            o.replay = optarg;
        } else if (name == PLANE) {
            o.plane = true;
        } else if (name == NEAR_LINE) {
            o.near_line = true;
        } else if (name <= MINIMIZE) {
            *numbers[name] = number_of(optarg);
        } else {
            usage();
        }
    }
    if (optind < argc) {
        usage();
    }
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
    const long misses = print_sums(&hunt);
    return misses > 0 || (hunt.options.file && hunt.refused > 0);
}
