"""The main job: simulates the six rows of Table 2 through fmpy and prints the table."""

import argparse
from collections.abc import Sequence

from rich.table import Table

from frictioncontact import resources
from frictioncontact.command import (
    add_fmu,
    add_output,
    as_table,
    can_draw,
    command_line,
    progress_bar,
    say_written,
    shown,
    table_console,
    write_csv,
)
from frictioncontact.fmu import FrictionFmu
from frictioncontact.parameters import IDENTIFIED, PRINTED, STIFFNESS_PRINTED, TABLE_2
from frictioncontact.periodic import reduction
from frictioncontact.table2.rows import Result, csv_rows, results

DESCRIPTION = """\
Simulates the six rows of the paper's Table 2 with the FMU through fmpy, and prints the mean friction force
of each row three times: as the paper prints it; exactly, as Eq. 1-2 give it at the printed parameters; and
identified, with a stiffness and a phase fitted to the table's three informative rows. Writes table2.csv and
table2.png."""


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = command_line("frictioncontact table2", DESCRIPTION)
    parser.add_argument("--quick", action="store_true", help="the table and table2.csv, without the picture")
    add_fmu(parser)
    add_output(parser, resources.output())
    return parser.parse_args(argv)


def run(options: argparse.Namespace) -> None:
    options.output.mkdir(parents=True, exist_ok=True)
    with progress_bar() as progress:
        path = options.fmu or resources.fmu()
        written = [options.output / "table2.csv"]
        with FrictionFmu(path) as fmu:
            task = progress.add_task("Simulating Table 2", total=len(TABLE_2) + 1)
            table = []
            for result in results(fmu):
                table.append(result)
                progress.advance(task)
            write_csv(csv_rows(table), written[0])
            if not options.quick and can_draw():
                progress.update(task, description="Drawing")
                written.append(options.output / "table2.png")
                from frictioncontact.table2 import figure  # takes a second, which --quick saves

                figure.draw(fmu, table, written[1])
    table_console().print(as_text(table))
    print(remarks())
    print("FMU:", shown(path))
    say_written(written)


def as_text(table: Sequence[Result]) -> Table:
    """The table as it is printed: mean forces, and beside each its reduction against row 1."""
    headings = ["row", "E_1", "a_d [um]", "V_1 [m/s]", "paper", "%", "exact", "%", "identified", "%"]
    rows, first = [], table[0]
    for result in table:
        row = result.row
        rows.append(
            [
                str(row.number),
                "-30 %" if row.softened else "",
                f"{1e6 * row.a_d:.1f}" if row.a_d else "",
                f"{row.V_1:.2f}" if row.V_1 else "",
                f"{row.paper_force:.0f}",
                f"{row.paper_reduction:.0f}",
                f"{result.exact:.4f}",
                percent(result.exact, first.exact),
                f"{result.identified:.2f}",
                percent(result.identified, first.identified),
            ]
        )
    title = "Table 2: mean friction force [N] and its reduction against row 1"
    return as_table(headings, rows, title, names=0)


def percent(mean: float, without: float) -> str:
    return f"{round(reduction(mean, without), 1) + 0.0:.1f}"  # + 0.0: no minus zero


def remarks() -> str:
    printed = f"{STIFFNESS_PRINTED:.4g} N/m, V {PRINTED.V} m/s, phase {PRINTED.phase_d:g} deg"
    fitted = f"{IDENTIFIED.stiffness / 1e6:.4f} MN/m, phase {IDENTIFIED.phase_d} deg"
    return f"""\
paper       as printed
exact       Eq. 1-2 at the printed parameters: {printed}
identified  Eq. 1-2 with {fitted}, and V {IDENTIFIED.V} m/s, the velocity of Fig. 3-4.
            Stiffness, phase and V are three numbers adjusted to three informative rows (2, 3, 6): the
            equations can reach these rows, which does not show that they are right. Rows 4 and 5
            are out of their reach: with V constant and positive the mean is F_C.
"""
