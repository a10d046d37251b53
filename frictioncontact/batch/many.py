"""Many scenarios of an FMU in one call.

    simulate_many({"V": V[:, None], "contact.stiffnessScale": scale},
                  {"mean": "F_t_mean", "least": ("F_t", "min"), "work": ("W_f", "change")}, samples=64)

gives arrays "mean", "least" and "work" of the shape that V[:, None] and scale broadcast to.

The scenarios run in host/batch.c through the FMI functions of the FMU itself, on threads of this process.
"""

from __future__ import annotations

import math
import os
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt

from .. import resources
from ..errors import BatchError, UserError, shown
from ..fmu import opened
from ..plausibility import warn_of
from ..tables import in_SI
from ..values import Variables, check_whole, numbers_of, pairs, real, row_of
from .run import Batch, Progress
from .runner import STATISTICS, loaded, runner

if TYPE_CHECKING:
    import pandas as pd

Statistic = Literal["end", "change", "mean", "min", "max", "samples"]
Output = str | tuple[str, Statistic]
Outputs = Sequence[str] | Mapping[str, Output]
Unit = Literal["period", "s"]
MAX_SAMPLES = 1_000_000
MAX_THREADS = 1024


def simulate_many(
    values: Mapping[str, npt.ArrayLike] | pd.DataFrame,
    outputs: Outputs = ("F_t_mean",),
    *,
    fmu: str | Path | bytes | None = None,
    settle: npt.ArrayLike | None = None,
    duration: npt.ArrayLike = 1.0,
    samples: int = 1,
    unit: Unit = "period",
    settled: bool = False,
    inputs: Mapping[str, npt.ArrayLike] | None = None,
    rates: Mapping[str, npt.ArrayLike] | None = None,
    steps: npt.ArrayLike | None = None,
    begin: float = 0.0,
    errors: Literal["raise", "keep"] = "raise",
    threads: int | None = None,
    progress: bool | Progress = False,
) -> dict[str, np.ndarray] | pd.DataFrame:
    """Results of every scenario: arrays of the shape that the values broadcast to, or a frame for a frame.

    values    name of an input or parameter -> values at the start, SI units, or under a heading "V [mm/s]";
              of an enumeration items or their numbers. Arrays broadcast as in NumPy; a row of a frame is a
              scenario, and nothing broadcasts beyond its rows
    outputs   names of variables to be read; or name of a result -> variable, or (variable, statistic)
              with a statistic of "end" (after the last step, the default), "change" (since the settling),
              "mean", "min", "max" (of the samples), "samples" (all of them: one axis more; in a frame the
              columns NAME[0], NAME[1], ...). F_t_mean is over the last step alone: with static friction a
              settled state may last several periods, and F_t_settled is the mean over all
    fmu       another .fmu file of this model with a binary for this platform, or its bytes
    settle    length of a first step that is not read. Without it scenarios start settled, if the unit is
              the period and the values do not contain initialState
    duration  length of the recorded part, in `samples` equal steps
    unit      of settle and duration: a period of the vibration, 1 / vibration.f, or a second
    settled   start in the settled state: initialState = Settled
    inputs    inputs to set before each step, the same in all scenarios: name -> a value for every step
    rates     of these inputs over each step, SI units per second: name -> a value for every step; else held
    steps     lengths of the steps, in the unit, instead of duration and samples
    begin     time at which all scenarios start, s: the vibration's phase refers to time 0
    errors    "raise": BatchError with the message of the first scenario that the FMU refuses;
              "keep": its results are NaN and "reason", one result more, holds the message (else None)
    threads   number of threads, up to 1024; by default one for each processor that this process may use
    progress  True: a bar on a terminal; or a function that is told how many scenarios are finished and
              how many of them refused
    returns   name of each result -> array, SI units; of a frame the frame of its rows
    raises    BatchError: a name, a value or a length is wrong, before anything runs, with column and row,
              counted from 0; a scenario is refused
    warns     FrictionWarning: of a setting that has no effect in any scenario; of an unlikely magnitude

    At a KeyboardInterrupt the threads stop after their present step, and within a second the exception
    reaches the caller. A few steps of the default method run to their end without a thread.

        import numpy as np
        import frictioncontact as fc
        V = np.linspace(0.1, 2.0, 20)
        ratio = np.array([[1.0], [0.5]])
        found = fc.simulate_many({"V": V, "F_C": 55 * ratio, "vibration.V_1": 1.44}, ["F_t_mean"])
        print(found["F_t_mean"].shape)
    """
    try:
        library, contact = runner(resources.batch_host()), opened(fmu)
        known, lengths = contact.known, None if steps is None else _row(_lengths(steps, "steps"), "steps")
        samples = check_whole(samples if lengths is None else len(lengths), MAX_SAMPLES, "samples =")
        if unit not in ("period", "s"):
            raise BatchError(f"unit = {unit!r}: must be 'period' or 's'")
        if errors not in ("raise", "keep"):
            raise BatchError(f"errors = {errors!r}: must be 'raise' or 'keep'")
        workers = check_whole(processors() if threads is None else threads, MAX_THREADS, "threads =")
        named = in_SI(_named(values), known.units(), "column")
        if settled or (settle is None and unit == "period" and "initialState" not in named):
            if "initialState" in named:
                raise BatchError("column initialState: settled gives it already")
            named = {**named, "initialState": "Settled"}
        starts = {name: known.numbers(name, value, f"column {name}") for name, value in named.items()}
        spans = {"settle": 0.0 if settle is None else settle, "duration": duration}
        spans = {name: _lengths(value, name) for name, value in spans.items()}
        shape, columns = _flat(starts | spans, None if isinstance(values, Mapping) else len(values))
        batch = Batch(
            library, loaded(library, contact.library), contact.description.guid.encode(), known,
            shape, {name: columns[name] for name in starts}, columns["settle"], columns["duration"], samples,
            _read(known, outputs), known.all["vibration.f"].valueReference if unit == "period" else None,
            *_moving(known, pairs(inputs, "inputs"), pairs(rates, "rates"), samples), lengths,
            real(begin, "begin"),
        )  # fmt: skip
    except UserError as error:
        raise BatchError(str(error)) from None
    warn_of(known, starts | (inputs or {}), is_over_period=unit == "period")
    with shown_progress(progress, batch.scenarios) as told:
        results = batch.run(workers, errors == "raise", told)
    if errors == "raise":
        del results["reason"]
    return _frame(results, values.index) if not isinstance(values, Mapping) else results


