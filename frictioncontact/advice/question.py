"""What is asked: a scene, the steps that are taken in it, and how accurate which output must be."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt

from frictioncontact.doubts import warn_of
from frictioncontact.errors import UserError
from frictioncontact.fmu import FrictionFmu, Value
from frictioncontact.simulation.inputs import samples
from frictioncontact.values import pairs, real

if TYPE_CHECKING:
    import pandas as pd

Output = Literal["both", "F_t", "F_t_mean"]
OUTPUTS: tuple[Output, ...] = ("both", "F_t", "F_t_mean")
LONGEST = 400  # communication steps taken from a table of inputs
LEAST = 1e-8  # accuracy; solver.tolerance promises no more
STEP_LENGTHS = (1e-15, 1e9)  # s


@dataclass(frozen=True)
class Question:
    """Inputs are samples at the communication points; without any, they keep their start values."""

    given: dict[str, Value]
    values: dict[str, Value]  # of every variable that describes a scene
    step: float  # s
    accuracy: float  # over F_C, and over the mean friction
    output: Output
    start: float  # s
    inputs: dict[str, np.ndarray]
    linear: bool  # inputs between their samples

    @property
    def vibrates(self) -> bool:
        return any(self.values[f"vibration.{name}"] != 0.0 for name in ("V_1", "V_2", "a_d"))

    @property
    def period(self) -> float:
        """Of the vibration [s]."""
        return 1.0 / float(self.values["vibration.f"])


def question(
    fmu: FrictionFmu,
    scene: Mapping[str, Value] | None,
    accuracy: float,
    step: float | None,
    output: Output,
    inputs: Mapping[str, npt.ArrayLike] | pd.DataFrame | None,
    linear: bool,
) -> Question:
    """The question, checked; UserError says what is wrong."""
    accuracy = real(accuracy, "accuracy")
    if not LEAST <= accuracy <= 1.0:
        raise UserError(f"accuracy {accuracy:g}: must lie between {LEAST:g} and 1")
    if output not in OUTPUTS:
        raise UserError(f"output {output}: must be one of {', '.join(OUTPUTS)}")
    given = scene_values(fmu, pairs(scene, "scene"))
    values = {**_starts(fmu), **given}
    start, moving = 0.0, {}
    if inputs is not None:
        if step is not None:
            raise UserError("step and inputs: the samples' own time steps are used; leave step out")
        start, step, moving = _even(inputs, fmu.known.inputs)
    elif step is None:
        step = 1.0 / float(values["vibration.f"])
    step = real(step, "step")
    between("step", step, "s", STEP_LENGTHS)
    with fmu.session({**given, **{name: float(v[0]) for name, v in moving.items()}}) as session:
        warn_of(fmu.known, given | moving, session.warnings, is_over_period=True)
    return Question(given, values, step, accuracy, output, start, moving, linear)


def scene_values(fmu: FrictionFmu, scene: Mapping[str, Value]) -> dict[str, Value]:
    """Start values of a scene; of an enumeration the name of an item. UserError where one is wrong."""
    known, values = _starts(fmu), fmu.known.values(scene, "scene")
    for name in values:
        if name not in known:
            raise UserError(f"{name} does not describe a scene; these do: {', '.join(known)}")
    return values


def between(option: str, value: float, unit: str, limits: tuple[float, float]) -> None:
    if not limits[0] <= value <= limits[1]:
        raise UserError(f"{option} {value:g} {unit}: must lie between {limits[0]:g} and {limits[1]:g} {unit}")


def _starts(fmu: FrictionFmu) -> dict[str, Value]:
    """Start values of the variables that describe a scene: not the solver's, and not where it begins."""
    return {
        name: value
        for name, value in fmu.known.starts().items()
        if not name.startswith("solver.") and name not in ("delta_0", "delta_y_0", "initialState")
    }


def _even(
    inputs: Mapping[str, npt.ArrayLike] | pd.DataFrame, names: Sequence[str]
) -> tuple[float, float, dict[str, np.ndarray]]:
    """Start [s], step [s] and samples."""
    table = samples(inputs, names)
    time = table.time[: LONGEST + 1]
    if len(time) < 2:
        raise UserError("inputs: needs at least two samples")
    step = float(time[-1] - time[0]) / (len(time) - 1)
    uneven = np.abs(np.diff(time) - step) > 1e-6 * step
    if step <= 0.0 or uneven.any():
        raise UserError(
            f"inputs: time must grow in even steps, and does not at sample {np.argmax(uneven) + 1}"
        )
    return float(time[0]), step, {name: column[: len(time)] for name, column in table.values.items()}
