"""Getting and setting: start values, initialization mode, tunable parameters."""

from __future__ import annotations

from collections.abc import Callable
from ctypes import c_double, c_int

import pytest
from fmi_library import ERROR, OK, WARNING, Instance, Library

OUTPUTS = ("F_t", "F_t_mean", "W_f", "sigma", "A_r", "delta")


def test_a_fresh_instance_has_the_start_values_of_the_model_description(
    library: Library, instance: Instance
) -> None:
    instance.bring_to("initialization")
    started = [variable for variable in library.variables.values() if variable.start is not None]
    assert len(started) > 20
    for variable in started:
        if variable.kind == "Real":
            assert instance.get(variable.name) == [float(str(variable.start))], variable.name
        else:
            assert instance.chosen(variable.name) == int(str(variable.start)), variable.name


def test_every_value_that_can_be_set_is_read_back(library: Library, instance: Instance) -> None:
    values = {}
    for variable in library.variables.values():
        if variable.causality in ("input", "parameter") and variable.kind == "Real":
            start = float(str(variable.start))
            values[variable.name] = 1.25 * start if start else 1e-9
    assert instance.set(values) == OK
    instance.bring_to("initialization")
    assert dict(zip(values, instance.get(*values), strict=True)) == values


def test_bounds_themselves_are_allowed(library: Library, instance: Instance) -> None:
    for variable in library.variables.values():
        for bound in (variable.min, variable.max):
            if variable.causality in ("input", "parameter") and variable.kind == "Real" and bound is not None:
                assert instance.set({variable.name: bound}) == OK, variable.name


def test_enumerations_take_each_of_their_values(instance: Instance) -> None:
    for name, count in (("friction.model", 2), ("contact.model", 2), ("solver.method", 6)):
        for value in range(1, count + 1):
            assert instance.choose({name: value}) == OK
    instance.bring_to("initialization")
    values = (c_int * 3)()
    references = instance.references(["friction.model", "contact.model", "solver.method"])
    assert instance.call("fmi2GetInteger", references, 3, values) == OK
    assert list(values) == [2, 2, 6]


def test_outputs_in_initialization_mode_follow_the_start_values(instance: Instance) -> None:
    stiffness = 2e6
    assert instance.choose({"contact.model": 2}) == OK
    instance.bring_to("initialization")
    for deflection in (1e-6, -3e-6):
        assert instance.set({"contact.sigma": stiffness, "delta_0": deflection}) == OK
        force, sigma, delta, work = instance.get("F_t", "sigma", "delta", "W_f")
        assert (force, sigma, delta, work) == (
            pytest.approx(stiffness * deflection, rel=1e-15),
            stiffness,
            deflection,
            0,
        )
    before = instance.get(*OUTPUTS)
    assert instance.call("fmi2ExitInitializationMode") == OK
    assert instance.get(*OUTPUTS) == before


def test_bad_start_values_show_when_an_output_is_read(instance: Instance) -> None:
    instance.bring_to("initialization")
    assert instance.set({"vibration.a_d": 20e-6}) == OK
    function_arguments = (instance.references(["F_t"]), 1, (c_double * 1)())
    assert instance.call("fmi2GetReal", *function_arguments) == ERROR
    assert "vibration.a_d" in instance.last_message.text
    assert instance.get("vibration.a_d") == [20e-6]


def test_a_new_stiffness_keeps_the_deflection(instance: Instance) -> None:
    assert instance.set({"contact.stiffnessScale": 1e-6}) == OK
    instance.initialize()
    assert instance.step(0.0, 1e-3) == OK
    delta, force, sigma = instance.get("delta", "F_t", "sigma")
    assert instance.set({"contact.stiffnessScale": 3e-6}) == OK
    assert instance.get("delta") == [delta]
    assert instance.get("F_t", "sigma") == [
        pytest.approx(3 * force, rel=1e-12),
        pytest.approx(3 * sigma, rel=1e-12),
    ]


def test_a_tunable_parameter_takes_effect_at_the_next_step(instance: Instance) -> None:
    instance.initialize()
    assert instance.step(0.0, 1e-3) == OK
    assert instance.get("F_t") == [pytest.approx(55.0, rel=1e-9)]
    assert instance.set({"F_C": 20.0}) == OK
    assert instance.step(1e-3, 1e-3) == OK
    assert instance.get("F_t") == [pytest.approx(20.0, rel=1e-9)]


def setup(instance: Instance, tolerance: float) -> int:
    return instance.call("fmi2SetupExperiment", 1, tolerance, 0.0, 0, 0.0)


def tolerance_used(instance: Instance) -> float:
    instance.bring_to("initialization")
    return instance.get("solver.tolerance")[0]


def test_the_tolerance_of_the_experiment_is_the_solvers(instance: Instance) -> None:
    assert setup(instance, 3e-9) == OK
    assert tolerance_used(instance) == 3e-9


def test_the_users_tolerance_comes_first(new_instance: Callable[..., Instance]) -> None:
    before, after = new_instance(), new_instance()
    assert before.set({"solver.tolerance": 1e-7}) == OK
    assert setup(before, 3e-9) == OK
    assert setup(after, 3e-9) == OK
    assert after.set({"solver.tolerance": 1e-7}) == OK
    assert tolerance_used(before) == tolerance_used(after) == 1e-7


@pytest.mark.parametrize(
    ("asked", "used"), [(0.0, 1e-12), (-1.0, 1e-12), (1e-15, 1e-12), (0.5, 1e-2), (1e300, 1e-2)]
)
def test_a_tolerance_out_of_bounds_is_clamped_with_a_warning(
    instance: Instance, asked: float, used: float
) -> None:
    assert setup(instance, asked) == WARNING
    assert (instance.last_message.status, instance.last_message.category) == (WARNING, "logStatusWarning")
    assert "solver.tolerance" in instance.last_message.text
    assert tolerance_used(instance) == used
