"""Figures 2-6 and 8-13 of the paper from the FMU, with Eq. 23 or 25 beside it where the paper used them.

The paper's axes are not stated in its text, so times are chosen to show what each figure is about. Each
scene is drawn at the printed parameters (sigma = 5.743e12 N/m) and at the identified stiffness.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from frictioncontact.fmu import FrictionFmu, simulate
from frictioncontact.gap import area, stiffness
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
from frictioncontact.periodic import periodic_mean, periodic_waves
from frictioncontact.style import BLACK, BLUE, GREEN, GREY, ORANGE
from workshop.figure import Figure, Level, Line, Panel
from workshop.paper.equations import force_eq_23, force_eq_25

A_D = 1.1e-6  # m, amplitude of the separation in the paper's section 3.2
PRINTED_AREA, PRINTED_MEAN_AREA = 1.397e-7, 1.341e-7  # m2, section 3.2
PRINTED_SIGMA, PRINTED_MEAN_SIGMA = 2.326e11, 2.07e11  # N/m, section 3.2 (the print has 2.07e-7)
FROZEN = 5.1  # sigma V t / F_C at which Eq. 23 gives the paper's 48 and 54 N

PAPER, MODEL, MEAN, FORMULA = BLACK, BLUE, BLUE, ORANGE


# Each scene is drawn at both stiffnesses.
STIFFNESSES = {
    "Printed parameters, σ = 5.743e12 N/m": PRINTED,
    "Identified stiffness, σ = 2.537 MN/m": IDENTIFIED,
}


def start(contact: ParameterSet, V: float, V_1: float = 0.0, a_d: float = 0.0) -> dict[str, float]:
    """Row 1 of Table 2 with the stiffness of a set of parameters and a vibration of phase 0."""
    still = start_values(TABLE_2[0], replace(contact, V=V, phase_d=0.0))
    return still | {"vibration.V_1": V_1, "vibration.a_d": a_d}


def _figure(number: int, title: str, caption: str, panels: list[Panel], *layout: Any) -> Figure:
    return Figure(f"fig-{number:02}", f"Figure {number}: {title}", caption, panels, *layout)


def steady(number: int, V: float, fmu: FrictionFmu) -> Figure:
    panels = []
    for name, contact in STIFFNESSES.items():
        relaxation = COULOMB_FORCE / (contact.stiffness * V)
        count = 120
        run = simulate(fmu, start(contact, V), 6.0 * relaxation / count, count, outputs=("F_t",))
        factor, unit = _time_unit(6.0 * relaxation)
        t = run["time"]
        panels.append(
            Panel(
                name,
                f"time from rest [{unit}]",
                "friction force F_t [N]",
                [
                    Line(factor * t, run["F_t"], "FMU", MODEL, width=3.0),
                    Line(
                        factor * t,
                        force_eq_23(COULOMB_FORCE, contact.stiffness, V, t),
                        "Eq. 23",
                        FORMULA,
                        "dotted",
                    ),
                    Level(COULOMB_FORCE, "F_C"),
                ],
                y_range=(0.0, 60.0),
            )
        )
    caption = (
        f"Constant V = {1e3 * V:g} mm/s from rest. Here Eq. 23 is the solution of Eq. 2, and the FMU agrees "
        "with it. At the printed parameters the force saturates within "
        f"{_shown(COULOMB_FORCE / (PRINTED.stiffness * V))}, at the identified stiffness within "
        f"{_shown(COULOMB_FORCE / (IDENTIFIED.stiffness * V))} (F_C / (σ V))."
    )
    return _figure(number, f"constant velocity of {V:g} m/s", caption, panels)


def _time_unit(t: float) -> tuple[float, str]:
    for factor, unit in ((1e3, "ms"), (1e6, "µs"), (1e9, "ns"), (1e12, "ps")):
        if factor * t >= 1.0:
            return factor, unit
    return 1e15, "fs"


def _shown(t: float) -> str:
    factor, unit = _time_unit(t)
    return f"{factor * t:.3g} {unit}"


def vibrating(number: int, V: float, V_1: float, fmu: FrictionFmu) -> Figure:
    panels, means = [], []
    samples, periods = 200, 3
    for name, contact in STIFFNESSES.items():
        values = start(contact, V, V_1)
        run = simulate(fmu, values, PERIOD / samples, periods * samples, outputs=("F_t",))
        mean = periodic_mean(fmu, values)
        means.append(mean)
        t = run["time"]
        formula = force_eq_25(COULOMB_FORCE, contact.stiffness, V, V_1, FREQUENCY, t)
        panels.append(
            Panel(
                name,
                "time from rest [µs]",
                "friction force F_t [N]",
                [
                    Line(1e6 * t, run["F_t"], "FMU", MODEL, width=2.4),
                    Line(1e6 * t, formula, "Eq. 25", FORMULA, "dashed", 1.4),
                    Level(mean, f"FMU, periodic mean {mean:.3g} N", MEAN, "dotted"),
                ],
                y_range=(-62.0, 62.0),
            )
        )
    caption = (
        f"V = {1e3 * V:g} mm/s, V_1 = {V_1:g} m/s, 20 kHz, d and E constant. Mean friction in the periodic "
        f"state: {means[0]:.4g} N at the printed parameters, {means[1]:.4g} N at the identified stiffness. "
        "Eq. 25 puts V(t) into the solution for constant V: it falls to zero at every reversal, whatever "
        "the bristle does, and drifts toward Coulomb friction as its factor t grows. In the stiff contact "
        "the two can't be told apart by eye."
    )
    return _figure(number, f"velocity {V:g} m/s with a vibration of {V_1:g} m/s", caption, panels)


def figure_8(fmu: FrictionFmu) -> Figure:
    gaps, of_fmu = _against_gap(fmu, "A_r")
    at = float(np.interp(SEPARATION, gaps, of_fmu))
    gaussian = [1e6 * area(Surfaces(), d, model="gaussian") for d in gaps]
    lines = _gap_lines(gaps, 1e6 * of_fmu, "FMU (Eq. 20–22, corrected)", gaussian, 1e6 * PRINTED_AREA)
    caption = (
        f"The FMU's area at 14 µm is {1e6 * at:.4f} mm² (5.188e-7 m²); the paper prints 1.397e-7 m², which "
        "follows from no variant of its equations. The dashed line is the Gaussian for which Eq. 17 stands "
        "in."
    )
    panel = Panel("Real contact area", "separation d [µm]", "A_r [mm²]", lines, y_log=True)
    return _figure(8, "contact area against separation", caption, [panel], 1, (6.0, 4.4))


def figure_10(fmu: FrictionFmu) -> Figure:
    gaps, of_fmu = _against_gap(fmu, "sigma")
    gaussian = [stiffness(Surfaces(), d, model="gaussian") for d in gaps]
    lines = _gap_lines(gaps, of_fmu, "FMU (Eq. 3)", gaussian, PRINTED_SIGMA)
    caption = (
        "The paper prints σ(14 µm) = 2.326e11 N/m, which is E A_r² / d³ with its own A_r and d = 17 µm. "
        "With 14 µm and the area of Eq. 20–22 it is 5.743e12 N/m. A micrometre changes σ by a factor of "
        "3.3."
    )
    panel = Panel("Tangential stiffness", "separation d [µm]", "σ [N/m]", lines, y_log=True)
    return _figure(10, "contact stiffness against separation", caption, [panel], 1, (6.0, 4.4))


def _against_gap(fmu: FrictionFmu, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Separations [m] and a variable of the FMU at each."""
    gaps, values = np.linspace(10e-6, 20e-6, 101), []
    with fmu.session() as session:
        for d in gaps:
            session.set("d", d)
            session.step(0.0)
            values.append(session.get(name))
    return gaps, np.array(values)


