"""Many scenarios on many processes: friction means, extremes and work over any parameters, into Parquet."""

from __future__ import annotations

import argparse
import contextlib
import hashlib
import os
import platform
import signal
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import fmpy
import numpy as np
from fmpy.model_description import ModelDescription
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.progress import Progress as Bar

from frictionlab.batch.many import built_runner
from frictionlab.batch.prepare import MOST_SAMPLES
from frictionlab.batch.unpacked import description_and_library
from frictionlab.build import build_fmu
from frictionlab.project import ROOT, UserError
from frictionlab.sweep import cluster, scenario
from frictionlab.sweep import plan as sweep_plan
from frictionlab.sweep.cluster import ClusterError
from frictionlab.sweep.plan import Scenarios
from frictionlab.sweep.scenario import RESULTS, Results
from frictionlab.sweep.shipping import shipped
from frictionlab.sweep.spans import MOST, Chunks, missing
from frictionlab.sweep.stop import Stop, held_back
from frictionlab.sweep.store import Store, opened
from frictionlab.values import Variables

DESCRIPTION = """\
Runs the FMU to its periodic state in many scenarios and writes one row for each to results.parquet.

Scenarios: every combination of the --vary values (a grid); --random N rows drawn from the --vary ranges;
or the rows of a --csv file whose header names variables. Values are in SI units; those of enumerations
are names.

  scripts/sweep --vary V=0.005:0.5:20:log --vary vibration.V_1=0:1.5:16
  scripts/sweep --random 10000 --seed 1 --vary V=1e-3:1:log --vary d=10e-6:18e-6 --set vibration.V_1=1.44
  scripts/sweep --csv scenarios.csv --scheduler tcp://10.0.0.5:8786

A sweep that was stopped, however it was, goes on when the same command is given again. Scenarios that the FMU
refuses are kept apart in failed.parquet and failed.csv, with the reason."""

EPILOG = "columns of the results:\n" + "\n".join(f"  {name:<12} {text}" for name, text in RESULTS.items())


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="scripts/sweep",
        description=DESCRIPTION,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "--vary", action="append", default=[], metavar="NAME=VALUES",
        help="a,b,c or low:high:count[:log]; with --random a,b,c or low:high[:log]",
    )  # fmt: skip
    parser.add_argument("--random", type=int, metavar="N", help="draw N scenarios instead of a grid")
    parser.add_argument("--seed", type=int, default=0, help="of --random (0)")
    parser.add_argument("--csv", type=Path, metavar="FILE", help="take the scenarios from a file")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="in all scenarios")
    parser.add_argument("--output", type=Path, help="folder of the results (build/sweep)")
    parser.add_argument("--fresh", action="store_true", help="discard what the folder holds of a sweep")
    parser.add_argument(
        "--scheduler", metavar="tcp://HOST:PORT", help="of a Dask cluster, instead of processes here"
    )
    parser.add_argument(
        "--workers", type=int, default=os.cpu_count() or 1, help="processes here (one a core)"
    )
    parser.add_argument("--chunk", type=int, help="scenarios handed out at a time (a second's work)")
    parser.add_argument("--settle", type=float, default=1e6, help="periods before the one that is read (1e6)")
    parser.add_argument("--samples", type=int, default=64, help="samples of that period (64)")
    parser.add_argument("--fmu", type=Path, help="use this FMU instead of building one")
    parser.add_argument("--quick", action="store_true", help="a grid of 16 x 12 scenarios, afresh")
    options = parser.parse_args(argv)
    if options.quick:
        options.fresh = True
        options.vary = options.vary or ["V=0.005:0.5:16:log", "vibration.V_1=0:1.44:12"]
    options.output = options.output or ROOT / "build" / ("sweep-quick" if options.quick else "sweep")
    return options


def scenarios_of(options: argparse.Namespace, fmu: Path) -> Scenarios:
    for name, least, most in (
        ("workers", 1, 1000),
        ("chunk", 1, MOST),
        ("settle", 0, sys.float_info.max),
        ("samples", 1, MOST_SAMPLES),
        ("random", 1, sweep_plan.MOST_SCENARIOS),
        ("seed", 0, sys.maxsize),
    ):
        value = getattr(options, name)
        if value is not None and not least <= value <= most:
            bound = f"at least {least}" if not value >= least else f"at most {most}"
            raise UserError(f"--{name} {value}: must be {bound}")
    if not options.csv and not options.vary:
        raise UserError("nothing to sweep: give --vary NAME=VALUES or --csv FILE (see --help)")
    if options.csv and (options.vary or options.random):
        raise UserError("--csv does not go with --vary or --random: the file names all scenarios")
    variables = Variables(described(fmu))
    if options.csv:
        scenarios = sweep_plan.from_csv(variables, options.csv)
    elif options.random:
        scenarios = sweep_plan.random(variables, options.vary, options.random, options.seed)
    else:
        scenarios = sweep_plan.grid(variables, options.vary)
    return sweep_plan.with_fixed(variables, scenarios, options.set)


