"""A sweep: groups of scenarios on threads of this process or a Dask cluster, a Parquet file for each."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from numbers import Integral
from pathlib import Path

from frictioncontact import resources
from frictioncontact.batch.columns import numbers_of
from frictioncontact.batch.many import processors, shown_progress
from frictioncontact.batch.prepare import MOST_SAMPLES, check_whole
from frictioncontact.batch.unpacked import description_and_library
from frictioncontact.errors import UserError
from frictioncontact.sweeps import workers as at
from frictioncontact.sweeps.folder import Folder, Group, opened
from frictioncontact.sweeps.group import Job
from frictioncontact.sweeps.scenarios import MOST_SCENARIOS, Scenarios, drawn, from_csv, grid, with_fixed
from frictioncontact.values import Value, Variables, pairs

MOST_WORKERS = 1000
MOST_GROUP = 1_000_000  # scenarios; a worker holds its group's rows, some 300 bytes each
GROUP = 250_000  # scenarios of a group, at most; a small sweep has GROUPS of them
GROUPS = 64
MOST_FILES = 100_000


@dataclass(frozen=True)
class Swept:
    """What came of a sweep."""

    results: Path  # a folder of Parquet files, which pandas and pyarrow read as one
    good: int  # scenarios in there
    refused: int  # scenarios, with reasons, in failed.parquet and failed.csv beside it
    earlier: int  # scenarios that were there from an earlier run
    new: int
    workers: int
    elapsed: float  # s, from the first new scenario to the last
    seconds: float  # that the new scenarios took: processor time, or time on the workers of a cluster
    on_cluster: bool

    def __str__(self) -> str:
        lines = [f"{self.good} results in {self.results}"]
        if self.refused:
            failed = self.results.with_name("failed.csv")
            lines.append(f"{self.refused} failed scenarios, with reasons, in {failed}")
        if self.earlier:
            lines.append(f"{self.earlier} scenarios were there from an earlier run")
        if self.new:
            rate = self.new / self.elapsed
            spent = "on their worker" if self.on_cluster else "of processor time each"
            lines.append(
                f"{self.new} scenarios in {self.elapsed:.1f} s on {self.workers} workers: "
                f"{rate:.0f} per second, {rate / self.workers:.0f} per worker; "
                f"{1e3 * self.seconds / self.new:.3g} ms {spent}"
            )
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
    settle: float = 1e6,
    samples: int = 64,
    fresh: bool = False,
    progress: bool = False,
) -> Swept:
    """Runs the FMU to its periodic state in many scenarios; one row for each in OUTPUT/results.parquet.

    output    folder of the results; that of an unfinished sweep with the same arguments is gone on with
    fmu       another .fmu file of this model with a binary for this platform
    vary      name of an input or parameter -> its values: "a,b,c", a sequence, or "low:high:count[:log]" of
              a grid of all combinations, "low:high[:log]" of a random sweep; in SI units, items by name
    random    this many scenarios, drawn from `vary`: row k depends on seed and k alone
    csv       a file whose header names variables and whose rows are scenarios, in place of `vary`
    set       name -> value, the same in all scenarios
    workers   threads here; one for each processor that this process may use
    cluster   address of a Dask scheduler, whose workers have this package, in place of threads here
    group     scenarios of a file of the results: what a kill loses at most for each worker
    settle    periods of the vibration before the one that is read
    samples   of that period
    fresh     discard what the folder holds of a sweep
    progress  a bar on a terminal

    UserError where an argument is wrong, before anything runs, and where the output can't be written.
    """
    fmu, output = Path(fmu or resources.fmu()), Path(output)
    check_whole(samples, MOST_SAMPLES, "--samples")
    if numbers_of(settle, "--settle", 0.0).ndim:
        raise UserError(f"--settle {settle}: must be one number")
    check_whole(1 if workers is None else workers, MOST_WORKERS, "--workers")
    content = _content(fmu)
    vary, fixed = pairs(vary, "vary"), pairs(set, "set")
    scenarios = scenarios_of(f"--fmu {fmu}", content, vary, random, seed, csv, fixed)
    if group is None:
        group = min(GROUP, -(-scenarios.count // GROUPS))
    check_whole(group, MOST_GROUP, "--group")
    if scenarios.count > MOST_FILES * group:
        raise UserError(f"--group {group}: {scenarios.count} scenarios would be more than {MOST_FILES} files")
    identity = repr((scenarios.digest(), group, float(settle), samples)).encode()
    record = {
        "digest": hashlib.sha256(identity + content).hexdigest(),
        "scenarios": scenarios.count,
        "group": group,
        "variables": list(scenarios.columns),
        "settle": float(settle),
        "samples": samples,
    }
    groups = [(first, min(first + group, scenarios.count)) for first in range(0, scenarios.count, group)]
    job = Job(content, scenarios, float(settle), samples)
    hired = at.cluster(job, cluster) if cluster else at.threads(job, workers or processors())
    with hired as staff, opened(output, record, fresh) as folder:
        try:
            return _run(folder, groups, staff, progress, bool(cluster))
        except UserError as error:
            if folder.is_begun():
                raise UserError(f"{error}; {kept(output)}") from None
            raise


def kept(output: Path) -> str:
    """What is said of a sweep that ended early."""
    return f"what was computed is kept in {output}; the same sweep without --fresh goes on from there"


def _run(folder: Folder, groups: list[Group], staff: at.Workers, progress: bool, on_cluster: bool) -> Swept:
    count, missing = groups[-1][1], folder.missing(groups)
    new = sum(stop - first for first, stop in missing)
    finished, refused, seconds, lost = 0, 0, 0.0, []
    began, busy = time.perf_counter(), time.process_time()
    with shown_progress(progress, new) as show:
        for group, part in staff.run(missing):
            if part is None:
                lost.append(f"{group[0]} to {group[1] - 1}")
                continue
            folder.keep(group, part)
            finished += group[1] - group[0]
            refused += part.refused
            seconds += part.seconds
            show(finished, refused)
    elapsed = time.perf_counter() - began
    if not on_cluster:
        seconds = time.process_time() - busy
    if lost:
        raise UserError(f"every worker died that ran scenarios {', '.join(lost)}")
    folder.finish()
    bad = folder.refused()
    return Swept(
        folder.results, count - bad, bad, count - new, new, staff.count, elapsed, seconds, on_cluster
    )


def _content(fmu: Path) -> bytes:
    try:
        return fmu.read_bytes()
    except OSError as error:
        raise UserError(f"--fmu {fmu}: {error.strerror}") from None


def scenarios_of(
    name: str,
    content: bytes,
    vary: Mapping[str, str | Iterable[Value]],
    random: int | None,
    seed: int,
    csv: str | Path | None,
    fixed: Mapping[str, Value],
) -> Scenarios:
    """As `sweep` takes them; content is that of the .fmu file, and name is what messages call it."""
    if csv is None and not vary:
        raise UserError("nothing to sweep: give --vary NAME=VALUES or --csv FILE (see --help)")
    if csv is not None and (vary or random is not None):
        raise UserError("--csv does not go with --vary or --random: the file names all scenarios")
    if not isinstance(seed, Integral):
        raise UserError(f"--seed {seed}: must be a whole number")
    if seed < 0:
        raise UserError(f"--seed {seed}: must be at least 0")
    for column, values in vary.items():
        if not isinstance(values, Iterable):
            raise UserError(f"--vary {column}: {values!r} is neither a text nor a sequence of values")
    variables = Variables(description_and_library(content, name)[0])
    if csv is not None:
        scenarios = from_csv(variables, Path(csv))
    elif random is not None:
        check_whole(random, MOST_SCENARIOS, "--random")
        scenarios = drawn(variables, vary, random, seed)
    else:
        scenarios = grid(variables, vary)
    return with_fixed(variables, scenarios, fixed)
