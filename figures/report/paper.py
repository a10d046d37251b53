"""Figures 2-6 and 8-13 of the paper and its claims from the FMU, beside Eq. 23 and 25.

The paper's axes are not stated in its text, so times are chosen to show what each figure is about. Each
scene is drawn at the printed parameters (sigma = 5.743e12 N/m) and at the identified stiffness.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import EngFormatter

from figures.figure import Figure, Level, Line, Panel
from frictioncontact.fmu import FrictionFmu, simulate
from frictioncontact.gap import area, gaussian, stiffness
from frictioncontact.parameters import (
    COULOMB_FORCE,
    FREQUENCY,
    IDENTIFIED,
    PERIOD,
    PRINTED,
    SEPARATION,
    TABLE_2,
    ParameterSet,
    Surfaces,
    start_values,
)
from frictioncontact.periodic import periodic_mean, periodic_waves, reduction
from frictioncontact.style import BLACK, BLUE, GREEN, GREY, ORANGE
from frictioncontact.table2 import mean_force

A_D = 1.1e-6  # m, amplitude of the separation in the paper's section 3.2
PRINTED_VALUES = {  # of section 3.2: at 14 um, and in the mean (the print has 2.07e-7 for the last)
    "A_r": (1.397e-7, 1.341e-7),  # m2
    "sigma": (2.326e11, 2.07e11),  # N/m
}
FROZEN_TIME = 5.1 * COULOMB_FORCE / (PRINTED.stiffness * PRINTED.V)  # s, at which Eq. 23 gives 48 and 54 N
PAPER, MODEL, FORMULA = BLACK, BLUE, ORANGE
STIFFNESSES = {  # each scene is drawn at both
    "Printed parameters, σ = 5.743e12 N/m": PRINTED,
    "Identified stiffness, σ = 2.537 MN/m": IDENTIFIED,
}
FORCE, GAP, TIME = "friction force F_t [N]", "separation d [µm]", "time [µs]"


def force_eq_23(F_C: float, sigma: Any, V: Any, t: Any) -> np.ndarray:
    """F_t [N] of Eq. 23: Eq. 2 solved from rest for constant V and sigma; with V(t) put in, Eq. 25."""
    return F_C * np.sign(V) * -np.expm1(-np.asarray(sigma) * np.abs(V) * t / F_C)


def force_eq_25(F_C: float, sigma: Any, V_2: float, V_1: float, f: float, t: np.ndarray) -> np.ndarray:
    return force_eq_23(F_C, sigma, V_2 + V_1 * np.cos(2.0 * math.pi * f * t), t)


def start(contact: ParameterSet, V: float, V_1: float = 0.0, a_d: float = 0.0) -> dict[str, float]:
    """Row 1 of Table 2 with the stiffness of a set of parameters and a vibration of phase 0."""
    still = start_values(TABLE_2[0], replace(contact, V=V, phase_d=0.0))
    return still | {"vibration.V_1": V_1, "vibration.a_d": a_d}


def figure(number: int, title: str, caption: str, panels: Sequence[Panel], *layout: Any) -> Figure:
    return Figure(f"fig-{number:02}", f"Figure {number}: {title}", caption, panels, *layout)


def steady(number: int, V: float, fmu: FrictionFmu) -> Figure:
    def in_seconds(axes: Axes) -> None:
        axes.xaxis.set_major_formatter(EngFormatter("s"))

    panels, times = [], []
    for name, contact in STIFFNESSES.items():
        relaxation = COULOMB_FORCE / (contact.stiffness * V)
        times.append(EngFormatter("s", places=1)(relaxation))
        run = simulate(fmu, start(contact, V), relaxation / 20, 120, outputs=("F_t",))
        t = run["time"]
        items = [
            Line(t, run["F_t"], "FMU", MODEL, width=3.0),
            Line(t, force_eq_23(COULOMB_FORCE, contact.stiffness, V, t), "Eq. 23", FORMULA, ":"),
            Level(COULOMB_FORCE, "F_C"),
            in_seconds,
        ]
        panels.append(Panel(name, "time from rest", FORCE, items, {"ylim": (0.0, 60.0)}))
    caption = (
        f"Constant V = {1e3 * V:g} mm/s from rest. Here Eq. 23 is the solution of Eq. 2, and the FMU agrees "
        f"with it. At the printed parameters the force saturates within {times[0]}, at the identified "
        f"stiffness within {times[1]} (F_C / (σ V))."
    )
    return figure(number, f"constant velocity of {V:g} m/s", caption, panels)


def vibrating(number: int, V: float, V_1: float, fmu: FrictionFmu) -> Figure:
    panels, means = [], []
    for name, contact in STIFFNESSES.items():
        values = start(contact, V, V_1)
        run = simulate(fmu, values, PERIOD / 200, 600, outputs=("F_t",))
        means.append(periodic_mean(fmu, values))
        t = run["time"]
        formula = force_eq_25(COULOMB_FORCE, contact.stiffness, V, V_1, FREQUENCY, t)
        items = [
            Line(1e6 * t, run["F_t"], "FMU", MODEL, width=2.4),
            Line(1e6 * t, formula, "Eq. 25", FORMULA, "--", 1.4),
            Level(means[-1], f"FMU, periodic mean {means[-1]:.3g} N", MODEL, ":"),
        ]
        panels.append(Panel(name, "time from rest [µs]", FORCE, items, {"ylim": (-62.0, 62.0)}))
    caption = (
        f"V = {1e3 * V:g} mm/s, V_1 = {V_1:g} m/s, 20 kHz, d and E constant. Mean friction in the periodic "
        f"state: {means[0]:.4g} N at the printed parameters, {means[1]:.4g} N at the identified stiffness. "
        "Eq. 25 puts V(t) into the solution for constant V: it falls to zero at every reversal, whatever "
        "the bristle does, and drifts toward Coulomb friction as its factor t grows."
    )
    return figure(number, f"velocity {V:g} m/s with a vibration of {V_1:g} m/s", caption, panels)


def against_gap(number: int, fmu: FrictionFmu) -> Figure:
    """The area (Figure 8) or the stiffness (10) over the separation, beside Gaussian heights."""
    name, of_heights, scale, words, y = {
        8: ("A_r", area, 1e6, "contact area", "A_r [mm²]"),
        10: ("sigma", stiffness, 1.0, "contact stiffness", "σ [N/m]"),
    }[number]
    gaps, of_fmu = np.linspace(10e-6, 20e-6, 101), []
    with fmu.session() as session:
        for d in gaps:
            session.set("d", d)
            session.step(0.0)
            of_fmu.append(scale * session.get(name))
    by_gaussian = [scale * of_heights(Surfaces(), d, model="gaussian") for d in gaps]
    items = [
        Line(1e6 * gaps, of_fmu, "FMU (Eq. 3; 20–22, corrected)", MODEL, width=2.4),
        Line(1e6 * gaps, by_gaussian, "Gaussian heights", GREEN, "--"),
        Line([14.0], [scale * PRINTED_VALUES[name][0]], "paper, as printed", PAPER, "o"),
    ]
    caption = {
        8: "The FMU's area at 14 µm is 0.5188 mm²; the paper prints 0.1397 mm², which follows from no "
        "variant of its equations. The dashed line is the Gaussian for which Eq. 17 stands in.",
        10: "The paper prints σ(14 µm) = 2.326e11 N/m, which is E A_r² / d³ with its own A_r and d = 17 µm. "
        "With 14 µm and the area of Eq. 20–22 it is 5.743e12 N/m. A micrometre changes σ by a factor of 3.3.",
    }[number]
    panel = Panel(words.capitalize(), GAP, y, items, {"yscale": "log"})
    return figure(number, f"{words} against separation", caption, [panel], 1, (6.0, 4.4))


def mean_change(fmu: FrictionFmu, name: str) -> tuple[dict[str, np.ndarray], float, float]:
    """A run with the paper's oscillation of d, the value at 14 um, and the change of the mean in percent."""
    run = periodic_waves(fmu, start(PRINTED, PRINTED.V, a_d=A_D), (name,))
    with fmu.session(start(PRINTED, PRINTED.V)) as session:
        still = session.get(name)
    return run, still, float(100.0 * (np.mean(run[name][:-1]) / still - 1.0))


