"""Whether the law fits at all, and what a fit can't tell, in words.

Do the residuals look like scatter? The tests' sum of false alarms is CHANCE. What a fit leaves of pure
scatter is (1 - H) z, with H the projection on the slopes of the fit and z normal. Every test is a number of
such residuals over their length. The scatter of that number over draws of z tells how odd the residuals are.
The least of the probabilities over all tests is held against the least of the draws' own (Westfall and Young,
1993).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np
from scipy import stats
from scipy.spatial import cKDTree

from frictioncontact.identification.experiment import Experiment, Parameter
from frictioncontact.identification.fit import SAME, Fit

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


CHANCE = 0.01  # of a law that fits to be doubted
DRAWS = 4000
HELD = 4_000_000  # numbers of draws at a time
FEW = 3  # rows for each value of a column whose values are groups, on average, at least

# Of residuals of length 1, [draw, row] -> [draw]; large where they are no scatter.
Statistic = Callable[[np.ndarray], np.ndarray]


def suspicion(experiment: Experiment, result: Fit, shapes: Mapping[str, np.ndarray]) -> tuple[float, str]:
    """How likely scatter gives residuals as odd as these, and in what they are the oddest.

    shapes: of faults, what each would add to the forces.
    """
    rows, total = len(experiment.force), len(result.slopes)
    tests = _in_time(rows) if experiment.word == "sample" else _over_rows(experiment)
    for fault, shape in shapes.items():
        seen = visible(experiment, result, shape)
        if np.linalg.norm(seen) > 1e-6 * np.linalg.norm(shape * experiment.weight):
            tests[f"have the shape of {fault}"] = _along(seen)

    def values(residuals: np.ndarray) -> np.ndarray:
        unit = residuals / np.linalg.norm(residuals, axis=1, keepdims=True)
        return np.stack([test(unit) for test in tests.values()], axis=1)

    random, left, step = np.random.default_rng(0), _projection(result.slopes), max(1, HELD // total)
    sizes = [min(step, DRAWS - k) for k in range(0, DRAWS, step)]
    drawn = np.concatenate([values(left(random.standard_normal((n, total)))[:, :rows]) for n in sizes])
    own = np.mean(drawn >= values((result.residuals * experiment.weight)[None, :]), axis=0)
    ranks = np.argsort(np.argsort(-drawn, axis=0), axis=0) + 1.0
    chance = float(np.mean(ranks.min(axis=1) / DRAWS <= own.min()))
    return max(chance, 1.0 / DRAWS), list(tests)[int(np.argmin(own))]


def visible(experiment: Experiment, result: Fit, shape: np.ndarray) -> np.ndarray:
    """What a fault adds to the residuals: what the parameters can't make up for, in standard deviations."""
    rest = np.zeros(len(result.slopes) - len(shape))
    return _projection(result.slopes)(np.concatenate([shape * experiment.weight, rest])[None])[
        0, : len(shape)
    ]


def _projection(slopes: np.ndarray) -> Statistic:
    """What a fit leaves of [draw, residual]."""
    scale = np.linalg.norm(slopes, axis=0)
    u, size, _ = np.linalg.svd(slopes[:, scale > 0.0] / scale[scale > 0.0], full_matrices=False)
    basis = u[:, size > 1e-9 * size.max(initial=0.0)]
    return lambda residuals: residuals - (residuals @ basis) @ basis.T


def _along(direction: np.ndarray) -> Statistic:
    return lambda r: np.abs(r @ direction) / np.linalg.norm(direction)


def _in_time(samples: int) -> dict[str, Statistic]:
    """Sums over blocks of samples, of several lengths; the largest."""

    def blocks(length: int) -> Statistic:
        whole = samples // length
        return lambda r: np.sum(r[:, : whole * length].reshape(-1, whole, length).sum(axis=2) ** 2, axis=1)

    lengths = [2**k for k in range(1, 12) if 2**k <= max(samples // 4, 2)]
    found = {f"to {length} neighbouring samples are alike": blocks(length) for length in lengths}
    return {**found, "are far larger at a sample than at others": lambda r: np.abs(r).max(axis=1)}


def _over_rows(experiment: Experiment) -> dict[str, Statistic]:
    """Rows of neighbouring values, of each column and of all; the sizes in groups that share a value."""
    columns = {name: experiment.rows.column(name) for name in experiment.rows.names}
    ranks = {name: np.unique(each, return_inverse=True)[1] for name, each in columns.items()}
    varied = {name: each for name, each in ranks.items() if each.max() > 0}
    found: dict[str, Statistic] = {}
    for name, rank in varied.items():
        others = [each for other, each in varied.items() if other != name]
        strata = rank
        if (rank.max() + 1) * FEW <= len(rank):
            groups = [rank == k for k in range(rank.max() + 1)]
            found[f"are far larger at one {name} than at others"] = _sizes(groups, experiment.force)
        else:
            strata = np.unique([*others, 0 * rank], axis=1, return_inverse=True)[1].ravel()
            strata = strata if (strata.max() + 1) * FEW <= len(rank) else 0 * rank
        order = np.lexsort((*others, rank, strata))
        pairs = np.stack([order[:-1], order[1:]])
        same = pairs[:, strata[pairs[0]] == strata[pairs[1]]]
        found[f"to rows of neighbouring {name} are alike"] = _neighbours(same)
    if len(varied) > 1:
        places = np.stack([rank / rank.max() for rank in varied.values()], axis=1)
        near = cKDTree(places).query(places, min(3, len(places)))[1][:, 1:]
        pairs = np.stack([np.repeat(np.arange(len(near)), near.shape[1]), near.ravel()])
        found["to rows of like conditions are alike"] = _neighbours(pairs)
    return found


def _neighbours(pairs: np.ndarray) -> Statistic:
    return lambda r: -np.sum((r[:, pairs[0]] - r[:, pairs[1]]) ** 2, axis=1)


def _sizes(groups: list[np.ndarray], force: np.ndarray) -> Statistic:
    """Of the group that misses by the most, both in N and over its force."""
    relative = np.array([np.mean(force**2) / max(np.mean(force[group] ** 2), 1e-300) for group in groups])

    def size(r: np.ndarray) -> np.ndarray:
        sizes = np.stack([np.mean(r[:, group] ** 2, axis=1) for group in groups], axis=1)
        return np.max(sizes * np.minimum(1.0, relative), axis=1)

    return size
