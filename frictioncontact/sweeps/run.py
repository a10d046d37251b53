"""A sweep: groups of scenarios on threads of this process or a Dask cluster, a Parquet file for each."""

import argparse
import hashlib
import json
import signal
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from numbers import Integral
from pathlib import Path

from frictioncontact import resources
from frictioncontact.batch.many import MAX_SAMPLES, processors, shown_progress
from frictioncontact.command import add_fmu, command_line, finish
from frictioncontact.errors import UserError
from frictioncontact.fmu import opened
from frictioncontact.plausibility import warn_of
from frictioncontact.sweeps import workers as at
from frictioncontact.sweeps.folder import Folder
from frictioncontact.sweeps.scenarios import Scenarios, Vary, drawn, from_csv, grid
from frictioncontact.sweeps.workers import Group, Job
from frictioncontact.values import Value, Variables, assignments, check_whole, pairs, path_of

MAX_WORKERS = 1000
MAX_GROUP = 1_000_000  # scenarios; a worker holds its group's rows, some 300 bytes each
GROUP = 250_000  # scenarios of a group, at most; a small sweep has GROUPS of them
GROUPS = 64
MAX_FILES = 100_000


@dataclass(frozen=True)
class Swept:
    """The results of a sweep."""

    results: Path  # a folder of Parquet files, which pandas and pyarrow read as one
    good: int  # scenarios in there
    refused: int  # scenarios, with reasons, in failed.parquet beside it
    new: int  # scenarios that were not there from an earlier run
    workers: int
    elapsed: float  # s, from the first new scenario to the last
    processor: float | None  # s, of this process meanwhile; None on a cluster

    def __str__(self) -> str:
        lines = [f"{self.good} results in {self.results}"]
        if self.refused:
            failed = self.results.with_name("failed.parquet")
            lines.append(f"{self.refused} failed scenarios, with reasons, in {failed}")
        if earlier := self.good + self.refused - self.new:
            lines.append(f"{earlier} scenarios were there from an earlier run")
        if self.new:
            rate = self.new / self.elapsed
            lines.append(
                f"{self.new} scenarios in {self.elapsed:.1f} s on {self.workers} workers: "
                f"{rate:.0f} per second, {rate / self.workers:.0f} per worker"
            )
            if self.processor is not None:
                lines[-1] += f"; {1e3 * self.processor / self.new:.3g} ms of processor time each"
        return "\n".join(lines)


