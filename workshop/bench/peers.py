"""Solvers that the default is compared with: Radau IIA of orders 5, 9 and 13 that stops at reversals, CVODE
with its defaults, and scipy's Radau.

All solve y = (sigma_ref delta / F_C, integral of F_t dt / F_C) or its equal. CVODE and scipy do not know when
V reverses.
"""

import math
import time
import warnings

import numpy as np
from scipy.integrate import solve_ivp

from workshop.bench.cases import Case
from workshop.bench.driver import Bench, Outcome, failed
from workshop.reference import CHOICES, rest, scene_of

PLAIN_PROGRAMS = {
    "Radau 5": "plain_radau_5",
    "Radau 9": "plain_radau_9",
    "Radau 13": "plain_radau_13",
    "plain CVODE": "plain_cvode",
}


def plain_values(case: Case, tolerance: float) -> dict[str, float]:
    """The equation's few numbers, under the names of bench.PLAIN."""
    scene = scene_of(case.start_values)
    asperities = scene.contact != 1 + CHOICES["contact"].index("Constant")
    return {
        "V": scene.V,
        "d": scene.d,
        "F_C": scene.F_C,
        "sigma": rest(scene)[1],
        "d_ref": scene.d,
        "decay": getattr(scene, "lambda") / scene.R_q if asperities else 0.0,
        "f": scene.f,
        "V_1": scene.V_1,
        "a_d": scene.a_d,
        "phase_d": scene.phase_d,
        "tolerance": tolerance,
    }


def plain(bench: Bench, method: str, case: Case, tolerance: float, budget: float, start: float) -> Outcome:
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


def scipy_radau(case: Case, tolerance: float, most_evaluations: int, start: float) -> Outcome:
    """solve_ivp with Radau over each communication step; started anew only if inputs jump or bend there."""
    equation = Equation(plain_values(case, tolerance), most_evaluations)
    ends = start + case.step * np.arange(1, case.count + 1)
    spans = [(start, ends[-1], ends)] if not case.inputs else [(e - case.step, e, [e]) for e in ends]
    y = np.zeros(2)
    rows = []
    cpu = time.thread_time()
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
                result = solve_ivp(
                    equation.slope, (begin, end), y, "Radau", points, rtol=tolerance, atol=atol
                )
            if not result.success:
                return failed(str(result.message))
            y = result.y[:, -1]
            rows += [
                (equation.stiffness_ratio(t), *column) for t, column in zip(points, result.y.T, strict=True)
            ]
    except TooSlow:
        return failed(f"not finished after {most_evaluations} evaluations")
    cpu = time.thread_time() - cpu
    ratio, scaled, impulse = np.array(rows).T
    F_C = equation.values["F_C"]
    F_mean = F_C * np.diff(impulse, prepend=0.0) / case.step
    per_step = np.array([cpu, equation.evaluations]) / case.count
    return Outcome(F_C * ratio * scaled, F_mean, *map(float, per_step))
