"""Each entry of docs/errata.md, computed; and that the number stands there."""

from __future__ import annotations

import math
from functools import partial
from itertools import product

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar
from scipy.special import i0

from figures.report.paper import force_eq_25, mean_change
from figures.report.regimes import coulomb_limit, scene, soft_limit
from frictioncontact.fmu import FrictionFmu
from frictioncontact.gap import area, load, stiffness
from frictioncontact.identification.api import fitted
from frictioncontact.identification.command import EXAMPLE
from frictioncontact.identification.data import read
from frictioncontact.identification.experiment import Rows, parameter
from frictioncontact.parameters import (
    COULOMB_FORCE,
    E_FULL,
    E_REDUCED,
    FREQUENCY,
    IDENTIFIED,
    PERIOD,
    PRINTED,
    SEPARATION,
    STIFFNESS_PRINTED,
    TABLE_2,
    Surfaces,
    start_values,
)
from frictioncontact.periodic import periodic_mean
from tools.project import ROOT

TEXT = (ROOT / "docs" / "errata.md").read_text(encoding="utf-8")
SURFACES = Surfaces()
A_D = 1.1e-6


def area_eq_20(swapped: bool, positive_exponent: bool, lengths_over_R_q: bool = True) -> float:
    """A_r [m2] of Eq. 20-22 at 14 um with each of its misprints on or off; all off is the FMU's."""
    surfaces, d, E = Surfaces(), SEPARATION, E_FULL
    c, decay = (surfaces.lambda_, surfaces.c) if swapped else (surfaces.c, surfaces.lambda_)
    omega_c = surfaces.critical_interference(E)
    scale = surfaces.R_q if lengths_over_R_q else 1e-6  # lengths in um, as in the nomenclature
    x = decay * omega_c / scale
    front = c * math.pi * surfaces.beta * surfaces.A_n / decay**2
    sign = 1.0 if positive_exponent else -1.0
    elastic = (1.0 - (1.0 + x) * math.exp(sign * x)) * math.exp(-decay * d / scale)
    plastic = (2.0 + x) * math.exp(-decay * (d + omega_c) / scale)
    return front * (elastic + plastic)


def yield_pressure_ratio(nu: float) -> float:
    """Peak contact pressure over Y at which a Hertzian contact begins to yield below its centre (von Mises).

    On the axis, at depth u contact radii: sigma_z = -p / (1 + u^2),
    sigma_r = -p [(1 + nu)(1 - u atan(1/u)) - 1 / (2 (1 + u^2))].
    """

    def difference(u: float) -> float:
        axial = -1.0 / (1.0 + u * u)
        radial = -(1.0 + nu) * (1.0 - u * math.atan(1.0 / u)) + 0.5 / (1.0 + u * u)
        return -abs(axial - radial)

    best = minimize_scalar(difference, bounds=(0.05, 3.0), method="bounded", options={"xatol": 1e-12})
    return -1.0 / best.fun


def entry(number: int) -> str:
    """The text of one entry, with its line breaks as spaces."""
    begin = TEXT.index(f"### {number}. ")
    end = TEXT.find("\n##", begin)
    return " ".join(TEXT[begin : end if end > 0 else None].split())


def stated(number: int, *forms: str) -> None:
    for form in forms:
        assert form in entry(number), f"entry {number} does not state {form}"


def test_1_constants_are_swapped() -> None:
    swapped = area_eq_20(swapped=True, positive_exponent=False)
    right = area(SURFACES, SEPARATION)
    assert swapped < 1e-20  # m2, an atom's cross-section
    stated(1, f"{swapped:.3g} m²", f"{right:.4g} m²")


def test_2_sign_in_eq_20() -> None:
    x = SURFACES.lambda_ * SURFACES.critical_interference(E_FULL) / SURFACES.R_q
    right, printed = 1.0 - (1.0 + x) * math.exp(-x), 1.0 - (1.0 + x) * math.exp(x)
    integral = quad(lambda u: u * math.exp(-u), 0.0, x, epsabs=0.0, epsrel=1e-12)[0]
    assert right == pytest.approx(integral, rel=1e-6)
    assert all(1.0 - (1.0 + y) * math.exp(y) < 0.0 for y in np.geomspace(1e-6, 10.0, 50))
    stated(2, f"x = {x:.3e}", f"{printed:.3e}", f"{right:.3e}")


