"""The picture of Table 2: friction over time for each row, and the means against the paper's."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from frictioncontact import style
from frictioncontact.fmu import FrictionFmu
from frictioncontact.parameters import COULOMB_FORCE, IDENTIFIED, PRINTED, start_values
from frictioncontact.periodic import periodic_waves
from frictioncontact.table2.rows import Result, conditions

PARAMETERS = {"exact": PRINTED, "identified": IDENTIFIED}
LABELS = {
    "paper": "paper, as printed",
    "exact": "Eq. 1–2 at the printed parameters",
    "identified": "Eq. 1–2 with stiffness and phase fitted to rows 2, 3, 6",
}


def draw(fmu: FrictionFmu, table: Sequence[Result], *paths: Path) -> None:
    """Writes the picture under each path."""
    figure, axes = style.subplots(
        3, 3, size=(11.0, 9.6), gridspec_kw={"height_ratios": [1.0, 1.0, 1.15]}, squeeze=False
    )
    for panel, result in zip(axes[:2].flat, table, strict=True):
        _draw_waves(panel, fmu, result)
    style.note(
        axes[1, 0],
        "passes $F_C$ while the surfaces approach:\n$\\delta$ lags behind the rising $\\sigma$",
        x=0.5,
        y=0.16,
        ha="center",
    )
    for panel in axes[:2, 0]:
        panel.set_ylabel("friction force $F_t$ [N]")
    for panel in axes[1]:
        panel.set_xlabel("time in the periodic state [µs]")
    grid = axes[2, 0].get_gridspec()
    for panel in axes[2]:
        panel.remove()
    _draw_means(figure.add_subplot(grid[2, :]), table)
    handles = [
        Line2D([], [], color=style.SOURCE[name], lw=2.0, ls=":" if name == "paper" else "-", label=label)
        for name, label in LABELS.items()
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=3, fontsize=10)
    style.save(figure, *paths)


def _draw_waves(axes: Axes, fmu: FrictionFmu, result: Result) -> None:
    for name, parameters in PARAMETERS.items():
        run = periodic_waves(fmu, start_values(result.row, parameters), ("F_t",), samples=400)
        axes.plot(1e6 * run["time"], run["F_t"], color=style.SOURCE[name], lw=1.7)
    axes.axhline(result.row.paper_force, color=style.SOURCE["paper"], ls=":", lw=1.8)
    axes.axhline(0.0, color=style.GREY, lw=0.8, zorder=0.5)
    axes.set_title(f"Row {result.row.number}", pad=18)
    axes.text(0.0, 1.025, conditions(result.row), transform=axes.transAxes)
    axes.set_ylim(-70.0, 150.0)
    axes.set_yticks([-55, 0, 55, 110])
    axes.set_xlim(0.0, 1e6 * run["time"][-1])


def _draw_means(axes: Axes, table: Sequence[Result]) -> None:
    columns = {
        "paper": [result.row.paper_force for result in table],
        "exact": [result.exact for result in table],
        "identified": [result.identified for result in table],
    }
    place = np.arange(len(table))
    width = 0.26
    for k, (name, values) in enumerate(columns.items()):
        bars = axes.bar(place + (k - 1) * width, values, 0.92 * width, color=style.SOURCE[name])
        axes.bar_label(bars, [f"{value:.1f}" for value in values], padding=2, fontsize=9)
    axes.axhline(COULOMB_FORCE, color=style.GREY, lw=0.9, zorder=0.5)
    axes.set_xticks(place, [conditions(result.row, "\n") for result in table])
    axes.set_ylabel("mean friction force [N]")
    axes.set_ylim(0.0, 66.0)
    axes.grid(axis="x", visible=False)
    axes.set_title("Mean of each row over one vibration period")
