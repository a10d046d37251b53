"""Pictures of stability."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import NullFormatter

from frictioncontact import style
from workshop.bench.coupling import Belt, Trajectory
from workshop.bench.exchange import MODEL_EXCHANGE

BEHAVIOUR = {
    "monotone": style.BLUE,
    "stable": style.SKY,
    "rings": style.AMBER,
    "diverges": style.RED,
    "refuses": style.LIGHT,
}
COUPLING = {"F_t held": style.ORANGE, "F_t linear": style.BLUE, MODEL_EXCHANGE: style.BLACK}


def draw_map(
    rows: Sequence[Mapping[str, Any]], edges: Sequence[Mapping[str, Any]], folder: Path
) -> list[Path]:
    methods = list(dict.fromkeys(row["method"] for row in rows))
    z = np.unique([row["z"] for row in rows])
    half = (z[1] / z[0]) ** 0.5
    figure, axes = style.subplots(size=(6.4, 4.2))
    for row in rows:
        left, colour = row["z"] / half, BEHAVIOUR[row["behaviour"]]
        axes.barh(methods.index(row["method"]), row["z"] * half - left, 0.72, left, color=colour, linewidth=0)
    for edge in edges:
        i = methods.index(edge["method"])
        axes.plot([edge["theory_z"]] * 2, [i - 0.48, i + 0.48], color=style.BLACK, linewidth=1.4)
        axes.plot(edge["measured_z"], i, "x", color=style.BLACK, markersize=5)
    axes.set(xscale="log", xlim=(z[0] / half, z[-1] * half), xlabel=r"$z = \sigma\,|V|\,h / F_C$")
    axes.set_yticks(range(len(methods)), methods)
    axes.invert_yaxis()
    axes.grid(False)
    axes.set_title("Steady sliding from rest: behaviour against z")
    handles: list[object] = [Patch(color=colour, label=name) for name, colour in BEHAVIOUR.items()]
    handles += [
        Line2D([], [], color=style.BLACK, label="limit in theory"),
        Line2D([], [], color=style.BLACK, marker="x", linestyle="", label="measured"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=4)
    return style.save_both(figure, folder, "stability")


def draw_coupled(
    errors: Sequence[Mapping[str, Any]],
    edges: Sequence[Mapping[str, Any]],
    reference: Trajectory,
    belt: Belt,
    folder: Path,
) -> list[Path]:
    figure, (motion, panel) = style.subplots(2, 1, size=(6.4, 7.2))
    t = np.linspace(0.0, belt.end, 1000)
    x, _, F = reference(t)
    motion.plot(1e3 * t, F / belt.F_C, color=style.BLACK, label=r"$F_t / F_C$")
    motion.plot(1e3 * t, belt.k * x / belt.F_C, color=style.GREEN, label=r"$k x / F_C$")
    motion.set(xlabel="time [ms]", title="Mass on a belt that moves to and fro, solved as one system")
    motion.legend()
    for coupling, colour in COUPLING.items():
        own = [row for row in errors if row["coupling"] == coupling]
        good, name = [row for row in own if not row["failure"]], coupling.replace("F_t", "$F_t$")
        steps, of_F_t = ([row[key] for row in good] for key in ("H", "error_F_t"))
        panel.loglog(steps, of_F_t, "o-", color=colour, label=name)
        bad = [row["H"] for row in own if row["failure"]]
        label = f"{name}: chatters" if bad else None
        panel.plot(bad, [2.0] * len(bad), "x", color=colour, label=label)
    for edge in edges:
        if np.isfinite(edge["theory_H"]):
            colour = COUPLING[edge["coupling"]]
            panel.axvline(edge["theory_H"], color=colour, linestyle="--", linewidth=1)
            panel.plot(edge["measured_H"], 1e-6, "^", color=colour)
    panel.xaxis.set_minor_formatter(NullFormatter())
    panel.set(
        xlabel="communication step; model exchange: time per evaluation of rates [s]",
        ylabel="largest error of $F_t$ over $F_C$",
        title="Jacobi master; dashed: stable up to here while it sticks",
    )
    panel.legend()
    return style.save_both(figure, folder, "coupled")
