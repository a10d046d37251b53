#include "solver/section.h"

#include <math.h>

// Gauss panels for a section over which the bristle relaxes by less than this, and the phase and ln(sigma) move by less.
static const double SOFT = 7.0;
static const double SOFT_IN_BELL = 2.5;
static const double SLOW = 15.0;

static double moving(const FcScene* scene, double duration) {
    const FcDrive* drive = &scene->drive;
    const double of_sigma =
        2.0 * scene->at_E.decay * (fabs(drive->d.rate) + drive->vibration.a_d * drive->omega);
    return duration * (drive->omega + of_sigma);
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

FcSections fc_sections(const FcScene* scene, const FcScene* beyond_bells, const FcStretch* stretch,
                       double per_path) {
    const double ends[] = {stretch->start, stretch->bells.after, stretch->bells.before, stretch->end};
    const bool narrow = is_narrow_somewhere(scene, stretch);
    FcSections sections = {.count = 0};
    for (int i = 0; i < 3; i++) {
        const double duration = ends[i + 1] - ends[i];
        if (!(duration > 0.0)) {
            continue;
        }
        FcSection* section = &sections.at[sections.count++];
        section->in_bell = i != 1;
        section->scene = section->in_bell ? scene : beyond_bells;
        section->start = ends[i];
        section->end = ends[i + 1];
        section->share = duration / (stretch->end - stretch->start);
        section->moves = moving(scene, duration);
        section->relaxes =
            per_path * fabs(fc_stretch_displacement(stretch, &scene->drive, ends[i], ends[i + 1]));
        section->forgets = per_path * (fabs(stretch->displacement) + stretch->path_after);
        section->soft =
            section->relaxes < (section->in_bell ? SOFT_IN_BELL : SOFT) && section->moves < SLOW && !narrow;
    }
    return sections;
}
