"""Faults of an instrument and of a request: what each adds to the forces, and the fit that allows for it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any

import numpy as np
from scipy import stats

from frictioncontact.errors import FrictionError
from frictioncontact.identification.data import Measurements, Series
from frictioncontact.identification.experiment import V_1, Experiment, parameter
from frictioncontact.identification.fit import Fit, search
from frictioncontact.identification.judge import CHANCE, misfits, visible
from frictioncontact.plausibility import BRISTLES, WITH_STATIC_FRICTION, unused

LAW, STRIBECK = "friction.model", ("friction.staticRatio", "friction.V_S")
MOST = 0.25  # of the sum of squares, left of a misfit that is mostly explained
TENTH = 0.1  # of the force: a fault that a fit should show
STARTS = 3  # of each remedy
SHOWS = 3.0  # standard deviations of the scatter by which it does
MAX_RATIO = 3.0  # of static friction that is tried
MUCH = 15.0  # of the sum of squares over the variance of a row: by scatter 1 of 1e4 fits is worse by that
ALIKE = 4.0  # the same of a fit inside of the 95 % interval of one parameter

OFFSET, GAIN = "an offset of the force", "a wrong gain of the force"
AMPLITUDE, POSITION, HOLDER = f"a wrong {V_1}", "a wrong gain of the position", "a soft holder in series"
ASKED = {"offset": OFFSET, "amplitude": AMPLITUDE}  # a nuisance, and the fault that it allows for
STEP = 0.03  # of a fault, for what it adds to first order

Remedy = tuple[str, Experiment]  # what the data may have been made with, in words if it is no nuisance
Tried = tuple[str, Experiment, Fit]


def shapes(experiment: Experiment, result: Fit) -> dict[str, np.ndarray]:
    """What faults would add to the forces [N], to first order: words -> of every row.

    Of all but drift, delay and laws: by a fault as large as what it belongs to.
    """
    rows, model = experiment.rows, result.model
    found = {OFFSET: np.full(len(model), np.abs(experiment.force).max()), GAIN: model}
    changed: dict[str, Measurements | Series] = {}
    if isinstance(rows, Series):
        if rows.is_timed:
            found["a force that is late"] = np.gradient(model, experiment.time)
        if rows.position is not None and rows.told is None:
            with np.errstate(divide="ignore", invalid="ignore"):
                stiffness = np.nanmax(np.abs(np.diff(model) / np.diff(rows.position)), initial=1e-300)
            changed[POSITION] = rows.moved((1.0 - STEP) * rows.position)
            changed[HOLDER] = rows.moved(rows.position - STEP * model / stiffness)
    if _ordered(experiment):
        found["a drift of the force"] = experiment.elapsed
    if V_1 not in [p.name for p in experiment.parameters] and np.any(rows.column(V_1)):
        changed[AMPLITUDE] = _with_amplitude(rows, 1.0 - STEP)
    for words, other in (changed | _other_laws(experiment)).items():
        forces = experiment.like(other, experiment.instrument).forces(result.point[None, :])[0]
        found[words] = np.nan_to_num(forces - model) / STEP
    return found


def hidden(experiment: Experiment, result: Fit, shapes: Mapping[str, np.ndarray]) -> list[str]:
    """Faults of a tenth that the parameters would make up for."""
    asked = [ASKED.get(name) for name in experiment.instrument]
    return [
        words
        for words in (OFFSET, GAIN, POSITION, HOLDER, AMPLITUDE)
        if words in shapes and words not in asked
        and TENTH * np.linalg.norm(visible(experiment, result, shapes[words]))
        < SHOWS * np.sqrt(result.variance)
    ]  # fmt: skip


def rivals(experiment: Experiment, result: Fit) -> list[str]:
    """With what other amplitude or law the data fit as well."""
    found = []
    for words, other in _others(experiment):
        with suppress(FrictionError):
            fit = search(other, other.target, most=STARTS, given=_near(experiment, result))
            worse, same = (fit.squares - result.squares) / result.variance, 1e-6 * result.squares
            is_new = abs(fit.squares - result.squares) > same  # LuGre may be Dahl
            if is_new and (worse < ALIKE or (worse < MUCH and not misfits(other, fit))):
                found.append(f"it fits as well with {_said(words, other, fit)}")
    return found


def _near(experiment: Experiment, result: Fit) -> list[np.ndarray]:
    """Where a search of another law or amplitude starts: a record costs more than rows."""
    return [result.coordinates] if experiment.word == "sample" else []


def _ordered(experiment: Experiment) -> bool:
    """Whether it is known when each force was measured."""
    rows = experiment.rows
    known = rows.is_timed if isinstance(rows, Series) else rows.order is not None
    return known or "drift" in experiment.instrument


def remedies(experiment: Experiment, result: Fit) -> list[str]:
    """What explains a fit that failed: each fault that does alone, the best first, or some together.

    Or else what takes most of the misfit away.
    """
    tried = _tried([*_with_one_more(experiment), *_others(experiment)], result)
    for more in ([], _with_stribeck(experiment)):
        tried += _tried(more, result)
        if good := [one for one in tried if not misfits(*one[1:])]:
            good.sort(key=lambda one: len(one[2].point))  # what frees the least comes first
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
    names = ["offset", *(["drift"] if _ordered(experiment) else []), "sign"]
    if isinstance(experiment.rows, Series):
        names += ["delay"] if experiment.rows.is_timed else []
    elif V_1 not in [p.name for p in experiment.parameters] and np.any(experiment.rows.column(V_1)):
        names.append("amplitude")
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


def _with_amplitude(rows: Measurements | Series, factor: float) -> Measurements | Series:
    return rows.changed(lambda scene: {V_1: factor * scene.get(V_1, 0.0)})


def _others(experiment: Experiment) -> list[Remedy]:
    """The experiment with half or twice the amplitude of the vibration, and with other laws."""
    rows, found = experiment.rows, _other_laws(experiment)
    free = "amplitude" in experiment.instrument or V_1 in [p.name for p in experiment.parameters]
    if not free and np.any(rows.column(V_1)):
        halves = {
            f"half the stated {V_1}: is that from peak to peak?": _with_amplitude(rows, 0.5),
            f"twice the stated {V_1}": _with_amplitude(rows, 2.0),
        }
        found = halves | found
    return [(words, experiment.like(other, experiment.instrument)) for words, other in found.items()]


def _law(experiment: Experiment) -> dict[str, Any]:
    """What the first row gives to the law, numbers by name; nan for what is fitted."""
    rows, known = experiment.rows, experiment.fmu.known
    first = rows.constants if isinstance(rows, Series) else rows.conditions[0]
    given: dict[str, Any] = {name: known.numbers(name, value, name) for name, value in first.items()}
    return given | {p.name: np.array(np.nan) for p in experiment.parameters}


def _other_laws(experiment: Experiment) -> dict[str, Measurements | Series]:
    """The data with the other laws in which every parameter has an effect."""
    known, given, found = experiment.fmu.known, _law(experiment), {}
    for law in BRISTLES:
        number = known.items[LAW][law]
        idle = {p.name for p in experiment.parameters} & set(unused(known, given | {LAW: np.array(number)}))
        if number != given.get(LAW, 1.0) and not idle:
            found[f"{LAW} = {law}"] = experiment.rows.changed(lambda scene, law=law: {LAW: law})
    return found


def _with_stribeck(experiment: Experiment) -> list[Remedy]:
    """The laws with a static friction, its ratio and its velocity fitted too."""
    rows, given = experiment.rows, _law(experiment)
    if {*STRIBECK} & {*given, *rows.names}:
        return []
    V = np.abs(rows.V if isinstance(rows, Series) else rows.column("V"))
    V = V[V > 0.0]
    if not len(V):
        return []
    ranges = ("friction.V_S", (V.min(), V.max())), ("friction.staticRatio", (1.0, MAX_RATIO))
    more = [parameter(experiment.fmu, name, None, search, {}) for name, search in ranges]
    return [
        (
            f"{LAW} = {law} and a static friction",
            type(experiment)(experiment.fmu, rows.changed(lambda scene, law=law: {LAW: law}),
                             [*experiment.parameters, *more], experiment.instrument),
        )
        for law in WITH_STATIC_FRICTION
    ]  # fmt: skip


def described(experiment: Experiment, fit: Fit) -> str:
    """The nuisances of the instrument, with their half-widths of 95 %."""
    per = "s" if experiment.word == "sample" else "row"
    units = {"offset": (1.0, "N"), "drift": (1.0, f"N per {per}"), "delay": (1e3, "ms")}
    units["amplitude"] = 1.0, f"times the stated {V_1}"
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