def over_time(number: int, name: str, symbol: str, words: str, fmu: FrictionFmu) -> Figure:
    """Over its value at 14 um, since the paper's absolute values are off."""
    run, still, change = mean_change(fmu, name)
    printed = printed_change(name)
    items = [
        Line(1e6 * run["time"], run[name] / still, "FMU", MODEL, width=2.4),
        Level(1.0 + change / 100.0, f"FMU, mean ({change:+.1f} %)", MODEL),
        Level(1.0, "without vibration", GREY, ":"),
        Level(1.0 + printed / 100.0, f"paper, mean (−{-printed:.0f} %)", PAPER),
    ]
    caption = (
        f"d = 14 µm ± 1.1 µm at 20 kHz. The {words} is convex in d, so by Jensen's inequality its mean over "
        f"a symmetric oscillation rises: {change:+.2f} %. The paper has it fall by {-printed:.0f} %."
    )
    panel = Panel(f"Oscillating {words}", TIME, f"{symbol} over its value at 14 µm", items)
    return figure(number, f"{words} over time", caption, [panel], 1, (6.4, 4.6))


def printed_change(name: str) -> float:
    """Of the mean, in percent."""
    at_rest, printed_mean = PRINTED_VALUES[name]
    return 100.0 * (printed_mean / at_rest - 1.0)


