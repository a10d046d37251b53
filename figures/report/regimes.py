"""Mean friction over the regimes, from the FMU: its sensitivities, its closed-form limits, and their figures.

Three numbers say where a vibrating contact is:

    kappa = sigma V_1 / (2 pi f F_C)   how often the bristle saturates in one swing: stiff above 1, soft below
    zeta  = V / V_1                    sliding against vibration; without reversals (zeta > 1) the mean is F_C
    alpha = a_d / R_q                  how much the separation moves
"""

import math
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap

from figures.figure import Figure, Line, Panel, text
from frictioncontact.batch import simulate_many
from frictioncontact.parameters import (
    COULOMB_FORCE,
    E_FULL,
    FREQUENCY,
    IDENTIFIED,
    PRINTED,
    SEPARATION,
    STIFFNESS_PRINTED,
    TABLE_2,
    Surfaces,
)
from frictioncontact.style import AMBER, BLACK, BLUE, GREEN, ORANGE, PINK, RED, SKY
from tools.validate.measurements import sliding

Numbers = float | np.ndarray
Scenes = Mapping[str, Numbers]  # start values
R_Q = Surfaces.R_q
TO_STIFFNESS = 2.0 * math.pi * FREQUENCY * COULOMB_FORCE  # kappa times this over V_1 is sigma
STEP = 1e-3  # of the central differences, relative or in rad
NAMES = ("V", "vibration.V_1", "F_C", "vibration.a_d", "vibration.phase_d", "E", "d")
SYMBOLS = {name: name.removeprefix("vibration.").replace("phase_d", "phase") for name in NAMES}
REGIMES = {
    "Coulomb": SKY,
    "Dahl, constant stiffness": GREEN,
    "Dahl, moving separation": AMBER,
    "mean friction may be negative": PINK,
}
COULOMB, CONSTANT, MOVING, MOTOR = range(4)


def scene(kappa: Numbers, zeta: Numbers, alpha: Numbers = 0.0, phase_d: Numbers = 0.0) -> dict[str, Numbers]:
    """Start values at V_1 = 1 m/s, d = 14 um and the full modulus; arrays broadcast."""
    return {
        "V": zeta,
        "d": SEPARATION,
        "E": E_FULL,
        "F_C": COULOMB_FORCE,
        "contact.stiffnessScale": kappa * TO_STIFFNESS / STIFFNESS_PRINTED,
        "vibration.f": FREQUENCY,
        "vibration.V_1": 1.0,
        "vibration.a_d": alpha * R_Q,
        "vibration.phase_d": phase_d,
    }


def mean(fmu: Path, values: Scenes) -> np.ndarray:
    """Mean forces of settled scenes over 55 N."""
    return simulate_many(values, settled=True, fmu=fmu)["F_t_mean"] / COULOMB_FORCE


def coulomb_limit(values: Scenes) -> np.ndarray:
    """The same for kappa -> infinity, whatever the separation does."""
    zeta = np.minimum(values["V"] / values["vibration.V_1"], 1.0)
    return 2.0 / math.pi * np.arcsin(zeta) * values["F_C"] / COULOMB_FORCE


def soft_limit(values: Scenes) -> np.ndarray:
    """For kappa -> 0: delta stands still at F_C <V> / <sigma |V|>."""
    theta = 2.0 * math.pi * (np.arange(4096) + 0.5) / 4096
    zeta = np.asarray(values["V"] / values["vibration.V_1"])[..., None]
    shift = values["vibration.a_d"] * np.cos(theta + values["vibration.phase_d"])
    sigma = np.exp(-2.0 * Surfaces.lambda_ * shift / R_Q) / (values["d"] + shift) ** 3
    force = np.mean(sigma) * zeta[..., 0] / np.mean(sigma * np.abs(zeta + np.cos(theta)), axis=-1)
    return force * values["F_C"] / COULOMB_FORCE


def sensitivity(of: Callable[[Scenes], np.ndarray], values: Scenes, name: str) -> np.ndarray:
    """d(mean) / d(ln p) over F_C; for the phase per rad. of: a mean, or a limit of it."""
    p = values[name]
    above, below = (p + h if name == "vibration.phase_d" else p * math.exp(h) for h in (STEP, -STEP))
    return (of({**values, name: above}) - of({**values, name: below})) / (2.0 * STEP)


