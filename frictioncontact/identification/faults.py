"""Faults of an instrument and of a request: what each adds to the forces, and the fit that allows for it."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from typing import Any

import numpy as np
from scipy import stats

from frictioncontact.doubts import BRISTLES, unused
from frictioncontact.errors import FrictionError
from frictioncontact.identification.data import Measurements, Series
from frictioncontact.identification.experiment import Experiment
from frictioncontact.identification.fit import Fit, search
from frictioncontact.identification.judge import CHANCE, misfits, visible

V_1, LAW = "vibration.V_1", "friction.model"
MOST = 0.25  # of the sum of squares, left of a misfit that is mostly explained
TENTH = 0.1  # of the force: a fault that a fit should show
STARTS = 3  # of each remedy
SHOWS = 3.0  # standard deviations of the scatter by which it does

Remedy = tuple[
    str, Experiment
]  # something else that the data may have been made with, in words if it is none
Tried = tuple[str, Experiment, Fit]  # of the instrument


def shapes(experiment: Experiment, result: Fit) -> dict[str, np.ndarray]:
    """What faults would add to the forces [N], to first order: words -> of every row."""
    found = {
        "an offset of the force": np.full(len(result.model), np.abs(experiment.force).max()),
        "a wrong gain of the force": result.model,
        "a drift of the force": experiment.elapsed,
    }
    if experiment.word == "sample":
        found["a force that is late"] = np.gradient(result.model, experiment.time)
    for words, rows in _other_rows(experiment, 0.97).items():
        other = experiment.like(rows, experiment.instrument).forces(result.point[None, :])[0]
        found[words] = np.nan_to_num(other - result.model)
    return found


def hidden(experiment: Experiment, result: Fit, shapes: dict[str, np.ndarray]) -> list[str]:
    """Faults of a tenth of the force that the parameters would make up for."""
    scatter = 1.0 if result.known else np.sqrt(result.variance / result.correlated)
    asked = 1 if "offset" in experiment.instrument else 0
    sizes = {words: np.linalg.norm(visible(experiment, result, each)) for words, each in shapes.items()}
    return [words for words in list(sizes)[asked:2] if TENTH * sizes[words] < SHOWS * scatter]


def remedies(experiment: Experiment, result: Fit) -> list[str]:
    """What explains a fit that failed: each fault that does alone, the best first, or some together.

    Or else what takes most of the misfit away.
    """
    others = _other_rows(experiment, 0.5)
    alone = [(words, experiment.like(rows, experiment.instrument)) for words, rows in others.items()]
    tried = _tried([*_with_one_more(experiment), *alone], result)
    if good := [one for one in tried if not misfits(*one[1:])]:
        return [f"it fits with {_said(*one)}" for one in good]
    best = next((one for one in tried if not one[0]), None)
    while best and (further := _tried(_with_one_more(best[1]), best[2], [best[2].coordinates])):
        best = further[0]
        if not misfits(*best[1:]):
            return [f"it fits with {_said(*best)}"]
    best = min([*tried, *([best] if best else [])], key=lambda one: one[2].squares, default=None)
    if best is None or best[2].squares > MOST * result.squares:
        return []
    return [f"the misfit falls to {np.sqrt(np.mean(best[2].residuals ** 2)):.3g} N rms with {_said(*best)}"]


def _with_one_more(experiment: Experiment) -> list[Remedy]:
    names = ["offset", "drift", *(["delay"] if experiment.word == "sample" else []), "sign"]
    more = [name for name in names if name not in experiment.instrument]
    return [("", experiment.like(experiment.rows, (*experiment.instrument, name))) for name in more]


def _tried(remedies: list[Remedy], than: Fit, starts: Sequence[np.ndarray] = ()) -> list[Tried]:
    """Those that fit better than one coordinate more does by scatter, the best first."""
    found = []
    for words, experiment in remedies:
        if experiment.degrees <= 0:
            continue
        with suppress(FrictionError):
            fit = search(experiment, experiment.target, most=STARTS, given=starts)
            is_new = all(
                abs(fit.squares - one[2].squares) > 1e-6 * fit.squares for one in found
            )  # LuGre as Dahl
            if is_new and than.squares - fit.squares > stats.chi2.isf(CHANCE, 1) * fit.variance:
                found.append((words, experiment, fit))
    return sorted(found, key=lambda one: one[2].squares)


def _other_rows(experiment: Experiment, amplitude: float) -> dict[str, Measurements | Series]:
    """The data with another amplitude of the vibration, and with other laws."""
    rows, known, fitted = experiment.rows, experiment.fmu.known, [p.name for p in experiment.parameters]
    first = rows.constants if isinstance(rows, Series) else rows.conditions[0]
    given: dict[str, Any] = {name: known.numbers(name, value, name) for name, value in first.items()}
    given |= {name: np.array(np.nan) for name in fitted}
    found: dict[str, Measurements | Series] = {}
    if V_1 not in fitted and np.any(rows.column(V_1)):
        words = f"half the stated {V_1}: is that from peak to peak?" if amplitude == 0.5 else f"a wrong {V_1}"
        found[words] = rows.changed(lambda scene: {V_1: amplitude * scene.get(V_1, 0.0)})
    for law in BRISTLES:
        number = known.items[LAW][law]
        idle = set(fitted) & set(unused(known, given | {LAW: np.array(number)}))
        if number != given.get(LAW, 1.0) and not idle:
            found[f"{LAW} = {law}"] = rows.changed(lambda scene, law=law: {LAW: law})
    return found


def described(experiment: Experiment, fit: Fit) -> str:
    """The nuisances of the instrument, with their half-widths of 95 %."""
    per = "s" if experiment.word == "sample" else "row"
    units = {"offset": (1.0, "N"), "drift": (1.0, f"N per {per}"), "delay": (1e3, "ms")}
    said = ["a force of the opposite sign"] if experiment.sign < 0.0 else []
    for name, (value, width) in fit.nuisances.items():
        size, unit = units[name]
        said.append(f"{name} {size * value:+.4g} ± {size * width:.2g} {unit}")
    return ", ".join(said)


def _said(words: str, experiment: Experiment, fit: Fit) -> str:
    """What it is, how to ask for it, and the parameters with it."""
    pairs = zip(fit.parameters, fit.values, strict=True)
    values = ", ".join(f"{p.name} = {value:.4g}{p.after}" for p, value in pairs)
    ask = f"{described(experiment, fit)} (nuisance {', '.join(experiment.instrument)})"
    return f"{words or ask}; then {values}"
