#include "tally.h"

#include <math.h>
#include <stdio.h>

#include "scenes.h"

const char* const LAW_NAMES[] = {"any", "Dahl", "Coulomb", "ElasticPlastic", "LuGre"};
static const char* const KAPPA_NAMES[KAPPAS] = {"below 1",    "1 to 1e2",    "1e2 to 1e4", "1e4 to 1e6",
                                                "1e6 to 1e8", "1e8 to 1e10", "above 1e10"};

static const char* const FAMILIES[METHODS] = {"", " by cvode", " by fixed steps"};

static int kappa_class(double kappa) {
    const double tens = kappa > 1.0 ? log10(kappa) / 2.0 : -1.0;
    return tens < 0.0 ? 0 : tens >= KAPPAS - 2 ? KAPPAS - 1 : 1 + (int)tens;
}

static void count(Cell* cell, const Verdict* verdict) {
    cell->steps++;
    cell->misses += !(verdict->ratio <= verdict->granted);
    cell->worst = fmax(cell->worst, verdict->ratio);
}

void tally_count(Tally* tally, const TrialStep* taken, int method, int column, const Verdict* verdict) {
    const ReferenceScene* scene = &taken->scene;
    const int family = method > FMU_CVODE ? 2 : method - 1;
    count(&tally->by_law[scene->law - 1 + LAWS * family][column], verdict);
    count(&tally->by_class[verdict->kind][column], verdict);
    count(&tally->by_grade[verdict->of][column], verdict);
    if (family == 0) {
        count(&tally->by_kappa[kappa_class(scene_kappa(scene))][column], verdict);
    }
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
    add_cells(sum->by_law, part->by_law, METHODS * LAWS);
    add_cells(sum->by_kappa, part->by_kappa, KAPPAS);
    add_cells(sum->by_class, part->by_class, CLASSES);
    add_cells(sum->by_grade, part->by_grade, GRADES);
    sum->drawn += part->drawn;
    sum->refused += part->refused;
    sum->unsure += part->unsure;
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
    long misses = 0;
    printf("\nMisses of what is promised, and the worst error over the tolerance:\n");
    print_head("law", tolerance, tolerances);
    for (int row = 0; row < METHODS * LAWS; row++) {
        char name[40];
        snprintf(name, sizeof name, "%s%s", LAW_NAMES[1 + row % LAWS], FAMILIES[row / LAWS]);
        print_row(name, tally->by_law[row], tolerances);
        for (int k = 0; k < tolerances; k++) {
            misses += tally->by_law[row][k].misses;
        }
    }
    print_head("kappa", tolerance, tolerances);
    for (int row = 0; row < KAPPAS; row++) {
        print_row(KAPPA_NAMES[row], tally->by_kappa[row], tolerances);
    }
    print_head("class", tolerance, tolerances);
    for (int row = 0; row < CLASSES; row++) {
        print_row(promise_name(row), tally->by_class[row], tolerances);
    }
    print_head("worst is", tolerance, tolerances);
    for (int row = 0; row < GRADES; row++) {
        print_row(GRADE_NAMES[row], tally->by_grade[row], tolerances);
    }
    printf("\n%ld sequences drawn, %ld refused or too dear, %ld misses; the reference is unsure of %ld\n",
           tally->drawn, tally->refused, misses, tally->unsure);
    return misses;
}
