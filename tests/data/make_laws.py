"""Makes laws_<law>.csv: 200 random scenes a law, of one to four steps, and what the reference gives.

    PYTHONPATH=tests python tests/data/make_laws.py [LAW ...]

The law Settled is 60 scenes of the laws with a state that start settled.
Takes ten minutes. The seeds are fixed: the files change only with the reference or the distributions below.
One row is one step; what stands for a whole scene is given in the row of its first step. Empty: the default.
Times are multiples of 2^-50 s, so that start + h is exact.
"""

from __future__ import annotations

import csv
import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from physics.course import Course

from workshop.reference import solution as reference
from workshop.reference.arithmetic import MP, multiprecision
from workshop.reference.contact import Contact, normal_force, stiffness
from workshop.reference.scene import Scene
from workshop.reference.settled import settled

SEEDS = {"Dahl": 11, "LuGre": 12, "ElasticPlastic": 13, "Coulomb": 14, "Settled": 15}
COUNT, SETTLED_COUNT = 200, 60
WITH_A_STATE = ("Dahl", "LuGre", "ElasticPlastic")
SOFTEST, LEAST_SCALE = 1e-6, 1e-15  # the FMU's bounds of contact.sigma [N/m] and contact.stiffnessScale
INPUTS = "V d E load V_rate d_rate E_rate load_rate".split()
PARAMETERS = "friction limit F_C mu staticRatio V_S sigma_1 sigma_2 input f V_1 a_d phase_d".split()
GEOMETRY = "R_q R eta A_n nu Y c lambda_".split()
CONTACT = ["model", "sigma", "stiffnessScale", *GEOMETRY]
RESULTS = "settled F_t F_t_mean W_f Q_f delta scale path".split()
COLUMNS = ["scene", "start", "h", *INPUTS, "tolerance", "delta_0", *PARAMETERS, *CONTACT, *RESULTS]


class Draw:
    """Random numbers of six digits."""

    def __init__(self, seed: Any) -> None:
        self.random = np.random.default_rng(seed)

    def log(self, low: float, high: float) -> float:
        return float(f"{low * (high / low) ** self.random.random():.6g}")

    def uniform(self, low: float, high: float) -> float:
        return float(f"{self.random.uniform(low, high):.6g}")

    def chance(self, probability: float) -> bool:
        return bool(self.random.random() < probability)

    def pick(self, *values: Any) -> Any:
        return values[int(self.random.integers(len(values)))]

    def time(self, low: float, high: float) -> float:
        return max(1, round(self.log(low, high) * 2**50)) / 2**50


def rest_separation(contact: Contact, load: Any, E: Any, a_d: Any = 0) -> Any:
    """d [m] at which the time mean of F_n over a period of the vibration is the load."""
    decay = MP.mpf(contact.lambda_) / MP.mpf(contact.R_q)
    swell = MP.besseli(0, decay * MP.mpf(a_d))
    return MP.log(normal_force(contact, 0, E) * swell / MP.mpf(load)) / decay


def velocity(draw: Draw, V_1: float) -> float:
    sign = draw.pick(-1.0, 1.0)
    kind = draw.random.random()
    if kind < 0.05:
        return 0.0
    if V_1 > 0.0 and kind < 0.25:  # dips and tangential reversals
        return float(f"{sign * V_1 * (1.0 + draw.pick(-1.0, 1.0) * draw.log(1e-8, 1e-1)):.12g}")
    if V_1 > 0.0 and kind < 0.8:
        return float(f"{sign * V_1 * draw.uniform(0.0, 3.0):.6g}")
    return sign * draw.log(1e-4, 10.0)


def geometry(draw: Draw) -> Contact:
    usual = Contact()
    if draw.chance(0.7):
        return usual
    values = {name: float(f"{getattr(usual, name) * draw.log(0.7, 1.4):.6g}") for name in GEOMETRY}
    values["nu"] = draw.uniform(0.0, 0.45)
    values["Y"] = usual.Y * draw.log(0.3, 30.0)
    return Contact(**values)


