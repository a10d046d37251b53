"""What a fit can't tell, and whether the law fits at all, in words."""

import math
from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
from scipy import stats

from frictioncontact.identification.experiment import Experiment
from frictioncontact.identification.parameter import Parameter
from frictioncontact.identification.result import Fit
from frictioncontact.identification.search import SAME
from frictioncontact.identification.suspicion import CHANCE, FEW, suspicion

SMALL = 1e-5  # a difference over the force that the search for the fit may leave
LARGE = 0.2  # a misfit over the force that no scatter of a mean explains


def judge(experiment: Experiment, result: Fit, shapes: Mapping[str, np.ndarray]) -> None:
    """Adds misfits and warnings to a fit with profiles."""
    result.misfits.extend(misfits(experiment, result, shapes))
    result.warnings.extend(
        [
            *_count(experiment, result),
            *(text for k in range(len(result.parameters)) for text in _interval(result, k)),
            *_correlated(result),
            *_minima(result),
        ]
    )


def misfits(
    experiment: Experiment, result: Fit, shapes: Mapping[str, np.ndarray] = MappingProxyType({})
) -> list[str]:
    """What is wrong with a fit, in words. shapes: of faults, as of `suspicion`."""
    rms = float(np.sqrt(np.mean(result.residuals**2)))
    if result.degrees <= 0 or np.abs(result.residuals).max() < SMALL * np.abs(experiment.force).max():
        return []
    if result.known:
        independent = result.squares / result.correlated
        chance = float(stats.chi2.sf(independent, result.degrees))
        if chance < CHANCE:
            stated = float(np.sqrt(np.mean(experiment.weight**-2.0)))
            return [
                f"the law does not fit: the misfit, {rms:.3g} N rms, is larger than the stated "
                f"uncertainties allow ({stated:.3g} N rms; probability {chance:.1e}). "
                "The intervals are those of a law that fits"
            ]
    elif experiment.word == "row" and (large := _large_parts(experiment, result)):
        return [f"the law does not fit: {large}"]
    chance, oddest = suspicion(experiment, result, shapes)
    if chance >= CHANCE:
        return []
    size = f"the misfit, {rms:.3g} N rms, is no scatter: its differences {oddest} (probability {chance:.1e})"
    if experiment.word == "sample":
        scatter = min(scatter_of(experiment.force), scatter_of(result.residuals))
        times = f"{rms / scatter:.3g} times" if scatter > 0.0 else "more than"
        size = (
            f"the misfit, {rms:.3g} N rms, is {times} the scatter of neighbouring samples, {scatter:.2g} N: "
            f"its differences {oddest} (probability {chance:.1e}). "
            f"The intervals count {result.correlated:.3g} samples as one"
        )
    return [f"the law does not fit: {size}"]


def scatter_of(samples: np.ndarray) -> float:
    """Standard deviation of white noise on a smooth curve, by second differences."""
    return float(np.std(np.diff(samples, 2)) / math.sqrt(6.0))


def _large_parts(experiment: Experiment, result: Fit) -> str:
    """The rows that miss by more than a scatter would: all, or those of one value of a column."""
    rows, force, miss = experiment.rows, experiment.force, result.residuals
    parts = {"": np.ones(len(force), dtype=bool)}
    for name in rows.names:
        values = rows.column(name)
        few = np.unique(values)
        if 1 < len(few) <= len(values) / FEW:
            parts |= {f" of the rows with {name} = {each:.4g}": values == each for each in few}
    for words, part in parts.items():
        own, size = np.sqrt(np.mean(miss[part] ** 2)), np.sqrt(np.mean(force[part] ** 2))
        rest = np.mean(miss[~part] ** 2) if (~part).any() else 0.0
        odd = stats.f.sf(own**2 / max(rest, 1e-300), part.sum(), max((~part).sum(), 1)) < CHANCE
        if own > LARGE * size and (odd or part.all()):
            return f"the misfit{words}, {own:.3g} N rms, is {own / max(size, 1e-300):.3g} of the force"
    return ""


def _count(experiment: Experiment, result: Fit) -> list[str]:
    if result.degrees <= 0 and not result.known:
        return [
            f"as many parameters as {experiment.word}s: the fit has nothing to check it, and "
            "no interval can be given"
        ]
    if result.degrees < 3:
        return [
            f"{len(experiment.force)} {experiment.word}s for {len(result.parameters)} parameters: "
            "an identification, not a validation"
        ]
    return []


def _interval(result: Fit, k: int) -> list[str]:
    p, value = result.parameters[k], result.values[k]
    low, high = result.profiles[k]
    unit = p.after
    found = []
    if not math.isnan(low):
        below, above = p.to_coordinate(low), p.to_coordinate(high)
        half = 0.5 * (above - below)
        open_low, open_high = (
            not math.isfinite(below) or below <= p.to_coordinate(p.low),
            not math.isfinite(above),
        )
        if open_low and open_high:
            found.append(
                f"the data can't tell {p.name}: within 95 % it may be anything from {p.low:.3g} to "
                f"{p.high:.3g}{unit}, which is all that was searched"
            )
        elif open_low or open_high:
            bound = f"at most {high:.3g}" if open_low else f"at least {low:.3g}"
            found.append(
                f"the data can't tell {p.name}: within 95 % it is {bound}{unit}, and no more is known"
            )
        elif half > _large(p, value):
            found.append(f"the data can't tell {p.name}: within 95 % it may be {low:.3g} to {high:.3g}{unit}")
    elif result.half_widths[k] > _large(p, value):
        found.append(f"the data can't tell {p.name}")
    if value <= p.low * (1 + 1e-6) or value >= p.high * (1 - 1e-6):
        found.append(f"{p.name} ended at its bound {value:g}{unit}")
    return found


def _open(result: Fit, k: int) -> bool:
    """Whether the data give no bound to the parameter on a side."""
    low, high = result.profiles[k]
    return math.isinf(high) or math.isinf(low) or (result.parameters[k].logarithmic and low == 0.0)


def _large(p: Parameter, value: float) -> float:
    """Half-width in the coordinate beyond which a value is not known."""
    if p.logarithmic:
        return math.log(2.0)
    return math.pi / 4.0 if p.periodic else abs(p.to_coordinate(value))


def _correlated(result: Fit) -> list[str]:
    correlation, found = result.correlation, []
    for j in range(len(result.parameters)):
        for k in range(j):
            if abs(correlation[j, k]) > 0.95:
                pair = f"{result.parameters[k].name} and {result.parameters[j].name}"
                found.append(f"the data hardly tell {pair} apart: correlation {correlation[j, k]:.3f}")
    return found


def _minima(result: Fit) -> list[str]:
    edge, found = result.region_bound, []
    if not result.minima[0].settled:
        found.append("the fit did not settle: its search was ended after its last evaluation")
    for other in result.minima[1:4]:
        if all(
            _open(result, k)
            for k in range(len(result.parameters))
            if abs(other.point - result.point)[k] > SAME
        ):
            continue  # somewhere on a floor that the profiles tell of
        values = ", ".join(
            f"{p.name} {p.to_value(x):.4g}" for p, x in zip(result.parameters, other.point, strict=False)
        )
        if other.squares < edge:
            found.append(f"another solution lies within the 95 % region: {values}")
        elif math.isfinite(edge):
            found.append(f"another minimum, outside the 95 % region: {values}")
        else:
            found.append(f"another minimum: {values}")
    return found
