"""Many scenarios of an FMU in one call.

    simulate_many({"V": V[:, None], "contact.stiffnessScale": scale},
                  {"mean": "F_t_mean", "least": ("F_t", "min"), "work": ("W_f", "change")}, samples=64)

gives arrays "mean", "least" and "work" of the shape that V[:, None] and scale broadcast to.

The scenarios run in host/batch.c through the FMI functions of the FMU itself, on threads of this process.
"""

from __future__ import annotations

import os
import time
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt

from .. import resources
from ..doubts import warn_of
from ..errors import BatchError, UserError
from .prepare import Outputs, Unit, check_whole, prepared
from .run import Progress
from .runner import runner
from .unpacked import loaded_fmu

if TYPE_CHECKING:
    import pandas as pd

MOST_THREADS = 1024


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
    if errors not in ("raise", "keep"):
        raise BatchError(f"errors = {errors!r}: must be 'raise' or 'keep'")
    if threads is not None:
        check_whole(threads, MOST_THREADS, "threads =")
    try:
        loaded = loaded_fmu(resources.fmu() if fmu is None else fmu, runner(resources.batch_host()))
        batch = prepared(
            loaded, values, outputs, settle, duration, samples, unit, settled, inputs, rates, steps, begin
        )
    except UserError as error:
        raise BatchError(str(error)) from None
    warn_of(loaded.variables, batch.starts | (inputs or {}), is_over_period=unit == "period")
    with shown_progress(progress, batch.scenarios) as shown:
        results = batch.run(threads or processors(), errors == "raise", shown)
    if errors == "raise":
        del results["reason"]
    return _frame(results, values.index) if not isinstance(values, Mapping) else results


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
