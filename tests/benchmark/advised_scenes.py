"""Scenes drawn at random, and whether settings hold the promise of scripts/advise in them.

Each scene is run over more than 20 periods from two phases of the vibration, from rest and settled, and
graded by workshop/reference.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from frictioncontact.fmu import FrictionFmu, Value
from frictioncontact.parameters import STIFFNESS_PRINTED
from workshop.reference import solution as reference
from workshop.reference.arithmetic import MP
from workshop.reference.settled import settled
from workshop.reference.start_values import scene_of

T = 5e-5  # s, period of the vibration
F_C = 55.0  # N
LAWS = ("Dahl", "LuGre", "ElasticPlastic", "Coulomb")
PHASES = 2
LONG = 19.37 * T  # s, of one step of each run
OUTPUTS = ("F_t", "F_t_mean")


def draw(seed: int) -> tuple[dict[str, Value], float, float]:
    """Start values of a scene, accuracy, communication step [s]."""
    random = np.random.default_rng(seed)
    values: dict[str, Value] = {
        "V": 10.0 ** random.uniform(-3, 0),
        "contact.stiffnessScale": 10.0 ** random.uniform(2, 13) / STIFFNESS_PRINTED,
        "friction.model": LAWS[seed % 4],
        "friction.staticRatio": random.uniform(1, 2),
        "friction.V_S": 10.0 ** random.uniform(-3, -1),
        "vibration.V_1": random.choice([0.0, 1.0, 1.0]) * 10.0 ** random.uniform(-2, 0.5),
        "vibration.a_d": random.choice([0.0, 1.0, 1.0]) * random.uniform(0.1e-6, 1.1e-6),
        "vibration.phase_d": random.uniform(0, 6),
    }
    return values, 10.0 ** random.uniform(-5, -2), T * 10.0 ** random.uniform(-1, 1.5)


def steps_of(step: float) -> tuple[float, ...]:
    return step, LONG, step, step


@dataclass(frozen=True)
class Run:
    """What the reference gives from a phase [s] and a deflection [m]."""

    phase: float
    delta: float
    outputs: np.ndarray  # [step, OUTPUTS], N


def runs_of(scene: Mapping[str, Value], step: float) -> list[Run]:
    truth, runs = scene_of(scene), []
    for phase in np.arange(PHASES) * T / PHASES:
        for delta_0 in (0.0, float(settled(truth, MP.mpf(phase), 0).delta)):
            now, delta, slips, rows = MP.mpf(phase), delta_0, 0, []
            for h in steps_of(step):
                delta, impulse, _, _, slips = reference.advance(truth, now, h, delta, slips=slips)
                now += MP.mpf(h)
                rows.append((float(reference.force(truth, now, delta, slips)), float(impulse) / h))
            runs.append(Run(float(phase), delta_0, np.array(rows)))
    return runs


def missed(
    fmu: FrictionFmu, settings: Mapping[str, Value], step: float, runs: Sequence[Run]
) -> tuple[np.ndarray, float]:
    """The largest error of F_t and of F_t_mean [N], and the evaluations of all runs."""
    worst, evaluations = np.zeros(2), 0.0
    for run in runs:
        with fmu.session({**settings, "delta_0": run.delta}, run.phase) as session:
            for h, right in zip(steps_of(step), run.outputs, strict=True):
                session.step(h)
                worst = np.maximum(worst, np.abs(session.read(OUTPUTS) - right))
            evaluations += session.get("solver.evaluations")
    return worst, evaluations


def allowed(scene: Mapping[str, Value], accuracy: float) -> float:
    """The largest error [N] that the promise grants: of F_C, and of a mean friction that is not nearly 0."""
    truth = scene_of(scene)
    impulse = reference.advance(truth, 0, T, settled(truth, 0, 0).delta)[1]
    mean = abs(float(impulse)) / T if truth.vibrates else F_C
    return accuracy * (min(F_C, mean) if mean > 1e-4 else F_C)
