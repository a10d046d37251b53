"""Deep in presliding the bristle gives back nearly all it takes: what it keeps must not drown in the rest.

V = V_1 cos, sigma X << F_C with the path's amplitude X = V_1 / omega. The deflection follows the path, so a
period dissipates the integral of (sigma x)^2 |dx| / F_C = (4/3) sigma^2 X^3 / F_C, which is its work too: at
the ends of a period the bristle is relaxed. The next terms are smaller by (sigma X / F_C)^2.
"""

from __future__ import annotations

from itertools import pairwise
from math import pi

import pytest

from frictioncontact.fmu import FrictionFmu

F, V_1 = 20e3, 1e-4
X = V_1 / (2.0 * pi * F)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-9])
@pytest.mark.parametrize(("sigma", "F_C"), [(1e6, 55.0), (1e4, 1e4)])
def test_work_and_heat_of_every_period(fmu: FrictionFmu, sigma: float, F_C: float, tolerance: float) -> None:
    start = {"V": 0.0, "vibration.V_1": V_1, "F_C": F_C, "solver.tolerance": tolerance}
    start |= {"contact.model": "Constant", "contact.sigma": sigma}
    expected = 4.0 / 3.0 * sigma**2 * X**3 / F_C
    swing = 0.5 * sigma * X**2  # J, stored and given back; the sum of the work is rounded like it
    rel = 0.01  # the tolerance is F_C's, and would allow all of it
    with fmu.session(start) as session:
        sums = [(0.0, 0.0)]
        for _ in range(4):
            session.step(1.0 / F)
            sums.append(tuple(session.read(("W_f", "Q_f"))))
    for (work, heat), (work_after, heat_after) in pairwise(sums):
        assert heat_after - heat == pytest.approx(expected, rel=rel)
        assert work_after - work == pytest.approx(expected, rel=rel, abs=1e-14 * swing)