def random_scene(law: str, draw: Draw, *, drops: bool = True) -> Scene:
    """drops: ElasticPlastic may have static friction."""
    f = draw.log(1e3, 1e5)
    V_1 = draw.log(1e-3, 3.0) if draw.chance(0.75) else 0.0
    V = velocity(draw, V_1)
    contact = geometry(draw)
    length = contact.R_q / contact.lambda_ / 2e-6
    scene = Scene(
        V=V,
        d=float(f"{draw.uniform(12e-6, 17e-6) * length:.6g}"),
        E=draw.uniform(20e9, 90e9),
        load=draw.log(1.0, 1e3),
        f=f,
        V_1=V_1,
        a_d=float(f"{draw.log(1e-8, 2.5e-6) * length:.6g}") if draw.chance(0.7) else 0.0,
        phase_d=draw.uniform(-2 * np.pi, 2 * np.pi),
        F_C=draw.log(1.0, 1e3),
        friction=law,
        limit=draw.pick("Constant", "Load"),
        mu=draw.log(0.05, 1.0),
        input=draw.pick("Separation", "Separation", "Load"),
        contact=replace(contact, model=draw.pick("Asperities", "Mindlin", "Constant")),
    )
    return dressed(scene, draw, drops)


def dressed(scene: Scene, draw: Draw, drops: bool) -> Scene:
    """With a stiffness for a random kappa, damping and Stribeck's velocity on the scale of the scene."""
    contact, top = scene.contact, max(abs(scene.V), scene.V_1, 1e-3)
    limit, d = resting_limit(scene)
    sigma = draw.log(1e-3, 1e8) * 2 * np.pi * scene.f * limit / top
    if contact.model == "Constant":
        contact = replace(contact, sigma=max(SOFTEST, float(f"{sigma:.6g}")))
    else:
        scale = float(f"{sigma / float(stiffness(contact, d, scene.E)):.6g}")
        contact = replace(contact, stiffnessScale=max(LEAST_SCALE, scale))

    def damping() -> float:
        return float(f"{draw.log(1e-3, 1.0) * limit / top:.6g}") if draw.chance(0.5) else 0.0

    stribeck = {}
    if scene.friction == "LuGre" or (scene.friction == "ElasticPlastic" and drops):
        stribeck["staticRatio"] = 1.0 if draw.chance(0.1) else 1.0 + draw.log(0.05, 2.0)
        stribeck["V_S"] = float(f"{draw.log(1e-3, 10.0) * top:.6g}")
    sigma_1 = damping() if scene.friction != "Coulomb" else 0.0
    return replace(scene, contact=contact, sigma_1=sigma_1, sigma_2=damping(), **stribeck)


def resting_limit(scene: Scene) -> tuple[float, float]:
    """F_C or mu F_n [N], and the separation [m], without vibration."""
    d = scene.d
    if scene.input == "Load":
        d = float(rest_separation(scene.contact, scene.load, scene.E, scene.a_d))
    if scene.limit == "Constant":
        return scene.F_C, d
    return scene.mu * float(normal_force(scene.contact, d, scene.E)), d


def random_steps(scene: Scene, draw: Draw) -> list[tuple[Scene, float]]:
    """The scene at the start of every step, and the step's size [s]."""
    start = draw.time(1e-6, 1e-1) if draw.chance(0.5) else 0.0
    steps = []
    for _ in range(draw.pick(1, 1, 2, 2, 3, 4)):
        linear = draw.chance(0.35)
        h = draw.time(0.01 / scene.f, (3.0 if linear or scene.bounded else 50.0) / scene.f)
        now = replace(scene, start=start, **(rates(scene, h, draw) if linear else {}))
        steps.append((now, h))
        start += h
        scene = following(now, h, draw)
    return steps


