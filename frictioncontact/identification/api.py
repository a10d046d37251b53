"""`identify`: named parameters of the FMU from measured friction, and what is found, to print and to plot."""

from __future__ import annotations

import io
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Console

from frictioncontact.command import TABLE
from frictioncontact.errors import UserError, did_you_mean, quiet
from frictioncontact.fmu import FrictionFmu, Value, opened
from frictioncontact.identification.data import FORCE, MEASURED, Measurements, Series, Stated, read
from frictioncontact.identification.experiment import (
    INSTRUMENT,
    V_1,
    Experiment,
    Parameter,
    Record,
    Rows,
    parameter,
)
from frictioncontact.identification.faults import hidden, remedies, rivals, shapes
from frictioncontact.identification.fit import Fit, Tell, search, silent, with_profiles
from frictioncontact.identification.judge import judge
from frictioncontact.identification.show import show
from frictioncontact.plausibility import unused, warn_of
from frictioncontact.tables import accepted
from frictioncontact.values import LARGEST, Variables, number, pairs, real

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from frictioncontact.tables import Source

    Asked = Sequence[str] | Mapping[str, float | tuple[float, float] | None]

DEFAULT = ("contact.stiffnessScale", "vibration.phase_d")


@dataclass(frozen=True, repr=False)
class Identification:
    """The result of a fit. str() states first whether the law fits; plot() draws the fit."""

    fit: Fit
    experiment: Experiment = field(repr=False)

    @property
    def values(self) -> dict[str, float]:
        """The fitted parameters, SI units: start values for `simulate`."""
        names = (p.name for p in self.fit.parameters)
        return dict(zip(names, map(float, self.fit.values), strict=True))

    @property
    def intervals(self) -> dict[str, tuple[float, float]]:
        """Their 95 % intervals by profile likelihood; nan where the data give none."""
        profiles = self.fit.profiles or []
        return {p.name: interval for p, interval in zip(self.fit.parameters, profiles, strict=True)}

    @property
    def misfits(self) -> list[str]:
        """The reasons why the law does not fit these data, in words; empty if it fits."""
        return self.fit.misfits

    @property
    def remedies(self) -> list[str]:
        """With what else the data fit, in words: a fault of the instrument, another law or amplitude.

        Where the law fits, with what the data fit as well.
        """
        return self.fit.remedies

    @property
    def nuisances(self) -> dict[str, tuple[float, float]]:
        """What was asked of the instrument, with half-widths of 95 %: offset [N], drift [N/s or N per row],
        delay [s], a factor of the amplitude, and a sign of -1 where the other one fits better."""
        found = dict(self.fit.nuisances)
        return found | ({"sign": (-1.0, 0.0)} if self.experiment.sign < 0.0 else {})

    @property
    def judged(self) -> bool:
        """Whether the data tell if the law fits: the uncertainty is stated, or it is a record in time."""
        return self.fit.judged

    def __repr__(self) -> str:
        values = ", ".join(f"{name} = {value:.6g}" for name, value in self.values.items())
        said, count = "it fits" if self.judged else "fit not judged", len(self.misfits)
        said = f"{count} misfit{'s' if count > 1 else ''}" if count else said
        return f"<identification: {values}; {said}>"

    def __str__(self) -> str:
        text = io.StringIO()
        show(Console(file=text, width=TABLE), self.experiment, self.fit)
        return text.getvalue()

    def plot(self) -> Figure:
        """Measured and fitted forces, and how sharply the data fix the parameters. Needs matplotlib."""
        from frictioncontact import style
        from frictioncontact.identification.figures import picture

        with style.kept():
            return picture(self.experiment, self.fit)


