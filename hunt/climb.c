#include "climb.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "random.h"

static const double MOST_PERIODS = 400.0;        // of a first step, for the reference's sake
static const double DRAWN = 1.0 / 3.0;           // of a climb: the rest changes what was drawn
static const double JUMPS = 0.2;                 // the chance of a second step
static const double SHARES[] = {0.5, 0.1, 0.02}; // by which numbers change,
enum { MOST_WORDS = 3 };                         // so many at once
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

// Changes a number of the text by up to the share, or takes a word over from another text, to the first step.
static void change_word(char* text, double share, const char* other) {
    char changed[SEQUENCE_TEXT], word[100];
    int name;
    double value;
    if (random_chance(TAKES_OVER)) {
        const char* taken = other + any_word(other);
        const char* later = strstr(text, "then ");
        const int first = later ? (int)(later - text) : (int)strlen(text);
        snprintf(changed, sizeof changed, "%.*s%.*s %s", first, text, (int)strcspn(taken, " "), taken,
                 text + first);
        strcpy(text, changed);
        return;
    }
    const size_t begin = any_word(text);
    if (sscanf(text + begin, "%*[^= ]=%n%lf", &name, &value) == 1) {
        value *= 1.0 + share * (2.0 * random_01() - 1.0);
        snprintf(word, sizeof word, "%.*s%.17g ", name, text + begin, value);
        with_word(changed, text, begin, word);
        strcpy(text, changed);
    }
}

static Sequence changed(const Sequence* from, const Sequence* drawn) {
    char text[SEQUENCE_TEXT], other[SEQUENCE_TEXT];
    Sequence first = *drawn;
    first.steps = 1;
    sequence_text(from, text, sizeof text);
    sequence_text(&first, other, sizeof other);
    const double share = SHARES[random_below(3)];
    for (int k = 1 + random_below(MOST_WORDS); k > 0; k--) {
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

void climb(Climb* c, TrySequence* try_it, void* context) {
    const time_t begin = time(NULL);
    for (int k = 0; k < KEPT; k++) {
        c->ratio[k] = -1.0;
    }
    uint64_t number = 0; // of the next draw, which sets the random numbers of its trial, too
    for (double trials = 0.0, of_time = 0.0; trials < c->trials && of_time < 1.0;) {
        const double done = isinf(c->trials) ? of_time : trials / c->trials;
        Sequence sequence = sequence_drawn(c->seed, number++, c->kind);
        if (sequence.steps == 0) {
            continue;
        }
        sequence.steps = sequence.steps > 1 ? 1 + random_chance(JUMPS) : 1;
        int place = 0;
        for (int k = 1; k < KEPT; k++) {
            place = c->ratio[k] < c->ratio[place] ? k : place;
        }
        if (done > DRAWN && c->ratio[place] >= 0.0) {
            place = random_below(KEPT);
            sequence = changed(&c->kept[place], &sequence);
        }
        const ReferenceScene *first = &sequence.step[0], *last = &sequence.step[sequence.steps - 1];
        if (first->h * first->f > MOST_PERIODS || !scene_is_in_domain(first) || !scene_is_in_domain(last) ||
            !has(&sequence, c->where)) {
            continue;
        }
        const double ratio = try_it(context, &sequence);
        trials += 1.0;
        of_time = difftime(time(NULL), begin) / c->seconds;
        if (ratio > c->ratio[place]) {
            c->ratio[place] = ratio;
            c->kept[place] = sequence;
        }
    }
}