def _flat(
    columns: Mapping[str, np.ndarray], rows: int | None
) -> tuple[tuple[int, ...], dict[str, np.ndarray]]:
    """What the columns broadcast to, and each with one value where there is one for all, else all of them."""
    shape = _common_shape(columns, rows)
    try:
        spread = {
            name: (each.reshape(1) if each.size == 1 else np.broadcast_to(each, shape)).astype(float).ravel()
            for name, each in columns.items()
        }
    except (MemoryError, ValueError):  # more than can be addressed
        raise BatchError(f"no memory for {math.prod(shape)} scenarios") from None
    return shape, spread


def _common_shape(columns: Mapping[str, np.ndarray], rows: int | None = None) -> tuple[int, ...]:
    """What the columns broadcast to: the rows of a frame, where there is one."""
    shape: tuple[int, ...] = () if rows is None else (rows,)
    for name, column in columns.items():
        try:
            wider = np.broadcast_shapes(shape, column.shape)
        except ValueError:
            wider = None
        if wider is None or (rows is not None and wider != (rows,)):
            size, before = (" x ".join(map(str, each)) or "1" for each in (column.shape, shape))
            those = f"{before} of those before it" if rows is None else f"{rows} rows of the frame"
            raise BatchError(f"column {name}: its {size} values do not go with the {those}")
        shape = wider
    return shape


def _lengths(value: object, where: str) -> np.ndarray:
    """Finite numbers, none below 0."""
    array = numbers_of(value, where)
    if (array < 0.0).any():
        row = int(np.argmax(array < 0.0))
        raise BatchError(f"{where}{row_of(array, row)}: {array.flat[row]:g} must be at least 0")
    return array


