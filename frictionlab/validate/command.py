"""scripts/validate: every law of friction against measurements that others published."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table

from frictionlab import style
from frictionlab.build import build_fmu
from frictionlab.command import add_fmu, add_output, command_line, finish, progress_bar
from frictionlab.fmu import FrictionFmu
from frictionlab.project import ROOT
from frictionlab.validate import figures, longitudinal, loop, measurements, normal

DESCRIPTION = """\
Holds every law of friction against measurements that others published: sliding under longitudinal
vibration (dry, oil), a measured loop of presliding, sliding under normal vibration. Says what was fixed,
what was fitted on which rows, and what was predicted on the others, and draws one picture a measurement.
What it means: docs/validation.md."""


def arguments(argv: Sequence[str] | None) -> argparse.Namespace:
    parser = command_line("validate", DESCRIPTION)
    add_fmu(parser)
    add_output(parser, ROOT / "build" / "validation")
    parser.add_argument("--docs", action="store_true", help="also write the pictures of docs/validation.md")
    parser.add_argument("--quick", action="store_true", help="without the loop, which takes some 10 s")
    return parser.parse_args(argv)


def longitudinal_table(name: str, data: measurements.Sliding, fits: Sequence[longitudinal.Fit]) -> Table:
    table = Table(title=f"Longitudinal vibration, {name}: 26 kHz, 0.35 um. Mean friction [N]")
    for heading in ("", "stiffness [N/um]", *(f"{1e3 * V:g} mm/s" for V in data.V), "rms", "rms predicted"):
        table.add_column(heading, justify="right" if heading else "left")
    table.add_row("measured", "", *(f"{force:.3f}" for force in data.vibrated), "", "")
    for fit in fits:
        stiffness = "" if fit.stiffness is None else f"{1e-6 * fit.stiffness:.3g}"
        if fit.law in ("Dahl", "LuGre"):
            stiffness = "any"
        table.add_row(
            fit.law,
            stiffness,
            *(f"{force:.4f}" for force in fit.model),
            f"{longitudinal.rms(fit.model, data.vibrated):.3f}",
            f"{longitudinal.rms(fit.predicted, data.vibrated):.3f}",
        )
    return table


def loop_table(fits: Sequence[loop.LoopFit]) -> Table:
    table = Table(title="The measured loop: fitted on its first half. Misfit over the measured friction")
    for heading in ("", "stiffness [N/mm]", "F_C [N]", "rms fitted", "rms predicted", "work / measured"):
        table.add_column(heading, justify="right" if heading else "left")
    for fit in fits:
        table.add_row(
            fit.law,
            "" if fit.stiffness is None else f"{1e-3 * fit.stiffness:.2f}",
            f"{fit.F_C:.3f}",
            f"{fit.rms_fitted:.1%}",
            f"{fit.rms_predicted:.1%}",
            f"{fit.work:.3f}",
        )
    return table


def normal_table(data: measurements.NormalVibration, fits: Sequence[normal.NormalFit]) -> Table:
    table = Table(
        title=f"Normal vibration: fitted to {data.reduction[0]:.0%} at 20.3 mm/s; measured at 87 mm/s: "
        f"{data.reduction[1]:.0%}. A constant limit gives 0"
    )
    for heading in (
        "limit mu F_n, law",
        "swing lambda a_d / R_q",
        "mu load / k [um]",
        "predicted at 87 mm/s",
    ):
        table.add_column(heading, justify="left" if "law" in heading else "right")
    for fit in fits:
        reached = fit.yielding is not None and fit.predicted is not None
        table.add_row(
            fit.law,
            f"{fit.swing:g}",
            f"{1e6 * fit.yielding:.3g}" if reached else "none reaches it",
            f"{fit.predicted:.1%}" if reached else "",
        )
    return table


def run(options: argparse.Namespace) -> None:
    console = Console(width=max(100, Console().width))
    with progress_bar() as progress:
        path = options.fmu or build_fmu(progress=progress)
    drawn = {}

    results = {}
    for name in ("dry", "oil"):
        data = measurements.sliding(name)
        fits = [longitudinal.fit(path, data, law) for law in longitudinal.LAWS]
        fits.append(longitudinal.constant_ratio(data))
        results[name] = (data, fits)
        console.print(longitudinal_table(name, data, fits))
    drawn["validation-longitudinal"] = figures.longitudinal(results)

    vibration = measurements.normal_vibration()
    normal_fits = [
        normal.fit(path, vibration, law, float(swing)) for law in normal.LAWS for swing in normal.SWINGS
    ]
    console.print(normal_table(vibration, normal_fits))
    drawn["validation-normal"] = figures.normal(path, vibration, normal_fits)

    if not options.quick:
        record = measurements.loop()
        with FrictionFmu(path) as fmu:
            loop_fits = [loop.fit(fmu, record, law) for law in loop.LAWS]
        console.print(loop_table(loop_fits))
        drawn["validation-loop"] = figures.loop(record, loop_fits)

    for name, figure in drawn.items():
        figure.savefig(_made(options.output) / f"{name}.svg", metadata={"Date": None})
        targets = [options.output / f"{name}.png"]
        if options.docs:
            targets.append(ROOT / "docs" / "pictures" / f"{name}.png")
        style.save(figure, *targets)
    print(f"Written: {len(drawn)} pictures in {options.output}")


def _made(folder: Path) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def main(argv: Sequence[str] | None = None) -> None:
    finish(run, arguments(argv))


if __name__ == "__main__":
    main()
