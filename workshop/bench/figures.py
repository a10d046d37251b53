"""Pictures of the benchmarks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from frictioncontact import style
from workshop.bench.grade import Point

VIOLET = "#5e3c99"  # beside those of the methods, which take all of the cycle
COLOUR = {
    **style.METHOD,
    "Radau IIA": style.RED,
    "ARKODE implicit": VIOLET,
    "ARKODE explicit": VIOLET,
    "plain CVODE": style.ORANGE,
    "scipy Radau": style.GREY,
    "scipy BDF": style.GREY,
    "scipy LSODA": style.BLACK,
    "PythonFMU": style.BLACK,
}
LINE = {"scipy BDF": "--", "PythonFMU": ":", "plain CVODE": "--", "ARKODE explicit": "--"}
MARKER = {
    "collocation": "o",
    "cvode": "s",
    "Radau IIA": "P",
    "plain CVODE": "D",
    "scipy LSODA": "^",
    "PythonFMU": "v",
}
SHORT = {
    "backwardEuler": "b. Euler",
    "explicitEuler": "e. Euler",
    "plain CVODE": "CVODE",
    "Radau IIA": "Radau",
    "ARKODE implicit": "ARK impl.",
    "ARKODE explicit": "ARK expl.",
}
SMALLEST_ERROR = 1e-16
REASONS = {
    "too long for solver.method": "unstable: refused",
    "not finished": "too slow",
    "input derivatives": "no linear inputs",
    "error test failed": "error test fails",
    "mxstep": "too many steps",
    "h = ": "step becomes 0",
}


def short_reason(failure: str) -> str:
    return next((short for text, short in REASONS.items() if text in failure), failure[:24])


def work_precision(points: Sequence[Point], titles: Mapping[str, str], folder: Path) -> list[Path]:
    columns = min(3, len(titles))
    rows = -(-len(titles) // columns)
    figure, axes = style.subplots(rows, columns, size=(5.2 * columns, 3.9 * rows + 0.8), squeeze=False)
    for panel, name in zip(axes.flat, titles, strict=False):
        _diagram(panel, [p for p in points if p.case == name])
        panel.set_title(titles[name])
    for panel in axes.flat[len(titles) :]:
        panel.set_visible(False)
    handles = {}
    for panel in axes.flat:
        handles.update(zip(*reversed(panel.get_legend_handles_labels()), strict=True))
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=6)
    return style.save_both(figure, folder, "work-precision")


def price(rows: Sequence[Mapping[str, object]], titles: Mapping[str, str], folder: Path) -> list[Path]:
    """The default's cost over that of the cheapest other: scenes downwards, accuracies to the right."""
    accuracies = sorted({float(str(row["accuracy"])) for row in rows}, reverse=True)
    ratio = {(row["case"], row["accuracy"]): row for row in rows}
    figure, axes = style.subplots(1, 1, size=(10.5, 0.42 * len(titles) + 1.6))
    values = np.array([[float(str(ratio[name, a]["ratio"])) for a in accuracies] for name in titles])
    shown = np.where(values > 0.0, np.log10(np.maximum(values, 1e-6)), -3.0)
    axes.imshow(shown, cmap="RdYlGn_r", vmin=-1.5, vmax=1.5, aspect="auto")
    for i, name in enumerate(titles):
        for j, accuracy in enumerate(accuracies):
            row = ratio[name, accuracy]
            rival = SHORT.get(str(row["cheapest_other"]), row["cheapest_other"])
            text = "alone" if values[i, j] == 0.0 else f"{values[i, j]:.2g}\n{rival}"
            colour = "white" if shown[i, j] < -1.0 else style.BLACK
            axes.text(j, i, text, ha="center", va="center", fontsize=7, color=colour)
    axes.set_xticks(range(len(accuracies)), [f"{a:.0e}".replace("e-0", "e-") for a in accuracies])
    axes.set_yticks(range(len(titles)), list(titles.values()))
    axes.tick_params(length=0)
    axes.grid(visible=False)
    axes.set_xlabel(r"error of $F_t$ and its mean at most, over $F_C$")
    axes.set_title("CPU time of the default over that of the cheapest other method, named below")
    return style.save_both(figure, folder, "work-precision-price")