def test_4_lengths_are_over_R_q() -> None:
    in_um = area_eq_20(False, False, lengths_over_R_q=False)
    stated(4, f"{in_um:.3g} m²")


def test_5_factor_counted_twice() -> None:
    ratio, C_v = yield_pressure_ratio(0.33), 1.234 + 1.256 * 0.33
    assert ratio == pytest.approx(C_v, rel=1e-3)
    factor = (1.0 - 0.33**2) ** -2
    x = SURFACES.lambda_ * SURFACES.critical_interference(E_FULL) / SURFACES.R_q
    change = (1.0 + math.exp(-factor * x)) / (1.0 + math.exp(-x)) - 1.0
    more_load = 1.0 / (1.0 - 0.33**2) - 1.0
    stated(5, f"{ratio:.3f} Y", f"{C_v:.3f}", f"{factor:.3f}")
    stated(5, f"{-100 * change:.3f} %", f"{100 * more_load:.1f} %")


def test_6_load_jumps_at_the_critical_interference() -> None:
    omega_c = SURFACES.critical_interference(E_FULL)
    elastic = 4.0 / 3.0 * E_FULL * math.sqrt(SURFACES.R) * omega_c**1.5
    plastic = math.pi * SURFACES.R * omega_c * SURFACES.yield_pressure
    assert elastic / plastic == pytest.approx(2.0 / 3.0, rel=1e-12)
    stated(6, f"{omega_c / SURFACES.R_q:.1e} R_q")


def test_7_no_variant_gives_the_printed_area() -> None:
    variants = [area_eq_20(*flags) for flags in product((False, True), repeat=3)]
    nearest = min(variants, key=lambda value: abs(math.log(value / 1.397e-7)))
    assert nearest == area_eq_20(swapped=False, positive_exponent=True)
    assert abs(math.log(nearest / 1.397e-7)) > 1.0
    at = brentq(lambda d: area(SURFACES, d) - 1.397e-7, 14e-6, 18e-6)
    stated(7, f"{nearest:.4g} m²", f"{nearest / 1.397e-7:.2f} times", f"{1e6 * at:.2f} µm")


def test_8_printed_stiffness_is_at_17_um() -> None:
    at_17, at_14 = (E_FULL * 1.397e-7**2 / d**3 for d in (17e-6, 14e-6))
    assert at_17 == pytest.approx(2.326e11, rel=5e-4)
    stated(8, f"{at_17:.4g} N/m", f"{at_14:.4g} N/m", f"{stiffness(SURFACES, SEPARATION):.4g} N/m")


def test_10_means_rise(fmu: FrictionFmu) -> None:
    """By the mean over a cycle of d; the means of convex quantities do."""
    by_fmu = [mean_change(fmu, name)[2] for name in ("A_r", "sigma")]
    for model in ("exponential", "gaussian"):
        changes = []
        for of in (area, stiffness):
            at = partial(of, SURFACES, model=model)
            whole = quad(lambda angle, at=at: at(SEPARATION + A_D * math.cos(angle)), 0.0, math.pi)[0]
            changes.append(100.0 * (whole / math.pi / at(SEPARATION) - 1.0))
            assert np.all(np.diff([at(d) for d in np.linspace(6e-6, 24e-6, 40)], 2) > 0.0)
        stated(10, *(f"{change:+.2f} %" for change in changes))
        if model == "exponential":
            assert changes == pytest.approx(by_fmu, rel=1e-7)
            assert changes[0] == pytest.approx(100.0 * (i0(0.55) - 1.0), rel=1e-9)


def limit(of: object, zeta: float) -> float:
    return float(of(scene(0.0, zeta)))  # type: ignore[operator]


