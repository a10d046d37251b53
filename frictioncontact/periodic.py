"""What is read from an FMU in its periodic state, in which initialState = Settled starts it."""

from collections.abc import Mapping, Sequence

import numpy as np

from .fmu import SETTLED, FrictionFmu, Value, simulate


def periodic_mean(fmu: FrictionFmu, start_values: Mapping[str, Value]) -> float:
    """Time mean of F_t [N] over one period of the periodic state of a scene."""
    with fmu.session({**start_values, **SETTLED}) as session:
        session.step(1.0 / session.get("vibration.f"))
        return session.get("F_t_mean")


def periodic_waves(
    fmu: FrictionFmu,
    start_values: Mapping[str, Value],
    names: Sequence[str],
    periods: int = 2,
    samples: int = 240,
) -> dict[str, np.ndarray]:
    """Variables over some periods of the periodic state; arrays of periods * samples + 1 points.

    "time" [s] is among them, 0 at the start of a period.
    """
    f = float(start_values.get("vibration.f", fmu.variables["vibration.f"].start))
    return simulate(fmu, {**start_values, **SETTLED}, 1.0 / f / samples, periods * samples, outputs=names)
