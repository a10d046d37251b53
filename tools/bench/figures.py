"""Pictures of the benchmarks."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import NullFormatter

from frictioncontact import style
from frictioncontact.advice.stuck_mass import GAUSS_SEIDEL
from tools.bench.coupling import Belt, Trajectory
from tools.bench.exchange import MODEL_EXCHANGE

METHODS = {  # that the chart shows: label and colour
    "collocation": ("the default", style.BLUE),
    "Radau 5": ("Radau IIA, order 5", style.PINK),
    "Radau 9": ("order 9", style.ORANGE),
    "Radau 13": ("order 13", style.RED),
    "plain CVODE": ("CVODE", style.GREEN),
}
MASS_METHODS = {  # of a mass: label and colour
    "collocation": ("panels", style.BLUE),
    "cvode": ("CVODE in the FMU", style.GREEN),
    MODEL_EXCHANGE: ("scipy's BDF, model exchange", style.ORANGE),
    GAUSS_SEIDEL: ("mass in a Gauss-Seidel master", style.BLACK),
}
BEHAVIOUR = {
    "monotone": style.BLUE,
    "stable": style.SKY,
    "rings": style.AMBER,
    "diverges": style.RED,
    "refuses": style.LIGHT,
}
COUPLING = {"F_t held": style.ORANGE, "F_t linear": style.BLUE, MODEL_EXCHANGE: style.BLACK}
SHOWN = ("vibrating-6e06", "vibrating-6e10", "vibrating-V", "vibrating-d", "linear", "sampled-20-linear-6e06")
SMALLEST_ERROR = 1e-16


def save_both(figure: Figure, folder: Path, name: str) -> list[Path]:
    """Saves as name.svg and name.png in the folder."""
    paths = [folder / f"{name}.svg", folder / f"{name}.png"]
    style.save(figure, *paths)
    return paths


def work_precision(points: Sequence[Any], titles: Mapping[str, str], folder: Path) -> list[Path]:
    """Small multiples of the scenes in SHOWN, of those that were measured; every method is in the CSV."""
    names = [name for name in SHOWN if name in titles] or list(titles)
    table = pd.DataFrame(points).query("failure == ''").sort_values("setting")
    rows = -(-len(names) // 2)
    figure, axes = style.subplots(rows, 2, size=(5.2, 2.3 * rows + 1.0), sharex=True, squeeze=False)
    for panel, name in zip(axes.flat, names, strict=False):
        for method, (label, colour) in METHODS.items():
            own = table[(table.case == name) & (table.method == method)]
            errors = own[["error_F_t", "error_F_t_mean"]].max(axis=1).clip(SMALLEST_ERROR)
            width = 2.4 if method == "collocation" else 1.4
            panel.loglog(errors, 1e6 * own.cpu, "o-", color=colour, lw=width, ms=3, label=label)
        panel.set(xlim=(3.0, SMALLEST_ERROR / 3), xticks=[1.0, 1e-4, 1e-8, 1e-12, 1e-16])
        panel.set_title(titles[name].replace(", ", "\n", 1))
        panel.yaxis.set_minor_formatter(NullFormatter())
    for panel in axes.flat[len(names) :]:
        panel.set_visible(False)
    for panel in axes[-1]:
        panel.set_xlabel("error over $F_C$")
    figure.supylabel("CPU time for 50 µs [µs]", fontsize=10)
    figure.legend(*axes.flat[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return save_both(figure, folder, "work-precision")


def mass_work(points: Sequence[Any], titles: Mapping[str, str], path: Path) -> None:
    """A panel a scene; a point's cpu is over simulated time. An error of rounding is drawn at its size."""
    rows = -(-len(titles) // 2)
    figure, axes = style.subplots(rows, 2, size=(5.2, 2.4 * rows + 0.9), sharex=True, sharey=True)
    table = pd.DataFrame(points).query("failure == ''")
    for panel, (name, title) in zip(axes.flat, titles.items(), strict=True):
        panel.axhline(1.0, color=style.GREY, lw=0.9, ls="--")
        for method, (label, colour) in MASS_METHODS.items():
            own = table[(table.case == name) & (table.method == method)]
            errors = own[["error_F_t", "error_F_t_mean"]].max(axis=1).clip(SMALLEST_ERROR)
            panel.loglog(errors, own.cpu, "o-", color=colour, ms=3, label=label)
            if method == GAUSS_SEIDEL:  # its longest step
                panel.loglog(errors.iloc[0], own.cpu.iloc[0], "x", color=colour, ms=9, mew=1.8)
        panel.set(xlim=(30.0, SMALLEST_ERROR / 3), xticks=[1.0, 1e-4, 1e-8, 1e-12, 1e-16])
        panel.set_title(title.replace(", ", "\n", 1))
    for panel in axes[-1]:
        panel.set_xlabel("error over $F_C$")
    style.note(axes.flat[0], "real time", 0.72, 0.6)
    figure.supylabel("CPU time over simulated time", fontsize=10)
    figure.legend(*axes.flat[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    style.save(figure, path)


def step_sizes(rows: Sequence[Mapping[str, object]], folder: Path) -> list[Path]:
    tables = dict([*pd.DataFrame(rows).groupby("sigma")])
    figure, axes = style.subplots(len(tables), 1, size=(5.2, 3.4 * len(tables)), squeeze=False)
    for panel, (sigma, table) in zip(axes.flat, tables.items(), strict=True):
        for kind, colour, slope in (("held", style.ORANGE, 1), ("linear", style.BLUE, 2)):
            own = table[table.inputs == kind]
            H = 1.0 / own.samples_per_period.to_numpy()
            for key, words, look in (("error_F_t", "", "o-"), ("error_F_t_mean", "mean of ", "s--")):
                panel.loglog(H, own[key], look, color=colour, label=f"{kind} inputs, {words}$F_t$")
            guide = own.error_F_t_mean.iloc[-1] * (H / H[-1]) ** slope
            panel.loglog(H, 0.5 * guide, ":", color=colour, label=f"slope {slope}")
        title = f"V, d from outside, σ {sigma:.0e} N/m".replace("e+0", "e").replace("e+", "e")
        panel.set(title=title, xlabel="communication step over vibration period")
        panel.set_ylabel("largest error over $F_C$")
    figure.legend(*axes.flat[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return save_both(figure, folder, "step-size")


def periods(rows: Sequence[Mapping[str, object]], folder: Path) -> list[Path]:
    """A panel a law: evaluations of a step over those of one period with held inputs."""
    figure, axes = style.subplots(2, 2, size=(5.2, 5.4), sharex=True, sharey=True)
    colours, looks = {"held": style.BLUE, "moving": style.ORANGE}, {"Constant": "o-", "Load": "s--"}
    by_law = pd.DataFrame(rows).groupby("law", sort=False)
    for panel, (law, table) in zip(axes.flat, by_law, strict=True):
        for (kind, limit), own in table.groupby(["inputs", "limit"]):
            look = {"color": colours[kind], "ms": 4, "label": f"{kind}, limit {limit}"}
            panel.loglog(own.periods, own.ratio, looks[limit], **look)
        panel.set(title=law, xticks=[1, 1e2, 1e4, 1e6])
    for panel in axes[-1]:
        panel.set_xlabel("periods in the step")
    figure.supylabel("evaluations over those of one period, held", fontsize=10)
    figure.legend(*axes.flat[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return save_both(figure, folder, "periods")


def stability(
    rows: Sequence[Mapping[str, Any]], edges: Sequence[Mapping[str, Any]], folder: Path
) -> list[Path]:
    table = pd.DataFrame(rows)
    methods, z = list(table.method.unique()), table.z.unique()
    half = (z[1] / z[0]) ** 0.5
    figure, axes = style.subplots(size=(5.2, 4.4))
    places, colours = table.method.map(methods.index), table.behaviour.map(BEHAVIOUR)
    axes.barh(places, table.z * (half - 1.0 / half), 0.72, table.z / half, color=colours, linewidth=0)
    for edge in edges:
        i = methods.index(edge["method"])
        axes.plot([edge["theory_z"]] * 2, [i - 0.48, i + 0.48], color=style.BLACK, linewidth=1.4)
        axes.plot(edge["measured_z"], i, "x", color=style.BLACK, markersize=5)
    axes.set(xscale="log", xlim=(z[0] / half, z[-1] * half), xlabel=r"$z = \sigma\,|V|\,h / F_C$")
    axes.set_yticks(range(len(methods)), methods)
    axes.invert_yaxis()
    axes.grid(False)
    axes.set_title("Steady sliding from rest")
    handles: list[object] = [Patch(color=colour, label=name) for name, colour in BEHAVIOUR.items()]
    handles += [
        Line2D([], [], color=style.BLACK, label="limit in theory"),
        Line2D([], [], color=style.BLACK, marker="x", linestyle="", label="measured"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=4)
    return save_both(figure, folder, "stability")


def coupled(
    errors: Sequence[Mapping[str, Any]],
    edges: Sequence[Mapping[str, Any]],
    reference: Trajectory,
    belt: Belt,
    folder: Path,
) -> list[Path]:
    figure, (motion, panel) = style.subplots(2, 1, size=(5.2, 7.0))
    t = np.linspace(0.0, belt.end, 1000)
    x, _, F = reference(t)
    motion.plot(1e3 * t, F / belt.F_C, color=style.BLACK, label=r"$F_t / F_C$")
    motion.plot(1e3 * t, belt.k * x / belt.F_C, color=style.GREEN, label=r"$k x / F_C$")
    motion.set(xlabel="time [ms]", title="Mass on a belt, solved as one system")
    motion.legend()
    table = pd.DataFrame(errors)
    for coupling, colour in COUPLING.items():
        own, name = table[table.coupling == coupling], coupling.replace("F_t", "$F_t$")
        good, bad = own[own.failure == ""], own[own.failure != ""]
        panel.loglog(good.H, good.error_F_t, "o-", color=colour, label=name)
        label = f"{name}: chatters" if len(bad) else None
        panel.plot(bad.H, [2.0] * len(bad), "x", color=colour, label=label)
    for edge in edges:
        if np.isfinite(edge["theory_H"]):
            colour = COUPLING[edge["coupling"]]
            panel.axvline(edge["theory_H"], color=colour, linestyle="--", linewidth=1)
            panel.plot(edge["measured_H"], 1e-6, "^", color=colour)
    panel.xaxis.set_minor_formatter(NullFormatter())
    panel.set(
        xlabel="communication step, or time per evaluation of rates [s]",
        ylabel="largest error of $F_t$ over $F_C$",
        title="Jacobi master; dashed: limit of stable sticking",
    )
    panel.legend(loc="upper center", bbox_to_anchor=(0.5, -0.17), ncols=2)
    return save_both(figure, folder, "coupled")