def regime_map(
    fmu: Path, kappas: np.ndarray, zetas: np.ndarray, alpha: float, phases: int = 12
) -> np.ndarray:
    """Which of REGIMES: the simplest model whose mean is within 0.01 F_C at every phase; rows over zeta."""
    angles = 2.0 * math.pi * np.arange(phases if alpha else 1) / phases
    kappas, rows = np.asarray(kappas), np.asarray(zetas)[:, None]
    constant = mean(fmu, scene(kappas, rows))
    moving = mean(fmu, scene(kappas, rows, alpha, angles[:, None, None]))
    coulomb = coulomb_limit(scene(kappas, rows))
    conditions = {
        MOTOR: np.min(moving, axis=0) < -0.01,
        COULOMB: np.max(np.abs(moving - coulomb), axis=0) <= 0.01,
        CONSTANT: np.max(np.abs(moving - constant), axis=0) <= 0.01,
    }
    return np.select(list(conditions.values()), list(conditions), MOVING)


# The figures.

ALPHA, PHASE = 1.1 / 6.0, math.radians(225.0)  # a_d / R_q in the paper, and about the identified phase
KAPPA, ZETA = "κ = σ V_1 / (2π f F_C)", "ζ = V / V_1"
LOG = {"xscale": "log", "yscale": "log"}
DRY_STIFFNESS = 7.76e6  # N/m, of the dry rows in docs/measured-parameters.md


def means(fmu: Path, quick: bool) -> Figure:
    """Mean friction over kappa and zeta without and with normal vibration, and cuts against the limits."""
    n = 17 if quick else 49
    kappas, zetas = np.geomspace(1e-2, 1e4, n), np.geomspace(1e-2, 1.5, n)

    def colours(axes: Axes, z: np.ndarray) -> None:
        axes.grid(visible=False)
        look = {"cmap": "cividis", "shading": "gouraud", "rasterized": True, "vmin": 0.0, "vmax": 1.0}
        axes.figure.colorbar(axes.pcolormesh(kappas, zetas, z, **look), ax=axes, label=text("mean F_t / F_C"))
        levels = (0.0, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8)
        lines = axes.contour(kappas, zetas, z, levels=levels, colors="white", linewidths=0.9)
        axes.clabel(lines, fontsize=7.5, fmt="%g")

    panels = []
    for title, moving in (("d constant", ()), ("a_d / R_q = 0.18, phase 225°", (ALPHA, PHASE))):
        z = mean(fmu, scene(kappas, zetas[:, None], *moving))
        panels.append(Panel(title, KAPPA, ZETA, [lambda axes, z=z: colours(axes, z)], LOG))
    fine = np.linspace(0.005, 1.5, 120)
    cuts = [
        Line(fine, mean(fmu, scene(kappa, fine)), f"FMU, κ = {kappa:g}", colour)
        for kappa, colour in ((0.3, SKY), (1.0, GREEN), (3.0, AMBER), (10.0, PINK))
    ]
    cuts += [
        Line(fine, soft_limit(scene(0.0, fine)), "κ → 0: ζ / mean |ζ + cos|", BLUE, "--"),
        Line(fine, coulomb_limit(scene(0.0, fine)), "κ → ∞: (2/π) asin ζ (Coulomb)", BLACK, "--"),
    ]
    panels.append(Panel("Cuts at d constant", ZETA, "mean F_t / F_C", cuts, {"ylim": (0.0, 1.05)}))
    caption = (
        "Mean friction in the periodic state. Stiff contacts tend to Coulomb's mean, soft ones (κ < 0.1) "
        "to a limit of their own. Inside the line 0 the mean is negative: the vibration drives the sliding. "
        "Beyond ζ = 1 nothing reverses and, with d constant, the mean is F_C."
    )
    return Figure("mean", "Mean friction over the regimes", caption, panels, 3, (15.0, 4.9))


def sensitivity_cuts(fmu: Path, quick: bool) -> Figure:
    """Along kappa at one zeta, against the closed-form limits at both ends."""
    kappas = np.geomspace(1e-3, 1e5, 33 if quick else 97)
    scenes = scene(kappas, 0.3, ALPHA, PHASE)
    panels, all_names = [], list(SYMBOLS)
    for names in (all_names[:3], all_names[3:6], all_names[6:]):
        items = []
        for name, colour in zip(names, (BLUE, ORANGE, GREEN), strict=False):
            values = sensitivity(partial(mean, fmu), scenes, name)
            items.append(Line(kappas, values, f"FMU, to {SYMBOLS[name]}", colour))
            for ends, limit in (([1e-3, 1e-2], soft_limit), ([1e4, 1e5], coulomb_limit)):
                items.append(Line(ends, [sensitivity(limit, scenes, name)] * 2, "", BLACK, "--", 2.4))
        items.append(Line([1.0], [np.nan], "limits in closed form", BLACK, "--", 2.4))
        title = "To " + ", ".join(SYMBOLS[name] for name in names)
        panels.append(Panel(title, KAPPA, "of F_C per 100 % or rad", items, {"xscale": "log"}))
    caption = (
        "Along κ at ζ = 0.3. The dashed ends are the limits: Coulomb's to the right, where only V, V_1, F_C "
        "matter, and the soft one to the left, where the phase matters and the stiffness no more."
    )
    return Figure("sensitivity-cuts", "Sensitivities against their limits", caption, panels, 3, (15.0, 4.9))