def test_9_11_exponent_and_percentages() -> None:
    assert 2.07e11 / 2.326e11 - 1.0 == pytest.approx(-0.11, abs=5e-4)
    stated(11, f"{100 * (1 - 48 / 55):.1f} %", f"{100 * (1 - 54 / 55):.1f} %")


@pytest.mark.parametrize("t", [1.3e-5, 3.3e-4])
def test_12_eq_25_fails_eq_2(t: float) -> None:
    """What Eq. 2 leaves of it, by finite differences, is sigma e^-G t dV/dt, at first over sigma V_1 / 10."""
    sigma, V, V_1, omega = 2.5366e6, 0.5, 1.44, 2.0 * math.pi * FREQUENCY
    h = 1e-10
    before, at, after = force_eq_25(COULOMB_FORCE, sigma, V, V_1, FREQUENCY, np.array([t - h, t, t + h]))
    V_now = V + V_1 * math.cos(omega * t)
    residual = (after - before) / (2.0 * h) - sigma * (V_now - abs(V_now) * at / COULOMB_FORCE)
    left = math.exp(-sigma * abs(V_now) * t / COULOMB_FORCE) * t * -omega * V_1 * math.sin(omega * t)
    assert residual == pytest.approx(sigma * left, rel=1e-5, abs=1e-3 * sigma)
    assert abs(left) > 0.1 * V_1 or t > 1e-4


def test_12_mean_of_eq_25_drifts_to_coulomb(fmu: FrictionFmu) -> None:
    row = TABLE_2[2]
    drive = IDENTIFIED.stiffness, IDENTIFIED.V, row.V_1, FREQUENCY
    means = []
    for n in (1, 2, 10, 1000):
        t = PERIOD * (n - 1 + (np.arange(400_000) + 0.5) / 400_000)
        means.append(float(np.mean(force_eq_25(COULOMB_FORCE, *drive, t))))
    coulomb = COULOMB_FORCE * limit(coulomb_limit, IDENTIFIED.V / row.V_1)
    assert means[-1] == pytest.approx(coulomb, abs=1e-3)
    exact = periodic_mean(fmu, start_values(row, IDENTIFIED))
    stated(12, f"{means[0]:.2f}, {means[1]:.2f} and {means[2]:.2f} N", f"{coulomb:.2f} N", f"{exact:.2f} N")


def test_13_constant_velocity_means_coulomb_friction(fmu: FrictionFmu) -> None:
    for row in (TABLE_2[3], TABLE_2[4]):
        for parameters in (PRINTED, IDENTIFIED):
            assert periodic_mean(fmu, start_values(row, parameters)) == pytest.approx(55.0, abs=1e-6)
    stated(13, "55.000000 N")


def test_15_rows_2_3_6(fmu: FrictionFmu) -> None:
    rows = [TABLE_2[k] for k in (1, 2, 5)]
    printed = [periodic_mean(fmu, start_values(row, PRINTED)) for row in rows]
    identified = [periodic_mean(fmu, start_values(row, IDENTIFIED)) for row in rows]
    zeta = PRINTED.V / TABLE_2[2].V_1
    coulomb, soft = (COULOMB_FORCE * limit(of, zeta) for of in (coulomb_limit, soft_limit))
    assert coulomb <= printed[1] * (1.0 + 1e-5) <= soft
    slowest = 1.44 * brentq(lambda z: limit(soft_limit, z) - 27 / 55, 0.01, 0.99)
    fastest = 1.44 * math.sin(0.5 * math.pi * 27 / 55)
    stated(
        15,
        "{:.4f}, {:.4f} and {:.4f} N".format(*printed),
        "{:.2f}, {:.2f} and {:.2f} N".format(*identified),
        f"= {coulomb:.4f} N",
        f"{soft:.4f} N",
        f"{100 * (1 - soft / COULOMB_FORCE):.2f} %",
        f"between {slowest:.3f} and {fastest:.3f} m/s",
    )


