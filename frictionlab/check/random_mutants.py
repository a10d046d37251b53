"""Random single-token mutants of fmu_src: does a test fail for each?

Half of them are drawn from fmu_src/solver. One that compiles to the same code is drawn again. Those that the
tests let live must stand in survivors.csv, each with the reason why it may.
"""

from __future__ import annotations

import csv
import os
import random
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from dataclasses import dataclass
from pathlib import Path

from frictionlab.build import build_fmu
from frictionlab.check.tokens import Site, line_at, mutated, sites
from frictionlab.check.workshop import ASSERTED, SHIPPED, Workshop
from frictionlab.project import ROOT, UserError

SOURCES = ROOT / "fmu_src"
SURVIVORS = Path(__file__).with_name("survivors.csv")
# What must notice a mutant of the boundary, and of what lies below it; what notices most, and soon, first.
OF_BOUNDARY = ("tests/fmi2",)
OF_CORE = (
    "tests/fmi2/test_steps.py",
    "tests/fmi2/test_time_derivatives.py",
    "tests/solver/test_fixed_step_methods.py",
    "tests/solver/test_step_control.py",
    "tests/solver",
    "tests/physics",
    "tests/fmi2",
)
OPTIONS = ("-q", "-x", "-p", "no:cacheprovider", "--tb=no", "-m", "not slow")
NOT_OF_CODE = ("--deselect", "tests/fmi2/test_mutants.py")
# s; a mutant that hangs is noticed. The tests as they are take a quarter of this where two run at once.
TIME_LIMIT = 600.0
UNIT_TIME_LIMIT = 60.0
SLOWEST_UNIT = "test_elastic_plastic"


@dataclass(frozen=True)
class Survivor:
    """A mutant that may live: its line as it stands, as it becomes, and why no test can or need notice."""

    file: str
    line: str
    replacement: str
    reason: str


@dataclass(frozen=True)
class Verdict:
    site: Site
    number: int  # of the line
    line: str
    replacement: str
    killer: str  # what noticed; "" if nothing did


def survivors() -> list[Survivor]:
    with SURVIVORS.open(newline="") as rows:
        return [Survivor(**row) for row in csv.DictReader(rows)]


def draw(seed: int) -> Iterator[Site]:
    """Mutants without end, in turn from the solver and from the rest."""
    generator = random.Random(seed)
    files = sorted(path.relative_to(SOURCES).as_posix() for path in SOURCES.rglob("*.[ch]"))
    every = [site for file in files for site in sites(file, (SOURCES / file).read_text())]
    solver = [site for site in every if site.file.startswith("solver/")]
    rest = [site for site in every if not site.file.startswith("solver/")]
    drawn: set[Site] = set()
    while len(drawn) < len(every):
        for pool in (solver, rest):
            site = generator.choice(pool)
            if site not in drawn:
                drawn.add(site)
                yield site


def _unit_killer(programs: Sequence[Path]) -> str:
    """The program that fails; the one that takes seconds comes last."""
    for program in sorted(programs, key=lambda program: program.name == SLOWEST_UNIT):
        try:
            done = subprocess.run(
                [str(program)], capture_output=True, check=False, timeout=UNIT_TIME_LIMIT, cwd=program.parent
            )
        except subprocess.TimeoutExpired:
            return f"{program.name} hangs"
        if done.returncode not in (0, 77):
            return program.name
    return ""


def _pytest_killer(fmu: Path, tests: Sequence[str], processes: int = 0) -> str:
    command = [sys.executable, "-m", "pytest", *OPTIONS, *NOT_OF_CODE, *tests, "-n", str(processes)]
    environment = {**os.environ, "FRICTION_FMU": str(fmu)}
    try:
        done = subprocess.run(
            command,
            cwd=ROOT,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
            timeout=TIME_LIMIT,
        )
    except subprocess.TimeoutExpired:
        return "the tests hang"
    if done.returncode == 0:
        return ""
    failed = [line for line in done.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))]
    return failed[0].split(" - ")[0].split(maxsplit=1)[1] if failed else f"pytest ends with {done.returncode}"


def _killer(workshop: Workshop, site: Site) -> str | None:
    """What notices the mutant; "" if nothing does, None if it is the same program or does not compile."""
    text = (SOURCES / site.file).read_text()
    before = workshop.object_code(site.file, SHIPPED)
    try:
        workshop.write(site.file, mutated(text, site), SHIPPED, ASSERTED)
        if workshop.object_code(site.file, SHIPPED) == before:
            return None
        tests = OF_BOUNDARY if site.file.startswith("fmi2/") else OF_CORE
        return _unit_killer(workshop.units()) or _pytest_killer(workshop.fmu(), tests)
    except UserError:
        return None
    finally:
        workshop.write(site.file, text, SHIPPED, ASSERTED)


def _verdict(workshop: Workshop, site: Site) -> Verdict | None:
    killer = _killer(workshop, site)
    if killer is None:
        return None
    text = (SOURCES / site.file).read_text()
    number, line = line_at(text, site.begin)
    return Verdict(site, number, line, line_at(mutated(text, site), site.begin)[1], killer)


def _tried(workshops: Sequence[Workshop], chosen: Iterator[Site], count: int) -> Iterator[Verdict]:
    """Verdicts of count mutants as they come. A workshop that is done takes the next."""
    verdicts = 0
    with ThreadPoolExecutor(len(workshops)) as pool:
        trials = {pool.submit(_verdict, workshop, next(chosen)): workshop for workshop in workshops[:count]}
        while trials:
            for trial in wait(trials, return_when=FIRST_COMPLETED).done:
                workshop = trials.pop(trial)
                if verdict := trial.result():
                    verdicts += 1
                    yield verdict
                if verdicts + len(trials) < count:
                    trials[pool.submit(_verdict, workshop, next(chosen))] = workshop


def _tell(verdict: Verdict, known: bool) -> str:
    what = f"{verdict.site.file}:{verdict.number}  {verdict.line}  ->  {verdict.replacement}"
    fate = verdict.killer or ("lives, as survivors.csv explains" if known else "LIVES")
    print(f"{what}\n    {fate}", flush=True)
    return what


def check_random_mutants(count: int, seed: int) -> list[str]:
    """Tries count mutants and prints each; gives those that live without a reason, one line each."""
    explained = {(known.file, known.line, known.replacement) for known in survivors()}
    built = build_fmu()
    workers = min(os.cpu_count() or 1, 8)
    alive: list[str] = []
    verdicts: list[Verdict] = []
    with tempfile.TemporaryDirectory(prefix="friction-mutants-") as folder:
        first = Workshop(Path(folder) / "0", built)
        first.compile(SHIPPED, ASSERTED)
        workshops = [first, *(first.copy(Path(folder) / str(k)) for k in range(1, workers))]
        if killer := _unit_killer(first.units()) or _pytest_killer(first.fmu(), OF_CORE, workers):
            return [f"the sources as they are: {killer} fails already"]
        for verdict in _tried(workshops, draw(seed), count):
            verdicts.append(verdict)
            known = (verdict.site.file, verdict.line, verdict.replacement) in explained
            what = _tell(verdict, known)
            if not verdict.killer and not known:
                alive.append(what)
    noticed = sum(bool(verdict.killer) for verdict in verdicts)
    print(f"seed {seed}: {noticed} of {len(verdicts)} mutants noticed, {len(alive)} live without a reason")
    return alive
