"""What the documents say: tables, examples and commands agree with the project. tests/site has the links."""

from __future__ import annotations

import re
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest

from frictioncontact import table2
from frictioncontact.fmu import OUTPUTS, FrictionFmu, simulate
from frictioncontact.table2 import percent
from workshop.fmu_docs import tutorial
from workshop.fmu_docs.readme import SCENE

ROOT = Path(__file__).resolve().parents[2]
DOCUMENTS = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("examples/**/*.md")])
USING = (ROOT / "docs" / "using.md").read_text(encoding="utf-8")
ROWS = [[cell.strip() for cell in line[1:].split("|")] for line in USING.splitlines() if line[:1] == "|"]
# And what it prints.
BLOCK = re.compile(r"^```python\n(.*?)^```(?:\n+```text\n(.*?)^```)?", re.DOTALL | re.MULTILINE)
EXAMPLES = [
    pytest.param(*block, id=f"{path.name}-{number}")
    for path in DOCUMENTS
    if path not in (*tutorial.PAGES, ROOT / "README.md")  # which tests/package/test_wheel.py runs
    for number, block in enumerate(BLOCK.findall(path.read_text(encoding="utf-8")))
]


def test_commands_exist() -> None:
    for document in DOCUMENTS:
        for name in re.findall(r"\bscripts/([a-z-]+)\b(?!/|\.)", document.read_text(encoding="utf-8")):
            assert (ROOT / "scripts" / name).exists(), f"scripts/{name} of {document}"


@pytest.mark.parametrize(("code", "shown"), EXAMPLES)
def test_python_examples_run(
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


def test_every_variable_is_explained_with_its_unit_and_start(fmu: FrictionFmu) -> None:
    rows = {row[0].strip("`"): row for row in ROWS if row[0].startswith("`")}
    for name, variable in fmu.variables.items():
        assert name in rows, f"{name} is not explained in docs/using.md"
        row = rows[name]
        assert row[1] == (variable.unit or variable.declaredType.unit or "") or variable.type == "Enumeration"
        if variable.type == "Enumeration":
            items = {int(item.value): item.name for item in variable.declaredType.items}
            start = int(variable.start)
            assert row[2] == f"{start} {items[start]}"
            assert all(f"{number} {item}" in row[4] for number, item in items.items())
        elif variable.start is not None:
            assert float(row[2]) == float(variable.start)
        if variable.causality == "parameter":
            assert row[3] == variable.variability