def test_15_least_squares_through_the_same_rows(fmu: FrictionFmu) -> None:
    rows = read(EXAMPLE, fmu, {})
    named = [parameter(fmu, name, None, None, {}) for name in ("contact.stiffnessScale", "vibration.phase_d")]
    result = fitted(Rows(fmu, rows, named))
    MN, (least, _), (low, high) = 1e-6 * STIFFNESS_PRINTED, *result.profiles
    second = result.minima[1]
    assert least == 0.0
    assert low < second.point[1] < high
    assert second.squares < result.region_bound
    stated(
        15,
        f"{MN * result.values[0]:.3f} MN/m and {math.degrees(result.values[1]):.2f}°",
        f"second minimum at {math.degrees(second.point[1]):.0f}°",
    )


def test_16_modulus() -> None:
    E = 1.0 - E_REDUCED / E_FULL
    sigma = 1.0 - stiffness(SURFACES, SEPARATION, E_REDUCED) / stiffness(SURFACES, SEPARATION)
    A_r = 1.0 - area(SURFACES, SEPARATION, E_REDUCED) / area(SURFACES, SEPARATION)
    index = math.sqrt(SURFACES.R_q / SURFACES.critical_interference(E_FULL))
    stated(16, f"{100 * E:.2f} %", f"{100 * sigma:.2f} %", f"{100 * A_r:.3f} %", f"index is {index:.0f}")


def test_17_exponential_against_gaussian() -> None:
    def ratio(h: float) -> float:
        d = h * SURFACES.R_q
        return area(SURFACES, d) / area(SURFACES, d, model="gaussian")

    low, high = brentq(lambda h: ratio(h) - 2.0, 0.1, 1.0), brentq(lambda h: ratio(h) - 2.0, 3.0, 5.0)
    assert min(ratio(h) for h in np.linspace(low, high, 60)) > 0.5
    at = ratio(14 / 6)
    inside = math.ceil(100 * low) / 100, math.floor(100 * high) / 100
    stated(
        17, f"{at:.3f} of the Gaussian's", f"the stiffness {at**2:.3f}.", "{:.2f} and {:.2f}".format(*inside)
    )


def test_17_at_a_given_load_the_areas_are_equal_and_eq_3_is_not() -> None:
    physics = " ".join((ROOT / "docs" / "physics.md").read_text("utf-8").split())
    lower = []
    for force in (100.0, 312.44):
        d, gaussian = (
            brentq(lambda d, m=model, f=force: load(SURFACES, d, model=m) - f, 5e-6, 30e-6)
            for model in ("exponential", "gaussian")
        )
        same = area(SURFACES, gaussian, model="gaussian") / area(SURFACES, d)
        assert same == pytest.approx(1.0, abs=1e-6)
        lower.append(100 * (1 - stiffness(SURFACES, gaussian, model="gaussian") / stiffness(SURFACES, d)))
    assert "by {:.0f} % at 100 N and by {:.0f} % at 312.44 N".format(*lower) in physics


def test_18_eq_3_is_no_sum_over_contacts(fmu: FrictionFmu) -> None:
    def stiffness_of(model: str, A_n: float) -> float:
        with fmu.session({"contact.model": model, "contact.A_n": A_n}) as session:
            return session.get("sigma")

    eq_3, doubled = (stiffness_of("Asperities", A_n) for A_n in (1e-4, 2e-4))
    mindlin, mindlin_doubled = (stiffness_of("Mindlin", A_n) for A_n in (1e-4, 2e-4))
    assert mindlin_doubled / mindlin == pytest.approx(2.0, rel=1e-12)
    s = SURFACES
    stated(18, f"factor of {doubled / eq_3:.2f}", f"{mindlin:.4e} N/m", f"gives {eq_3 / mindlin:.0f} times")
    interference = s.R_q / s.lambda_
    plastic = math.sqrt(2.0 * s.R * interference)  # Eq. 15: the area 2 pi R omega
    stated(18, f"λ = {1e6 * interference:.1f} µm", f"a radius of {1e6 * plastic:.1f} µm")
