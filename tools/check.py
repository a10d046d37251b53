"""scripts/check: the long runs that look for crashes, leaks, races, hangs and drift.

Each prints its figures and the command behind them. docs/reliability.md says what they found.
"""

import argparse
import os
import random
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

from frictioncontact.command import command_line
from frictioncontact.errors import UserError
from tools.build import build_fmu, build_targets
from tools.project import ROOT

FUZZERS = {"call_sequence": 100, "model_exchange": 160, "state_bytes": 900}  # name: longest input in bytes
# The tests that call the library. Left out: pages in a browser; commands, releases and examples, which build
# or start something of their own; times; and the references, which load no FMU.
OF_LIBRARY = (
    *("tests/fmi2", "tests/solver", "tests/physics", "tests/model_exchange"),
    *("tests/batch", "tests/package", "tests/paper"),
)
MIN_LINES = 95.0  # percent of the lines of fmu_src that the suite executes


class Skipped(Exception):
    """A check can't run here; the text says what is missing."""


@dataclass(frozen=True)
class Extent:
    """How long the runs are."""

    tests: tuple[str, ...]  # of the library; without any, those in C and the fuzzers alone
    fuzz_seconds: int
    soak: tuple[str, str]  # held steps, seconds of vibration
    hunt_minutes: float
    watched: str  # calls
    seed: int = 0  # of the hunts and the watchdog


FULL = Extent(OF_LIBRARY, 3600, ("1e9", "1e5"), 60.0, "1000000")
FEW_TESTS = ("tests/fmi2", "tests/solver", "-m", "not slow")
QUICK = Extent(FEW_TESTS, 60, ("1e7", "1e3"), 1.0, "100000")
CI = Extent((), 3, ("1e6", "1e2"), 0.2, "20000")
FUZZ_RUNS = 10_000_000  # at the most
CORES = os.cpu_count() or 1


def _run(command: list[str], environment: Mapping[str, str] | None = None) -> None:
    """Runs a command in the project's root with its output shown; raises UserError if it fails."""
    if environment:
        print(" ".join(f"{name}={value}" for name, value in environment.items()))
    print("$ " + " ".join(command), flush=True)
    done = subprocess.run(command, cwd=ROOT, env={**os.environ, **(environment or {})}, check=False)
    if done.returncode:
        raise UserError(f"{Path(command[0]).name} ended with {done.returncode}")


def _test(fmu: Path, tests: tuple[str, ...], environment: Mapping[str, str] | None = None) -> None:
    # A worker that dies ends the run: with new ones in its place, pytest-xdist may wait without end.
    parallel = ("-n", "logical", "--maxprocesses", "8", "--dist", "loadfile", "--max-worker-restart", "0")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *parallel, *tests]
    _run(command, {"FRICTION_FMU": str(fmu), **(environment or {})})


def _runtimes(*names: str) -> str:
    """The sanitizer runtimes, to be loaded before Python, which was built without."""
    compiler, paths = os.environ.get("CC", "cc"), []
    for name in names:
        paths.append(
            subprocess.check_output([*compiler.split(), f"-print-file-name={name}"], text=True).strip()
        )
        if not Path(paths[-1]).is_absolute():
            raise Skipped(f"{compiler} has no {name} (with gcc it comes along)")
    return " ".join(paths)


def check_sanitize(extent: Extent) -> None:
    """The library's tests and the C unit tests with AddressSanitizer and UndefinedBehaviorSanitizer."""
    folder = build_targets("asan", ["unit_tests"])
    ctest = str(Path(sys.executable).with_name("ctest"))
    _run([ctest, "--test-dir", str(folder), "--output-on-failure", "--parallel", str(CORES)])
    if not extent.tests:
        return
    environment = {
        "LD_PRELOAD": _runtimes("libasan.so", "libubsan.so"),
        "ASAN_OPTIONS": "detect_leaks=0:halt_on_error=1:allocator_may_return_null=1",  # Python itself leaks
        "UBSAN_OPTIONS": "halt_on_error=1:print_stacktrace=1",
    }
    # CasADi loads its plugins in a way that sanitizers refuse (RTLD_DEEPBIND).
    _test(build_fmu("asan"), (*extent.tests, "-k", "not casadi"), environment)


def check_threads(extent: Extent) -> None:
    """The threaded test on a library built with ThreadSanitizer."""
    environment = {"LD_PRELOAD": _runtimes("libtsan.so"), "TSAN_OPTIONS": "halt_on_error=1"}
    _test(build_fmu("tsan"), ("tests/fmi2/test_instances.py",), environment)


def check_fuzz(extent: Extent) -> None:
    """libFuzzer on call sequences and on state bytes, with the same sanitizers."""
    _fuzz("fuzz", extent)


def check_fuzz_many(extent: Extent) -> None:
    """libFuzzer without sanitizers: some 5000 executions a second, of which 1e7 are asked for."""
    _fuzz("fuzz-fast", extent)


def _fuzz(preset: str, extent: Extent) -> None:
    clang = os.environ.get("CC") or shutil.which("clang") or shutil.which("clang-14")
    if clang is None or "clang" not in clang:
        raise Skipped("clang is missing (Debian: apt-get install clang libclang-rt-14-dev)")
    fuzzers = [f"fuzz_{name}" for name in FUZZERS]
    folder = build_targets(preset, fuzzers, environment={**os.environ, "CC": clang})
    for name, longest in FUZZERS.items():
        found = folder / f"corpus-{name}"
        found.mkdir(exist_ok=True)
        length = f"-max_len={longest} -max_total_time={extent.fuzz_seconds} -runs={FUZZ_RUNS}"
        options = f"{length} -timeout=30 -print_final_stats=1 -verbosity=0 -print_funcs=0".split()
        options += [f"-artifact_prefix={folder}/{name}-", str(found), f"tests/fuzz/corpus/{name}"]
        _run([str(folder / f"fuzz_{name}"), *options])


