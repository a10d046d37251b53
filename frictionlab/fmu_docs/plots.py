"""Draws the plots of the documentation inside the FMU: docs/fmu/force.svg and mean.svg.

    python -m frictionlab.fmu_documentation_plots

They are simulated with build/FrictionContact.fmu. The colours are CSS variables of the page that shows them,
so that they follow its light or dark scheme; by itself a picture has those of the light one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from frictionlab.fmu import FrictionFmu
from frictionlab.fmu_docs.page import FMU_DOCS
from frictionlab.periodic import periodic_mean
from frictionlab.project import ROOT

F_C = 55.0  # N
FREQUENCY = 20e3  # Hz
V_1 = 1.44  # m/s
COLOURS = ("var(--c1, #0072b2)", "var(--c2, #d55e00)", "var(--c3, #00835f)", "var(--c4, #a23e86)")
INK, GRID = "var(--ink, #222)", "var(--grid, #d0d0d0)"
WIDTH, HEIGHT = 480, 320
LEFT, RIGHT, TOP, BOTTOM = 56, 14, 14, 50


@dataclass
class Chart:
    """Two axes and lines over them, written as SVG."""

    title: str
    x_label: str
    y_label: str
    x_ticks: list[float]
    y_ticks: list[float]
    body: list[str] = field(default_factory=list)

    def x(self, value: float) -> float:
        return LEFT + (value - self.x_ticks[0]) / (self.x_ticks[-1] - self.x_ticks[0]) * (
            WIDTH - LEFT - RIGHT
        )

    def y(self, value: float) -> float:
        return (
            HEIGHT
            - BOTTOM
            - (value - self.y_ticks[0]) / (self.y_ticks[-1] - self.y_ticks[0]) * (HEIGHT - TOP - BOTTOM)
        )

    def line(self, xs: np.ndarray, ys: np.ndarray, colour: str, dashed: bool = False) -> None:
        points = " ".join(f"{self.x(x):.1f},{self.y(y):.1f}" for x, y in zip(xs, ys, strict=True))
        dash = ' stroke-dasharray="6 4"' if dashed else ""
        self.body.append(
            f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"{dash}/>'
        )

    def text(self, x: float, y: float, text: str, colour: str, anchor: str = "start") -> None:
        self.body.append(_label(self.x(x), self.y(y), text, colour, anchor))

    def svg(self) -> str:
        lines = [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" '
            f'font-family="system-ui, sans-serif" font-size="14">',
            f"<title>{self.title}</title>",
        ]
        for tick in self.x_ticks:
            x = f"{self.x(tick):.1f}"
            lines.append(f'<path d="M{x} {TOP}V{HEIGHT - BOTTOM}" stroke="{GRID}"/>')
            lines.append(_label(self.x(tick), HEIGHT - BOTTOM + 18, _number(tick), INK, "middle"))
        for tick in self.y_ticks:
            y = self.y(tick)
            lines.append(f'<path d="M{LEFT} {y:.1f}H{WIDTH - RIGHT}" stroke="{GRID}"/>')
            lines.append(_label(LEFT - 6, y + 5, _number(tick), INK, "end"))
        lines.append(_label((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 12, self.x_label, INK, "middle"))
        middle = (TOP + HEIGHT - BOTTOM) / 2
        turned = _label(0, 0, self.y_label, INK, "middle")
        lines.append(f'<g transform="translate(15 {middle}) rotate(-90)">{turned}</g>')
        return "\n".join([*lines, *self.body, "</svg>"]) + "\n"


def _label(x: float, y: float, text: str, colour: str, anchor: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}">{text}</text>'


def _number(value: float) -> str:
    return f"{value:g}".replace("-", "−")


def with_stiffness(kappa: float, V: float) -> dict[str, float | str]:
    """Start values at a constant stiffness of kappa = sigma V_1 / (2 pi f F_C)."""
    return {
        "V": V,
        "F_C": F_C,
        "contact.model": "Constant",
        "contact.sigma": kappa * 2.0 * math.pi * FREQUENCY * F_C / V_1,
        "vibration.f": FREQUENCY,
        "vibration.V_1": V_1,
    }


def force(fmu: FrictionFmu) -> str:
    """F_t over two periods, after many, for three stiffnesses."""
    chart = Chart(
        "Friction force over two periods of the vibration for three contact stiffnesses",
        "time in periods of the vibration",
        "F_t / F_C",
        [0, 0.5, 1, 1.5, 2],
        [-1, -0.5, 0, 0.5, 1],
    )
    period, count = 1.0 / FREQUENCY, 400
    for kappa, colour in zip((0.5, 5.0, 100.0), COLOURS, strict=False):
        with fmu.session(with_stiffness(kappa, 0.5)) as session:
            session.step(1000 * period)
            forces = [session.get("F_t")]
            for _ in range(count):
                session.step(2.0 * period / count)
                forces.append(session.get("F_t"))
        chart.line(np.linspace(0.0, 2.0, count + 1), np.array(forces) / F_C, colour)
    for y, kappa, colour in (
        (-0.62, "0.5", COLOURS[0]),
        (-0.74, "5", COLOURS[1]),
        (-0.86, "100", COLOURS[2]),
    ):
        chart.text(0.03, y, f"κ = {kappa}", colour)
    return chart.svg()


def mean(fmu: FrictionFmu) -> str:
    """The mean friction over V / V_1 for four stiffnesses, and the Coulomb limit."""
    chart = Chart(
        "Mean friction against the velocity over the vibration's amplitude for four contact stiffnesses",
        "V / V_1",
        "F_t_mean / F_C",
        [0, 0.25, 0.5, 0.75, 1, 1.25, 1.5],
        [0, 0.25, 0.5, 0.75, 1],
    )
    ratios = np.concatenate(
        [np.linspace(0.0, 0.9, 37), np.linspace(0.91, 1.09, 19), np.linspace(1.1, 1.5, 9)]
    )
    for kappa, colour in zip((0.2, 1.0, 5.0, 100.0), COLOURS, strict=True):
        means = [periodic_mean(fmu, with_stiffness(kappa, ratio * V_1)) / F_C for ratio in ratios]
        chart.line(ratios, np.array(means), colour)
    coulomb = [2.0 / math.pi * math.asin(min(ratio, 1.0)) for ratio in ratios]
    chart.line(ratios, np.array(coulomb), INK, dashed=True)
    for y, kappa, colour in zip((0.48, 0.4, 0.32, 0.24), ("0.2", "1", "5", "100"), COLOURS, strict=True):
        chart.text(1.12, y, f"κ = {kappa}", colour)
    chart.text(1.12, 0.16, "Coulomb", INK)
    return chart.svg()


def main() -> None:
    with FrictionFmu(ROOT / "build" / "FrictionContact.fmu") as fmu:
        for name, plot in (("force", force), ("mean", mean)):
            path = Path(FMU_DOCS / f"{name}.svg")
            path.write_text(plot(fmu), encoding="utf-8")
            print(f"wrote {path.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
