"""InitialUnknowns in the model description: nothing else changes a result of the initialization."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from fmi_library import OK, Instance

from tools import description
from tools.packing import model_description

MODEL = description.read()
DEPENDENCIES = {
    each.variable.name: {known.name for known in each.dependencies} for each in MODEL.initialUnknowns
}
KNOWNS = [v for v in MODEL.modelVariables if v.causality in ("input", "parameter", "independent")]
SETTLED = {"F_t_settled", "F_y_settled"}

# Values of every kind of start: laws, inputs of the contact, a state that is given or settled, a mass.
VIBRATES = {
    "time": 3.7e-6,
    "vibration.V_1": 0.3,
    "vibration.a_d": 2e-6,
    "vibration.phase_d": 0.4,
    "V": 0.05,
    "load": 60.0,
}
DAMPED = {"friction.sigma_1": 20.0, "friction.sigma_2": 3.0, "delta_0": 1e-7}
ACROSS = {"V_y": 0.02, "vibration.V_2": 0.2, "vibration.phase_2": 0.3, "delta_y_0": 2e-8}
STATIC = {"friction.staticRatio": 1.3, "friction.V_S": 0.1}
SCENES: dict[str, tuple[dict[str, int], dict[str, float]]] = {
    "Dahl": ({"friction.model": 1}, VIBRATES | DAMPED | ACROSS),
    "Coulomb by the load": (
        {"friction.model": 2, "friction.limit": 2, "contact.input": 2},
        VIBRATES | ACROSS,
    ),
    "LuGre by mu": ({"friction.model": 4, "friction.limit": 2}, VIBRATES | DAMPED | STATIC | ACROSS),
    "settled": ({"friction.model": 4, "initialState": 2}, VIBRATES | STATIC),
    "ElasticPlastic": ({"friction.model": 3, "contact.model": 2}, VIBRATES | DAMPED | STATIC),
    "constant stiffness": ({"friction.model": 1, "contact.model": 3}, VIBRATES | DAMPED),
    "a mass": (
        {"friction.model": 2},
        {"body.m": 0.5, "body.v_0": 0.0, "V": 0.0, "body.F": 2.0, "body.x_0": 1.0},
    ),
    "a mass on a bristle": ({"friction.model": 1}, {"body.m": 0.5, "body.v_0": 0.1, "delta_0": 1e-8}),
}


def results(
    new_instance: Callable[..., Instance], choices: dict[str, int], values: dict[str, float]
) -> dict[str, float] | None:
    """The unknowns after initialization; None where the values do not go together."""
    instance = new_instance()
    instance.set_up(values.get("time", 0.0), None)
    settings = {name: value for name, value in values.items() if name != "time"}
    if instance.choose(choices) != OK or instance.set(settings) != OK:
        return None
    if (
        instance.call("fmi2EnterInitializationMode") != OK
        or instance.call("fmi2ExitInitializationMode") != OK
    ):
        return None
    names = [name for name in DEPENDENCIES if not (name in SETTLED and values.get("body.m"))]
    found = dict(zip(names, instance.get(*names), strict=True))
    instance.free()
    return found


@pytest.mark.parametrize("scene", SCENES)
def test_nothing_else_changes_a_result(new_instance: Callable[..., Instance], scene: str) -> None:
    choices, values = SCENES[scene]
    before = results(new_instance, choices, values)
    assert before is not None
    changes: set[tuple[str, str]] = set()
    for known in KNOWNS:
        if known.type == "Enumeration":
            items = range(1, len(known.declaredType.items) + 1)
            trials = [(choices | {known.name: item}, values) for item in items]
        else:
            value = values.get(known.name, float(known.start or 0.0))
            trials = [(choices, values | {known.name: 1.01 * value or 1e-3})]
        for changed_choices, changed_values in trials:
            after = results(new_instance, changed_choices, changed_values)
            for name in (after or {}).keys() & before.keys():
                if after is not None and after[name] != before[name]:
                    changes.add((name, known.name))
    wrong = {(name, known) for name, known in changes if known not in DEPENDENCIES[name]}
    assert not wrong
    assert len(changes) > 20


def test_the_build_refuses_a_file_that_the_rules_do_not_give(tmp_path: Path) -> None:
    old = tmp_path / "modelDescription.xml"
    text = description.XML.read_text(encoding="utf-8")
    old.write_text(text, encoding="utf-8")
    model_description.read(old)
    old.write_text(
        text.replace('index="7" dependencies="2 3 13', 'index="7" dependencies="2 3'), encoding="utf-8"
    )
    with pytest.raises(ValueError, match="InitialUnknowns is old; python -m"):
        model_description.read(old)
