"""Many scenarios on many processes: friction means, extremes and work over any parameters, into Parquet."""

from __future__ import annotations

import argparse
import os
import platform
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import pandas as pd
from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from frictionlab.build import BuildError, build_fmu
from frictionlab.project import ROOT
from frictionlab.sweep import cluster as sweep_cluster
from frictionlab.sweep import plan as sweep_plan
from frictionlab.sweep.cluster import ClusterError, Numbered
from frictionlab.sweep.plan import PlanError, Variables
from frictionlab.sweep.scenario import RESULTS, Sampling
from frictionlab.sweep.shipping import shipped
from frictionlab.sweep.store import Store, digest, opened

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
    parser.add_argument("--chunk", type=int, default=100, help="scenarios handed out at a time (100)")
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


def scenarios_of(options: argparse.Namespace, fmu: Path) -> pd.DataFrame:
    for name, least in (
        ("workers", 1),
        ("chunk", 1),
        ("settle", 0),
        ("samples", 1),
        ("random", 1),
        ("seed", 0),
    ):
        value = getattr(options, name)
        if value is not None and not value >= least:
            raise PlanError(f"--{name} {value}: must be at least {least}")
    if not options.csv and not options.vary:
        raise PlanError("nothing to sweep: give --vary NAME=VALUES or --csv FILE (see --help)")
    if options.csv and (options.vary or options.random):
        raise PlanError("--csv does not go with --vary or --random: the file names all scenarios")
    if not fmu.is_file():
        raise PlanError(f"--fmu {fmu}: is not there")
    variables = Variables(fmu)
    if options.csv:
        scenarios = sweep_plan.from_csv(variables, options.csv)
    elif options.random:
        scenarios = sweep_plan.random(variables, options.vary, options.random, options.seed)
    else:
        scenarios = sweep_plan.grid(variables, options.vary)
    return sweep_plan.with_fixed(variables, scenarios, options.set)


def chunks_of(scenarios: pd.DataFrame, done: set[int], size: int) -> list[Numbered]:
    todo = [(k, values) for k, values in enumerate(sweep_plan.records(scenarios)) if k not in done]
    return [todo[k : k + size] for k in range(0, len(todo), size)]


def sweep(options: argparse.Namespace, console: Console) -> str:
    """Runs it, or the rest of it, and says in a few words what came of it."""
    fmu = options.fmu or build_fmu()
    scenarios = scenarios_of(options, fmu)
    content, sampling = fmu.read_bytes(), Sampling(options.settle, options.samples)
    plan = {
        "digest": digest(scenarios, content, sampling),
        "scenarios": len(scenarios),
        "variables": list(scenarios.columns),
        "settle": options.settle,
        "samples": options.samples,
        "python": platform.python_version(),
        "machine": platform.machine(),
    }
    with opened(options.output, plan, options.fresh) as store:
        if store.is_whole():
            good, bad = store.counts()
            return f"nothing to do: {options.output} holds all {good} results ({bad} failed scenarios apart)"
        return _run(options, console, store, scenarios, content, sampling)


def _run(
    options: argparse.Namespace,
    console: Console,
    store: Store,
    scenarios: pd.DataFrame,
    content: bytes,
    sampling: Sampling,
) -> str:
    columns = (
        TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(),
        TimeElapsedColumn(), TimeRemainingColumn(), TextColumn("{task.fields[failed]}"),
    )  # fmt: skip
    done = store.done()
    chunks = chunks_of(scenarios, done, options.chunk)
    new, failed, seconds = len(scenarios) - len(done), 0, 0.0
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as progress:
        task = progress.add_task("Sweeping", total=len(scenarios), completed=len(done), failed="")
        with sweep_cluster.connected(options.scheduler, options.workers) as client:
            cores = sum(client.nthreads().values())
            begin = time.perf_counter()
            for rows in sweep_cluster.run(client, shipped(sampling), content, chunks):
                store.keep(rows)
                failed += sum("reason" in row for row in rows)
                seconds += sum(row.get("seconds", 0.0) for row in rows)
                progress.update(task, advance=len(rows), failed=f"{failed} failed" if failed else "")
            elapsed = time.perf_counter() - begin
    good, bad = store.finish([*scenarios.columns, *RESULTS])
    lines = [f"{good} results in {store.folder / 'results.parquet'}"]
    if bad:
        lines.append(f"{bad} failed scenarios, with reasons, in {store.folder / 'failed.csv'}")
    if done:
        lines.append(f"{len(done)} scenarios were there from an earlier run")
    if new:
        lines.append(
            f"{new} scenarios in {elapsed:.1f} s on {cores} workers: {new / elapsed:.0f} per second, "
            f"{new / elapsed / cores:.0f} per worker; {1e3 * seconds / new:.2f} ms of processor time each"
        )
    return "\n".join(lines)


def main(argv: Sequence[str] | None = None) -> None:
    options = arguments(argv)
    console = Console(stderr=True)
    again = (
        f"what was computed is kept in {options.output}; the same command without --fresh goes on from there"
    )
    try:
        print(sweep(options, console))
    except (BuildError, PlanError) as error:
        sys.exit(f"error: {error}")
    except ClusterError as error:
        sys.exit(f"error: {error}; {again}")
    except KeyboardInterrupt:
        sys.exit(f"stopped; {again}")


if __name__ == "__main__":
    main()
