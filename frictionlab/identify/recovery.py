"""Does an identification recover what made the data? Synthetic noisy measurements, fitted again and again."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from frictionlab.figure import BLUE, INK, ORANGE, Figure, Level, Line, Panel
from frictionlab.fmu import FrictionFmu
from frictionlab.identify.data import Measurements, Uncertain
from frictionlab.identify.experiment import Rows
from frictionlab.identify.fit import Fit
from frictionlab.identify.fit import fits as many
from frictionlab.identify.parameter import Parameter, parameter

TRUTH = {"contact.stiffnessScale": 6e-7, "vibration.phase_d": 2.2, "F_C": 48.0}
NOISE = 0.5  # N, standard deviation of one mean
NAMES = ("V", "vibration.V_1", "vibration.a_d")


def conditions() -> list[dict[str, float]]:
    """Twelve rows as a person would measure them: some with, some without normal vibration."""
    return [
        {"V": V, "vibration.V_1": V_1, "vibration.a_d": a_d}
        for V in (0.2, 0.6)
        for V_1 in (0.5, 1.0, 1.5)
        for a_d in (0.0, 1e-6)
    ]


def measurements(force: np.ndarray, uncertainty: list[float] | None = None) -> Measurements:
    return Measurements(NAMES, conditions(), list(force), uncertainty)


def parameters(fmu: FrictionFmu) -> list[Parameter]:
    """Nothing is known of them but where the command searches."""
    return [parameter(fmu, name, None, None, {}) for name in TRUTH]


def true_forces(fmu: FrictionFmu) -> np.ndarray:
    experiment = Rows(fmu, measurements(np.zeros(len(conditions()))), parameters(fmu))
    return experiment.means([p.to_coordinate(TRUTH[p.name]) for p in experiment.parameters])


def fits(
    fmu: FrictionFmu, seeds: int, uncertainty: list[float] | None = None, V_1_error: float = 0.0
) -> list[Fit]:
    """One fit per seed; uncertainty as stated by who measured, or None to estimate it from the scatter.

    V_1_error: relative standard error of the V_1 of each row.
    """
    forces = true_forces(fmu)
    rows = measurements(forces, uncertainty)
    if V_1_error > 0.0:
        uncertain = [
            Uncertain("vibration.V_1", V_1_error * row["vibration.V_1"], k)
            for k, row in enumerate(conditions())
        ]
        rows = replace(rows, uncertain=tuple(uncertain))
    experiment = Rows(fmu, rows, parameters(fmu))
    random = np.array(
        [np.random.default_rng(seed).standard_normal(len(experiment.target)) for seed in range(seeds)]
    )
    random[:, : len(forces)] *= NOISE
    return many(experiment, experiment.target + random, starts=4)


def held(found: list[Fit], name: str) -> int:
    """How many 95 % intervals hold the true value."""
    k = list(TRUTH).index(name)
    return sum(low <= TRUTH[name] <= high for low, high in (one.interval(k) for one in found))


def figure(fmu: FrictionFmu, seeds: int) -> Figure:
    """The intervals of every seed against the truth."""
    found = fits(fmu, seeds)
    panels = []
    for k, name in enumerate(TRUTH):
        factor, unit = {
            "contact.stiffnessScale": (1e7, "1e-7"),
            "vibration.phase_d": (np.degrees(1.0), "deg"),
        }.get(name, (1.0, "N"))
        good: tuple[list[float], list[float]] = ([], [])
        missed: tuple[list[float], list[float]] = ([], [])
        for seed, one in enumerate(found):
            low, high = one.interval(k)
            x, y = good if low <= TRUTH[name] <= high else missed
            x += [seed, seed, np.nan]
            y += [factor * low, factor * high, np.nan]
        items = [
            Line(*good, f"holds the truth: {held(found, name)} of {seeds}", BLUE),
            Level(factor * TRUTH[name], "truth", INK, "dash"),
        ]
        if missed[0]:
            items.insert(1, Line(*missed, "misses it", ORANGE, width=2.4))
        panels.append(Panel(name, "seed", f"95 % interval [{unit}]", items, x_range=(-1.0, seeds)))
    caption = (
        f"Twelve synthetic mean forces with normal noise of {NOISE:g} N, fitted for three parameters, with "
        f"{seeds} seeds. Of 95 % intervals, about 95 in 100 should hold the truth."
    )
    return Figure("recovery", "Known parameters, recovered from noisy data", caption, panels, 3, (15.0, 4.6))