def figure_12(fmu: FrictionFmu) -> Figure:
    """F against d: at one instant of Eq. 23, as the paper may have drawn it, and while d moves."""
    gaps, of_fmu = np.linspace(12.0e-6, 16.5e-6, 46), []
    for d in gaps:
        with fmu.session(start(PRINTED, PRINTED.V) | {"d": d}) as session:
            session.step(FROZEN_TIME)
            of_fmu.append(session.get("F_t"))
    sigmas = [stiffness(Surfaces(), d) for d in gaps]
    formula = force_eq_23(COULOMB_FORCE, sigmas, PRINTED.V, FROZEN_TIME)
    loop = periodic_waves(fmu, start(IDENTIFIED, 0.5, a_d=A_D), ("F_t",), periods=1)
    d_loop = SEPARATION + A_D * np.cos(2.0 * math.pi * FREQUENCY * loop["time"])
    at_rest = [
        Line(1e6 * gaps, formula, "Eq. 23", FORMULA, "--"),
        Line(1e6 * gaps, of_fmu, "FMU, d constant", MODEL, "o"),
        Level(COULOMB_FORCE, "FMU, d constant, later"),
    ]
    moving = [
        Line(1e6 * d_loop, loop["F_t"], "FMU, identified stiffness, V = 0.5 m/s", MODEL, width=2.4),
        Level(COULOMB_FORCE, "F_C, and the mean over the cycle"),
    ]
    panels = [
        Panel(f"From rest, after {1e9 * FROZEN_TIME:.2f} ns", GAP, FORCE, at_rest),
        Panel("Separation moving, periodic state", GAP, FORCE, moving),
    ]
    caption = (
        "Left: the friction force depends on d only on the way to saturation, here at the instant σ V t / "
        "F_C = 5.1 of d = 14 µm. Right: while d moves, the deflection lags and the force goes around a loop."
    )
    return figure(12, "friction force against separation", caption, panels)


def figure_13(fmu: FrictionFmu) -> Figure:
    run = periodic_waves(fmu, start(PRINTED, PRINTED.V, a_d=A_D), ("F_t", "sigma"))
    formula = force_eq_23(COULOMB_FORCE, run["sigma"], PRINTED.V, FROZEN_TIME)
    middle = 0.5 * float(formula.max() + formula.min())
    soft = periodic_waves(fmu, start(IDENTIFIED, 0.5, a_d=A_D), ("F_t",))
    mean = periodic_mean(fmu, start(IDENTIFIED, 0.5, a_d=A_D))
    paper = Level(48.0, "paper's mean: 48 N", PAPER, ":")
    stiff = [
        Line(1e6 * run["time"], run["F_t"], "FMU", MODEL, width=2.4),
        Line(1e6 * run["time"], formula, "Eq. 23 at σ V t / F_C = 5.1", FORMULA, "--"),
        Level(middle, f"its (max + min) / 2: {middle:.2f} N", FORMULA, ":"),
        paper,
    ]
    identified = [
        Line(1e6 * soft["time"], soft["F_t"], "FMU", MODEL, width=2.4),
        Level(mean, f"FMU, mean {mean:.3f} N", MODEL, ":"),
        paper,
    ]
    panels = [
        Panel("Printed parameters, V = 5 mm/s", TIME, FORCE, stiff),
        Panel("Identified stiffness, V = 0.5 m/s", TIME, FORCE, identified),
    ]
    caption = (
        "V constant, d = 14 µm ± 1.1 µm. In a periodic state the integral of V (1 − F / F_C) vanishes, so "
        "with V constant and positive the mean is exactly F_C = 55 N whatever σ does. The paper's 48 N "
        "comes out of Eq. 23 at one frozen instant, and of (max + min) / 2 instead of a mean."
    )
    return figure(13, "friction force over time with moving separation", caption, panels)