def sweep(
    *,
    output: str | Path,
    fmu: str | Path | None = None,
    vary: Mapping[str, str | Iterable[Value]] | None = None,
    random: int | None = None,
    seed: int = 0,
    csv: str | Path | None = None,
    set: Mapping[str, Value] | None = None,
    workers: int | None = None,
    cluster: str | None = None,
    group: int | None = None,
    samples: int = 64,
    fresh: bool = False,
    progress: bool = False,
) -> Swept:
    """Runs the FMU over a period of the vibration in many scenarios; one row each in OUTPUT/results.parquet.

    They start settled, unless initialState is among their values. Needs the extra frictioncontact[sweep].

    output    folder of the results; an unfinished sweep with the same arguments continues
    fmu       another .fmu file of this model with a binary for this platform
    vary      name of an input or parameter -> its values: "a,b,c", a sequence, or "low:high:count[:log]" of
              a grid of all combinations, "low:high[:log]" of a random sweep; SI units, of an enumeration
              items or their numbers
    random    this many scenarios, drawn from `vary`: row k depends on seed and k alone
    csv       a file whose header names variables, or also their units, "V [mm/s]", and whose rows are
              scenarios, in place of `vary`
    set       name -> value, the same in all scenarios
    workers   threads here; one for each processor that this process may use
    cluster   address of a Dask scheduler, whose workers have this package, in place of threads here
    group     number of scenarios in a file of results; a kill loses at most one group of each worker
    samples   steps of the period
    fresh     discard an earlier sweep in the folder
    progress  a bar on a terminal
    returns   a `Swept`: the place of the results, and their cost
    raises    UserError: an argument is wrong, before anything runs; the output can't be written
    warns     FrictionWarning: of a setting that has no effect in any scenario; of an unlikely magnitude

        import pandas as pd
        import frictioncontact as fc
        swept = fc.sweep(output="sweep", vary={"V": "0.01:1:20:log"}, set={"vibration.V_1": 1.44})
        print(pd.read_parquet(swept.results)[["V", "F_mean", "reduction"]])
    """
    if find_spec("pyarrow") is None:
        raise UserError("sweeps need pyarrow: pip install 'frictioncontact[sweep]'")
    fmu = resources.fmu() if fmu is None else path_of(fmu, "fmu")
    output = path_of(output, "output")
    csv = None if csv is None else path_of(csv, "csv")
    check_whole(samples, MAX_SAMPLES, "samples")
    check_whole(1 if workers is None else workers, MAX_WORKERS, "workers")
    content = _content(f"fmu {fmu}", fmu)
    variables = opened(fmu).known
    vary = {name: _listed(name, values) for name, values in pairs(vary, "vary").items()}
    scenarios = _scenarios(variables, vary, random, seed, csv)
    count, rows = scenarios.count, scenarios.rows
    texts = {name: str(value) for name, value in pairs(set, "set").items()}
    fixed = {name: variables.text(name, text, f"set {name}") for name, text in texts.items()}
    for name in fixed.keys() & scenarios.seen:
        raise UserError(f"set {name}: is given twice")
    warn_of(variables, {**scenarios.seen, **fixed}, is_over_period=True)
    if group is None:
        group = min(GROUP, -(-count // GROUPS))
    check_whole(group, MAX_GROUP, "group")
    if count > MAX_FILES * group:
        raise UserError(f"group {group}: {count} scenarios would be more than {MAX_FILES} files")
    record = {
        "fmu": hashlib.sha256(content).hexdigest(),
        "vary": vary, "random": random, "seed": seed,
        "csv": hashlib.sha256(_content("csv", csv)).hexdigest() if csv else None,
        "set": fixed, "scenarios": count, "group": group, "samples": samples,
    }  # fmt: skip
    job = Job(content, rows, fixed, samples)
    groups = [(first, min(first + group, count)) for first in range(0, count, group)]
    hired = at.cluster(job, cluster) if cluster else at.threads(job, workers or processors())
    with hired as staff:
        folder = Folder(output, json.dumps(record, default=str) + "\n", fresh)
        missing = folder.missing(groups)
        began, busy = time.perf_counter(), time.process_time()
        new = _run(folder, missing, staff, progress)
        elapsed, busy = time.perf_counter() - began, time.process_time() - busy
        bad = folder.finish()
    return Swept(folder.results, count - bad, bad, new, staff.count, elapsed, None if cluster else busy)


def _run(folder: Folder, groups: list[Group], staff: at.Workers, progress: bool) -> int:
    """How many scenarios there were."""
    finished = refused = 0
    with shown_progress(progress, sum(stop - first for first, stop in groups)) as show:
        for group, part in staff.run(groups):
            folder.keep(group, part)
            finished += group[1] - group[0]
            refused += part.refused
            show(finished, refused)
    return finished


def _content(name: str, path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise UserError(f"{name}: {error.strerror}") from None


def _listed(name: str, values: str | Iterable[Value]) -> str | list[Value]:
    try:
        return values if isinstance(values, str) else list(values)
    except TypeError:
        raise UserError(f"vary {name}: {values!r} is neither a text nor a sequence of values") from None


def _scenarios(
    variables: Variables, vary: Vary, random: int | None, seed: int, csv: Path | None
) -> Scenarios:
    if not isinstance(seed, Integral) or isinstance(seed, bool) or seed < 0:
        raise UserError(f"seed {seed}: must be a whole number from 0")
    if csv is not None:
        if vary or random is not None:
            raise UserError("csv does not go with vary or random: the file names all scenarios")
        return from_csv(variables, csv)
    if not vary:
        raise UserError("nothing to sweep: give vary or csv")
    return grid(variables, vary) if random is None else drawn(variables, vary, random, seed)


DESCRIPTION = """\
Runs the FMU over a settled period of the vibration in many scenarios and writes one row for each to
results.parquet, a folder of files that pandas.read_parquet reads as one. With static friction the settled
state may last several periods: F_mean and reduction are over all of them, the other columns over the first.

Scenarios: every combination of the --vary values (a grid); --random N rows drawn from the --vary ranges;
or the rows of a --csv file whose header names variables. Values are in SI units, in a file also in those of
a heading "V [mm/s]"; those of enumerations are items or their numbers.

  %(prog)s --vary V=0.005:0.5:20:log --vary vibration.V_1=0:1.5:16
  %(prog)s --random 10000 --seed 1 --vary V=1e-3:1:log --vary d=10e-6:18e-6 --set vibration.V_1=1.44
  %(prog)s --csv scenarios.csv --cluster tcp://10.0.0.5:8786

A sweep that was stopped, however it was, goes on when the same command is given again. Scenarios that the FMU
refuses are kept apart in failed.parquet, with the reason."""


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    columns = ["columns of the results:", *(f"  {name:<12} {text}" for name, (_, text) in at.RESULTS.items())]
    parser = command_line("frictioncontact sweep", DESCRIPTION, "\n".join(columns))
    add = parser.add_argument
    add("--vary", action="append", default=[], metavar="NAME=VALUES",
        help="a,b,c or low:high:count[:log]; with --random a,b,c or low:high[:log]")  # fmt: skip
    add("--random", type=int, metavar="N", help="draw N scenarios instead of a grid")
    add("--seed", type=int, default=0, help="of --random (0)")
    add("--csv", type=Path, metavar="FILE", help="take the scenarios from a file")
    add("--set", action="append", default=[], metavar="NAME=VALUE", help="in all scenarios")
    add("--output", type=Path, help="folder of the results (sweep)")
    add("--fresh", action="store_true", help="discard what the folder holds of a sweep")
    add("--cluster", metavar="tcp://HOST:PORT",
        help="scheduler of a Dask cluster that has this package, instead of threads here")  # fmt: skip
    add("--workers", type=int, default=processors(), help="threads here (one a processor)")
    add("--group", type=int, metavar="N",
        help="scenarios of a file, which a kill loses (a 64th of the sweep, at most 250000)")  # fmt: skip
    add("--samples", type=int, default=64, help="samples of the period (64)")
    add_fmu(parser)
    add("--quick", action="store_true", help="a grid of 16 x 12 scenarios, afresh")
    options = parser.parse_args(argv)
    if options.quick:
        options.fresh = True
        options.vary = options.vary or ["V=0.005:0.5:16:log", "vibration.V_1=0:1.44:12"]
    options.output = options.output or resources.output("sweep-quick" if options.quick else "sweep")
    return options


def wanted(options: argparse.Namespace) -> dict[str, object]:
    """The arguments of `sweep`."""
    given = {name: value for name, value in vars(options).items() if name != "quick"}
    return given | {name: assignments(given[name], f"--{name}") for name in ("vary", "set")}


def run(options: argparse.Namespace) -> None:
    print(sweep(progress=True, **wanted(options)))


def main(argv: Sequence[str] | None = None) -> None:
    options = arguments(argv)
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # ends like Control-C
    try:
        finish(run, options)
    except KeyboardInterrupt:
        raise KeyboardInterrupt(f"stopped; {at.GOES_ON}") from None
