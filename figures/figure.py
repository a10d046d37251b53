"""Figures of the report and of the pages: panels with lines, drawn beside or below each other.

Labels write subscripts as F_t or V_1; pictures and the page turn them into their own form.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import NullFormatter

from frictioncontact import style

SUBSCRIPT = re.compile(r"(?<![A-Za-z])([A-Za-zσκζδαφλω])_([A-Za-z0-9]+)")


def text(label: str, before: str = r"$_{\\mathrm{", after: str = "}}$") -> str:
    """With its subscripts as matplotlib's mathtext."""
    return SUBSCRIPT.sub(rf"\1{before}\2{after}", label)


@dataclass(frozen=True)
class Line:
    x: Sequence[float] | np.ndarray
    y: Sequence[float] | np.ndarray
    label: str = ""
    colour: str = style.BLUE
    dash: str = "-"  # as matplotlib names it; "o" draws points
    width: float = 1.8

    def __call__(self, axes: Axes) -> None:
        axes.plot(self.x, self.y, self.dash, color=self.colour, lw=self.width, label=text(self.label))


@dataclass(frozen=True)
class Level:
    """A horizontal line over the whole width."""

    y: float
    label: str
    colour: str = style.GREY
    dash: str = "--"

    def __call__(self, axes: Axes) -> None:
        axes.axhline(self.y, color=self.colour, ls=self.dash, lw=1.5, label=text(self.label))


@dataclass(frozen=True)
class Panel:
    title: str
    x_label: str
    y_label: str
    items: Sequence[Callable[[Axes], None]]  # each draws itself
    look: Mapping[str, Any] = field(default_factory=dict)  # further words of Axes.set

    def draw(self, axes: Axes) -> None:
        axes.set(title=text(self.title), xlabel=text(self.x_label), ylabel=text(self.y_label), **self.look)
        for axis in (axes.xaxis, axes.yaxis):
            if axis.get_scale() == "log":
                axis.set_minor_formatter(NullFormatter())
        for item in self.items:
            item(axes)

    def add_legend(self, axes: Axes) -> None:
        labels = axes.get_legend_handles_labels()[1]
        if labels:
            columns = 1 if max(map(len, labels)) > 34 else 2
            axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.17), ncols=columns, fontsize=8.5)


@dataclass(frozen=True)
class Figure:
    key: str  # names the files
    title: str
    caption: str
    panels: Sequence[Panel]
    columns: int = 2
    size: tuple[float, float] = (10.0, 4.0)  # inches
    shared_legend: int = 0  # columns of one legend for all panels; 0: each has its own
    options: Mapping[str, Any] = field(default_factory=dict)  # further words of style.subplots

    def narrow(self) -> Figure:
        """The same with a panel below the other, for a phone."""
        return replace(self, columns=1, size=(5.2, 3.9 * len(self.panels)))

    def draw(self, *paths: Path) -> None:
        """Writes the figure under each path."""
        rows = -(-len(self.panels) // self.columns)
        drawing, grid = style.subplots(rows, self.columns, size=self.size, squeeze=False, **self.options)
        for axes, panel in zip(grid.flat, self.panels, strict=True):
            panel.draw(axes)
            if not self.shared_legend:
                panel.add_legend(axes)
        if self.shared_legend:
            entries = grid.flat[0].get_legend_handles_labels()
            drawing.legend(*entries, loc="outside lower center", ncols=self.shared_legend)
        if self.title:
            drawing.suptitle(text(self.title), x=0.01, ha="left", fontweight="bold", fontsize=12)
        style.save(drawing, *paths)
