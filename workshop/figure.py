"""A figure without a plotting package: what the web page and the image files draw alike.

Labels write subscripts as F_t or V_1; each renderer turns them into its own form.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

SUBSCRIPT = re.compile(r"(?<![A-Za-z])([A-Za-zσκζδαφλω])_([A-Za-z0-9]+)")

# Roles; each renderer has a colour for each, and the page one for light and one for dark.
INK, GREY, BLUE, ORANGE, GREEN, PINK, SKY, AMBER = (
    "ink",
    "grey",
    "blue",
    "orange",
    "green",
    "pink",
    "sky",
    "amber",
)


def subscripts(text: str, before: str, after: str) -> str:
    return SUBSCRIPT.sub(rf"\1{before}\2{after}", text)


@dataclass(frozen=True)
class Line:
    x: Sequence[float] | np.ndarray
    y: Sequence[float] | np.ndarray
    label: str = ""
    colour: str = BLUE
    dash: str = "solid"  # solid, dash, dot
    width: float = 1.8
    markers: bool = False  # points instead of a line


@dataclass(frozen=True)
class Level:
    """A horizontal line over the whole width."""

    y: float
    label: str = ""
    colour: str = GREY
    dash: str = "dash"


@dataclass(frozen=True)
class Span:
    """A horizontal band over the whole width."""

    low: float
    high: float
    label: str
    colour: str = GREY


@dataclass(frozen=True)
class Map:
    """Values over x (columns) and y (rows), with contour lines."""

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    label: str
    low: float
    high: float
    contours: Sequence[float] = ()
    diverging: bool = False


@dataclass(frozen=True)
class Classes:
    """Integer classes over x and y, each with a name and a colour."""

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    names: Sequence[str]
    colours: Sequence[str]


@dataclass(frozen=True)
class Panel:
    title: str
    x_label: str
    y_label: str
    items: Sequence[Line | Level | Span | Map | Classes]
    x_log: bool = False
    y_log: bool = False
    x_range: tuple[float, float] | None = None
    y_range: tuple[float, float] | None = None
    legend: bool = True


@dataclass(frozen=True)
class Figure:
    key: str  # names the files
    title: str
    caption: str
    panels: Sequence[Panel]
    columns: int = 2
    size: tuple[float, float] = field(default=(10.0, 4.0))  # inches, of the image files