def _moving(
    known: Variables, inputs: Mapping[str, npt.ArrayLike], rates: Mapping[str, npt.ArrayLike], samples: int
) -> tuple[tuple[int, ...], np.ndarray | None, np.ndarray | None]:
    """Value references, values before each step, and rates over it; no rate is 0."""
    for name in rates:
        if name not in inputs:
            raise BatchError(f"rate of {name}: inputs has no values of {name}")
    references, columns, slopes = [], [], []
    for name, values in inputs.items():
        references.append(known.find(name, f"input {name}", ("input",)).valueReference)
        columns.append(_of_steps(values, f"input {name}", samples))
        slopes.append(_of_steps(rates.get(name, np.zeros(samples)), f"rate of {name}", samples))
    return (
        tuple(references),
        np.column_stack(columns) if columns else None,
        np.column_stack(slopes) if rates else None,
    )


def _of_steps(values: npt.ArrayLike, where: str, samples: int) -> np.ndarray:
    """A value for each step."""
    row = _row(numbers_of(values, where), where)
    if len(row) != samples:
        raise BatchError(f"{where}: {len(row)} values for {samples} steps")
    return row


def _row(array: np.ndarray, where: str) -> np.ndarray:
    if array.ndim != 1:
        raise BatchError(f"{where}: must be a row of numbers")
    return np.ascontiguousarray(array)


def _named(values: Mapping[str, npt.ArrayLike] | pd.DataFrame) -> Mapping[str, npt.ArrayLike]:
    if isinstance(values, Mapping):
        return values
    if not hasattr(values, "columns"):
        raise BatchError("values: must be a mapping of names to values, or a pandas frame")
    if not values.columns.is_unique:
        name = values.columns[values.columns.duplicated()][0]
        raise BatchError(f"column {name}: is there twice")
    return {name: values[name].array for name in values.columns}


def _read(known: Variables, outputs: Outputs) -> dict[str, tuple[int, Statistic]]:
    """Name of each result -> value reference and statistic."""
    if isinstance(outputs, str) or not isinstance(outputs, Iterable):
        raise BatchError(f"outputs = {outputs!r}: must be a sequence of names, or a mapping")
    if not isinstance(outputs, Mapping):
        outputs = {known.readable(name, "outputs").name: name for name in outputs}
    read: dict[str, tuple[int, Statistic]] = {}
    for name, output in outputs.items():
        pair = (output, "end") if isinstance(output, str) else output
        if not isinstance(pair, (tuple, list)) or len(pair) != 2 or not isinstance(pair[0], str):
            raise BatchError(
                f"output {name}: {str(output)[:40]} is neither a variable nor (variable, statistic)"
            )
        found = known.readable(pair[0], f"output {name}")
        if pair[1] not in STATISTICS:
            raise BatchError(f"output {name}: {shown(pair[1])} is not one of {', '.join(STATISTICS)}")
        if name == "reason":
            raise BatchError(f"output {name}: the name is taken")
        read[name] = found.valueReference, pair[1]
    return read


def processors() -> int:
    """How many this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _frame(results: Mapping[str, np.ndarray], index: pd.Index) -> pd.DataFrame:
    import pandas as pd

    columns: dict[str, np.ndarray] = {}
    for name, array in results.items():
        if array.ndim == 1:
            columns[name] = array
        else:
            columns |= {f"{name}[{k}]": array[:, k] for k in range(array.shape[1])}
    return pd.DataFrame(columns, index=index)


def shown_progress(progress: bool | Progress, scenarios: int) -> AbstractContextManager[Progress]:
    """What is told how many scenarios are finished and refused: a bar, the given function, or nothing."""
    if callable(progress):
        return nullcontext(progress)
    return _bar(scenarios) if progress else nullcontext(lambda finished, refused: None)


@contextmanager
def _bar(scenarios: int) -> Iterator[Progress]:
    """On standard error where that is a terminal: scenarios per second and time left."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    console = Console(stderr=True)
    columns = (
        TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(),
        TextColumn("{task.fields[rate]}"), TimeRemainingColumn(), TextColumn("{task.fields[refused]}"),
    )  # fmt: skip
    with Bar(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("Simulating", total=scenarios, rate="", refused="")
        began = time.monotonic()

        def show(finished: int, refused: int) -> None:
            rate = finished / max(time.monotonic() - began, 1e-3)
            bar.update(
                task,
                completed=finished,
                rate=f"{rate:.0f}/s",
                refused=f"{refused} refused" if refused else "",
            )

        yield show
