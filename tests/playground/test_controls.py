"""Every control of the page does to the FMU what it says, and shows what the FMU refuses."""

from __future__ import annotations

import json

import pytest
from playground_page import Playground, native_wave

from frictioncontact.fmu import FrictionError, FrictionFmu
from tools.description import description
from tools.playground.page import ASSETS, controls

LIMIT = 1e-12  # of the largest force
VARIABLES = {variable["name"]: variable for variable in description()["variables"]}
CONTROLS = [control["name"] for control in json.loads((ASSETS / "controls.json").read_text(encoding="utf-8"))]
# What must be chosen for a control to have an effect.
CONTEXT = {
    "contact.sigma": {"contact.model": "Constant"},
    "vibration.phase_d": {"vibration.a_d": 1e-6},
    "vibration.phase_2": {"vibration.V_2": 0.7},
    "friction.model": {"friction.staticRatio": 1.5},  # with 1 LuGre is Dahl
    "friction.mu": {"friction.limit": "Load"},
    "friction.staticRatio": {"friction.model": "LuGre"},
    "friction.V_S": {"friction.model": "LuGre", "friction.staticRatio": 1.5},
    "load": {"contact.input": "Load"},
}
START = {"V": 0.5, "vibration.V_1": 1.44, "contact.stiffnessScale": 5e-7}
CHOICES = [name for name in CONTROLS if "items" in VARIABLES[name]]
QUANTITIES = [name for name in CONTROLS if name not in CHOICES]


def assert_same(playground: Playground, fmu: FrictionFmu, values: dict[str, float | str]) -> list[float]:
    native, shown = native_wave(fmu, values)["F_t_N"], playground.wave()["F_t_N"]
    assert shown == pytest.approx(native, rel=0, abs=LIMIT * max(map(abs, native))), values
    return native


def test_a_new_parameter_has_a_plain_control() -> None:
    new = {"name": "friction.new", "start": 2.0, "causality": "parameter", "variability": "tunable"}
    *known, plain = controls([*VARIABLES.values(), new])
    assert [control["name"] for control in known] == CONTROLS
    assert (plain["group"], plain["words"], plain["low"], plain["high"]) == ("Friction", "new", 2e-3, 2e3)


def test_every_quantity_reaches_the_fmu(playground: Playground, fmu: FrictionFmu) -> None:
    """Typed into its field, in the unit that is shown: one after the other where they have an effect."""
    contexts = [{}, *CONTEXT.values()]
    for context in contexts:
        scene = START | context
        playground.load(scene)
        for name in (name for name in QUANTITIES if CONTEXT.get(name, {}) == context):
            before, factor = native_wave(fmu, scene)["F_t_N"], VARIABLES[name]["factor"]
            value = 1.5 * float(scene.get(name, VARIABLES[name]["start"])) or 0.5 / factor
            text = repr(value * factor)
            playground.enter(name, text)
            scene[name] = float(text) / factor
            assert name == "delta_0" or native_wave(fmu, scene)["F_t_N"] != before, name
        assert_same(playground, fmu, scene)


def test_every_choice_reaches_the_fmu(playground: Playground, fmu: FrictionFmu) -> None:
    for name in CHOICES:
        scene, forces = START | CONTEXT.get(name, {}), []
        playground.load(scene)
        for item in VARIABLES[name]["items"]:
            playground.pick(name, item["name"])
            forces.append(assert_same(playground, fmu, scene | {name: item["name"]}))
        assert all(forces[0] != other for other in forces[1:]), name


def test_a_refusal_is_the_fmu_s_own_message_at_the_control(playground: Playground, fmu: FrictionFmu) -> None:
    playground.load(START)
    before = playground.wave()
    for name, value in {"F_C": -1.0, "vibration.a_d": 20e-6, "vibration.V_1": 1e30}.items():
        factor = VARIABLES[name]["factor"]
        playground.enter(name, repr(value * factor))
        with pytest.raises(FrictionError) as refused:
            native_wave(fmu, START | {name: float(repr(value * factor)) / factor})
        refusal = playground.refusal(name)
        assert f"{name} = " in refusal and str(refused.value).endswith(refusal)
        assert playground.wave() == before
        field = playground.page.locator(f'[data-variable="{name}"] input[type=text]')
        assert field.get_attribute("aria-invalid") == "true"
        playground.enter(name, repr(float(START.get(name, VARIABLES[name]["start"])) * factor))
        assert playground.refusal(name) == ""
        assert playground.wave() == before


def test_what_is_no_number_is_told_so(playground: Playground) -> None:
    """A comma has two meanings; a minus sign as it is printed is one."""
    playground.load(START)
    before = playground.wave()
    for text in ("", "1e", "NaN", "0x10", "1 2", "0,5"):
        playground.enter("V", text)
        said = playground.refusal("V")
        assert ("is not a number: write the decimal point as ." if "," in text else "is not a number") in said
        assert playground.wave() == before, text
    playground.enter("V", "\u22125e1")
    assert playground.refusal("V") == ""
    assert playground.wave()["velocity_m_per_s"][120] == pytest.approx(-0.05 - 1.44)


def test_wrong_words_of_an_address_are_told_and_no_part_of_the_scene(playground: Playground) -> None:
    """On a page that shows a scene already, and on one that opens with them."""
    playground.load(START)
    for words, message in (("x=1", "x is no variable of this FMU"), ("V=NaN", "V: NaN is not a number")):
        playground.load(dict([words.split("=")]))
        assert playground.page.locator("#refusal").inner_text() == message
        for kind in ("fmpy", "Python", ".ssv", "Link"):
            text = playground.text(kind)
            assert "NaN" not in text and "x=1" not in text
    playground.enter("V", "20")
    assert playground.page.locator("#refusal").inner_text() == ""
    playground.open("#colour=3")
    assert playground.page.locator("#refusal").inner_text() == "colour is no variable of this FMU"
    playground.open("#friction.model=Newton")
    assert "friction.model" in playground.refusal("friction.model")


def test_pointing_at_the_map_and_at_the_curve_moves_the_scene(playground: Playground) -> None:
    """But not a scene that is refused."""
    playground.load(START)
    playground.finish()
    for figure, numbers, part in (("map", ("kappa", "zeta"), 0.7), ("mean", ("zeta",), 0.5)):
        box = playground.page.locator(f"#{figure} svg").bounding_box()
        assert box is not None
        before = [playground.number(number) for number in numbers]
        playground.page.mouse.click(box["x"] + part * box["width"], box["y"] + 0.3 * box["height"])
        playground.settle()
        after = [playground.number(number) for number in numbers]
        assert all(abs(a - b) > 0.1 * b for a, b in zip(after, before, strict=True)), (before, after)
        ring = playground.page.locator(f"#{figure} .point.here").bounding_box()
        assert ring is not None
        assert ring["x"] + ring["width"] / 2 == pytest.approx(box["x"] + part * box["width"], abs=1.5)
    playground.enter("d", "0")
    refusal, box = playground.refusal("d"), playground.page.locator("#map svg").bounding_box()
    assert "d = 0 m must be above 0 m" in refusal and box is not None
    playground.page.mouse.click(box["x"] + 0.6 * box["width"], box["y"] + 0.5 * box["height"])
    playground.settle()
    assert playground.refusal("d") == refusal
