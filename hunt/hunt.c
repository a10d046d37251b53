// Hunts for wrong answers: draws sequences of steps at random, takes them with the FMU's core, grades each
// step by the reference (trial.h has the rule), and prints each step that is not within the tolerance.
//
//     cmake --preset default && cmake --build --preset default --target hunt
//     build/hunt/hunt --seed 1 --scenes 20000 --jobs 2
//     build/hunt/hunt --replay "V=0.5 V_1=1.44 law=LuGre staticRatio=1.3 then V=0.2" --tolerance 1e-6
//
// With --plane the scenes slide and vibrate across as well. Each miss is one line: the tolerance, the error
// over it, the result that missed, the number of the sequence, and the sequence as name=value for each value
// that is not the start value. --replay takes such a line. The sequences take the tolerances in turn. The
// last lines are tables by law and by kappa = sigma V / (2 pi f limit), and counts of the kinds of step. Ends
// with 1 if a step missed.
#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "scenes.h"
#include "trial.h"

enum { MOST_JOBS = 64, MOST_TOLERANCES = 12, LAWS = 4, KAPPAS = 7, ROWS = LAWS + KAPPAS };

typedef struct {
    uint64_t seed, scenes, first;
    double seconds; // INFINITY: no end but the number of scenes
    double tolerance[MOST_TOLERANCES];
    int tolerances, jobs;
    const char *replay, *file;
    bool plane;
    int minimize; // misses that a job makes plain, at the most, of each law and grade
} Options;

// ---------------------------------------------------------------------------------------------------------------------
// Counts
// ---------------------------------------------------------------------------------------------------------------------

typedef struct {
    long steps, misses;
    double worst; // error over the tolerance
} Cell;

typedef struct {
    Cell cell[ROWS][MOST_TOLERANCES]; // the laws, then the classes of kappa
    long drawn, refused, unknown, is[KINDS];
    int minimized[LAWS][GRADES];
} Tally;

static int kappa_class(const ReferenceScene* scene) {
    const double kappa = scene_kappa(scene);
    return !vibrates(scene) ? KAPPAS - 1
           : kappa <= 1.0   ? 0
           : kappa >= 1e8   ? 5
                            : 1 + (int)(log10(kappa) / 2.0);
}

static void add_cell(Cell* sum, const Cell* part) {
    sum->steps += part->steps;
    sum->misses += part->misses;
    sum->worst = fmax(sum->worst, part->worst);
}

static void count_step(Tally* tally, const TrialStep* taken, int column) {
    const double ratio = taken->verdict.ratio;
    const Cell cell = {1, !(ratio <= 1.0), ratio};
    add_cell(&tally->cell[taken->scene.law - 1][column], &cell);
    add_cell(&tally->cell[LAWS + kappa_class(&taken->scene)][column], &cell);
    for (int k = 0; k < KINDS; k++) {
        tally->is[k] += taken->is[k];
    }
}

static void add_tally(Tally* sum, const Tally* part) {
    for (int row = 0; row < ROWS; row++) {
        for (int k = 0; k < MOST_TOLERANCES; k++) {
            add_cell(&sum->cell[row][k], &part->cell[row][k]);
        }
    }
    for (int k = 0; k < KINDS; k++) {
        sum->is[k] += part->is[k];
    }
    sum->drawn += part->drawn;
    sum->refused += part->refused;
    sum->unknown += part->unknown;
}

// Tables with a column for each tolerance, "misses, worst error over the tolerance"; returns the misses.
static long print_tally(const Tally* tally, const Options* options, double seconds) {
    static const char* const KAPPA_NAMES[KAPPAS] = {"below 1",    "1 to 1e2",  "1e2 to 1e4",  "1e4 to 1e6",
                                                    "1e6 to 1e8", "above 1e8", "no vibration"};
    long misses = 0, steps = 0;
    printf("\nMisses, and the worst error over the tolerance:\n");
    for (int row = 0; row < ROWS; row++) {
        if (row == 0 || row == LAWS) {
            printf("\n| %s | steps |", row == 0 ? "law" : "kappa");
            for (int k = 0; k < options->tolerances; k++) {
                printf(" %g |", options->tolerance[k]);
            }
            printf("\n|---|---|");
            for (int k = 0; k < options->tolerances; k++) {
                printf("---|");
            }
            printf("\n");
        }
        Cell all = {0};
        for (int k = 0; k < options->tolerances; k++) {
            add_cell(&all, &tally->cell[row][k]);
        }
        misses += row < LAWS ? all.misses : 0;
        steps += row < LAWS ? all.steps : 0;
        printf("| %s | %ld |", row < LAWS ? LAW_NAMES[row] : KAPPA_NAMES[row - LAWS], all.steps);
        for (int k = 0; k < options->tolerances; k++) {
            printf(" %ld, %.2g |", tally->cell[row][k].misses, tally->cell[row][k].worst);
        }
        printf("\n");
    }
    printf("\n%ld sequences of %ld steps, %ld refused, %ld beyond the reference, %ld misses\n", tally->drawn,
           steps, tally->refused, tally->unknown, misses);
    printf("%.0f steps a second; %ld with static friction, %ld open, %ld close, %ld after a jump, %ld move "
           "through 10 "
           "periods and more\n",
           (double)steps / seconds, tally->is[IS_STATIC], tally->is[OPENS], tally->is[CLOSES],
           tally->is[JUMPS], tally->is[LEAPS]);
    return misses;
}

