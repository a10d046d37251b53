"""Scenarios through one session each: what batches and sweeps are compared with, bit for bit."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from frictioncontact.fmu import FrictionFmu, Value

SAMPLED = ("F_t", "sigma", "A_r")


def sampled_period(
    fmu: FrictionFmu, values: Mapping[str, Value], settle: float | None, samples: int
) -> dict[str, float]:
    """The columns of a sweep: one period in samples steps, after settle periods or settled at once."""
    initial = {} if settle is not None else {"initialState": "Settled"}
    with fmu.session({**values, **initial}) as session:
        period = 1.0 / session.get("vibration.f")
        if settle:
            session.step(settle * period)
        work = session.get("W_f")
        rows = np.empty((samples, len(SAMPLED)))
        for row in rows:
            session.step(period / samples)
            row[:] = session.read(SAMPLED)
        work = session.get("W_f") - work
        mean = session.get("F_t_settled")
        evaluations = session.get("solver.evaluations")
    still = {"vibration.V_1": 0.0, "vibration.V_2": 0.0, "vibration.a_d": 0.0}
    with fmu.session({**values, **still}) as session:
        without = session.get("F_t_settled")
    force, sigma, area = rows.T
    return {
        "F_mean": mean,
        "reduction": 100.0 * (without - mean) / without,
        "F_min": force.min(),
        "F_max": force.max(),
        "sigma_mean": sigma.mean(),
        "A_r_mean": area.mean(),
        "W_period": work,
        "evaluations": evaluations,
    }
