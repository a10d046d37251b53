"""Velocity and vibration across the sliding: many periods, and nothing across."""

from __future__ import annotations

import math

import numpy as np
import pytest

from frictioncontact.fmu import FrictionFmu, Value

F, F_C = 20e3, 55.0
LAWS = ("Dahl", "Coulomb", "ElasticPlastic", "LuGre")
FINE: dict[str, Value] = {"solver.tolerance": 1e-8, "contact.model": "Constant", "F_C": F_C, "vibration.f": F}
OBLIQUE: dict[str, Value] = {"V": 0.21, "V_y": -0.34}
OBLIQUE |= {"vibration.V_1": 0.6, "vibration.V_2": 0.9, "vibration.phase_2": 1.1}
NAMES = ("F_t_mean", "F_t", "W_f", "Q_f")
MOVES: dict[str, Value] = {"V": 0.2, "vibration.V_1": 0.6, "vibration.a_d": 4e-7, "vibration.phase_d": 0.8}
MOVES |= {"friction.staticRatio": 1.3, "friction.V_S": 0.2, "contact.stiffnessScale": 4e-7}
MOVES |= {"friction.sigma_1": 3.0, "friction.sigma_2": 5.0}


def course(fmu: FrictionFmu, values: dict[str, Value]) -> np.ndarray:
    """Outputs after steps with a rate of V, a jump of it, and many periods."""
    with fmu.session(FINE | values) as session:
        rows = []
        for change, h in ((300.0, 1e-4), (-2e3, 1.3e-4), (0.0, 3.3e-3)):
            session.set_rates(V=change)
            session.step(h)
            rows.append(session.read(NAMES))
            session.set("V", -0.1)
        return np.array(rows)


@pytest.mark.parametrize("law", LAWS)
def test_a_million_periods_are_settled(fmu: FrictionFmu, law: str) -> None:
    """At little more than the cost of the first ones: ElasticPlastic forgets its direction in some 30."""
    sigma = 3.0 * 2 * math.pi * F * F_C / 0.8
    with fmu.session(FINE | OBLIQUE | {"friction.model": law, "contact.sigma": sigma}) as session:
        session.step(3 / F)
        few = session.get("solver.evaluations")
        session.step(1e6 / F)
        means, settled = (session.read((f"F_t_{end}", f"F_y_{end}")) for end in ("mean", "settled"))
        assert means == pytest.approx(settled, abs=1e-6 * F_C)
        assert session.get("solver.evaluations") - few < 15 * few


@pytest.mark.parametrize("law", LAWS)
def test_nothing_across_is_one_dimension(fmu: FrictionFmu, law: str) -> None:
    """To the bit; the hunt grades hardly anything across."""
    values = MOVES | {"friction.model": law}
    assert (course(fmu, values) == course(fmu, values | {"vibration.phase_2": 1.0})).all()
