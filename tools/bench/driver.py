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

import numpy as np
from PIL import Image
from rich.progress import Progress

from frictioncontact.command import add_output, command_line
from frictioncontact.fmu import FrictionFmu, Value
from tools.build import build_targets
from tools.project import ROOT

REPORT = ROOT / "build" / "report"
TIME_LIMIT = 120.0  # s of wall time for one job


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
    instances: int = 1  # that take turns, each with all of the steps

    def lines(self, references: Mapping[str, int]) -> list[str]:
        """For bench/job.h, without start values and outputs; references of the inputs."""
        steps = f"start {self.start!r} step {self.step!r} count {self.count} budget {self.budget!r}"
        return [
            f"{steps} calls {int(self.calls)} linear {int(self.linear)} instances {self.instances}",
            *(
                f"input {references[name]} {len(samples)} {' '.join(map(str, samples.tolist()))}"
                for name, samples in self.inputs.items()
            ),
        ]


@dataclass(frozen=True)
class Outcome:
    """What one job gave; F and F_mean [N] at the end of and over each step."""

    F: np.ndarray
    F_mean: np.ndarray
    cpu: float  # s per step and instance
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
        self.library = fmu.library

    def run(self, job: Job, count_allocations: bool = False, under: Sequence[str] = ()) -> Outcome:
        """The FMU through its FMI functions. under: the words of a program that runs the driver."""
        references = {name: variable.valueReference for name, variable in self.fmu.variables.items()}
        lines = job.lines(references)
        for name, value in job.start_values.items():
            number = self.fmu.known.number(name, value, "job")
            is_real = self.fmu.variables[name].type == "Real"
            lines.append(f"{'real' if is_real else 'integer'} {references[name]} {number!r}")
        lines += [f"output {references['F_t']}", f"output {references['F_t_mean']}"]
        lines.append(f"evaluations {references['solver.evaluations']}")
        resources = (self.fmu.directory / "resources").as_uri()
        preload = {"LD_PRELOAD": str(self.programs / "count_allocations.so")} if count_allocations else {}
        program = ["fmu_driver", str(self.library), self.fmu.description.guid, resources]
        return self.call(program, lines, job, preload, under)

    def call(
        self,
        program: list[str],
        lines: list[str],
        job: Job,
        environment: Mapping[str, str] | None = None,
        under: Sequence[str] = (),
    ) -> Outcome:
        """A program of bench/ with its arguments, and the lines of the job."""
        path = self.programs / program[0]
        if not path.is_file():
            return failed("not in this build (built without SUNDIALS)")
        how = {"input": "\n".join(lines), "capture_output": True, "text": True, "timeout": TIME_LIMIT}
        how["env"] = {**os.environ, **(environment or {})}
        try:
            done = subprocess.run([*under, path, *program[1:]], check=False, **how)
        except subprocess.TimeoutExpired:
            return failed(f"not finished after {TIME_LIMIT:.0f} s")
        if done.returncode:
            return failed(done.stderr.strip() or f"ended with the code {done.returncode}")
        return _parse(done.stdout, job)


def _parse(text: str, job: Job) -> Outcome:
    words = [line.split(maxsplit=1) for line in text.splitlines()]
    if words[0][0] == "failed":
        return failed(words[0][1].partition(" ")[2])
    numbers = {keyword: float(rest) for keyword, rest in words if keyword != "row"}
    rows = [rest.split() for keyword, rest in words if keyword == "row"]
    F, F_mean = np.array(rows, float).reshape(-1, 2).T
    costs = (numbers["cpu"] / job.count / job.instances, numbers["evaluations"] / job.count)
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
