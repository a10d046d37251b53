"""Many scenarios of an FMU in one call.

    simulate_many("build/FrictionContact.fmu", {"V": V[:, None], "contact.stiffnessScale": scale},
                  {"mean": "F_t_mean", "least": ("F_t", "min"), "work": ("W_f", "change")}, samples=64)

gives arrays "mean", "least" and "work" of the shape that V[:, None] and scale broadcast to.

The scenarios run in host/batch.c through the FMI functions of the FMU itself, on threads of this process.
"""

from __future__ import annotations

import os
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from typing import Literal

import fmpy
import numpy as np
import numpy.typing as npt
import pandas as pd
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn
from rich.progress import Progress as Bar

from frictionlab.build import build_fmu
from frictionlab.project import ROOT

from .columns import common_shape, flat, numbers_of, start_values
from .errors import BatchError
from .run import Batch, Progress
from .runner import STATISTICS, runner
from .unpacked import LoadedFmu, loaded_fmu

Statistic = Literal["end", "change", "mean", "min", "max", "samples"]
Output = str | tuple[str, Statistic]
MOST_SAMPLES = 10_000_000
SETTLING = 1e6  # periods: every state that matters has forgotten its start


def simulate_many(
    fmu: str | Path | bytes,
    values: Mapping[str, npt.ArrayLike] | pd.DataFrame,
    outputs: Sequence[str] | Mapping[str, Output] = ("F_t_mean",),
    *,
    settle: npt.ArrayLike | None = None,
    duration: npt.ArrayLike = 1.0,
    samples: int = 1,
    unit: Literal["period", "s"] = "period",
    settled: bool = False,
    errors: Literal["raise", "keep"] = "raise",
    threads: int | None = None,
    progress: bool | Progress = False,
) -> dict[str, np.ndarray] | pd.DataFrame:
    """Results of every scenario: arrays of the shape that the values broadcast to, or a frame for a frame.

    fmu       a .fmu file with a binary for this platform, or its bytes
    values    what is set at the start: name of an input or parameter -> values in the units of the model
              description, those of an enumeration as names of its items or as numbers. Arrays broadcast
              as in NumPy; a row of a frame is a scenario
    outputs   names of variables to be read; or name of a result -> variable, or (variable, statistic)
              with a statistic of "end" (after the last step, the default), "change" (since the settling),
              "mean", "min", "max" (of the samples), "samples" (all of them: one axis more; in a frame the
              columns NAME[0], NAME[1], ...)
    settle    length of a first step that is not read; 1e6 periods where it is not given, but 0 where the
              scenarios start settled or the unit is the second
    duration  what is read after that, in samples equal steps
    unit      of settle and duration: a period of the vibration, 1 / vibration.f, or a second
    settled   start where the state tends to after infinitely many periods: initialState = Settled
    errors    "raise": BatchError with the message of the first scenario that the FMU refuses;
              "keep": its results are NaN and "reason", one result more, holds the message (else None)
    threads   that run at once; one for each processor that this process may use
    progress  True: a bar on a terminal; or a function that is told how many scenarios are finished and
              how many of them refused

    BatchError before anything runs where a name, a value or a length is wrong; it names column and row,
    counted from 0. At a KeyboardInterrupt the threads stop after their present step, and within a second
    it goes on to the caller.
    """
    batch = prepared(
        fmu, values, outputs, settle=settle, duration=duration, samples=samples, unit=unit, settled=settled
    )
    if errors not in ("raise", "keep"):
        raise BatchError(f"errors = {errors!r}: must be 'raise' or 'keep'")
    if threads is not None and not threads >= 1:
        raise BatchError(f"threads = {threads}: must be at least 1")
    with _shown(progress, batch.scenarios) as shown:
        results = batch.run(threads or processors(), errors == "raise", shown)
    if errors == "raise":
        del results["reason"]
    return _frame(results, values.index) if isinstance(values, pd.DataFrame) else results