def _diagram(axes: Axes, points: Sequence[Point]) -> None:
    failures: list[tuple[str, str]] = []
    for method in dict.fromkeys(p.method for p in points):
        own = [p for p in points if p.method == method]
        good = [p for p in own if not p.failure]
        axes.loglog(
            [max(p.error, SMALLEST_ERROR) for p in good],
            [1e6 * p.cpu for p in good],
            color=COLOUR[method],
            linestyle=LINE.get(method, "-"),
            marker=MARKER.get(method, "."),
            markersize=4,
            label=method,
        )
        reasons = [short_reason(p.failure) for p in own if p.failure]
        if reasons:
            failures.append(
                (method, f"{method}: {max(set(reasons), key=reasons.count)} ({len(reasons)} of {len(own)})")
            )
    axes.set_xlim(SMALLEST_ERROR / 3, 30)
    if failures:  # room for them above the lines
        low, high = axes.get_ylim()
        axes.set_ylim(low, high * (high / low) ** (0.085 * len(failures)))
    axes.set_xlabel(r"largest error of $F_t$ and its mean, over $F_C$")
    axes.set_ylabel("CPU time per 50 µs simulated [µs]")
    for i, (method, text) in enumerate(failures):
        axes.text(
            0.99,
            0.985 - 0.052 * i,
            f"× {text}",
            transform=axes.transAxes,
            ha="right",
            va="top",
            fontsize=7,
            color=COLOUR[method],
        )


def step_sizes(rows: Sequence[Mapping[str, object]], folder: Path) -> list[Path]:
    sigmas = list(dict.fromkeys(row["sigma"] for row in rows))
    figure, axes = style.subplots(1, len(sigmas), size=(5.0 * len(sigmas), 4.0), squeeze=False)
    for panel, sigma in zip(axes.flat, sigmas, strict=True):
        for kind, colour, slope in (("held", style.ORANGE, 1), ("linear", style.BLUE, 2)):
            own = [row for row in rows if row["sigma"] == sigma and row["inputs"] == kind]
            H = 1.0 / np.array([row["samples_per_period"] for row in own], dtype=float)
            for key, marker, line in (("error_F_t", "o", "-"), ("error_F_t_mean", "s", "--")):
                errors = np.array([row[key] for row in own], dtype=float)
                label = f"{kind} inputs, {'mean of ' if 'mean' in key else ''}$F_t$"
                panel.loglog(H, errors, line, marker=marker, color=colour, label=label)
            guide = errors[-1] * (H / H[-1]) ** slope
            panel.loglog(H, 0.5 * guide, ":", color=style.GREY)
            panel.annotate(f"slope {slope}", (H[0], 0.5 * guide[0]), fontsize=8, color=style.GREY)
        panel.set_title(f"V, d from outside, σ {sigma:.0e} N/m".replace("e+", "e"))
        panel.set_xlabel("communication step over vibration period")
        panel.set_ylabel("largest error over $F_C$")
        panel.legend()
    return style.save_both(figure, folder, "step-size")


def periods(rows: Sequence[Mapping[str, object]], folder: Path) -> list[Path]:
    figure, axes = style.subplots(size=(5.5, 4.0))
    for method in dict.fromkeys(str(row["method"]) for row in rows):
        own = [row for row in rows if row["method"] == method and not row["failure"]]
        times = [1e6 * float(row["cpu_s_per_step"]) for row in own]  # type: ignore[arg-type]
        axes.loglog([row["periods"] for row in own], times, "o-", color=COLOUR[method], label=method)
    axes.set_title("One communication step over many periods")
    axes.set_xlabel("vibration periods in the step")
    axes.set_ylabel("CPU time of the step [µs]")
    axes.legend()
    return style.save_both(figure, folder, "periods")