def regimes(fmu: Path, quick: bool) -> Figure:
    """Which model is enough, over kappa and zeta, for three amplitudes of the separation."""
    n = 21 if quick else 61
    kappas, zetas = np.geomspace(1e-2, 1e7, n), np.geomspace(1e-3, 1.5, n)
    look = {"cmap": ListedColormap(list(REGIMES.values())), "norm": BoundaryNorm(np.arange(5) - 0.5, 4)}

    def classes(axes: Axes, z: np.ndarray) -> None:
        axes.grid(visible=False)
        axes.pcolormesh(kappas, zetas, z, alpha=0.75, rasterized=True, shading="nearest", **look)
        for name, colour in REGIMES.items():
            axes.plot([], [], "s", color=colour, alpha=0.75, ms=8, label=name)

    V_1, points = TABLE_2[2].V_1, []
    for found, colour in ((PRINTED, BLACK), (IDENTIFIED, ORANGE)):
        kappa, label = found.stiffness * V_1 / TO_STIFFNESS, f"row 3 of Table 2, {found.name}"
        points.append(Line([kappa], [found.V / V_1], label, colour, "o"))
    dry, panels = sliding("dry"), []
    kappa = DRY_STIFFNESS * dry.V_1 / (2.0 * math.pi * dry.f * dry.without)
    measured = Line(kappa, dry.V / dry.V_1, "dry rows, measured", RED, "o")
    amplitudes = {0.0: "d constant", 0.02: "a_d / R_q = 0.02", ALPHA: "a_d / R_q = 0.18 (paper)"}
    for alpha, words in amplitudes.items():
        z = regime_map(fmu, kappas, zetas, alpha, phases=8 if quick else 12)
        shown = points if alpha else [*points, measured]
        panels.append(Panel(words, KAPPA, ZETA, [lambda axes, z=z: classes(axes, z), *shown], LOG))
    caption = (
        "The simplest simplification of Dahl's law whose mean is within 1 % of F_C of Dahl's at every phase "
        "of the separation. Where the mean may be negative, some phase drives the sliding. Marked: row 3 of "
        "Table 2 at the printed parameters (κ = 1.2e6, ζ = 0.0035) and as identified (κ = 0.53, ζ = 0.35), "
        "and the dry rows of Luo 2024, of which Dahl's law itself gives 1/110 to 1/4."
    )
    title = "Dahl's law: which simplification is within 1 % of F_C"
    return Figure("regimes", title, caption, panels, 3, (15.0, 5.6))


def reduction(fmu: Path, quick: bool) -> Figure:
    """Friction reduction over V / V_1 with the limits."""
    zetas = np.geomspace(1e-3, 2.0, 60 if quick else 160)
    curves = [(coulomb_limit(scene(0.0, zetas)), "Coulomb limit, κ → ∞", BLACK, "--")]
    for kappa, colour in ((10.0, AMBER), (3.0, GREEN), (1.0, SKY)):
        curves.append((mean(fmu, scene(kappa, zetas)), f"FMU, κ = {kappa:g}", colour, "-"))
    curves.append((soft_limit(scene(0.0, zetas)), "soft limit, κ → 0", BLUE, "--"))
    items = [Line(zetas, 100.0 * (1.0 - left), *look) for left, *look in curves]
    items.append(Line([0.005 / 1.44], [51.0], "Table 2, row 3, as printed", ORANGE, "o"))
    look = {"xscale": "log", "xlim": (1e-3, 2.0), "ylim": (0.0, 105.0)}
    panel = Panel("Tangential vibration, d constant", "V / V_1", "friction reduction [%]", items, look)
    caption = (
        "With a constant separation every stiffness lies between the two dashed limits. The printed V / V_1 "
        "of Table 2 is 0.0035: there every stiffness gives at least 99.4 %, not 51 %."
    )
    title = "Friction reduction against the velocity ratio"
    return Figure("reduction", title, caption, [panel], 1, (6.4, 5.0))
