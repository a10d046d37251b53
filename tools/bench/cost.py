"""Counts what a step costs in an FMU, over what it costs in another: instructions by callgrind, evaluations
of the equation, CPU time. Each FMU is a file, or a commit, which is built in build/cost/ by this compiler.

All calls of a host in a step count: inputs are set, the step is made, the force is read. Times are the least
of some rounds in which the FMUs take turns. docs/solver.md#what-a-step-costs names the scenes."""

import argparse
import math
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

from rich.progress import Progress

from frictioncontact.command import (
    add_output,
    as_table,
    command_line,
    progress_bar,
    say_written,
    table_console,
    write_csv,
)
from frictioncontact.errors import UserError
from frictioncontact.fmu import FrictionFmu, Value
from tools.bench.cases import Case, cases
from tools.bench.driver import REPORT, Bench
from tools.build import build_targets
from tools.project import ROOT

BEFORE = "ba0ea32"  # the core of 0.4.0
LAWS: dict[str, dict[str, Value]] = {
    "Dahl": {},
    "LuGre": {"friction.model": "LuGre", "friction.staticRatio": 1.3},
    "ElasticPlastic": {"friction.model": "ElasticPlastic"},
    "ElasticPlastic, static 1.3": {"friction.model": "ElasticPlastic", "friction.staticRatio": 1.3},
    "Dahl, limit Load": {"friction.limit": "Load"},
}
TOLERANCES = (1e-3, 1e-6, 1e-8)
STEPS = 10  # of a vibrating scene
MANY = 10_000  # instances, more than a processor's caches hold
CALLS = ("fmi2SetReal", "fmi2SetRealInputDerivatives", "fmi2DoStep", "fmi2GetReal")  # what is counted
BUDGET = 0.01  # s of CPU time for one scene in one round


@dataclass(frozen=True)
class Scene:
    group: str  # line of the table
    case: Case
    settings: Mapping[str, Value]


@dataclass(frozen=True)
class Cost:
    """Of one step."""

    instructions: float
    evaluations: float
    time: float  # s of CPU time


def vibrating_scenes(tolerances: Sequence[float] = TOLERANCES) -> list[Scene]:
    """Five laws, seven motions, each tolerance."""
    motions = [replace(case, count=STEPS) for case in cases() if case.name.startswith("vibrating-")]
    return [
        Scene(law, case, {**settings, "solver.tolerance": tolerance})
        for law, settings in LAWS.items()
        for case in motions
        for tolerance in tolerances
    ]


def held() -> Case:
    """Held inputs, over so many steps that they are not the first ones of an instance."""
    return replace(next(case for case in cases() if case.name == "held"), count=2000)


def other_scenes() -> list[Scene]:
    """Those without vibration: held and linear inputs, each a line of the table."""
    others = [held(), *(case for case in cases() if not case.name.startswith(("vibrating-", "held")))]
    return [Scene(case.title, case, {}) for case in others]


def counted(bench: Bench, scene: Scene) -> tuple[float, float]:
    """Instructions and evaluations of a step."""
    job = scene.case.job(0.0, 0.0, scene.settings)
    with tempfile.TemporaryDirectory() as folder:
        counts = Path(folder) / "counts"
        callgrind = f"valgrind --tool=callgrind --collect-atstart=no --callgrind-out-file={counts}".split()
        callgrind += [f"--toggle-collect={name}" for name in CALLS]
        outcome = bench.run(job, under=callgrind)
        if outcome.failure:
            raise UserError(f"{scene.case.title}: {outcome.failure}")
        totals = re.search(r"^totals: (\d+)", counts.read_text(), re.MULTILINE)
    if totals is None or not int(totals[1]):
        raise UserError(f"{scene.case.title}: callgrind has counted nothing in {', '.join(CALLS)}")
    return int(totals[1]) / job.count, outcome.evaluations


def costs(
    benches: Sequence[Bench], scenes: Sequence[Scene], rounds: int, progress: Progress
) -> list[list[Cost]]:
    """Of each scene, by each bench."""
    tasks = [(bench, scene) for scene in scenes for bench in benches]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = pool.map(lambda task: counted(*task), tasks)
        counts = list(progress.track(found, len(tasks), description="Counting instructions"))
    times = [math.inf] * len(tasks)
    for _ in range(rounds):
        for k, (bench, scene) in enumerate(progress.track(tasks, description="Taking times")):
            times[k] = min(times[k], bench.run(scene.case.job(0.0, BUDGET, scene.settings)).cpu)
    each = [Cost(*count, time) for count, time in zip(counts, times, strict=True)]
    return [each[k : k + len(benches)] for k in range(0, len(each), len(benches))]


def in_turn(bench: Bench, rounds: int) -> float:
    """The time of a held step of one among MANY instances that take turns, over that of one alone."""
    alone = held().job(0.0, BUDGET)
    many = replace(alone, instances=MANY, count=20, budget=0.0)
    times = [(bench.run(many).cpu, bench.run(alone).cpu) for _ in range(rounds)]
    least = [min(column) for column in zip(*times, strict=True)]
    return least[0] / least[1]


