"""Whether scripts/advise holds its promise in scenes drawn at random, and what its advice costs too much.

    python -m workshop.check.advice --scenes 40 --seed 1

Each scene is run over more than 50 periods from five phases of the vibration, from rest and settled, and held
against workshop/reference. The price of the advice is what it costs over the cheapest setting that would have
kept the promise in all these runs: Coulomb friction, or the default at a tolerance of 1e-2, 3e-3, ... 1e-10.
"""

from __future__ import annotations

import argparse
import math
import os
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from frictioncontact.advice.answer import advise
from frictioncontact.batch import simulate_many
from frictioncontact.command import finish
from frictioncontact.errors import UserError
from frictioncontact.fmu import FrictionFmu, Value, opened
from frictioncontact.parameters import STIFFNESS_PRINTED
from workshop.build import build_fmu
from workshop.reference import solution as reference
from workshop.reference.settled import settled
from workshop.reference.solution import MP
from workshop.reference.start_values import scene_of

T = 5e-5  # s, period of the vibration
F_C = 55.0  # N
LAWS = ("Dahl", "LuGre", "ElasticPlastic", "Coulomb")
PHASES = 5
LONG = 49.37 * T  # s, of one step of each run
OUTPUTS = ("F_t", "F_t_mean")
TOLERANCES = [float(f"{10.0 ** (-k / 2):.0e}") for k in range(4, 21)]
COPIES = 200  # of a scene, whose time is taken together
TURNS = 5


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
            now, delta, rows = MP.mpf(phase), delta_0, []
            for h in steps_of(step):
                delta, impulse = reference.advance(truth, now, h, delta)[:2]
                now += MP.mpf(h)
                rows.append((float(reference.force(truth, now, delta)), float(impulse) / h))
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


@dataclass(frozen=True)
class Grade:
    seed: int
    law: Value
    advice: str
    share: float  # error over what is allowed
    cheapest: str
    evaluations: float  # of the advice over those of the cheapest setting that holds
    seconds: float  # the same of processor time


def grade(path: Path, seed: int) -> Grade:
    scene, accuracy, step = draw(seed)
    fmu, bound = opened(path), allowed(scene, accuracy)
    runs = runs_of(scene, step)
    settings = advise(scene, accuracy=accuracy, step=step, fmu=path).settings
    worst, advised = missed(fmu, {**scene, **settings}, step, runs)
    cheapest, least = settings, advised
    tightest = settings.get("solver.tolerance", 0.0)
    looser: list[dict[str, Value]] = [{"solver.tolerance": each} for each in TOLERANCES if each > tightest]
    for other in [{"friction.model": "Coulomb"}, *looser]:
        error, evaluations = missed(fmu, {**scene, **other}, step, runs)
        if error.max() <= bound and evaluations < least:
            cheapest, least = other, evaluations
    seconds = 1.0
    if cheapest != settings:
        taken = [[_seconds(path, {**scene, **s}, step) for s in (settings, cheapest)] for _ in range(TURNS)]
        seconds = float(np.divide(*np.min(taken, axis=0)))
    return Grade(
        seed, scene["friction.model"], _said(settings), float(worst.max()) / bound,
        _said(cheapest), advised / least if least else math.inf, seconds,
    )  # fmt: skip


def _said(settings: Mapping[str, Value]) -> str:
    return next(f"{value:.0e}" if isinstance(value, float) else str(value) for value in settings.values())


def _seconds(path: Path, settings: Mapping[str, Value], step: float) -> float:
    began = time.process_time()
    copies = {**settings, "vibration.phase_d": np.full(COPIES, settings["vibration.phase_d"])}
    simulate_many(copies, OUTPUTS, steps=steps_of(step), unit="s", threads=1, fmu=path)
    return time.process_time() - began


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m workshop.check.advice", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--scenes", type=int, default=40, help="how many (40)")
    parser.add_argument("--seed", type=int, help="of the first scene; by the clock when not given")
    return parser.parse_args(argv)


def run(options: argparse.Namespace) -> None:
    first = time.time_ns() // 10**9 if options.seed is None else options.seed
    print(f"scenes {first} to {first + options.scenes - 1}")
    print(
        f"{'scene':>11} {'law':15}{'advised':>9}{'error/allowed':>15}{'cheapest':>10}"
        f"{'evaluations':>13}{'time':>7}"
    )
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        grades = []
        path = build_fmu()
        asked = [pool.submit(grade, path, seed) for seed in range(first, first + options.scenes)]
        for done in as_completed(asked):
            grades.append(one := done.result())
            print(
                f"{one.seed:11} {one.law:15}{one.advice:>9}{one.share:15.2g}{one.cheapest:>10}"
                f"{one.evaluations:13.2f}{one.seconds:7.2f}", flush=True,
            )  # fmt: skip
    for what in ("evaluations", "seconds"):
        ratios = [getattr(one, what) for one in grades]
        print(f"{what} over the cheapest: median {np.median(ratios):.2f}, worst {max(ratios):.2f}")
    beyond = [one.seed for one in grades if one.share > 1.0]
    if beyond:
        raise UserError(f"the advice misses its promise in scenes {', '.join(map(str, beyond))}")
    print(f"the promise holds in all {len(grades)} scenes")


def main(argv: Sequence[str] | None = None) -> None:
    finish(run, arguments(argv))


if __name__ == "__main__":
    main()
