"""What the documents say: tables, examples and commands agree with the project. tests/site has the links."""

from __future__ import annotations

import re
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pages
import pytest

from figures.pages import laws, tutorial
from figures.pages.readme import SCENE
from frictioncontact import table2
from frictioncontact.fmu import OUTPUTS, FrictionError, FrictionFmu, simulate
from frictioncontact.parameters import (
    COULOMB_FORCE,
    IDENTIFIED,
    PERIOD,
    SEPARATION,
    STIFFNESS_PRINTED,
    TABLE_2,
    start_values,
)
from frictioncontact.table2 import percent

ROOT = Path(__file__).resolve().parents[2]
PHYSICS = " ".join((ROOT / "docs" / "physics.md").read_text(encoding="utf-8").split())
USING = (ROOT / "docs" / "using.md").read_text(encoding="utf-8")
ROWS = [[cell.strip() for cell in line[1:].split("|")] for line in USING.splitlines() if line[:1] == "|"]


def test_commands_exist() -> None:
    for document in pages.DOCUMENTS:
        for name in re.findall(r"\bscripts/([a-z-]+)\b(?!/|\.)", document.read_text(encoding="utf-8")):
            assert (ROOT / "scripts" / name).exists(), f"scripts/{name} of {document}"


@pytest.mark.parametrize(("code", "shown"), pages.python(in_wheel=False))
def test_blocks_that_need_a_clone(
    fmu_path: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
    code: str,
    shown: str,
) -> None:
    """In a folder that has what the project's root has; what an example writes beside it stays there."""
    for path in ROOT.iterdir():
        (tmp_path / path.name).symlink_to(path)
    for package in ("libcosimpy", "OMSimulator"):
        if package in code:
            pytest.importorskip(package)
    monkeypatch.chdir(tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        exec(compile(code, "example", "exec"), {"__name__": "example"})
    assert shown in ("", capfd.readouterr().out)


def test_the_pages_of_the_tutorial_are_short_and_have_pictures() -> None:
    for page in tutorial.PAGES:
        text = page.read_text(encoding="utf-8")
        assert f'"{page.stem}.png"' in text and len(text.split()) <= 500


def test_fmpy_example_of_the_readme_runs_the_scene_of_its_picture(fmu: FrictionFmu, tmp_path: Path) -> None:
    text = (ROOT / "README.md").read_text(encoding="utf-8").replace("\\\n", " ")
    command = re.search(r"^    \.venv/bin/fmpy (simulate .*)$", text, re.MULTILINE)
    words = [word for word in command[1].split() if word != "--show-plot"]
    result = tmp_path / "result.csv"
    words[words.index("--output-file") + 1] = str(result)
    fmpy = [sys.executable, "-m", "fmpy"]
    subprocess.run([*fmpy, *words], cwd=ROOT, check=True, capture_output=True, timeout=600)
    rows = np.genfromtxt(result, delimiter=",", names=True)
    drawn = simulate(fmu, SCENE, 5e-7, 400)
    for name in OUTPUTS:
        assert np.abs(rows[name] - drawn[name]).max() < 2e-4 * np.abs(drawn[name]).max(), name


def test_table_2_of_the_readme_is_what_the_run_prints(fmu: FrictionFmu) -> None:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    for result in table2.results(fmu):
        row = result.row
        line = re.search(rf"^\| {row.number} \|.*$", text, re.MULTILINE)[0]
        assert f"| {row.paper_force:.0f} ({row.paper_reduction:.0f} %) |" in line
        assert f"| {result.exact:.4f} ({percent(result.exact, 55.0)} %) |" in line
        assert f"| {result.identified:.2f} ({percent(result.identified, 55.0)} %) |" in line


def test_the_force_beyond_the_limit_is_what_the_equations_page_says(fmu: FrictionFmu) -> None:
    row_4 = start_values(TABLE_2[3], IDENTIFIED) | {"initialState": "Settled"}
    period = simulate(fmu, row_4, PERIOD / 1000, 1000)
    most = np.max(period["F_t"]) / COULOMB_FORCE
    assert f"in row 4 of Table 2 with the identified parameters it reaches {most:.2f} F_C." in PHYSICS


def test_the_limits_of_the_equations_are_those_of_their_page(fmu: FrictionFmu) -> None:
    """The normal reaction (delta^2/2) |d sigma/dd| in sliding, and the deflection F_C/sigma itself."""
    reactions, F_n = [], 0.0
    for model in ("Asperities", "Mindlin"):
        scale = IDENTIFIED.stiffness / STIFFNESS_PRINTED if model == "Asperities" else 1.0
        sigma = {}
        for d in (SEPARATION - 1e-10, SEPARATION, SEPARATION + 1e-10):
            scene = {"contact.model": model, "contact.stiffnessScale": scale, "d": d}
            with fmu.session(scene) as session:
                sigma[d], F_n = session.get("sigma"), session.get("F_n")
        below, at, above = sigma.values()
        reactions.append(0.5 * (COULOMB_FORCE / at) ** 2 * (below - above) / 2e-10)
    said = f"{reactions[0]:.0f} N beside F_n = {F_n:.0f} N at the identified"
    assert said in PHYSICS and f"{reactions[1]:.2f} N at Mindlin's" in PHYSICS
    delta = COULOMB_FORCE / IDENTIFIED.stiffness
    assert f"{1e6 * delta:.1f} µm or {delta / 6e-6:.1f} R_q" in PHYSICS


def test_static_friction_under_vibration_is_what_the_page_says(fmu: FrictionFmu) -> None:
    """77 N and a swing of sigma V_1 / omega break away at 82.5 N; so does a constant V, whatever it is."""
    (left,) = laws.bound_with_total_velocity(np.array([0.02]))
    assert f"only {left:.1f} N would remain at V₁ = 20 mm/s" in PHYSICS
    breaks = 5.5 * 2.0 * np.pi * 20e3 / 2.5e6  # m/s
    assert laws.vibrated(fmu, 0.999 * breaks) == pytest.approx(77.0)
    assert laws.vibrated(fmu, 1.001 * breaks) < 60.0
    for V in (1e-5, 0.01, 1.0):
        assert laws.break_away(fmu, V) == pytest.approx(82.5, rel=1e-3)


def test_every_variable_is_explained_with_its_unit_and_start(fmu: FrictionFmu) -> None:
    rows = {name: row for row in ROWS if row[0].startswith("`") for name in row[0].strip("`").split("`, `")}
    for name, variable in fmu.variables.items():
        assert name in rows, f"{name} is not explained in docs/using.md"
        row = rows[name]
        assert row[1] == (variable.unit or variable.declaredType.unit or "") or variable.type == "Enumeration"
        if variable.type == "Enumeration":
            items = {int(item.value): item.name for item in variable.declaredType.items}
            start = int(variable.start)
            assert row[2] == f"{start} {items[start]}"
            missing = [
                f"{number} {item}" for number, item in items.items() if f"{number} {item}" not in row[4]
            ]
            assert not missing, f"docs/using.md does not explain {missing} of {name}"
        elif variable.start is not None:
            assert float(row[2]) == float(variable.start)
        if variable.causality == "parameter":
            assert row[3] == variable.variability


def test_the_log_says_what_the_page_quotes(fmu: FrictionFmu) -> None:
    chaotic = {"friction.model": "ElasticPlastic", "friction.staticRatio": 1.5, "friction.V_S": 0.22}
    chaotic |= {"contact.sigma": 5.2e5, "V": 0.036, "vibration.V_1": 0.19, "F_C": 82.0}
    with fmu.session(chaotic | {"contact.model": "Constant"}) as session:
        session.get("F_t_settled")
        (told,) = session.warnings
    assert told.partition(": ")[2].partition(" so that")[0] in USING
    with fmu.session() as session:
        with pytest.raises(FrictionError) as refused:
            session.set("F_C", -55.0)
        assert f"\n    {refused.value}\n" in USING
        session.set("d", 0.0)
        with pytest.raises(FrictionError) as refused:
            session.step(1e-3)
        assert f"\n    {refused.value}\n" in USING
