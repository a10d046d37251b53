"""Does an identification recover what made the data? Synthetic noisy measurements, fitted again and again."""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from matplotlib.axes import Axes

from frictioncontact.errors import quiet
from frictioncontact.fmu import FrictionFmu
from frictioncontact.identification.data import Measurements, Uncertain
from frictioncontact.identification.experiment import Experiment, Rows
from frictioncontact.identification.fit import with_profiles
from frictioncontact.identification.parameter import Parameter, parameter
from frictioncontact.identification.result import Fit
from frictioncontact.identification.search import search
from frictioncontact.style import BLACK, BLUE, ORANGE
from workshop.report.figure import Figure, Level, Panel

TRUTH = {"contact.stiffnessScale": 6e-7, "vibration.phase_d": 2.2, "F_C": 48.0}
UNITS = ("1e-7", "deg", "N")
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


@dataclass(frozen=True)
class Recovered:
    """What fits found that knew nothing of the truth, one for each seed."""

    truth: dict[str, float]
    fits: list[Fit]

    def holds(self, name: str) -> list[bool]:
        """Whether the 95 % interval of each seed holds the true value."""
        k = list(self.truth).index(name)
        intervals = [one.profiles[k] for one in self.fits]
        return [low <= self.truth[name] <= high for low, high in intervals]


def from_rows(
    fmu: FrictionFmu, seeds: int, uncertainty: list[float] | None = None, V_1_error: float = 0.0
) -> Recovered:
    """From one noisy set of rows per seed; uncertainty as stated, or None to estimate it from the scatter.

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
    return recovered(experiment, TRUTH, experiment.target, NOISE, seeds)


def recovered(
    experiment: Experiment, truth: dict[str, float], exact: np.ndarray, noise: float, seeds: int
) -> Recovered:
    random = np.array([np.random.default_rng(seed).standard_normal(len(exact)) for seed in range(seeds)])
    random[:, : len(experiment.force)] *= noise
    with quiet():  # the search looks at unlikely values too
        found = [with_profiles(experiment, search(experiment, target)) for target in exact + random]
    return Recovered(truth, found)


def figure(fmu: FrictionFmu, seeds: int) -> Figure:
    """The intervals of every seed against the truth."""
    found = from_rows(fmu, seeds)
    panels = []
    for k, (name, factor, unit) in enumerate(zip(TRUTH, (1e7, np.degrees(1.0), 1.0), UNITS, strict=True)):
        held = np.array(found.holds(name))
        ends = factor * np.array([one.profiles[k] for one in found.fits])

        def bars(
            axes: Axes, which: np.ndarray, label: str, colour: str, width: float, ends: np.ndarray = ends
        ) -> None:
            axes.vlines(np.flatnonzero(which), *ends[which].T, color=colour, lw=width, label=label)

        label = f"contains the truth: {sum(held)} of {seeds}"
        items = [partial(bars, which=held, label=label, colour=BLUE, width=1.8)]
        if not all(held):
            items.append(partial(bars, which=~held, label="misses it", colour=ORANGE, width=2.4))
        items.append(Level(factor * TRUTH[name], "truth", BLACK))
        look = {"xlim": (-1.0, seeds), "xticks": range(0, seeds, 5)}
        panels.append(Panel(name, "seed", f"95 % interval [{unit}]", items, look))
    caption = (
        f"Twelve synthetic mean forces with normal noise of {NOISE:g} N, fitted for three parameters, with "
        f"{seeds} seeds. Of 95 % intervals, about 95 in 100 should contain the truth."
    )
    return Figure("recovery", "Known parameters, recovered from noisy data", caption, panels, 3, (15.0, 4.6))
