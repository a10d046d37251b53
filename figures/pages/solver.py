"""The diagrams of docs/solver.md: nested spans of time, the controller as a flow, the ramp of a jump."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon, Rectangle

from figures.pages.diagrams import ANSWER, QUESTION, box
from frictioncontact import style
from frictioncontact.fmu import FrictionFmu, Session, Value

# ---- the nested spans ----

# The span, the ends of those in one of the row above, which one the next row divides, and what ends one.
SPANS: tuple[tuple[str, tuple[float, ...], int, str], ...] = (
    ("step", (0.0, 1.0), 0, "the tool's communication step"),
    (
        "period",
        (0.0, 0.23, 0.46, 0.69, 0.92, 1.0),
        1,
        "a period of the vibration; the last one is a remainder",
    ),
    ("segment", (0.0, 0.62, 1.0), 0, "the contact opens or closes; the load changes by a factor of 4"),
    ("interval", (0.0, 1.0), 0, "one map: a segment of one period, or of less than two"),
    ("part", (0.0, 0.2, 0.5, 0.8, 1.0), 1, "a center of |V|, or the middle between two centers"),
    ("panel", (0.0, 0.12, 0.3, 0.62, 1.0), 2, "the allowed error, or an event"),
    ("points", (), 0, "the start, and 9 stages of Radau IIA"),
)
RADAU = (0.0, 0.018, 0.091, 0.212, 0.368, 0.541, 0.709, 0.850, 0.948, 1.0)  # rounded, for the eye


def draw_spans(path: Path) -> None:
    """A row for each span, from the step down to the points; the next row is one span, enlarged."""
    figure, axes = style.subplots(size=(5.0, 6.8))
    axes.set(xlim=(0.0, 1.0), ylim=(0.0, len(SPANS) - 0.1))
    axes.axis("off")
    for k, (name, ends, which, words) in enumerate(SPANS):
        y = len(SPANS) - 1 - k
        axes.text(0.0, y + 0.56, name, fontsize=11, fontweight="bold", va="bottom", color=style.BLUE)
        axes.text(0.19, y + 0.57, words, fontsize=8.6, va="bottom", color=style.BLACK)
        for i, (start, end) in enumerate(zip(ends, ends[1:], strict=False)):
            chosen = QUESTION if i == which else ANSWER
            axes.add_patch(
                Rectangle(
                    (start, y + 0.1),
                    end - start,
                    0.42,
                    lw=1.4,
                    facecolor=chosen["fc"],
                    edgecolor=chosen["ec"],
                )
            )
        if ends:
            shadow = ((ends[which], y + 0.1), (ends[which + 1], y + 0.1), (1.0, y - 0.48), (0.0, y - 0.48))
            axes.add_patch(Polygon(shadow, color=style.ORANGE, alpha=0.08, lw=0, zorder=0))
        else:
            axes.plot([0.0, 1.0], [y + 0.3, y + 0.3], color=style.BLUE, lw=1.4)
            axes.plot(RADAU, [y + 0.3] * len(RADAU), "o", color=style.ORANGE, ms=7, clip_on=False)
    style.save(figure, path)


# ---- the controller ----

FLOW = {  # the place and the words of a box; a question is orange
    "plan": (0.33, 0.93, "plan the length h\nfc_control_length", ANSWER),
    "make": (0.33, 0.72, "make the panel\nfc_make_panel", ANSWER),
    "judge": (0.33, 0.50, "judge: error ratio ≤ 1 ?\nfc_control_error_ratio", QUESTION),
    "event": (0.33, 0.28, "does the panel contain\nan event?", QUESTION),
    "accept": (0.33, 0.07, "accept: append the map\nfc_accept_panel", ANSWER),
    "reduce": (0.80, 0.61, "shorten h\nby the ratio", ANSWER),
    "cut": (0.80, 0.175, "shorten h to\nthe event", ANSWER),
}
SIZES = {"reduce": (0.29, 0.11), "cut": (0.29, 0.11)}
SIZE = (0.60, 0.115)
MIDDLE = 0.33
DOWN = ("make", "judge", "event", "accept")


def draw_controller(path: Path) -> None:
    """Down the left what happens to a panel; to the right how it becomes shorter."""
    figure, axes = style.subplots(size=(4.8, 6.2))
    axes.set(xlim=(-0.01, 1.01), ylim=(-0.01, 1.01))
    axes.axis("off")
    for name, (x, y, words, look) in FLOW.items():
        box(axes, x, y, SIZES.get(name, SIZE), words, look, fontsize=10)
    for (start, word), end in zip(
        (("plan", ""), ("make", ""), ("judge", "yes"), ("event", "no")), DOWN, strict=True
    ):
        top, bottom = FLOW[start][1] - SIZE[1] / 2, FLOW[end][1] + SIZE[1] / 2
        _flow(axes, (MIDDLE, top), (MIDDLE, bottom))
        axes.text(MIDDLE + 0.03, (top + bottom) / 2, word, va="center", color=style.ORANGE)
    for question, answer, word in (("judge", "reduce", "no"), ("event", "cut", "yes")):
        (x, y, *_), (x_answer, y_answer, *_) = FLOW[question], FLOW[answer]
        edge = x + SIZE[0] / 2
        _flow(
            axes,
            (edge, y),
            (x_answer, y),
            (x_answer, y_answer + np.sign(y - y_answer) * SIZES[answer][1] / 2),
        )
        axes.text((edge + x_answer) / 2, y + 0.015, word, ha="center", va="bottom", color=style.ORANGE)
    y = FLOW["make"][1]  # a shorter panel is made again
    _flow(
        axes,
        (FLOW["reduce"][0], FLOW["reduce"][1] + SIZES["reduce"][1] / 2),
        (FLOW["reduce"][0], y),
        (MIDDLE + SIZE[0] / 2, y),
    )
    side = 1.0  # the way back of a cut panel, beside the box of a rejected one
    right = FLOW["cut"][0] + SIZES["cut"][0] / 2
    _flow(
        axes,
        (right, FLOW["cut"][1]),
        (side, FLOW["cut"][1]),
        (side, y + 0.03),
        (MIDDLE + SIZE[0] / 2, y + 0.03),
    )
    style.save(figure, path)


def _flow(axes: Axes, *points: tuple[float, float]) -> None:
    """An arrow along straight lines."""
    *first, last = points
    look = {"arrowstyle": "-|>", "color": style.GREY, "lw": 1.4, "shrinkA": 0, "shrinkB": 1}
    axes.plot(*np.transpose(first), color=style.GREY, lw=1.4)
    axes.annotate("", last, first[-1], arrowprops=look)


# ---- the ramp of a jump ----

INSTANT = 1e-20  # s, in which the bristle does not move
CLOSED, OPEN = 12.9e-6, 14e-6  # m, d after the jump and before it
JUMPS: dict[str, tuple[float, float, str]] = {  # the static ratio, and |delta| over D before the jump
    "Dahl": (1.0, 0.7, "no static friction"),
    "ElasticPlastic": (1.5, 0.9, "stuck, static ratio 1.5"),
}


def ramp(fmu: FrictionFmu, law: str, steps: int) -> np.ndarray:
    """D and |delta| over the first D, after each of so many equal jumps of d."""
    static_ratio, part, _ = JUMPS[law]
    scene: dict[str, Value] = {
        "friction.model": law,
        "friction.limit": "Load",
        "friction.staticRatio": static_ratio,
        "d": OPEN,
        "V": 1.0,  # outward, far beyond the Stribeck curve
    }
    with fmu.session(scene) as session:
        first = _bound(session)
    rows = []
    with fmu.session(scene | {"delta_0": part * first}) as session:
        session.step(INSTANT)
        for d in np.linspace(OPEN, CLOSED, steps + 1):
            session.set("d", d)
            session.step(INSTANT)
            rows.append((_bound(session), session.get("delta")))
    return np.array(rows) / first


def _bound(session: Session) -> float:
    """The kinetic bound D [m] under the present load."""
    return session.get("friction.mu") * session.get("F_n") / session.get("sigma")


def draw_jump(fmu: FrictionFmu, path: Path) -> None:
    """Two bristles, each over a ramp of 400 jumps (line), and after one jump (point)."""
    figure, grid = style.subplots(2, 1, size=(4.8, 7.6))
    for axes, (law, (static_ratio, part, title)) in zip(grid, JUMPS.items(), strict=True):
        D, delta = ramp(fmu, law, 400).T
        end = ramp(fmu, law, 1)[-1]
        axes.plot([0.0, 1.1], [0.0, 1.1], color=style.GREY, lw=1.4)
        axes.text(0.30, 0.22, "kinetic bound: |δ| = D", fontsize=9.5, color=style.GREY)
        if static_ratio > 1.0:
            axes.plot([0.0, 1.1], [0.0, 1.1 * static_ratio], color=style.PINK, lw=1.4, ls="--")
            axes.text(0.27, 0.60, "static bound:\n|δ| = 1.5 D", fontsize=9.5, color=style.PINK, ha="center")
        axes.plot(D, delta, color=style.BLUE, lw=2.6)
        axes.plot(1.0, part, "o", color=style.BLUE, ms=8, label="before the jump")
        axes.plot(*end, "o", color=style.ORANGE, ms=8, label="after the jump, in one step")
        axes.annotate(
            "", (0.78, part), (0.95, part), arrowprops={"arrowstyle": "-|>", "color": style.BLUE, "lw": 2}
        )
        axes.set(
            title=title, xlim=(0.0, 1.1), ylim=(0.0, 1.1), xlabel="D / D before", ylabel="|δ| / D before"
        )
        axes.legend(loc="upper left")
    style.save(figure, path)