// ---------------------------------------------------------------------------------------------------------------------
// One sequence
// ---------------------------------------------------------------------------------------------------------------------

// Whether the sequence misses by 1.5 tolerances or more, in any result.
static bool still_misses(const Sequence* sequence, double tolerance) {
    static Trial trial;
    trial_run(&trial, sequence, tolerance);
    bool misses = false;
    for (int k = 0; k < trial.steps; k++) {
        misses = misses || !(trial.taken[k].verdict.ratio <= 1.5);
    }
    return misses;
}

static void report_miss(const Options* options, const Sequence* sequence, const Trial* trial, int step,
                        uint64_t number, double tolerance, Tally* tally) {
    const TrialStep* taken = &trial->taken[step];
    char text[SEQUENCE_TEXT];
    sequence_text(sequence, text, sizeof text);
    printf("miss law=%s tolerance=%g ratio=%.3g of=%s step=%d kappa=%.1e number=%llu: %s\n",
           LAW_NAMES[taken->scene.law - 1], tolerance, taken->verdict.ratio, GRADE_NAMES[taken->verdict.of],
           step + 1, scene_kappa(&taken->scene), (unsigned long long)number, text);
    int* done = &tally->minimized[taken->scene.law - 1][taken->verdict.of];
    if (*done < options->minimize && still_misses(sequence, tolerance)) {
        (*done)++;
        const Sequence plain = minimized(sequence, still_misses, tolerance);
        sequence_text(&plain, text, sizeof text);
        printf("plain: tolerance=%g %s\n", tolerance, text); // a line that --file takes
    }
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
    if (s->F_y != 0.0 || t->F_y != 0.0) {
        printf("  FMU       F_y %.17g mean %.17g delta_y %.17g; start: F_y %.17g\n", s->F_y, s->F_y_mean,
               s->delta_y, s->F_y_start);
        printf("  reference F_y %.17g mean %.17g delta_y %.17g; start: F_y %.17g\n", t->F_y, t->F_y_mean,
               t->delta_y, t->F_y_start);
    }
    if (step == 0) {
        const double (*both)[2] = taken->settled;
        printf("  settled: FMU %.17g, %.17g, reference %.17g, %.17g\n", both[0][0], both[0][1], both[1][0],
               both[1][1]);
    }
}

