"""The validation example: passes as it stands, fails when the model changes, names what its input lacks."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
import validate

HEADER = "scenario,start values,quantity,low,high,reason\n"
Ended = Callable[..., object]


@pytest.fixture
def ended(fmu_path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Ended:
    """What the script ends with in this process: its exit status, or its error."""

    def run(*arguments: str) -> object:
        words = ["validate.py", "--fmu", str(fmu_path), "--picture", str(tmp_path / "bands.png"), *arguments]
        monkeypatch.setattr(sys, "argv", words)
        with pytest.raises(SystemExit) as ended:
            validate.main()
        return ended.value.code

    return run


def test_passes(fmu_path: Path, tmp_path: Path) -> None:
    """As its user starts it."""
    picture = tmp_path / "bands.png"
    command = [sys.executable, validate.__file__, "--fmu", str(fmu_path), "--picture", str(picture)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "9 of 9 results in their bands" in done.stdout
    assert picture.stat().st_size > 10_000


def test_fails_when_a_result_leaves_its_band(ended: Ended, capsys: pytest.CaptureFixture[str]) -> None:
    assert ended("--start", "contact.R_q=6.1e-6") == 1
    printed = capsys.readouterr().out.splitlines()
    left = [line for line in printed if line.startswith("LEFT")]
    assert [line.split(" = ")[0] for line in left] == [
        "LEFT contact at rest: sigma",
        "LEFT contact at rest: A_r",
    ]
    assert f"\n    {left[0]}\n" in Path(validate.__file__).with_name("README.md").read_text(encoding="utf-8")


def test_wrong_input_is_one_line(ended: Ended, tmp_path: Path) -> None:
    bands = tmp_path / "bands.csv"
    for line, message in (
        ("one,V=0.5,F_t_mean,x,56,why", "row 2, column low: 'x' is not a number"),
        ("one,V=0.5,F_t_mean,54", "row 2: must have 6 cells"),
        ("one,v=0.5,F_t_mean,54,56,why", "v: no variable of FrictionContact.fmu"),
        ("one,d=-1,F_t_mean,54,56,why", "fmi2ExitInitializationMode: d = -1 m must be above"),
    ):
        bands.write_text(HEADER + line + "\n")
        error = str(ended("--bands", str(bands)))
        assert error.startswith("error: ") and message in error and "\n" not in error
