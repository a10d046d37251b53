"""Does an identification recover what made the data? Synthetic noisy measurements, fitted again and again."""

from functools import partial

import numpy as np
from matplotlib.axes import Axes

from figures.report.figure import Figure, Level, Panel
from frictioncontact.errors import quiet
from frictioncontact.fmu import FrictionFmu
from frictioncontact.identification.data import Measurements
from frictioncontact.identification.experiment import Rows, parameter
from frictioncontact.identification.fit import search, with_profiles
from frictioncontact.style import BLACK, BLUE, ORANGE

TRUTH = {  # with the factor to the unit of its axis
    "contact.stiffnessScale": (6e-7, 1e7, "1e-7"),
    "vibration.phase_d": (2.2, np.degrees(1.0), "deg"),
    "F_C": (48.0, 1.0, "N"),
}
NOISE = 0.5  # N, standard deviation of one mean
CONDITIONS = [  # as a person would measure them: some with, some without normal vibration
    {"V": V, "vibration.V_1": V_1, "vibration.a_d": a_d}
    for V in (0.2, 0.6)
    for V_1 in (0.5, 1.0, 1.5)
    for a_d in (0.0, 1e-6)
]


def intervals(fmu: FrictionFmu, seeds: int) -> np.ndarray:
    """95 % intervals from one noisy set of rows a seed, [parameter, seed, end], by fits that know nothing."""
    unknown = [parameter(fmu, name, None, None, {}) for name in TRUTH]

    def rows(force: np.ndarray) -> Rows:
        return Rows(fmu, Measurements(tuple(CONDITIONS[0]), CONDITIONS, list(force), None), unknown)

    truth = [each.to_coordinate(TRUTH[each.name][0]) for each in unknown]
    experiment = rows(rows(np.zeros(len(CONDITIONS))).means(truth))
    noise = [np.random.default_rng(seed).standard_normal(len(CONDITIONS)) for seed in range(seeds)]
    targets = experiment.target + NOISE * np.array(noise)
    with quiet():  # the search looks at unlikely values too
        found = [with_profiles(experiment, search(experiment, target)) for target in targets]
    return np.transpose([one.profiles for one in found], (1, 0, 2))


def figure(fmu: FrictionFmu, seeds: int) -> Figure:
    """The intervals of every seed against the truth."""

    def bars(axes: Axes, ends: np.ndarray, which: np.ndarray, label: str, colour: str, width: float) -> None:
        axes.vlines(np.flatnonzero(which), *ends[which].T, color=colour, lw=width, label=label)

    panels = []
    for (name, (true, factor, unit)), found in zip(TRUTH.items(), intervals(fmu, seeds), strict=True):
        held = (found[:, 0] <= true) & (true <= found[:, 1])
        of = partial(bars, ends=factor * found)
        label = f"contains the truth: {sum(held)} of {seeds}"
        items = [partial(of, which=held, label=label, colour=BLUE, width=1.8)]
        if not all(held):
            items.append(partial(of, which=~held, label="misses it", colour=ORANGE, width=2.4))
        items.append(Level(factor * true, "truth", BLACK))
        look = {"xlim": (-1.0, seeds), "xticks": range(0, seeds, 5)}
        panels.append(Panel(name, "seed", f"95 % interval [{unit}]", items, look))
    caption = (
        f"Twelve synthetic mean forces with normal noise of {NOISE:g} N, fitted for three parameters, with "
        f"{seeds} seeds. Of 95 % intervals, about 95 in 100 should contain the truth."
    )
    return Figure("recovery", "Known parameters, recovered from noisy data", caption, panels, 3, (15.0, 4.6))
