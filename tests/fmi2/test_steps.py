"""fmi2DoStep: any time, the stop time, steps of any length."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from ctypes import c_double

import pytest
from fmi_library import ERROR, LAST_SUCCESSFUL_TIME, OK, WARNING, Instance


@pytest.mark.parametrize(("start", "h"), [(0.1, 1e-12), (0.1, 1.0 / 3.0), (-1e12, 1e-7), (0.1, 1e9)])
def test_a_host_may_multiply_steps_instead_of_adding_them(instance: Instance, start: float, h: float) -> None:
    instance.initialize(start=start)
    for step in range(500):
        assert instance.step(start + step * h, h) == OK, instance.messages


@pytest.mark.parametrize(
    ("start", "h", "allowed", "refused"),
    [
        (0.0, 1e-3, 0.997e-9, 1.003e-9),
        (1.0, 2.0, 1.994e-6, 2.006e-6),
        (2.0**30, 1e-12, 16 * 2.0**-22, 17 * 2.0**-22),
        (-(2.0**30), 1e-12, 16 * 2.0**-22, 17 * 2.0**-22),
    ],
)
def test_how_far_the_time_of_a_host_may_be_off(
    new_instance: Callable[..., Instance], start: float, h: float, allowed: float, refused: float
) -> None:
    """By a millionth of the step, and 16 roundings of the time."""
    for side in (-1.0, 1.0):
        instance = new_instance()
        instance.initialize(start=start)
        assert instance.step(start + side * refused, h) == ERROR
        assert "but the instance is at" in instance.last_message.text
        assert instance.step(start + side * allowed, h) == OK, instance.messages


@pytest.mark.parametrize(("start", "h"), [(0.0, sys.float_info.max), (1e200, 1e200), (-1e308, 1e308)])
def test_a_step_with_a_finite_end_is_taken_however_long_it_is(
    instance: Instance, start: float, h: float
) -> None:
    """It slides steadily: the work is F_C V h."""
    assert instance.set({"F_C": 1e-3}) == OK
    instance.initialize(start=start)
    assert instance.step(start, h) == OK, instance.messages
    reached = (c_double * 1)()
    assert instance.call("fmi2GetRealStatus", LAST_SUCCESSFUL_TIME, reached) == OK
    assert reached[0] == start + h
    assert start + h < 1e300 or instance.step(start + h, 1e308) == ERROR  # it has no finite end
    assert instance.get("W_f") == [pytest.approx(1e-3 * 0.005 * h, rel=1e-12)]


def test_a_run_without_end_may_say_so(instance: Instance) -> None:
    """FMPy and others set an infinite stop time."""
    instance.initialize(stop=float("inf"))
    assert instance.step(0.0, 1e9) == OK, instance.messages


def test_a_coarse_step_over_the_vibration_is_told_once(new_instance: Callable[..., Instance]) -> None:
    instance = new_instance().start(values={"vibration.V_1": 1.44})
    half_period = 0.5 / 20e3
    assert instance.step(0.0, 0.9 * half_period) == OK
    assert instance.messages == []
    t = 0.9 * half_period
    for _ in range(3):
        assert instance.step(t, 1e-3) == OK
        t += 1e-3
    assert len(instance.messages) == 1
    assert (instance.last_message.status, instance.last_message.category) == (WARNING, "logStatusWarning")
    for part in ("0.001 s", "20000 Hz", "F_t_mean"):
        assert part in instance.last_message.text
    steady = new_instance().start()
    assert steady.step(0.0, 1.0) == OK
    assert steady.messages == []


@pytest.mark.slow
def test_a_settled_start_does_not_follow_surfaces_that_are_apart(instance: Instance) -> None:
    """The separation goes from 1 m to 2 km and back: no stiffness and no force anywhere on the way."""
    apart = {"d": 1e3, "vibration.a_d": 999.0, "vibration.V_1": 1.0}
    instance.start({"friction.model": 3, "initialState": 2}, apart)
    sigma, F_t, evaluations = instance.get("sigma", "F_t", "solver.evaluations")
    assert (sigma, F_t) == (0.0, 0.0)
    assert evaluations < 1e7


def test_a_step_that_costs_too_much_is_refused_with_one_that_does_not(instance: Instance) -> None:
    """V_y moves through 600 000 periods, in which the bristle sticks and slips in a circle."""
    values = {"vibration.V_1": 0.0025, "V": 0.0125, "friction.V_S": 8e-4, "contact.stiffnessScale": 5.38e-6}
    instance.start({"friction.model": 3}, values)
    assert instance.set_input_rates({"V_y": 5.72e-5}) == OK
    assert instance.step(0.0, 30.0) == ERROR
    advice = re.search(
        r"needs more than .* evaluations.*use steps of at most (\S+) s$", instance.last_message.text
    )
    assert advice
    assert instance.set_input_rates({"V_y": 5.72e-5}) == OK
    assert instance.step(0.0, float(advice[1])) == OK
