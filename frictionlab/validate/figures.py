"""One figure a measurement: what was measured, and what each law says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from frictionlab import style
from frictionlab.validate.longitudinal import Fit
from frictionlab.validate.loop import LoopFit
from frictionlab.validate.measurements import Loop, NormalVibration, Sliding
from frictionlab.validate.normal import NormalFit, reduction

LAW = {
    "Coulomb": style.GREY,
    "Dahl": style.ORANGE,
    "LuGre": style.PINK,
    "ElasticPlastic": style.BLUE,
    "a constant ratio": style.GREEN,
}


def longitudinal(results: Mapping[str, tuple[Sliding, Sequence[Fit]]]) -> Figure:
    figure, axes = style.subplots(1, len(results), size=(10.0, 4.2))
    for panel, (name, (data, fits)) in zip(axes, results.items(), strict=True):
        V = 1e3 * data.V
        panel.loglog(V, data.without, "o", color=style.BLACK, mfc="white", label="measured,\nno vibration")
        panel.loglog(V, data.vibrated, "o", color=style.BLACK, label="measured,\nvibrated")
        for fit in fits:
            if fit.law == "Dahl":
                panel.fill_between(V, fit.least, fit.most, color=LAW["Dahl"], alpha=0.3, lw=0)
                panel.plot([], [], lw=6, color=LAW["Dahl"], alpha=0.4, label="Dahl, LuGre:\nany stiffness")
            elif fit.law != "LuGre":
                label = fit.law if fit.law != "ElasticPlastic" else "ElasticPlastic,\nstiffness fitted"
                dash = ":" if fit.law == "a constant ratio" else "--" if fit.law == "Coulomb" else "-"
                panel.loglog(V, fit.model, dash, color=LAW[fit.law], label=label)
        panel.set(xlabel="sliding velocity [mm/s]", title=f"{name}: 26 kHz, 0.35 µm along the sliding")
        panel.set_ylim(1e-3, 20.0)
    axes[0].set_ylabel("mean friction [N]")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside right center")
    return figure


def loop(data: Loop, fits: Sequence[LoopFit]) -> Figure:
    figure, (path, time) = style.subplots(1, 2, size=(10.0, 4.2))
    half = len(data.time) // 2
    path.plot(1e3 * data.position, data.friction, ".", ms=2, color=style.BLACK, label="measured")
    time.plot(data.time, data.friction, ".", ms=2, color=style.BLACK)
    for fit in fits:
        if fit.stiffness is None:
            continue
        label = f"{fit.law}, {fit.stiffness * 1e-3:.1f} N/mm, {fit.F_C:.2f} N"
        path.plot(1e3 * data.position[half:], fit.friction[half:], color=LAW[fit.law], label=label)
        time.plot(data.time, fit.friction, color=LAW[fit.law])
    time.axvspan(data.time[0], data.time[half], color=style.LIGHT, alpha=0.4, lw=0)
    path.set(xlabel="position [mm]", ylabel="friction [N]", title="A measured loop; the laws' second half")
    path.legend(loc="lower right", bbox_to_anchor=(1.0, 0.08), fontsize=8, markerscale=4)
    time.set(xlabel="time [s]", title="Fitted on the grey half, predicted on the other")
    return figure


def normal(fmu: Path, data: NormalVibration, fits: Sequence[NormalFit]) -> Figure:
    figure, axes = style.subplots(size=(7.0, 4.2))
    V = np.geomspace(3e-3, 0.3, 60)
    for law in ("Dahl", "ElasticPlastic"):
        chosen = [fit for fit in fits if fit.law == law and fit.yielding is not None and fit.swing >= 2.0]
        curves = [reduction(fmu, law, data.f, V, fit.swing, np.array([fit.yielding])) for fit in chosen]
        low, high = np.min(curves, axis=0), np.max(curves, axis=0)
        axes.fill_between(1e3 * V, 100 * low, 100 * high, color=LAW[law], alpha=0.35, lw=0)
        axes.plot(
            [], [], lw=6, color=LAW[law], alpha=0.45, label=f"{law}, limit μ F_n, fitted to the left point"
        )
    axes.plot(1e3 * V, 0 * V, color=style.GREY, ls="--", label="every law with a constant limit")
    axes.semilogx(1e3 * data.V, 100 * data.reduction, "o", color=style.BLACK, label="measured")
    axes.set(
        xlabel="sliding velocity [mm/s]",
        ylabel="fall of the friction [%]",
        title="Vibration of 22 kHz normal to the sliding",
        ylim=(-5, 100),
    )
    axes.legend(loc="upper right", fontsize=8)
    return figure
