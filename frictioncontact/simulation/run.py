"""`simulate`: one scene over time, as a table."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from frictioncontact.doubts import warn_of
from frictioncontact.errors import UserError
from frictioncontact.fmu import OUTPUTS, Value, opened, run
from frictioncontact.simulation.inputs import Samples, samples
from frictioncontact.values import real

if TYPE_CHECKING:
    from frictioncontact.tables import Source

MOST = 10_000_000  # rows


def simulate(
    start: Mapping[str, Value] | None = None,
    *,
    stop: float,
    step: float,
    inputs: Source | None = None,
    columns: Mapping[str, str] | None = None,
    outputs: Sequence[str] = OUTPUTS,
    fmu: str | Path | None = None,
) -> pd.DataFrame:
    """Simulates a scene from 0 to stop, with a row for each step.

    start     name of an input or parameter -> its value at the start, SI units; of an enumeration an item or
              its number
    stop      s; the last step is shorter if stop is not a multiple of step
    step      s between two rows; F_t_mean and F_y_mean are means over the time since the row before
    inputs    a table (CSV file, mapping or frame) with time and any inputs, in SI units or under headings
              "V [mm/s]": linear between the samples, held before the first and after the last; two samples
              at one time are a jump. position in place of V: its velocity. Samples need not coincide with
              steps
    columns   headings of other names in inputs: "V" or "V [mm/s]" -> the heading there
    outputs   names of the variables to read
    fmu       another .fmu file of this model
    returns   a frame of ceil(stop / step) + 1 rows: the column time [s], and one for each output, SI units
    raises    UserError: a name or a value is wrong; FrictionError: the FMU refuses the scene
    warns     FrictionWarning: of the FMU's log; of a setting that has no effect; of an unlikely magnitude;
              of samples after stop

        import frictioncontact as fc
        scene = {"V": 0.5, "vibration.V_1": 1.44, "contact.stiffnessScale": 4.4e-7}
        print(fc.simulate(scene, stop=1e-3, step=5e-5, outputs=["F_t_mean", "W_f"]))
    """
    loaded = opened(fmu)
    outputs = _names(outputs)
    for name in outputs:
        loaded.known.readable(name, "outputs")
    values = loaded.known.values(start, "start")
    ends = _ends(real(stop, "stop"), real(step, "step"))
    moving = (
        samples(inputs, loaded.known, float(ends[-1]), columns)
        if inputs is not None
        else Samples(np.zeros(1), {})
    )
    times = moving.steps(ends)
    begins = np.concatenate([[0.0], times[:-1]])
    lengths = times - begins
    log: list[str] = []
    rows = run(loaded, values, lengths, *moving.over(begins, times), outputs=outputs, warnings=log)
    if not {"F_t", "F_y"} & {*outputs}:  # the sample that an undersampled vibration makes of it is not read
        log = [text for text in log if "F_t is then one sample" not in text]
    warn_of(loaded.known, values | moving.values, log)
    kept = np.concatenate([[0], np.searchsorted(times, ends) + 1])
    found = rows[kept]
    means = [k for k, name in enumerate(outputs) if name in ("F_t_mean", "F_y_mean")]
    impulse = np.cumsum(rows[:, means] * np.concatenate([[0.0], lengths])[:, None], axis=0)
    found[1:, means] = np.diff(impulse[kept], axis=0) / np.diff(ends, prepend=0.0)[:, None]
    return pd.DataFrame({"time": np.concatenate([[0.0], ends]), **dict(zip(outputs, found.T, strict=True))})


def _names(outputs: object) -> list[str]:
    if isinstance(outputs, str) or not isinstance(outputs, Iterable):
        raise UserError(f"outputs = {outputs!r}: must be a sequence of names")
    return [str(name) for name in outputs]


def _ends(stop: float, step: float) -> np.ndarray:
    """Times [s] of the rows after the first."""
    for name, value in (("stop", stop), ("step", step)):
        if not 0.0 < value < math.inf:
            raise UserError(f"{name} = {value}: must be a positive number of seconds")
    if stop > MOST * step:
        raise UserError(f"step = {step:g} s: stop / step must be at most {MOST}")
    count = max(1, math.ceil(stop / step - 1e-9))
    ends = step * np.arange(1.0, count + 1.0)
    ends[-1] = stop
    return ends
