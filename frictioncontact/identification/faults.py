"""Faults of an instrument and of a request: what each adds to the forces, and the fit that allows for it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy import stats

from frictioncontact.doubts import BRISTLES, unused
from frictioncontact.errors import FrictionError
from frictioncontact.identification.data import Measurements, Series
from frictioncontact.identification.experiment import Experiment
from frictioncontact.identification.judge import misfits
from frictioncontact.identification.result import Fit
from frictioncontact.identification.search import search
from frictioncontact.identification.suspicion import CHANCE, visible

V_1 = "vibration.V_1"
MOST = 0.25  # of the sum of squares, left of a misfit that is mostly explained
SHOWS = 3.0  # standard deviations by which a fault's residuals must exceed the scatter to be seen


@dataclass(frozen=True)
class Remedy:
    """Something else that the data may have been made with."""

    words: str
    experiment: Experiment


def shapes(experiment: Experiment, result: Fit) -> dict[str, np.ndarray]:
    """What faults would add to the forces [N], to first order: words -> of every row."""
    model = result.model
    found = {
        "of an offset of the force": np.full(len(model), np.abs(experiment.force).max()),
        "of a drift of the force": experiment.elapsed,
        "of a wrong gain of the force": model,
    }
    if experiment.word == "sample":
        found["of a force that is late"] = np.gradient(model, experiment.time)
    for words, rows in _other_rows(experiment, 0.97).items():
        other = experiment.like(rows, experiment.instrument).forces(result.point[None, :])[0]
        if np.isfinite(other).all():
            found[f"of {words}"] = other - model
    return found


def hidden(experiment: Experiment, result: Fit) -> list[str]:
    """Faults of a usual size that the fit would make up for."""
    sizes = {"a gain of the force that is wrong by a tenth": 0.1 * result.model}
    if "offset" not in experiment.instrument:
        tenth = np.full(len(result.model), 0.1 * np.abs(experiment.force).max())
        sizes = {"an offset of a tenth of the largest force": tenth, **sizes}
    scatter = np.sqrt(result.variance / result.correlated) if not result.known else 1.0
    return [
        words
        for words, shape in sizes.items()
        if visible(experiment, result, shape) * np.linalg.norm(shape * experiment.weight) < SHOWS * scatter
    ]


def remedies(experiment: Experiment, result: Fit) -> list[str]:
    """What explains a fit that failed: each fault that does alone, the best first, or some together.

    Or else what takes most of the misfit away.
    """
    found = [(one, fit) for one in _alone(experiment) if (fit := _fitted(one.experiment)) is not None]
    better = sorted((pair for pair in found if _better(pair[1], result)), key=lambda pair: pair[1].squares)
    if good := [(one, fit) for one, fit in better if not misfits(one.experiment, fit)]:
        return [f"it fits with {_said(one, fit)}" for one, fit in good]
    together, fit = _together(experiment, result)
    if fit is not result and not misfits(together.experiment, fit):
        return [f"it fits with {_said(together, fit)}"]
    best, fit = min([*better, (together, fit)], key=lambda pair: pair[1].squares)
    if fit.squares > MOST * result.squares:
        return []
    return [f"the misfit falls to {np.sqrt(np.mean(fit.residuals**2)):.3g} N rms with {_said(best, fit)}"]


def _better(fit: Fit, than: Fit) -> bool:
    """By more than one coordinate more takes off of scatter."""
    return than.squares - fit.squares > stats.chi2.isf(CHANCE, 1) * fit.variance


def _alone(experiment: Experiment) -> list[Remedy]:
    names = [name for name in possible(experiment) if name not in experiment.instrument]
    instruments = [Remedy("", experiment.like(experiment.rows, (*experiment.instrument, name))) for name in names]
    others = _other_rows(experiment, 0.5)
    return instruments + [Remedy(w, experiment.like(rows, experiment.instrument)) for w, rows in others.items()]


def _together(experiment: Experiment, result: Fit) -> tuple[Remedy, Fit]:
    """Faults of the instrument, each the best beside those before it, until they explain the misfit."""
    best, fit = experiment, result
    while names := [name for name in possible(experiment) if name not in best.instrument]:
        tried = [experiment.like(experiment.rows, (*best.instrument, name)) for name in names]
        fits = [(one, next_) for one in tried if (next_ := _fitted(one)) is not None and _better(next_, fit)]
        if not fits:
            break
        best, fit = min(fits, key=lambda pair: pair[1].squares)
        if not misfits(best, fit):
            break
    return Remedy("", best), fit


def possible(experiment: Experiment) -> list[str]:
    """Nuisances of the instrument that this kind of data has."""
    return ["offset", "drift", *(["delay"] if experiment.word == "sample" else []), "sign"]


def _fitted(experiment: Experiment) -> Fit | None:
    if experiment.degrees <= 0:
        return None
    try:
        return search(experiment, experiment.target)
    except FrictionError:
        return None


def _other_rows(experiment: Experiment, amplitude: float) -> dict[str, Measurements | Series]:
    """The data with another amplitude of the vibration, and with other laws."""
    rows = experiment.rows
    first = rows.constants if isinstance(rows, Series) else rows.conditions[0]
    known, fitted = experiment.fmu.known, [p.name for p in experiment.parameters]
    now = known.named("friction.model", known.number("friction.model", first.get("friction.model", 1.0), ""))
    found: dict[str, Measurements | Series] = {}
    if V_1 not in fitted and np.any(_column(rows, V_1)):
        words = f"half the stated {V_1}: is that from peak to peak?" if amplitude == 0.5 else f"a wrong {V_1}"
        found[words] = _with(rows, {V_1: lambda row: amplitude * row.get(V_1, 0.0)})
    given = {name: np.atleast_1d(known.numbers(name, value, name)) for name, value in first.items()}
    for law in BRISTLES:
        numbers = {**given, **{name: np.array([np.nan]) for name in fitted}}
        numbers["friction.model"] = np.array([known.items["friction.model"][law]])
        if law != now and not set(fitted) & set(unused(known, numbers)):
            found[f"friction.model = {law}"] = _with(rows, {"friction.model": lambda row, law=law: law})
    return found


def _column(rows: Measurements | Series, name: str) -> list[float]:
    scenes = [rows.constants] if isinstance(rows, Series) else rows.conditions
    return [float(scene.get(name, 0.0)) for scene in scenes]


def _with(rows: Measurements | Series, changes: Mapping[str, Any]) -> Measurements | Series:
    def changed(scene: Mapping[str, Any]) -> dict[str, Any]:
        return {**scene, **{name: change(scene) for name, change in changes.items()}}

    if isinstance(rows, Series):
        return replace(rows, constants=changed(rows.constants))
    return replace(rows, conditions=[changed(scene) for scene in rows.conditions])


def described(experiment: Experiment, fit: Fit) -> list[str]:
    """The nuisances of the instrument, with their half-widths of 95 %."""
    per = "s" if experiment.word == "sample" else "row"
    units = {"offset": (1.0, "N"), "drift": (1.0, f"N per {per}"), "delay": (1e3, "ms")}
    said = [
        f"{name} {units[name][0] * value:+.4g} ± {units[name][0] * width:.2g} {units[name][1]}"
        for name, (value, width) in fit.nuisances.items()
    ]
    return said + (["force of the opposite sign"] if experiment.sign < 0.0 else [])


def _said(remedy: Remedy, fit: Fit) -> str:
    """What it is, how to ask for it, and the parameters with it."""
    experiment, pairs = remedy.experiment, zip(fit.parameters, fit.values, strict=True)
    values = ", ".join(f"{p.name} = {value:.4g}{p.after}" for p, value in pairs)
    ask = f"{', '.join(described(experiment, fit))} (nuisance {', '.join(experiment.instrument)})"
    return f"{remedy.words or ask}; then {values}"
