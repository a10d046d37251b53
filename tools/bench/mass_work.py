"""The work of a mass inside the FMU against its accuracy, for docs/numerics.md.

    .venv/bin/python -m tools.bench.mass_work      draws the picture of the page, prints its table; minutes

    m v' = body.F - F_t

The FMU solves it by its panels (solver.method = collocation) and by CVODE (solver.method = cvode), both
driven from C. Beside them stand two hosts in Python that keep v as their own state: BDF of scipy on model
exchange, and a Gauss-Seidel master whose steps are a step of the scene and whole parts of it.
Work is CPU time over simulated time: 1 is real time. An error is the larger of those of F_t and F_t_mean,
over F_C. What is right is hunt/reference.c.
"""

import time
from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from frictioncontact.advice.stuck_mass import GAUSS_SEIDEL
from frictioncontact.command import progress_bar
from frictioncontact.errors import UserError
from frictioncontact.exchange import ModelExchange
from frictioncontact.fmu import FrictionFmu, Value
from frictioncontact.parameters import PERIOD
from tools.bench import figures
from tools.bench.cases import Case, expected
from tools.bench.driver import Bench, Outcome, failed, open_bench
from tools.bench.exchange import MODEL_EXCHANGE
from tools.bench.mass_inside import by_master
from tools.bench.work_precision import Point, graded
from tools.project import ROOT

PICTURE = ROOT / "docs" / "pictures" / "mass-work.png"
TOLERANCES = tuple(10.0**-k for k in range(2, 12))
TOLERANCE_OF_TABLE = 1e-6  # the default
ROUNDS = 4  # in which all settings take turns; the least time counts
BUDGET = 0.01  # s of CPU time for one setting in one round
H = 1e-3  # s
PANELS, CVODE = "collocation", "cvode"
PARTS = (1, 10, 100, 1000)  # of a step of the scene, by the master
STATIC: dict[str, Value] = {"friction.staticRatio": 1.5, "friction.V_S": 0.1}
VIBRATES: dict[str, Value] = {"vibration.V_1": 1.44}  # at 20 kHz


def pulled(title: str, law: str, sigma: float, count: int = 1, **more: Value) -> Case:
    """1 kg on a contact of sigma [N/m] with F_C = 55 N, from rest, pulled by 30 N in steps of 1 ms."""
    values: dict[str, Value] = {"contact.model": "Constant", "contact.sigma": sigma, "friction.model": law}
    values |= {"F_C": 55.0, "V": 0.0, "body.m": 1.0, "body.F": 30.0, **more}
    return Case(
        title, f"{title}, {law}, {sigma:.0e} N/m".replace("e+0", "e").replace("e+", "e"), values, H, count
    )


def to_and_fro() -> Case:
    """It sticks twice in a period of the pull, and breaks away at 1.3 F_C."""
    of: dict[str, Value] = {"friction.staticRatio": 1.3, "friction.V_S": 0.05}
    pull = 100.0 * np.sin(2.0 * np.pi * 10.0 * H * np.arange(101))
    scene = pulled("stick-slip", "ElasticPlastic", 6e6, 100, **of)
    return replace(scene, inputs={"body.F": pull}, linear=True)


def drawn() -> list[Case]:
    """The scenes of the picture."""
    return [
        to_and_fro(),
        pulled("under 20 kHz", "Dahl", 6e6, 2, **VIBRATES),
        pulled("ringing", "Dahl", 6e8, 5),
        pulled("ringing in stick", "ElasticPlastic", 6e8, 5, **{"body.F": 20.0}),
    ]


def tabled() -> list[Case]:
    """The scenes of the table, of a step each."""
    return [
        *(pulled("20 kHz", "Dahl", sigma, **VIBRATES) for sigma in (6e4, 6e6, 6e12)),
        pulled("20 kHz", "ElasticPlastic", 6e6, **VIBRATES),
        pulled("20 kHz, Stribeck's curve", "LuGre", 6e8, **VIBRATES, **STATIC),
        pulled("no vibration", "Dahl", 6e8),
        pulled("no vibration, Stribeck's curve", "LuGre", 6e8, **STATIC, **{"body.F": 70.0}),
        *(pulled("stuck", "ElasticPlastic", sigma, **{"body.F": 20.0}) for sigma in (6e6, 6e12)),
    ]


