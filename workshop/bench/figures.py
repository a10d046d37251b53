"""Pictures of the benchmarks."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from frictioncontact import style

METHODS = {  # that the chart shows: label and colour
    "collocation": ("the default", style.BLUE),
    "Radau 5": ("Radau IIA, order 5", style.PINK),
    "Radau 9": ("order 9", style.ORANGE),
    "Radau 13": ("order 13", style.RED),
    "plain CVODE": ("CVODE", style.GREEN),
}
SHOWN = ("vibrating-6e06", "vibrating-6e10", "vibrating-V", "vibrating-d", "linear", "sampled-20-linear-6e06")
SMALLEST_ERROR = 1e-16


def work_precision(points: Sequence[Any], titles: Mapping[str, str], folder: Path) -> list[Path]:
    """Small multiples of the scenes in SHOWN, of those that were measured; every method is in the CSV."""
    names = [name for name in SHOWN if name in titles] or list(titles)
    rows = -(-len(names) // 2)
    figure, axes = style.subplots(rows, 2, size=(6.4, 2.5 * rows + 0.9), sharex=True, squeeze=False)
    for panel, name in zip(axes.flat, names, strict=False):
        for method, (label, colour) in METHODS.items():
            good = sorted(
                (p for p in points if p.case == name and p.method == method and not p.failure),
                key=lambda p: p.setting,
            )
            panel.loglog(
                [max(p.error, SMALLEST_ERROR) for p in good],
                [1e6 * p.cpu for p in good],
                "o-",
                color=colour,
                linewidth=2.4 if method == "collocation" else 1.4,
                markersize=3,
                label=label,
            )
        panel.set_title(titles[name])
        panel.set_xlim(3.0, SMALLEST_ERROR / 3)
        panel.set_xticks([1.0, 1e-4, 1e-8, 1e-12, 1e-16])
    for panel in axes.flat[len(names) :]:
        panel.set_visible(False)
    for panel in axes[-1]:
        panel.set_xlabel(r"error of $F_t$ and its mean, over $F_C$")
    figure.supylabel("CPU time for 50 µs [µs]", fontsize=10)
    figure.legend(*axes.flat[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return style.save_both(figure, folder, "work-precision")


def step_sizes(rows: Sequence[Mapping[str, object]], folder: Path) -> list[Path]:
    sigmas = list(dict.fromkeys(row["sigma"] for row in rows))
    figure, axes = style.subplots(len(sigmas), 1, size=(6.4, 3.6 * len(sigmas)), squeeze=False)
    for panel, sigma in zip(axes.flat, sigmas, strict=True):
        for kind, colour, slope in (("held", style.ORANGE, 1), ("linear", style.BLUE, 2)):
            own = [row for row in rows if row["sigma"] == sigma and row["inputs"] == kind]
            H = 1.0 / np.array([row["samples_per_period"] for row in own], dtype=float)
            for key, marker, line in (("error_F_t", "o", "-"), ("error_F_t_mean", "s", "--")):
                errors = np.array([row[key] for row in own], dtype=float)
                label = f"{kind} inputs, {'mean of ' if 'mean' in key else ''}$F_t$"
                panel.loglog(H, errors, line, marker=marker, color=colour, label=label)
            guide = errors[-1] * (H / H[-1]) ** slope
            panel.loglog(H, 0.5 * guide, ":", color=colour, label=f"slope {slope}")
        panel.set_title(f"V, d from outside, σ {sigma:.0e} N/m".replace("e+0", "e").replace("e+", "e"))
        panel.set_xlabel("communication step over vibration period")
        panel.set_ylabel("largest error over $F_C$")
    figure.legend(*axes.flat[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return style.save_both(figure, folder, "step-size")


def periods(rows: Sequence[Mapping[str, object]], folder: Path) -> list[Path]:
    """A panel a law: evaluations of a step over those of one period with held inputs."""
    laws = list(dict.fromkeys(str(row["law"]) for row in rows))
    figure, axes = style.subplots(2, 2, size=(5.2, 5.4), sharex=True, sharey=True)
    for panel, law in zip(axes.flat, laws, strict=True):
        for kind, colour in (("held", style.BLUE), ("moving", style.ORANGE)):
            for limit, dash in (("Constant", "o-"), ("Load", "s--")):
                own = [row for row in rows if (row["law"], row["limit"], row["inputs"]) == (law, limit, kind)]
                panel.loglog(
                    [row["periods"] for row in own],
                    [row["ratio"] for row in own],
                    dash,
                    color=colour,
                    markersize=4,
                    label=f"{kind}, limit {limit}",
                )
        panel.set_title(law)
        panel.set_xticks([1, 1e2, 1e4, 1e6])
    for panel in axes[-1]:
        panel.set_xlabel("periods in the step")
    figure.supylabel("evaluations over those of one period, held", fontsize=10)
    figure.legend(*axes.flat[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return style.save_both(figure, folder, "periods")
