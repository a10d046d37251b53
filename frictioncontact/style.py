"""One look for every picture of the project.

    from frictioncontact import style
    figure, axes = style.subplots(1, 2, size=(9, 3.5))
    style.save(figure, "build/picture.png", "build/picture.svg")

Colours are those of Okabe and Ito, which people with any colour vision can tell apart; a role (paper, exact,
identified; each solver) has the same colour in every picture.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from frictioncontact.errors import UserError
from frictioncontact.files import whole_file

try:
    import matplotlib
except ImportError:
    raise UserError("pictures need matplotlib: pip install 'frictioncontact[plot]'") from None
from matplotlib.axes import Axes
from matplotlib.figure import Figure

BLACK, GREY, LIGHT = "#222222", "#767676", "#d0d0d0"
BLUE, ORANGE, GREEN, RED = "#0072b2", "#d55e00", "#009e73", "#b2182b"
SKY, AMBER, PINK = "#56b4e9", "#e69f00", "#cc79a7"
CYCLE = (BLUE, ORANGE, GREEN, PINK, SKY, AMBER, BLACK)

# Where a number of Table 2 comes from.
SOURCE = {"paper": BLACK, "exact": BLUE, "identified": ORANGE}

_SETTINGS: dict[str, Any] = {
    "figure.dpi": 100,
    "figure.facecolor": "white",
    "figure.constrained_layout.use": True,
    "savefig.dpi": 160,
    "font.size": 10,
    "font.family": "DejaVu Sans",
    "mathtext.fontset": "dejavusans",
    "axes.titlesize": 10.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelcolor": BLACK,
    "axes.edgecolor": GREY,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.prop_cycle": matplotlib.cycler(color=CYCLE),
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.7,
    "lines.linewidth": 1.6,
    "lines.markersize": 5,
    "xtick.color": GREY,
    "ytick.color": GREY,
    "xtick.labelcolor": BLACK,
    "ytick.labelcolor": BLACK,
    "legend.frameon": False,
    "legend.fontsize": 9,
    "svg.fonttype": "none",
    "svg.hashsalt": "FrictionContact",  # the same data gives the same bytes
}


def subplots(
    rows: int = 1, columns: int = 1, size: tuple[float, float] = (7.0, 4.0), **options: Any
) -> tuple[Figure, Any]:
    """A figure in the project's look with its axes; size in inches. No display is needed, or touched."""
    matplotlib.rcParams.update(_SETTINGS)
    figure = Figure(figsize=size)
    return figure, figure.subplots(rows, columns, **options)


@contextmanager
def kept() -> Iterator[None]:
    """Leaves the user's settings of matplotlib as they were."""
    with matplotlib.rc_context():
        yield


def save(figure: Figure, *paths: str | Path) -> None:
    """Writes the figure under each path (the suffix says the format), free of dates."""
    for path in map(Path, paths):
        metadata = {"Date": None} if path.suffix == ".svg" else {}
        with whole_file(path) as unfinished:
            figure.savefig(unfinished, format=path.suffix[1:], metadata=metadata)


def note(axes: Axes, text: str, x: float = 0.02, y: float = 0.96, **options: Any) -> None:
    """Small grey remark inside the axes, at fractions of their width and height."""
    settings = {"fontsize": 8.5, "color": GREY, "va": "top", "transform": axes.transAxes}
    axes.text(x, y, text, **{**settings, **options})
