"""Which output to connect (using.md), the domain of the promise and the levels of the model (numerics.md)."""

import math
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import FancyBboxPatch

from figures.figure import Figure, Line, Panel
from frictioncontact import style
from frictioncontact.batch import simulate_many
from frictioncontact.fmu import FrictionFmu
from frictioncontact.parameters import COULOMB_FORCE, FREQUENCY, STIFFNESS_PRINTED, Surfaces

# ---- which output to connect ----

QUESTION, ANSWER = {"fc": "#fdf1e3", "ec": style.ORANGE}, {"fc": "#eaf3fa", "ec": style.BLUE}
WIDTH, HEIGHT = 0.56, 0.14  # of a box
QUESTIONS = (  # what is asked; the answers that end the way and go on, and the output that the first leads to
    ("Does the contact\nvibrate?", "no", "yes", "F_t\nat any step"),
    ("Does your machine feel\nthe force within a period?", "yes", "no", "F_t\nup to T/20"),
    ("Can your mass stick, or does\nyour tool exchange values?", "no", "yes", "F_t_settled\nat any step"),
)
LAST = "F_t_mean\nsteps of whole periods T"


def draw_choice(path: Path) -> None:
    """Questions down the left, outputs on the right."""
    figure, axes = style.subplots(size=(4.4, 4.8))
    axes.set(xlim=(-0.01, 1.01), ylim=(0.0, 1.0))
    axes.axis("off")
    for k, (question, ends, goes_on, output) in enumerate(QUESTIONS):
        y = 0.91 - 0.27 * k
        box(axes, 0.28, y, (WIDTH, HEIGHT), question, QUESTION)
        box(axes, 0.86, y, (0.28, HEIGHT), output, ANSWER, weight="bold")
        _arrow(axes, (0.56, y), (0.72, y), ends, (0.64, y + 0.03))
        _arrow(axes, (0.28, y - HEIGHT / 2), (0.28, y - 0.27 + HEIGHT / 2), goes_on, (0.32, y - 0.135))
    box(axes, 0.28, 0.1, (WIDTH, HEIGHT), LAST, ANSWER, weight="bold")
    style.save(figure, path)


def box(
    axes: Axes,
    x: float,
    y: float,
    size: tuple[float, float],
    text: str,
    look: dict[str, str],
    rounding: float = 0.02,
    **font: Any,
) -> None:
    """Around the middle (x, y), with round corners and a text."""
    corner = (x - size[0] / 2, y - size[1] / 2)
    patch = FancyBboxPatch(corner, *size, boxstyle=f"round,pad=0,rounding_size={rounding}", lw=1.4, **look)
    axes.add_patch(patch)
    axes.text(x, y, text, ha="center", va="center", **font)


def _arrow(
    axes: Axes, start: tuple[float, float], end: tuple[float, float], word: str, place: tuple[float, float]
) -> None:
    look = {"arrowstyle": "-|>", "color": style.GREY, "shrinkA": 2, "shrinkB": 2, "lw": 1.4}
    axes.annotate("", end, start, arrowprops=look)
    axes.text(*place, word, ha="center", va="center", fontsize=10, color=style.ORANGE)


# ---- the domain of the promise ----

FREE, REFUSED = "finite numbers, no tested accuracy", "refused, by name and value"
DOMAIN = (  # the quantity, from, to; what happens below and above
    ("tolerance", 1e-8, 1e-2, FREE, FREE),
    ("σ v/(2πf g)", 1e-3, 1e8, FREE, FREE),
    ("step [periods]", 1e-6, 1e6, FREE, FREE),
    ("static ratio R", 1.0, 3.0, None, FREE),
    ("V_S / v", 1e-3, 10.0, FREE, FREE),
    ("σ₁ v / g", None, 1.0, None, FREE),
    ("start force / g", None, 100.0, None, FREE),
    ("E max / E min", 1.0, 10.0, None, REFUSED),
)
ENDS = (1e-11, 1e11)


