"""Draws docs/fmu/model.png, the icon of the FMU in a block diagram.

    python -m figures.pages.icon

Two rough surfaces that touch at their asperities, the arrow of the velocity, the wave of the vibration.
"""

import numpy as np
from matplotlib.patches import FancyArrowPatch

from frictioncontact import style
from tools.packing.documentation import FMU_DOCS
from tools.project import ROOT

PIXELS = 256
BODY, SLIDER, EDGE = "#9aa7b4", style.BLUE, style.BLACK


def profile(x: np.ndarray, crests: tuple[float, ...], heights: tuple[float, ...]) -> np.ndarray:
    """A rough profile: round asperities of given places and heights."""
    bumps = [h * np.exp(-(((x - c) / 0.065) ** 2)) for c, h in zip(crests, heights, strict=True)]
    return np.max(bumps, axis=0)


def main() -> None:
    figure, axes = style.subplots(size=(2.56, 2.56))
    axes.set(xlim=(0, 1), ylim=(0, 1), aspect="equal")
    axes.axis("off")
    figure.set_layout_engine("none")
    axes.set_position((0, 0, 1, 1))

    x = np.linspace(0.04, 0.96, 400)
    lower = 0.27 + profile(x, (0.1, 0.27, 0.45, 0.62, 0.8, 0.94), (0.07, 0.11, 0.06, 0.11, 0.06, 0.1))
    upper = 0.50 - profile(x, (0.09, 0.28, 0.43, 0.61, 0.79, 0.93), (0.06, 0.125, 0.07, 0.125, 0.07, 0.08))
    inside = (x > 0.14) & (x < 0.86)
    axes.fill_between(x, 0.06, lower, fc=BODY, ec=EDGE, lw=2.2)
    axes.fill_between(x[inside], np.maximum(upper, lower)[inside], 0.66, fc=SLIDER, ec=EDGE, lw=2.2)

    wave = np.linspace(0.0, 1.0, 200)
    axes.plot(0.14 + 0.38 * wave, 0.82 + 0.085 * np.sin(6 * np.pi * wave), color=style.ORANGE, lw=5.5)
    arrow = "simple,head_width=17,head_length=15,tail_width=6"
    axes.add_patch(FancyArrowPatch((0.56, 0.82), (0.95, 0.82), arrowstyle=arrow, color=style.GREY, lw=0))
    path = FMU_DOCS / "model.png"
    figure.savefig(path, dpi=PIXELS / 2.56, transparent=True, metadata={"Software": None})
    print(f"wrote {path.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
