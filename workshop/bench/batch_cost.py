"""What a scenario costs in a batch and in a sweep, against the bare C loop over the same FMI calls.

All take turns in one run, and the medians of the turns are printed; the machine should be idle.
The cost of a sweep is that of all its processes: what N scenarios more take, so that starting them does not
count.
"""

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from frictioncontact.batch import simulate_many
from frictioncontact.command import finish
from frictioncontact.errors import UserError
from frictioncontact.fmu import FrictionFmu
from frictioncontact.sweeps.workers import OUTPUTS
from workshop.build import build_fmu
from workshop.project import ROOT

SAMPLED = ("F_t_mean", "F_t", "sigma", "A_r")
AROUND = ("W_f", "solver.evaluations")
RANGES = {"V": (0.005, 0.5), "vibration.V_1": (0.1, 1.5), "d": (12e-6, 17e-6)}
SHORT = 10  # times as many scenarios where only the mean is asked: starts vary by tenths of a second
TURNS = 3


def scenarios(count: int) -> dict[str, np.ndarray]:
    random = np.random.default_rng(1)
    return {name: random.uniform(*ends, count) for name, ends in RANGES.items()}


def bare_input(fmu: FrictionFmu, count: int) -> str:
    """What the bare loop reads: the variables' numbers, then a line a scenario."""
    reference = {name: variable.valueReference for name, variable in fmu.variables.items()}
    values = scenarios(count)
    numbers = [reference["vibration.f"], reference["initialState"]]
    for names in (tuple(values), SAMPLED, AROUND):
        numbers += [len(names), *(reference[name] for name in names)]
    rows = "\n".join(" ".join(map(repr, row)) for row in np.column_stack(list(values.values())).tolist())
    return " ".join(map(str, [*numbers, count])) + "\n" + rows


def bare_loop(fmu: FrictionFmu, program: Path, text: str, count: int, samples: int) -> tuple[float, float]:
    """Processor time [s] per scenario, and the mean force [N] over all."""
    description = fmu.description
    library = next((fmu.directory / "binaries").glob(f"*/{description.coSimulation.modelIdentifier}.so"))
    done = subprocess.run(
        [program, library, description.guid, str(samples)],
        input=text,
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    if done.returncode:
        raise UserError(f"{program}: {done.stderr.strip()}")
    seconds, force, *_ = map(float, done.stdout.split())
    return seconds / count, force


def one_batch(fmu: Path, count: int, samples: int) -> tuple[float, float]:
    """The same of one call of simulate_many on one thread."""
    began = time.process_time()
    outputs = OUTPUTS | {"F_mean": ("F_t_mean", "mean"), "reduction": "F_C"}  # as the bare loop reads
    results = simulate_many(scenarios(count), outputs, samples=samples, threads=1, fmu=fmu)
    return (time.process_time() - began) / count, float(np.mean(results["F_mean"]))


def sessions(fmu: FrictionFmu, count: int, samples: int) -> float:
    """The same of one session in Python for each scenario."""
    values = scenarios(count)
    began = time.process_time()
    for row in range(count):
        start = {name: column[row] for name, column in values.items()}
        with fmu.session({**start, "initialState": "Settled"}) as session:
            period = 1.0 / session.get("vibration.f")
            session.read(AROUND)
            for _ in range(samples):
                session.step(period / samples)
                session.read(SAMPLED)
            session.read(AROUND)
    return (time.process_time() - began) / count


def sweep(fmu: Path, count: int, samples: int) -> float:
    """Processor time [s] of scripts/sweep with one worker, of all its processes."""
    with tempfile.TemporaryDirectory() as folder:
        arguments = ["--random", count, "--samples", samples, "--workers", 1]
        for name, (low, high) in RANGES.items():
            arguments += ["--vary", f"{name}={low}:{high}"]
        command = [sys.executable, "-m", "frictioncontact", "sweep", "--fmu", fmu, "--output", folder]
        process = subprocess.Popen([*map(str, command), *map(str, arguments)], stdout=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        if status:
            raise UserError("the sweep failed: see above")
    return usage.ru_utime + usage.ru_stime


BARE = "bare C loop"


def turn(fmu: FrictionFmu, program: Path, count: int, samples: int) -> dict[str, float]:
    """Processor time [s] per scenario, each way."""
    bare, force = bare_loop(fmu, program, bare_input(fmu, count), count, samples)
    batch, batch_force = one_batch(fmu.path, count, samples)
    if not np.isclose(force, batch_force, rtol=1e-12):
        raise UserError(f"the bare loop gives {force!r} N, the batch {batch_force!r} N")
    few, many = (sweep(fmu.path, n, samples) for n in (count, 4 * count))
    return {
        BARE: bare,
        "simulate_many": batch,
        "scripts/sweep, all processes": (many - few) / (3 * count),
        "one session each in Python": sessions(fmu, max(1, count // 100), samples),
    }


def measure(fmu_path: Path, program: Path, count: int, turns: int) -> None:
    print(f"{'processor time per scenario':40}{'us':>9}{'ratio':>8}")
    with FrictionFmu(fmu_path) as fmu:
        for samples in (64, 1):
            words, n = (f"{samples} samples", count) if samples > 1 else ("mean only", SHORT * count)
            taken = [turn(fmu, program, n, samples) for _ in range(turns)]
            for name in taken[0]:
                cost = statistics.median(costs[name] for costs in taken)
                ratio = statistics.median(costs[name] / costs[BARE] for costs in taken)
                print(f"{words + ', ' + name:40}{1e6 * cost:9.1f}{ratio:8.2f}")


def main(argv: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(prog="bench/batch-cost", description=__doc__.splitlines()[0])
    parser.add_argument(
        "--scenarios",
        type=int,
        default=30_000,
        help=f"of each measurement (30000); {SHORT} times that for the mean only",
    )
    parser.add_argument("--quick", action="store_true", help="one turn of 10000")
    finish(run, parser.parse_args(argv))


def run(options: argparse.Namespace) -> None:
    count = 10_000 if options.quick else options.scenarios
    if count < 100:
        raise UserError(f"--scenarios {count}: must be at least 100")
    fmu = build_fmu()
    command = [sys.executable, "-m", "cmake", "--build", str(ROOT / "build"), "--target", "bare_loop"]
    try:
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    except subprocess.CalledProcessError as error:
        raise UserError(str(error)) from None
    measure(fmu, ROOT / "build" / "bench" / "bare_loop", count, 1 if options.quick else TURNS)
