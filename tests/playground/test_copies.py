"""What Copy as gives does in other tools what the page shows."""

from __future__ import annotations

import shlex
import subprocess
import sys
from pathlib import Path

import fmpy
import numpy as np
import pytest
from lxml import etree
from playground_page import Playground

from frictioncontact.fmu import FrictionFmu
from tools.description import description
from tools.presets import Preset

SCHEMA = Path(fmpy.__file__).parent / "ssp" / "schema" / "SystemStructureParameterValues.xsd"
VARIABLES = {variable["name"]: variable for variable in description()["variables"]}
TOLERANCE = 1e-6 * 55.0  # N


@pytest.fixture
def scene(offered: list[Preset]) -> Preset:
    return next(preset for preset in offered if preset.id == "table2-row6-identified")


def test_the_link_restores_the_scene(playground: Playground, offered: list[Preset]) -> None:
    for preset in offered[::9]:
        playground.open()
        playground.choose(preset)
        playground.enter("V", "123.456789")
        before, link = playground.wave(), playground.text("Link")
        playground.page.goto("about:blank")
        playground.page.goto(link)
        playground.page.wait_for_selector("body.ready")
        playground.settle()
        assert playground.wave() == before
        assert playground.page.locator("#preset").input_value() == preset.id
        assert playground.page.locator("#changed").inner_text() == "changed"


def test_a_refused_value_is_not_copied(playground: Playground, scene: Preset) -> None:
    """The texts are those of the last accepted scene."""
    playground.choose(scene)
    kinds = ("fmpy", "Python", ".ssv", "CSV", "Link")
    before = {kind: playground.text(kind) for kind in kinds}
    playground.enter("d", "-7")
    assert "must be above 0 m" in playground.refusal("d")
    assert {kind: playground.text(kind) for kind in kinds} == before
    assert "the last scene that the FMU accepted" in playground.page.locator("#copied").inner_text()
    playground.enter("d", "13")
    assert playground.text("Link") != before["Link"]


def test_the_command_runs(
    playground: Playground, fmu: FrictionFmu, fmu_path: Path, scene: Preset, tmp_path: Path
) -> None:
    """It gives the same scene to the FMU: the forces at the end of a run from rest."""
    playground.choose(scene)
    program, *words = shlex.split(playground.text("fmpy"))
    assert program == "fmpy" and words[-1] == "--show-plot"
    words[1] = str(fmu_path)
    command = [Path(sys.executable).with_name("fmpy"), *words[:-1], "--output-file", "out.csv"]
    subprocess.run(command, cwd=tmp_path, check=True, capture_output=True)
    result = np.genfromtxt(tmp_path / "out.csv", delimiter=",", names=True)
    assert result["time"][-1] == pytest.approx(2 / 20e3)
    with fmu.session(scene.values) as session:
        session.step(2 / 20e3)
        assert result["F_t"][-1] == pytest.approx(session.get("F_t"), abs=2 * TOLERANCE)


def test_the_python_gives_the_mean(
    playground: Playground, fmu_path: Path, scene: Preset, tmp_path: Path
) -> None:
    playground.choose(scene)
    (tmp_path / "FrictionContact.fmu").symlink_to(fmu_path)
    command = [sys.executable, "-c", playground.text("Python")]
    run = subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, text=True)
    value, unit = run.stdout.splitlines()[-1].split()
    assert unit == "N"
    assert float(value) == pytest.approx(playground.number("mean-force"), abs=2 * TOLERANCE)


def test_the_parameter_set_holds_the_scene(
    playground: Playground, offered: list[Preset], tmp_path: Path
) -> None:
    schema = etree.XMLSchema(etree.parse(SCHEMA))
    for preset in offered[::3]:
        playground.choose(preset)
        path = tmp_path / "scene.ssv"
        path.write_text(playground.text(".ssv"), encoding="utf-8")
        root = etree.parse(path).getroot()
        schema.assertValid(root)
        found = {one.get("name"): one[0].get("value") for one in root.iterfind("{*}Parameters/{*}Parameter")}
        restored = {
            name: type(value)(found.get(name, VARIABLES[name]["start"]))
            for name, value in preset.values.items()
        }
        assert restored == preset.values
        assert found.keys() <= preset.values.keys()
