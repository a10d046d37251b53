"""Draws the plots of the documentation inside the FMU: docs/fmu/force.svg and mean.svg.

    python -m figures.pages.plots

They are simulated with build/FrictionContact.fmu. The colours are CSS variables of the page that shows them,
so that they follow its light or dark scheme; by itself a plot has those of the light one.
"""

import io
import math
import re
from collections.abc import Mapping

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from frictioncontact import style
from frictioncontact.fmu import FrictionFmu, Value
from frictioncontact.parameters import COULOMB_FORCE, FREQUENCY, TABLE_2
from frictioncontact.periodic import periodic_mean, periodic_waves
from tools.packing.documentation import FMU_DOCS
from tools.project import ROOT

V_1 = TABLE_2[1].V_1
COLOURS = ("#0072b2", "#d55e00", "#00835f", "#a23e86")
INK, GRID = "#222222", "#d0d0d0"
VARIABLES = {**dict(zip(COLOURS, ("c1", "c2", "c3", "c4"), strict=True)), INK: "ink", GRID: "grid"}


def start_values(kappa: float, V: float) -> dict[str, Value]:
    """Start values at a constant stiffness of kappa = sigma V_1 / (2 pi f F_C)."""
    return {
        "V": V,
        "F_C": COULOMB_FORCE,
        "contact.model": "Constant",
        "contact.sigma": kappa * 2.0 * math.pi * FREQUENCY * COULOMB_FORCE / V_1,
        "vibration.f": FREQUENCY,
        "vibration.V_1": V_1,
    }


def new_axes() -> tuple[Figure, Axes]:
    figure, axes = style.subplots(size=(4.6, 3.1))
    axes.tick_params(colors=INK, length=0)
    axes.grid(color=GRID)
    axes.spines[:].set_visible(False)
    return figure, axes


def label_lines(axes: Axes, x: float, heights: Mapping[str, float]) -> None:
    """Names the lines in their order and colours, one below the other."""
    for line, (text, y) in zip(axes.get_lines(), heights.items(), strict=True):
        axes.text(x, y, text, color=line.get_color())


def as_svg(figure: Figure, title: str) -> str:
    """The figure as an element of a page: colours by variables, no ids but those that are referred to."""
    buffer = io.StringIO()
    with matplotlib.rc_context({"svg.fonttype": "none"}):
        figure.savefig(buffer, format="svg", transparent=True, metadata={"Date": None})
    text = buffer.getvalue()
    text = text[text.index("<svg") :]
    text = re.sub(r"\s*<(metadata|defs)>.*?</\1>", "", text, count=2, flags=re.DOTALL)
    text = re.sub(r"\s*<!--.*?-->", "", text, flags=re.DOTALL)
    used = set(re.findall(r"#([\w-]+)[\")]", text))
    text = re.sub(r' id="([\w.-]+)"', lambda match: match[0] if match[1] in used else "", text)
    text = text.replace(" font-family: 'DejaVu Sans';", "")
    for colour, variable in VARIABLES.items():
        text = text.replace(colour, f"var(--{variable}, {colour})")
    head, _, rest = text.partition(">")
    head = re.sub(r' (width|height|version|xmlns:xlink)="[^"]*"', "", head)
    return f'{head} role="img" font-family="system-ui, sans-serif">\n <title>{title}</title>{rest}'


def force(fmu: FrictionFmu) -> str:
    """F_t over two periods of the periodic state, for three stiffnesses."""
    figure, axes = new_axes()
    for kappa, colour in zip((0.5, 5.0, 100.0), COLOURS, strict=False):
        run = periodic_waves(fmu, start_values(kappa, 0.5), ("F_t",), samples=200)
        axes.plot(FREQUENCY * run["time"], run["F_t"] / COULOMB_FORCE, color=colour, lw=2.0)
    label_lines(axes, 0.03, {"κ = 0.5": -0.66, "κ = 5": -0.8, "κ = 100": -0.94})
    axes.set(xlabel="time in periods of the vibration", xlim=(0.0, 2.0), xticks=[0.0, 0.5, 1.0, 1.5, 2.0])
    axes.set(ylabel="F_t / F_C", yticks=[-1.0, -0.5, 0.0, 0.5, 1.0])
    return as_svg(figure, "Friction force over two periods of the vibration for three contact stiffnesses")


def mean(fmu: FrictionFmu) -> str:
    """The mean friction over V / V_1 for four stiffnesses, and the Coulomb limit."""
    figure, axes = new_axes()
    ratios = np.r_[0.0:0.9:37j, 0.91:1.09:19j, 1.1:1.5:9j]
    for kappa, colour in zip((0.2, 1.0, 5.0, 100.0), COLOURS, strict=True):
        means = [periodic_mean(fmu, start_values(kappa, ratio * V_1)) / COULOMB_FORCE for ratio in ratios]
        axes.plot(ratios, means, color=colour, lw=2.0)
    coulomb = [2.0 / math.pi * math.asin(min(ratio, 1.0)) for ratio in ratios]
    axes.plot(ratios, coulomb, color=INK, lw=2.0, ls="--")
    label_lines(axes, 1.12, {"κ = 0.2": 0.5, "κ = 1": 0.42, "κ = 5": 0.34, "κ = 100": 0.26, "Coulomb": 0.18})
    axes.set(xlabel="V / V_1", xlim=(0.0, 1.5))
    axes.set(ylabel="F_t_mean / F_C", ylim=(0.0, 1.05), yticks=[0.0, 0.25, 0.5, 0.75, 1.0])
    words = "Mean friction against the velocity over the vibration's amplitude for four contact stiffnesses"
    return as_svg(figure, words)


def main() -> None:
    with FrictionFmu(ROOT / "build" / "FrictionContact.fmu") as fmu:
        for name, plot in (("force", force), ("mean", mean)):
            path = FMU_DOCS / f"{name}.svg"
            path.write_text(plot(fmu), encoding="utf-8")
            print(f"wrote {path.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
