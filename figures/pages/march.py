"""The pictures of docs/solver.md: panels of a period in u, regimes of a bristle, a period as a map."""

import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import FancyArrowPatch

from figures.pages.diagrams import ANSWER, box
from frictioncontact import style
from frictioncontact.fmu import FrictionFmu, Value
from frictioncontact.parameters import COULOMB_FORCE, FREQUENCY, PERIOD, STIFFNESS_PRINTED
from tools.build import build_targets

# ---- the panels of a period ----

STIFFNESSES = (6e4, 6e6, 6e8, 6e12)  # N/m
SCENE = "tolerance=1e-6 V=0.3 V_1=1.44 a_d=1.1e-6 initial=Settled"  # in the hunt's words
REVERSALS = np.arccos(-0.3 / 1.44) / (2.0 * np.pi) * np.array([1.0, -1.0]) * PERIOD + [0.0, PERIOD]


@dataclass(frozen=True)
class Panel:
    t: tuple[float, float]  # s
    u: tuple[float, float]
    length: float  # s, L of t = t_c + L sinh u; infinite for t = t_c + u

    def course(self) -> tuple[np.ndarray, np.ndarray]:
        """u from the panel's start on, in radians of the vibration where it is a time; and t."""
        u = np.linspace(*self.u, 40)
        if np.isinf(self.length):
            return 2.0 * np.pi * FREQUENCY * (u - u[0]), self.t[0] + u - u[0]
        return u - u[0], self.t[0] + self.length * (np.sinh(u) - np.sinh(u[0]))


def panels(stiffness: float) -> list[Panel]:
    """Those of a period from a settled start, as the march takes them."""
    program = build_targets("default", ["panels"]) / "hunt" / "panels"
    sequence = f"{SCENE} h={PERIOD!r} stiffnessScale={stiffness / STIFFNESS_PRINTED!r}"
    said = subprocess.run([program, sequence], check=True, capture_output=True, text=True).stdout
    lines = [line for line in said.splitlines() if line.endswith("relaxes")]
    rows = [[float(word) for word in line.split()[:5]] for line in lines]
    return [Panel((t, t_end), (u, u_end), length) for t, t_end, u, u_end, length in rows]


def draw_panels(path: Path) -> None:
    figure, grid = style.subplots(2, 2, size=(5.2, 6.4), sharey=True)
    for axes, stiffness in zip(grid.flat, STIFFNESSES, strict=True):
        _draw_course(axes, stiffness)
    for axes in grid[:, 0]:
        axes.set_ylabel("t [µs]")
    style.save(figure, path)


def _draw_course(axes: Axes, stiffness: float) -> None:
    found = panels(stiffness)
    for time in REVERSALS:
        axes.axhline(1e6 * time, color=style.PINK, lw=1.2, ls="--")
    place = 0.0
    for panel in found:
        u, t = panel.course()
        axes.plot(place + u, 1e6 * t, color=style.BLUE)
        place += u[-1]
        axes.plot(place, 1e6 * t[-1], "o", color=style.ORANGE, ms=4.5)
    axes.plot(0.0, 0.0, "o", color=style.ORANGE, ms=4.5)
    axes.text(0.02 * place, 1e6 * REVERSALS[0] + 0.7, "V = 0", color=style.PINK, fontsize=9)
    exponent = int(np.log10(stiffness))
    straight = np.isinf(found[0].length)
    axes.set(title=f"6·10$^{{{exponent}}}$ N/m: {len(found)} panels", ylim=(0.0, 1e6 * PERIOD))
    axes.set_xlabel("ω u, with t = u" if straight else "u, added up")


# ---- the regimes ----

BOXES = {
    "open": (0.5, 0.93, "open\nδ = 0, F = 0"),
    "free": (0.5, 0.67, "stuck or relaxing\nδ' = V − r δ,  r = 0 in ElasticPlastic"),
    "slips": (0.5, 0.35, "slipping along its bound\n|δ| = D"),
    "inside": (0.5, 0.07, "slipping inside its bound\nδ' = V, with static friction alone"),
}
# From, to, where the arrow leaves and arrives (x), its bend, and what it says at (x, y).
ARROWS = (
    ("open", "free", 0.42, 0.42, 0.0, "closes", (0.40, 0.80), "right"),
    ("free", "open", 0.58, 0.58, 0.0, "opens, from any state:\nδ is lost", (0.60, 0.80), "left"),
    ("free", "slips", 0.42, 0.42, 0.0, "meets D, push > 0\n(drops to the kinetic D)", (0.40, 0.51), "right"),
    ("slips", "free", 0.58, 0.58, 0.0, "push ends", (0.60, 0.51), "left"),
    ("slips", "inside", 0.42, 0.42, 0.0, "an input jumps", (0.40, 0.21), "right"),
    ("inside", "slips", 0.58, 0.58, 0.0, "meets D", (0.60, 0.21), "left"),
    ("inside", "free", 0.80, 0.80, 0.5, "push ends", (0.945, 0.37), "right"),
)
WIDTH, HEIGHT = 0.60, 0.10  # of a box