def check_soak(extent: Extent) -> None:
    """Very many steps: the work does not drift from the cycle identity."""
    folder = build_targets("default", ["soak"])
    _run([str(folder / "soak"), *extent.soak])


def check_watchdog(extent: Extent) -> None:
    """Scenes of any numbers: every call returns. Usual scenes: no floating-point exception, either."""
    folder = build_targets("default", ["watchdog"])
    for numbers in ([], ["--ordinary"]):
        _run([str(folder / "watchdog"), extent.watched, str(extent.seed), *numbers])


def _hunt(extent: Extent, *words: object) -> None:
    """Hunts in the plane and along a line at the same time; raises UserError if one finds a miss."""
    program = str(build_targets("default", ["hunt"]) / "hunt/hunt")
    commands = [[program, "--seed", str(extent.seed), *map(str, words), *kind] for kind in ([], ["--plane"])]
    with ThreadPoolExecutor() as pool:
        list(pool.map(_run, commands))


def check_hunt(extent: Extent) -> None:
    """Random scenes against the references of hunt/, along and in the plane: none is beyond the tolerance."""
    _hunt(extent, "--minutes", extent.hunt_minutes / 2, "--minimize", 2)


def check_climb(extent: Extent) -> None:
    """The same, of scenes that are changed while their error grows."""
    _hunt(extent, "--climb", 30 * extent.hunt_minutes, "--minimize", 2)


def check_leaks(extent: Extent) -> None:
    """valgrind on the fuzzers' seeds and a short soak: no leak, no invalid access, no undefined value."""
    if not shutil.which("valgrind"):
        raise Skipped("valgrind is missing (Debian: apt-get install valgrind)")
    folder = build_targets("debug", ["soak", *(f"replay_{name}" for name in FUZZERS)])
    valgrind = "valgrind --quiet --leak-check=full --show-leak-kinds=all --error-exitcode=1".split()
    for name in FUZZERS:
        seeds = sorted(str(seed.relative_to(ROOT)) for seed in (ROOT / "tests/fuzz/corpus" / name).iterdir())
        _run([*valgrind, str(folder / f"replay_{name}"), *seeds])
    _run([*valgrind, str(folder / "soak"), "1e5", "1"])


def check_coverage(extent: Extent) -> None:
    """Lines and branches of fmu_src that the tests execute."""
    fmu = build_fmu("coverage")
    for counts in fmu.parent.rglob("*.gcda"):
        counts.unlink()
    _test(fmu, extent.tests)
    gcov_bug = "--gcov-ignore-parse-errors=negative_hits.warn_once_per_file"
    gcovr = [sys.executable, "-m", "gcovr", gcov_bug, "--root", ".", "--filter", "fmu_src/", str(fmu.parent)]
    _run([*gcovr, "--print-summary", "--fail-under-line", str(MIN_LINES)])


def check_analysis(extent: Extent) -> None:
    """clang's analyzer on many more paths than scripts/lint follows."""
    _run(["scripts/lint", "--deep"])


CHECKS: dict[str, Callable[[Extent], None]] = {
    check.__name__.removeprefix("check_").replace("_", "-"): check
    for check in (
        *(
            check_sanitize,
            check_threads,
            check_fuzz,
            check_fuzz_many,
            check_soak,
            check_hunt,
            check_climb,
        ),
        *(check_watchdog, check_leaks, check_coverage, check_analysis),
    )
}
IN_CI = ("sanitize", "leaks", "fuzz")


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    what = "\n".join(f"  {name:14} {check.__doc__}" for name, check in CHECKS.items())
    description = "The long runs: crashes, leaks, races, hangs, drift."
    parser = command_line("scripts/check", description, f"checks:\n{what}")
    add = parser.add_argument
    add("checks", nargs="*", metavar="CHECK", help="which ones; all when none is named")
    add("--quick", action="store_true", help="shorter runs, in minutes")
    add("--ci", action="store_true", help="sanitizers, valgrind and fuzzers in under four minutes")
    add("--minutes", type=float, help="of the hunt")
    add("--seed", type=int, help="of the hunts and the watchdog; drawn anew when not given")
    options = parser.parse_args(argv)
    for name in options.checks:
        if name not in CHECKS:
            parser.error(f"unknown check {name}; there are: {', '.join(CHECKS)}")
    return options


def run(options: argparse.Namespace) -> None:
    extent = CI if options.ci else QUICK if options.quick else FULL
    seed = random.randrange(10**6) if options.seed is None else options.seed
    extent = replace(extent, seed=seed, hunt_minutes=options.minutes or extent.hunt_minutes)
    failed = []
    for name in options.checks or (IN_CI if options.ci else CHECKS):
        print(f"\n== {name}: {CHECKS[name].__doc__}", flush=True)
        begin = time.monotonic()
        try:
            CHECKS[name](extent)
            result = "nothing found"
        except Skipped as reason:
            result = f"skipped: {reason}"
        except UserError as error:
            result = f"FAILED: {error}"
            failed.append(name)
        print(f"== {name}: {result} ({time.monotonic() - begin:.0f} s)", flush=True)
    if failed:
        raise UserError(f"{', '.join(failed)} failed")