static void try_at(const Options* options, const Sequence* sequence, uint64_t number, int column,
                   Tally* tally) {
    static Trial trial;
    const double tolerance = options->tolerance[column];
    trial_run(&trial, sequence, tolerance);
    tally->unknown += trial.unknown;
    tally->refused += trial.refused;
    if (trial.refused) {
        char text[SEQUENCE_TEXT];
        sequence_text(sequence, text, sizeof text);
        printf("refused number=%llu step=%d: %s; %s\n", (unsigned long long)number, trial.steps + 1,
               trial.message, text);
    }
    for (int k = 0; k < trial.steps; k++) {
        count_step(tally, &trial.taken[k], column);
        if (!(trial.taken[k].verdict.ratio <= 1.0)) {
            report_miss(options, sequence, &trial, k, number, tolerance, tally);
        }
        if (options->replay) {
            print_step(&trial.taken[k], k, tolerance);
        }
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Many sequences
// ---------------------------------------------------------------------------------------------------------------------

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static void run_job(const Options* options, int job, Tally* tally) {
    const double begin = now();
    for (uint64_t n = (uint64_t)job; n < options->scenes && now() - begin < options->seconds;
         n += (uint64_t)options->jobs) {
        const uint64_t number = options->first + n;
        const Sequence sequence = sequence_drawn(options->seed, number, options->plane);
        tally->drawn++;
        try_at(options, &sequence, number, (int)(number % (uint64_t)options->tolerances), tally);
    }
}

static void* or_end(void* found, const char* what) {
    if (found == NULL || found == MAP_FAILED) {
        perror(what);
        exit(2);
    }
    return found;
}

static void run_all(const Options* options, Tally* total) {
    Tally* tallies = or_end(
        mmap(NULL, MOST_JOBS * sizeof *tallies, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0),
        "mmap");
    for (int job = 1; job < options->jobs; job++) {
        const pid_t child = fork();
        or_end(child < 0 ? NULL : tallies, "fork");
        if (child == 0) {
            run_job(options, job, &tallies[job]);
            _exit(0);
        }
    }
    run_job(options, 0, &tallies[0]);
    for (int job = 1, status; job < options->jobs; job++) {
        or_end(wait(&status) < 0 || status != 0 ? NULL : tallies, "hunt: a job");
    }
    for (int job = 0; job < options->jobs; job++) {
        add_tally(total, &tallies[job]);
    }
    printf("\nseed %llu\n", (unsigned long long)options->seed);
}

static Sequence sequence_of_text(const char* text) {
    Sequence sequence;
    char wrong[100];
    if (!sequence_read(text, &sequence, wrong, sizeof wrong)) {
        fprintf(stderr, "hunt: %s is no name=value of a scene\n", wrong);
        exit(2);
    }
    return sequence;
}

// Each line is a sequence, with its tolerance first, for which the tables get a column; # begins a comment.
static void replay_file(Options* options, Tally* tally) {
    FILE* file = or_end(fopen(options->file, "r"), options->file);
    char line[SEQUENCE_TEXT];
    options->tolerances = 0;
    for (uint64_t number = 1; fgets(line, sizeof line, file) != NULL; number++) {
        int read = 0, column = 0;
        double tolerance;
        if (line[0] == '#' || line[0] == '\n') {
            continue;
        }
        if (sscanf(line, "tolerance=%lf%n", &tolerance, &read) != 1) {
            fprintf(stderr, "hunt: line %llu does not begin with a tolerance\n", (unsigned long long)number);
            exit(2);
        }
        while (column < options->tolerances && options->tolerance[column] != tolerance) {
            column++;
        }
        if (column == MOST_TOLERANCES) {
            fprintf(stderr, "hunt: line %llu: too many tolerances\n", (unsigned long long)number);
            exit(2);
        }
        options->tolerance[column] = tolerance;
        options->tolerances += column == options->tolerances;
        const Sequence sequence = sequence_of_text(line + read);
        tally->drawn++;
        try_at(options, &sequence, number, column, tally);
    }
    fclose(file);
}

// ---------------------------------------------------------------------------------------------------------------------
// The command line
// ---------------------------------------------------------------------------------------------------------------------

static void usage(void) {
    fprintf(stderr,
            "hunt [--seed S] [--scenes N] [--first N] [--minutes M] [--tolerance T,T,..] [--jobs J]\n"
            "     [--minimize K] [--plane] [--replay \"NAME=VALUE ..\"] [--file FILE]\n"
            "--first: number of the first sequence; with --scenes 1 a single one. --minimize: makes K misses "
            "of each\n"
            "law and grade plain. --file: the sequences of a file, one a line.\n"
            "--plane: scenes that slide, or vibrate, across.\n");
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
    enum {
        SEED,
        SCENES,
        FIRST,
        MINUTES,
        JOBS,
        MINIMIZE,
        NUMBERS,
        PLANE = NUMBERS,
        TOLERANCE,
        FILE_NAME,
        REPLAY
    };
    static const struct option NAMES[] = {{"seed", 1, NULL, SEED},
                                          {"scenes", 1, NULL, SCENES},
                                          {"first", 1, NULL, FIRST},
                                          {"minutes", 1, NULL, MINUTES},
                                          {"jobs", 1, NULL, JOBS},
                                          {"minimize", 1, NULL, MINIMIZE},
                                          {"plane", 0, NULL, PLANE},
                                          {"tolerance", 1, NULL, TOLERANCE},
                                          {"file", 1, NULL, FILE_NAME},
                                          {"replay", 1, NULL, REPLAY},
                                          {0}};
    Options o = {.tolerance = {1e-2, 1e-3, 1e-4, 1e-6, 1e-8}, .tolerances = 5};
    double number[NUMBERS] = {1.0, NAN, 0.0, INFINITY, 1.0, 0.0};
    for (int name; (name = getopt_long(argc, argv, "", NAMES, NULL)) != -1;) {
        if (name < NUMBERS) {
            number[name] = number_of(optarg);
        } else if (name == PLANE) {
            o.plane = true;
        } else if (name == FILE_NAME || name == REPLAY) {
            *(name == REPLAY ? &o.replay : &o.file) = optarg;
        } else if (name == TOLERANCE) {
            o.tolerances = 0;
            for (char* part = strtok(optarg, ","); part && o.tolerances < MOST_TOLERANCES;
                 part = strtok(NULL, ",")) {
                o.tolerance[o.tolerances++] = number_of(part);
            }
        } else {
            usage();
        }
    }
    if (optind < argc || o.tolerances == 0) {
        usage();
    }
    o.seed = (uint64_t)number[SEED];
    o.first = (uint64_t)number[FIRST];
    o.seconds = 60.0 * number[MINUTES];
    o.scenes = !isnan(number[SCENES]) ? (uint64_t)number[SCENES] : isinf(o.seconds) ? 1000 : UINT64_MAX / 2;
    o.jobs = (int)fmin(MOST_JOBS, fmax(1.0, number[JOBS]));
    o.minimize = (int)number[MINIMIZE];
    return o;
}

int main(int argc, char** argv) {
    static Tally total;
    Options options = read_options(argc, argv);
    const double begin = now();
    if (options.replay) {
        const Sequence sequence = sequence_of_text(options.replay);
        for (int k = 0; k < options.tolerances; k++) {
            try_at(&options, &sequence, 0, k, &total);
        }
        return 0;
    }
    if (options.file) {
        replay_file(&options, &total);
    } else {
        run_all(&options, &total);
    }
    const long misses = print_tally(&total, &options, now() - begin);
    return misses > 0 || (options.file && total.refused > 0);
}
