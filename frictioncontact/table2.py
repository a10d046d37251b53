"""Table 2 of the paper from the FMU: the mean friction force of its six rows, and the force over time.

Three numbers a row. The paper's; the exact one, which is what Eq. 1-2 give at the printed parameters; and the
identified one, with three numbers (stiffness, phase, V) adjusted to the three informative rows. The last
shows that the equations can reach those rows. It does not show that they are right.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from rich.table import Table

from frictioncontact import command as shared
from frictioncontact import parameters as paper
from frictioncontact.fmu import FrictionFmu, opened
from frictioncontact.parameters import IDENTIFIED, PRINTED, TABLE_2, ParameterSet, Row
from frictioncontact.periodic import periodic_mean, periodic_waves, reduction

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DESCRIPTION = """\
Simulates the six rows of the paper's Table 2 with the FMU through fmpy, and prints the mean friction force
of each row three times: as the paper prints it; exactly, as Eq. 1-2 give it at the printed parameters; and
identified, with a stiffness and a phase fitted to the table's three informative rows. With --output it also
writes table2.csv and table2.png."""

REMARKS = f"""\
paper       as printed
exact       Eq. 1-2 at the printed parameters: {PRINTED.stiffness:.4g} N/m, V {PRINTED.V} m/s, phase 0 deg
identified  Eq. 1-2 with {IDENTIFIED.stiffness / 1e6:.4f} MN/m, phase {IDENTIFIED.phase_d} deg, and V \
{IDENTIFIED.V} m/s, the velocity of Fig. 3-4.
            Stiffness, phase and V are three numbers adjusted to three informative rows (2, 3, 6): the
            equations can reach these rows, which does not show that they are right. Rows 4 and 5
            are out of their reach: with V constant and positive the mean is F_C.
"""
PARAMETERS = {"exact": PRINTED, "identified": IDENTIFIED}
LABELS = {
    "paper": "paper, as printed",
    "exact": "Eq. 1–2 at the printed parameters",
    "identified": "Eq. 1–2 with stiffness and phase fitted to rows 2, 3, 6",
}


@dataclass(frozen=True)
class Result:
    """One row of Table 2: mean forces in N."""

    row: Row
    exact: float
    identified: float


def results(fmu: FrictionFmu) -> Iterator[Result]:
    """The six rows, one after the other."""
    for row in TABLE_2:
        yield Result(row, mean_force(fmu, row, PRINTED), mean_force(fmu, row, IDENTIFIED))


def mean_force(fmu: FrictionFmu, row: Row, parameters: ParameterSet) -> float:
    """Time mean of F_t [N] in the periodic state."""
    return periodic_mean(fmu, paper.start_values(row, parameters))


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = shared.command_line("frictioncontact table2", DESCRIPTION)
    parser.add_argument("--quick", action="store_true", help="no picture")
    shared.add_fmu(parser)
    parser.add_argument("--output", type=Path, help="folder to write to, made if missing; else nothing is")
    return parser.parse_args(argv)


def run(options: argparse.Namespace) -> None:
    written = []
    with shared.progress_bar() as progress:
        fmu = opened(options.fmu)
        task = progress.add_task("Simulating Table 2", total=len(TABLE_2) + 1)
        table = []
        for result in results(fmu):
            table.append(result)
            progress.advance(task)
        if options.output:
            written.append(shared.write_csv(csv_rows(table), options.output / "table2.csv"))
        if options.output and not options.quick and shared.can_draw():
            progress.update(task, description="Drawing")
            written.append(options.output / "table2.png")
            draw(fmu, table, written[1])
    shared.table_console().print(as_text(table))
    print(REMARKS)
    print("FMU:", shared.shown(fmu.path))
    shared.say_written(written)


def csv_rows(table: Sequence[Result]) -> list[dict[str, float]]:
    """One row of table2.csv for each of the table."""
    first = table[0]
    return [
        {
            "row": result.row.number,
            "E_1_reduction_percent": 100.0 * paper.E_1_REDUCTION * result.row.softened,
            "a_d_um": round(1e6 * result.row.a_d, 6),
            "V_1_m_per_s": result.row.V_1,
            "paper_N": result.row.paper_force,
            "paper_reduction_percent": result.row.paper_reduction,
            "exact_N": result.exact,
            "exact_reduction_percent": reduction(result.exact, first.exact),
            "identified_N": result.identified,
            "identified_reduction_percent": reduction(result.identified, first.identified),
        }
        for result in table
    ]


def as_text(table: Sequence[Result]) -> Table:
    """The table as it is printed: mean forces, and beside each its reduction against row 1."""
    headings = ["row", "E_1", "a_d [um]", "V_1 [m/s]", "paper", "%", "exact", "%", "identified", "%"]
    first = table[0]
    rows = [
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
        for result, row in ((result, result.row) for result in table)
    ]
    title = "Table 2: mean friction force [N] and its reduction against row 1"
    return shared.as_table(headings, rows, title, names=0)


def percent(mean: float, without: float) -> str:
    return f"{round(reduction(mean, without), 1) + 0.0:.1f}"  # + 0.0: no minus zero


def conditions(row: Row) -> str:
    """What is switched on in a row, for headings."""
    parts = []
    if row.softened:
        parts.append(f"$E_1$ −{100 * paper.E_1_REDUCTION:.0f} %")
    if row.a_d:
        parts.append(f"$a_d$ {1e6 * row.a_d:.1f} µm")
    if row.V_1:
        parts.append(f"$V_1$ {row.V_1:.2f} m/s")
    return ", ".join(parts) or "no vibration"


def draw(fmu: FrictionFmu, table: Sequence[Result], *paths: Path) -> None:
    """Writes the picture under each path: friction over time, and the means against the paper's."""
    from matplotlib.lines import Line2D

    from frictioncontact import style

    figure, axes = style.subplots(4, 2, size=(5.2, 9.6), gridspec_kw={"height_ratios": [1.0, 1.0, 1.0, 2.2]})
    for panel, result in zip(axes[:3].flat, table, strict=True):
        _draw_waves(panel, fmu, result)
    for panel in axes[:3, 0]:
        panel.set_ylabel("$F_t$ [N]")
    for panel in axes[:3, 1]:
        panel.tick_params(labelleft=False)
    for panel in axes[2]:
        panel.set_xlabel("time in a period [µs]")
    grid = axes[3, 0].get_gridspec()
    for panel in axes[3]:
        panel.remove()
    _draw_means(figure.add_subplot(grid[3, :]), table)
    handles = [
        Line2D([], [], color=style.SOURCE[name], lw=2.0, ls=":" if name == "paper" else "-", label=label)
        for name, label in LABELS.items()
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=1, fontsize=10)
    style.save(figure, *paths)


