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
from workshop.reference.contact import stiffness
from workshop.reference.start_values import scene_of

PLAIN_PROGRAMS = {
    "Radau 5": "plain_radau_5",
    "Radau 9": "plain_radau_9",
    "Radau 13": "plain_radau_13",
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


def plain(bench: Bench, method: str, case: Case, tolerance: float, budget: float, start: float) -> Outcome:
    """One of PLAIN_PROGRAMS."""
    return bench.run_plain(PLAIN_PROGRAMS[method], case.job(start, budget), plain_values(case, tolerance))


class TooSlow(Exception):
    """The evaluations allowed are spent."""


def scipy_radau(case: Case, tolerance: float, most_evaluations: int, start: float) -> Outcome:
    """solve_ivp with Radau over each communication step; started anew only if inputs jump or bend there."""
    v, rates = plain_values(case, tolerance), {"V": 0.0, "d": 0.0}
    begin, evaluations, y, rows = start, 0, np.zeros(2), []

    def stiffness_ratio(t: float) -> float:
        d = v["d"] + rates["d"] * (t - begin) + v["a_d"] * math.cos(2 * math.pi * v["f"] * t + v["phase_d"])
        softer = (v["d_ref"] / d) ** 3 * math.exp(-2 * v["decay"] * (d - v["d_ref"]))
        return softer if v["decay"] else 1.0

    def slope(t: float, y: np.ndarray) -> tuple[float, float]:
        nonlocal evaluations
        evaluations += 1
        if evaluations > most_evaluations:
            raise TooSlow
        V = v["V"] + rates["V"] * (t - begin) + v["V_1"] * math.cos(2 * math.pi * v["f"] * t)
        ratio = stiffness_ratio(t) * float(y[0])
        return (V - abs(V) * ratio) * v["sigma"] / v["F_C"], ratio

    ends = start + case.step * np.arange(1, case.count + 1)
    spans = [(start, ends[-1], ends)] if not case.inputs else [(e - case.step, e, [e]) for e in ends]
    how = {"rtol": tolerance, "atol": (tolerance, tolerance * case.step)}
    cpu = time.thread_time()
    try:
        for k, (begin, end, points) in enumerate(spans):
            for name, samples in case.inputs.items():
                v[name] = float(samples[k])
                if case.linear:
                    rates[name] = float(samples[k + 1] - samples[k]) / case.step
            with warnings.catch_warnings():  # its numerical Jacobian overflows where the contact is stiff
                warnings.simplefilter("ignore", RuntimeWarning)
                result = solve_ivp(slope, (begin, end), y, "Radau", points, **how)
            if not result.success:
                return failed(str(result.message))
            y = result.y[:, -1]
            rows += [(stiffness_ratio(t), *column) for t, column in zip(points, result.y.T, strict=True)]
    except TooSlow:
        return failed(f"not finished after {most_evaluations} evaluations")
    cpu = time.thread_time() - cpu
    ratio, scaled, impulse = np.array(rows).T
    F_mean = v["F_C"] * np.diff(impulse, prepend=0.0) / case.step
    return Outcome(v["F_C"] * ratio * scaled, F_mean, cpu / case.count, evaluations / case.count)