def draw_regimes(path: Path) -> None:
    figure, axes = style.subplots(size=(5.2, 6.4))
    axes.set(xlim=(0.0, 1.0), ylim=(-0.01, 1.01))
    axes.axis("off")
    for x, y, text in BOXES.values():
        box(axes, x, y, (WIDTH, HEIGHT), text, ANSWER, rounding=0.03, fontsize=9.5)
    for start, end, left, right, bend, text, place, side in ARROWS:
        _draw_arrow(axes, (left, BOXES[start][1]), (right, BOXES[end][1]), bend)
        axes.text(*place, text, ha=side, va="center", fontsize=9, color=style.ORANGE)
    style.save(figure, path)


def _draw_arrow(axes: Axes, start: tuple[float, float], end: tuple[float, float], bend: float) -> None:
    """From the edge of a box to that of the next; a bent one leaves and arrives on the side."""
    if bend == 0.0:
        way = np.sign(end[1] - start[1]) * HEIGHT / 2
        start, end = (start[0], start[1] + way), (end[0], end[1] - way)
    look = {"arrowstyle": "-|>", "mutation_scale": 14, "shrinkA": 1, "shrinkB": 1}
    arrow = FancyArrowPatch(start, end, connectionstyle=f"arc3,rad={bend}", **look)
    arrow.set(color=style.ORANGE, linewidth=1.5)
    axes.add_patch(arrow)


# ---- a period as a clamped map ----

MAPS: dict[str, dict[str, Value]] = {
    "ElasticPlastic": {
        "friction.model": "ElasticPlastic",
        "contact.model": "Constant",
        "contact.sigma": 0.3 * 2.0 * np.pi * FREQUENCY * COULOMB_FORCE,  # kappa = 0.3
        "V": 0.1,
        "vibration.V_1": 1.0,
    },
    "Dahl under a vibrating load": {
        "friction.limit": "Load",
        "contact.stiffnessScale": 2e6 / STIFFNESS_PRINTED,
        "V": 0.12,
        "vibration.a_d": 1.1e-6,
    },
}
LARGEST = (1.0, 0.4)  # of the starts, over D at the begin of the period
FIRST = (-0.9, -0.3)  # of the periods that are drawn


def end_of_period(fmu: FrictionFmu, scene: dict[str, Value], start: float) -> float:
    with fmu.session(scene | {"delta_0": start}) as session:
        session.step(PERIOD)
        return session.get("delta")


def bound(fmu: FrictionFmu, scene: dict[str, Value]) -> float:
    with fmu.session(scene) as session:
        follows = scene.get("friction.limit") == "Load"
        limit = session.get("friction.mu") * session.get("F_n") if follows else session.get("F_C")
        return limit / session.get("sigma")


def draw_map(fmu: FrictionFmu, path: Path) -> None:
    figure, both = style.subplots(2, 1, size=(4.2, 8.0))
    for axes, (title, scene), most, first in zip(both, MAPS.items(), LARGEST, FIRST, strict=True):
        D = bound(fmu, scene)
        starts = most * np.linspace(-1.0, 1.0, 161)
        ends = np.array([end_of_period(fmu, scene, x * D) / D for x in starts])
        low, high = ends[0], ends[-1]
        free = (ends > low + 1e-3 * most) & (ends < high - 1e-3 * most)
        slope, offset = np.polyfit(starts[free], ends[free], 1)
        axes.plot(starts, starts, color=style.GREY, lw=1.0)
        axes.plot(starts, slope * starts + offset, color=style.BLUE, lw=1.2, ls="--")
        axes.plot(starts, ends, color=style.BLUE, lw=2.6)
        for level, name, x, side in ((low, "lo", 0.98, "right"), (high, "hi", -0.98, "left")):
            axes.axhline(level, color=style.LIGHT, lw=1.0, zorder=1)
            axes.text(x * most, level + 0.02 * most, name, ha=side, va="bottom", fontsize=9)
        edge = (high - offset) / slope
        axes.axvline(edge, color=style.PINK, lw=1.2, ls="--")
        axes.text(edge + 0.03 * most, -0.93 * most, "e", color=style.PINK)
        _draw_periods(axes, fmu, scene, D, first)
        square = {"xlim": (-most, most), "ylim": (-most, most), "aspect": "equal"}
        axes.set(title=f"{title}: P = {slope:.2g}", xlabel="δ₀/D", ylabel="δ₁/D, a period later", **square)
    style.save(figure, path)


def _draw_periods(axes: Axes, fmu: FrictionFmu, scene: dict[str, Value], D: float, start: float) -> None:
    """A bristle from period to period: up to the map, and across to the line on which an end is a start."""
    x, y = [start], [start]
    for _ in range(25):
        end = end_of_period(fmu, scene, start * D) / D
        x += [start, end]
        y += [end, end]
        start = end
    axes.plot(x, y, color=style.ORANGE, lw=1.2)
    axes.plot(x[-1], y[-1], "o", color=style.ORANGE)
