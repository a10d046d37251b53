"""Solvers that the default is compared with: Radau IIA and ARKODE that stop at reversals, CVODE with its
defaults, scipy, an FMU made with PythonFMU.

All solve y = (sigma_ref delta / F_C, integral of F_t dt / F_C) or its equal. Those in Python and CVODE do not
know where V reverses.
"""

from __future__ import annotations

import math
import subprocess
import sys
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave
from scipy.integrate import solve_ivp

from frictioncontact.errors import UserError
from workshop.bench.cases import Case
from workshop.bench.driver import Bench, Outcome, failed
from workshop.project import ROOT
from workshop.reference.solution import stiffness
from workshop.reference.start_values import scene_of

SCIPY = ("Radau", "BDF", "LSODA")
PLAIN_PROGRAMS = {
    "Radau IIA": "plain_radau",
    "ARKODE implicit": "plain_arkode implicit",
    "ARKODE explicit": "plain_arkode explicit",
    "plain CVODE": "plain_cvode",
}


def plain_values(case: Case, tolerance: float) -> dict[str, float]:
    """The equation's few numbers, under the names of bench.PLAIN."""
    scene = scene_of(case.start_values)
    contact = scene.contact
    asperities = contact.model != "Constant"
    return {
        "V": scene.V,
        "d": scene.d,
        "F_C": scene.F_C,
        "sigma": float(stiffness(contact, scene.d, scene.E)),
        "d_ref": scene.d,
        "decay": contact.lambda_ / contact.R_q if asperities else 0.0,
        "f": scene.f,
        "V_1": scene.V_1,
        "a_d": scene.a_d,
        "phase_d": scene.phase_d,
        "tolerance": tolerance,
    }


def plain(bench: Bench, method: str, case: Case, start: float, tolerance: float, budget: float) -> Outcome:
    """One of PLAIN_PROGRAMS."""
    return bench.run_plain(PLAIN_PROGRAMS[method], case.job(start, budget), plain_values(case, tolerance))


class TooSlow(Exception):
    """The evaluations allowed are spent."""


class Equation:
    """Eq. 1, 2 in plain Python numbers over one communication step."""

    def __init__(self, values: dict[str, float], most_evaluations: int) -> None:
        self.values = values
        self.rates = {"V": 0.0, "d": 0.0}
        self.begin = 0.0
        self.evaluations = 0
        self.most_evaluations = most_evaluations

    def stiffness_ratio(self, t: float) -> float:
        v = self.values
        if v["decay"] == 0.0:
            return 1.0
        d = v["d"] + self.rates["d"] * (t - self.begin)
        d += v["a_d"] * math.cos(2 * math.pi * v["f"] * t + v["phase_d"])
        return (v["d_ref"] / d) ** 3 * math.exp(-2 * v["decay"] * (d - v["d_ref"]))

    def slope(self, t: float, y: np.ndarray) -> tuple[float, float]:
        self.evaluations += 1
        if self.evaluations > self.most_evaluations:
            raise TooSlow
        v = self.values
        V = v["V"] + self.rates["V"] * (t - self.begin) + v["V_1"] * math.cos(2 * math.pi * v["f"] * t)
        ratio = self.stiffness_ratio(t) * float(y[0])
        return (V - abs(V) * ratio) * v["sigma"] / v["F_C"], ratio


def scipy_solver(case: Case, start: float, method: str, tolerance: float, most_evaluations: int) -> Outcome:
    """solve_ivp over each communication step; started anew there only where inputs jump or bend."""
    equation = Equation(plain_values(case, tolerance), most_evaluations)
    ends = start + case.step * np.arange(1, case.count + 1)
    spans = [(start, ends[-1], ends)] if not case.inputs else [(e - case.step, e, [e]) for e in ends]
    y = np.zeros(2)
    rows = []
    cpu, wall = time.thread_time(), time.perf_counter()
    try:
        for k, (begin, end, points) in enumerate(spans):
            equation.begin = begin
            for name, samples in case.inputs.items():
                equation.values[name] = float(samples[k])
                if case.linear:
                    equation.rates[name] = float(samples[k + 1] - samples[k]) / case.step
            atol = (tolerance, tolerance * case.step)
            with warnings.catch_warnings():  # its numerical Jacobian overflows where the contact is stiff
                warnings.simplefilter("ignore", RuntimeWarning)
                result = solve_ivp(equation.slope, (begin, end), y, method, points, rtol=tolerance, atol=atol)
            if not result.success:
                return failed(str(result.message))
            y = result.y[:, -1]
            rows += [
                (equation.stiffness_ratio(t), *column) for t, column in zip(points, result.y.T, strict=True)
            ]
    except TooSlow:
        return failed(f"not finished after {most_evaluations} evaluations")
    wall, cpu = time.perf_counter() - wall, time.thread_time() - cpu
    ratio, scaled, impulse = np.array(rows).T
    F_C = equation.values["F_C"]
    F_mean = F_C * np.diff(impulse, prepend=0.0) / case.step
    per_step = np.array([wall, cpu, equation.evaluations]) / case.count
    return Outcome(F_C * ratio * scaled, F_mean, *map(float, per_step))


class PythonFmu:
    """bench/python_fmu.py, built with PythonFMU and unpacked."""

    def __init__(self, folder: Path) -> None:
        command = [sys.executable, "-m", "pythonfmu", "build", "-f", str(ROOT / "bench" / "python_fmu.py")]
        done = subprocess.run([*command, "-d", str(folder)], capture_output=True, text=True, check=False)
        if done.returncode:
            raise UserError(f"PythonFMU can't build bench/python_fmu.py: {done.stderr[-1000:]}")
        self.directory = extract(str(folder / "PythonFriction.fmu"), unzipdir=str(folder / "unzipped"))
        self.description = read_model_description(self.directory, validate=False)
        self.numbers = {v.name: v.valueReference for v in self.description.modelVariables}

    def run(self, case: Case, start: float, tolerance: float) -> Outcome:
        if case.linear:
            return failed("has no input derivatives")
        slave = FMU2Slave(
            guid=self.description.guid,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            unzipDirectory=self.directory,
            instanceName="python",
        )
        slave.instantiate()
        try:
            slave.setupExperiment(startTime=start)
            for name, value in plain_values(case, tolerance).items():
                slave.setReal([self.numbers[name]], [value])
            slave.enterInitializationMode()
            slave.exitInitializationMode()
            return self._steps(case, start, slave)
        except FMICallException:
            return failed("LSODA failed in do_step")
        finally:
            slave.terminate()
            slave.freeInstance()

    def _steps(self, case: Case, start: float, slave: FMU2Slave) -> Outcome:
        outputs = [self.numbers["F_t"], self.numbers["F_t_mean"]]
        rows = []
        cpu, wall = time.thread_time(), time.perf_counter()
        for k in range(case.count):
            for name, samples in case.inputs.items():
                slave.setReal([self.numbers[name]], [float(samples[k])])
            slave.doStep(start + k * case.step, case.step)
            rows.append(slave.getReal(outputs))
        wall, cpu = time.perf_counter() - wall, time.thread_time() - cpu
        F, F_mean = np.array(rows).T
        evaluations = slave.getReal([self.numbers["evaluations"]])[0]
        return Outcome(F, F_mean, wall / case.count, cpu / case.count, evaluations / case.count)


@contextmanager
def python_fmu() -> Iterator[PythonFmu]:
    with TemporaryDirectory(prefix="friction-python-fmu-") as folder:
        yield PythonFmu(Path(folder))
