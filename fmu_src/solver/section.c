#include "solver/section.h"

#include <math.h>

#include "solver/gauss_tables.h"
#include "solver/panel.h"

// In a bell, Gauss panels for a section over which the bristle relaxes by less than this; and anywhere, where the phase and
// ln(sigma) move by less.
static const double SOFT_IN_BELL = 2.5;
static const double SLOW = 15.0;
// Where more relaxes, Radau panels are cheaper, whatever sigma is elsewhere.
static const double STIFF = 40.0;
// Where as much may relax, sigma is asked for in the section: it may be many times that at the start.
static const double MATTERS = 0.5;
// What a bell adds to the change over a panel, beyond its width.
static const double BELL_CHANGE = 2.0;

static double phase_moves(const FcScene* scene, double duration) { return duration * scene->drive.omega; }

static double stiffness_moves(const FcScene* scene, double duration) {
    const FcDrive* drive = &scene->drive;
    return duration * 2.0 * scene->at_E.decay * (fabs(drive->d.rate) + drive->vibration.a_d * drive->omega);
}

// Whether a stretch that is all in a bell goes through so much of it that nodes spread evenly may miss it.
static bool is_narrow_somewhere(const FcScene* scene, const FcStretch* stretch) {
    const FcDrive* drive = &scene->drive;
    const double moves = 2.0 * drive->vibration.V_1 + fabs(drive->V.rate) * (stretch->end - stretch->start);
    return stretch->bells.after == stretch->end && moves > 3.0 * scene->friction->V_S;
}

double fc_stretch_displacement(const FcStretch* stretch, const FcDrive* drive, double t, double end) {
    return t == stretch->start && end == stretch->end ? stretch->displacement
                                                      : fc_drive_displacement(drive, t, end);
}

enum { RELAXATION_NODES = 4 };

static FcRelaxation relaxation_of(const FcSection* section) {
    enum { N = RELAXATION_NODES };
    const FcGaussRule* rule = &FC_GAUSS_4;
    const double duration = section->end - section->start;
    FcNodeCoefficients at;
    fc_node_coefficients(section->scene, section->start, duration, rule->node, N, &at);
    double z[N]; // if it went on as there
    for (int i = 0; i < N; i++) {
        z[i] = duration * at.sigma[i] * fabs(at.V[i]) / at.limit[i];
    }
    const double first = rule->weight[0] * z[0] + rule->weight[1] * z[1];
    const double second = rule->weight[2] * z[2] + rule->weight[3] * z[3];
    return (FcRelaxation){
        .whole = first + second,
        .half = fc_most(first, second),
        .fastest = fc_most(fc_most(z[0], z[1]), fc_most(z[2], z[3])),
    };
}

static void find_relaxation(FcSection* section, const FcStretch* stretch, double per_path,
                            double most_per_path) {
    const FcDrive* drive = &section->scene->drive;
    const double X = fabs(fc_stretch_displacement(stretch, drive, section->start, section->end));
    const double z = per_path * X;
    section->is_measured = !section->in_bell && most_per_path * X > MATTERS && z < STIFF;
    section->z = section->is_measured ? relaxation_of(section) : (FcRelaxation){z, z, z};
}

static bool is_soft(const FcSection* section) {
    const double duration = section->end - section->start;
    return section->z.whole < (section->in_bell ? SOFT_IN_BELL : STIFF) &&
           phase_moves(section->scene, duration) + stiffness_moves(section->scene, duration) < SLOW;
}

FcGaussPieces fc_section_pieces(const FcSection* section, const FcBells* bells, double decades) {
    const double duration = section->end - section->start;
    const double phase = phase_moves(section->scene, duration);
    const double stiffness = stiffness_moves(section->scene, duration);
    if (section->in_bell) {
        const double change = 1.4 * (phase + stiffness) + 2.0 * section->z.whole + BELL_CHANGE + bells->reach;
        return fc_gauss_pieces_in_bell(change, bells->digits);
    }
    return fc_gauss_pieces(0.5 * phase, 0.5 * stiffness, &section->z, decades - fc_digits(section->share));
}

int fc_sections(const FcScene* scene, const FcScene* beyond_bells, const FcStretch* stretch, double per_path,
                double most_per_path, FcSection* sections, double* evaluations) {
    const double ends[] = {stretch->start, stretch->bells.after, stretch->bells.before, stretch->end};
    const bool narrow = is_narrow_somewhere(scene, stretch);
    int count = 0;
    for (int i = 0; i < 3; i++) {
        const double duration = ends[i + 1] - ends[i];
        if (!(duration > 0.0)) {
            continue;
        }
        FcSection* section = &sections[count++];
        section->in_bell = i != 1;
        section->scene = section->in_bell ? scene : beyond_bells;
        section->start = ends[i];
        section->end = ends[i + 1];
        section->share = duration / (stretch->end - stretch->start);
        find_relaxation(section, stretch, per_path, most_per_path);
        *evaluations += section->is_measured ? RELAXATION_NODES : 0.0;
        section->forgets = per_path * (fabs(stretch->displacement) + stretch->path_after);
        section->soft = !narrow && is_soft(section);
    }
    return count;
}
