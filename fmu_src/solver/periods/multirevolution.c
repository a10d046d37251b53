#include "solver/periods/multirevolution.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

#include "model/extremes.h"
#include "solver/integrate/march.h"
#include "solver/integrate/tuning.h"
#include "solver/periods/period_interpolation.h"
#include "solver/periods/segments.h"

// One period, or the part [from, to] of it.
static void take_part(const FcScene* scene, const FcSolverOptions* options, double k, double from, double to,
                      FcStepResult* total) {
    assert(k >= 0.0 && from >= 0.0 && from <= to);
    FcScene part = fc_scene_later(scene, k / scene->drive.vibration.f);
    if (from > 0.0) {
        part = fc_scene_from(&part, from);
    }
    fc_march_segments(&part, options, to - from, total);
}

// The number of periods from k to the next kink: at |V| = V_1, beyond which V begins or ends to reverse; at the next end
// of a Stribeck peak beside it, which few points far from it do not see; and where the surfaces reverse between two periods,
// so that the period before has one reversal more than the one after, or less.
static double to_kink(const FcScene* scene, double k) {
    const FcDrive* drive = &scene->drive;
    const double V_1 = drive->vibration.V_1;
    const double peak = fc_has_stribeck_curve(scene->friction) ? FC_END_OF_PEAK * scene->friction->V_S : 0.0;
    const double between = -V_1 * fc_drive_phase(drive, 0.0).cosine;
    const double kinks[] = {V_1, V_1 - peak, V_1 + peak, -V_1, peak - V_1, -V_1 - peak, between};
    double nearest = HUGE_VAL;
    for (size_t i = 0; i < sizeof kinks / sizeof *kinks && drive->V.rate != 0.0; i++) {
        const double at = (kinks[i] - drive->V.value) / drive->V.rate * drive->vibration.f; // periods
        if (at > k) {
            nearest = fc_min(nearest, floor(at - k));
        }
    }
    assert(nearest >= 0.0);
    return nearest;
}

// How the next try goes.
typedef struct {
    double longest;  // periods of a block, at the most
    double tries_at; // the period before which no block is tried
    double alone;    // periods that are taken one by one before the next try, if no block is smooth
} Tries;

// After a block of `left` periods, its last one included, has been taken or refused: a longer block, a shorter one, or
// some periods one by one.
static void adapt(Tries* tries, bool taken, double left, double fewest, double k) {
    tries->longest = taken ? 2.0 * left : floor(0.5 * left);
    // A block on a line has one period less, the last one, which closes it.
    if (tries->longest < fewest + 1.0) {
        tries->longest = 2.0 * fewest + 2.0;
        tries->tries_at = k + tries->alone;
        tries->alone *= 2.0;
    }
    if (taken) {
        tries->alone = FC_MIN_PERIODS;
    }
}

// Takes the block from the phase of its first period on, and the rest of the period that closes it. False if the block is
// refused: of *total only the evaluations have changed then.
static bool take_block(const FcBlock* block, bool closes, FcStepResult* total) {
    const double period = 1.0 / block->scene->drive.vibration.f;
    FcStepResult before = *total;
    assert(block->count >= FC_MIN_PERIODS && block->phase >= 0.0);
    total->meetings = 0;
    if (block->phase > 0.0) {
        take_part(block->scene, block->options, block->first, 0.0, block->phase, total);
    }
    const bool taken = (block->side != 0 || total->meetings == 0) && fc_interpolate_periods(block, total);
    if (taken && closes) {
        take_part(block->scene, block->options, block->first + block->count, block->phase, period, total);
    } else if (!taken) {
        before.evaluations = total->evaluations;
        *total = before;
    }
    return taken;
}

// In turn: one period that shows whether a bounded bristle slips in it; a block of periods, if one may be tried; without a
// block, one period of a bristle without a bound.
double fc_multirevolution(const FcScene* scene, const FcSolverOptions* options, double periods,
                          FcStepResult* total) {
    assert(periods >= 0.0 && periods == floor(periods) && fc_drive_vibrates(&scene->drive));
    const double period = 1.0 / scene->drive.vibration.f;
    const bool is_planar = fc_is_planar(scene, fc_bristle_of(total));
    const bool is_bounded = fc_march_may_meet(scene);
    Tries tries = {.longest = periods, .tries_at = 0.0, .alone = FC_MIN_PERIODS};
    double k = 0.0;
    while (k < periods && total->evaluations <= FC_MAX_EVALUATIONS) {
        bool slipped = false;
        if (is_bounded) { // the first period says whether it slips
            total->meetings = total->slip_side = 0;
            take_part(scene, options, k, 0.0, period, total);
            slipped = total->meetings > 0;
            k += 1.0;
        }
        const double left = fc_min(tries.longest, fc_min(periods - k, to_kink(scene, k)));
        // On a line periods begin at the bound, if the bristle slips along it for any time.
        const bool is_one_dimensional = slipped && !is_planar && total->slip_side != 0;
        const bool forgets = slipped && !is_one_dimensional;
        const double phase = is_one_dimensional ? total->slip_time : 0.0;
        const bool closes = phase > 0.0 || forgets; // a last period, taken without interpolation
        const double count = closes ? left - 1.0 : left;
        const double fewest = forgets ? FC_MIN_PERIODS_OF_SLIPS : FC_MIN_PERIODS;
        const FcBlock block = {.scene = scene,
                               .is_planar = is_planar,
                               .is_bounded = is_bounded,
                               .options = options,
                               .first = k,
                               .count = floor(count),
                               .phase = phase,
                               .side = is_one_dimensional ? total->slip_side : 0,
                               .warm_up = forgets ? FC_WARM_UP : 0};
        bool taken = false;
        if (k >= tries.tries_at && block.count >= fewest && k >= block.warm_up &&
            (slipped || !fc_has_broken_away(scene->friction, total->state))) {
            taken = take_block(&block, closes, total);
            adapt(&tries, taken, left, fewest, k);
        }
        if (taken) {
            k += block.count + (closes ? 1.0 : 0.0);
        } else if (!is_bounded) {
            take_part(scene, options, k, 0.0, period, total);
            k += 1.0;
        }
        assert(k <= periods);
    }
    return k;
}