def rates(scene: Scene, h: float, draw: Draw) -> dict[str, float]:
    spans = {
        "V_rate": 2.0 * max(abs(scene.V), scene.V_1, 1e-3),
        "d_rate": 1e-6,
        "E_rate": 0.3 * scene.E,
        "load_rate": 0.5 * scene.load,
    }
    return {
        name: 0.0 if draw.chance(0.3) else float(f"{draw.uniform(-1.0, 1.0) * span / h:.6g}")
        for name, span in spans.items()
    }


def following(scene: Scene, h: float, draw: Draw) -> Scene:
    """Inputs that go on where they were, held, or that jump."""
    values = {name: getattr(scene, name) + h * getattr(scene, f"{name}_rate") for name in INPUTS[:4]}
    if draw.chance(0.5):
        values["V"] = velocity(draw, scene.V_1)
        values["d"] *= draw.uniform(0.97, 1.03)
        if scene.input == "Separation":
            values["E"] *= draw.uniform(0.9, 1.1)
        values["load"] *= draw.uniform(0.5, 2.0)
    values = {name: float(f"{value:.9g}") for name, value in values.items()}
    return replace(scene, **values, **dict.fromkeys(INPUTS[4:], 0.0))


def text(value: Any) -> str:
    return str(MP.nstr(multiprecision(value), 18))


def given(value: Any, usual: Any) -> str:
    return "" if value == usual else value if isinstance(value, str) else repr(value)


def rows_of(law: str, number: int) -> list[dict[str, str]]:
    draw = Draw([SEEDS[law], number])
    if law == "Settled":
        scene = random_scene(WITH_A_STATE[number % 3], draw, drops=False)
        steps = [(replace(scene, start=draw.time(1e-6, 1e-1)), draw.time(0.1 / scene.f, 2.0 / scene.f))]
    else:
        steps = random_steps(random_scene(law, draw), draw)
    first = steps[0][0]
    stiff = float(reference.sigma(first, first.start))
    spread = 1.0 if draw.chance(0.75) else 3.0
    delta_0 = float(f"{draw.uniform(-spread, spread) * resting_limit(first)[0] / stiff:.9g}")
    begin = settled(first, first.start, delta_0).delta if law == "Settled" else delta_0
    course, usual, rows = Course(first, begin), Scene(), []
    for now, h in steps:
        row = {"scene": str(number), "start": repr(now.start), "h": repr(h)}
        row |= {name: given(getattr(now, name), getattr(usual, name)) for name in INPUTS}
        if not rows:
            row |= {name: given(getattr(now, name), getattr(usual, name)) for name in PARAMETERS}
            row |= {name: given(getattr(now.contact, name), getattr(usual.contact, name)) for name in CONTACT}
            row |= {"settled": text(begin)} if law == "Settled" else {}
            row |= {"tolerance": f"1e-{2 + number % 7}", "delta_0": repr(delta_0)}
        step = course.step(now, h)._asdict()
        row |= {name: f"{step.pop(name):.9g}" for name in ("scale", "path")}
        row |= {name: text(value) for name, value in step.items()}
        rows.append(row)
    return rows


def rows_of_pair(job: tuple[str, int]) -> list[dict[str, str]]:
    return rows_of(*job)


def main() -> None:
    for law in sys.argv[1:] or SEEDS:
        out = Path(__file__).with_name(f"laws_{law.lower()}.csv")
        count = SETTLED_COUNT if law == "Settled" else COUNT
        partial = out.with_suffix(".partial")
        with partial.open("w", newline="") as file, ProcessPoolExecutor(2) as pool:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n", restval="")
            writer.writeheader()
            for k, rows in enumerate(pool.map(rows_of_pair, [(law, n) for n in range(count)], chunksize=5)):
                writer.writerows(rows)
                print(f"\r{law}: {k + 1} of {count}", end="", file=sys.stderr, flush=True)
        partial.replace(out)
        print(file=sys.stderr)


if __name__ == "__main__":
    main()
