"""F_t_settled and F_y_settled at the FMI boundary: on demand, wherever outputs are read, without a trace."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import pytest
from fmi_library import ERROR, OK, Instance, Library

from tools import description

VIBRATING = {"V": 0.5, "vibration.V_1": 1.44, "vibration.a_d": 1.1e-6}
VIBRATING |= {"contact.stiffnessScale": 4.4e-7, "friction.sigma_2": 3.0, "friction.V_S": 0.5}
ACROSS = {"V_y": 0.2, "vibration.V_2": 0.7, "vibration.phase_2": 1.0}
INPUTS = ("V", "d", "E", "load", "V_y")
BOTH = ("F_t_settled", "F_y_settled")


def ask(instance: Instance, inputs: Sequence[str] = INPUTS) -> list[float]:
    """The means and their derivatives."""
    slopes = [instance.directional(BOTH, {name: 1.0}) for name in inputs]
    assert all(status == OK for status, _ in slopes)
    return [*instance.get(*BOTH), *(slope for _, pair in slopes for slope in pair)]


@pytest.mark.parametrize(("law", "initial", "across"), [(1, 2, {}), (3, 1, ACROSS), (4, 1, ACROSS)])
def test_asking_leaves_no_trace(
    new_instance: Callable[..., Instance], law: int, initial: int, across: dict[str, float]
) -> None:
    asked, other = new_instance(), new_instance()
    choices = {"friction.model": law, "friction.limit": 2, "initialState": initial}
    values = VIBRATING | across | {"friction.staticRatio": 1.2, "solver.tolerance": 1e-3}
    for each in (asked, other):
        each.start(choices, values, "initialization")
    first = ask(asked)
    assert asked.fingerprint() == other.fingerprint()
    for each in (asked, other):
        assert each.call("fmi2ExitInitializationMode") == OK
    assert ask(asked) == first
    for each in (asked, other):
        assert each.set({"V": 0.3}) == OK
        assert each.set_input_rates({"V": 30.0, "d": 1e-3}) == OK
    now = ask(asked, ["V"])
    for each in (asked, other):
        assert each.step(0.0, 1.3e-5) == OK
    assert asked.fingerprint() == other.fingerprint() and now[:2] != first[:2]
    state, last = asked.save(), ask(asked, ["V"])
    assert asked.step(1.3e-5, 1e-3) == OK
    assert asked.restore(state) == OK and asked.drop(state) == OK
    assert ask(asked, ["V"]) == last
    assert asked.call("fmi2Terminate") == OK
    assert asked.get(*BOTH) == last[:2] and (last[1] != 0.0) == bool(across)


def test_it_is_that_of_the_present_values(new_instance: Callable[..., Instance]) -> None:
    """What was asked for before a value changed is asked for again, from a law to the last input."""
    changes = {"V": 0.3, "d": 15e-6, "E": 50e9, "F_C": 40.0, "contact.R_q": 5e-6, "solver.tolerance": 1e-3}
    changes |= {"contact.stiffnessScale": 2e-6, "friction.sigma_2": 5.0, "vibration.f": 1e4}
    changes |= {"vibration.V_1": 1.2, "vibration.a_d": 5e-7, "vibration.phase_d": 1.0, **ACROSS}
    asked, so_far = new_instance().start({}, VIBRATING, "initialization"), dict(VIBRATING)
    last, chosen = asked.get(*BOTH), {}
    for name, value in [*changes.items(), ("friction.model", 4), ("friction.staticRatio", 1.5)]:
        is_choice = isinstance(value, int)
        (chosen if is_choice else so_far)[name] = value
        fresh = new_instance().start(chosen, so_far, "initialization")
        assert (asked.choose if is_choice else asked.set)({name: value}) == OK
        now = asked.get(*BOTH)
        assert now == fresh.get(*BOTH) == asked.get(*BOTH)
        assert now != last or is_choice, name
        last = now


def test_calls_that_ask_for_it_beside_others(instance: Instance) -> None:
    """More than once, and in a direction, which is the sum of its parts."""
    instance.start(values=VIBRATING | ACROSS)
    V, first, F_t, second = instance.get("V", "F_t_settled", "F_t", "F_t_settled")
    assert (V, F_t) == (0.5, instance.get("F_t")[0]) and first == second == instance.get("F_t_settled")[0]
    _, _, *slopes = ask(instance)
    direction = {"V": 0.3, "d": -2e-7, "E": 4e8, "load": 7.0, "V_y": -0.2}
    sums = [
        sum(slope * part for slope, part in zip(slopes[k::2], direction.values(), strict=True))
        for k in (0, 1)
    ]
    status, found = instance.directional(["F_t_settled", "F_t", "F_y_settled"], direction)
    assert status == OK and [found[0], found[2]] == pytest.approx(sums, rel=1e-12)
    assert instance.directional(BOTH, {"V": 0.0}) == (OK, [0.0, 0.0])
    assert instance.output_rate("F_t_settled")[0] == ERROR
    assert "F_t_settled has no derivative in time here" in instance.last_message.text


@pytest.mark.parametrize("name", BOTH)
def test_the_model_description_says_what_it_depends_on(library: Library, name: str) -> None:
    model = description.read()
    (output,) = (each for each in model.outputs if each.variable.name == name)
    assert [each.name for each in output.dependencies] == list(INPUTS)
    (unknown,) = (each for each in model.initialUnknowns if each.variable.name == name)
    parameters = {each.name for each in library.variables.values() if each.causality == "parameter"}
    unused = {"initialState", "solver.method", "solver.stepSize", "friction.sigma_1", "body.x_0"}
    assert {each.name for each in unknown.dependencies} - set(INPUTS) == parameters - unused