FIGURES: tuple[Callable[[FrictionFmu], Figure], ...] = (
    partial(steady, 2, 0.005),
    partial(steady, 3, 0.5),
    partial(vibrating, 4, 0.5, 1.4),
    partial(vibrating, 5, 0.005, 1.4),
    partial(vibrating, 6, 0.005, 14.5),
    partial(against_gap, 8),
    partial(over_time, 9, "A_r", "A_r", "contact area"),
    partial(against_gap, 10),
    partial(over_time, 11, "sigma", "σ", "contact stiffness"),
    figure_12,
    figure_13,
)


def claims(fmu: FrictionFmu) -> list[tuple[str, float, float, float | None, str]]:
    """What the abstract states: words, percent as printed, exact, identified (if it matters), why."""
    exact, identified = (
        [-reduction(mean_force(fmu, row, found), mean_force(fmu, TABLE_2[0], found)) for row in TABLE_2]
        for found in (PRINTED, IDENTIFIED)
    )
    constant_V = "V is constant and positive, so the periodic mean is F_C whatever σ does"
    slow = "at V / V_1 = 0.0035"
    rows = {  # of Table 2: percent as printed, words, why
        2: (-62.0, "all effects together", f"{slow} hardly any is left; 62 % needs another V and σ"),
        3: (-51.0, "velocity oscillation", f"{slow} no σ gives −51 %: from −99.45 % (soft) to −99.78 %"),
        4: (-12.0, "moving separation and contact area", constant_V),
        5: (-1.0, "Young's modulus", constant_V),
    }
    forces = [
        (f"friction, {words} (Table 2, row {k})", printed, float(exact[k - 1]), float(identified[k - 1]), why)
        for k, (printed, words, why) in rows.items()
    ]
    convex = "convex in d: the mean over a symmetric oscillation rises (Jensen)"
    return forces + [
        (f"mean {words} under d = 14 ± 1.1 µm", printed_change(name), mean_change(fmu, name)[2], None, convex)
        for name, words in (("A_r", "contact area"), ("sigma", "contact stiffness"))
    ]


# Height statistics: what the exponential density costs.

MODELS = {
    "exponential": ("exponential, elastic-plastic (the FMU)", BLUE, "-"),
    "gaussian": ("Gaussian, elastic-plastic (Chang-Etsion-Bogy)", GREEN, "--"),
    "elastic": ("Gaussian, elastic (Greenwood-Williamson)", ORANGE, ":"),
}
HEIGHTS = """\
The exponential stands in for the upper tail of a Gaussian. At the paper's d / R_q = 2.33 it gives 0.52 of the
Gaussian's area and 0.27 of its stiffness; the area is within a factor of 2 for d / R_q from 0.55 to 4.1, and
useless near zero. Nearly all touching asperities yield here, which doubles the elastic area."""


def heights() -> Figure:
    """Density, contact area and its error over d / R_q."""
    surfaces = Surfaces()
    h, s = np.linspace(0.25, 4.5, 61), np.linspace(0.0, 4.5, 61)
    by_model = {m: np.array([area(surfaces, x * surfaces.R_q, model=m) for x in h]) for m in MODELS}
    density = [
        Line(s, surfaces.c * np.exp(-surfaces.lambda_ * s), "17 e^(−3s), Eq. 17", BLUE),
        Line(s, [gaussian(x) for x in s], "Gaussian", GREEN, "--"),
    ]
    areas = [Line(h, by_model[m] / surfaces.A_n, *look, 2.2) for m, look in MODELS.items()]
    ratio = by_model["exponential"] / by_model["gaussian"]
    printed = area(surfaces, SEPARATION) / area(surfaces, SEPARATION, model="gaussian")
    errors = [
        Line(h, ratio, "area A_r", BLUE, width=2.4),
        Line(h, ratio**2, "stiffness σ = E A_r² / d³", ORANGE, "--"),
        Level(1.0, "exact", GREY, ":"),
        Line([SEPARATION / surfaces.R_q], [printed], "14 µm of the paper", BLACK, "o"),
    ]
    separation, log = "separation d / R_q", {"yscale": "log"}
    panels = [
        Panel("Height density", "height s = z / R_q", "density", density, log | {"ylim": (1e-5, 30.0)}),
        Panel("Real contact area", separation, "A_r / A_n", areas, log),
        Panel("Exponential over Gaussian", separation, "ratio", errors, log | {"ylim": (0.05, 20.0)}),
    ]
    return Figure("heights", "Error of the exponential height density", HEIGHTS, panels, 3, (14.0, 4.8))