def identify(
    data: Source,
    fit: Asked = DEFAULT,
    *,
    start: Mapping[str, Value] | None = None,
    uncertain: Mapping[str, float | str] | None = None,
    nuisance: Iterable[str] = (),
    columns: Mapping[str, str] | None = None,
    fmu: str | Path | None = None,
    tell: Tell = silent,
) -> Identification:
    """Least squares of any parameters of the FMU to measured friction, with 95 % intervals.

    data       a CSV file, or a mapping or frame with the same headings, NAME in SI units or "NAME [UNIT]": a
               row a steady mean, F_t_mean with V and any other input or parameter; or a series in time (that
               the vibration's phase refers to), F_t with position or V. NAME.uncertainty is the standard
               uncertainty of a column
    fit        names of the parameters, "NAME", "NAME=START" or "NAME=LOW..HIGH", that it stays in; or a
               mapping of names to START, (LOW, HIGH) or None
    start      start values that all rows share, SI units; of an enumeration an item or its number
    uncertain  standard uncertainties: name -> SI value or per cent ("5%")
    nuisance   faults of the instrument to fit beside the parameters: "offset" and "drift" of the force,
               "delay" of the force in a record, "sign" (1 or -1, whichever fits better), "amplitude" (one
               factor of vibration.V_1 in all rows). A column "order" says when each row was measured
    columns    headings of other names: "V" or "V [mm/s]" -> the heading in the data
    fmu        another .fmu file of this model
    tell       a function that is called with the name of each stage
    returns    an `Identification`: values, intervals, nuisances, misfits and with what else the data fit;
               str() prints them, plot() draws the fit
    raises     UserError: the data or the request are wrong; a parameter has no effect on these data
    warns      FrictionWarning: of a start value that has no effect; of an unlikely magnitude

        import frictioncontact as fc
        law = {"friction.model": "ElasticPlastic", "contact.model": "Constant"}
        found = fc.identify(fc.contacts["steel-dry"].data, fit="contact.sigma", start=law)
        print(found)
        fc.simulate({**law, **found.values, "V": 1e-3}, stop=1e-3, step=1e-4)
    """
    loaded = opened(fmu)
    constants = loaded.known.values(start, "start")
    stated = [_stated(loaded, name, value) for name, value in pairs(uncertain, "uncertain").items()]
    rows = read(data, loaded, constants, stated, columns)
    instrument = _instrument(nuisance, rows)
    largest = float(np.max(np.abs(rows.force)))
    if largest == 0.0:
        raise UserError("every measured force is 0 N, and tells nothing about any parameter")
    usual = {"F_C": largest, **constants}  # a limit of another size than the forces has no slope towards them
    parameters = [_parameter(loaded, name, value, usual) for name, value in _asked(fit).items()]
    if not parameters:
        raise UserError("fit: names no parameter")
    _check(parameters, rows, constants)
    _check_use(loaded.known, parameters, rows)
    kind = Record if isinstance(rows, Series) else Rows
    experiment = kind(loaded, rows, parameters, instrument)
    with quiet():
        if "sign" in instrument:  # or not, whichever fits better
            plain = experiment.like(rows, [name for name in instrument if name != "sign"])
            experiment = min((plain, experiment), key=lambda one: search(one, one.target).squares)
        found = fitted(experiment, tell)
    return Identification(found, experiment)


def fitted(experiment: Experiment, tell: Tell = silent) -> Fit:
    """Least squares from the best of some sampled starts, or from the given start values.

    Where the law does not fit, its remedies are sought.

    UserError where there are fewer rows than parameters; FrictionError where the FMU refuses every start.
    """
    result = with_profiles(experiment, search(experiment, experiment.target, tell), tell)
    of_faults = shapes(experiment, result)
    judge(experiment, result, of_faults)
    if result.misfits:
        tell("what explains the misfit")
        result.remedies.extend(remedies(experiment, result))
    elif result.degrees > 0:
        tell("what explains the data as well")
        result.remedies.extend(rivals(experiment, result))
        result.hidden.extend(hidden(experiment, result, of_faults))
    return result


