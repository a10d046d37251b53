"""Runs jobs of the C drivers in bench/: communication steps through the FMI functions, timed without Python.

A job is a scene with its communication steps; a result is its outputs, cost, or the reason why it failed.

`frictioncontact.batch` does not serve for this: what is timed here are the steps alone, without the
initialization, of one run that is repeated until its median is steady, from a start time and with input
derivatives. Errors are those of the timed run's own outputs, so that no second run is needed for them.
"""

import argparse
import os
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType

import fmpy
import numpy as np
from PIL import Image
from rich.progress import Progress

from frictioncontact.command import add_output, command_line
from frictioncontact.errors import UserError
from frictioncontact.fmu import FrictionFmu, Value
from workshop.build import build_targets
from workshop.project import ROOT

REPORT = ROOT / "build" / "report"
TIME_LIMIT = 120.0  # s of wall time for one job
PLAIN = ("V", "d", "F_C", "sigma", "d_ref", "decay", "f", "V_1", "a_d", "phase_d", "tolerance", "delta_0")


@dataclass(frozen=True)
class Job:
    """count steps of the length step [s] from the time start [s]."""

    start_values: Mapping[str, Value]
    step: float
    count: int = 1
    start: float = 0.0
    inputs: Mapping[str, np.ndarray] = field(default_factory=dict)  # count + 1 samples each
    linear: bool = False  # inputs move linearly between their samples; else held over a step
    budget: float = 0.02  # s of CPU time for repetitions
    calls: bool = False  # steps of the length 0: what the calls of the FMU cost


@dataclass(frozen=True)
class Outcome:
    """What one job gave; F and F_mean [N] at the end of and over each step."""

    F: np.ndarray
    F_mean: np.ndarray
    cpu: float  # s per step
    evaluations: float  # per step
    failure: str = ""
    allocations: int = -1  # in all steps of a run; -1: not counted
    allocations_to_start: int = -1


def failed(reason: str) -> Outcome:
    return Outcome(np.empty(0), np.empty(0), np.nan, np.nan, reason)


class Bench:
    """The built FMU with the programs that drive it."""

    def __init__(self, fmu: FrictionFmu, programs: Path) -> None:
        self.fmu = fmu
        self.programs = programs
        identifier = fmu.description.coSimulation.modelIdentifier
        self.library = fmu.directory / "binaries" / fmpy.platform / f"{identifier}.so"
        if not self.library.is_file():
            raise UserError("the FMU holds no .so for this machine: the benchmarks run on Linux only")

    def run(self, job: Job, count_allocations: bool = False) -> Outcome:
        """The FMU through its FMI functions."""
        numbers = {name: variable.valueReference for name, variable in self.fmu.variables.items()}
        lines = _steps(job)
        for name, value in job.start_values.items():
            variable = self.fmu.variables[name]
            number = self.fmu.known.number(name, value, "job")
            kind, number = ("real", number) if variable.type == "Real" else ("integer", int(number))
            lines.append(f"{kind} {variable.valueReference} {number!r}")
        lines += _inputs(job, numbers)
        lines += [f"output {numbers['F_t']}", f"output {numbers['F_t_mean']}"]
        lines.append(f"evaluations {numbers['solver.evaluations']}")
        resources = (self.fmu.directory / "resources").as_uri()
        preload = {"LD_PRELOAD": str(self.programs / "count_allocations.so")} if count_allocations else {}
        arguments = [self.library, self.fmu.description.guid, resources]
        return self.call("fmu_driver", arguments, lines, job, preload)

    def run_plain(self, program: str, job: Job, values: Mapping[str, float]) -> Outcome:
        """A program of bench/plain_*.c with its arguments; values under the names of PLAIN."""
        lines = _steps(job)
        lines += [f"real {PLAIN.index(name)} {value!r}" for name, value in values.items()]
        lines += _inputs(job, {"V": 0, "d": 1})
        name, *arguments = program.split()
        return self.call(name, arguments, [*lines, "output 0", "output 1"], job)

    def call(
        self,
        program: str,
        arguments: list,
        lines: list[str],
        job: Job,
        environment: Mapping[str, str] = MappingProxyType({}),
    ) -> Outcome:
        if program.startswith("plain_") and not (self.programs / program).is_file():
            return failed("not in this build (built without SUNDIALS)")
        command = [str(self.programs / program), *map(str, arguments)]
        how = {
            "capture_output": True,
            "text": True,
            "timeout": TIME_LIMIT,
            "env": {**os.environ, **environment},
        }
        try:
            done = subprocess.run(command, input="\n".join(lines), check=False, **how)
        except subprocess.TimeoutExpired:
            return failed(f"not finished after {TIME_LIMIT:.0f} s")
        if done.returncode:
            return failed(done.stderr.strip() or f"ended with the code {done.returncode}")
        return _parse(done.stdout, job)


def _steps(job: Job) -> list[str]:
    return [
        f"start {job.start!r}",
        f"step {job.step!r}",
        f"count {job.count}",
        f"budget {job.budget!r}",
        f"calls {int(job.calls)}",
        f"linear {int(job.linear)}",
    ]


def _inputs(job: Job, numbers: Mapping[str, int]) -> list[str]:
    return [
        f"input {numbers[name]} {len(samples)} " + " ".join(repr(float(sample)) for sample in samples)
        for name, samples in job.inputs.items()
    ]


def _parse(text: str, job: Job) -> Outcome:
    numbers: dict[str, float] = {}
    rows = []
    for line in text.splitlines():
        keyword, _, rest = line.partition(" ")
        if keyword == "failed":
            return failed(rest.partition(" ")[2])
        if keyword == "row":
            rows.append([float(word) for word in rest.split()])
        else:
            numbers[keyword] = float(rest)
    F, F_mean = np.array(rows).reshape(-1, 2).T
    costs = (numbers[name] / job.count for name in ("cpu", "evaluations"))
    counted = {name: int(value) for name, value in numbers.items() if name.startswith("allocations")}
    return Outcome(F, F_mean, *costs, **counted)


@contextmanager
def open_bench(progress: Progress) -> Iterator[Bench]:
    """Builds the FMU and the programs."""
    folder = build_targets("default", ["all", "bench"], progress)
    with FrictionFmu(folder / "FrictionContact.fmu") as fmu:
        yield Bench(fmu, folder / "bench")


def bench_options(name: str, description: str) -> argparse.ArgumentParser:
    """The options that all benchmark commands have."""
    parser = command_line(f"scripts/{name}", description)
    parser.add_argument("--quick", action="store_true", help="fewer scenes, methods and repetitions")
    add_output(parser, REPORT)
    parser.add_argument("--docs", action="store_true", help="renew the pictures of docs/numerics.md too")
    return parser


def renew_docs(pictures: Sequence[Path]) -> list[Path]:
    """Puts the PNG pictures, in few colours, where docs/numerics.md shows them."""
    copies = []
    for picture in pictures:
        if picture.suffix == ".png":
            copies.append(ROOT / "docs" / "pictures" / f"numerics-{picture.name}")
            Image.open(picture).convert("RGB").quantize(96).save(copies[-1], optimize=True)
    return copies
