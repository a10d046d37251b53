#include "climb.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "random.h"

static const double LONG = 4.0; // periods, whose number is the reference's time: longer draws are rarer
static const double DRAWN = 1.0 / 3.0;           // of a climb: the rest changes what was drawn
static const double JUMPS = 0.2;                 // the chance of a second step
static const double SHARES[] = {0.5, 0.1, 0.02}; // by which numbers change,
enum { MAX_WORDS = 3 };                          // so many at once
static const double TAKES_OVER = 0.15;           // the chance that a word comes from another sequence

// The begin of a word, none of which is more likely than another.
static size_t any_word(const char* text) {
    size_t found = 0, begin = 0;
    for (int count = 1; text[begin]; count++) {
        found = random_below(count) == 0 ? begin : found;
        begin += strcspn(text + begin, " ") + 1;
    }
    return found;
}

// Changes a number of the text by up to the share, or takes a word over from another text if all is one step.
static void change_word(char* text, double share, const char* other) {
    char before[SEQUENCE_TEXT], word[200];
    const size_t begin = any_word(text);
    const char *old = text + begin, *taken = other + any_word(other);
    int name;
    double value;
    strcpy(before, text);
    if (random_chance(TAKES_OVER) && !strstr(text, "then ")) {
        snprintf(word, sizeof word, "%.*s %.*s ", (int)strcspn(old, " "), old, (int)strcspn(taken, " "),
                 taken);
        with_word(text, before, begin, word);
    } else if (sscanf(old, "%*[^= ]=%n%lf", &name, &value) == 1) {
        value *= 1.0 + share * (2.0 * random_01() - 1.0);
        snprintf(word, sizeof word, "%.*s%.17g ", name, old, value);
        with_word(text, before, begin, word);
    }
}

static Sequence changed(const Sequence* from, const Sequence* drawn) {
    char text[SEQUENCE_TEXT], other[SEQUENCE_TEXT];
    Sequence first = *drawn;
    first.steps = 1;
    sequence_text(from, text, sizeof text);
    sequence_text(&first, other, sizeof other);
    const double share = SHARES[random_below(3)];
    for (int k = 1 + random_below(MAX_WORDS); k > 0; k--) {
        change_word(text, share, other);
    }
    first = sequence_read(text);
    first.tolerance = from->tolerance;
    return first;
}

// Whether the words change nothing of the first step.
static bool has(const Sequence* sequence, const char* words) {
    char text[SEQUENCE_TEXT], with[SEQUENCE_TEXT];
    Sequence first = *sequence;
    first.steps = 1;
    sequence_text(&first, text, sizeof text);
    snprintf(with, sizeof with, "%s%s", text, words);
    first = sequence_read(with);
    sequence_text(&first, with, sizeof with);
    return strcmp(text, with) == 0;
}

static int least(const double of[KEPT]) {
    int least = 0;
    for (int k = 1; k < KEPT; k++) {
        least = of[k] < of[least] ? k : least;
    }
    return least;
}

void climb(Climb* c, TrySequence* try_it, void* context) {
    const time_t begin = time(NULL);
    double spent[KEPT] = {0.0}; // periods, on changes of each: more on the worse
    for (int k = 0; k < KEPT; k++) {
        c->ratio[k] = -1.0;
    }
    uint64_t number = 0; // of the next draw, which sets the random numbers of its trial, too
    for (double trials = 0.0, of_time = 0.0; trials < c->trials && of_time < 1.0;) {
        const double done = isinf(c->trials) ? of_time : trials / c->trials;
        Sequence sequence = sequence_drawn(c->seed, number++, c->kind);
        const bool changes = done > DRAWN && sequence.steps > 0 && c->ratio[least(c->ratio)] >= 0.0;
        sequence.steps =
            sequence.steps > 1 ? 1 + random_chance(JUMPS) : 1; // an empty one is not in the domain
        const int place = least(changes ? spent : c->ratio);
        if (changes) {
            sequence = changed(&c->kept[place], &sequence);
        }
        const ReferenceScene *first = &sequence.step[0], *last = &sequence.step[sequence.steps - 1];
        const double periods = first->h * first->f + last->h * last->f;
        of_time = difftime(time(NULL), begin) / c->seconds;
        spent[place] += changes ? (1.0 + periods) / sqrt(c->ratio[place]) : 0.0;
        if ((!changes && random_01() * periods > LONG) || !scene_is_in_domain(first) ||
            !scene_is_in_domain(last) || !has(&sequence, c->where)) {
            continue;
        }
        const double ratio = try_it(context, &sequence);
        trials += 1.0;
        if (ratio > c->ratio[place]) {
            c->ratio[place] = ratio;
            c->kept[place] = sequence;
        }
    }
}