def described(fmu: Path) -> ModelDescription:
    try:
        content = fmu.read_bytes()
    except OSError as error:
        raise UserError(f"--fmu {fmu}: {error.strerror}") from None
    return description_and_library(content, f"--fmu {fmu}")[0]


def sweep(options: argparse.Namespace, console: Console) -> str:
    """Runs it, or the rest of it, and says in a few words what came of it."""
    fmu = options.fmu or build_fmu()
    scenarios = scenarios_of(options, fmu)
    content = fmu.read_bytes()
    plan = {
        "digest": hashlib.sha256(
            repr((scenarios.digest(), options.settle, options.samples)).encode() + content
        ).hexdigest(),
        "scenarios": scenarios.count,
        "variables": list(scenarios.columns),
        "settle": options.settle,
        "samples": options.samples,
        "python": platform.python_version(),
        "machine": platform.machine(),
    }
    runner = built_runner().read_bytes()
    with held_back() as stop, opened(options.output, plan, options.fresh) as store:
        stop.check()
        if store.is_whole():
            good, bad = store.counts()
            return f"nothing to do: {options.output} holds all {good} results ({bad} failed scenarios apart)"
        return _run(options, console, store, scenarios, (content, runner), stop)


@dataclass
class Progress:
    """How far a sweep is: scenarios from an earlier run, and those of this one."""

    total: int
    earlier: int
    new: int = 0
    failed: int = 0
    seconds: float = 0.0  # that the scenarios took on the workers
    elapsed: float = 0.0  # s

    def add(self, results: Results) -> None:
        self.new += len(results.columns["seconds"])
        self.failed += len(results.reasons)
        self.seconds += float(np.nansum(results.columns["seconds"]))


def _run(
    options: argparse.Namespace,
    console: Console,
    store: Store,
    scenarios: Scenarios,
    files: tuple[bytes, bytes],
    stop: Stop,
) -> str:
    """files: the FMU and the batch runner."""
    missing_spans = missing(scenarios.count, store.done())
    progress = Progress(scenarios.count, scenarios.count - sum(stop - first for first, stop in missing_spans))
    with (
        _bar(console, progress) as show,
        cluster.connected(options.scheduler, options.workers, store.work) as client,
    ):
        code = shipped(client, store.work) if options.scheduler else scenario
        stop.check()
        work = code.Work(*files, fmpy.platform, options.settle, options.samples)
        cores = sum(client.nthreads().values())
        chunks = Chunks(missing_spans, options.chunk, cores)
        begin = time.perf_counter()
        for span, results in cluster.run(
            client, code.run_chunk, work, lambda span: scenarios.rows(*span), chunks, stop
        ):
            store.keep(span, scenarios.shown(*span), results)
            progress.add(results)
            progress.elapsed = time.perf_counter() - begin
            show()
    good, bad = store.finish(list(RESULTS), stop.check)
    lines = [f"{good} results in {store.folder / 'results.parquet'}"]
    if bad:
        lines.append(f"{bad} failed scenarios, with reasons, in {store.folder / 'failed.csv'}")
    if progress.earlier:
        lines.append(f"{progress.earlier} scenarios were there from an earlier run")
    if progress.new:
        rate = progress.new / progress.elapsed
        lines.append(
            f"{progress.new} scenarios in {progress.elapsed:.1f} s on {cores} workers: "
            f"{rate:.0f} per second, {rate / cores:.0f} per worker; "
            f"{1e3 * progress.seconds / progress.new:.3g} ms each"
        )
    return "\n".join(lines)


@contextlib.contextmanager
def _bar(console: Console, progress: Progress) -> Iterator[Callable[[], None]]:
    """A bar on a terminal, and a function that brings it up to date."""
    columns = (
        TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(),
        TimeElapsedColumn(), TimeRemainingColumn(), TextColumn("{task.fields[said]}"),
    )  # fmt: skip
    with Bar(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("Sweeping", total=progress.total, completed=progress.earlier, said="")

        def show() -> None:
            said = f"{progress.new / progress.elapsed:.0f} per second"
            if progress.failed:
                said += f", {progress.failed} failed"
            bar.update(task, completed=progress.earlier + progress.new, said=said)

        yield show


def main(argv: Sequence[str] | None = None) -> None:
    options = arguments(argv)
    console = Console(stderr=True)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    again = (
        f"what was computed is kept in {options.output}; the same command without --fresh goes on from there"
    )
    try:
        print(sweep(options, console))
    except ClusterError as error:
        sys.exit(f"error: {error}; {again}")
    except UserError as error:
        sys.exit(f"error: {error}")
    except KeyboardInterrupt:
        sys.exit(f"stopped; {again}")


if __name__ == "__main__":
    main()