def draw_domain(path: Path) -> None:
    """Each quantity as a bar on one logarithmic axis."""
    figure, axes = style.subplots(size=(4.6, 4.6))
    for k, (_, low, high, below, above) in enumerate(DOMAIN):
        y = len(DOMAIN) - k
        left, right = low or ENDS[0], high
        axes.barh(y, right - left, left=left, height=0.56, color=style.BLUE)
        for begin, end, words in ((ENDS[0], left, below), (right, ENDS[1], above)):
            if words:
                colour = style.ORANGE if words == REFUSED else style.LIGHT
                axes.barh(y, end - begin, left=begin, height=0.56, color=colour)
        narrow = right < 20.0 * left
        for place, number, side in ((left, low, "right"), (right, high, "left")):
            if number:
                _number(axes, place, y, number, side if narrow else "center")
    axes.set(xscale="log", xlim=ENDS, ylim=(0.4, len(DOMAIN) + 0.7), xticks=[1e-8, 1e-4, 1, 1e4, 1e8])
    axes.set_yticks(range(len(DOMAIN), 0, -1), [name for name, *_ in DOMAIN])
    axes.grid(axis="y", visible=False)
    kinds = {style.BLUE: "error within the tolerance", style.LIGHT: FREE, style.ORANGE: REFUSED}
    for colour, words in kinds.items():
        axes.barh(np.nan, np.nan, color=colour, label=words)
    figure.legend(loc="outside lower center")
    style.save(figure, path)


def _number(axes: Axes, place: float, y: float, number: float, side: str) -> None:
    """The end of a bar, above its corner."""
    exponent = round(math.log10(number))
    text = f"{number:g}" if 1 <= number < 1000 else f"$10^{{{exponent}}}$"
    axes.text(place, y + 0.31, text, ha=side, va="bottom", fontsize=8, color=style.BLACK)


# ---- levels of the model ----

ZETA, V_1 = 0.3, 1.44  # V/V_1; m/s
ALPHAS = {0.0: "d constant", 0.18: "a_d / R_q = 0.18"}


def level_errors(fmu: FrictionFmu, kappas: np.ndarray, alpha: float) -> dict[str, np.ndarray]:
    """Largest error of the settled mean over F_C, at any phase, of each level against Dahl on asperities."""
    sigma = kappas * 2.0 * math.pi * FREQUENCY * COULOMB_FORCE / V_1
    sliding = {"V": ZETA * V_1, "vibration.V_1": V_1}
    full = sliding | {
        "vibration.a_d": alpha * Surfaces.R_q,
        "vibration.phase_d": np.linspace(0.0, 2.0 * np.pi, 36, endpoint=False)[:, None],
        "contact.stiffnessScale": sigma / STIFFNESS_PRINTED,
    }
    levels: dict[str, dict[str, Any]] = {
        "Coulomb": sliding | {"friction.model": "Coulomb"},
        "ElasticPlastic": full | {"friction.model": "ElasticPlastic"},
        "Dahl, constant stiffness": sliding | {"contact.model": "Constant", "contact.sigma": sigma},
    }
    truth, *means = (
        simulate_many(scene, ["F_t_settled"], fmu=fmu.path)["F_t_settled"]
        for scene in (full, *levels.values())
    )
    errors = [np.abs(mean - truth).max(axis=0) / COULOMB_FORCE for mean in means]
    return dict(zip(levels, errors, strict=True))


def draw_levels(fmu: FrictionFmu, path: Path) -> None:
    kappas, panels = np.geomspace(1e-2, 1e5, 57), []
    look = {"xscale": "log", "yscale": "log", "ylim": (1e-5, 3.0), "xlim": kappas[[0, -1]]}

    def percent(axes: Axes) -> None:
        axes.axhline(0.01, color=style.GREY, lw=1.0, ls="--")
        axes.text(1.3e-2, 0.012, "1 %", fontsize=9, va="bottom", color=style.GREY)

    for alpha, title in ALPHAS.items():
        errors = level_errors(fmu, kappas, alpha).items()
        lines = [
            Line(kappas, of, name, colour) for (name, of), colour in zip(errors, style.CYCLE, strict=False)
        ]
        x_label = "κ = σ V_1/(2πf F_C)" if alpha else ""
        panels.append(Panel(title, x_label, "error of the mean / F_C", [*lines, percent], look))
    shared = {"sharex": True, "sharey": True}
    Figure(path.stem, "", "", panels, 1, (5.6, 6.6), 2, shared).draw(path)
