"""What is read from an FMU in its periodic state."""

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from .fmu import SETTLED, FrictionFmu, Value, simulate

STILL = {"vibration.V_1": 0.0, "vibration.V_2": 0.0, "vibration.a_d": 0.0}  # start values: no vibration


def reduction(mean: npt.ArrayLike, without: npt.ArrayLike) -> np.ndarray:
    """Percent by which mean forces lie below those without vibration; nan if there is none of these."""
    without = np.where(without, without, np.nan)
    return 100.0 * (without - mean) / without


def periodic_mean(fmu: FrictionFmu, start_values: Mapping[str, Value]) -> float:
    """Time mean of F_t [N] in the periodic state of a scene, over the several periods of static friction."""
    with fmu.session(start_values) as session:
        return session.get("F_t_settled")


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
