"""Height statistics against closed forms, the FMU and an independent package."""

from __future__ import annotations

import math

import pandas as pd
import pytest

from frictioncontact.fmu import FrictionFmu
from frictioncontact.gap import area, gaussian, height_integral, load, separation, stiffness
from frictioncontact.parameters import E_FULL, E_REDUCED, Surfaces
from tools.project import ROOT

TABLE_1 = Surfaces()


PACKAGE = pd.read_csv(ROOT / "data" / "gaussian_heights.csv", comment="#").set_index("h")


def test_gaussian_integrals_match_contactmechanics() -> None:
    for h, row in PACKAGE.iterrows():
        for n in ("0", "1", "1.5"):
            # 1e-11: what the package, which integrates in one piece, leaves
            assert height_integral(float(h), float(n)) == pytest.approx(row[f"F_{n}"], abs=1e-11)


@pytest.mark.parametrize("E", [E_FULL, 1e8])
@pytest.mark.parametrize("d", [6e-6, 14e-6])
@pytest.mark.parametrize("surfaces", [TABLE_1, Surfaces(c=0.01, lambda_=0.5, nu=0.0)])
def test_exponential_heights_are_the_fmus(fmu: FrictionFmu, surfaces: Surfaces, d: float, E: float) -> None:
    start = {"contact.c": surfaces.c, "contact.lambda": surfaces.lambda_, "contact.nu": surfaces.nu}
    with fmu.session({"d": d, "E": E, **start}) as session:
        A_r, sigma, F_n = session.read(["A_r", "sigma", "F_n"])
    assert area(surfaces, d, E) == pytest.approx(A_r, rel=1e-11)
    assert stiffness(surfaces, d, E) == pytest.approx(sigma, rel=1e-11)
    assert load(surfaces, d, E) == pytest.approx(F_n, rel=1e-11)


@pytest.mark.parametrize("E", [E_FULL, 1e8, 1.0])
def test_gaussian_area_matches_its_closed_form(E: float) -> None:
    """(s - h) for all heights above h, and (s - h - w) more for those above h + w."""
    h, w = 14 / 6, TABLE_1.critical_interference(E) / TABLE_1.R_q
    first = [gaussian(a) - a * 0.5 * math.erfc(a / math.sqrt(2.0)) for a in (h, h + w)]
    expected = math.pi * TABLE_1.beta * TABLE_1.A_n * sum(first)
    assert area(TABLE_1, 14e-6, E, "gaussian") == pytest.approx(expected, rel=1e-9)


def test_load_of_elastic_gaussian_is_greenwood_williamson() -> None:
    s = TABLE_1
    expected = 4 / 3 * s.eta * s.A_n * E_FULL * math.sqrt(s.R) * s.R_q**1.5 * PACKAGE.loc[2.0, "F_1.5"]
    assert load(s, 2.0 * s.R_q, model="elastic") == pytest.approx(expected, rel=1e-7)


@pytest.mark.parametrize("model", ["exponential", "gaussian", "elastic"])
def test_separation_inverts_load(model: str) -> None:
    for surfaces, wanted in ((TABLE_1, 0.1), (Surfaces(lambda_=0.3), 240.0)):
        d = separation(surfaces, wanted, E_REDUCED, model)
        assert load(surfaces, d, E_REDUCED, model) == pytest.approx(wanted, rel=1e-9)
