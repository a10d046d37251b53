#include "tally.h"

#include <math.h>
#include <stdio.h>

#include "scenes.h"

const char* const LAW_NAMES[] = {"any", "Dahl", "Coulomb", "ElasticPlastic", "LuGre"};
static const char* const KAPPA_NAMES[KAPPAS] = {"below 1",    "1 to 1e2",  "1e2 to 1e4",  "1e4 to 1e6",
                                                "1e6 to 1e8", "above 1e8", "no vibration"};

static int kappa_class(const ReferenceScene* scene) {
    const double kappa = scene_kappa(scene);
    const double tens = kappa > 1.0 ? log10(kappa) / 2.0 : -1.0;
    return scene->V_1 == 0.0 && scene->a_d == 0.0 ? KAPPAS - 1
           : tens < 0.0                           ? 0
           : tens >= 4.0                          ? 5
                                                  : 1 + (int)tens;
}

static void count(Cell* cell, const Verdict* verdict) {
    cell->steps++;
    cell->misses += !(verdict->ratio <= 1.0);
    cell->worst = fmax(cell->worst, verdict->ratio);
}

void tally_count(Tally* tally, const TrialStep* taken, int column) {
    count(&tally->by_law[taken->scene.law - 1][column], &taken->verdict);
    count(&tally->by_kappa[kappa_class(&taken->scene)][column], &taken->verdict);
}

static void add_cells(Cell (*sum)[MOST_TOLERANCES], const Cell (*part)[MOST_TOLERANCES], int rows) {
    for (int row = 0; row < rows; row++) {
        for (int k = 0; k < MOST_TOLERANCES; k++) {
            sum[row][k].steps += part[row][k].steps;
            sum[row][k].misses += part[row][k].misses;
            sum[row][k].worst = fmax(sum[row][k].worst, part[row][k].worst);
        }
    }
}

void tally_add(Tally* sum, const Tally* part) {
    add_cells(sum->by_law, part->by_law, LAWS);
    add_cells(sum->by_kappa, part->by_kappa, KAPPAS);
    sum->drawn += part->drawn;
    sum->refused += part->refused;
    sum->unknown += part->unknown;
}

static void print_row(const char* name, const Cell* cells, int tolerances) {
    long steps = 0;
    for (int k = 0; k < tolerances; k++) {
        steps += cells[k].steps;
    }
    if (steps == 0) {
        return;
    }
    printf("| %s | %ld |", name, steps);
    for (int k = 0; k < tolerances; k++) {
        printf(" %ld, %.2g |", cells[k].misses, cells[k].worst);
    }
    printf("\n");
}

static void print_head(const char* name, const double* tolerance, int tolerances) {
    printf("\n| %s | steps |", name);
    for (int k = 0; k < tolerances; k++) {
        printf(" %g |", tolerance[k]);
    }
    printf("\n|---|---|");
    for (int k = 0; k < tolerances; k++) {
        printf("---|");
    }
    printf("\n");
}

long tally_print(const Tally* tally, const double* tolerance, int tolerances) {
    long misses = 0, steps = 0;
    printf("\nMisses, and the worst error over the tolerance:\n");
    print_head("law", tolerance, tolerances);
    for (int row = 0; row < LAWS; row++) {
        print_row(LAW_NAMES[1 + row], tally->by_law[row], tolerances);
        for (int k = 0; k < tolerances; k++) {
            misses += tally->by_law[row][k].misses;
            steps += tally->by_law[row][k].steps;
        }
    }
    print_head("kappa", tolerance, tolerances);
    for (int row = 0; row < KAPPAS; row++) {
        print_row(KAPPA_NAMES[row], tally->by_kappa[row], tolerances);
    }
    printf("\n%ld sequences of %ld steps, %ld refused, %ld beyond the reference, %ld misses\n", tally->drawn,
           steps, tally->refused, tally->unknown, misses);
    return misses;
}
