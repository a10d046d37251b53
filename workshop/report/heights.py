"""Figure of the height statistics: what the exponential density costs."""

import numpy as np

from frictioncontact.gap import area, gaussian
from frictioncontact.parameters import SEPARATION, Surfaces
from frictioncontact.style import BLACK, BLUE, GREEN, GREY, ORANGE
from workshop.report.figure import Figure, Level, Line, Panel

MODELS = {
    "exponential": ("exponential, elastic-plastic (the FMU)", BLUE, "-"),
    "gaussian": ("Gaussian, elastic-plastic (Chang-Etsion-Bogy)", GREEN, "--"),
    "elastic": ("Gaussian, elastic (Greenwood-Williamson)", ORANGE, ":"),
}
CAPTION = """\
The exponential stands in for the upper tail of a Gaussian. At the paper's d / R_q = 2.33 it gives 0.52 of the
Gaussian's area and 0.27 of its stiffness; the area is within a factor of 2 for d / R_q from 0.55 to 4.1, and
useless near zero. Nearly all touching asperities yield here, which doubles the elastic area."""


def areas() -> Figure:
    """Density, contact area and its error over d / R_q."""
    surfaces = Surfaces()
    h, s = np.linspace(0.25, 4.5, 61), np.linspace(0.0, 4.5, 61)
    by_model = {m: np.array([area(surfaces, x * surfaces.R_q, model=m) for x in h]) for m in MODELS}
    density = [
        Line(s, surfaces.c * np.exp(-surfaces.lambda_ * s), "17 e^(−3s), Eq. 17", BLUE),
        Line(s, [gaussian(x) for x in s], "Gaussian", GREEN, "--"),
    ]
    areas = [Line(h, by_model[m] / surfaces.A_n, *look, 2.2) for m, look in MODELS.items()]
    ratio = by_model["exponential"] / by_model["gaussian"]
    printed = area(surfaces, SEPARATION) / area(surfaces, SEPARATION, model="gaussian")
    errors = [
        Line(h, ratio, "area A_r", BLUE, width=2.4),
        Line(h, ratio**2, "stiffness σ = E A_r² / d³", ORANGE, "--"),
        Level(1.0, "exact", GREY, ":"),
        Line([SEPARATION / surfaces.R_q], [printed], "14 µm of the paper", BLACK, "o"),
    ]
    separation, log = "separation d / R_q", {"yscale": "log"}
    panels = [
        Panel("Height density", "height s = z / R_q", "density", density, log | {"ylim": (1e-5, 30.0)}),
        Panel("Real contact area", separation, "A_r / A_n", areas, log),
        Panel("Exponential over Gaussian", separation, "ratio", errors, log | {"ylim": (0.05, 20.0)}),
    ]
    return Figure("heights", "Error of the exponential height density", CAPTION, panels, 3, (14.0, 4.8))
