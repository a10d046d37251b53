"""Mean friction of the periodic state by `periodic_mean` and sweeps; what docs/physics.md says of it."""

from __future__ import annotations

import numpy as np
import pytest
from physics.closed_forms import coulomb_along

from frictioncontact.batch import simulate_many
from frictioncontact.fmu import FrictionFmu
from frictioncontact.gap import stiffness
from frictioncontact.parameters import SEPARATION, Surfaces
from frictioncontact.periodic import periodic_mean
from tools.project import ROOT
from tools.reference import scene_of, settled

F, F_C = 20e3, 55.0
PAGE = " ".join((ROOT / "docs" / "physics.md").read_text(encoding="utf-8").split())


def constant_stiffness(kappa: float, zeta: float) -> dict[str, float | str]:
    sigma = kappa * 2 * np.pi * F * F_C
    moves = {"V": zeta, "vibration.V_1": 1.0, "solver.tolerance": 1e-11}
    return {"contact.model": "Constant", "contact.sigma": sigma, **moves}


def test_a_moving_separation_asks_for_a_stiffer_contact_than_a_constant_one(fmu: FrictionFmu) -> None:
    """How far the mean lies from Coulomb's over the phase, at two kappa."""
    zeta, V_1 = 0.05, 1.44
    coulomb = F_C * coulomb_along(zeta)
    assert f"Coulomb's mean is {coulomb:.2f} N" in PAGE
    for kappa in (100.0, 3000.0):
        sigma = kappa * 2 * np.pi * F * F_C / V_1
        scene = {
            "V": zeta * V_1,
            "vibration.V_1": V_1,
            "vibration.a_d": 1.1e-6,
            "contact.stiffnessScale": sigma / stiffness(Surfaces(), SEPARATION),
            "vibration.phase_d": np.linspace(0.0, 2 * np.pi, 73),
        }
        means = simulate_many(scene, settled=True, fmu=fmu.path)["F_t_mean"]
        assert means.min() < coulomb < means.max()
        assert f"{means.min():.1f} and {means.max():.1f} N" in PAGE
    assert np.max(np.abs(means - coulomb)) < 0.01 * F_C


def test_how_far_kappa_100_is_from_coulomb_is_what_the_page_says(fmu: FrictionFmu) -> None:
    off = {}
    for zeta in (0.3, 0.9, 0.99):
        values = constant_stiffness(100.0, zeta)
        mean = settled(scene_of(values))[0]
        assert periodic_mean(fmu, values) == pytest.approx(mean, abs=1e-9 * F_C)
        off[zeta] = mean / F_C - coulomb_along(zeta)
    said = f"{off[0.3]:.4f} F_C at ζ = 0.3, by {off[0.9]:.3f} F_C at 0.9 and by {off[0.99]:.3f} F_C at 0.99"
    assert said in PAGE
