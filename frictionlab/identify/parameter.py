"""A parameter that is fitted, and the coordinate it is fitted in."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from frictionlab.fmu import FrictionFmu
from frictionlab.project import UserError

# Where to search when no start value is given; other parameters are searched within a factor of 3.
SEARCH = {
    "contact.stiffnessScale": (1e-9, 10.0),
    "contact.sigma": (1e3, 1e13),
    "vibration.phase_d": (0.0, 2.0 * math.pi),
}


@dataclass(frozen=True)
class Parameter:
    """The coordinate is the logarithm if the parameter must be positive, so that an interval is a factor.

    Else it is the value over the largest that is searched, or over 1 rad.
    """

    name: str
    unit: str
    low: float  # bounds of the model description
    high: float
    search: tuple[float, float]
    start: float | None = None

    @property
    def logarithmic(self) -> bool:
        return self.low > 0.0

    @property
    def periodic(self) -> bool:
        return self.name == "vibration.phase_d"

    @property
    def unit_of_coordinate(self) -> float:
        return 1.0 if self.periodic else max(map(abs, self.search)) or 1.0

    def to_coordinate(self, value: float) -> float:
        if self.logarithmic:
            return math.log(value) if value > 0.0 else -math.inf
        return value / self.unit_of_coordinate

    def to_value(self, coordinate: float) -> float:
        return float(self.values(np.float64(coordinate)))

    def values(self, coordinates: np.ndarray) -> np.ndarray:
        if self.logarithmic:
            return np.exp(np.minimum(coordinates, 700.0))
        return coordinates * self.unit_of_coordinate

    def wrapped(self, coordinate: float) -> float:
        return coordinate % (2.0 * math.pi) if self.periodic else coordinate


def accepted(fmu: FrictionFmu) -> list[str]:
    """Variables that a column may hold, or a fit vary."""
    return [
        name
        for name, variable in fmu.variables.items()
        if variable.type == "Real"
        and variable.causality in ("input", "parameter")
        and not name.startswith("solver.")
        and name != "delta_0"
    ]


def parameter(
    fmu: FrictionFmu,
    name: str,
    start: float | None,
    search: tuple[float, float] | None,
    constants: Mapping[str, Any],
) -> Parameter:
    """A parameter by its name in the FMU, with bounds and unit from the model description."""
    if name not in accepted(fmu):
        raise UserError(f"{name} can't be fitted; these can: {', '.join(accepted(fmu))}")
    variable = fmu.variables[name]
    low = -math.inf if variable.min is None else float(variable.min)
    high = math.inf if variable.max is None else float(variable.max)
    if search is None:
        usual = float(constants.get(name, variable.start))
        nominal = usual or float(variable.nominal or 1.0)
        search = SEARCH.get(name, (max(nominal / 3.0, low), min(nominal * 3.0, high)))
    for value in (*search, *([] if start is None else [start])):
        if not low <= value <= high:
            raise UserError(f"{name} = {value:g} {variable.unit} must be from {low:g} to {high:g}")
    return Parameter(name, variable.unit, low, high, search, start)
