"""What is asked: a scene, the steps that are taken in it, and how accurate which output must be."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from frictioncontact.advice.stuck_mass import between
from frictioncontact.errors import UserError
from frictioncontact.fmu import FrictionFmu, Value
from frictioncontact.plausibility import warn_of
from frictioncontact.simulation import Samples, samples
from frictioncontact.values import pairs, real

if TYPE_CHECKING:
    from frictioncontact.tables import Source

Output = Literal["both", "F_t", "F_t_mean"]
OUTPUTS: tuple[Output, ...] = ("both", "F_t", "F_t_mean")
STEP_LENGTHS = (1e-15, 1e9)  # s
LONGEST = 400  # communication steps taken from a table of inputs
LEAST = 1e-8  # accuracy; solver.tolerance promises no more


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
    table: Samples | None = None  # all of the inputs

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
    inputs: Source | None,
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
    start, moving, table = 0.0, {}, None
    if inputs is not None:
        if step is not None:
            raise UserError("step and inputs: the samples' own time steps are used; leave step out")
        table = _at_steps(samples(inputs, fmu.known))
        start, step, moving = _even(table)
    elif step is None:
        step = 1.0 / float(values["vibration.f"])
    step = real(step, "step")
    between("step", step, "s", STEP_LENGTHS)
    with fmu.session({**given, **{name: float(v[0]) for name, v in moving.items()}}) as session:
        warn_of(fmu.known, given | moving, session.warnings, is_over_period=True)
    return Question(given, values, step, accuracy, output, start, moving, linear, table)


def scene_values(fmu: FrictionFmu, scene: Mapping[str, Value]) -> dict[str, Value]:
    """Start values of a scene; of an enumeration the name of an item. UserError where one is wrong."""
    known, values = _starts(fmu), fmu.known.values(scene, "scene")
    for name in values:
        if name not in known:
            raise UserError(f"{name} does not describe a scene; these do: {', '.join(known)}")
    return values


def _starts(fmu: FrictionFmu) -> dict[str, Value]:
    """Start values of the variables that describe a scene: not the solver's, and not where it begins."""
    return {
        name: value
        for name, value in fmu.known.starts().items()
        if not name.startswith("solver.") and name not in ("delta_0", "delta_y_0", "initialState")
    }


def _at_steps(table: Samples) -> Samples:
    """One sample a time; of a velocity that jumps at all, as a position's does, its means over steps."""
    time = table.time
    if len(time) < 4 or len(time) % 2 or (time[::2] != time[1::2]).any():
        return table
    means = {name: 0.5 * (each[1:-1:2] + each[2:-1:2]) for name, each in table.values.items()}
    return Samples(time[::2], {name: np.append(each, each[-1]) for name, each in means.items()})


def _even(table: Samples) -> tuple[float, float, dict[str, np.ndarray]]:
    """Start [s], step [s] and samples."""
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
