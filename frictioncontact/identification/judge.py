"""Whether the law fits at all, and what a fit can't tell, in words.

Do the residuals look like scatter? The tests' sum of false alarms is CHANCE. What a fit leaves of pure
scatter is (1 - H) z, with H the projection on the slopes of the fit and z normal. Every test is a number of
such residuals over their length. The scatter of that number over draws of z tells how odd the residuals are.
The least of the probabilities over all tests is held against the least of the draws' own (Westfall and Young,
1993).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
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
    rms, friction = (float(np.sqrt(np.mean(each**2))) for each in (result.residuals, experiment.force))
    size = f"the misfit, {rms:.3g} N rms ({100.0 * rms / friction:.2g} % of the friction)"
    if result.degrees <= 0 or np.abs(result.residuals).max() < SMALL * np.abs(experiment.force).max():
        return []
    if result.known:
        independent = result.squares / result.correlated
        chance = float(stats.chi2.sf(independent, result.degrees))
        if chance < CHANCE:
            stated = float(np.sqrt(np.mean(experiment.weight**-2.0)))
            return [
                f"the law does not fit: {size}, is larger than the stated uncertainties "
                f"allow ({stated:.3g} N rms; probability {chance:.1e}). "
                "The intervals are those of a law that fits"
            ]
    elif experiment.word == "row" and (large := _large_parts(experiment, result)):
        return [f"the law does not fit: {large}"]
    chance, oddest = suspicion(experiment, result, shapes)
    if chance >= CHANCE:
        return []
    odd = f"its differences {oddest} (probability {chance:.1e})"
    if experiment.word == "row":
        return [f"the law does not fit: {size}, is no scatter: {odd}"]
    scatter = min(scatter_of(experiment.force), scatter_of(result.residuals))
    times = f"{rms / scatter:.3g} times" if scatter > 0.0 else "more than"
    return [
        f"the law does not fit: {size}, is {times} the scatter of neighbouring samples, {scatter:.2g} N: "
        f"{odd}. The intervals count {result.correlated:.3g} samples as one"
    ]


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


CHANCE = 0.005  # of a law that fits to be doubted
DRAWS = 4000
HELD = 4_000_000  # numbers of draws at a time
MEMORY = 8  # samples: twice what a filter at a quarter of Nyquist's frequency makes alike
BLOCKS = 40  # of samples, at least, where there are more samples
HARMONICS = 5  # of the motion: a line there is no hum
LINES = 3  # of hum, at most
NEAR = 100  # places of the spectrum to each side, from whose median a line has to stand out
STANDS_OUT = 25.0  # of white noise 1 of 1e5 records of 1000 samples has such a line
FEW = 3  # rows for each value of a column whose values are groups, on average, at least

# Of residuals of length 1, [draw, row] -> [draw]; large where they are no scatter.
Statistic = Callable[[np.ndarray], np.ndarray]


def suspicion(experiment: Experiment, result: Fit, shapes: Mapping[str, np.ndarray]) -> tuple[float, str]:
    """How likely scatter gives residuals as odd as these, and in what they are the oddest.

    shapes: of faults, what each would add to the forces.
    """
    residuals, slopes = result.residuals * experiment.weight, result.slopes
    rows, total, length = len(residuals), len(slopes), 1
    if experiment.word == "sample":
        length, drive = min(MEMORY, max(1, rows // BLOCKS)), motion(experiment)
        slopes = np.hstack([slopes, _hum(experiment, residuals, drive)])
        tests = _in_time(rows // length, length) | _with_the_motion(experiment, drive)
    else:
        tests = {words: (1, test) for words, test in _over_rows(experiment).items()}
    left = _projection(slopes)
    for fault, shape in shapes.items():
        seen = left(np.pad(shape * experiment.weight, (0, total - rows))[None])[0, :rows]
        if np.linalg.norm(seen) > 1e-6 * np.linalg.norm(shape * experiment.weight):
            tests[f"have the shape of {fault}"] = length, _along(_averaged(seen, length))

    def values(residuals: np.ndarray) -> np.ndarray:
        means = {count: _averaged(residuals, count) for count in (1, length)}
        unit = {count: each / np.linalg.norm(each, axis=1, keepdims=True) for count, each in means.items()}
        return np.stack([test(unit[count]) for count, test in tests.values()], axis=1)

    random, step = np.random.default_rng(0), max(1, HELD // total)
    sizes = [min(step, DRAWS - k) for k in range(0, DRAWS, step)]
    drawn = np.concatenate([values(left(random.standard_normal((n, total)))[:, :rows]) for n in sizes])
    own = np.mean(drawn >= values(left(np.pad(residuals, (0, total - rows))[None])[:, :rows]), axis=0)
    ranks = np.argsort(np.argsort(-drawn, axis=0), axis=0) + 1.0
    chance = float(np.mean(ranks.min(axis=1) / DRAWS <= own.min()))
    return max(chance, 1.0 / DRAWS), list(tests)[int(np.argmin(own))]


def _averaged(each: np.ndarray, count: int) -> np.ndarray:
    """Sums of so many neighbouring samples, which scatter as one does where it is white; the rest is left."""
    whole = each.shape[-1] // count * count
    return each[..., :whole].reshape(*each.shape[:-1], -1, count).sum(axis=-1) / math.sqrt(count)


def spectrum(experiment: Experiment, samples: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies [Hz], four to what the record resolves, and the power at each."""
    time = experiment.time
    even = np.interp(np.linspace(time[0], time[-1], len(time)), time, samples)
    power = np.abs(np.fft.rfft(even, 4 * len(time))) ** 2
    return np.arange(len(power)) * (len(time) - 1) / (4.0 * len(time) * np.ptp(time)), power


