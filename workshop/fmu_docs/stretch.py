"""The drawing of docs/solver.md: one stretch between two reversals, and its panels in four contacts."""

from pathlib import Path

import numpy as np

from frictioncontact import style

KINDS = {
    "bounded": ("Gauss panel, error bounded beforehand", style.SKY),
    "judged": ("Gauss panels, each judged", style.BLUE),
    "Radau": ("Radau IIA panels, each judged", style.ORANGE),
    "settled": ("settled panel, closed form", style.GREEN),
}
# What the bristle relaxes by in the stretch; the panels' ends as parts of it, and their kinds.
CONTACTS = (
    ("soft: relaxes by less than 7", (0.0, 1.0), ("bounded",)),
    ("medium: by less than 40", (0.0, 1 / 3, 2 / 3, 1.0), ("judged",) * 3),
    ("stiff", (0.0, 0.03, 0.09, 0.2, 0.37, 0.6, 0.8, 0.92, 0.975, 1.0), ("Radau",) * 9),
    ("stiffest: follows its limit", (0.0, 0.012, 0.045, 1.0), ("Radau", "Radau", "settled")),
)
PEAK = 0.07  # of the stretch, that a Stribeck peak takes at each end


def draw(path: Path) -> None:
    """A schema: times are parts of the stretch, nothing is simulated."""
    figure, (speed, panels) = style.subplots(
        2, 1, size=(9.0, 5.2), sharex=True, gridspec_kw={"height_ratios": (1.0, 1.5)}
    )
    time = np.linspace(0.0, 1.0, 200)
    speed.plot(time, np.sin(np.pi * time), color=style.BLACK)
    for left in (0.0, 1.0 - PEAK):
        speed.axvspan(left, left + PEAK, color=style.PINK, alpha=0.35, lw=0)
    speed.text(PEAK + 0.01, 0.06, "Stribeck peak (LuGre)", color=style.GREY, fontsize=8.5)
    speed.text(0.5, 0.06, "between the peaks", color=style.GREY, fontsize=8.5, ha="center")
    speed.set(
        ylabel="|V|", yticks=[0], ylim=(0.0, 1.1), title="One stretch: from a reversal of V to the next"
    )

    for row, (name, ends, kinds) in enumerate(CONTACTS):
        y = -row
        for left, right, kind in zip(ends, ends[1:], kinds, strict=False):
            panels.barh(
                y, right - left, 0.46, left=left, color=KINDS[kind][1], edgecolor="white", linewidth=1.2
            )
        panels.text(0.0, y + 0.31, name, fontsize=9, va="bottom")
    for label, colour in KINDS.values():
        panels.barh(0, 0, color=colour, label=label)
    panels.grid(visible=False)
    panels.set(yticks=[], ylim=(-3.4, 0.75), xlim=(-0.01, 1.01), xticks=[0.0, 1.0])
    panels.set_xticklabels(["reversal", "reversal"])
    figure.legend(*panels.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    style.save(figure, path)
