"""Height statistics against closed forms, the FMU and an independent package."""

from __future__ import annotations

import csv
import math
from itertools import product
from pathlib import Path

import pytest
from misprints import closed_form_area

from frictioncontact.errors import UserError
from frictioncontact.fmu import FrictionFmu
from frictioncontact.gap import (
    area,
    gaussian,
    height_integral,
    load,
    separation,
    stiffness,
)
from frictioncontact.parameters import E_FULL, E_REDUCED, Surfaces

DATA = Path(__file__).resolve().parents[2] / "data"
TABLE_1 = Surfaces()


def package_rows() -> list[dict[str, str]]:
    with (DATA / "gaussian_heights.csv").open() as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def test_gaussian_integrals_match_contactmechanics() -> None:
    for row, n in product(package_rows(), ("0", "1", "1.5")):
        # 1e-11: what the package, which integrates in one piece, leaves
        assert height_integral(float(row["h"]), float(n)) == pytest.approx(float(row[f"F_{n}"]), abs=1e-11)


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
    assert closed_form_area(surfaces, d, E) == pytest.approx(A_r, rel=1e-13)


@pytest.mark.parametrize("E", [E_FULL, 1e8, 1.0])
def test_gaussian_area_matches_its_closed_form(E: float) -> None:
    """(s - h) for all heights above h, and (s - h - w) more for those above h + w."""
    h, w = 14 / 6, TABLE_1.critical_interference(E) / TABLE_1.R_q
    first = [gaussian(a) - a * 0.5 * math.erfc(a / math.sqrt(2.0)) for a in (h, h + w)]
    expected = math.pi * TABLE_1.beta * TABLE_1.A_n * sum(first)
    assert area(TABLE_1, 14e-6, E, "gaussian") == pytest.approx(expected, rel=1e-9)


def test_soft_gaussian_heights_stay_elastic() -> None:
    assert load(TABLE_1, 14e-6, 2e6, "gaussian") == load(TABLE_1, 14e-6, 2e6, "elastic") > 0.5


def test_elastic_asperities_alone_touch_on_half_the_area() -> None:
    """Nearly all yield at 14 um (Eq. 8 against Eq. 15)."""
    areas = [area(TABLE_1, 14e-6, model=model) for model in ("elastic", "gaussian")]
    assert areas[0] / areas[1] == pytest.approx(0.5, abs=1e-3)


def test_load_of_elastic_gaussian_is_greenwood_williamson() -> None:
    row = next(row for row in package_rows() if row["h"] == "2.0")
    s = TABLE_1
    expected = 4 / 3 * s.eta * s.A_n * E_FULL * math.sqrt(s.R) * s.R_q**1.5 * float(row["F_1.5"])
    assert load(s, 2.0 * s.R_q, model="elastic") == pytest.approx(expected, rel=1e-7)


def test_load_of_exponential_heights_in_closed_form() -> None:
    """Plastic part by hand; the elastic part lies within its bounds over (0, omega_c)."""
    s, d = TABLE_1, 14e-6
    x = s.lambda_ * s.critical_interference(E_FULL) / s.R_q
    front = s.eta * s.A_n * s.c * math.exp(-s.lambda_ * d / s.R_q)
    plastic = front * math.pi * s.R * s.R_q * s.yield_pressure * (2.0 + x) * math.exp(-x) / s.lambda_**2
    hertz = front * 4 / 3 * E_FULL * math.sqrt(s.R) * s.R_q**1.5 * (x / s.lambda_) ** 2.5 / 2.5
    assert plastic + hertz * math.exp(-x) <= load(s, d) <= plastic + hertz
    assert hertz < 1e-4 * plastic


@pytest.mark.parametrize("model", ["exponential", "gaussian", "elastic"])
def test_separation_inverts_load(model: str) -> None:
    for surfaces, wanted in ((TABLE_1, 0.1), (Surfaces(lambda_=0.3), 240.0)):
        d = separation(surfaces, wanted, E_REDUCED, model)
        assert load(surfaces, d, E_REDUCED, model) == pytest.approx(wanted, rel=1e-9)


def test_impossible_load_names_its_bound() -> None:
    with pytest.raises(UserError, match=r"load = 1e\+12 N is out of reach.*3\.41"):
        separation(TABLE_1, 1e12)
