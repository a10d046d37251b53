"""One figure a measurement: what was measured, and what each law says."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from frictioncontact import style
from tools.validate import record
from tools.validate.longitudinal import Fit
from tools.validate.measurements import NormalVibration, Record, Sliding
from tools.validate.normal import NormalFit, reduction
from tools.validate.record import RecordFit

LAW = {
    "Coulomb": style.GREY,
    "Dahl": style.ORANGE,
    "LuGre": style.PINK,
    "ElasticPlastic": style.BLUE,
    "a constant force": style.PINK,
    "a constant ratio": style.GREEN,
    "a + b ln V": style.AMBER,
}
TWO_CYCLES = (100.75, 108.75)  # s, in the middle of the record


def longitudinal(results: Mapping[str, tuple[Sliding, Sequence[Fit]]]) -> Figure:
    figure, axes = style.subplots(len(results), 1, size=(5.2, 6.6), sharex=True)
    for panel, (name, (data, fits)) in zip(axes, results.items(), strict=True):
        V = 1e3 * data.V
        panel.loglog(V, data.without, "o", color=style.BLACK, mfc="white", label="measured, no vibration")
        panel.loglog(V, data.vibrated, "o", color=style.BLACK, label="measured, vibrated")
        for fit in fits:
            if fit.law == "Dahl":
                panel.fill_between(V, fit.least, fit.most, color=LAW["Dahl"], alpha=0.3, lw=0)
                panel.plot([], [], lw=6, color=LAW["Dahl"], alpha=0.4, label="Dahl, LuGre: any stiffness")
            elif fit.law != "LuGre":
                label = fit.law if fit.law != "ElasticPlastic" else "ElasticPlastic, stiffness fitted"
                dash = ":" if fit.law.startswith("a ") else "--" if fit.law == "Coulomb" else "-"
                panel.loglog(V, fit.model, dash, color=LAW[fit.law], label=label)
        panel.set(ylabel="mean friction [N]", title=f"{name}: 26 kHz, 0.35 µm along the sliding")
        panel.set_ylim(1e-3, 20.0)
    axes[-1].set_xlabel("sliding velocity [mm/s]")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def cycles(data: Record, fits: Sequence[RecordFit]) -> Figure:
    figure, (path, time) = style.subplots(2, 1, size=(5.2, 7.0))
    whole = record.modelled(data)
    shown = (whole.time >= TWO_CYCLES[0]) & (whole.time <= TWO_CYCLES[1])
    middle = 0.5 * (whole.position[shown].min() + whole.position[shown].max())
    x, t = 1e6 * (whole.position - middle)[shown], whole.time[shown]
    path.plot(x, whole.friction[shown], ".", ms=2, color=style.BLACK, label="measured")
    time.plot(t, whole.friction[shown], ".", ms=2, color=style.BLACK)
    for fit in fits:
        if fit.stiffness is not None:
            label = f"{fit.law}, {fit.stiffness * 1e-3:.1f} N/mm, μ {fit.mu:.3f}"
            path.plot(x, fit.friction[shown], color=LAW[fit.law], label=label)
            time.plot(t, fit.friction[shown], color=LAW[fit.law])
    path.set(xlabel="position [µm]", ylabel="friction [N]", title="Two of the 47 later cycles")
    time.set(xlabel="time [s]", ylabel="friction [N]", title="The same along time")
    figure.legend(*path.get_legend_handles_labels(), loc="outside lower center", ncols=1, markerscale=4)
    return figure


def unloading(data: Record, fits: Sequence[RecordFit]) -> Figure:
    figure, (force, ratio) = style.subplots(2, 1, size=(5.2, 7.2))
    part = data.between(*record.UNLOADING)
    carrying = part.load > record.CARRYING
    dahl = next(fit for fit in fits if fit.law == "Dahl")
    elastic_plastic = next(fit for fit in fits if fit.law == "ElasticPlastic")
    curves = (
        ("ElasticPlastic, limit μ F_n", elastic_plastic.unloading, LAW["ElasticPlastic"], "-"),
        ("Dahl, limit μ F_n, bounded", dahl.unloading, LAW["Dahl"], "-"),
        ("Dahl, limit μ F_n, Eq. 2 alone", record.without_bound(data, dahl), LAW["Dahl"], "--"),
        ("ElasticPlastic, constant limit", elastic_plastic.constant_limit, LAW["ElasticPlastic"], ":"),
        ("Dahl, constant limit", dahl.constant_limit, LAW["Dahl"], ":"),
    )
    force.plot(part.time, -part.friction, color=style.BLACK, lw=4, alpha=0.35, label="measured")
    ratio.plot(
        part.time[carrying], (-part.friction / part.load)[carrying], color=style.BLACK, lw=4, alpha=0.35
    )
    for label, friction, colour, dash in curves:
        force.plot(part.time, -friction, dash, color=colour, label=label)
        ratio.plot(part.time[carrying], (-friction / part.load)[carrying], dash, color=colour)
    force.set(xlabel="time [s]", ylabel="friction [N]", title="The load falls from 5 N to 0: predicted")
    ratio.set(xlabel="time [s]", ylabel="friction / load", title="The same over the load", ylim=(0.0, 3.0))
    figure.legend(*force.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def normal(fmu: Path, data: NormalVibration, fits: Sequence[NormalFit]) -> Figure:
    figure, axes = style.subplots(size=(5.2, 5.0))
    V = np.geomspace(3e-3, 0.3, 60)
    for law in ("Dahl", "ElasticPlastic"):
        chosen = [fit for fit in fits if fit.law == law and fit.yielding is not None]
        curves = [reduction(fmu, law, data.f, V, fit.swing, np.array([fit.yielding])) for fit in chosen]
        lines = axes.plot(1e3 * V, 100 * np.transpose(curves), color=LAW[law], lw=1.0)
        swings = ", ".join(f"{fit.swing:g}" for fit in chosen)
        lines[0].set_label(f"{law}, limit μ F_n; at the right,\nfrom above, α = {swings}")
    axes.plot(1e3 * V, 0 * V, color=style.GREY, ls="--", label="every law with a constant limit")
    label = "measured; the laws are fitted to the left one"
    axes.semilogx(1e3 * data.V, 100 * data.reduction, "o", color=style.BLACK, label=label)
    at, where = 1e3 * data.between, {"va": "bottom", "transform": axes.transData}
    axes.axvline(at, ymax=0.55, color=style.GREY, lw=0.8)
    style.note(axes, "measured,\nvalue unknown", 1.03 * at, 2.0, **where)
    axes.set(
        xlabel="sliding velocity [mm/s]",
        ylabel="fall of the friction [%]",
        title="Vibration of 22 kHz normal to the sliding",
        ylim=(-5, 100),
    )
    figure.legend(loc="outside lower center")
    return figure
