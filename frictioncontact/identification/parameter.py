"""A parameter that is fitted, and the coordinate it is fitted in."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from frictioncontact.errors import UserError, did_you_mean
from frictioncontact.fmu import FrictionFmu
from frictioncontact.tables import accepted
from frictioncontact.values import LARGEST

LEAST = {"d": 1e-12, "E": 1.0}  # m, Pa: the FMU asks for more than 0 where they are used

# The ranges where nothing is given. Of other parameters starts are sought within a factor of 3 of the usual
# value, and the fit stays within a factor of FARTHEST of it.
PHASES = ("vibration.phase_d", "vibration.phase_2")
RANGES = {
    "contact.stiffnessScale": (1e-9, 10.0),
    "contact.sigma": (1e3, 1e13),
    **dict.fromkeys(PHASES, (0.0, 2.0 * math.pi)),
}
NEAR, FARTHEST = 3.0, 1e6


@dataclass(frozen=True)
class Parameter:
    """The coordinate is the logarithm if the parameter must be positive, so that an interval is a factor.

    Else it is the value over the largest that is searched, or over 1 rad.
    """

    name: str
    unit: str
    low: float  # the fit stays from low to high
    high: float
    search: tuple[float, float]  # where starts are sought
    start: float | None
    logarithmic: bool

    @property
    def after(self) -> str:
        """The unit as it follows a number."""
        return "" if self.unit == "1" else f" {self.unit}"

    @property
    def periodic(self) -> bool:
        return self.name in PHASES

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


def parameter(
    fmu: FrictionFmu,
    name: str,
    start: float | None,
    search: tuple[float, float] | None,
    constants: Mapping[str, Any],
) -> Parameter:
    """A parameter by its name in the FMU, with bounds and unit from the model description.

    search is the range that it stays in; of a phase it says only where starts are sought. UserError where the
    name is none that can be fitted, or a value is out of bounds.
    """
    names = accepted(fmu.variables)
    if name not in names:
        raise UserError(
            f"{name} can't be fitted{did_you_mean(str(name), names) or ';'} these can: {', '.join(names)}"
        )
    variable = fmu.variables[name]
    low = LEAST.get(name, -LARGEST) if variable.min is None else float(variable.min)
    high = LARGEST if variable.max is None else float(variable.max)
    after = "" if variable.unit == "1" else f" {variable.unit}"
    for value in (*(search or ()), *([] if start is None else [start])):
        if not low <= value <= high:
            raise UserError(f"{name} = {value:g}{after} must be from {low:g} to {high:g}")
    logarithmic = low > 0.0
    search = search or (RANGES.get(name) if start is None else None)
    if search is not None:
        stays = search
    else:
        usual = float(constants.get(name, variable.start)) if start is None else start
        usual = usual or float(variable.nominal or 1.0)
        far = FARTHEST * abs(usual)
        search = max(low, min(usual / NEAR, usual * NEAR)), min(high, max(usual / NEAR, usual * NEAR))
        stays = max(low, usual / FARTHEST if logarithmic else -far), min(high, far)
    if name in PHASES:
        stays = -math.inf, math.inf
    return Parameter(name, variable.unit, *stays, search, start, logarithmic)