def _instrument(nuisance: Iterable[str], rows: Measurements | Series) -> list[str]:
    names = [nuisance] if isinstance(nuisance, str) else list(nuisance)
    for name in names:
        if name not in INSTRUMENT:
            raise UserError(f"nuisance {name}: must be one of {', '.join(INSTRUMENT)}")
    if "delay" in names and not (isinstance(rows, Series) and rows.is_timed):
        raise UserError("nuisance delay: is for a series, with a column 'time [s]'")
    if "amplitude" in names and (isinstance(rows, Series) or not np.any(rows.column(V_1))):
        raise UserError(f"nuisance amplitude: is for rows of means with a column {V_1}")
    return [name for name in INSTRUMENT if name in names]


def _asked(fit: Asked) -> dict[str, float | tuple[float, float] | None]:
    """Name -> start value, range or neither."""
    if isinstance(fit, Mapping):
        return dict(fit)
    if not isinstance(fit, Iterable):
        raise UserError(f"fit = {fit!r}: must be a name, names, or a mapping of names")
    asked: dict[str, float | tuple[float, float] | None] = {}
    for text in [fit] if isinstance(fit, str) else fit:
        name, _, value = text.partition("=")
        if name in asked:
            raise UserError(f"{name} is to be fitted twice")
        first, *second = [number(part, f"fit {text}") for part in value.split("..", 1)] if value else [None]
        asked[name] = (first, *second) if second else first
    return asked


def _stated(fmu: FrictionFmu, name: str, value: float | str) -> Stated:
    known = (MEASURED, FORCE, *accepted(fmu.variables))
    if name not in known:
        hint = did_you_mean(str(name), known)
        raise UserError(f"the uncertainty of {name}: {name} is no variable that a file may hold{hint}")
    text = str(value)
    found = number(text.removesuffix("%"), f"the uncertainty of {name}")
    if not 1.0 / LARGEST <= found <= LARGEST:
        raise UserError(f"the uncertainty of {name}, {text}: must be from {1.0 / LARGEST:g} to {LARGEST:g}")
    relative = text.endswith("%")
    return Stated(name, found / 100.0 if relative else found, relative)


def _parameter(
    fmu: FrictionFmu, name: str, value: float | tuple[float, float] | None, constants: Mapping[str, Value]
) -> Parameter:
    if isinstance(value, (tuple, list)):
        if len(value) != 2:
            raise UserError(f"{name} = {value}: a range is (low, high)")
        low, high = (real(bound, name) for bound in value)
        if not low < high:
            raise UserError(f"{name} = {low:g}..{high:g}: the range is empty")
        return parameter(fmu, name, None, (low, high), constants)
    return parameter(fmu, name, None if value is None else real(value, name), None, constants)


def _check_use(known: Variables, parameters: Sequence[Parameter], rows: Measurements | Series) -> None:
    """That every parameter has an effect on the rows; warns of other settings that have none."""
    if isinstance(rows, Series):
        given = {**rows.constants, "V": rows.V, **rows.inputs}
    else:
        given = {name: [row[name] for row in rows.conditions] for name in rows.conditions[0]}
    numbers = {name: np.atleast_1d(known.numbers(name, value, name)) for name, value in given.items()}
    fitted = {p.name: np.array([math.nan]) for p in parameters}
    idle = unused(known, numbers | fitted)
    for name in fitted.keys() & idle:
        raise UserError(f"{name} can't be fitted: {idle[name]}")
    warn_of(known, given)


def _check(
    parameters: Sequence[Parameter], rows: Measurements | Series, constants: Mapping[str, Value]
) -> None:
    uncertain = () if isinstance(rows, Series) else [one.name for one in rows.uncertain]
    for name in (p.name for p in parameters):
        if name in rows.names:
            raise UserError(f"{name} is a column of the measurements and can't be fitted too")
        if name in constants:
            raise UserError(f"{name} is given as a start value and can't be fitted too")
        if name in uncertain:
            raise UserError(f"{name} is fitted, and so takes no uncertainty")
