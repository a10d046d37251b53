"""`simulate`: one scene over time, as a table; `variables`: what the FMU takes and gives; the command."""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from frictioncontact import command as shared
from frictioncontact.errors import UserError, warn
from frictioncontact.files import write_whole
from frictioncontact.fmu import INPUTS, OUTPUTS, Value, opened
from frictioncontact.fmu import run as run_steps
from frictioncontact.plausibility import warn_of
from frictioncontact.tables import OWN, POSITION, SUFFIX, TIME
from frictioncontact.tables import table as read
from frictioncontact.values import assignments, real

if TYPE_CHECKING:
    from frictioncontact.tables import Source
    from frictioncontact.values import Variables

FAR = 1e300  # s, before and after every sample
ROUNDING = 1e-6  # of times that a table holds in single precision


@dataclass(frozen=True)
class Samples:
    """Inputs that are linear between their samples, and held before the first and after the last.

    Two samples at one time are a jump.
    """

    time: np.ndarray  # s, never falling
    values: dict[str, np.ndarray]

    def preceded(self, part: float, zero: float) -> Samples:
        """The same, with a velocity before the first sample that is a part of its own; times from zero on."""
        values = {name: np.concatenate([each[:1], each]) for name, each in self.values.items()}
        values["V"][0] *= part
        return Samples(np.concatenate([self.time[:1], self.time]) - zero, values)

    def steps(self, ends: np.ndarray) -> np.ndarray:
        """Times [s] from 0 at which a step has to end: the given ends, and the samples between them.

        A sample nearer to an end than 1e-9 of the shortest step counts as there.
        """
        near = 1e-9 * np.diff(ends, prepend=0.0).min()
        inner = np.unique(self.time[(self.time > near) & (self.time < ends[-1])])
        after = ends[np.searchsorted(ends, inner)]
        before = np.concatenate([[0.0], ends])[np.searchsorted(ends, inner)]
        return np.union1d(ends, inner[(after - inner > near) & (inner - before > near)])

    def over(self, begins: np.ndarray, ends: np.ndarray) -> tuple[dict[str, np.ndarray], ...]:
        """Value at the begin of each step and rate over it, per input, where no sample is inside a step."""
        time = np.concatenate([[-FAR], self.time, [FAR]])
        right = np.searchsorted(time, 0.5 * (begins + ends))
        left = right - 1
        values, rates = {}, {}
        for name, samples in self.values.items():
            padded = np.concatenate([samples[:1], samples, samples[-1:]])
            rates[name] = (padded[right] - padded[left]) / (time[right] - time[left])
            values[name] = padded[left] + rates[name] * (begins - time[left])
        return values, rates


def moving(time: np.ndarray, values: Mapping[str, np.ndarray], position: np.ndarray | None = None) -> Samples:
    """Samples of the inputs; of a position its velocity, which between two samples is linear.

    Each piece goes as far as the position, and not to and fro.
    """
    if position is None:
        return Samples(time, dict(values))
    steps = np.diff(time)
    mean, V = np.diff(position) / steps, np.gradient(position, time, edge_order=min(2, len(steps)))
    half = np.clip(0.5 * np.diff(V), -np.abs(mean), np.abs(mean))
    pieces = {name: np.repeat(each, 2)[1:-1] for name, each in values.items()}
    return Samples(
        np.repeat(time, 2)[1:-1], {**pieces, "V": np.column_stack([mean - half, mean + half]).ravel()}
    )


