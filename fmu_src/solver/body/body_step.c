#include "solver/body/body_step.h"

#include <assert.h>

#include "solver/body/body_march.h"
#include "solver/body/body_rigid.h"
#include "solver/periods/segments.h"

// Takes *result and the body over a segment with a bristle.
static bool take_bristle(const FcScene* scene, FcMethod method, FcCvode* cvode,
                         const FcSolverOptions* options, double h, FcBody* body, FcStepResult* result,
                         FcMessage* message) {
    bool is_doubtful = true;
    if (method != FC_METHOD_CVODE &&
        fc_body_march_step(scene, options, h, body, result, &is_doubtful, message)) {
        return true;
    }
    return is_doubtful && cvode && fc_body_cvode_step(cvode, scene, options, h, body, result, message);
}

bool fc_body_step(const FcScene* scene, FcMethod method, FcCvode* cvode, const FcSolverOptions* options,
                  double h, FcBristle from, FcBody* body, FcStepResult* result, FcMessage* message) {
    assert(h >= 0.0 && body->m > 0.0 && options->tolerance > 0.0 && !fc_is_planar(scene, from));
    fc_result_start(result, from, 0.0);
    const FcBody start = *body;
    body->x = 0.0;
    FcSegments segments;
    fc_segments_start(&segments, scene, h);
    while (fc_next_segment(&segments)) {
        const bool is_separated = fc_scene_is_separated(segments.scene);
        if (is_separated) {
            fc_open_contact_step(result);
        }
        const bool is_rigid = is_separated || !fc_has_bristle(scene->friction);
        const bool is_done =
            is_rigid
                ? fc_body_rigid_step(segments.scene, options, segments.h, body, result, message)
                : take_bristle(segments.scene, method, cvode, options, segments.h, body, result, message);
        if (!is_done) {
            return false;
        }
    }
    // v and x are rounded once: over the many segments of a load that falls by decades their rounding would add up.
    body->v = start.v + (fc_body_pushed(&start, h) - result->impulse) / start.m;
    body->x += start.x;
    return true;
}