def _gap_lines(
    gaps: np.ndarray, of_fmu: np.ndarray, name: str, gaussian: list[float], printed: float
) -> list[Line]:
    return [
        Line(1e6 * gaps, of_fmu, name, MODEL, width=2.4),
        Line(1e6 * gaps, gaussian, "Gaussian heights", GREEN, "dashed"),
        Line([14.0], [printed], "paper, as printed", PAPER, markers=True),
    ]


def over_time(number: int, name: str, symbol: str, words: str, printed: float, fmu: FrictionFmu) -> Figure:
    """Over its value at 14 um, since the paper's absolute values are off; printed is the paper's mean so."""
    run = periodic_waves(fmu, start(PRINTED, 0.005, a_d=A_D), (name,))
    with fmu.session(start(PRINTED, 0.005)) as session:
        still = session.get(name)
    mean = float(np.mean(run[name][:-1])) / still
    change, printed_change = 100.0 * (mean - 1.0), 100.0 * (printed - 1.0)
    items = [
        Line(1e6 * run["time"], run[name] / still, "FMU", MODEL, width=2.4),
        Level(mean, f"FMU, mean ({change:+.1f} %)", MEAN, "dashed"),
        Level(1.0, "without vibration", GREY, "dotted"),
        Level(printed, f"paper, mean (−{-printed_change:.0f} %)", PAPER, "dashed"),
    ]
    caption = (
        f"d = 14 µm ± 1.1 µm at 20 kHz. The {words} is convex in d, so by Jensen's inequality its mean over "
        f"a symmetric oscillation rises: {change:+.2f} %. The paper has it fall by {-printed_change:.0f} %."
    )
    panel = Panel(f"Oscillating {words}", "time [µs]", f"{symbol} over its value at 14 µm", items)
    return _figure(number, f"{words} over time", caption, [panel], 1, (6.4, 4.6))


def frozen_time() -> float:
    """The time at which sigma V t / F_C = 5.1 for V = 5 mm/s and the printed stiffness [s]."""
    return FROZEN * COULOMB_FORCE / (PRINTED.stiffness * PRINTED.V)


