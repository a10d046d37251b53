#include "plain_equation.h"

#include <math.h>

static const double TWO_PI = 6.283185307179586;

Plain plain_of(const Job* job, Run* run) {
    Plain plain = {.start = job->start, .reason = run->reason, .reason_size = sizeof run->reason};
    for (int i = 0; i < job->values; i++) {
        if (job->value[i].reference < PLAIN_PARAMETERS) {
            plain.p[job->value[i].reference] = job->value[i].value;
        }
    }
    plain.cos_phase = cos(plain.p[PLAIN_PHASE_D]);
    plain.sin_phase = sin(plain.p[PLAIN_PHASE_D]);
    return plain;
}

void plain_set_inputs(Plain* plain, const Job* job, int k) {
    plain->start = job->start + k * job->step;
    for (int i = 0; i < job->inputs; i++) {
        const double now = job_sample(&job->input[i], k);
        const double rate = job->linear ? (job_sample(&job->input[i], k + 1) - now) / job->step : 0.0;
        plain->p[job->input[i].reference] = now;
        *(job->input[i].reference == PLAIN_V ? &plain->V_rate : &plain->d_rate) = rate;
    }
}

PlainCoefficients plain_at(Plain* plain, double t) {
    const double* p = plain->p;
    const double elapsed = t - plain->start;
    const double angle = TWO_PI * p[PLAIN_F] * t;
    const int vibrates = p[PLAIN_V_1] != 0.0 || p[PLAIN_A_D] != 0.0;
    const double cosine = vibrates ? cos(angle) : 0.0, sine = vibrates ? sin(angle) : 0.0;
    PlainCoefficients at = {.V = p[PLAIN_V] + plain->V_rate * elapsed + p[PLAIN_V_1] * cosine,
                            .sigma = p[PLAIN_SIGMA_REF]};
    if (p[PLAIN_DECAY] != 0.0) {
        const double swing = plain->cos_phase * cosine - plain->sin_phase * sine;
        const double d = p[PLAIN_D] + plain->d_rate * elapsed + p[PLAIN_A_D] * swing;
        const double ratio = p[PLAIN_D_REF] / d;
        at.sigma *= ratio * ratio * ratio * exp(-2.0 * p[PLAIN_DECAY] * (d - p[PLAIN_D_REF]));
    }
    at.rate = -at.sigma * fabs(at.V) / p[PLAIN_F_C];
    plain->evaluations += 1.0;
    return at;
}

double plain_next_reversal(const Plain* plain, double t, double end) {
    const double* p = plain->p;
    if (p[PLAIN_V_1] == 0.0) {
        const double root = plain->start - p[PLAIN_V] / plain->V_rate; // not finite where V is held
        return root > t && root < end ? root : end;
    }
    if (fabs(p[PLAIN_V]) >= fabs(p[PLAIN_V_1])) {
        return end;
    }
    const double angle = acos(-p[PLAIN_V] / p[PLAIN_V_1]) / TWO_PI; // of a turn; the other one lies at -angle
    const double turns = p[PLAIN_F] * t;
    const double first = floor(turns);
    const double candidates[] = {angle, 1.0 - angle, 1.0 + angle};
    for (int i = 0; i < 3; i++) {
        const double root = (first + candidates[i]) / p[PLAIN_F];
        if (root > t * (1.0 + 1e-15) + 1e-12 / p[PLAIN_F]) {
            return fmin(root, end);
        }
    }
    return end;
}

void plain_run(const Job* job, Run* run, int is_open, PlainStep step, void* solver) {
    run->failed_at = is_open ? -1 : 0;
    const double cpu = cpu_seconds();
    for (int k = 0; k < job->count && run->failed_at < 0; k++) {
        if (!step(solver, job, k, run->row + k * job->outputs)) {
            run->failed_at = k;
        }
    }
    run->cpu = cpu_seconds() - cpu;
}
