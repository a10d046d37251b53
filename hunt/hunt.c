// Hunts for wrong answers: draws sequences of steps at random, takes them with the FMU's core, grades each step by the
// reference, and prints each step that is not within the tolerance.
//
//     cmake --preset default && cmake --build --preset default --target hunt
//     build/hunt/hunt --seed 1 --scenes 20000 --jobs 2
//     build/hunt/hunt --replay "V=0.5 V_1=1.44 law=LuGre staticRatio=1.3 then V=0.2" --tolerance 1e-6
//
// Each miss is one line: the tolerance, the error over it and of what, the number of the sequence, and the sequence as
// name=value where it is not the start value, which --replay takes. A sequence is taken with one of the tolerances, in
// turn. The last lines are tables by law and by kappa = sigma V / (2 pi f limit). Ends with 1 where something missed.
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "minimize.h"
#include "scenes.h"
#include "tally.h"
#include "trial.h"

enum { MOST_JOBS = 64 };

typedef struct {
    uint64_t seed, scenes, first;
    double seconds; // 0: no end but the number of scenes
    double tolerance[MOST_TOLERANCES];
    int tolerances, jobs;
    const char *replay, *file;
    bool brief, show;
    int minimize; // misses that a job makes plain, at the most
    Grammar grammar;
} Options;

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

// ---------------------------------------------------------------------------------------------------------------------
// One sequence
// ---------------------------------------------------------------------------------------------------------------------

static void report(const Sequence* sequence, const Trial* trial, int step, uint64_t number,
                   double tolerance) {
    const TrialStep* taken = &trial->taken[step];
    char text[SEQUENCE_TEXT];
    sequence_text(sequence, text, sizeof text);
    printf("miss law=%s tolerance=%g ratio=%.3g of=%s step=%d kappa=%.1e number=%llu: %s\n",
           LAW_NAMES[taken->scene.law], tolerance, taken->verdict.ratio, GRADE_NAMES[taken->verdict.of],
           step + 1, scene_kappa(&taken->scene), (unsigned long long)number, text);
    fflush(stdout);
}

// Whether the sequence misses by half as much again as the tolerance, whatever of.
static bool still_misses(const Sequence* sequence, const void* context) {
    static Trial trial;
    trial_run(&trial, sequence, *(const double*)context);
    const int worst = trial_worst(&trial);
    return worst >= 0 && !(trial.taken[worst].verdict.ratio <= 1.5);
}

// So many misses of each law and grade are made plain, as lines that --file takes.
static void make_plain(const Options* options, const Sequence* sequence, double tolerance,
                       const Verdict* verdict, Tally* tally) {
    int* done = &tally->minimized[sequence->step[0].law - 1][verdict->of];
    if (*done >= options->minimize || !still_misses(sequence, &tolerance)) {
        return;
    }
    (*done)++;
    const Sequence plain = minimized(sequence, still_misses, &tolerance);
    char text[SEQUENCE_TEXT];
    sequence_text(&plain, text, sizeof text);
    printf("plain: tolerance=%g %s\n", tolerance, text);
    fflush(stdout);
}

static void print_step(const TrialStep* taken, int step, double tolerance) {
    const FmuStep* s = &taken->step;
    const ReferenceStep* t = &taken->truth;
    printf("tolerance %g, step %d: ratio %.3g of %s; S %g N, path %g m, from delta %.17g side %d, %g "
           "evaluations\n",
           tolerance, step + 1, taken->verdict.ratio, GRADE_NAMES[taken->verdict.of], t->S, t->path,
           taken->scene.delta_0, taken->scene.slips, s->evaluations);
    printf("  FMU       F_t %.17g mean %.17g W %.17g Q %.17g delta %.17g side %g; start: F_t %.17g\n", s->F_t,
           s->F_t_mean, s->work, s->heat, s->delta, s->slips, s->F_t_start);
    printf("  reference F_t %.17g mean %.17g W %.17g Q %.17g delta %.17g side %g; start: F_t %.17g\n", t->F_t,
           t->F_t_mean, t->work, t->heat, t->delta, t->slips, t->F_t_start);
    if (step == 0) {
        printf("  F_t_settled: FMU %.17g, reference %.17g\n", taken->settled[0], taken->settled[1]);
    }
}

