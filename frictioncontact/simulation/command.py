"""One scene over time: a table on the terminal, or a CSV file."""

import argparse
from collections.abc import Sequence
from pathlib import Path

from frictioncontact.command import (
    add_column,
    add_fmu,
    add_set,
    command_line,
    new_file,
    print_frame,
    say_written,
)
from frictioncontact.files import write_whole
from frictioncontact.fmu import INPUTS, OUTPUTS, opened
from frictioncontact.simulation.run import simulate
from frictioncontact.values import assignments

DESCRIPTION = """\
Simulates one scene from time 0 on and prints a row for each step, or writes them to a CSV file, whose
headings are the names alone. All values are in SI units, as in the FMU; what is not set has the FMU's start
value.

  %(prog)s --set V=0.5 --set vibration.V_1=1.44 --stop 1e-3 --step 5e-5
  %(prog)s --inputs drive.csv --stop 2 --step 1e-3 --outputs F_t_mean W_f --output out.csv"""


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = command_line("frictioncontact simulate", DESCRIPTION)
    add_set(parser, "of the scene")
    parser.add_argument("--stop", type=float, required=True, help="end, s")
    parser.add_argument("--step", type=float, required=True, help="time between two rows, s")
    parser.add_argument(
        "--inputs", type=Path, metavar="CSV",
        help=f"columns time and any of {', '.join(INPUTS)}, or position; linear between their samples; in SI "
        "units, or with a unit as 'V [mm/s]'",
    )  # fmt: skip
    add_column(parser)
    parser.add_argument(
        "--outputs", nargs="+", default=OUTPUTS, metavar="NAME", help=f"variables ({' '.join(OUTPUTS)})"
    )
    parser.add_argument("--output", type=new_file, metavar="CSV", help="file to write to")
    add_fmu(parser)
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
        say_written([options.output])
    else:
        print_frame(table, fmu.known, scene)
