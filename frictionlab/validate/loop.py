"""A measured loop of presliding and sliding: the friction along the path, law by law.

The position is the input. Fitted on the first half of the record: the stiffness and F_C, by least
squares. Predicted: the second half, with the deflection carried on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from frictionlab.batch import simulate_many
from frictionlab.fmu import FrictionFmu
from frictionlab.validate.measurements import Loop

LAWS = ("Coulomb", "Dahl", "ElasticPlastic")


@dataclass(frozen=True)
class LoopFit:
    law: str
    stiffness: float | None  # N/m
    F_C: float  # N
    friction: np.ndarray  # N, model at the samples
    rms_fitted: float  # of the first half, over the amplitude of the measured friction
    rms_predicted: float  # of the second half
    work: float  # over the measured work


def along_path(fmu: FrictionFmu, data: Loop, start_values: dict[str, float | str]) -> np.ndarray:
    """F_t [N] at the samples, the velocity held between them."""
    steps = np.diff(data.time)
    velocities = np.diff(data.position) / steps
    found = simulate_many(
        fmu.path,
        {**start_values, "V": velocities[0]},
        {"F_t": ("F_t", "samples")},
        inputs={"V": np.concatenate([velocities[:1], velocities])},
        steps=np.concatenate([[0.0], steps]),  # one of no length gives the force at the first sample
        unit="s",
    )
    return found["F_t"]


def fit(fmu: FrictionFmu, data: Loop, law: str) -> LoopFit:
    half = len(data.time) // 2
    amplitude = float(np.percentile(np.abs(data.friction), 95.0))

    def model(parameters: Sequence[float]) -> np.ndarray:
        stiffness, F_C = np.exp(parameters)
        start = float(np.clip(data.friction[0], -F_C, F_C)) / stiffness
        values = {
            "friction.model": law,
            "contact.model": "Constant",
            "contact.sigma": stiffness,
            "F_C": F_C,
            "delta_0": start,
        }
        return along_path(fmu, data, values)

    def residuals(parameters: Sequence[float]) -> np.ndarray:
        return (model(parameters) - data.friction)[:half]

    start = np.log([amplitude / 6e-5, amplitude])
    found = least_squares(residuals, start, diff_step=1e-4, x_scale=[1.0, 0.2])
    friction = model(found.x)
    error = friction - data.friction
    stiffness, F_C = np.exp(found.x)
    return LoopFit(
        law,
        None if law == "Coulomb" else float(stiffness),
        float(F_C),
        friction,
        float(np.sqrt(np.mean(error[:half] ** 2))) / amplitude,
        float(np.sqrt(np.mean(error[half:] ** 2))) / amplitude,
        _work(data, friction) / _work(data, data.friction),
    )


def _work(data: Loop, friction: np.ndarray) -> float:
    """Work along the path [J], trapezoidal."""
    return float(np.trapezoid(friction, data.position))
