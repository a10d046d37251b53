"""Many scenarios on many processors: friction means, extremes and work over any parameters, into Parquet."""

import argparse
import signal
from collections.abc import Sequence
from pathlib import Path

from frictioncontact import resources
from frictioncontact.batch.many import processors
from frictioncontact.command import add_fmu, command_line, finish
from frictioncontact.sweeps.group import RESULTS
from frictioncontact.sweeps.run import sweep
from frictioncontact.sweeps.workers import GOES_ON
from frictioncontact.values import assignments

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

COLUMNS = [f"  {name:<12} {text}" for name, (_, text) in RESULTS.items()]


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = command_line(
        "frictioncontact sweep", DESCRIPTION, "\n".join(["columns of the results:", *COLUMNS])
    )
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
        raise KeyboardInterrupt(f"stopped; {GOES_ON}") from None