static void try_at(const Options* options, const Sequence* sequence, uint64_t number, int column,
                   Tally* tally) {
    static Trial trial;
    const double tolerance = options->tolerance[column];
    trial_run(&trial, sequence, tolerance);
    tally->unknown += trial.unknown;
    tally->refused += trial.refused;
    if (trial.refused && !options->brief) {
        char text[SEQUENCE_TEXT];
        sequence_text(sequence, text, sizeof text);
        printf("refused number=%llu step=%d: %s; %s\n", (unsigned long long)number, trial.steps + 1,
               trial.message, text);
    }
    for (int k = 0; k < trial.steps; k++) {
        const TrialStep* taken = &trial.taken[k];
        const bool misses = !(taken->verdict.ratio <= 1.0);
        tally_count(tally, taken, column);
        if (misses && !options->brief) {
            report(sequence, &trial, k, number, tolerance);
        }
        if (misses) {
            make_plain(options, sequence, tolerance, &taken->verdict, tally);
        }
        if (options->replay) {
            print_step(taken, k, tolerance);
        }
    }
}

static void try_sequence(const Options* options, const Sequence* sequence, uint64_t number, Tally* tally) {
    tally->drawn++;
    if (options->show) {
        char text[SEQUENCE_TEXT];
        sequence_text(sequence, text, sizeof text);
        printf("%llu: %s\n", (unsigned long long)number, text);
        fflush(stdout);
    }
    for (int k = 0; k < options->tolerances; k++) {
        if (options->replay || number % (uint64_t)options->tolerances == (uint64_t)k) {
            try_at(options, sequence, number, k, tally);
        }
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Many scenes
// ---------------------------------------------------------------------------------------------------------------------

static void run_job(const Options* options, int job, Tally* tally) {
    const double begin = now();
    for (uint64_t n = (uint64_t)job; n < options->scenes; n += (uint64_t)options->jobs) {
        if (options->seconds > 0.0 && now() - begin > options->seconds) {
            break;
        }
        const uint64_t number = options->first + n;
        const Sequence sequence = sequence_drawn(options->seed, number, &options->grammar);
        try_sequence(options, &sequence, number, tally);
        if (job == 0 && tally->drawn % 1000 == 0 && isatty(STDERR_FILENO)) {
            fprintf(stderr, "\r%ld sequences, %.0f s", tally->drawn * options->jobs, now() - begin);
        }
    }
    if (job == 0 && isatty(STDERR_FILENO)) {
        fprintf(stderr, "\n");
    }
}

static void run_all(const Options* options, Tally* total) {
    Tally* tallies =
        mmap(NULL, MOST_JOBS * sizeof *tallies, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (tallies == MAP_FAILED) {
        perror("hunt: mmap");
        exit(2);
    }
    for (int job = 1; job < options->jobs; job++) {
        const pid_t child = fork();
        if (child < 0) {
            perror("hunt: fork");
            exit(2);
        }
        if (child == 0) {
            run_job(options, job, &tallies[job]);
            _exit(0);
        }
    }
    run_job(options, 0, &tallies[0]);
    for (int job = 1; job < options->jobs; job++) {
        int status;
        if (wait(&status) < 0 || status != 0) {
            fprintf(stderr, "hunt: a job ended with status %d\n", status);
            exit(2);
        }
    }
    for (int job = 0; job < options->jobs; job++) {
        tally_add(total, &tallies[job]);
    }
}

static void replay(const Options* options, const char* text, uint64_t number, Tally* tally) {
    Sequence sequence;
    char wrong[100];
    if (!sequence_read(text, &sequence, wrong, sizeof wrong)) {
        fprintf(stderr, "hunt: %s is no name=value of a scene\n", wrong);
        exit(2);
    }
    try_sequence(options, &sequence, number, tally);
}

// Each line is a sequence, with its tolerance first; # begins a comment.
static void replay_file(const Options* options, Tally* tally) {
    FILE* file = fopen(options->file, "r");
    if (file == NULL) {
        fprintf(stderr, "hunt: %s: %s\n", options->file, strerror(errno));
        exit(2);
    }
    char line[SEQUENCE_TEXT];
    for (uint64_t number = 1; fgets(line, sizeof line, file) != NULL; number++) {
        int read = 0;
        Options mine = *options;
        mine.tolerances = 1;
        if (line[0] == '#' || line[0] == '\n') {
            continue;
        }
        if (sscanf(line, "tolerance=%lf%n", &mine.tolerance[0], &read) != 1) {
            fprintf(stderr, "hunt: %s:%llu does not begin with a tolerance\n", options->file,
                    (unsigned long long)number);
            exit(2);
        }
        replay(&mine, line + read, number, tally);
    }
    fclose(file);
}

// ---------------------------------------------------------------------------------------------------------------------
// The command line
// ---------------------------------------------------------------------------------------------------------------------

static void usage(void) {
    fprintf(stderr,
            "hunt [--seed S] [--scenes N] [--first N] [--minutes M] [--tolerance T,T,..] [--law NAME]\n"
            "     [--limit Constant|Load] [--jobs J] [--minimize K] [--brief] [--show] [--replay "
            "\"NAME=VALUE ..\"]\n"
            "     [--file FILE]\n"
            "--first: number of the first sequence; with --scenes 1 a single one. --minimize: makes K misses "
            "of each\n"
            "law and grade plain. --file: the sequences of a file, one a line. --brief: only the tables. "
            "--show:\n"
            "every sequence before it is tried.\n");
    exit(2);
}

static double number_of(const char* text) {
    char* end;
    const double value = strtod(text, &end);
    if (end == text || *end != '\0' || !(value >= 0.0)) {
        fprintf(stderr, "hunt: %s is no number that is expected here\n", text);
        usage();
    }
    return value;
}

static int name_of(const char* text, const char* const* names, int first, int last) {
    for (int k = first; k <= last; k++) {
        if (strcmp(text, names[k]) == 0) {
            return k;
        }
    }
    fprintf(stderr, "hunt: unknown %s\n", text);
    usage();
    return 0;
}

static void read_tolerances(Options* options, const char* text) {
    char copy[400];
    snprintf(copy, sizeof copy, "%s", text);
    options->tolerances = 0;
    for (char* part = strtok(copy, ","); part != NULL; part = strtok(NULL, ",")) {
        if (options->tolerances == MOST_TOLERANCES) {
            usage();
        }
        options->tolerance[options->tolerances++] = number_of(part);
    }
}

static void read_option(Options* options, const char* name, const char* value) {
    static const char* const LIMITS[] = {"any", "Constant", "Load"};
    if (strcmp(name, "--seed") == 0) {
        options->seed = strtoull(value, NULL, 10);
    } else if (strcmp(name, "--scenes") == 0) {
        options->scenes = (uint64_t)number_of(value);
    } else if (strcmp(name, "--first") == 0) {
        options->first = strtoull(value, NULL, 10);
    } else if (strcmp(name, "--minutes") == 0) {
        options->seconds = 60.0 * number_of(value);
        options->scenes = UINT64_MAX / 2;
    } else if (strcmp(name, "--tolerance") == 0) {
        read_tolerances(options, value);
    } else if (strcmp(name, "--law") == 0) {
        options->grammar.law = name_of(value, LAW_NAMES, 0, LAWS);
    } else if (strcmp(name, "--limit") == 0) {
        options->grammar.limit = name_of(value, LIMITS, 0, 2);
    } else if (strcmp(name, "--jobs") == 0) {
        options->jobs = (int)fmin(MOST_JOBS, fmax(1.0, number_of(value)));
    } else if (strcmp(name, "--minimize") == 0) {
        options->minimize = (int)number_of(value);
    } else if (strcmp(name, "--file") == 0) {
        options->file = value;
    } else if (strcmp(name, "--replay") == 0) {
        options->replay = value;
    } else {
        fprintf(stderr, "hunt: unknown option %s\n", name);
        usage();
    }
}

int main(int argc, char** argv) {
    Options options = {
        .seed = 1, .scenes = 1000, .tolerance = {1e-2, 1e-3, 1e-4, 1e-6, 1e-8}, .tolerances = 5, .jobs = 1};
    for (int k = 1; k < argc; k++) {
        if (strcmp(argv[k], "--brief") == 0) {
            options.brief = true;
        } else if (strcmp(argv[k], "--show") == 0) {
            options.show = true;
        } else if (k + 1 < argc) {
            read_option(&options, argv[k], argv[k + 1]);
            k++;
        } else {
            usage();
        }
    }
    static Tally total;
    if (options.replay) {
        replay(&options, options.replay, 0, &total);
        return 0;
    }
    if (options.file) {
        replay_file(&options, &total);
    } else {
        run_all(&options, &total);
        printf("\nseed %llu\n", (unsigned long long)options.seed);
    }
    const long misses = tally_print(&total, options.tolerance, options.tolerances);
    return misses > 0 || (options.file && total.refused > 0);
}
