"""The picture of docs/three-directions.md: one contact that vibrates along, transverse or normal."""

from pathlib import Path

import numpy as np

from figures.figure import Figure, Line, Panel
from frictioncontact import style
from frictioncontact.batch import simulate_many
from frictioncontact.fmu import FrictionFmu, Value
from frictioncontact.parameters import COULOMB_FORCE, FREQUENCY

LOAD = 312.5  # N, times the FMU's friction coefficient of 0.176 makes 55 N
AMPLITUDE, HEIGHT = 1.44, 1.1e-6  # m/s in the plane, m normal to it: those of the paper
STATIC: dict[str, Value] = {"friction.staticRatio": 1.5, "friction.V_S": 0.01}
DIRECTIONS: dict[str, dict[str, Value]] = {
    "along": {"vibration.V_1": AMPLITUDE},
    "transverse": {"vibration.V_2": AMPLITUDE},
    "normal": {"vibration.a_d": HEIGHT},
}
# Law, kappa, colour, dash, label.
LINES = (
    ("Coulomb", 3.0, style.BLACK, "-", "Coulomb"),
    ("Dahl", 3.0, style.ORANGE, "-", "Dahl, κ = 3"),
    ("LuGre", 3.0, style.GREEN, "--", "LuGre, κ = 3"),
    ("ElasticPlastic", 3.0, style.BLUE, "-", "ElasticPlastic, κ = 3"),
    ("ElasticPlastic", 0.5, style.SKY, "-.", "ElasticPlastic, κ = 0.5"),
)


def scene(law: str, kappa: float, direction: str) -> dict[str, Value]:
    """kappa = sigma AMPLITUDE / (2 pi f F_C) gives the stiffness, in every direction the same."""
    return {
        "friction.model": law,
        "friction.limit": "Load",
        "contact.input": "Load",
        "load": LOAD,
        "contact.model": "Constant",
        "contact.sigma": kappa * 2.0 * np.pi * FREQUENCY * COULOMB_FORCE / AMPLITUDE,
        "vibration.f": FREQUENCY,
        **(STATIC if law == "LuGre" else {}),
        **DIRECTIONS[direction],
    }


def mean(fmu: FrictionFmu, start_values: dict[str, Value], V: np.ndarray) -> np.ndarray:
    """Settled mean friction over F_C at each V [m/s]."""
    found = simulate_many(start_values | {"V": V}, ["F_t_settled"], fmu=fmu.path)
    return found["F_t_settled"] / COULOMB_FORCE


def draw(fmu: FrictionFmu, path: Path) -> None:
    V = np.unique(np.concatenate([np.geomspace(1e-3, 10.0, 121), np.linspace(1.2, 1.5, 31), [AMPLITUDE]]))
    speed, height = f"{AMPLITUDE} m/s", f"{1e6 * HEIGHT:g} µm"
    titles = f"Along the sliding, {speed}", f"Transverse, {speed}", f"Normal, {height}"
    look, panels = {"xscale": "log", "xlim": (V[0], V[-1]), "ylim": (0.0, 1.06)}, []
    for direction, title in zip(DIRECTIONS, titles, strict=True):
        lines = [
            Line(V, mean(fmu, scene(law, kappa, direction), V), label, colour, dash, 2.2)
            for law, kappa, colour, dash, label in LINES
        ]
        x_label = "sliding velocity V [m/s]" if direction == "normal" else ""
        panels.append(Panel(title, x_label, "mean friction over F_C", lines, look))
    below = {"size": (5.2, 8.6), "shared_legend": 2, "options": {"sharex": True}}
    Figure(path.stem, "", "", panels, 1, **below).draw(path)
