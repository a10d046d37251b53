"""Solvers that the default is compared with: Radau IIA of orders 5, 9 and 13 that stops at reversals of V,
and CVODE with its defaults, which passes over them.

All solve y = (sigma_ref delta / F_C, integral of F_t dt / F_C) or its equal.
"""

from workshop.bench.cases import Case
from workshop.bench.driver import Bench, Outcome
from workshop.reference import CHOICES, rest, scene_of

PLAIN_PROGRAMS = {
    "Radau 5": "plain_radau_5",
    "Radau 9": "plain_radau_9",
    "Radau 13": "plain_radau_13",
    "plain CVODE": "plain_cvode",
}


def plain_values(case: Case, tolerance: float) -> dict[str, float]:
    """The equation's few numbers, in the order of bench/plain_equation.h."""
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
    job, values = case.job(start, budget), plain_values(case, tolerance)
    lines = job.lines({"V": 0, "d": 1})
    lines += [f"real {k} {value!r}" for k, value in enumerate(values.values())]
    return bench.call([PLAIN_PROGRAMS[method]], [*lines, "output 0", "output 1"], job)
