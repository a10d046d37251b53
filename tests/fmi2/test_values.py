"""Getting and setting: start values, initialization mode, tunable parameters."""

from __future__ import annotations

from collections.abc import Callable
from ctypes import c_double

import pytest
from fmi_library import ERROR, OK, WARNING, Instance, Library

OUTPUTS = ("F_t", "F_t_mean", "W_f", "sigma", "A_r", "delta")


def test_every_value_of_the_model_description(
    library: Library, new_instance: Callable[..., Instance]
) -> None:
    """Its start is there; another one, each item and each bound can be set, and is read back."""
    fresh, instance, values = new_instance(), new_instance(), {}
    fresh.bring_to("initialization")
    for variable in library.variables.values():
        name, can_be_set = variable.name, variable.causality in ("input", "parameter")
        if variable.type == "Real" and variable.start is not None:
            start = float(variable.start)
            assert fresh.get(name) == [start], name
            if can_be_set:
                values[name] = 1.25 * start if start else 1e-9
                for bound in filter(None, (variable.min, variable.max)):
                    assert instance.set({name: float(bound)}) == OK, name
        elif can_be_set:
            assert fresh.chosen(name) == int(variable.start), name
            for item in variable.declaredType.items:
                assert instance.choose({name: int(item.value)}) == OK, name
            assert instance.choose({name: int(variable.start)}) == OK
    assert len(values) > 20
    assert instance.set(values) == OK
    instance.bring_to("initialization")
    assert dict(zip(values, instance.get(*values), strict=True)) == values


def test_outputs_in_initialization_mode_follow_the_start_values(instance: Instance) -> None:
    instance.bring_to("initialization")
    assert instance.set({"vibration.a_d": 20e-6}) == OK
    assert instance.call("fmi2GetReal", instance.references(["F_t"]), 1, (c_double * 1)()) == ERROR
    assert "vibration.a_d" in instance.last_message.text
    assert instance.get("vibration.a_d") == [20e-6] and instance.set({"vibration.a_d": 0.0}) == OK
    assert instance.choose({"contact.model": 2}) == OK
    for deflection in (1e-6, -3e-6):
        assert instance.set({"contact.sigma": 2e6, "delta_0": deflection}) == OK
        found = instance.get("F_t", "sigma", "delta", "W_f")
        assert found == [pytest.approx(2e6 * deflection, rel=1e-15), 2e6, deflection, 0]
    before = instance.get(*OUTPUTS)
    assert instance.call("fmi2ExitInitializationMode") == OK
    assert instance.get(*OUTPUTS) == before


def test_a_tunable_parameter_takes_effect_at_once(instance: Instance) -> None:
    """A new stiffness keeps the deflection, a new limit counts from the next step on."""
    instance.start(values={"contact.stiffnessScale": 1e-6})
    assert instance.step(0.0, 1e-3) == OK
    delta, force, sigma = instance.get("delta", "F_t", "sigma")
    assert instance.set({"contact.stiffnessScale": 3e-6}) == OK
    assert instance.get("delta", "F_t", "sigma") == pytest.approx([delta, 3 * force, 3 * sigma], rel=1e-12)
    assert instance.set({"F_C": 20.0}) == OK
    assert instance.step(1e-3, 0.1) == OK
    assert instance.get("F_t") == [pytest.approx(20.0, rel=1e-9)]


def setup(instance: Instance, tolerance: float) -> int:
    return instance.call("fmi2SetupExperiment", 1, tolerance, 0.0, 0, 0.0)


def test_the_users_tolerance_comes_before_that_of_the_experiment(
    new_instance: Callable[..., Instance],
) -> None:
    for user, expected in (((), 3e-9), (("before",), 1e-7), (("after",), 1e-7)):
        instance = new_instance()
        for when in ("before", "setup", "after"):
            if when == "setup":
                assert setup(instance, 3e-9) == OK
            elif when in user:
                assert instance.set({"solver.tolerance": 1e-7}) == OK
        instance.bring_to("initialization")
        assert instance.get("solver.tolerance") == [expected]


@pytest.mark.parametrize(("asked", "used"), [(0.0, 1e-12), (-1.0, 1e-12), (1e300, 1e-2)])
def test_a_tolerance_out_of_bounds_is_clamped_with_a_warning(
    instance: Instance, asked: float, used: float
) -> None:
    assert setup(instance, asked) == WARNING
    assert (instance.last_message.status, instance.last_message.category) == (WARNING, "logStatusWarning")
    assert "solver.tolerance" in instance.last_message.text
    instance.bring_to("initialization")
    assert instance.get("solver.tolerance") == [used]