def figure_12(fmu: FrictionFmu) -> Figure:
    """F against d: at one instant of Eq. 23, as the paper may have drawn it, and while d moves."""
    gaps = np.linspace(12.0e-6, 16.5e-6, 46)
    t = frozen_time()
    surfaces = Surfaces()
    of_fmu = []
    for d in gaps:
        with fmu.session(start(PRINTED, PRINTED.V) | {"d": d}) as session:
            session.step(t)
            of_fmu.append(session.get("F_t"))
    formula = [float(force_eq_23(COULOMB_FORCE, stiffness(surfaces, d), PRINTED.V, t)) for d in gaps]
    loop = periodic_waves(fmu, start(IDENTIFIED, 0.5, a_d=A_D), ("F_t",), periods=1)
    d_loop = SEPARATION + A_D * np.cos(2.0 * math.pi * FREQUENCY * loop["time"])
    panels = [
        Panel(
            f"From rest, after {1e9 * t:.2f} ns",
            "separation d [µm]",
            "friction force F_t [N]",
            [
                Line(1e6 * gaps, formula, "Eq. 23", FORMULA, "dashed"),
                Line(1e6 * gaps, of_fmu, "FMU, d constant", MODEL, markers=True),
                Level(COULOMB_FORCE, "FMU, d constant, later"),
            ],
        ),
        Panel(
            "Separation moving, periodic state",
            "separation d [µm]",
            "friction force F_t [N]",
            [
                Line(1e6 * d_loop, loop["F_t"], "FMU, identified stiffness, V = 0.5 m/s", MODEL, width=2.4),
                Level(COULOMB_FORCE, "F_C, and the mean over the cycle"),
            ],
        ),
    ]
    caption = (
        "Left: the friction force depends on d only on the way to saturation, here at the instant σ V t / "
        "F_C = 5.1 of d = 14 µm. Once the contact slides it is F_C at every constant d. Right: while d "
        "moves, the deflection lags and the force goes around a loop, beyond F_C on one side and below it "
        "on the other."
    )
    return _figure(12, "friction force against separation", caption, panels)


def figure_13(fmu: FrictionFmu) -> Figure:
    run = periodic_waves(fmu, start(PRINTED, PRINTED.V, a_d=A_D), ("F_t", "sigma"))
    formula = force_eq_23(COULOMB_FORCE, run["sigma"], PRINTED.V, frozen_time())
    middle = 0.5 * float(formula.max() + formula.min())
    soft = periodic_waves(fmu, start(IDENTIFIED, 0.5, a_d=A_D), ("F_t",))
    mean = periodic_mean(fmu, start(IDENTIFIED, 0.5, a_d=A_D))
    panels = [
        Panel(
            "Printed parameters, V = 5 mm/s",
            "time [µs]",
            "friction force F_t [N]",
            [
                Line(1e6 * run["time"], run["F_t"], "FMU", MODEL, width=2.4),
                Line(1e6 * run["time"], formula, "Eq. 23 at σ V t / F_C = 5.1", FORMULA, "dashed"),
                Level(middle, f"its (max + min) / 2: {middle:.2f} N", FORMULA, "dotted"),
                Level(48.0, "paper's mean: 48 N", PAPER, "dotted"),
            ],
        ),
        Panel(
            "Identified stiffness, V = 0.5 m/s",
            "time [µs]",
            "friction force F_t [N]",
            [
                Line(1e6 * soft["time"], soft["F_t"], "FMU", MODEL, width=2.4),
                Level(mean, f"FMU, mean {mean:.3f} N", MEAN, "dotted"),
                Level(48.0, "paper's mean: 48 N", PAPER, "dotted"),
            ],
        ),
    ]
    caption = (
        "V constant, d = 14 µm ± 1.1 µm. In a periodic state the integral of V (1 − F / F_C) vanishes, so "
        "with V constant and positive the mean is exactly F_C = 55 N whatever σ does. The paper's 48 N "
        "comes out of Eq. 23 with d(t) put in at one frozen instant, and of (max + min) / 2 instead of a "
        "mean."
    )
    return _figure(13, "friction force over time with moving separation", caption, panels)


FIGURES: tuple[Callable[[FrictionFmu], Figure], ...] = (
    partial(steady, 2, 0.005),
    partial(steady, 3, 0.5),
    partial(vibrating, 4, 0.5, 1.4),
    partial(vibrating, 5, 0.005, 1.4),
    partial(vibrating, 6, 0.005, 14.5),
    figure_8,
    partial(over_time, 9, "A_r", "A_r", "contact area", PRINTED_MEAN_AREA / PRINTED_AREA),
    figure_10,
    partial(over_time, 11, "sigma", "σ", "contact stiffness", PRINTED_MEAN_SIGMA / PRINTED_SIGMA),
    figure_12,
    figure_13,
)