def exchanged(fmu: FrictionFmu, scene: Case, tolerance: float) -> Outcome:
    """The scene in model exchange; F_t_mean follows from the change of v."""
    values = dict(scene.start_values)
    m, held = float(values.pop("body.m")), float(values.pop("body.F"))
    F = scene.inputs.get("body.F", np.full(scene.count + 1, held))
    times = scene.step * np.arange(scene.count + 1)

    def rates(t: float, own: np.ndarray, F_t: float) -> tuple[float]:
        return ((np.interp(t, times, F) - F_t) / m,)

    v, F_t = np.zeros(scene.count + 1), np.zeros(scene.count)
    of_v = {"own": (0.0,), "rates": rates, "nominals": (scene.F_C * scene.step / m,)}
    of_v |= {"inputs": lambda t, own: {"V": own[0]}, "tolerance": tolerance}
    try:
        with ModelExchange(values, fmu=fmu, **of_v) as host:
            begin = time.process_time()
            for k, stop in enumerate(times[1:]):
                host.advance(stop)
                v[k + 1], F_t[k] = host.own[0], host.get("F_t")
            cpu = time.process_time() - begin
            evaluations = host.get("solver.evaluations")
    except (UserError, RuntimeError) as error:
        return failed(str(error))
    mean = 0.5 * (F[1:] + F[:-1]) - m * np.diff(v) / scene.step
    return Outcome(F_t, mean, cpu / scene.count, evaluations / scene.count)


def mastered(fmu: FrictionFmu, scene: Case, parts: int) -> Outcome:
    """The scene by Gauss-Seidel in equal parts of a step: v by the last force, then the contact."""
    values = dict(scene.start_values)
    m, held = float(values.pop("body.m")), float(values.pop("body.F"))
    count, H = scene.count * parts, scene.step / parts
    samples = scene.inputs.get("body.F", np.full(scene.count + 1, held))
    pull = np.interp(np.arange(count) / parts, np.arange(scene.count + 1), samples)
    output = "F_t_mean" if "vibration.V_1" in values else "F_t"
    with fmu.session(values) as session:
        begin = time.process_time()
        rows = by_master(session, m, pull, H, output, GAUSS_SEIDEL)
        cpu = time.process_time() - begin
        evaluations = session.get("solver.evaluations")
    F_t, means = rows[1:, 1:].reshape(scene.count, parts, 2).transpose(2, 0, 1)
    return Outcome(F_t[:, -1], means.mean(axis=1), cpu / scene.count, evaluations / scene.count)


def solved(bench: Bench, scene: Case, method: str, setting: float) -> Outcome:
    """By the FMU at a tolerance, by its host on model exchange, or by a master in so many parts of a step."""
    if method == MODEL_EXCHANGE:
        return exchanged(bench.fmu, scene, setting)
    if method == GAUSS_SEIDEL:
        return mastered(bench.fmu, scene, int(setting))
    return bench.run(scene.job(0.0, BUDGET, {"solver.method": method, "solver.tolerance": setting}))


def measure(bench: Bench, scene: Case, settings: Sequence[tuple[str, float]]) -> list[Point]:
    """Each method at each setting; cpu of a Point is over simulated time here, the least of ROUNDS."""
    truth = {0.0: expected(scene, 0.0)}
    rounds = [
        [
            graded(scene, truth, *setting, lambda _, setting=setting: solved(bench, scene, *setting))
            for setting in settings
        ]
        for _ in range(ROUNDS)
    ]
    return [replace(same[0], cpu=min(p.cpu for p in same) / PERIOD) for same in zip(*rounds, strict=True)]


def line(scene: Case, panels: Point, cvode: Point) -> str:
    """Of the table."""
    over = float(f"{cvode.cpu / panels.cpu:.2g}")
    return f"| {scene.title} | {panels.cpu:.2g} | {over:g} |"


def main() -> None:
    print("| scene | CPU time over simulated time | CVODE over it |", "|---|---|---|", sep="\n")
    of_table = [(method, TOLERANCE_OF_TABLE) for method in (PANELS, CVODE)]
    with progress_bar() as progress, open_bench(progress) as bench:
        for scene in tabled():
            print(line(scene, *measure(bench, scene, of_table)), flush=True)
        settings = [*product((PANELS, CVODE, MODEL_EXCHANGE), TOLERANCES), *product((GAUSS_SEIDEL,), PARTS)]
        points = [p for scene in drawn() for p in measure(bench, scene, settings)]
    figures.mass_work(points, {scene.name: scene.title for scene in drawn()}, PICTURE)


if __name__ == "__main__":
    main()