def _draw_waves(axes: Axes, fmu: FrictionFmu, result: Result) -> None:
    from frictioncontact import style

    for name, parameters in PARAMETERS.items():
        run = periodic_waves(fmu, paper.start_values(result.row, parameters), ("F_t",), samples=400)
        axes.plot(1e6 * run["time"], run["F_t"], color=style.SOURCE[name], lw=1.7)
    axes.axhline(result.row.paper_force, color=style.SOURCE["paper"], ls=":", lw=1.8)
    axes.axhline(0.0, color=style.GREY, lw=0.8, zorder=0.5)
    axes.set_title(f"Row {result.row.number}", pad=18)
    axes.text(0.0, 1.025, conditions(result.row), transform=axes.transAxes, fontsize=9, in_layout=False)
    axes.set(ylim=(-70.0, 150.0), yticks=[-55, 0, 55, 110], xlim=(0.0, 1e6 * run["time"][-1]))


def _draw_means(axes: Axes, table: Sequence[Result]) -> None:
    from frictioncontact import style

    columns = {
        "paper": [result.row.paper_force for result in table],
        "exact": [result.exact for result in table],
        "identified": [result.identified for result in table],
    }
    place, width = np.arange(len(table)), 0.26
    for k, (name, values) in enumerate(columns.items()):
        bars = axes.barh(place + (k - 1) * width, values, 0.92 * width, color=style.SOURCE[name])
        axes.bar_label(bars, [f"{value:.1f}" for value in values], padding=2, fontsize=9)
    axes.set_yticks(place, [f"Row {result.row.number}" for result in table])
    axes.invert_yaxis()
    axes.set(xlabel="mean friction force [N]", xlim=(0.0, 66.0))
    axes.grid(axis="y", visible=False)
    axes.set_title("Mean of each row over a period")
