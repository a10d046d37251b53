"""The figures of the report: panels of lines, levels, bands and maps, and how they are drawn.

Labels write subscripts as F_t or V_1; pictures and the page turn them into their own form.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Patch
from matplotlib.ticker import NullFormatter

from frictioncontact import style

SUBSCRIPT = re.compile(r"(?<![A-Za-z])([A-Za-zσκζδαφλω])_([A-Za-z0-9]+)")


def subscripts(text: str, before: str, after: str) -> str:
    return SUBSCRIPT.sub(rf"\1{before}\2{after}", text)


def text(label: str) -> str:
    """Subscripts as matplotlib's mathtext."""
    return subscripts(label, r"$_{\\mathrm{", "}}$")


# An item draws itself, and gives what the legend shows of it.


@dataclass(frozen=True)
class Line:
    x: Sequence[float] | np.ndarray
    y: Sequence[float] | np.ndarray
    label: str = ""
    colour: str = style.BLUE
    dash: str = "solid"  # solid, dashed, dotted
    width: float = 1.8
    markers: bool = False  # points instead of a line

    def draw(self, axes: Axes) -> list[Artist]:
        look = {"ls": "", "marker": "o", "ms": 5} if self.markers else {"ls": self.dash}
        lines = axes.plot(self.x, self.y, color=self.colour, lw=self.width, label=text(self.label), **look)
        return lines if self.label else []


@dataclass(frozen=True)
class Level:
    """A horizontal line over the whole width."""

    y: float
    label: str
    colour: str = style.GREY
    dash: str = "dashed"

    def draw(self, axes: Axes) -> list[Artist]:
        return [axes.axhline(self.y, color=self.colour, ls=self.dash, lw=1.5, label=text(self.label))]


@dataclass(frozen=True)
class Map:
    """Values over x (columns) and y (rows), from low to high, with contour lines."""

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    label: str
    low: float
    high: float
    contours: Sequence[float]

    def draw(self, axes: Axes) -> list[Artist]:
        axes.grid(visible=False)
        look = {"cmap": "cividis", "shading": "gouraud", "rasterized": True}
        shown = axes.pcolormesh(self.x, self.y, self.z, vmin=self.low, vmax=self.high, **look)
        axes.figure.colorbar(shown, ax=axes, label=text(self.label))
        lines = axes.contour(self.x, self.y, self.z, levels=self.contours, colors="white", linewidths=0.9)
        axes.clabel(lines, fontsize=7.5, fmt="%g")
        return []


@dataclass(frozen=True)
class Classes:
    """Integer classes over x and y, each with a name and a colour."""

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    names: Sequence[str]
    colours: Sequence[str]

    def draw(self, axes: Axes) -> list[Artist]:
        axes.grid(visible=False)
        count = len(self.colours)
        norm = BoundaryNorm(np.arange(count + 1) - 0.5, count)
        look = {"cmap": ListedColormap(self.colours), "norm": norm, "shading": "nearest"}
        axes.pcolormesh(self.x, self.y, self.z, alpha=0.75, rasterized=True, **look)
        names = zip(self.names, self.colours, strict=True)
        return [Patch(color=colour, alpha=0.75, label=text(name)) for name, colour in names]


@dataclass(frozen=True)
class Panel:
    title: str
    x_label: str
    y_label: str
    items: Sequence[Line | Level | Map | Classes]
    x_log: bool = False
    y_log: bool = False
    x_range: tuple[float, float] | None = None
    y_range: tuple[float, float] | None = None
    x_whole: bool = False  # ticks at whole numbers alone

    def draw(self, axes: Axes) -> None:
        axes.set(title=text(self.title), xlabel=text(self.x_label), ylabel=text(self.y_label))
        if self.x_log:
            axes.set_xscale("log")
            axes.xaxis.set_minor_formatter(NullFormatter())
        if self.x_whole:
            axes.xaxis.get_major_locator().set_params(integer=True)
        if self.y_log:
            axes.set_yscale("log")
            axes.yaxis.set_minor_formatter(NullFormatter())
        handles = [handle for item in self.items for handle in item.draw(axes)]
        axes.set(xlim=self.x_range, ylim=self.y_range)
        if handles:
            columns = 1 if max(len(handle.get_label()) for handle in handles) > 34 else 2
            below = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.17)}
            axes.legend(handles=handles, ncols=columns, fontsize=8.5, **below)


@dataclass(frozen=True)
class Figure:
    key: str  # names the files
    title: str
    caption: str
    panels: Sequence[Panel]
    columns: int = 2
    size: tuple[float, float] = (10.0, 4.0)  # inches, of the image files

    def narrow(self) -> Figure:
        """The same with a panel below the other, for a phone."""
        return replace(self, columns=1, size=(5.6, 4.1 * len(self.panels)))

    def draw(self, *paths: Path) -> None:
        """Writes the figure under each path."""
        rows = -(-len(self.panels) // self.columns)
        drawing, grid = style.subplots(rows, self.columns, size=self.size, squeeze=False)
        for axes, panel in zip(grid.flat, self.panels, strict=False):
            panel.draw(axes)
        for axes in grid.flat[len(self.panels) :]:
            axes.remove()
        drawing.suptitle(text(self.title), x=0.01, ha="left", fontweight="bold", fontsize=12)
        style.save(drawing, *paths)
