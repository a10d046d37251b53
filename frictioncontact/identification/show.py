"""What a fit found, on the terminal: first whether the law fits, then numbers, then what they can't tell."""

import math

import numpy as np
from rich.console import Console
from rich.table import Table

from frictioncontact.command import as_table
from frictioncontact.identification.experiment import Experiment, Parameter
from frictioncontact.identification.faults import described
from frictioncontact.identification.fit import Fit

MOST = 30  # rows shown


def show(console: Console, experiment: Experiment, result: Fit) -> None:
    """Misfits, values and intervals, rows, correlations, warnings."""

    def say(text: str) -> None:
        console.print(text, markup=False, highlight=False, soft_wrap=True)

    for text in result.misfits:
        say(f"MISFIT: {text}\n")
    if result.judged and not result.misfits:
        say("The law fits: its differences to the data look like their scatter.\n")
    for text in result.remedies:
        say(f"{'PERHAPS' if result.misfits else 'BUT'} {text}\n")
    console.print(_values(result))
    if experiment.word == "row":
        console.print(_rows(experiment, result))
    if len(result.parameters) > 1:
        console.print(_correlations(result))
    word = experiment.word
    rms, friction = (np.sqrt(np.mean(each**2)) for each in (result.residuals, experiment.force))
    percent = f"{100.0 * rms / friction:.2g} % of the friction"
    say(f"misfit: {rms:.3g} N rms over {len(result.residuals)} {word}s, {percent}")
    if math.isfinite(result.deviation):
        say(f"scatter of one {word}: {result.deviation:.3g} N ({result.degrees} degrees of freedom)")
    if getattr(experiment.rows, "scatter", 0.0):
        say(f"the measured position scatters by {experiment.rows.scatter:.2g} m, and is smoothed by as much")
    if asked := described(experiment, result):
        say(f"instrument: {asked} (95 %)")
    if not result.judged and not result.misfits:
        ask = "state the uncertainty of the force (uncertain, --uncertain)"
        say(f"no misfit is seen, but whether the law fits is open: {ask}")
    if result.hidden:
        hidden = ", ".join(result.hidden)
        say(f"these data would not show {hidden}, each of a tenth: the parameters take it up")
    for warning in result.warnings:
        say(f"warning: {warning}")


def _values(result: Fit) -> Table:
    headings = ["parameter", "unit", "value", "95 % interval, linear", "by profile"]
    rows = []
    for k, p in enumerate(result.parameters):
        intervals = [result.interval(k), result.profiles[k]]
        rows.append([p.name, p.unit, f"{result.values[k]:.6g}", *(_interval(p, *one) for one in intervals)])
        if p.unit == "rad":
            degrees = [_interval(p, *one, math.degrees(1.0)) for one in intervals]
            rows.append(["", "deg", f"{math.degrees(result.values[k]):.6g}", *degrees])
    return as_table(headings, rows, "Fitted parameters")


def _interval(p: Parameter, low: float, high: float, factor: float = 1.0) -> str:
    """Within the values that were searched."""
    is_open = p.periodic and high - low >= 2.0 * math.pi
    no_low, no_high = is_open or low <= p.low, is_open or high >= p.high
    if math.isnan(low):
        return "none"
    if no_low and no_high:
        return "not determined"
    if no_low or no_high:
        return f"at most {factor * high:.5g}" if no_low else f"at least {factor * low:.5g}"
    return f"{factor * low:.5g} .. {factor * high:.5g}"


def _rows(experiment: Experiment, result: Fit) -> Table:
    rows = [
        [
            str(k + 1),
            f"{experiment.force[k]:.3f}",
            f"{result.model[k]:.3f}",
            f"{result.residuals[k]:+.3f}",
        ]
        for k in range(min(len(result.model), MOST))
    ]
    rows += [["..."]] if len(result.model) > MOST else []
    headings = ("row", "measured", "fitted", "difference")
    return as_table(headings, rows, "Mean friction force [N]", names=0)


def _correlations(result: Fit) -> Table:
    names = [p.name for p in result.parameters]
    rows = [
        [name, *("none" if math.isnan(value) else f"{value:+.3f}" for value in row)]
        for name, row in zip(names, result.correlation, strict=True)
    ]
    return as_table(["", *names], rows, "Correlations")