def motion(experiment: Experiment) -> float:
    """The frequency [Hz] of the motion: the strongest of its velocity."""
    V = np.interp(experiment.time, experiment.rows.time, experiment.rows.V)
    frequencies, power = spectrum(experiment, V - V.mean())
    return float(frequencies[np.argmax(power)])


def _waves(experiment: Experiment, frequencies: Iterable[float]) -> np.ndarray:
    """Sines and cosines, [sample, wave]."""
    turns = 2j * math.pi * (experiment.time - experiment.time.mean())
    waves = [np.exp(frequency * turns) for frequency in frequencies]
    return np.column_stack([part for wave in waves for part in (wave.real, wave.imag)])


def _with_the_motion(experiment: Experiment, drive: float) -> dict[str, tuple[int, Statistic]]:
    """The power at harmonics of the motion over that halfway between them: a filtered noise has as much."""

    def power(count: int) -> Statistic:
        at, between = (
            np.linalg.qr(_waves(experiment, drive * (np.arange(1.0, count + 1.0) - shift)))[0]
            for shift in (0.0, 0.5)
        )
        return lambda r: np.sum((r @ at) ** 2, axis=1) / np.sum((r @ between) ** 2, axis=1)

    most = 0.5 * len(experiment.time) / max(drive * np.ptp(experiment.time), 1.0)
    return {f"repeat with the motion, up to harmonic {k}": (1, power(k)) for k in (1, 3, 10) if k <= most}


def _hum(experiment: Experiment, residuals: np.ndarray, drive: float) -> np.ndarray:
    """Lines in the spectrum of the residuals that are no harmonics of the motion, as slopes [sample, slope].

    A misfit of the law has the frequency of the motion and its first harmonics.
    """
    found, span = np.zeros((len(residuals), 0)), float(np.ptp(experiment.time))
    phase = ((experiment.time - experiment.time.mean()) / span)[:, None]
    for _ in range(LINES):
        frequencies, power = spectrum(experiment, _projection(found)(residuals[None])[0])
        away = np.abs(frequencies[:, None] - drive * np.arange(HARMONICS + 1.0)).min(axis=1)
        k = int(np.argmax(power * (away > 1.0 / span)))
        if power[k] < STANDS_OUT * np.median(power[max(0, k - NEAR) : k + NEAR]):
            break
        wave = _waves(experiment, frequencies[k : k + 1])
        found = np.hstack([found, wave, phase * wave])
    return found


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


def _in_time(samples: int, length: int) -> dict[str, tuple[int, Statistic]]:
    """Sums over blocks of samples, of several sizes; the largest. length: of what is one sample here."""

    def blocks(count: int) -> Statistic:
        return lambda r: np.sum(_averaged(r, count) ** 2, axis=1)

    counts = [2**k for k in range(1, 12) if 2**k <= max(samples // 4, 2)]
    found = {f"to {length * count} neighbouring samples are alike": blocks(count) for count in counts}
    found["are far larger at a sample than at others"] = lambda r: np.abs(r).max(axis=1)
    return {words: (length, test) for words, test in found.items()}


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