def geometric_mean(values: Sequence[float]) -> float:
    return math.exp(sum(map(math.log, values)) / len(values))


def ratios(title: str, pairs: Sequence[Sequence[Cost]]) -> list[str]:
    """A line of the table: geometric means of the costs by the second over those by the first."""
    means = [
        geometric_mean([getattr(now, name) / getattr(before, name) for before, now in pairs])
        for name in ("instructions", "evaluations", "time")
    ]
    return [title, *(f"{mean:.2f}" for mean in means)]


def csv_rows(scenes: Sequence[Scene], pairs: Sequence[Sequence[Cost]]) -> list[dict[str, object]]:
    """The costs themselves, a scene a line."""
    rows = []
    for scene, pair in zip(scenes, pairs, strict=True):
        tolerance = scene.settings.get("solver.tolerance", 1e-6)
        rows.append({"group": scene.group, "scene": scene.case.name, "tolerance": tolerance})
        for which, cost in zip(("before", "now"), pair, strict=True):
            rows[-1] |= {f"{name} {which}": value for name, value in vars(cost).items()}
    return rows


def built(commit: str, progress: Progress) -> Path:
    """The FMU of a commit, by the compiler of the clone's own; raises UserError if there is none."""
    if not re.fullmatch(r"[0-9a-f]{7,40}", commit):
        raise UserError(f"{commit} is neither an FMU nor the hash of a commit")
    source, folder = (ROOT / "build" / "cost" / commit[:7] / name for name in ("source", "build"))
    fmu = folder / "FrictionContact.fmu"
    if fmu.is_file():
        return fmu
    task = progress.add_task(f"Building {commit}", total=None)
    archive = subprocess.run(["git", "archive", commit], cwd=ROOT, capture_output=True, check=False)
    if archive.returncode:
        raise UserError(f"{commit}: {archive.stderr.decode().strip()}")
    source.mkdir(parents=True, exist_ok=True)
    subprocess.run(["tar", "-x", "-C", source], input=archive.stdout, check=True)
    settings = {
        "CMAKE_BUILD_TYPE": "Release",
        "Python3_EXECUTABLE": sys.executable,
        "FC_SUNDIALS_SOURCE": ROOT / "build" / "sundials-source",
    }
    configure = ["-S", source, "-B", folder, *(f"-D{name}={value}" for name, value in settings.items())]
    for words in (configure, ["--build", folder, "--target", "fmu", "--parallel", str(os.cpu_count() or 1)]):
        done = subprocess.run(
            [sys.executable, "-m", "cmake", *words], capture_output=True, text=True, check=False
        )
        if done.returncode:
            raise UserError(f"{commit} can't be built: {done.stderr.strip()[-2000:]}")
    progress.remove_task(task)
    return fmu


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = command_line("scripts/cost", __doc__)
    add = parser.add_argument
    add("before", nargs="?", default=BEFORE, metavar="BEFORE", help=f"an FMU or a commit ({BEFORE})")
    add("now", nargs="?", metavar="NOW", help="another; the clone's own, built anew, if it is not given")
    add("--quick", action="store_true", help="the tolerance 1e-6 alone, in a third of the time")
    add_output(parser, REPORT)
    return parser.parse_args(argv)


def run(options: argparse.Namespace) -> None:
    vibrating = vibrating_scenes(TOLERANCES[1:2] if options.quick else TOLERANCES)
    scenes = [*vibrating, *other_scenes()]
    rounds = 2 if options.quick else 5
    with progress_bar() as progress:
        folder = build_targets("default", ["all", "bench"], progress)
        names = (options.before, options.now or str(folder / "FrictionContact.fmu"))
        paths = [Path(name) if Path(name).is_file() else built(name, progress) for name in names]
        with FrictionFmu(paths[0]) as before, FrictionFmu(paths[1]) as now:
            benches = [Bench(fmu, folder / "bench") for fmu in (before, now)]
            pairs = costs(benches, scenes, rounds, progress)
            turns = [in_turn(bench, rounds) for bench in benches]
    groups: dict[str, list[list[Cost]]] = {scene.group: [] for scene in scenes}
    for scene, pair in zip(scenes, pairs, strict=True):
        groups[scene.group].append(pair)
    groups |= {f"all {len(vibrating)} that vibrate": pairs[: len(vibrating)]}
    lines = [ratios(title, group) for title, group in groups.items()]
    title = f"The costs of a step in {names[1]}, over those in {names[0]}"
    table_console().print(as_table(["scene", "instructions", "evaluations", "time"], lines, title))
    print(f"A held step of one of {MANY} instances that take turns, over that of one alone: ", end="")
    print(f"{turns[1]:.2f} (before: {turns[0]:.2f})")
    say_written([write_csv(csv_rows(scenes, pairs), options.output / "cost.csv")])
