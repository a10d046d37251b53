// Hunts for wrong answers: draws sequences of steps at random, takes them with the FMU's core, grades each step by the
// reference (trial.h has the rule), and prints each step that is not within the tolerance.
//
//     cmake --preset default && cmake --build --preset default --target hunt
//     build/hunt/hunt --seed 1 --scenes 20000
//     build/hunt/hunt --climb 60 --seed 1 --where "tolerance=1e-6 law=LuGre limit=Load"
//     build/hunt/hunt --replay "tolerance=1e-6 V=0.5 V_1=1.44 law=LuGre staticRatio=1.3 then V=0.2"
//
// Each miss is one line, with the sequence as --replay reads it. The last line has the sums. Ends with 1 if a step missed.
#include <getopt.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "climb.h"
#include "scenes.h"
#include "trial.h"

typedef struct {
    double seed, scenes, minutes;
    double minimize; // misses that are made plain, at most
    double climb;    // s
    Kind kind;
    const char *where, *replay, *file;
} Options;

typedef struct {
    Options options;
    long sequences, steps, misses, refused, unknown;
    double worst; // error over the allowed error
    double work;  // the sum of ln(1 + evaluations) over the sequences
} Hunt;

// Whether a step of the sequence misses by 1.5 allowed errors or more, in any result.
static bool still_misses(const Sequence* sequence) {
    Trial trial;
    trial_run(&trial, sequence, true);
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

static void take_sequence(Hunt* hunt, const Sequence* sequence, bool settled, Trial* trial) {
    trial_run(trial, sequence, settled);
    hunt->sequences++;
    hunt->steps += trial->steps;
    hunt->unknown += trial->unknown;
    hunt->refused += trial->refused;
    hunt->worst = fmax(hunt->worst, trial->worst);
    hunt->work += log1p(trial->evaluations);
    if (trial->refused) {
        char text[SEQUENCE_TEXT];
        sequence_text(sequence, text, sizeof text);
        printf("refused step=%d: %s; %s\n", trial->steps + 1, trial->message.text, text);
    }
}

static void try_sequence(Hunt* hunt, const Sequence* sequence) {
    Trial trial;
    take_sequence(hunt, sequence, true, &trial);
    for (int k = 0; k < trial.steps; k++) {
        if (!(trial.taken[k].verdict.ratio <= 1.0)) {
            hunt->misses++;
            print_miss(hunt, sequence, &trial.taken[k], k);
        }
        if (hunt->options.replay) {
            print_step(&trial.taken[k], k);
        }
    }
}

static void try_draws(Hunt* hunt) {
    const Options* o = &hunt->options;
    const time_t begin = time(NULL);
    for (uint64_t number = 0; (double)number < o->scenes && difftime(time(NULL), begin) < 60.0 * o->minutes;
         number++) {
        const Sequence sequence = sequence_drawn((uint64_t)o->seed, number, o->kind);
        try_sequence(hunt, &sequence);
    }
}

// Most of the time of a trial goes into F_t_settled: a settled start tells its error, too.
static double ratio_of(void* hunt, const Sequence* sequence) {
    Trial trial;
    take_sequence(hunt, sequence, sequence->step[0].initial == START_SETTLED, &trial);
    return trial.steps > trial.unknown ? trial.worst : -1.0;
}

// Prints the misses of a climb, and its worst sequence.
static void try_climb(Hunt* hunt) {
    const Options* o = &hunt->options;
    Climb of = {.seed = (uint64_t)o->seed, .kind = o->kind, .where = o->where, .seconds = o->climb};
    of.trials = o->scenes;
    climb(&of, ratio_of, hunt);
    int worst = 0;
    for (int k = 0; k < KEPT; k++) {
        worst = of.ratio[k] > of.ratio[worst] ? k : worst;
        if (of.ratio[k] > 1.0) {
            try_sequence(hunt, &of.kept[k]);
        }
    }
    char text[SEQUENCE_TEXT];
    sequence_text(&of.kept[worst], text, sizeof text);
    printf("worst ratio=%.3g: %s\n", of.ratio[worst], text);
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
            const Sequence sequence = sequence_read(line);
            try_sequence(hunt, &sequence);
        }
    }
    fclose(file);
}

static void usage(void) {
    fprintf(stderr,
            "hunt [--seed S] [--scenes N] [--minutes M] [--plane] [--mass] [--minimize K]\n"
            "     [--climb SECONDS] [--where \"NAME=VALUE ..\"] [--replay \"NAME=VALUE ..\"] [--file FILE]\n"
            "--plane: scenes that slide, or vibrate, across. --mass: a mass on the contact. --minimize: "
            "makes K misses plain.\n"
            "--climb: keeps the worst scenes and changes these, N at the most. --where: which all have.\n"
            "--replay: one sequence, with the results of its steps. --file: the sequences of a file, one a "
            "line.\n");
    exit(2);
}

static Options read_options(int argc, char** argv) {
    enum { SEED, SCENES, MINUTES, MINIMIZE, CLIMB, FILE_NAME, WHERE, REPLAY };
    Options o = {.seed = 1.0, .minutes = INFINITY, .where = ""};
    int kind = ALONG;
    char rest;
    const struct option names[] = {{"seed", 1, NULL, SEED},
                                   {"scenes", 1, NULL, SCENES},
                                   {"minutes", 1, NULL, MINUTES},
                                   {"minimize", 1, NULL, MINIMIZE},
                                   {"climb", 1, NULL, CLIMB},
                                   {"plane", 0, &kind, PLANE},
                                   {"mass", 0, &kind, MASS},
                                   {"file", 1, NULL, FILE_NAME},
                                   {"where", 1, NULL, WHERE},
                                   {"replay", 1, NULL, REPLAY},
                                   {0}};
    double* const numbers[] = {&o.seed, &o.scenes, &o.minutes, &o.minimize, &o.climb};
    const char** const words[] = {&o.file, &o.where, &o.replay};
    for (int name, index; (name = getopt_long(argc, argv, "", names, &index)) != -1;) {
        if (name > REPLAY) { // it is not known
            usage();
        } else if (name >= FILE_NAME) {
            *words[name - FILE_NAME] = optarg;
        } else if (optarg && sscanf(optarg, "%lf%c", numbers[name], &rest) != 1) {
            usage();
        }
    }
    if (optind < argc) {
        usage();
    }
    o.kind = (Kind)kind;
    o.scenes = o.scenes > 0.0 ? o.scenes : isinf(o.minutes) && o.climb == 0.0 ? 1000.0 : INFINITY;
    return o;
}

int main(int argc, char** argv) {
    static Hunt hunt;
    hunt.options = read_options(argc, argv);
    if (hunt.options.replay) {
        const Sequence sequence = sequence_read(hunt.options.replay);
        try_sequence(&hunt, &sequence);
        return 0;
    }
    (hunt.options.file ? replay_file : hunt.options.climb > 0.0 ? try_climb : try_draws)(&hunt);
    printf(
        "\n%ld sequences of %ld steps, %ld refused, %ld beyond the reference, %ld misses, worst error %.2g, "
        "%.5g evaluations a sequence\n",
        hunt.sequences, hunt.steps, hunt.refused, hunt.unknown, hunt.misses, hunt.worst,
        exp(hunt.work / (double)hunt.sequences));
    return hunt.misses > 0 || (hunt.options.file && hunt.refused > 0);
}