def processors() -> int:
    """How many this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def prepared(
    fmu: str | Path | bytes,
    values: Mapping[str, npt.ArrayLike] | pd.DataFrame,
    outputs: Sequence[str] | Mapping[str, Output],
    *,
    settle: npt.ArrayLike | None = None,
    duration: npt.ArrayLike = 1.0,
    samples: int = 1,
    unit: Literal["period", "s"] = "period",
    settled: bool = False,
    times: bool = False,
    library: Path | None = None,
) -> Batch:
    """The batch of `simulate_many`, checked. times: one result more, "seconds" of processor time."""
    if unit not in ("period", "s"):
        raise BatchError(f"unit = {unit!r}: must be 'period' or 's'")
    if (
        isinstance(samples, bool)
        or not isinstance(samples, (int, np.integer))
        or not 1 <= samples <= MOST_SAMPLES
    ):
        raise BatchError(f"samples = {samples}: must be a whole number from 1 to {MOST_SAMPLES}")
    loaded = loaded_fmu(fmu, runner(library or built_runner()))
    if settle is None:
        settle = 0.0 if settled or unit == "s" else SETTLING
    starts = start_values(loaded, _settled(loaded, values) if settled else _named(values))
    spans = {"settle": numbers_of(settle, "settle", 0.0), "duration": numbers_of(duration, "duration", 0.0)}
    shape = common_shape(starts | spans)
    return Batch(
        loaded,
        shape,
        {name: flat(column, shape) for name, column in starts.items()},
        flat(spans["settle"], shape),
        flat(spans["duration"], shape),
        int(samples),
        _read(loaded, outputs),
        loaded.variable("vibration.f", "unit").valueReference if unit == "period" else None,
        times,
    )


def built_runner() -> Path:
    """The runner's library, built where it is missing."""
    path = ROOT / "build" / f"friction_batch{fmpy.sharedLibraryExtension}"
    if not path.is_file():
        build_fmu()
    return path


def _named(values: Mapping[str, npt.ArrayLike] | pd.DataFrame) -> Mapping[str, npt.ArrayLike]:
    if not isinstance(values, pd.DataFrame):
        return values
    if not values.columns.is_unique:
        name = values.columns[values.columns.duplicated()][0]
        raise BatchError(f"column {name}: is there twice")
    return {name: values[name].array for name in values.columns}


def _settled(
    fmu: LoadedFmu, values: Mapping[str, npt.ArrayLike] | pd.DataFrame
) -> Mapping[str, npt.ArrayLike]:
    fmu.variable("initialState", "settled")
    if "initialState" in values:
        raise BatchError("column initialState: settled gives it already")
    return {**_named(values), "initialState": "Settled"}


def _read(fmu: LoadedFmu, outputs: Sequence[str] | Mapping[str, Output]) -> dict[str, tuple[int, Statistic]]:
    """Name of each result -> value reference and statistic."""
    if isinstance(outputs, str):
        raise BatchError(f"outputs = {outputs!r}: must be a sequence of names, or a mapping")
    named = dict(outputs) if isinstance(outputs, Mapping) else {name: name for name in outputs}
    read = {}
    for name, output in named.items():
        variable, statistic = (output, "end") if isinstance(output, str) else output
        found = fmu.variable(variable, f"output {name}")
        if found.type != "Real":
            raise BatchError(f"output {name}: {variable} is of type {found.type}; only Real is read")
        if statistic not in STATISTICS:
            raise BatchError(f"output {name}: {statistic!r} is not one of {', '.join(STATISTICS)}")
        if name in ("reason", "seconds"):
            raise BatchError(f"output {name}: the name is taken")
        read[name] = found.valueReference, statistic
    return read


def _frame(results: Mapping[str, np.ndarray], index: pd.Index) -> pd.DataFrame:
    columns: dict[str, np.ndarray] = {}
    for name, array in results.items():
        if array.ndim == 1:
            columns[name] = array
        else:
            columns |= {f"{name}[{k}]": array[:, k] for k in range(array.shape[1])}
    return pd.DataFrame(columns, index=index)


def _shown(progress: bool | Progress, scenarios: int) -> AbstractContextManager[Progress]:
    if callable(progress):
        return nullcontext(progress)
    return _bar(scenarios) if progress else nullcontext(lambda finished, refused: None)


@contextmanager
def _bar(scenarios: int) -> Iterator[Progress]:
    """On standard error where that is a terminal: scenarios per second and time left."""
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
