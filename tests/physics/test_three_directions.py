"""The numbers of docs/three-directions.md: by formulas, and by the contact of its picture in the FMU."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from physics.closed_forms import coulomb_across, coulomb_along
from scipy.optimize import brentq
from scipy.special import i0

from figures.pages.directions import AMPLITUDE, HEIGHT, mean, scene
from frictioncontact.fmu import FrictionFmu, Value
from frictioncontact.parameters import COULOMB_FORCE
from tools.project import ROOT

TEXT = (ROOT / "docs" / "three-directions.md").read_text(encoding="utf-8")
PAGE = " ".join(TEXT.split())
X = 3.0 * HEIGHT / 6e-6  # lambda a_d / R_q
SLOW = 1e-6  # m/s


def one(fmu: FrictionFmu, V: float, start_values: dict[str, Value]) -> float:
    return float(mean(fmu, start_values, np.array([V]))[0])


def test_a_rigid_contact(fmu: FrictionFmu) -> None:
    """The table, the crossing and the gain in slow sliding."""
    places, *rows = (
        [float(cell) for cell in re.search(rf"^\| {name} \|([ .\d|]+)\|$", TEXT, re.MULTILINE)[1].split("|")]
        for name in ("⟨F_t⟩/F_C at ζ =", "along", "transverse")
    )
    for direction, formula, row in zip(
        ("along", "transverse"), (coulomb_along, coulomb_across), rows, strict=True
    ):
        truth = [formula(zeta) for zeta in places]
        assert row == pytest.approx(truth, abs=5e-4)
        V = AMPLITUDE * np.array(places)
        assert mean(fmu, scene("Coulomb", 3.0, direction), V) == pytest.approx(truth, abs=1e-5)
    assert one(fmu, 0.1, scene("Coulomb", 3.0, "normal")) == pytest.approx(1.0, abs=1e-6)
    crossing = brentq(lambda zeta: coulomb_along(zeta) - coulomb_across(zeta), 0.5, 0.9999)
    assert f"Below ζ = {crossing:.3f}" in PAGE
    assert coulomb_across(1e-4) / coulomb_along(1e-4) == pytest.approx(math.log(4e4), rel=1e-6)


def test_a_contact_that_yields(fmu: FrictionFmu) -> None:
    coulomb, dahl, lugre, elastic = (
        one(fmu, 0.1, scene(law, 3.0, "transverse")) for law in ("Coulomb", "Dahl", "LuGre", "ElasticPlastic")
    )
    assert f"is {coulomb:.2f} F_C in Coulomb, {dahl:.2f} in Dahl and {elastic:.2f} in ElasticPlastic" in PAGE
    assert lugre == pytest.approx(dahl, abs=1e-4)
    for direction, left in (("along", 1.0 - 0.5), ("transverse", math.sqrt(1.0 - 0.5**2))):
        assert one(fmu, SLOW, scene("ElasticPlastic", 0.5, direction)) == pytest.approx(left, abs=1e-4)
        assert f"{left:.3g}" in PAGE
        for law in ("Dahl", "LuGre"):
            assert one(fmu, SLOW, scene(law, 0.5, direction)) < 1e-4


@pytest.mark.parametrize("kappa", [0.5, 3.0])
def test_a_normal_vibration(fmu: FrictionFmu, kappa: float) -> None:
    least = math.exp(-X) / float(i0(X))
    assert f"which is {least:.3f} at 1.1 µm" in PAGE
    for law, ratio in (("Dahl", 1.0), ("ElasticPlastic", 1.0), ("LuGre", 1.5)):
        assert one(fmu, SLOW, scene(law, kappa, "normal")) == pytest.approx(ratio * least, abs=1e-3)
    # sigma V is as fast as the limit F_C e^(-x cos) / I0(x) at its fastest.
    phase = np.linspace(0.0, 2.0 * np.pi, 100_001)
    rate = (X * np.sin(phase) * np.exp(-X * np.cos(phase))).max() / float(i0(X))
    V = rate * AMPLITUDE / kappa
    assert f"{V:.2f} m/s on at κ = {kappa:g}" in PAGE
    elastic = scene("ElasticPlastic", kappa, "normal")
    assert one(fmu, 1.001 * V, elastic) == pytest.approx(1.0, abs=1e-6)
    assert one(fmu, 0.9 * V, elastic) < 0.999


def test_what_the_stiffness_does_under_a_normal_vibration(fmu: FrictionFmu) -> None:
    assert f"{one(fmu, 1.0, scene('Dahl', 3.0, 'normal')):.2f} F_C at 1 m/s" in PAGE
    least = math.exp(-1.0) / float(i0(1.0))  # an amplitude of R_q / 3, and lambda = 3
    assert f"a third of R_q leaves {least:.2f} F_C" in PAGE
    scale = 14.4e6 / 5.743e12
    for law in ("Dahl", "ElasticPlastic"):
        normal = scene(law, 3.0, "normal") | {"contact.stiffnessScale": scale}
        assert one(fmu, 0.01, normal | {"contact.model": "Mindlin"}) == pytest.approx(1.0, abs=1e-5)
        left = one(fmu, SLOW, normal | {"contact.model": "Asperities"})
        assert f"paper's Eq. 3 both laws keep {left:.3f} F_C in slow sliding" in PAGE
        constant = normal | {"friction.limit": "Constant"}
        assert one(fmu, 0.01, constant) == pytest.approx(1.0, abs=1e-6)


def test_yielded_asperities_would_lose_their_load_over_a_small_part_of_the_amplitude(
    fmu: FrictionFmu,
) -> None:
    """Mindlin's normal stiffness is (2 - nu)/(2 (1 - nu)) times his tangential one."""
    nu = 0.33
    with fmu.session({"contact.model": "Mindlin"}) as session:
        retreat = session.get("F_n") / (session.get("sigma") * (2.0 - nu) / (2.0 * (1.0 - nu)))
    assert f"within {1e6 * retreat:.2f} µm of retreat" in PAGE
    assert f"a_d is {1e6 * HEIGHT:.1f} µm" in PAGE


@pytest.mark.parametrize("direction", ["along", "transverse"])
@pytest.mark.parametrize("ratio", [1.0, 1.5])
def test_the_force_at_which_a_vibrated_contact_breaks_away(
    fmu: FrictionFmu, direction: str, ratio: float
) -> None:
    """The formulas of the page: just below them the contact carries its force through every period."""
    kappa = 0.5
    bound = {"along": ratio - kappa, "transverse": math.sqrt(ratio**2 - kappa**2)}[direction]
    start = scene("ElasticPlastic", kappa, direction) | {"friction.staticRatio": ratio}
    deflection = COULOMB_FORCE / float(start["contact.sigma"])
    below = one(fmu, 0.0, start | {"delta_0": 0.999 * bound * deflection})
    above = one(fmu, 0.0, start | {"delta_0": 1.001 * bound * deflection})
    assert below == pytest.approx(0.999 * bound, rel=1e-5)
    assert above < 1.0005 * bound  # it has slipped
    assert "With R > 1 the contact breaks away at R - κ and √(R² - κ²)" in PAGE
