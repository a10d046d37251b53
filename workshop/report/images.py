"""Figures of the report as SVG and PNG."""

from __future__ import annotations

from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Patch
from matplotlib.ticker import NullFormatter

from frictioncontact import style
from workshop.figure import Classes, Figure, Level, Line, Map, Panel, Span, subscripts

COLOURS = {
    "ink": style.BLACK,
    "grey": style.GREY,
    "blue": style.BLUE,
    "orange": style.ORANGE,
    "green": style.GREEN,
    "pink": style.PINK,
    "sky": style.SKY,
    "amber": style.AMBER,
}
DASHES = {"solid": "-", "dash": "--", "dot": ":"}
SEQUENTIAL, DIVERGING = "cividis", "RdBu_r"


def text(label: str) -> str:
    """Subscripts as matplotlib's mathtext."""
    return subscripts(label, r"$_{\\mathrm{", "}}$")


def draw(figure: Figure, *paths: Path) -> None:
    """Writes the figure under each path."""
    rows = -(-len(figure.panels) // figure.columns)
    drawing, grid = style.subplots(rows, figure.columns, size=figure.size, squeeze=False)
    for axes, panel in zip(grid.flat, figure.panels, strict=False):
        _panel(axes, panel)
    for axes in grid.flat[len(figure.panels) :]:
        axes.remove()
    drawing.suptitle(text(figure.title), x=0.01, ha="left", fontweight="bold", fontsize=12)
    style.save(drawing, *paths)


def _panel(axes: Axes, panel: Panel) -> None:
    axes.set_title(text(panel.title))
    axes.set_xlabel(text(panel.x_label))
    axes.set_ylabel(text(panel.y_label))
    if panel.x_log:
        axes.set_xscale("log")
        axes.xaxis.set_minor_formatter(NullFormatter())
    if panel.y_log:
        axes.set_yscale("log")
        axes.yaxis.set_minor_formatter(NullFormatter())
    handles = [handle for item in panel.items for handle in _item(axes, item)]
    if panel.x_range:
        axes.set_xlim(*panel.x_range)
    if panel.y_range:
        axes.set_ylim(*panel.y_range)
    if panel.legend and handles:
        columns = 1 if max(len(handle.get_label()) for handle in handles) > 34 else 2
        axes.legend(
            handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.17), ncols=columns, fontsize=8.5
        )


def _item(axes: Axes, item: Line | Level | Span | Map | Classes) -> list[Artist]:
    """Draws it; gives what the legend shows of it."""
    match item:
        case Line():
            marker = {"ls": "", "marker": "o", "ms": 5} if item.markers else {"ls": DASHES[item.dash]}
            (line,) = axes.plot(
                item.x, item.y, color=COLOURS[item.colour], lw=item.width, label=text(item.label), **marker
            )
            return [line] if item.label else []
        case Level():
            line = axes.axhline(
                item.y, color=COLOURS[item.colour], ls=DASHES[item.dash], lw=1.5, label=text(item.label)
            )
            return [line] if item.label else []
        case Span():
            colour = COLOURS[item.colour]
            return [axes.axhspan(item.low, item.high, color=colour, alpha=0.15, lw=0, label=text(item.label))]
        case Map():
            _map(axes, item)
            return []
        case Classes():
            return _classes(axes, item)


def _map(axes: Axes, item: Map) -> None:
    axes.grid(visible=False)
    colours = matplotlib.colormaps[DIVERGING if item.diverging else SEQUENTIAL]
    shown = axes.pcolormesh(
        item.x,
        item.y,
        item.z,
        cmap=colours,
        vmin=item.low,
        vmax=item.high,
        shading="gouraud",
        rasterized=True,
    )
    axes.figure.colorbar(
        shown, ax=axes, label=text(item.label), extend="both" if item.diverging else "neither"
    )
    if len(item.contours):
        ink = style.BLACK if item.diverging else "white"
        lines = axes.contour(item.x, item.y, item.z, levels=sorted(item.contours), colors=ink, linewidths=0.9)
        axes.clabel(lines, fontsize=7.5, fmt="%g")


def _classes(axes: Axes, item: Classes) -> list[Artist]:
    axes.grid(visible=False)
    colours = [COLOURS[name] for name in item.colours]
    axes.pcolormesh(
        item.x,
        item.y,
        item.z,
        cmap=ListedColormap(colours),
        norm=BoundaryNorm(np.arange(len(colours) + 1) - 0.5, len(colours)),
        shading="nearest",
        alpha=0.75,
        rasterized=True,
    )
    names = map(text, item.names)
    return [Patch(color=c, alpha=0.75, label=name) for c, name in zip(colours, names, strict=True)]
