"""Holds every law of friction against measurements that others published: sliding under longitudinal
vibration (dry, oil), a record of cycles and of an unloading, sliding under normal vibration. Says what
was fixed, what was fitted on which rows, and what was predicted on the others, and draws a picture of each.
What it means: docs/validation.md."""

import argparse
from collections.abc import Sequence

from rich.table import Table

from figures import measured
from frictioncontact import resources, style
from frictioncontact.command import add_fmu, add_output, as_table, command_line, table_console
from frictioncontact.fmu import FrictionFmu
from tools.build import build_fmu
from tools.validate import elements, longitudinal, measurements, normal, record


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = command_line("scripts/validate", __doc__)
    add_fmu(parser)
    add_output(parser, resources.output("validation"))
    parser.add_argument("--quick", action="store_true", help="without the record, which takes some 10 s")
    return parser.parse_args(argv)


def longitudinal_table(name: str, data: measurements.Sliding, fits: Sequence[longitudinal.Fit]) -> Table:
    rows = [["measured", "", *(f"{force:.3f}" for force in data.vibrated), "", ""]]
    for fit in fits:
        found = "" if fit.stiffness is None else f"{1e-6 * fit.stiffness:.3g}"
        stiffness = "any" if fit.law in ("Dahl", "LuGre") else found
        errors = (measurements.rms(model - data.vibrated) for model in (fit.model, fit.predicted))
        rows.append([fit.law, stiffness, *(f"{F:.4f}" for F in fit.model), *(f"{e:.3f}" for e in errors)])
    headings = ["", "stiffness [N/um]", *(f"{1e3 * V:g} mm/s" for V in data.V), "rms", "rms predicted"]
    return as_table(headings, rows, f"Longitudinal vibration, {name}: 26 kHz, 0.35 um. Mean friction [N]")


def scatter_line(data: measurements.Record) -> str:
    from_mean, from_last, work = record.scatter(data)
    return (
        f"A measured cycle differs from the mean one by {from_mean:.1%} (rms over the sliding friction), "
        f"from the one before it over sqrt 2 by {from_last:.1%}; the work of cycles by {work:.1%}."
    )


def cycles_table(data: measurements.Record, fits: Sequence[record.RecordFit]) -> Table:
    rows = []
    for fit in fits:
        stiffness = "" if fit.stiffness is None else f"{1e-3 * fit.stiffness:.2f}"
        misfits = f"{fit.rms_fitted:.1%}", f"{fit.rms_predicted:.1%}"
        rows.append([fit.law, stiffness, f"{fit.mu:.3f}", *misfits, f"{fit.work:.3f}"])
    same, later = record.repeated(data), record.predicted_cycles(data)
    error = measurements.rms(same.friction - later.friction) / record.sliding_friction(data)
    ratio = record.work(same.friction, later) / record.work(later.friction, later)
    rows.append(["empirical: mean of the two cycles", "", "", "", f"{error:.1%}", f"{ratio:.3f}"])
    headings = ["", "stiffness [N/mm]", "mu", "rms fitted", "rms predicted", "work / measured"]
    return as_table(
        headings, rows, "The cycles: fitted on two, 47 predicted. Misfit over the measured friction"
    )


def elements_table(fits: Sequence[elements.ElementFit]) -> Table:
    rows = []
    for fit in fits:
        name = f"{fit.name}, {fit.tilt:.3f} N/N" if fit.tilt else fit.name
        rows.append([name, f"{fit.rms_fitted:.1%}", f"{fit.rms_predicted:.1%}"])
    title = "What would mend ElasticPlastic, fitted to the same two cycles"
    return as_table(["", "rms fitted", "rms predicted"], rows, title)


def unloading_table(data: measurements.Record, fits: Sequence[record.RecordFit]) -> Table:
    part, by_law = data.between(*record.UNLOADING), {fit.law: fit for fit in fits}
    dahl, elastic_plastic = by_law["Dahl"], by_law["ElasticPlastic"]
    forces = {
        "measured": part.friction,
        "ElasticPlastic, limit mu F_n": elastic_plastic.unloading,
        "Dahl, limit mu F_n, as the FMU has it": dahl.unloading,
        "Dahl, limit mu F_n, Eq. 2 alone": record.without_bound(data, dahl),
        "ElasticPlastic, constant limit": elastic_plastic.constant_limit,
        "Dahl, constant limit": dahl.constant_limit,
    }
    rows = []
    for name, each in forces.items():
        misfit = "" if name == "measured" else f"{record.misfit_of_unloading(data, each):.1%}"
        rows.append([name, misfit, *(f"{ratio:.3f}" for ratio in record.over_the_load(data, each))])
    title = (
        "The unloading, predicted by what the two cycles gave: rms over the "
        f"{record.friction_before_unloading(data):.2f} N before it, "
        f"and |F| / F_n while F_n > {record.CARRYING} N"
    )
    return as_table(["", "rms", "least F / F_n", "largest"], rows, title)


def normal_table(data: measurements.NormalVibration, fits: Sequence[normal.NormalFit]) -> Table:
    rows = []
    for fit in fits:
        found = ["none reaches it", "", ""]
        if fit.yielding is not None and fit.predicted is not None:
            found = [f"{1e6 * fit.yielding:.3g}", f"{fit.between:.1%}", f"{fit.predicted:.1%}"]
        rows.append([fit.law, f"{fit.swing:g}", *found])
    at_second, between = normal.hyperbola(data)
    rows.append(["empirical: 1 / (1 + V / V_0)", "", "", f"{between:.1%}", f"{at_second:.1%}"])
    title = (
        f"Normal vibration: fitted to {data.reduction[0]:.0%} at 20.3 mm/s; measured at 87 mm/s: "
        f"{data.reduction[1]:.0%}. A constant limit gives 0"
    )
    headings = "limit mu F_n, law", "swing lambda a_d / R_q", "mu load / k [um]", "predicted at 40.6 mm/s"
    return as_table([*headings, "at 87 mm/s"], rows, title)


def run(options: argparse.Namespace) -> None:
    console = table_console()
    path = options.fmu or build_fmu()

    sliding = {}
    for name in ("dry", "oil"):
        data = measurements.sliding(name)
        fits = [longitudinal.fit(path, data, law) for law in longitudinal.LAWS]
        fits += [baseline(data) for baseline in longitudinal.BASELINES]
        sliding[name] = (data, fits)
        console.print(longitudinal_table(name, data, fits))

    vibration = measurements.normal_vibration()
    normal_fits = [
        normal.fit(path, vibration, law, float(swing)) for law in normal.LAWS for swing in normal.SWINGS
    ]
    console.print(normal_table(vibration, normal_fits))

    whole, record_fits = measurements.record(), []
    if not options.quick:
        with FrictionFmu(path) as fmu:
            record_fits = [record.fit(fmu, whole, law) for law in record.LAWS]
        console.print(scatter_line(whole), cycles_table(whole, record_fits), sep="\n")
        console.print(elements_table(elements.fits(whole)), unloading_table(whole, record_fits), sep="\n")

    drawn = {"longitudinal": measured.longitudinal(sliding)}
    drawn["normal"] = measured.normal(path, vibration, normal_fits)
    if record_fits:
        drawn["cycles"] = measured.cycles(whole, record_fits)
        drawn["unloading"] = measured.unloading(whole, record_fits)
    for name, figure in drawn.items():
        style.save(figure, options.output / f"validation-{name}.png")
    print(f"Written: {len(drawn)} pictures in {options.output}")
