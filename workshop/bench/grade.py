"""How far one method at one setting is from the reference on a case, and what it costs."""

import math
from collections.abc import Callable
from dataclasses import astuple, dataclass

import numpy as np

from frictioncontact.parameters import PERIOD
from workshop.bench.cases import Case
from workshop.bench.driver import Outcome

References = dict[float, tuple[np.ndarray, np.ndarray]]  # start [s]: F and F_mean [N] after each step


@dataclass(frozen=True)
class Point:
    """One method at one setting on one case; errors over F_C, times in s per vibration period."""

    case: str
    method: str
    setting: float  # tolerance, or internal steps per communication step
    error_F: float
    error_mean: float
    cpu: float
    evaluations: float
    failure: str = ""

    @property
    def error(self) -> float:
        return max(self.error_F, self.error_mean)

    def row(self) -> dict[str, object]:
        return dict(zip(COLUMNS, astuple(self), strict=True))


COLUMNS = (  # of a point in a CSV file
    *("case", "method", "setting", "error_F_t", "error_F_t_mean"),
    *("cpu_s_per_period", "evaluations_per_period", "failure"),
)


def grade_point(
    case: Case, references: References, method: str, setting: float, run: Callable[[float], Outcome]
) -> Point:
    """Runs a method from each start for which there is a reference."""
    outcomes = {start: run(start) for start in references}
    for outcome in outcomes.values():
        if outcome.failure:
            return Point(case.name, method, setting, *[math.nan] * 4, outcome.failure)
    error_F, error_mean = 0.0, 0.0
    for start, (F, F_mean) in references.items():
        error_F = max(error_F, float(np.abs(outcomes[start].F - F).max()) / case.F_C)
        error_mean = max(error_mean, float(np.abs(outcomes[start].F_mean - F_mean).max()) / case.F_C)
    scale = PERIOD / case.step
    cpu, evaluations = (
        scale * float(np.median([getattr(outcome, name) for outcome in outcomes.values()]))
        for name in ("cpu", "evaluations")
    )
    return Point(case.name, method, setting, error_F, error_mean, cpu, evaluations)
