"""fmi2GetRealOutputDerivatives: the exact slopes of F_t and F_y, against differences over short steps."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from fmi_library import OK, Instance

RATES = {"V": 2.0, "d": 1e-3, "E": 5e12}
ACROSS = {"V_y": 0.01, "vibration.V_2": 0.07, "vibration.phase_2": 1.9}


def slope_ahead(
    instance: Instance, t: float, h: float, rates: dict[str, float], output: str = "F_t"
) -> float:
    """Second-order forward difference of the output over two steps with the inputs moving at the rates."""
    start = instance.save()
    forces = instance.get(output)
    for step in range(2):
        assert instance.set_input_rates(rates) == OK
        assert instance.step(t + step * h, h) == OK
        forces += instance.get(output)
    assert instance.restore(start) == OK
    assert instance.drop(start) == OK
    return (-3 * forces[0] + 4 * forces[1] - forces[2]) / (2 * h)


@pytest.mark.parametrize("damping", [0.0, 20.0])
@pytest.mark.parametrize("law", [1, 3, 4], ids=["Dahl", "ElasticPlastic", "LuGre"])
def test_slope_of_the_force_under_vibration(
    new_instance: Callable[..., Instance], law: int, damping: float
) -> None:
    """Off by (2 pi f h)^2 = 1.6e-6 of the slopes that the vibration gives, at h = 1e-8 s.

    A second holds no whole number of periods, so a slope taken at another time is another one.
    """
    for output, across in (("F_t", {}), ("F_t", ACROSS), ("F_y", ACROSS)):
        rates = RATES | ({"V_y": -3.0} if across else {})
        vibration = {"vibration.f": 19999.7, "vibration.V_1": 0.1, "vibration.a_d": 1.1e-6}
        dampers = {"friction.sigma_1": damping, "friction.sigma_2": 1.5 * damping}
        soft = {"contact.stiffnessScale": 1e-6, "vibration.phase_d": 0.7}
        instance = new_instance().start({"friction.model": law}, soft | vibration | dampers | across)
        t, expected, slopes = 0.0, [], []
        for h in (1.3e-5, 1.1e-5, 1.9e-5):
            assert instance.step(t, h) == OK
            t += h
            assert instance.set_input_rates(rates) == OK
            expected.append(slope_ahead(instance, t, 1e-8, rates, output))
            assert instance.set_input_rates(rates) == OK
            status, slope = instance.output_rate(output)
            assert status == OK
            slopes.append(slope)
        steepest = max(map(abs, expected))
        assert steepest > 1e5
        assert slopes == pytest.approx(expected, rel=1e-4, abs=1.6e-6 * steepest)


def test_the_slope_after_a_step_continues_its_rates_until_one_is_set(instance: Instance) -> None:
    """It relaxes within 1 / (sigma V / F_C), about 2 ms, so that a step of 1e-7 s is short."""
    instance.start(values={"contact.stiffnessScale": 1e-6})
    assert instance.set_input_rates(RATES) == OK
    assert instance.step(0.0, 1e-3) == OK
    moving, held = (slope_ahead(instance, 1e-3, 1e-7, rates) for rates in (RATES, {}))
    assert instance.output_rate("F_t") == (OK, pytest.approx(moving, rel=1e-5))
    assert moving != pytest.approx(held, rel=1e-2)
    assert instance.set_input_rates({"V": 0.0}) == OK
    assert instance.output_rate("F_t") == (OK, pytest.approx(held, rel=1e-5))


def test_slope_at_a_reversal_is_the_mean_of_both_sides(instance: Instance) -> None:
    """V = 0 that moves at 7 m/s^2: the dampers alone, since sigma V is 0 on either side."""
    values = {"delta_0": 1e-6, "V": 0.0, "friction.sigma_1": 20.0, "friction.sigma_2": 30.0}
    instance.start({"contact.model": 2}, values)
    assert instance.set_input_rates({"V": 7.0}) == OK
    assert instance.output_rate("F_t") == (OK, pytest.approx((20.0 + 30.0) * 7.0, rel=1e-14))
