"""A measured record of presliding and sliding under a load that falls at its end: friction law by law.

The position and the load are the inputs. Fitted: the stiffness and the friction coefficient, by least
squares on two cycles at constant load. Predicted: the 47 cycles after them, and then the unloading, in
which the load falls from 5 N to 0 while the contact creeps. One run from the first fitted cycle to the
end of the unloading gives all of it: nothing is adjusted or started anew on the way.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares

from frictioncontact.fmu import FrictionFmu, Value, run
from tools.validate.measurements import Record, rms

LAWS = ("Coulomb", "Dahl", "ElasticPlastic")
CYCLE = 4.0  # s
FIRST = 12.75  # s, where the second cycle begins; the first one starts from rest
FITTED = 2  # cycles
CYCLES = 49  # from FIRST on, the fitted ones among them
UNLOADING = (209.4, 212.0)  # s
MIN_LOAD = 1e-3  # N; below it the measured load is the sensor's noise
CARRYING = 0.7  # N; below it force over load is dominated by what the sensors miss


@dataclass(frozen=True)
class RecordFit:
    """One law against the record, its limit being mu times the load but where it says otherwise."""

    law: str
    stiffness: float | None  # N/m
    mu: float
    friction: np.ndarray  # N, from FIRST to the end of the unloading
    rms_fitted: float  # of the fitted cycles, over the sliding friction
    rms_predicted: float  # of the cycles after them
    work: float  # of these, over the measured work
    unloading: np.ndarray  # N, the part of friction in which the load falls
    constant_limit: np.ndarray  # N, there, with the limit of the cycles


def fitted_cycles(record: Record) -> Record:
    return record.between(FIRST, FIRST + FITTED * CYCLE)


def predicted_cycles(record: Record) -> Record:
    return record.between(FIRST + FITTED * CYCLE, FIRST + CYCLES * CYCLE)


def modelled(record: Record) -> Record:
    """What one run of a law covers."""
    return record.between(FIRST, UNLOADING[1])


def sliding_friction(record: Record) -> float:
    """What the friction of the cycles exceeds for a twentieth of the time [N]."""
    return float(np.percentile(np.abs(record.between(FIRST, FIRST + CYCLES * CYCLE).friction), 95.0))


def friction_before_unloading(record: Record) -> float:
    """Measured friction [N] where the load begins to fall, without its sign."""
    return float(abs(record.between(*UNLOADING).friction[0]))


def scatter(record: Record) -> tuple[float, float, float]:
    """How far the measured cycles from FIRST on differ, over the sliding friction.

    The rms of a cycle less the mean cycle; the rms of a cycle less the one before it, over the square root of
    2; and the standard deviation of a cycle's work over its mean.
    """
    phase = np.arange(0.0, CYCLE, 0.02)
    starts = FIRST + CYCLE * np.arange(CYCLES)
    cycles = np.array([np.interp(start + phase, record.time, record.friction) for start in starts])
    works = [work(part.friction, part) for part in (record.between(s, s + CYCLE) for s in starts)]
    from_mean = np.sqrt(np.mean((cycles - cycles.mean(axis=0)) ** 2))
    from_last = np.sqrt(np.mean(np.diff(cycles, axis=0) ** 2) / 2.0)
    sliding = sliding_friction(record)
    return float(from_mean / sliding), float(from_last / sliding), float(np.std(works) / np.mean(works))


def repeated(record: Record) -> Record:
    """An empirical baseline: the mean of the fitted cycles, repeated over the predicted ones."""
    phase = np.arange(0.0, CYCLE, 0.02)
    later = predicted_cycles(record)

    def mean(column: np.ndarray) -> np.ndarray:
        cycles = [np.interp(FIRST + k * CYCLE + phase, record.time, column) for k in range(FITTED)]
        return np.interp(later.time - FIRST, phase, np.mean(cycles, axis=0), period=CYCLE)

    return Record(later.time, *map(mean, (record.load, record.position, record.friction)))


def work(friction: np.ndarray, record: Record) -> float:
    """Work along the path [J], trapezoidal."""
    return float(np.trapezoid(friction, record.position))


def along_path(fmu: FrictionFmu, record: Record, start_values: dict[str, Value]) -> np.ndarray:
    """F_t [N] at the samples; position and load are linear in time between them."""
    steps = np.diff(record.time)
    velocity = np.diff(record.position) / steps
    load = np.maximum(record.load, MIN_LOAD)
    inputs = {"V": velocity, "load": load}
    rates = {"V": np.zeros(len(steps)), "load": np.diff(load) / steps}
    return run(fmu, start_values, steps, inputs, rates, outputs=("F_t",))[:, 0]


def fit(fmu: FrictionFmu, record: Record, law: str) -> RecordFit:
    """Least squares on the fitted cycles, then one run over all."""
    sliding = sliding_friction(record)
    cycles = fitted_cycles(record)
    whole = modelled(record)
    load = float(cycles.load.mean())

    def model(parameters: Sequence[float], part: Record, limit: str = "Load") -> np.ndarray:
        stiffness, mu = map(float, np.exp(parameters))
        start = float(np.clip(part.friction[0], -mu * load, mu * load))  # as the friction strains the bristle
        start_values: dict[str, Value] = {
            "friction.model": law,
            "friction.limit": limit,
            "friction.mu": mu,
            "F_C": mu * load,
            "contact.model": "Constant",
            "contact.sigma": stiffness,
            "contact.input": "Load",
            "delta_0": start / stiffness,
        }
        return along_path(fmu, part, start_values)

    guess = np.log([sliding / 6e-5, sliding / load])
    found = least_squares(
        lambda x: model(x, cycles) - cycles.friction, guess, diff_step=1e-4, x_scale=[1.0, 0.2]
    )
    friction, constant = model(found.x, whole), model(found.x, whole, "Constant")
    predicted, unloading = predicted_cycles(record), whole.time >= UNLOADING[0]
    of_predicted = friction[np.isin(whole.time, predicted.time)]
    misfits = rms(found.fun) / sliding, rms(of_predicted - predicted.friction) / sliding
    works = work(of_predicted, predicted) / work(predicted.friction, predicted)
    stiffness, mu = map(float, np.exp(found.x))
    known = None if law == "Coulomb" else stiffness
    return RecordFit(law, known, mu, friction, *misfits, works, friction[unloading], constant[unloading])


def without_bound(record: Record, fit: RecordFit) -> np.ndarray:
    """Dahl's force [N] over the unloading with mu F_n(t) in Eq. 2 and nothing that holds it below mu F_n(t).

    dF/dt = k V - k |V| F / (mu F_n), by scipy's LSODA from the force that the law has when the load begins to
    fall.
    """
    assert fit.stiffness is not None
    stiffness = fit.stiffness
    part = record.between(*UNLOADING)
    load = np.maximum(part.load, MIN_LOAD)
    velocity = np.diff(part.position) / np.diff(part.time)
    forces = [float(fit.unloading[0])]
    for k, V in enumerate(velocity):
        begin, end = part.time[k : k + 2]

        def rate(t: float, F: np.ndarray, k: int = k, V: float = V) -> np.ndarray:
            limit = fit.mu * np.interp(t, part.time[k : k + 2], load[k : k + 2])
            return stiffness * (V - abs(V) * F / limit)

        solution = solve_ivp(rate, (begin, end), forces[-1:], "LSODA", rtol=1e-8, atol=1e-10)
        forces.append(float(solution.y[0, -1]))
    return np.array(forces)


def over_the_load(record: Record, friction: np.ndarray) -> tuple[float, float]:
    """Least and largest |F| / F_n of the unloading while the load is above CARRYING."""
    part = record.between(*UNLOADING)
    ratio = (np.abs(friction) / part.load)[part.load > CARRYING]
    return float(ratio.min()), float(ratio.max())


def misfit_of_unloading(record: Record, friction: np.ndarray) -> float:
    """rms over the unloading, over the measured friction before it."""
    return rms(friction - record.between(*UNLOADING).friction) / friction_before_unloading(record)