def samples(
    source: Source, known: Variables, stop: float | None = None, columns: Mapping[str, str] | None = None
) -> Samples:
    """The samples of a table with a column time and any inputs, or position; UserError if it is wrong.

    What was measured is left out. stop [s]: warns of samples beyond it. columns: headings of other names.
    """
    units = known.units(("input",))
    names = ", ".join(units)
    measured = {f"{name}{SUFFIX}": unit for name, unit in OWN.items()}
    table = read(source, "inputs", {**units, **OWN, **measured}, "input of the FMU", columns, is_log=True)
    found = {name: each for name, each in table.numbers().items() if name in (*units, TIME, POSITION)}
    where = table.where
    if TIME not in found or len(found) < 2:
        raise UserError(f"{where}: needs a column time [s] and at least one of {names}, {POSITION}")
    time, position = found.pop(TIME), found.pop(POSITION, None)
    if not len(time):
        raise UserError(f"{where}: no samples")
    backward = np.flatnonzero(np.diff(time) < 0.0)
    if len(backward):
        k = int(backward[0])
        raise UserError(f"{where}: time falls from {time[k]:g} to {time[k + 1]:g} s at sample {k + 1}")
    beyond = 0 if stop is None else int(np.sum(time > stop * (1.0 + ROUNDING)))
    if beyond:
        late = f"{beyond} of {len(time)} samples are after stop = {stop:g} s"
        warn([f"{where}: {late}; the last is at {time[-1]:g} s"])
    if position is None:
        return Samples(time, found)
    if "V" in found or len(time) < 2 or (np.diff(time) <= 0.0).any():
        raise UserError(f"{where}: position needs two samples, a time that grows, and no V beside it")
    pieces = moving(time, found, position)
    ends = {name: np.concatenate([each[:1], each, each[-1:]]) for name, each in pieces.values.items()}
    ends["V"][[0, -1]] = 0.0  # it rests outside of its samples
    return Samples(np.concatenate([time[:1], pieces.time, time[-1:]]), ends)


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
    moving = Samples(np.zeros(1), {})
    if inputs is not None:
        moving = samples(inputs, loaded.known, float(ends[-1]), columns)
    times = moving.steps(ends)
    begins = np.concatenate([[0.0], times[:-1]])
    lengths = times - begins
    log: list[str] = []
    rows = run_steps(loaded, values, lengths, *moving.over(begins, times), outputs=outputs, warnings=log)
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


def variables(fmu: str | Path | None = None) -> pd.DataFrame:
    """Every variable of the FMU, from its model description.

    fmu       another .fmu file of this model
    returns   a frame, a row for each name: causality, variability, unit, start, min, max (inclusive), items
              (of an enumeration name -> number), meaning
    raises    UserError: not an FMU of this model

        import frictioncontact as fc
        print(fc.variables().loc["vibration.V_1"])
        print(fc.variables().query("causality == 'input'")[["unit", "start", "meaning"]])
    """
    known = opened(fmu).known
    starts = known.starts()
    rows = {
        name: {
            "causality": variable.causality,
            "variability": variable.variability,
            "unit": variable.unit or "",
            "start": starts.get(name),
            "min": None if variable.min is None else float(variable.min),
            "max": None if variable.max is None else float(variable.max),
            "items": {item: int(number) for item, number in known.items[name].items()} or None,
            "meaning": variable.description,
        }
        for name, variable in known.all.items()
    }
    return pd.DataFrame.from_dict(rows, orient="index")


DESCRIPTION = """\
Simulates one scene from time 0 on and prints a row for each step, or writes them to a CSV file, whose
headings are the names alone. All values are in SI units, as in the FMU; what is not set has the FMU's start
value.

  %(prog)s --set V=0.5 --set vibration.V_1=1.44 --stop 1e-3 --step 5e-5
  %(prog)s --inputs drive.csv --stop 2 --step 1e-3 --outputs F_t_mean W_f --output out.csv"""


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = shared.command_line("frictioncontact simulate", DESCRIPTION)
    shared.add_set(parser, "of the scene")
    parser.add_argument("--stop", type=float, required=True, help="end, s")
    parser.add_argument("--step", type=float, required=True, help="time between two rows, s")
    parser.add_argument(
        "--inputs", type=Path, metavar="CSV",
        help=f"columns time and any of {', '.join(INPUTS)}, or position; linear between their samples; in SI "
        "units, or with a unit as 'V [mm/s]'",
    )  # fmt: skip
    shared.add_column(parser)
    parser.add_argument(
        "--outputs", nargs="+", default=OUTPUTS, metavar="NAME", help=f"variables ({' '.join(OUTPUTS)})"
    )
    parser.add_argument("--output", type=shared.new_file, metavar="CSV", help="file to write to")
    shared.add_fmu(parser)
    return parser.parse_args(argv)


def run(options: argparse.Namespace) -> None:
    fmu = opened(options.fmu)
    scene = fmu.known.assigned(options.set)
    table = simulate(
        scene,
        stop=options.stop,
        step=options.step,
        inputs=options.inputs,
        columns=assignments(options.column, "--column"),
        outputs=options.outputs,
        fmu=options.fmu,
    )
    if options.output:
        write_whole(options.output, table.to_csv(index=False))
        shared.say_written([options.output])
    else:
        shared.print_frame(table, fmu.known, scene)
